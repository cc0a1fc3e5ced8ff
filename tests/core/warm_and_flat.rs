//! Warm starts and flat sets: closed forms, and what must hold from tick to tick.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{BoxShape, Ellipsoid, Failure, Points, Rigid, Support};
use qdist::{Options, Outcome, Plan, Real, Tracker, Vector};

fn v<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

/// A box around a point: d for a ball is the distance to the nearest face.
fn moved_box<const N: usize>(half: &[f64; N], at: &[f64; N]) -> f64 {
    (0..N).map(|i| half[i] - at[i].abs()).fold(f64::MAX, f64::min)
}

fn ticks<T: Real, const N: usize>() {
    let mut dice = Dice::new(71);
    let u = T::ROUNDOFF.to_f64();
    for round in 0..20 {
        let half: [f64; N] = std::array::from_fn(|_| f64::from(dice.range(0.5, 2.0) as f32));
        let mut at = [0.0; N];
        let mut tracker = Tracker::<T, N>::new();
        let mut memory = Memory::new::<T, N>(64, 512);
        let step = 10f64.powi(-(round % 5) - 1) * 0.1;
        let radius = T::of(0.75);
        let unit: Box<dyn UnitSet<T, N>> = match round % 3 {
            0 => Box::new(Ball::new(radius).unwrap()),
            1 => Box::new(UnitBox::new(v::<T, N>([0.75; N])).unwrap()),
            _ => Box::new(UnitEllipsoid::new(v::<T, N>([0.75; N]), SMatrix::identity()).unwrap()),
        };
        for tick in 0..40 {
            let old = at;
            for x in &mut at {
                *x = f64::from((*x + step * dice.signed()).clamp(-0.4, 0.4) as f32);
            }
            let moved = (0..N).map(|i| (at[i] - old[i]).powi(2)).sum::<f64>().sqrt();
            let moved = (tick > 0).then_some(T::of(moved * (1.0 + 1e-6)));
            let set = Rigid::new(BoxShape::new(v::<T, N>(half)).unwrap(), SMatrix::identity(), v::<T, N>(at)).unwrap();
            let d = moved_box(&half, &at) / 0.75;
            let limit = (tick > 0).then(|| dice.below(30) as u32);
            let options = Options { max_iterations: limit, relative: T::of(1e-3), ..Options::default() };
            let before = tracker;
            let lower = moved.and_then(|moved| before.lower_after(moved, &*unit)).map_or(f64::MIN, T::to_f64);
            assert!(lower <= d * (1.0 + 8.0 * u), "{lower} {d}");
            let a = memory.solver::<T, N>().solve_warm(&mut tracker, &set, &*unit, moved, &options);
            let s = Seen::from(&a);
            assert_eq!(broken_promise(&s, &options, 64, 512), None, "{s:?}");
            assert!(s.lower <= d * (1.0 + 8.0 * u) && d * (1.0 - 8.0 * u) <= s.upper, "{round} {tick} {d} {s:?}");
            assert!(s.lower >= lower * (1.0 - 8.0 * u) || lower < 0.0, "worse than at once: {lower} {s:?}");
            assert_eq!(tracker.lower, Some(a.lower));
        }
    }
}

#[test]
fn every_tick_has_a_true_bracket() {
    ticks::<f64, 3>();
    ticks::<f64, 6>();
    ticks::<f32, 3>();
    ticks::<f32, 6>();
}

