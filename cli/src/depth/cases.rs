//! Convex pairs from case files, with what is known of their depth: one stream of tokens.
//!
//! ```text
//! CASE id
//! S type np p...          shape A: sphere[r] box[hx hy hz, half extents] ellipsoid[a b c] cylinder[r hh] capsule[r hh] cone[r hh]
//!                         (axis z, half heights, cone apex at +z); `S hull nv` is followed by nv lines x y z
//! P r00 .. r22 tx ty tz   pose of A: rotation row by row, then translation
//! S ... / P ...           shape B and its pose
//! T depth lb ub size nx ny nz
//! ```
//!
//! `depth` is negative where the bodies are apart: minus the distance. `lb` and `ub` bracket it, `size` is the scale that errors are quoted
//! against, and `n` is the unit direction from A to B, `nan` where it is not known.

use std::str::FromStr;

use qdist::nalgebra::{Matrix3, Vector3};
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Points, Sphere, Support};
use qdist::{Body, Real};

/// What is wrong, in words. (The reader stands alone: the project's tests are made of it, too.)
type Trouble = String;

/// A shape with its numbers as they stand in the file.
#[derive(Clone, Debug)]
pub struct Shape {
    pub kind: String,
    pub numbers: Vec<f64>,
}

/// A placed shape.
#[derive(Clone, Debug)]
pub struct Placed {
    pub shape: Shape,
    pub rotation: [f64; 9],
    pub translation: [f64; 3],
}

/// A case with its reference.
#[derive(Clone, Debug)]
pub struct Case {
    pub id: String,
    pub bodies: [Placed; 2],
    /// The lines of the file where the bodies begin.
    pub lines: [usize; 2],
    pub depth: f64,
    pub lower: f64,
    pub upper: f64,
    pub size: f64,
    pub normal: Option<Vector3<f64>>,
}

impl Case {
    /// The pair of shape kinds.
    pub fn family(&self) -> String {
        let name = |placed: &Placed| match placed.shape.kind.as_str() {
            "hull" => format!("hull{}", placed.shape.numbers.len() / 3),
            kind => kind.to_string(),
        };
        format!("{}-{}", name(&self.bodies[0]), name(&self.bodies[1]))
    }
}

/// The cases of a file. The trouble names the line and the case.
pub fn parse(text: &str) -> Result<Vec<Case>, Trouble> {
    let mut words = Words { left: Box::new(words(text)), line: 1 };
    let mut cases = Vec::new();
    while let Some((line, word)) = words.left.next() {
        words.line = line;
        if word != "CASE" {
            return Err(format!("line {line}: `{word}` where CASE is expected, after {} cases", cases.len()));
        }
        let mut next = || {
            let id = words.next("the case's name")?;
            words.case(id).map_err(|trouble| format!("case {id}: {trouble}"))
        };
        let case = next();
        cases.push(case.map_err(|trouble| format!("line {}: {trouble}", words.line))?);
    }
    Ok(cases)
}

/// With the lines that they stand in.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines()).flat_map(|(number, line)| line.split_whitespace().map(move |word| (number, word)))
}

/// What is left of the file.
struct Words<'a> {
    left: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    /// Of the last word.
    line: usize,
}

/// How many numbers the shapes have, but for hulls.
const NUMBERS: [(&str, usize); 6] =
    [("sphere", 1), ("box", 3), ("ellipsoid", 3), ("cylinder", 2), ("capsule", 2), ("cone", 2)];

impl<'a> Words<'a> {
    fn next(&mut self, what: &str) -> Result<&'a str, Trouble> {
        let (line, word) = self.left.next().ok_or(format!("the file ends before {what}"))?;
        self.line = line;
        Ok(word)
    }

    fn expect(&mut self, word: &str) -> Result<(), Trouble> {
        let found = self.next(word)?;
        if found == word { Ok(()) } else { Err(format!("`{found}` where {word} is expected")) }
    }

    fn number<N: FromStr>(&mut self, what: &str) -> Result<N, Trouble> {
        let word = self.next(what)?;
        word.parse().map_err(|_| format!("`{word}` is no number, as {what} must be"))
    }

    fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], Trouble> {
        let mut list = [0.0; N];
        for number in &mut list {
            *number = self.number(what)?;
        }
        Ok(list)
    }

    fn case(&mut self, id: &str) -> Result<Case, Trouble> {
        let [(a, first), (b, second)] = [self.placed()?, self.placed()?];
        let (bodies, lines) = ([a, b], [first, second]);
        self.expect("T")?;
        let [depth, lower, upper, size, x, y, z] = self.numbers("the reference")?;
        if let Some(bad) = [depth, lower, upper].iter().find(|x| !x.is_finite()) {
            return Err(format!("{bad} is not finite, as the depth and its bracket must be"));
        }
        if !(size > 0.0 && size.is_finite()) {
            return Err(format!("the size {size} is not above 0 and finite"));
        }
        let normal = (!x.is_nan()).then(|| Vector3::new(x, y, z));
        if normal.is_some_and(|n| !((n.norm() - 1.0).abs() < 1e-3)) {
            return Err(format!("the normal ({x}, {y}, {z}) is no unit vector, nor nan"));
        }
        Ok(Case { id: id.to_string(), bodies, lines, depth, lower, upper, size, normal })
    }

    /// A body, and the line where it begins.
    fn placed(&mut self) -> Result<(Placed, usize), Trouble> {
        self.expect("S")?;
        let line = self.line;
        let kind = self.next("a shape's type")?.to_string();
        let count: usize = self.number("the count of a shape's numbers")?;
        let count = match NUMBERS.iter().find(|(name, _)| *name == kind) {
            Some((_, takes)) if *takes != count => {
                return Err(format!("{kind} has {count} numbers, where it takes {takes}"));
            }
            Some(_) => count,
            None if kind == "hull" => count.saturating_mul(3),
            None => return Err(no_shape(&kind)),
        };
        let numbers = (0..count).map(|_| self.number("a shape's numbers")).collect::<Result<_, _>>()?;
        self.expect("P")?;
        let (rotation, translation) = (self.numbers("a rotation")?, self.numbers("a translation")?);
        Ok((Placed { shape: Shape { kind, numbers }, rotation, translation }, line))
    }
}

