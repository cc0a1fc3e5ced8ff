//! Pairs of random convex polytopes against an oracle that is exact (`common::hull`): penetration depth and
//! distance by brute force over features, in double-double.
//!
//! The inputs are exact `f64` (or `f32`) numbers, rotation matrices are used as they are, and the oracle sees the
//! same numbers. So lower <= d <= upper is checked with no tolerance, but for the oracle's own rounding of some
//! 1e-26.

use crate::common;

use common::dd::{BLUR, Dd, V3, add, scale, v3};
use common::dice::Dice;
use common::hull::{Exact, ExactHull, signed_depth};
use common::memory::{Seen, broken_promise};
use nalgebra::{Matrix3, Vector3};
use qdist::support::Points;
use qdist::{Body, Depth, Options, Outcome, Real, Workspace};

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Points with a pose; exact numbers of the scalar type that the solver will run in.
#[derive(Clone, Debug)]
struct Placed {
    points: Vec<[f64; 3]>,
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
}

impl Placed {
    fn new(points: Vec<[f64; 3]>) -> Self {
        Placed { points, rotation: IDENTITY, translation: [0.0; 3] }
    }

    fn turned(mut self, rotation: [[f64; 3]; 3]) -> Self {
        self.rotation = rotation;
        self
    }

    fn moved(mut self, by: [f64; 3]) -> Self {
        for i in 0..3 {
            self.translation[i] += by[i];
        }
        self
    }

    /// Every number rounded to the scalar type.
    fn rounded<T: Real>(&self) -> Self {
        let r = |x: f64| T::of(x).to_f64();
        Placed {
            points: self.points.iter().map(|p| p.map(r)).collect(),
            rotation: self.rotation.map(|row| row.map(r)),
            translation: self.translation.map(r),
        }
    }

    /// World coordinates, exact to double-double.
    fn world(&self) -> Vec<V3> {
        let turn = |p: &[f64; 3]| -> V3 { self.rotation.map(|row| common::dd::dot(&v3(row), &v3(*p))) };
        self.points.iter().map(|p| add(&turn(p), &v3(self.translation))).collect()
    }

    fn reach(&self) -> f64 {
        let norm = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>().sqrt();
        self.points.iter().map(norm).fold(0.0, f64::max) + norm(&self.translation)
    }
}

fn oracle(a: &Placed, b: &Placed) -> Exact {
    signed_depth(&ExactHull::new(&a.world()), &ExactHull::new(&b.world()))
}

fn solve<T: Real>(a: &Placed, b: &Placed, options: &Options<'_, T, 3>) -> Depth<T> {
    let list = |p: &Placed| p.points.iter().map(|p| p.map(T::of)).collect::<Vec<_>>();
    let (pa, pb) = (list(a), list(b));
    let (sa, sb) = (Points::new(&pa).unwrap(), Points::new(&pb).unwrap());
    let rotation = |p: &Placed| Matrix3::from_fn(|i, j| T::of(p.rotation[i][j]));
    let translation = |p: &Placed| Vector3::from(p.translation.map(T::of));
    let a = Body::new(&sa, rotation(a), translation(a)).unwrap();
    let b = Body::new(&sb, rotation(b), translation(b)).unwrap();
    let mut memory = Box::new(Workspace::<T, 3, 256, 512>::new());
    memory.solver().depth(&a, &b, options)
}

