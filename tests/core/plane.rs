//! Depths of bodies in the plane, against oracles that share nothing with the solver: separating axes and distances of edges for
//! polygons (a capsule is a segment with a radius, a disc a point with one), and a scan of all directions for ellipses.
//!
//! The oracles work in `f64` on the very numbers that the solver is given.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::Matrix2;
use qdist::support::{BoxShape, Capsule, Ellipsoid, Margin, Points, Sphere, Support};
use qdist::{Body, Depth, Options, Outcome, Real, Vector};

type Point = [f64; 2];

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

/// What a body is to the oracle: the hull of points in the world, and a ball swept over it.
#[derive(Clone, Debug)]
struct Placed {
    kind: Kind,
    /// Numbers of the scalar type.
    turn: Point,
    at: Point,
}

#[derive(Clone, Debug)]
enum Kind {
    Disc(f64),
    Box(Point),
    Capsule(f64, f64),
    Polygon(Vec<Point>, f64),
    Ellipse(Point),
}

impl Placed {
    fn random<T: Real>(dice: &mut Dice, ellipses: bool) -> Self {
        let size = |dice: &mut Dice| exact::<T>(dice.range(0.1, 1.0));
        let kind = match dice.below(if ellipses { 5 } else { 4 }) {
            0 => Kind::Disc(size(dice)),
            1 => Kind::Box([size(dice), size(dice)]),
            2 => Kind::Capsule(size(dice), size(dice)),
            3 => {
                let n = 1 + dice.below(10);
                let points = (0..n).map(|_| [exact::<T>(dice.signed()), exact::<T>(dice.signed())]).collect();
                Kind::Polygon(points, if dice.chance(0.5) { 0.0 } else { size(dice) })
            }
            _ => Kind::Ellipse([size(dice), size(dice)]),
        };
        let (s, c) = dice.range(0.0, 7.0).sin_cos();
        let turn = if dice.chance(0.2) { [1.0, 0.0] } else { [exact::<T>(c), exact::<T>(s)] };
        let at = [exact::<T>(dice.range(-2.0, 2.0)), exact::<T>(dice.range(-2.0, 2.0))];
        Placed { kind, turn, at }
    }

    fn with<T: Real, R>(&self, ask: impl FnOnce(&Body<'_, T, 2>) -> R) -> R {
        let vector = |p: Point| Vector::<T, 2>::new(T::of(p[0]), T::of(p[1]));
        let points: Vec<[T; 2]>;
        let shape: Box<dyn Support<T, 2> + Sync + '_> = match &self.kind {
            Kind::Disc(r) => Box::new(Sphere::new(T::of(*r)).unwrap()),
            Kind::Box(half) => Box::new(BoxShape::new(vector(*half)).unwrap()),
            Kind::Capsule(r, h) => Box::new(Capsule::new(T::of(*r), T::of(*h)).unwrap()),
            Kind::Polygon(list, r) => {
                points = list.iter().map(|p| p.map(T::of)).collect();
                Box::new(Margin::new(Points::new(&points).unwrap(), T::of(*r)).unwrap())
            }
            Kind::Ellipse(semi) => Box::new(Ellipsoid::new(vector(*semi)).unwrap()),
        };
        let [c, s] = self.turn.map(T::of);
        ask(&Body::new(&*shape, Matrix2::new(c, -s, s, c), vector(self.at)).unwrap())
    }

    fn placed(&self, p: Point) -> Point {
        let [c, s] = self.turn;
        [c * p[0] - s * p[1] + self.at[0], s * p[0] + c * p[1] + self.at[1]]
    }

    /// Vertices of the core, in the world, and the radius. Not for ellipses.
    fn core(&self) -> (Vec<Point>, f64) {
        let (points, radius) = match &self.kind {
            Kind::Disc(r) => (vec![[0.0; 2]], *r),
            Kind::Box([x, y]) => (vec![[*x, *y], [-x, *y], [-x, -y], [*x, -y]], 0.0),
            Kind::Capsule(r, h) => (vec![[0.0, -h], [0.0, *h]], *r),
            Kind::Polygon(list, r) => (list.clone(), *r),
            Kind::Ellipse(_) => unreachable!(),
        };
        (points.into_iter().map(|p| self.placed(p)).collect(), radius)
    }

