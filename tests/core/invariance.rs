//! What must not change the answer, or change it in a known way: unit of length, motion, order of the bodies,
//! scalar type, margins; and what must move it one way: inclusion.
//!
//! Powers of two scale floating-point numbers exactly, and signed permutations move them exactly: there the
//! comparison needs no tolerance at all.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen};
use nalgebra::{Matrix3, SMatrix, Vector3};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Margin, Points, Rigid, Sphere, Sum, Support};
use qdist::{Body, Depth, Options, Outcome, Real, Vector};

/// A shape by its numbers, so that it can be built in either type and at any scale.
#[derive(Clone, Debug)]
enum Kind {
    Sphere(f64),
    Box([f64; 3]),
    Ellipsoid([f64; 3]),
    Cylinder(f64, f64),
    Capsule(f64, f64),
    Cone(f64, f64),
    Hull(Vec<[f64; 3]>),
}

/// A placed shape; every number is exact in `f32`.
#[derive(Clone, Debug)]
struct Placed {
    kind: Kind,
    margin: f64,
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

impl Placed {
    fn random(dice: &mut Dice) -> Self {
        let mut size = || single(dice.range(0.2, 1.5));
        let numbers = [size(), size(), size()];
        let [a, b, _] = numbers;
        let kind = match dice.below(7) {
            0 => Kind::Sphere(a),
            1 => Kind::Box(numbers),
            2 => Kind::Ellipsoid(numbers),
            3 => Kind::Cylinder(a, b),
            4 => Kind::Capsule(a, b),
            5 => Kind::Cone(a, b),
            _ => Kind::Hull((0..4 + dice.below(20)).map(|_| dice.direction::<3>().map(single)).collect()),
        };
        let margin = if dice.chance(0.3) { single(dice.range(0.0, 0.3)) } else { 0.0 };
        let rotation =
            if dice.chance(0.3) { [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] } else { dice.rotation::<3>() };
        Placed { kind, margin, rotation: rotation.map(|r| r.map(single)), translation: [0.0; 3] }
    }

    fn moved(mut self, by: [f64; 3]) -> Self {
        self.translation = by.map(single);
        self
    }

    fn scaled(&self, s: f64) -> Self {
        let by = |x: &[f64; 3]| x.map(|x| x * s);
        let kind = match &self.kind {
            Kind::Sphere(r) => Kind::Sphere(r * s),
            Kind::Box(h) => Kind::Box(by(h)),
            Kind::Ellipsoid(h) => Kind::Ellipsoid(by(h)),
            Kind::Cylinder(r, h) => Kind::Cylinder(r * s, h * s),
            Kind::Capsule(r, h) => Kind::Capsule(r * s, h * s),
            Kind::Cone(r, h) => Kind::Cone(r * s, h * s),
            Kind::Hull(p) => Kind::Hull(p.iter().map(by).collect()),
        };
        Placed { kind, margin: self.margin * s, translation: by(&self.translation), rotation: self.rotation }
    }

    /// The world turned by a matrix of signs and zeros.
    fn turned(&self, m: &[[f64; 3]; 3]) -> Self {
        let row = |i: usize, v: &dyn Fn(usize) -> f64| (0..3).map(|k| m[i][k] * v(k)).sum::<f64>();
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| row(i, &|k| self.rotation[k][j])));
        let translation = std::array::from_fn(|i| row(i, &|k| self.translation[k]));
        Placed { rotation, translation, ..self.clone() }
    }

    fn with<T: Real, R>(&self, f: impl FnOnce(&Body<'_, T>) -> R) -> R {
        let v = |x: &[f64; 3]| Vector3::from(x.map(T::of));
        let t = T::of;
        let points: Vec<[T; 3]> = match &self.kind {
            Kind::Hull(p) => p.iter().map(|p| p.map(T::of)).collect(),
            _ => Vec::new(),
        };
        let shape: Box<dyn Support<T, 3> + Sync + '_> = match &self.kind {
            Kind::Sphere(r) => Box::new(Sphere::<T, 3>::new(t(*r)).unwrap()),
            Kind::Box(h) => Box::new(BoxShape::new(v(h)).unwrap()),
            Kind::Ellipsoid(h) => Box::new(Ellipsoid::new(v(h)).unwrap()),
            Kind::Cylinder(r, h) => Box::new(Cylinder::new(t(*r), t(*h)).unwrap()),
            Kind::Capsule(r, h) => Box::new(Capsule::new(t(*r), t(*h)).unwrap()),
            Kind::Cone(r, h) => Box::new(Cone::new(t(*r), t(*h)).unwrap()),
            Kind::Hull(_) => Box::new(Points::new(&points).unwrap()),
        };
        let grown = Margin::new(&*shape, t(self.margin)).unwrap();
        let rotation = Matrix3::from_fn(|i, j| T::of(self.rotation[i][j]));
        f(&Body::new(&grown, rotation, v(&self.translation)).unwrap())
    }
}