/// Everything that one answer can be held to. `Err` tells what is wrong.
fn judge<T: Real>(a: &Placed, b: &Placed, exact: &Exact) -> Result<(), String> {
    let options = Options::<T, 3>::default();
    let r = solve::<T>(a, b, &options);
    let seen = Seen::from(&r);
    if let Some(text) = broken_promise(&seen, &options, 256, 512) {
        return Err(format!("{text}: {seen:?}"));
    }
    let reach = a.reach() + b.reach();
    let blur = Dd::new(BLUR * reach);
    let d = exact.depth;
    let (lower, upper) = (Dd::new(seen.lower), Dd::new(seen.upper));
    if !(lower <= d + blur && d - blur <= upper) {
        return Err(format!(
            "d = {:e} not in [{:e}, {:e}]: d - lower = {:e}, upper - d = {:e}, {:?}",
            d.hi,
            seen.lower,
            seen.upper,
            (d - lower).hi,
            (upper - d).hi,
            seen.outcome
        ));
    }
    // The normal proves the upper bound.
    let n = v3([r.normal.x.to_f64(), r.normal.y.to_f64(), r.normal.z.to_f64()]);
    let support = |p: &Placed, u: &V3| ExactHull::new(&p.world()).support(u);
    let proved = (support(a, &n) + support(b, &scale(&n, Dd::new(-1.0)))) / common::dd::norm(&n);
    if !(proved <= upper + blur) {
        return Err(format!("the normal proves {:e}, not upper = {:e}", proved.hi, seen.upper));
    }
    // Narrow, where arithmetic allows: the error margins are some hundred roundoffs of the coordinates,
    // and where rounding ends a walk is not far beyond.
    let width = seen.upper - seen.lower;
    let attainable = 2000.0 * T::ROUNDOFF.to_f64() * reach;
    let asked = options.relative.to_f64() * seen.upper.abs().max(seen.lower.abs());
    if !(width <= asked.max(attainable)) {
        return Err(format!("width {width:e} of d = {:e}, {:?}, attainable {attainable:e}", d.hi, seen.outcome));
    }
    // The right conclusion, where it is not a matter of rounding.
    let clear = 1000.0 * T::ROUNDOFF.to_f64() * reach;
    let right = if d.hi > clear.max(0.0) {
        matches!(seen.outcome, Outcome::Converged | Outcome::Precision)
    } else if d.hi < -clear {
        seen.outcome == Outcome::Separated
    } else {
        true
    };
    if right { Ok(()) } else { Err(format!("outcome {:?} for d = {:e}", seen.outcome, d.hi)) }
}

/// Runs 8 `count` pairs of a family in both scalar types.
fn family(name: &str, seed: u64, count: usize, mut make: impl FnMut(&mut Dice) -> (Placed, Placed)) {
    let mut dice = Dice::new(seed);
    let mut complaints = Vec::new();
    for i in 0..8 * count {
        let (a, b) = make(&mut dice);
        let mut check = |precision: &str, a: &Placed, b: &Placed, result: Result<(), String>| {
            if let Err(text) = result {
                complaints.push(format!("{name} {i} {precision}: {text}"));
                // One in full, to reproduce.
                if complaints.len() == 1 {
                    complaints.push(format!("  A = {a:?}\n  B = {b:?}"));
                }
            }
        };
        let exact = oracle(&a, &b);
        check("f64", &a, &b, judge::<f64>(&a, &b, &exact));
        let (a, b) = (a.rounded::<f32>(), b.rounded::<f32>());
        let exact = oracle(&a, &b);
        check("f32", &a, &b, judge::<f32>(&a, &b, &exact));
    }
    assert!(complaints.is_empty(), "{} complaints\n{}", complaints.len(), complaints.join("\n"));
}

/// Points in a ball.
fn cloud(dice: &mut Dice, least: usize, most: usize) -> Vec<[f64; 3]> {
    let n = least + dice.below(most - least + 1);
    (0..n).map(|_| dice.direction::<3>().map(|x| x * dice.range(0.5, 1.0))).collect()
}

/// A cloud turned and moved by up to `apart`.
fn placed_cloud(dice: &mut Dice, most: usize, apart: f64) -> Placed {
    let points = cloud(dice, 4, most);
    let (rotation, shift) = (dice.rotation::<3>(), dice.direction::<3>());
    let by = dice.range(0.0, apart);
    Placed::new(points).turned(rotation).moved(shift.map(|x| x * by))
}

fn cuboid(half: [f64; 3]) -> Vec<[f64; 3]> {
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| [sign(i & 1) * half[0], sign(i & 2) * half[1], sign(i & 4) * half[2]]).collect()
}

fn random_half(dice: &mut Dice) -> [f64; 3] {
    std::array::from_fn(|_| dice.range(0.2, 1.5))
}