impl Shape {
    /// The vertices of a hull; of another shape nothing that is meant.
    pub fn points<T: Real>(&self) -> Vec<[T; 3]> {
        self.numbers.chunks_exact(3).map(|p| [T::of(p[0]), T::of(p[1]), T::of(p[2])]).collect()
    }

    /// As the library has it; `points` are its vertices when it is a hull.
    pub fn build<'a, T: Real>(&self, points: &'a [[T; 3]]) -> Result<Box<dyn Support<T, 3> + Sync + 'a>, Trouble> {
        let n =
            |i: usize| self.numbers.get(i).map(|&x| T::of(x)).ok_or(format!("{} lacks number {}", self.kind, i + 1));
        let bad = |error| format!("{}: {error}", self.kind);
        Ok(match self.kind.as_str() {
            "sphere" => Box::new(Sphere::<T, 3>::new(n(0)?).map_err(bad)?),
            "box" => Box::new(BoxShape::new(Vector3::new(n(0)?, n(1)?, n(2)?)).map_err(bad)?),
            "ellipsoid" => Box::new(Ellipsoid::new(Vector3::new(n(0)?, n(1)?, n(2)?)).map_err(bad)?),
            "cylinder" => Box::new(Cylinder::new(n(0)?, n(1)?).map_err(bad)?),
            "capsule" => Box::new(Capsule::new(n(0)?, n(1)?).map_err(bad)?),
            "cone" => Box::new(Cone::new(n(0)?, n(1)?).map_err(bad)?),
            "hull" => Box::new(Points::new(points).map_err(bad)?),
            kind => return Err(no_shape(kind)),
        })
    }
}

fn no_shape(kind: &str) -> Trouble {
    format!("`{kind}` is no shape: sphere, box, ellipsoid, cylinder, capsule, cone, hull are")
}

impl Placed {
    /// The shape where it is.
    pub fn body<'a, T: Real>(&self, shape: &'a (dyn Support<T, 3> + Sync)) -> Result<Body<'a, T>, Trouble> {
        let t = self.translation.map(T::of);
        let rotation = Matrix3::from_row_slice(&self.rotation.map(T::of));
        Body::new(shape, rotation, Vector3::new(t[0], t[1], t[2]))
            .map_err(|e| format!("pose of {}: {e}", self.shape.kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "CASE one S sphere 1 0.5 P 1 0 0 0 1 0 0 0 1 0 0 0 S hull 1 0.25 0 0 P 1 0 0 0 1 0 0 0 1 1 2 3 T -1 -1 -1 1 nan nan nan";

    #[test]
    fn a_case_is_read() {
        let [case] = parse(CASE).unwrap().try_into().unwrap();
        assert_eq!((case.id.as_str(), case.family().as_str(), case.depth), ("one", "sphere-hull1", -1.0));
        assert_eq!((case.bodies[1].translation, case.normal, case.lines), ([1.0, 2.0, 3.0], None, [1, 1]));
        assert_eq!(case.bodies[1].shape.points::<f64>(), [[0.25, 0.0, 0.0]]);
    }

    #[test]
    fn trouble_names_the_line_and_the_case() {
        let told =
            |from: &str, to: &str| parse(&CASE.replacen(from, to, 1).replace(" S hull", "\nS hull")).unwrap_err();
        for (from, to, says) in [
            ("CASE", "case", "line 1: `case` where CASE is expected"),
            ("0.5", "half", "line 1: case one: `half` is no number"),
            ("S hull 1", "S hull 2", "line 2: case one: `P` is no number"),
            ("S hull 1", "S hull 99999999999999999999", "line 2: case one: `99999999999999999999` is no number"),
            ("S hull 1", "S hull -1", "line 2: case one: `-1` is no number"),
            ("S hull 1", "S torus 1", "line 1: case one: `torus` is no shape"),
            ("sphere 1", "sphere 2", "line 1: case one: sphere has 2 numbers, where it takes 1"),
            ("T -1", "T", "line 2: case one: the file ends before the reference"),
            ("T -1", "T nan", "line 2: case one: NaN is not finite, as the depth"),
            ("-1 -1 1", "-1 -inf 1", "line 2: case one: -inf is not finite, as the depth"),
            ("1 nan nan nan", "0 nan nan nan", "line 2: case one: the size 0"),
            ("nan nan nan", "0 0 2", "line 2: case one: the normal (0, 0, 2) is no unit"),
        ] {
            assert!(told(from, to).starts_with(says), "{to}: {}", told(from, to));
        }
        let shape = Shape { kind: "torus".into(), numbers: vec![] };
        assert!(shape.build::<f64>(&[]).err().unwrap().contains("torus"));
        let shape = Shape { kind: "box".into(), numbers: vec![1.0] };
        assert_eq!(shape.build::<f64>(&[]).err().unwrap(), "box lacks number 2");
    }
}