fn depth_with<T: Real>(a: &Placed, b: &Placed, options: &Options<'_, T, 3>) -> Depth<T> {
    let mut memory = Memory::new::<T, 3>(256, 512);
    a.with(|a| b.with(|b| memory.solver::<T, 3>().depth(a, b, options)))
}

fn depth<T: Real>(a: &Placed, b: &Placed) -> Depth<T> {
    depth_with(a, b, &Options::default())
}

/// Random pairs, overlapping and apart, some far from the origin of the world.
fn pairs(seed: u64, count: usize) -> Vec<(Placed, Placed)> {
    let mut dice = Dice::new(seed);
    (0..count)
        .map(|_| {
            let far = if dice.chance(0.3) { 100.0 } else { 0.0 };
            let (direction, by) = (dice.direction::<3>(), dice.range(0.0, 3.0));
            let a = Placed::random(&mut dice).moved([far, 0.0, -far]);
            let b =
                Placed::random(&mut dice).moved([far + by * direction[0], by * direction[1], by * direction[2] - far]);
            (a, b)
        })
        .collect()
}

fn overlap(what: &str, a: (f64, f64), b: (f64, f64)) {
    assert!(a.0 <= b.1 && b.0 <= a.1, "{what}: {a:?} and {b:?} do not overlap");
}

fn bracket<T: Real>(d: &Depth<T>) -> (f64, f64) {
    (d.lower.to_f64(), d.upper.to_f64())
}

/// Scaling everything by 2^k scales the answer by 2^k, to the last bit.
fn scales<T: Real>(powers: &[i32]) {
    for (i, (a, b)) in pairs(41, 150).iter().enumerate() {
        let one = depth::<T>(a, b);
        for &k in powers {
            let s = 2f64.powi(k);
            let r = depth::<T>(&a.scaled(s), &b.scaled(s));
            let tell = format!("pair {i}, 2^{k}: {a:?} {b:?}\n{:?}\n{:?}", Seen::from(&one), Seen::from(&r));
            assert_eq!((one.lower * T::of(s), one.upper * T::of(s)), (r.lower, r.upper), "{tell}");
            assert_eq!((one.outcome, one.iterations, one.normal), (r.outcome, r.iterations, r.normal), "{tell}");
        }
    }
}

#[test]
fn a_power_of_two_as_unit_of_length_changes_no_bit_in_f64() {
    scales::<f64>(&[-40, -20, 1, 20, 40]);
}

#[test]
fn a_power_of_two_as_unit_of_length_changes_no_bit_in_f32() {
    scales::<f32>(&[-20, -10, 1, 10, 20]);
}

/// Any other unit rounds the sizes, so brackets overlap up to that rounding, and conclusions stay.
#[test]
fn units_from_1e_minus_12_to_1e12() {
    for (i, (a, b)) in pairs(42, 100).iter().enumerate() {
        let one = depth::<f64>(a, b);
        for s in [1e-12, 1e-6, 1e-3, 1e3, 1e6, 1e12] {
            let r = depth::<f64>(&a.scaled(s), &b.scaled(s));
            let (lower, upper) = bracket(&one);
            // Coordinates of at most 110 were rounded.
            let blur = 8.0 * f64::EPSILON * 110.0;
            overlap(&format!("pair {i}, scale {s:e}"), (lower - blur, upper + blur), (r.lower / s, r.upper / s));
            assert_eq!(one.outcome == Outcome::Separated, r.outcome == Outcome::Separated, "{i} {s:e}");
        }
    }
}

