//! Every way to stop early leaves a true bracket: iteration limits, capacities from the least allowed upwards,
//! thresholds close to d, tolerances from nothing to everything, odd guesses. In both scalar types, 2 to 6
//! dimensions.

use crate::common;

use common::dd::v3;
use common::dice::Dice;
use common::hull::{ExactHull, signed_depth};
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::{Matrix3, SMatrix, Vector3};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{BoxShape, Ellipsoid, Linear, Margin, Points, Rigid, Support};
use qdist::{Body, Options, Outcome, Real, Vector};

/// A problem with a known answer.
struct Known<T: Real, const N: usize> {
    name: String,
    set: Box<dyn Support<T, N>>,
    unit: Box<dyn UnitSet<T, N>>,
    d: f64,
    /// How far `d` may be off: rounding of its own evaluation.
    blur: f64,
}

fn vector<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

fn least<const N: usize>(values: impl Fn(usize) -> f64) -> f64 {
    (0..N).map(values).fold(f64::MAX, f64::min)
}

/// Sets with a closed form: moved boxes and centred ellipsoids, sheared boxes, with and without a ball term,
/// inside and outside.
fn problems<T: Real, const N: usize>(seed: u64) -> Vec<Known<T, N>> {
    let mut dice = Dice::new(seed);
    let mut all: Vec<Known<T, N>> = Vec::new();
    let few = 16.0 * f64::EPSILON;
    let sizes = |dice: &mut Dice| -> [f64; N] { std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0))) };
    let (h, g) = (sizes(&mut dice), sizes(&mut dice));
    let t: [f64; N] = std::array::from_fn(|_| (dice.below(25) as f64 - 12.0) / 64.0);
    let cuboid = BoxShape::new(vector::<T, N>(h)).unwrap();
    let moved = Rigid::new(cuboid, SMatrix::identity(), vector::<T, N>(t)).unwrap();
    let room = |i: usize| h[i] - t[i].abs();
    let mut add = |name: &str, set: Box<dyn Support<T, N>>, unit: Box<dyn UnitSet<T, N>>, d: f64, blur: f64| {
        all.push(Known { name: format!("{name}, N = {N}, roundoff {:e}", T::ROUNDOFF.to_f64()), set, unit, d, blur });
    };
    add("ball in box", Box::new(moved), Box::new(Ball::unit()), least::<N>(room), few);
    let grown = Margin::new(moved, T::of(0.25)).unwrap();
    add("ball in grown box", Box::new(grown), Box::new(Ball::unit()), least::<N>(room) + 0.25, few);
    let scaled = least::<N>(|i| room(i) / g[i]);
    add("box in box", Box::new(moved), Box::new(UnitBox::new(vector::<T, N>(g)).unwrap()), scaled, few);
    add("cross in box", Box::new(moved), Box::new(CrossPolytope::new(vector::<T, N>(g)).unwrap()), scaled, few);
    let ray: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.range(0.1, 1.0)));
    let exit = least::<N>(|i| (h[i] + t[i]) / ray[i]);
    add("ray in box", Box::new(moved), Box::new(Segment::new(vector::<T, N>(ray)).unwrap()), exit, few);
    let ellipsoid = Ellipsoid::new(vector::<T, N>(h)).unwrap();
    add("ball in ellipsoid", Box::new(ellipsoid), Box::new(Ball::unit()), least::<N>(|i| h[i]), few);
    let q = UnitEllipsoid::new(vector::<T, N>(g), SMatrix::identity()).unwrap();
    add("ellipsoid in ellipsoid", Box::new(ellipsoid), Box::new(q), least::<N>(|i| h[i] / g[i]), few);
    let corner = (0..N).map(|i| (g[i] / h[i]).powi(2)).sum::<f64>().sqrt();
    add("box in ellipsoid", Box::new(ellipsoid), Box::new(UnitBox::new(vector::<T, N>(g)).unwrap()), 1.0 / corner, few);
    // Sheared: face normals are the rows of the inverse.
    let r = dice.rotation::<N>();
    let m = SMatrix::<f64, N, N>::from_fn(|i, j| exact::<T>(r[i][j] * g[j] + 0.1 * dice.signed()));
    let inverse = m.try_inverse().unwrap();
    let unit = BoxShape::new(vector::<T, N>([1.0; N])).unwrap();
    let sheared = Linear::new(unit, m.map(T::of), Vector::zeros()).unwrap();
    let d = least::<N>(|i| 1.0 / inverse.row(i).norm());
    add("ball in sheared box", Box::new(sheared), Box::new(Ball::unit()), d, 1e-13);
    // Outside, on the surface, and nearly so.
    for gap in [2.0, exact::<T>(1e-3), 0.0] {
        let mut t = [0.125; N];
        t[0] = h[0] + gap;
        let beside = Rigid::new(cuboid, SMatrix::identity(), vector::<T, N>(t)).unwrap();
        // The sum is rounded: the true gap is that of the rounded one.
        let d = h[0] - exact::<T>(t[0]);
        add("box beside", Box::new(beside), Box::new(Ball::unit()), d, few);
        if gap > 0.0 {
            let grown = Margin::new(beside, T::of(0.25)).unwrap();
            add("grown box beside", Box::new(grown), Box::new(Ball::unit()), d + 0.25, few);
            add(
                "box beside, box unit set",
                Box::new(beside),
                Box::new(UnitBox::new(vector::<T, N>(g)).unwrap()),
                d,
                few,
            );
        }
    }
    all
}