/// A smooth set in six dimensions that moves little: no expansion is needed, and some calls do.
#[test]
fn a_small_move_is_answered_at_once() {
    let body = Ellipsoid::new(v::<f64, 6>([1.0, 1.2, 1.4, 1.6, 1.8, 2.0])).unwrap();
    let options = Options { relative: 1e-2, ..Options::default() };
    let mut memory = Memory::new::<f64, 6>(256, 2048);
    let mut tracker = Tracker::new();
    let shifted = |x: f64| Rigid::new(body, SMatrix::identity(), v::<f64, 6>([x, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap();
    let exact = Options { relative: 2e-3, ..options };
    let first = memory.solver().solve_warm(&mut tracker, &shifted(0.0), &Ball::unit(), None, &exact);
    assert_eq!(first.outcome, Outcome::Converged);
    for tick in 1..=5 {
        let x = 1e-3 * f64::from(tick);
        let a =
            memory.solver().solve_warm(&mut tracker, &shifted(x), &Ball::unit(), Some(1e-3 * (1.0 + 1e-9)), &options);
        assert_eq!((a.outcome, a.plan), (Outcome::Converged, Plan::Warm), "{tick}");
        assert!(
            a.lower <= 1.0 - x && 1.0 - x <= a.upper && a.support_calls < 100,
            "{tick}: {} {} {}",
            a.lower,
            a.upper,
            a.support_calls
        );
    }
}

/// A caller who says that nothing moved when it did gets an upper bound that shows it, never a reversed bracket.
#[test]
fn a_false_bound_of_the_move_is_found_out() {
    let cube = BoxShape::new(v::<f64, 3>([1.0; 3])).unwrap();
    let mut memory = Memory::new::<f64, 3>(64, 128);
    let mut tracker = Tracker::new();
    let at = |x: f64| Rigid::new(cube, SMatrix::identity(), v::<f64, 3>([x, 0.0, 0.0])).unwrap();
    let options = Options::default();
    memory.solver().solve_warm(&mut tracker, &at(0.0), &Ball::unit(), None, &options);
    let a = memory.solver().solve_warm(&mut tracker, &at(0.5), &Ball::unit(), Some(0.0), &options);
    assert!(a.lower <= 0.5 && 0.5 <= a.upper, "{} {}", a.lower, a.upper);
    for moved in [f64::NAN, f64::INFINITY, -0.0, 1e300] {
        let mut tracker = tracker;
        let a = memory.solver().solve_warm(&mut tracker, &at(0.5), &Ball::unit(), Some(moved), &options);
        assert!(a.lower <= 0.5 && 0.5 <= a.upper, "{moved}");
    }
}

/// A set in the subspace of some columns of a rotation.
struct Embedded<S, const N: usize, const K: usize> {
    inner: S,
    basis: SMatrix<f64, N, K>,
}

impl<S: Support<f64, K>, const N: usize, const K: usize> Support<f64, N> for Embedded<S, N, K> {
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        Ok(self.basis * self.inner.support(&self.basis.tr_mul(u))?)
    }
    fn extent(&self) -> f64 {
        self.inner.extent() * 1.001
    }
}

fn flat<const N: usize, const K: usize>() {
    let mut dice = Dice::new(72);
    for turned in [false, true] {
        let r = dice.rotation::<N>();
        let basis =
            SMatrix::<f64, N, K>::from_fn(|i, j| if turned { r[i][j] } else { f64::from(u8::from(i == N - 1 - j)) });
        let half: [f64; K] = std::array::from_fn(|_| dice.range(0.5, 2.0));
        let least = half.iter().fold(f64::MAX, |m, &x| m.min(x));
        let set = Embedded { inner: BoxShape::new(v::<f64, K>(half)).unwrap(), basis };
        let mut memory = Memory::new::<f64, N>(128, 1024);
        let options = brisk();
        let mut check = |what: &str, q: &dyn UnitSet<f64, N>, d: f64| {
            let a = memory.solver::<f64, N>().solve_in_span(&set, q, &options);
            let s = Seen::from(&a);
            assert_eq!((a.outcome, a.dimension), (Outcome::Converged, K), "{what} {N} {K} {turned} {s:?}");
            assert!(s.lower <= d * (1.0 + 1e-12) && d * (1.0 - 1e-12) <= s.upper, "{what} {N} {K} {d} {s:?}");
            assert!((basis.tr_mul(&a.direction).norm() - 1.0).abs() < 1e-9, "the direction lies in the span");
            let whole = memory.solver::<f64, N>().solve(&set, q, &options);
            assert!(whole.lower <= 1e-12 && whole.upper >= 0.0, "{what}: in the whole space d is 0");
        };
        check("ball", &Ball::new(0.5).unwrap(), 2.0 * least);
        if !turned {
            check("box", &UnitBox::new(v::<f64, N>([0.5; N])).unwrap(), 2.0 * least);
            check("cross", &CrossPolytope::new(v::<f64, N>([0.5; N])).unwrap(), 2.0 * least);
        }
        // Along a diagonal of the box.
        let end: Vector<f64, N> = basis * v::<f64, K>(half);
        let a = memory.solver::<f64, N>().solve_in_span(&set, &Segment::new(end).unwrap(), &options);
        assert!((a.lower - 1.0).abs() < 1e-5 && (a.upper - 1.0).abs() < 1e-5, "{N} {K} {:?}", Seen::from(&a));
    }
}

#[test]
fn flat_sets_have_a_depth_in_their_span() {
    flat::<2, 1>();
    flat::<3, 1>();
    flat::<3, 2>();
    flat::<4, 3>();
    flat::<6, 1>();
    flat::<6, 2>();
    flat::<6, 3>();
    flat::<6, 4>();
    flat::<6, 5>();
}

/// A line that ends at the origin, as the wrenches of one contact without friction do: d is 0, along the line.
#[test]
fn a_line_that_ends_at_the_origin() {
    let mut dice = Dice::new(73);
    let mut memory = Memory::new::<f64, 6>(64, 256);
    for round in 0..60 {
        let axis = match round % 3 {
            0 => v([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            _ => Vector::<f64, 6>::from(dice.direction::<6>()),
        };
        let far = axis * dice.decade(-3.0, 3.0);
        let ends = [[0.0; 6], far.into()];
        let line = Points::new(&ends).unwrap();
        let q: Box<dyn UnitSet<f64, 6>> = match round % 2 {
            0 => Box::new(Ball::new(0.5).unwrap()),
            _ => Box::new(UnitBox::new(v([0.5; 6])).unwrap()),
        };
        let a = memory.solver::<f64, 6>().solve_in_span(&line, q.as_ref(), &brisk());
        assert_eq!((a.outcome, a.dimension), (Outcome::Touching, 1), "{far} {:?}", Seen::from(&a));
        assert!(a.lower <= 0.0 && 0.0 <= a.upper && a.upper - a.lower < 1e-11 * far.norm(), "{:?}", Seen::from(&a));
        assert!((a.direction + axis).norm() < 1e-12, "{} is not against {axis}", a.direction);
        // Beside the origin it is as far away as ever.
        let ends = [far.into(), (far * 2.0).into()];
        let a = memory.solver::<f64, 6>().solve_in_span(&Points::new(&ends).unwrap(), q.as_ref(), &brisk());
        assert!(a.outcome == Outcome::Separated && a.lower < 0.0, "{:?}", Seen::from(&a));
    }
}

#[test]
fn what_spans_the_space_is_solved_there() {
    let cube = BoxShape::new(v::<f64, 4>([1.0, 2.0, 3.0, 4.0])).unwrap();
    let mut memory = Memory::new::<f64, 4>(64, 256);
    let a = memory.solver::<f64, 4>().solve_in_span(&cube, &Ball::unit(), &Options::default());
    assert_eq!((a.outcome, a.dimension), (Outcome::Converged, 4));
    // A flat set beside the origin is as far away as ever.
    let plate = Rigid::new(
        BoxShape::new(v::<f64, 4>([1.0, 1.0, 1.0, 0.0])).unwrap(),
        SMatrix::identity(),
        v([0.0, 0.0, 0.0, 2.0]),
    );
    let a = memory.solver::<f64, 4>().solve_in_span(&plate.unwrap(), &Ball::unit(), &Options::default());
    assert_eq!(a.outcome, Outcome::Separated);
    assert!(a.lower <= -2.0 && -2.0 <= a.upper);
}

/// A cube whose fifth corner is what a careless caller made of it.
struct Corners(f64);

impl UnitSet<f64, 3> for Corners {
    fn value(&self, u: &Vector<f64, 3>) -> Result<f64, Failure> {
        Ok(u.abs().sum())
    }
    fn vertex_count(&self) -> usize {
        9
    }
    fn vertex(&self, index: usize) -> Vector<f64, 3> {
        match index {
            8 => Vector::zeros(), // the origin may be listed
            5 => Vector::from([-1.0, 1.0, -self.0]),
            _ => Vector::from_fn(|i, _| if index >> i & 1 == 1 { -1.0 } else { 1.0 }),
        }
    }
    fn error(&self) -> f64 {
        1e-15
    }
}

/// Of a set that does not know its extent, too.
#[test]
fn rays_refuse_what_is_not_a_point() {
    struct Plain;
    impl Support<f64, 3> for Plain {
        fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
            Ok(u.map(|x| 2f64.copysign(x)))
        }
    }
    // No room for expansion.
    let mut memory = Memory::new::<f64, 3>(4, 6);
    let a = memory.solver::<f64, 3>().solve(&Plain, &Corners(1.0), &Options::default());
    assert_eq!((a.outcome, a.plan), (Outcome::Converged, Plan::Rays));
    assert!(a.lower <= 2.0 && 2.0 <= a.upper && a.upper - a.lower < 1e-5);
    for bad in [f64::NAN, f64::INFINITY] {
        let a = memory.solver::<f64, 3>().solve(&Plain, &Corners(bad), &Options::default());
        assert_eq!((a.outcome, a.failure), (Outcome::SupportFailed, Some(Failure(qdist::NOT_FINITE))));
        assert!(a.lower <= 2.0 && 2.0 <= a.upper);
    }
    // A finite number that leaves the range of the arithmetic.
    let a = memory.solver::<f64, 3>().solve(&Plain, &Corners(1e308), &Options::default());
    assert!(a.lower.is_finite() && a.lower <= a.upper, "{:?} {} {}", a.plan, a.lower, a.upper);
}

/// The axes of a thin set are known as well as its points are, over its width; Q out of its plane makes that count.
#[test]
fn a_subspace_found_from_a_thin_set_is_not_taken_for_exact() {
    let mut dice = Dice::new(73);
    for width in [1e-2, 1e-4, 1e-6] {
        for _ in 0..50 {
            let r = dice.rotation::<3>();
            let basis = SMatrix::<f64, 3, 2>::from_fn(|i, j| r[i][j]);
            let set = Embedded { inner: BoxShape::new(v::<f64, 2>([1.0, width])).unwrap(), basis };
            // Its projection ends where the box does.
            let end = Vector::<f64, 3>::from_fn(|i, _| r[i][1] * width + r[i][2] * 10.0);
            let mut memory = Memory::new::<f64, 3>(64, 128);
            let options = Options { relative: 1e-9, ..Options::default() };
            let a = memory.solver::<f64, 3>().solve_in_span(&set, &Segment::new(end).unwrap(), &options);
            assert!(a.lower <= 1.0 && 1.0 <= a.upper, "{width} [{:e}, {:e}] + 1", a.lower - 1.0, a.upper - 1.0);
        }
    }
}

/// The change of d as the set moves along x, by the envelope theorem and by differences.
#[test]
fn the_gradient_holds_for_any_unit_and_for_warm_answers() {
    let body = Ellipsoid::new(v::<f64, 3>([1.0, 1.5, 2.0])).unwrap();
    let at = |x: f64| Rigid::new(body, SMatrix::identity(), v::<f64, 3>([x, 0.2, -0.1])).unwrap();
    let unit = UnitEllipsoid::new(v::<f64, 3>([0.5, 1.0, 0.7]), SMatrix::identity()).unwrap();
    let options = Options { relative: 1e-9, ..Options::default() };
    let mut memory = Memory::new::<f64, 3>(2048, 4096);
    let along = |_: &Vector<f64, 3>| v::<f64, 3>([1.0, 0.0, 0.0]);
    for q in [&unit as &dyn UnitSet<f64, 3>, &Ball::unit()] {
        let h = 1e-3;
        let mut d = |x: f64| memory.solver::<f64, 3>().solve(&at(x), q, &options).upper;
        let slope = (d(0.3 + h) - d(0.3 - h)) / (2.0 * h);
        let answer = memory.solver::<f64, 3>().solve(&at(0.3), q, &options);
        assert!((answer.derivative(along) - slope).abs() < 1e-3, "{} {slope}", answer.derivative(along));
        let mut tracker = Tracker::new();
        tracker.remember(&answer);
        let loose = Options { relative: 1e-2, ..Options::default() };
        let warm = memory.solver::<f64, 3>().solve_warm(&mut tracker, &at(0.3), q, Some(0.0), &loose);
        assert_eq!(warm.plan, Plan::Warm);
        assert!((warm.derivative(along) - slope).abs() < 1e-2, "{} {slope}", warm.derivative(along));
    }
}