/// The general solver under a change of unit, of A and of Q alike.
fn general_scales<T: Real, const N: usize>(powers: &[i32]) {
    let mut dice = Dice::new(43);
    // Enough for a ray per corner of the box; what is cut short may end with a negative lower end, a length of another unit.
    let options = Options { max_iterations: Some(600), ..Options::default() };
    for _ in 0..6 {
        let h: [f64; N] = std::array::from_fn(|_| single(dice.range(0.5, 2.0)));
        let g: [f64; N] = std::array::from_fn(|_| single(dice.range(0.5, 2.0)));
        let t: [f64; N] = std::array::from_fn(|_| single(dice.range(-0.3, 0.3)));
        let which = dice.below(2);
        let run = |s: f64, q: f64, unit: usize| {
            let v = |x: &[f64; N], s: f64| Vector::<T, N>::from(x.map(|x| T::of(x * s)));
            let inner: Box<dyn Support<T, N>> = if which == 0 {
                Box::new(BoxShape::new(v(&h, s)).unwrap())
            } else {
                Box::new(Ellipsoid::new(v(&h, s)).unwrap())
            };
            let set = Rigid::new(&*inner, SMatrix::identity(), v(&t, s)).unwrap();
            let unit: Box<dyn UnitSet<T, N>> = match unit {
                0 => Box::new(Ball::new(T::of(q)).unwrap()),
                1 => Box::new(UnitBox::new(v(&g, q)).unwrap()),
                2 => Box::new(CrossPolytope::new(v(&g, q)).unwrap()),
                3 => Box::new(Segment::new(v(&g, q)).unwrap()),
                _ => Box::new(UnitEllipsoid::new(v(&g, q), SMatrix::identity()).unwrap()),
            };
            let mut memory = Memory::new::<T, N>(64, 1024);
            let r = memory.solver::<T, N>().solve(&set, &*unit, &options);
            (r.lower, r.upper, r.iterations, r.outcome)
        };
        for unit in 0..5 {
            let one = run(1.0, 1.0, unit);
            for &k in powers {
                let s = 2f64.powi(k);
                assert_eq!(run(s, s, unit), one, "both, N = {N}, unit set {unit}, 2^{k}");
                let set = run(s, 1.0, unit);
                assert_eq!(
                    (set.0 / T::of(s), set.1 / T::of(s), set.2),
                    (one.0, one.1, one.2),
                    "A, N = {N}, unit set {unit}, 2^{k}"
                );
                let q = run(1.0, s, unit);
                assert_eq!(
                    (q.0 * T::of(s), q.1 * T::of(s), q.2),
                    (one.0, one.1, one.2),
                    "Q, N = {N}, unit set {unit}, 2^{k}"
                );
            }
        }
    }
}

#[test]
fn a_power_of_two_as_unit_of_a_or_q_changes_no_bit() {
    general_scales::<f64, 2>(&[-40, -20, 20, 40]);
    general_scales::<f64, 3>(&[-40, -20, 20, 40]);
    general_scales::<f64, 4>(&[-40, -20, 20, 40]);
    general_scales::<f64, 6>(&[-40, -20, 20, 40]);
    general_scales::<f32, 2>(&[-20, 20]);
    general_scales::<f32, 3>(&[-20, 20]);
    general_scales::<f32, 6>(&[-20, 20]);
}

/// The 24 turns of the cube move every number exactly: the brackets hold for the same d.
fn turns<T: Real>() {
    let turns = [
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
        [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]],
    ];
    for (i, (a, b)) in pairs(44, 150).iter().enumerate() {
        let one = depth::<T>(a, b);
        for m in &turns {
            let r = depth::<T>(&a.turned(m), &b.turned(m));
            overlap(&format!("pair {i} turned: {a:?} {b:?}"), bracket(&one), bracket(&r));
        }
    }
}

#[test]
fn exact_turns_of_the_world_change_nothing() {
    turns::<f64>();
    turns::<f32>();
}