/// The bracket contains d, and the answer is consistent in itself.
fn holds<T: Real, const N: usize>(k: &Known<T, N>, s: &Seen, options: &Options<'_, T, N>, memory: (usize, usize)) {
    let tell = || format!("{} in {memory:?} with {options:?}: d = {:e}, {s:?}", k.name, k.d);
    if let Some(text) = broken_promise(s, options, memory.0, memory.1) {
        panic!("{text}: {}", tell());
    }
    // Below, where |d| is tiny, the difference of two sizes near 1 has been rounded.
    let blur = k.blur * k.d.abs();
    assert!(s.lower <= k.d + blur && k.d - blur <= s.upper, "the bracket is false: {}", tell());
    assert!(s.failure.is_none() && s.outcome != Outcome::SupportFailed, "{}", tell());
}

/// More iterations: the bracket stays true, and inside it does not get worse by more than rounding. (Outside and
/// on the surface a second phase begins when that has been found out, and the bracket starts anew.)
fn limits<T: Real, const N: usize>() {
    let size = (256, 4096);
    let mut memory = Memory::new::<T, N>(size.0, size.1);
    for k in problems::<T, N>(31) {
        let mut best = (f64::MIN, f64::MAX);
        for limit in 0..=40 {
            let options = Options { max_iterations: Some(limit), relative: T::zero(), ..brisk() };
            let s = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
            holds(&k, &s, &options, size);
            let rounding = 4096.0 * T::ROUNDOFF.to_f64() * (1.0 + k.d.abs()) * N as f64;
            let inside = k.d > 0.0;
            assert!(
                !inside || s.lower >= best.0 - rounding && s.upper <= best.1 + rounding,
                "{} got worse at {limit}: {best:?} {s:?}",
                k.name
            );
            best = (best.0.max(s.lower), best.1.min(s.upper));
        }
    }
}
every_type_and_dimension!(iteration_limits_leave_brackets_that_only_improve, limits);

/// Capacities from the least that is allowed.
fn capacities<T: Real, const N: usize>() {
    for k in problems::<T, N>(32) {
        for extra in [0, 1, 2, 3, 5, 8, 13, 30, 80] {
            for facets in [0, 1, 2, 5, 11, 40, 200] {
                let size = (N + 1 + extra, 2 * N + facets);
                let mut memory = Memory::new::<T, N>(size.0, size.1);
                let options = Options { relative: T::of(1e-9), ..brisk() };
                let s = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
                holds(&k, &s, &options, size);
            }
        }
    }
}
every_type_and_dimension!(every_capacity_leaves_a_true_bracket, capacities);