#[test]
fn the_oracle_knows_what_is_known() {
    // Two cubes that overlap by 0.5, touch, and are 1 apart in two directions; a tetrahedron against itself.
    let cube = || Placed::new(cuboid([1.0; 3]));
    let depth = |by: [f64; 3]| oracle(&cube(), &cube().moved(by)).depth;
    assert_eq!(depth([1.5, 0.25, 0.0]), Dd::new(0.5));
    assert_eq!(depth([2.0, 0.25, 0.0]), Dd::ZERO);
    assert!((depth([3.0, 3.0, 0.5]) + Dd::new(2.0).sqrt()).abs().hi < 1e-30);
    assert!((depth([3.0, 4.0, 4.0]) + Dd::new(3.0)).abs().hi < 1e-30);
    let tetrahedron = || Placed::new(vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]);
    // M is the cuboctahedron (the difference body), with square faces at 2.
    assert_eq!(oracle(&tetrahedron(), &tetrahedron()).depth, Dd::new(2.0));
    // A point above the inside of a triangle.
    let triangle = Placed::new(vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
    assert_eq!(oracle(&triangle, &Placed::new(vec![[1.0, 1.0, 3.0]])).depth, Dd::new(-3.0));
    // Crossing segments, 2 apart.
    let x = Placed::new(vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let y = Placed::new(vec![[0.0, -1.0, 2.0], [0.0, 1.0, 2.0]]);
    assert_eq!(oracle(&x, &y).depth, Dd::new(-2.0));
}

#[test]
fn random_hulls_overlapping_or_apart() {
    family("random", 1, 60, |dice| (placed_cloud(dice, 40, 0.5), placed_cloud(dice, 40, 2.0)));
}

#[test]
fn hulls_deep_inside_each_other() {
    family("deep", 2, 40, |dice| (placed_cloud(dice, 30, 0.0), placed_cloud(dice, 30, 0.2)));
}

#[test]
fn tetrahedra() {
    family("tetrahedra", 3, 150, |dice| (placed_cloud(dice, 4, 0.3), placed_cloud(dice, 4, 0.7)));
}

#[test]
fn boxes_as_hulls_at_any_angle() {
    family("boxes", 4, 100, |dice| {
        let (ha, hb) = (random_half(dice), random_half(dice));
        let (ra, rb) = (dice.rotation::<3>(), dice.rotation::<3>());
        let shift = dice.direction::<3>();
        let by = dice.range(0.0, 3.0);
        (Placed::new(cuboid(ha)).turned(ra), Placed::new(cuboid(hb)).turned(rb).moved(shift.map(|x| x * by)))
    });
}

#[test]
fn boxes_aligned_with_equal_faces_and_edges() {
    family("aligned", 5, 100, |dice| {
        // Sixteenths: coplanar faces, shared edges and exact touching happen often.
        let mut sixteenths = |low: usize, n: usize| (low + dice.below(n)) as f64 / 16.0;
        let ha: [f64; 3] = std::array::from_fn(|_| sixteenths(8, 3));
        let hb: [f64; 3] = std::array::from_fn(|_| sixteenths(8, 3));
        let by: [f64; 3] = std::array::from_fn(|_| sixteenths(0, 20));
        (Placed::new(cuboid(ha)), Placed::new(cuboid(hb)).moved(by))
    });
}

#[test]
fn boxes_nearly_parallel() {
    family("parallel", 6, 120, |dice| {
        let (ha, hb) = (random_half(dice), random_half(dice));
        let angle = dice.decade(-16.0, -2.0);
        let shift = dice.direction::<3>();
        let by = dice.range(0.0, 3.0);
        (Placed::new(cuboid(ha)), Placed::new(cuboid(hb)).turned(dice.tilt(angle)).moved(shift.map(|x| x * by)))
    });
}

#[test]
fn points_that_are_equal_collinear_or_coplanar() {
    family("degenerate", 7, 80, |dice| {
        let mixed = |dice: &mut Dice| {
            let mut points = cloud(dice, 4, 8);
            for _ in 0..6 {
                let (p, q, r) = (dice.pick(&points), dice.pick(&points), dice.pick(&points));
                points.push(match dice.below(4) {
                    0 => p,
                    1 => std::array::from_fn(|i| (p[i] + q[i]) / 2.0),
                    2 => std::array::from_fn(|i| p[i] + 1e-15 * q[i]),
                    _ => std::array::from_fn(|i| p[i] / 2.0 + q[i] / 4.0 + r[i] / 4.0),
                });
            }
            points
        };
        let (a, b) = (mixed(dice), mixed(dice));
        let shift = dice.direction::<3>();
        let by = dice.range(0.0, 2.0);
        (Placed::new(a), Placed::new(b).turned(dice.rotation::<3>()).moved(shift.map(|x| x * by)))
    });
}

#[test]
fn grid_points_with_many_coplanar_faces() {
    family("grid", 8, 60, |dice| {
        let grid = |dice: &mut Dice| {
            let n = 4 + dice.below(10);
            (0..n).map(|_| std::array::from_fn(|_| dice.below(3) as f64 - 1.0)).collect::<Vec<[f64; 3]>>()
        };
        let (a, b) = (grid(dice), grid(dice));
        let by = std::array::from_fn(|_| (dice.below(9) as f64 - 4.0) / 4.0);
        (Placed::new(a), Placed::new(b).moved(by))
    });
}

#[test]
fn polygons_segments_and_points() {
    family("flat", 9, 100, |dice| {
        let flat = |dice: &mut Dice| {
            let mut points = cloud(dice, 3, 8);
            match dice.below(4) {
                0 => points.truncate(1),
                1 => points.truncate(2),
                2 => points.iter_mut().for_each(|p| p[2] = 0.0),
                _ => {}
            }
            Placed::new(points).turned(dice.rotation::<3>())
        };
        let (a, b) = (flat(dice), flat(dice));
        let shift = dice.direction::<3>();
        let by = dice.range(0.0, 1.5);
        (a, b.moved(shift.map(|x| x * by)))
    });
}

#[test]
fn needles_and_plates_of_aspect_up_to_a_million() {
    family("aspect", 10, 100, |dice| {
        let thin = |dice: &mut Dice| {
            let factors: [f64; 3] = std::array::from_fn(|_| dice.decade(-6.0, 0.0));
            let largest = factors.iter().fold(0.0f64, |m, &x| m.max(x));
            let points =
                cloud(dice, 4, 20).iter().map(|p| std::array::from_fn(|i| p[i] * factors[i] / largest)).collect();
            Placed::new(points).turned(dice.rotation::<3>())
        };
        let (a, b) = (thin(dice), thin(dice));
        let shift = dice.direction::<3>();
        let by = if dice.chance(0.5) { dice.decade(-7.0, 0.0) } else { 0.0 };
        (a, b.moved(shift.map(|x| x * by)))
    });
}

#[test]
fn far_from_the_origin() {
    family("offset", 11, 60, |dice| {
        let far: [f64; 3] = dice.direction::<3>().map(|x| x * 1e3);
        (placed_cloud(dice, 20, 0.3).moved(far), placed_cloud(dice, 20, 1.0).moved(far))
    });
}

#[test]
fn coordinates_far_from_the_frame_of_the_body() {
    // The distance is in the points, so that only their differences are small.
    family("own offset", 12, 60, |dice| {
        let far: [f64; 3] = dice.direction::<3>().map(|x| x * 1e3);
        let shifted =
            |p: Vec<[f64; 3]>| -> Vec<[f64; 3]> { p.iter().map(|p| std::array::from_fn(|i| p[i] + far[i])).collect() };
        let (a, b) = (shifted(cloud(dice, 4, 20)), shifted(cloud(dice, 4, 20)));
        (Placed::new(a), Placed::new(b))
    });
}

/// Moves B along the exact normal until the depth is `target` (up to rounding of the translation).
fn until(a: &Placed, b: &Placed, target: f64) -> Option<Placed> {
    let exact = oracle(a, b);
    (exact.depth.hi > 0.0).then(|| b.clone().moved(exact.normal.map(|x| x * (exact.depth.hi - target))))
}

#[test]
fn barely_overlapping_touching_and_barely_apart() {
    family("tiny", 13, 100, |dice| {
        loop {
            let (a, b) = (placed_cloud(dice, 12, 0.2), placed_cloud(dice, 12, 0.8));
            let target = match dice.below(3) {
                0 => 0.0,
                1 => dice.decade(-15.0, -3.0),
                _ => -dice.decade(-15.0, -3.0),
            };
            if let Some(b) = until(&a, &b, target) {
                return (a, b);
            }
        }
    });
}

#[test]
fn sizes_from_a_millionth_to_a_million() {
    family("sizes", 14, 60, |dice| {
        let size = dice.decade(-6.0, 6.0);
        let scaled = |p: Placed| Placed {
            points: p.points.iter().map(|p| p.map(|x| x * size)).collect(),
            translation: p.translation.map(|x| x * size),
            ..p
        };
        (scaled(placed_cloud(dice, 16, 0.3)), scaled(placed_cloud(dice, 16, 1.5)))
    });
}

#[test]
fn a_large_body_and_a_small_one() {
    family("unequal", 15, 60, |dice| {
        let size = dice.decade(-6.0, -1.0);
        let a = placed_cloud(dice, 16, 0.0);
        let mut b = placed_cloud(dice, 16, 0.0);
        b.points.iter_mut().for_each(|p| *p = p.map(|x| x * size));
        let shift = dice.direction::<3>();
        let by = dice.range(0.0, 1.2);
        (a, b.moved(shift.map(|x| x * by)))
    });
}

#[test]
fn identical_poses() {
    family("identical", 16, 40, |dice| {
        let a = placed_cloud(dice, 24, 1.0);
        (a.clone(), a)
    });
}

#[test]
fn point_mirrored_bodies_with_symmetric_differences() {
    // M is symmetric: every support point comes with its mirror image, and offsets tie.
    family("mirrored", 17, 40, |dice| {
        let points = cloud(dice, 4, 16);
        let mirrored = points.iter().map(|p| p.map(|x| -x)).collect();
        (Placed::new(points), Placed::new(mirrored))
    });
}