/// A common shift by a sum that is exact changes nothing; the solver takes relative positions.
#[test]
fn exact_shifts_of_the_world_change_no_bit() {
    let mut dice = Dice::new(45);
    for i in 0..100 {
        let sixteenths =
            |dice: &mut Dice| -> [f64; 3] { std::array::from_fn(|_| (dice.below(49) as f64 - 24.0) / 16.0) };
        let (ta, tb) = (sixteenths(&mut dice), sixteenths(&mut dice));
        let (a, b) = (Placed::random(&mut dice), Placed::random(&mut dice));
        let one = depth::<f64>(&a.clone().moved(ta), &b.clone().moved(tb));
        let far = [1e6, -3e5, 65536.0];
        let shift = |t: [f64; 3]| std::array::from_fn(|i| t[i] + far[i]);
        let r = {
            let (mut a, mut b) = (a.clone(), b.clone());
            (a.translation, b.translation) = (shift(ta), shift(tb));
            depth::<f64>(&a, &b)
        };
        assert_eq!((one.lower, one.upper, one.normal), (r.lower, r.upper, r.normal), "pair {i}");
    }
}

/// Swapping the bodies turns the normal and swaps the witnesses.
fn swaps<T: Real>() {
    for (i, (a, b)) in pairs(46, 200).iter().enumerate() {
        let (one, other) = (depth::<T>(a, b), depth::<T>(b, a));
        let tell = format!("pair {i}: {a:?} {b:?}\n{one:?}\n{other:?}");
        overlap(&tell, bracket(&one), bracket(&other));
        assert_eq!(one.outcome == Outcome::Separated, other.outcome == Outcome::Separated, "{tell}");
        if one.outcome == Outcome::Separated && other.outcome == Outcome::Separated {
            // Nearest directions of separated bodies are unique; the normal is as good as the root of the tolerance.
            let root = (8.0 * T::RELATIVE_TOLERANCE.to_f64()).sqrt();
            let widths = [&one, &other].map(|d| ((d.upper - d.lower) / d.upper.abs()).to_f64());
            if widths.iter().all(|&w| w <= 2.0 * T::RELATIVE_TOLERANCE.to_f64()) {
                assert!((one.normal + other.normal).norm().to_f64() < 4.0 * root, "{tell}");
            }
        }
    }
}

#[test]
fn swapping_the_bodies_mirrors_the_answer() {
    swaps::<f64>();
    swaps::<f32>();
}

/// The two scalar types, given the same numbers, bracket the same depth.
#[test]
fn f32_and_f64_agree_on_the_same_numbers() {
    for (i, (a, b)) in pairs(47, 400).iter().enumerate() {
        // All numbers are exact in f32, the positions too.
        let (wide, narrow) = (depth::<f64>(a, b), depth::<f32>(a, b));
        overlap(&format!("pair {i}: {a:?} {b:?}\n{wide:?}\n{narrow:?}"), bracket(&wide), bracket(&narrow));
    }
}

/// A margin adds its radius to the depth, inside and outside, on either body.
fn margins<T: Real>() {
    let mut dice = Dice::new(48);
    for (i, (a, b)) in pairs(49, 200).iter().enumerate() {
        let r = (1.0 + dice.below(32) as f64) / 16.0;
        let mut grown = a.clone();
        // Rounded in f32; the solver is given the rounded one.
        grown.margin = T::of(single(a.margin + r)).to_f64();
        let added = grown.margin - a.margin;
        let (one, two) = (depth::<T>(a, b), depth::<T>(&grown, b));
        let (lower, upper) = bracket(&one);
        // The sum of radii is rounded once in the scalar type.
        let blur = 4.0 * T::ROUNDOFF.to_f64() * (grown.margin + 3.0);
        overlap(
            &format!("pair {i} + {added}: {a:?} {b:?}\n{one:?}\n{two:?}"),
            (lower + added - blur, upper + added + blur),
            bracket(&two),
        );
        let mut other = b.clone();
        other.margin = T::of(single(b.margin + r)).to_f64();
        let added = other.margin - b.margin;
        let two = depth::<T>(a, &other);
        overlap(
            &format!("pair {i}, B + {added}: {a:?} {b:?}"),
            (lower + added - blur, upper + added + blur),
            bracket(&two),
        );
    }
}

#[test]
fn a_margin_adds_its_radius() {
    margins::<f64>();
    margins::<f32>();
}