/// As much memory as the answer says it used is enough for the same answer.
fn used_memory<T: Real, const N: usize>() {
    for k in problems::<T, N>(33) {
        let options = Options { relative: T::of(1e-3), max_iterations: Some(60), ..brisk() };
        let mut memory = Memory::new::<T, N>(256, 4096);
        let full = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
        let size = (full.vertices.max(N + 1), full.facets.max(2 * N));
        let mut memory = Memory::new::<T, N>(size.0, size.1);
        let again = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
        holds(&k, &again, &options, size);
        assert_eq!((full.outcome, full.lower, full.upper), (again.outcome, again.lower, again.upper), "{}", k.name);
    }
}
every_type_and_dimension!(as_much_memory_as_was_used_gives_the_same_answer, used_memory);

/// Thresholds at d, next to d, and far from it. What is concluded is true; what is far away is concluded.
fn thresholds<T: Real, const N: usize>() {
    let size = (128, 1024);
    let mut memory = Memory::new::<T, N>(size.0, size.1);
    for k in problems::<T, N>(34) {
        for offset in [0.0, 1e-15, 1e-9, 1e-6, 1e-3, 0.1, 0.9, 5.0] {
            for sign in [1.0, -1.0] {
                let threshold = k.d + sign * offset;
                for (relative, limit) in [(0.0, 500), (1e-6, 500), (1e-6, 3), (0.5, 500)] {
                    let options = Options {
                        threshold: Some(T::of(threshold)),
                        relative: T::of(relative),
                        max_iterations: Some(limit),
                        ..brisk()
                    };
                    let s = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
                    holds(&k, &s, &options, size);
                    let rounding = 64.0 * T::ROUNDOFF.to_f64();
                    match s.outcome {
                        Outcome::Above => assert!(k.d >= threshold - rounding, "{} {threshold} {s:?}", k.name),
                        Outcome::Below => assert!(k.d < threshold + rounding, "{} {threshold} {s:?}", k.name),
                        _ => {}
                    }
                    if offset == 5.0 && sign < 0.0 && k.d > 0.0 && limit > 3 {
                        assert_eq!(s.outcome, Outcome::Above, "{} {threshold} {s:?}", k.name);
                    }
                    if offset == 5.0 && sign > 0.0 && limit > 3 {
                        assert_eq!(s.outcome, Outcome::Below, "{} {threshold} {s:?}", k.name);
                    }
                }
            }
        }
    }
}
every_type_and_dimension!(thresholds_near_and_far_are_answered_truly, thresholds);

