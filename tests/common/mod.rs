//! Reads the convex case files: the format is that of `tests/data/README.md`. The oracles are in the modules.

// Each test uses a part.
#![allow(dead_code, unused_macros)]

/// A test of a generic function in both scalars and every dimension.
macro_rules! every_type_and_dimension {
    ($test:ident, $generic:ident) => {
        #[test]
        fn $test() {
            $generic::<f64, 2>();
            $generic::<f64, 3>();
            $generic::<f64, 4>();
            $generic::<f64, 5>();
            $generic::<f64, 6>();
            $generic::<f32, 2>();
            $generic::<f32, 3>();
            $generic::<f32, 4>();
            $generic::<f32, 5>();
            $generic::<f32, 6>();
        }
    };
}

pub mod dd;
pub mod dice;
pub mod exact;
pub mod hull;
pub mod lattice;
pub mod memory;

use nalgebra::{Matrix3, Vector3};
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Points, Sphere, Support};
use qdist::{Body, Real};
use std::path::{Path, PathBuf};

/// A file or folder of the shared data, which lie beside the project and not in it. A test that calls this is marked
/// `#[ignore = "needs ../shared/data"]`: `./x test` runs it with `--include-ignored` where the data are there, or must be (`CI=true`), and
/// counts it as skipped elsewhere.
pub fn shared(path: &str) -> PathBuf {
    let asked = std::env::args().any(|a| a == "--include-ignored" || a == "--ignored");
    assert!(asked, "a test that needs ../shared/data must be #[ignore]d: it would fail where only the project is");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(path);
    assert!(path.exists(), "{path:?} is not there");
    path
}

/// A shape with its numbers as they stand in the file.
#[derive(Clone, Debug)]
pub struct ShapeText {
    pub kind: String,
    pub numbers: Vec<f64>,
}

/// A placed shape.
#[derive(Clone, Debug)]
pub struct BodyText {
    pub shape: ShapeText,
    pub rotation: [f64; 9],
    pub translation: [f64; 3],
}

/// A case with its reference.
#[derive(Clone, Debug)]
pub struct Case {
    pub id: String,
    pub bodies: [BodyText; 2],
    pub depth: f64,
    pub lower: f64,
    pub upper: f64,
    pub size: f64,
    pub normal: Option<Vector3<f64>>,
}

impl Case {
    /// The pair of shape kinds, for statistics.
    pub fn family(&self) -> String {
        let name = |b: &BodyText| match b.shape.kind.as_str() {
            "hull" => format!("hull{}", b.shape.numbers.len() / 3),
            kind => kind.to_string(),
        };
        format!("{}-{}", name(&self.bodies[0]), name(&self.bodies[1]))
    }
}

/// Parses a case file.
pub fn parse(text: &str) -> Vec<Case> {
    let mut tokens = text.split_whitespace();
    let mut cases = Vec::new();
    while let Some(token) = tokens.next() {
        assert_eq!(token, "CASE");
        let id = tokens.next().unwrap().to_string();
        let number = |tokens: &mut std::str::SplitWhitespace| tokens.next().unwrap().parse::<f64>().unwrap();
        let body = |tokens: &mut std::str::SplitWhitespace| {
            assert_eq!(tokens.next(), Some("S"));
            let kind = tokens.next().unwrap().to_string();
            let count = number(tokens) as usize;
            let count = if kind == "hull" { 3 * count } else { count };
            let numbers = (0..count).map(|_| number(tokens)).collect();
            assert_eq!(tokens.next(), Some("P"));
            let rotation = std::array::from_fn(|_| number(tokens));
            let translation = std::array::from_fn(|_| number(tokens));
            BodyText { shape: ShapeText { kind, numbers }, rotation, translation }
        };
        let bodies = [body(&mut tokens), body(&mut tokens)];
        assert_eq!(tokens.next(), Some("T"));
        let t: [f64; 7] = std::array::from_fn(|_| number(&mut tokens));
        let normal = (!t[4].is_nan()).then(|| Vector3::new(t[4], t[5], t[6]));
        cases.push(Case { id, bodies, depth: t[0], lower: t[1], upper: t[2], size: t[3], normal });
    }
    cases
}

/// The vertices of a hull, as the crate wants them.
pub fn points<T: Real>(shape: &ShapeText) -> Vec<[T; 3]> {
    shape.numbers.chunks_exact(3).map(|p| [T::of(p[0]), T::of(p[1]), T::of(p[2])]).collect()
}

/// Builds the shape; `points` must hold its vertices when it is a hull.
pub fn shape<'a, T: Real>(text: &ShapeText, points: &'a [[T; 3]]) -> Box<dyn Support<T, 3> + Sync + 'a> {
    let n: [T; 3] = std::array::from_fn(|i| T::of(text.numbers.get(i).copied().unwrap_or(0.0)));
    match text.kind.as_str() {
        "sphere" => Box::new(Sphere::<T, 3>::new(n[0]).unwrap()),
        "box" => Box::new(BoxShape::new(Vector3::new(n[0], n[1], n[2])).unwrap()),
        "ellipsoid" => Box::new(Ellipsoid::new(Vector3::new(n[0], n[1], n[2])).unwrap()),
        "cylinder" => Box::new(Cylinder::new(n[0], n[1]).unwrap()),
        "capsule" => Box::new(Capsule::new(n[0], n[1]).unwrap()),
        "cone" => Box::new(Cone::new(n[0], n[1]).unwrap()),
        "hull" => Box::new(Points::new(points).unwrap()),
        kind => panic!("unknown shape {kind}"),
    }
}

/// Places the shape.
pub fn body<'a, T: Real>(text: &BodyText, shape: &'a (dyn Support<T, 3> + Sync)) -> Body<'a, T> {
    let r = text.rotation.map(T::of);
    let t = text.translation.map(T::of);
    Body::new(shape, Matrix3::from_row_slice(&r), Vector3::new(t[0], t[1], t[2])).unwrap()
}