    /// Height along a unit vector.
    fn height(&self, u: Point) -> f64 {
        if let Kind::Ellipse(semi) = self.kind {
            let [c, s] = self.turn;
            let local = [c * u[0] + s * u[1], -s * u[0] + c * u[1]];
            return dot(u, self.at) + (semi[0] * local[0]).hypot(semi[1] * local[1]);
        }
        let (points, radius) = self.core();
        points.iter().map(|&p| dot(u, p)).fold(f64::MIN, f64::max) + radius
    }
}

fn height(a: &Placed, b: &Placed, u: Point) -> f64 {
    a.height(u) + b.height([-u[0], -u[1]])
}

/// Distance of a point from a segment.
fn from_segment(p: Point, a: Point, b: Point) -> f64 {
    let (along, to) = (minus(b, a), minus(p, a));
    let length = dot(along, along);
    let t = if length > 0.0 { (dot(to, along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (to[0] - t * along[0]).hypot(to[1] - t * along[1])
}

/// The signed depth of two hulls with radii: the least overlap along the normals of all segments between vertices of one
/// body (the edges are among them), or minus the least distance of a vertex from such a segment.
fn by_separating_axes(a: &Placed, b: &Placed) -> f64 {
    let ((p, r), (q, s)) = (a.core(), b.core());
    let mut overlap = f64::MAX;
    let mut distance = f64::MAX;
    for (list, other) in [(&p, &q), (&q, &p)] {
        for (i, &x) in list.iter().enumerate() {
            for &y in &list[..=i] {
                let edge = minus(y, x);
                let length = edge[0].hypot(edge[1]);
                if length > 0.0 {
                    let n = [edge[1] / length, -edge[0] / length];
                    overlap = overlap.min(height(a, b, n)).min(height(a, b, [-n[0], -n[1]]));
                }
                distance = other.iter().fold(distance, |d, &z| d.min(from_segment(z, x, y)));
            }
        }
    }
    if p.len() == 1 && q.len() == 1 {
        return r + s - (p[0][0] - q[0][0]).hypot(p[0][1] - q[0][1]);
    }
    // `height` contains the radii, so the cores are apart where it is below their sum.
    if overlap > r + s { overlap } else { r + s - distance }
}

/// The same for any bodies: the least height over all directions.
fn by_scanning(a: &Placed, b: &Placed) -> f64 {
    let at = |angle: f64| height(a, b, [angle.cos(), angle.sin()]);
    let steps = 20_000;
    let step = std::f64::consts::TAU / f64::from(steps);
    let start = (0..steps).map(|k| f64::from(k) * step).min_by(|x, y| at(*x).total_cmp(&at(*y))).unwrap();
    let (mut low, mut high) = (start - step, start + step);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if at(low + third) < at(high - third) { high -= third } else { low += third }
    }
    at(0.5 * (low + high))
}

fn depth<T: Real>(a: &Placed, b: &Placed, options: &Options<'_, T, 2>) -> Depth<T, 2> {
    let mut memory = Memory::new::<T, 2>(128, 256);
    let r = a.with(|a| b.with(|b| memory.solver::<T, 2>().depth(a, b, options)));
    assert_eq!(broken_promise(&Seen::from(&r), options, 128, 256), None, "{a:?} {b:?} {r:?}");
    r
}

/// The bracket holds and is narrow, the normal proves its upper end, the witnesses lie in the bodies and are depth * normal apart.
fn check<T: Real>(a: &Placed, b: &Placed, d: f64, blur: f64) {
    let r = depth::<T>(a, b, &brisk());
    let u = T::ROUNDOFF.to_f64();
    let what = format!("{a:?} {b:?} {d:e} {r:?}");
    let (lower, upper) = (r.lower.to_f64(), r.upper.to_f64());
    assert!(lower <= d + blur && d - blur <= upper, "{what}");
    let narrow = 1.01 * T::RELATIVE_TOLERANCE.to_f64() * d.abs() + 2000.0 * u;
    assert!(upper - lower <= narrow, "{what}");
    let expected = if upper < 0.0 {
        r.outcome == Outcome::Separated
    } else if lower > 0.0 {
        matches!(r.outcome, Outcome::Converged | Outcome::Precision)
    } else {
        matches!(r.outcome, Outcome::Touching | Outcome::Precision | Outcome::Degenerate)
    };
    assert!(expected, "{what}");
    let pair = |v: &Vector<T, 2>| [v[0].to_f64(), v[1].to_f64()];
    let (n, p, q) = (pair(&r.normal), pair(&r.point_a), pair(&r.point_b));
    assert!(height(a, b, n) <= upper + blur + 16.0 * u, "{what}");
    // Sideways, points are known up to the square root of the bracket only.
    let sideways = 4.0 * (narrow * 4.0).sqrt();
    for k in 0..32 {
        let (s, c) = (f64::from(k) * 0.2).sin_cos();
        assert!(dot([c, s], p) <= a.height([c, s]) + narrow && dot([c, s], q) <= b.height([c, s]) + narrow, "{what}");
    }
    let apart = minus(p, q);
    assert!((dot(apart, n) - d).abs() <= narrow + sideways * sideways, "{what}");
    assert!((apart[0] * n[1] - apart[1] * n[0]).abs() <= sideways, "{what}");
}

fn polygons<T: Real>() {
    let mut dice = Dice::new(11);
    for _ in 0..3000 {
        let (a, b) = (Placed::random::<T>(&mut dice, false), Placed::random::<T>(&mut dice, false));
        check::<T>(&a, &b, by_separating_axes(&a, &b), 1e-14);
    }
}

#[test]
fn polygons_discs_and_capsules_agree_with_separating_axes() {
    polygons::<f64>();
    polygons::<f32>();
}

fn ellipses<T: Real>() {
    let mut dice = Dice::new(12);
    for _ in 0..100 {
        let (a, b) = (Placed::random::<T>(&mut dice, true), Placed::random::<T>(&mut dice, true));
        // The scan finds a smooth minimum to rounding, and a corner, where a third is wasted, to 1e-12.
        check::<T>(&a, &b, by_scanning(&a, &b), 1e-12);
    }
}

#[test]
fn ellipses_agree_with_a_scan_of_all_directions() {
    ellipses::<f64>();
    ellipses::<f32>();
}

fn plain(kind: Kind, at: Point) -> Placed {
    Placed { kind, turn: [1.0, 0.0], at }
}

fn closed_forms<T: Real>() {
    let turned = |kind, turn, at| Placed { kind, turn, at };
    let cases = [
        // Pythagorean triples: the references are exact.
        (plain(Kind::Disc(2.0), [1.0, 1.0]), plain(Kind::Disc(1.5), [4.0, 5.0]), -1.5),
        (plain(Kind::Disc(2.0), [1.0, 1.0]), plain(Kind::Disc(3.0), [4.0, 5.0]), 0.0),
        (plain(Kind::Disc(2.0), [1.0, 1.0]), plain(Kind::Disc(1.5), [1.0, 1.0]), 3.5),
        (plain(Kind::Box([1.0, 2.0]), [0.0; 2]), plain(Kind::Box([0.5, 0.5]), [1.25, 0.0]), 0.25),
        (plain(Kind::Box([1.0, 2.0]), [0.0; 2]), plain(Kind::Box([0.5, 0.5]), [1.5, 0.0]), 0.0),
        (plain(Kind::Box([1.0, 2.0]), [0.0; 2]), plain(Kind::Box([0.5, 0.5]), [4.5, 6.5]), -5.0),
        // A quarter turn exchanges the sides; (3, 4)/5 leans them.
        (turned(Kind::Box([1.0, 2.0]), [0.0, 1.0], [0.0; 2]), plain(Kind::Disc(0.5), [2.25, 0.0]), 0.25),
        (turned(Kind::Capsule(0.5, 2.0), [0.0, 1.0], [0.0; 2]), plain(Kind::Disc(0.5), [5.0, 4.0]), -4.0),
        (plain(Kind::Capsule(0.5, 2.0), [0.0; 2]), plain(Kind::Capsule(0.25, 1.0), [0.5, 2.5]), 0.25),
    ];
    let few = 64.0 * T::ROUNDOFF.to_f64();
    for (a, b, d) in cases {
        check::<T>(&a, &b, d, 1e-15);
        let r = depth::<T>(&a, &b, &Options { relative: T::of(few), ..brisk() });
        assert!(r.upper.to_f64() - r.lower.to_f64() <= few * (4.0 + 2.0 * d.abs()), "{a:?} {b:?} {r:?}");
    }
}

#[test]
fn closed_forms_are_met_to_rounding() {
    closed_forms::<f64>();
    closed_forms::<f32>();
}

#[test]
fn thresholds_and_swaps() {
    let mut dice = Dice::new(13);
    for _ in 0..300 {
        let (a, b) = (Placed::random::<f64>(&mut dice, false), Placed::random::<f64>(&mut dice, false));
        let d = by_separating_axes(&a, &b);
        if d.abs() < 1e-6 {
            continue;
        }
        for (share, outcome) in [(0.9, Outcome::Above), (1.1, Outcome::Below)] {
            let share = if d > 0.0 { share } else { 2.0 - share };
            let r = depth::<f64>(&a, &b, &Options { threshold: Some(d * share), ..brisk() });
            assert_eq!(r.outcome, outcome, "{a:?} {b:?} {d} {r:?}");
        }
        let (r, swapped) = (depth::<f64>(&a, &b, &brisk()), depth::<f64>(&b, &a, &brisk()));
        assert!((r.upper - swapped.upper).abs() <= 1e-6 * d.abs() + 1e-13, "{a:?} {b:?}");
    }
}

/// As the documentation of `depth` says: two polygons of m and n vertices need m + n vertices and as many facets.
#[test]
fn polygons_need_little_memory() {
    let mut dice = Dice::new(14);
    for _ in 0..200 {
        let (m, n) = (3 + dice.below(8), 3 + dice.below(8));
        let mut polygon = |n: usize| {
            let points = (0..n).map(|_| [dice.signed(), dice.signed()]).collect();
            plain(Kind::Polygon(points, 0.0), [0.2 * dice.signed(), 0.2 * dice.signed()])
        };
        let (a, b) = (polygon(m), polygon(n));
        let mut memory = Memory::new::<f64, 2>(m + n, m + n);
        let r = a.with(|a| b.with(|b| memory.solver::<f64, 2>().depth(a, b, &brisk())));
        assert_ne!(r.outcome, Outcome::Capacity, "{a:?} {b:?} {r:?}");
        let d = by_separating_axes(&a, &b);
        assert!(r.lower <= d + 1e-14 && d <= r.upper + 1e-14, "{a:?} {b:?} {d} {r:?}");
    }
}

#[test]
fn a_mirror_image_is_no_rotation() {
    let disc = Sphere::<f64, 2>::new(1.0).unwrap();
    for (m, right) in [
        (Matrix2::new(1.0, 0.0, 0.0, 1.0), true),
        (Matrix2::new(0.6, -0.8, 0.8, 0.6), true),
        (Matrix2::new(0.6, 0.8, 0.8, -0.6), false),
        (Matrix2::new(1.0, 0.0, 0.0, 1.001), false),
        (Matrix2::new(f64::NAN, 0.0, 0.0, 1.0), false),
    ] {
        assert_eq!(Body::new(&disc, m, Vector::<f64, 2>::zeros()).is_ok(), right, "{m}");
    }
}