/// Tolerances from nothing to everything, and guesses of any kind.
fn tolerances<T: Real, const N: usize>() {
    let size = (96, 1024);
    let mut memory = Memory::new::<T, N>(size.0, size.1);
    let mut dice = Dice::new(35);
    for k in problems::<T, N>(35) {
        for (absolute, relative) in [
            (0.0, 0.0),
            (0.0, 1e-15),
            (1e-30, 0.0),
            (0.0, 0.3),
            (0.0, 1.0),
            (0.0, 1e6),
            (1e30, 0.0),
            (0.1, 0.0),
            (1e-3, 1e-3),
        ] {
            for guess in 0..6 {
                let guess = match guess {
                    0 => None,
                    1 => Some(Vector::<T, N>::zeros()),
                    2 => Some(vector(dice.direction::<N>().map(|x| x * 1e-30))),
                    3 => Some(vector(dice.direction::<N>().map(|x| x * 1e30))),
                    4 => Some(vector(std::array::from_fn(|i| if i == N - 1 { -1.0 } else { 0.0 }))),
                    _ => Some(vector(dice.direction::<N>())),
                };
                let options = Options { absolute: T::of(absolute), relative: T::of(relative), guess, ..brisk() };
                let s = Seen::from(&memory.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
                holds(&k, &s, &options, size);
            }
        }
    }
}
every_type_and_dimension!(tolerances_and_guesses_of_any_size, tolerances);

/// A memory that has been used before answers as a fresh one.
fn reuse<T: Real, const N: usize>() {
    let size = (64, 512);
    let mut used = Memory::new::<T, N>(size.0, size.1);
    let mut solver = used.solver::<T, N>();
    for k in problems::<T, N>(36) {
        let options = brisk();
        let s = Seen::from(&solver.solve(&*k.set, &*k.unit, &options));
        holds(&k, &s, &options, size);
        let mut fresh = Memory::new::<T, N>(size.0, size.1);
        let t = Seen::from(&fresh.solver::<T, N>().solve(&*k.set, &*k.unit, &options));
        assert_eq!(
            (s.outcome, s.lower, s.upper, s.iterations),
            (t.outcome, t.lower, t.upper, t.iterations),
            "{}",
            k.name
        );
    }
}
every_type_and_dimension!(used_memory_answers_as_fresh_memory, reuse);

/// Pairs of hulls with an exact depth, through all the early exits.
fn pairs<T: Real>() {
    let mut dice = Dice::new(37);
    for round in 0..60 {
        let list = |dice: &mut Dice| -> Vec<[f64; 3]> {
            (0..4 + dice.below(16)).map(|_| dice.direction::<3>().map(exact::<T>)).collect()
        };
        let (pa, pb) = (list(&mut dice), list(&mut dice));
        let by: [f64; 3] = dice.direction::<3>().map(|x| exact::<T>(x * 1.3));
        let far = exact::<T>(if round % 3 == 0 { 1000.0 } else { 0.0 });
        // B stands at far + by, rounded; the oracle takes what the solver gets.
        let (at_a, at_b) = ([far, 0.0, 0.0], [exact::<T>(far + by[0]), by[1], by[2]]);
        let place =
            |p: &[[f64; 3]], t: [f64; 3]| -> Vec<_> { p.iter().map(|p| common::dd::add(&v3(*p), &v3(t))).collect() };
        let d = signed_depth(&ExactHull::new(&place(&pa, at_a)), &ExactHull::new(&place(&pb, at_b))).depth.hi;
        let typed = |p: &[[f64; 3]]| -> Vec<[T; 3]> { p.iter().map(|p| p.map(T::of)).collect() };
        let (ta, tb) = (typed(&pa), typed(&pb));
        let (sa, sb) = (Points::new(&ta).unwrap(), Points::new(&tb).unwrap());
        let a = Body::new(&sa, Matrix3::identity(), Vector3::from(at_a.map(T::of))).unwrap();
        let b = Body::new(&sb, Matrix3::identity(), Vector3::from(at_b.map(T::of))).unwrap();
        let run = |options: Options<T, 3>, vertices: usize, facets: usize| {
            let mut memory = Memory::new::<T, 3>(vertices, facets);
            let s = Seen::from(&memory.solver::<T, 3>().depth(&a, &b, &options));
            let tell = format!("{round} {vertices} {facets} {options:?}: d = {d:e} {s:?}");
            assert_eq!(broken_promise(&s, &options, vertices, facets), None, "{tell}");
            assert!(s.lower <= d + 4e-16 * d.abs() && d - 4e-16 * d.abs() <= s.upper, "{tell}");
        };
        for limit in 0..=20 {
            run(Options { max_iterations: Some(limit), relative: T::zero(), ..brisk() }, 64, 128);
        }
        for extra in 0..12 {
            run(Options { relative: T::zero(), ..brisk() }, 4 + extra, 6 + 2 * extra);
            run(Options { relative: T::zero(), ..brisk() }, 4 + extra, 200);
            run(Options { relative: T::zero(), ..brisk() }, 100, 6 + extra);
        }
        for offset in [0.0, 1e-12, -1e-12, 1e-6, -1e-6, 0.1, -0.1] {
            run(Options { threshold: Some(T::of(d + offset)), ..brisk() }, 64, 128);
        }
        for scale in [1e-20, 1.0, 1e20] {
            let guess = Some(Vector::from(dice.direction::<3>().map(|x| T::of(x * scale))));
            run(Options { guess, ..brisk() }, 64, 128);
        }
    }
}

#[test]
fn pairs_of_hulls_through_every_early_exit_in_f64() {
    pairs::<f64>();
}

#[test]
fn pairs_of_hulls_through_every_early_exit_in_f32() {
    pairs::<f32>();
}