/// A sum with a sphere is a margin, in any dimension and order.
fn sphere_sums<T: Real, const N: usize>() {
    let mut dice = Dice::new(50);
    for _ in 0..20 {
        let points: Vec<[T; N]> = (0..N + 1 + dice.below(8)).map(|_| dice.direction::<N>().map(|x| T::of(x))).collect();
        let set = Points::new(&points).unwrap();
        let r = T::of(single(dice.range(0.01, 1.0)));
        let run = |set: &dyn Support<T, N>| {
            let mut memory = Memory::new::<T, N>(128, 2048);
            let r = memory.solver::<T, N>().solve(set, &Ball::unit(), &Options::default());
            (r.lower.to_f64(), r.upper.to_f64())
        };
        let plain = run(&set);
        let sphere = Sphere::<T, N>::new(r).unwrap();
        let blur = 16.0 * T::ROUNDOFF.to_f64();
        let moved = (plain.0 + r.to_f64() - blur, plain.1 + r.to_f64() + blur);
        overlap("set + sphere", moved, run(&Sum::new(&set, &sphere)));
        overlap("sphere + set", moved, run(&Sum::new(&sphere, &set)));
        overlap("set with margin", moved, run(&Margin::new(&set, r).unwrap()));
    }
}

#[test]
fn a_sum_with_a_sphere_is_a_margin() {
    sphere_sums::<f64, 2>();
    sphere_sums::<f64, 3>();
    sphere_sums::<f64, 4>();
    sphere_sums::<f64, 6>();
    sphere_sums::<f32, 3>();
    sphere_sums::<f32, 5>();
}

/// More points, larger sizes, larger margins: never less depth.
fn inclusions<T: Real>() {
    let mut dice = Dice::new(51);
    for i in 0..200 {
        let all: Vec<[f64; 3]> = (0..12).map(|_| dice.direction::<3>().map(single)).collect();
        let (direction, by) = (dice.direction::<3>(), dice.range(0.0, 2.0));
        let b = Placed::random(&mut dice).moved(direction.map(|x| x * by));
        let hull =
            |n: usize| Placed { kind: Kind::Hull(all[..n].to_vec()), margin: 0.0, ..Placed::random(&mut Dice::new(i)) };
        let mut before: Option<Depth<T>> = None;
        for n in 1..=12 {
            let now = depth::<T>(&hull(n), &b);
            if let Some(before) = before {
                assert!(
                    before.lower <= now.upper,
                    "{i}: {n} points have less depth than {}: {before:?} {now:?}",
                    n - 1
                );
            }
            before = Some(now);
        }
        // Boxes: each side longer, then the ellipsoid in its box.
        let h: [f64; 3] = std::array::from_fn(|_| single(dice.range(0.2, 1.0)));
        let longer = h.map(|x| single(x * 1.25));
        let make = |kind: Kind| Placed { kind, margin: 0.0, ..Placed::random(&mut Dice::new(i)) };
        let chain = [make(Kind::Ellipsoid(h)), make(Kind::Box(h)), make(Kind::Box(longer))];
        let depths: Vec<Depth<T>> = chain.iter().map(|a| depth(a, &b)).collect();
        for pair in depths.windows(2) {
            assert!(pair[0].lower <= pair[1].upper, "{i}: {chain:?} {b:?} {depths:?}");
        }
    }
}

#[test]
fn a_larger_set_is_not_less_deep() {
    inclusions::<f64>();
    inclusions::<f32>();
}

/// A guess steers where the search begins, not what it finds.
#[test]
fn a_guess_does_not_change_what_is_bracketed() {
    let mut dice = Dice::new(52);
    for (i, (a, b)) in pairs(53, 150).iter().enumerate() {
        let one = depth::<f64>(a, b);
        for guess in [one.normal, -one.normal, Vector3::from(dice.direction::<3>())] {
            let r = depth_with::<f64>(a, b, &Options { guess: Some(guess), ..Options::default() });
            overlap(&format!("pair {i} from {guess:?}: {a:?} {b:?}"), bracket(&one), bracket(&r));
        }
    }
}

/// The same question twice: the same bits.
#[test]
fn answers_are_reproducible() {
    for (a, b) in pairs(54, 100) {
        assert_eq!(depth::<f64>(&a, &b), depth::<f64>(&a, &b));
        assert_eq!(depth::<f32>(&a, &b), depth::<f32>(&a, &b));
    }
}
