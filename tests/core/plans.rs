//! The plans that a query may take: which one is taken, and that each is true. Closed forms in 2 to 6 dimensions, both
//! scalar types: rays for polytopal Q, cones in any memory, budgets of any kind, gradients.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen, broken_promise};
use nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, UnitSetFn, Vertices};
use qdist::support::{BoxShape, Ellipsoid, Failure, Linear, Margin, Points, Rigid, Support};
use qdist::{Answer, Options, Outcome, Plan, Real, Vector};
use qdist::{Layout, WorkspaceError, place};
use std::cell::Cell;

type Matrix<const N: usize> = SMatrix<f64, N, N>;

fn vector<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::MAX, f64::min)
}

/// The least singular value, by inverse iteration.
fn least_singular_value<const N: usize>(m: &Matrix<N>) -> f64 {
    let inverse = m.try_inverse().unwrap();
    let square = inverse * inverse.transpose();
    let mut v = Vector::<f64, N>::from_fn(|i, _| 1.0 + 0.1 * i as f64);
    for _ in 0..5000 {
        let next = square * v;
        v = next / next.norm();
    }
    1.0 / v.dot(&(square * v)).sqrt()
}

fn options<T: Real, const N: usize>(relative: f64, limit: impl Into<Option<u32>>) -> Options<'static, T, N> {
    Options { relative: T::of(relative), max_iterations: limit.into(), ..Options::default() }
}

/// A round set given point by point, its ball term unknown: an ellipsoid R D B + t, h = |D R^T u| + t.u.
#[derive(Clone)]
struct Round<const N: usize> {
    semi: [f64; N],
    turn: [[f64; N]; N],
    at: [f64; N],
    /// Says so when it is its own mirror image.
    tells: bool,
}

impl<const N: usize> Round<N> {
    fn aligned(semi: [f64; N]) -> Self {
        let turn = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
        Round { semi, turn, at: [0.0; N], tells: false }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Round<N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let m = SMatrix::<T, N, N>::from_fn(|i, j| T::of(self.turn[i][j] * self.semi[j]));
        let inner = m.tr_mul(u);
        let length = inner.dot(&inner).root();
        let point = if length > T::zero() { m * (inner * (T::one() / length)) } else { Vector::zeros() };
        Ok(point + vector::<T, N>(self.at))
    }
    fn extent(&self) -> T {
        let most = self.semi.iter().fold(0.0f64, |m, &x| m.max(x));
        T::of((most + self.at.iter().map(|x| x * x).sum::<f64>().sqrt()) * 1.001)
    }
    fn mirrored(&self, _: u8) -> bool {
        self.tells
    }
}

/// Two soft fingers on the x axis (Table I of the paper): h = sum of max(0, h_i).
#[derive(Clone, Copy)]
struct TwoFingers {
    /// Says which changes of sign leave it as it is: y, z and the moment about x together or apart.
    tells: bool,
}

impl<T: Real> Support<T, 6> for TwoFingers {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        let mu = T::of(0.2);
        let mut sum = Vector::<T, 6>::zeros();
        for (x, s) in [(-0.75, 1.0), (1.3, -1.0)] {
            let (x, s) = (T::of(x), T::of(s));
            // Force (s, 0, 0), (0, 1, 0), (0, 0, 1) at (x, 0, 0), and the moment (s, 0, 0).
            let g = [s * u[0], u[1] + x * u[5], u[2] - x * u[4], s * u[3]];
            let length = (g[1] * g[1] + g[2] * g[2] + g[3] * g[3]).root() * mu;
            if g[0] + length > T::zero() {
                let share = if length > T::zero() { mu * mu / length } else { T::zero() };
                let f = [T::one(), g[1] * share, g[2] * share, g[3] * share];
                sum += Vector::from([s * f[0], f[1], f[2], s * f[3], -(x * f[2]), x * f[1]]);
            }
        }
        Ok(sum)
    }
    fn extent(&self) -> T {
        T::of(3.0)
    }
    fn mirrored(&self, signs: u8) -> bool {
        // y with the moment about z, z with that about y, the moment about x alone.
        let same = |i: u8, j: u8| signs >> i & 1 == signs >> j & 1;
        self.tells && signs & 1 == 0 && same(1, 5) && same(2, 4)
    }
}

fn a1() -> f64 {
    0.41 / (0.1681f64 + 1.69 + 1.0).sqrt()
}

fn a2() -> f64 {
    0.41 / (4.0 * 0.1681f64 + 1.69 + 1.0).sqrt()
}

/// One query, with what every answer promises, the truth if it is known, and sane counts.
fn solve<T: Real, const N: usize>(
    what: &str,
    set: &dyn Support<T, N>,
    unit: &dyn UnitSet<T, N>,
    options: &Options<'_, T, N>,
    (vertices, facets): (usize, usize),
    d: f64,
) -> Answer<T, N> {
    let mut memory = Memory::new::<T, N>(vertices, facets);
    let answer = memory.solver::<T, N>().solve(set, unit, options);
    check(what, &answer, options, (vertices, facets), d);
    answer
}

fn check<T: Real, const N: usize>(
    what: &str,
    answer: &Answer<T, N>,
    options: &Options<'_, T, N>,
    (vertices, facets): (usize, usize),
    d: f64,
) {
    let seen = Seen::from(answer);
    let tell = || {
        let (plan, cones, splits) = (answer.plan, answer.cones, answer.splits);
        let u = T::ROUNDOFF.to_f64();
        format!(
            "{what}, N = {N}, u = {u:.0e}, {vertices} vertices, {facets} facets, {options:?}: d = {d:e}, {seen:?} \
             {plan:?}, {cones} cones, {splits} splits"
        )
    };
    assert_eq!(broken_promise(&seen, options, vertices, facets), None, "{}", tell());
    assert!(seen.outcome != Outcome::SupportFailed, "{}", tell());
    if !d.is_nan() {
        let blur = 1e-14 * d.abs();
        assert!(seen.lower <= d + blur && d - blur <= seen.upper, "the bracket is false: {}", tell());
    }
    assert!(answer.splits <= 192, "{}", tell());
    if answer.plan != Plan::Cones {
        assert!(answer.cones == 0 && answer.splits == 0, "{}", tell());
    } else {
        assert!(answer.vertices <= vertices && answer.facets > 0, "{}", tell());
    }
}

// Which plan.

fn choice<T: Real, const N: usize>() {
    let ones = vector::<T, N>([1.0; N]);
    let large = (256, 4096);
    let o = options::<T, N>(1e-2, 3000);
    let cube = BoxShape::new(vector::<T, N>([1.0; N])).unwrap();
    let corner: [T; N] = std::array::from_fn(|i| T::of(if i == 0 { 1.0 } else { 0.5 }));
    let corners = [corner, corner.map(|x| -x)];
    let polytopal: [(&dyn UnitSet<T, N>, f64); 4] = [
        (&UnitBox::new(ones).unwrap(), 1.0),
        (&CrossPolytope::new(ones).unwrap(), 1.0),
        (&Segment::new(Vector::from(corner)).unwrap(), 1.0),
        (&Vertices::new(&corners).unwrap(), 1.0),
    ];
    for (q, d) in polytopal {
        // The cheaper one of two; and where expansion has no memory, rays need none.
        for size in [large, (N + 1, 2 * N)] {
            let answer = solve("cube", &cube, q, &o, size, d);
            assert!(matches!(answer.plan, Plan::Rays | Plan::Expansion), "{:?}", answer.plan);
            assert_eq!(answer.outcome, Outcome::Converged);
        }
    }
    let cubic = UnitBox::new(ones).unwrap();
    assert_eq!(solve("cube", &cube, &cubic, &o, (N + 1, 2 * N), 1.0).plan, Plan::Rays);
    if N == 6 {
        // Round sets take thousands of facets there.
        let answer = solve("ball", &Round::aligned([1.0; N]), &cubic, &options(1e-4, None), large, 6f64.sqrt().recip());
        assert_eq!((answer.plan, answer.outcome), (Plan::Rays, Outcome::Converged));
    }
    let stretched = UnitEllipsoid::new(vector::<T, N>([0.5; N]), SMatrix::identity()).unwrap();
    let unknown =
        UnitSetFn::new(|u: &Vector<T, N>| Ok(u.iter().fold(T::zero(), |s, x| s + x.abs())), T::ROUNDOFF * T::count(9))
            .unwrap();
    for (q, d) in [(&Ball::unit() as &dyn UnitSet<T, N>, 1.0), (&stretched, 2.0), (&unknown, 1.0)] {
        let answer = solve("cube", &cube, q, &o, large, d);
        assert_eq!((answer.plan, answer.outcome), (Plan::Expansion, Outcome::Converged), "{:?}", Seen::from(&answer));
    }
    // Shallow: the core does not reach the origin, the ball around it does.
    let t: [f64; N] = std::array::from_fn(|i| if i == 0 { 1.25 } else { 0.125 });
    let moved = Rigid::new(cube, SMatrix::identity(), vector::<T, N>(t)).unwrap();
    let grown = Margin::new(moved, T::of(0.5)).unwrap();
    let answer = solve("grown cube", &grown, &Ball::unit(), &o, large, 0.25);
    assert_eq!((answer.plan, answer.outcome), (Plan::Distance, Outcome::Converged));
    // Overflow: cones where there is room for their start, else Capacity.
    let round = Round::aligned([1.0; N]);
    let d = exact::<T>(1.0);
    let o = options::<T, N>([0.1, 0.1, 0.1, 0.1, 0.5, 1.0, 2.0][N], 200_000);
    let (v, f) = (3 * N, 4 * N);
    let answer = solve("ball", &round, &Ball::unit(), &o, (v, f), d);
    if N > 2 {
        assert_eq!(answer.plan, Plan::Cones);
        assert!(answer.cones >= 1 << N, "{}", answer.cones);
    }
    assert_eq!(answer.outcome, Outcome::Converged, "{:?}", Seen::from(&answer));
    let o = options::<T, N>(1e-3, None);
    for size in [(3 * N - 1, 8 * N), (4 * N, 4 * N - 1), (N + 1, 2 * N)] {
        let answer = solve("ball", &round, &Ball::unit(), &o, size, d);
        assert_eq!((answer.plan, answer.outcome), (Plan::Expansion, Outcome::Capacity), "{size:?}");
    }
    let answer = {
        let mut memory = Memory::new::<T, N>(v, f);
        memory.solver::<T, N>().solve_by_expansion(&round, &Ball::unit(), &o)
    };
    check("ball", &answer, &o, (v, f), d);
    assert_eq!((answer.plan, answer.outcome), (Plan::Expansion, Outcome::Capacity));
    // Below the least layout there is no solver.
    for (v, f) in [(N, 2 * N), (N + 1, 2 * N - 1), (0, 0)] {
        assert_eq!(Layout::new::<T, N>(v, f), Err(WorkspaceError::Capacity));
        assert_eq!(place::<T, N>(&mut [], v, f).err(), Some(WorkspaceError::Capacity));
    }
}

every_type_and_dimension!(the_plan_is_chosen_by_the_query, choice);

// Cones.

/// Rows a1 and a2 of Table I at capacities from the least, with and without known symmetry.
fn table_one<T: Real>(sizes: &[(usize, f64)]) {
    let mut semi = [1.0; 6];
    semi[0] = 2.0;
    let ellipsoid = UnitEllipsoid::new(vector::<T, 6>(semi), SMatrix::identity()).unwrap();
    for &(facets, relative) in sizes {
        let size = ((facets / 4).max(18), facets);
        for (what, q, d) in [("a1", &Ball::unit() as &dyn UnitSet<T, 6>, a1()), ("a2", &ellipsoid, a2())] {
            let run = |tells: bool| solve(what, &TwoFingers { tells }, q, &options(relative, 2_000_000), size, d);
            let (with, without) = (run(true), run(false));
            for answer in [&with, &without] {
                assert_eq!(answer.outcome, Outcome::Converged, "{what} {facets} {:?}", Seen::from(answer));
                assert_eq!(answer.plan, Plan::Cones, "{what} {facets}");
            }
            assert!(without.cones >= 64 && with.cones >= 8 && with.cones < without.cones);
        }
    }
}

#[test]
fn table_one_by_cones_in_f64() {
    table_one::<f64>(&[(24, 0.2), (48, 0.1), (200, 0.03), (512, 1e-2), (2048, 1e-3)]);
}

#[test]
fn table_one_by_cones_in_f32() {
    table_one::<f32>(&[(24, 0.2), (64, 0.1), (512, 1e-2), (2048, 1e-3)]);
}

/// Random round and angular sets whose d is known, in frames without mirror symmetry; Q a ball or an ellipsoid, that sees the
/// set as one of other semi axes.
fn turned_sets<T: Real, const N: usize>() {
    let mut dice = Dice::new(51);
    for round in 0..4 {
        let turn = dice.rotation::<N>().map(|row| row.map(exact::<T>));
        let semi: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0)));
        let m = Matrix::<N>::from_fn(|i, j| exact::<T>(turn[i][j] * semi[j]));
        // The least singular value, beyond that the matrix is orthonormal to rounding only.
        let d = least_singular_value(&m);
        let set = Round { semi, turn, at: [0.0; N], tells: false };
        let cuboid = BoxShape::new(vector::<T, N>(semi)).unwrap();
        let matrix = SMatrix::<T, N, N>::from_fn(|i, j| T::of(turn[i][j]));
        let inverse = Matrix::<N>::from_fn(|i, j| turn[i][j]).try_inverse().unwrap();
        let at: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.range(-0.1, 0.1)));
        let from = inverse * Vector::<f64, N>::from(at);
        let boxed = Linear::new(cuboid, matrix, vector::<T, N>(at)).unwrap();
        let room = |i: usize| (semi[i] - from[i].abs()) / inverse.row(i).norm();
        let relative = [0.0, 0.0, 1e-3, 1e-2, 0.05, 0.2, 0.3][N];
        let relative = if relative == 0.0 { 1e-4 } else { relative };
        for facets in [4 * N, 6 * N, 24 * N, 100 * N] {
            let size = (3 * N + facets / 4, facets);
            let o = options::<T, N>(relative, None);
            let tell = format!("turned ellipsoid {round}");
            let answer = solve(&tell, &set, &Ball::<T>::unit(), &o, size, d);
            assert_eq!(answer.outcome, Outcome::Converged, "{tell} {size:?} {:?}", Seen::from(&answer));
            let tell = format!("turned box {round}");
            let answer = solve(&tell, &boxed, &Ball::unit(), &o, size, least((0..N).map(room)));
            assert_eq!(answer.outcome, Outcome::Converged, "{tell} {size:?} {:?}", Seen::from(&answer));
            // Seen by Q with the same axes: R D B in units of R G B.
            let g: [f64; N] = std::array::from_fn(|i| exact::<T>(0.4 + 0.3 * i as f64));
            let q = UnitEllipsoid::new(vector::<T, N>(g), matrix).unwrap();
            let tell = format!("turned ellipsoid in ellipsoid {round}");
            let d = least((0..N).map(|i| semi[i] / g[i]));
            let o = options::<T, N>(relative.max(0.02), None);
            let mut memory = Memory::new::<T, N>(size.0, size.1);
            let answer = memory.solver::<T, N>().solve(&set, &q, &o);
            check(&tell, &answer, &o, size, f64::NAN);
            let blur = 64.0 * T::ROUNDOFF.to_f64() * d; // of an orthonormal matrix
            let seen = Seen::from(&answer);
            assert!(seen.lower <= d + blur && d - blur <= seen.upper, "{tell} {size:?} {d} {seen:?}");
            assert_eq!(answer.outcome, Outcome::Converged, "{tell} {size:?} {seen:?}");
        }
    }
}
every_type_and_dimension!(turned_sets_converge_in_any_memory, turned_sets);

/// The unit ball point by point, its worst case; the mirrored one must agree.
fn unit_ball<T: Real, const N: usize>(relative: f64) {
    for facets in [4 * N, 5 * N, 8 * N, 32 * N, 512] {
        let size = (3 * N + facets / 3, facets);
        for tells in [true, false] {
            let set = Round { tells, ..Round::aligned([1.0; N]) };
            let answer = solve("unit ball", &set, &Ball::unit(), &options::<T, N>(relative, None), size, 1.0);
            assert_eq!(answer.outcome, Outcome::Converged, "{size:?} {:?}", Seen::from(&answer));
        }
    }
}

#[test]
fn the_unit_ball_by_points() {
    unit_ball::<f64, 2>(1e-5);
    unit_ball::<f64, 3>(3e-3);
    unit_ball::<f64, 4>(0.05);
    unit_ball::<f32, 2>(1e-4);
    unit_ball::<f32, 3>(3e-3);
    unit_ball::<f32, 4>(0.05);
}

/// Moved: the nearest point of the boundary along an axis, where the curvature says that it is the nearest.
fn moved_balls<T: Real, const N: usize>() {
    let mut dice = Dice::new(52);
    for _ in 0..6 {
        let far = dice.pick(&[0.5, 0.9, 0.999, 1.0 - 1e-9]);
        let at = dice.direction::<N>().map(|x| exact::<T>(x * far));
        let length = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let set = Round { at, ..Round::aligned([1.0; N]) };
        let size = (64, 16 * N);
        let o = Options { absolute: T::of(0.02), ..options::<T, N>(0.0, None) };
        let mut memory = Memory::new::<T, N>(size.0, size.1);
        let answer = memory.solver::<T, N>().solve(&set, &Ball::unit(), &o);
        let seen = Seen::from(&answer);
        check("moved ball", &answer, &o, size, f64::NAN);
        let blur = 1e-15;
        let d = 1.0 - length;
        assert!(seen.lower <= d + blur && d - blur <= seen.upper, "{d:e} {seen:?}");
        assert!(seen.upper - seen.lower <= 0.021, "{N} {far} {d:e} {seen:?}");
    }
}
every_type_and_dimension!(balls_moved_almost_away, moved_balls);

// Budgets.

/// Sets by which all plans are met, with their d.
#[allow(clippy::type_complexity)]
fn problems<T: Real, const N: usize>() -> Vec<(&'static str, Box<dyn Support<T, N>>, Box<dyn UnitSet<T, N>>, f64)> {
    let mut semi = [1.0; N];
    semi[N - 1] = 0.5;
    let turn = Dice::new(53).rotation::<N>().map(|row| row.map(exact::<T>));
    let round = Round { turn, semi, at: [0.0; N], tells: false };
    let d = least_singular_value(&Matrix::<N>::from_fn(|i, j| exact::<T>(turn[i][j] * semi[j])));
    let cube = BoxShape::new(vector::<T, N>([1.0; N])).unwrap();
    let matrix = SMatrix::<T, N, N>::from_fn(|i, j| T::of(turn[i][j]));
    let inverse = Matrix::<N>::from_fn(|i, j| turn[i][j]).try_inverse().unwrap();
    let boxed = Linear::new(cube, matrix, Vector::zeros()).unwrap();
    let shallow: [f64; N] = std::array::from_fn(|i| if i == 0 { 1.125 } else { 0.25 });
    let beside = Rigid::new(cube, SMatrix::identity(), vector::<T, N>(shallow)).unwrap();
    let grown = Margin::new(beside, T::of(0.25)).unwrap();
    // The farthest vertex of Q in the box's frame: the ray of each leaves at 1 / |R^-1 v|_max.
    let rays = (0..1usize << N).map(|k| {
        let v = Vector::<f64, N>::from_fn(|i, _| if k >> i & 1 == 1 { -0.5 } else { 0.5 });
        1.0 / (inverse * v).amax()
    });
    vec![
        ("round", Box::new(round.clone()), Box::new(Ball::unit()), d),
        ("box", Box::new(boxed), Box::new(Ball::unit()), least((0..N).map(|i| 1.0 / inverse.row(i).norm()))),
        ("box in box", Box::new(boxed), Box::new(UnitBox::new(vector::<T, N>([0.5; N])).unwrap()), least(rays)),
        ("grown", Box::new(grown), Box::new(Ball::unit()), 0.125),
        ("aside", Box::new(beside), Box::new(Ball::unit()), -0.125),
        ("aside, box", Box::new(beside), Box::new(UnitBox::new(vector::<T, N>([0.5; N])).unwrap()), -0.125),
    ]
}

/// Iterations one by one, and the same as interrupts: true, never worse, and the same.
fn budgets<T: Real, const N: usize>() {
    let mut dice = Dice::new(54);
    for (name, set, unit, d) in problems::<T, N>() {
        for size in [(3 * N, 4 * N), (40, 60), (200, 800)] {
            let mut best = (f64::MIN, f64::MAX);
            let mut limit = 0;
            while limit < 1500 {
                limit += 1 + dice.below(1 + limit as usize / 2) as u32;
                let relative = 1e-4;
                let o = options::<T, N>(relative, limit);
                let answer = solve(name, &*set, &*unit, &o, size, d);
                let seen = Seen::from(&answer);
                let rounding = 4096.0 * T::ROUNDOFF.to_f64() * N as f64;
                assert!(
                    seen.lower >= best.0 - rounding && (d < 0.0 || seen.upper <= best.1 + rounding),
                    "{name} {size:?} got worse at {limit}: {best:?} {seen:?}"
                );
                best = (best.0.max(seen.lower), best.1.min(seen.upper));
                let asked = Cell::new(0u32);
                let stop = || {
                    asked.set(asked.get() + 1);
                    asked.get() > limit
                };
                let mut memory = Memory::new::<T, N>(size.0, size.1);
                let free = Options { interrupt: Some(&stop), ..options::<T, N>(relative, None) };
                let cut = memory.solver::<T, N>().solve(&*set, &*unit, &free);
                check(name, &cut, &free, size, d);
                let wanted = if answer.outcome == Outcome::Iterations { Outcome::Interrupted } else { answer.outcome };
                assert_eq!(
                    (cut.outcome, cut.lower, cut.upper, cut.plan),
                    (wanted, answer.lower, answer.upper, answer.plan),
                    "{name} {size:?} {limit}: {seen:?}"
                );
                if !matches!(answer.outcome, Outcome::Iterations) {
                    break;
                }
            }
            assert!(best.0 <= d + 1e-12 && best.1 >= d - 1e-12);
        }
    }
}
every_type_and_dimension!(budgets_and_interrupts_of_any_length, budgets);

/// Random capacities, tolerances, thresholds and limits; what is concluded is true.
fn odds<T: Real, const N: usize>() {
    let mut dice = Dice::new(55);
    for (name, set, unit, d) in problems::<T, N>() {
        for _ in 0..40 {
            let size = (N + 1 + dice.below(80), 2 * N + dice.below(300));
            let mut o = options::<T, N>(dice.decade(-5.0, 0.0), 1 + dice.decade(0.0, 3.3) as u32);
            if dice.chance(0.6) {
                let near = dice.pick(&[0.0, 1e-12, 1e-6, 1e-3, 0.05, 0.5, 3.0]) * dice.pick(&[1.0, -1.0]);
                o.threshold = Some(T::of(d + near));
            }
            let answer = solve(name, &*set, &*unit, &o, size, d);
            let Some(threshold) = o.threshold.map(T::to_f64) else {
                assert!(!matches!(answer.outcome, Outcome::Above | Outcome::Below));
                continue;
            };
            match answer.outcome {
                Outcome::Above => assert!(d + 1e-14 >= threshold, "{name} {threshold}"),
                Outcome::Below => assert!(d - 1e-14 < threshold, "{name} {threshold}"),
                _ => {}
            }
            // One that is far away is decided whatever the memory, given enough iterations.
            if o.max_iterations > Some(800) && size.0 >= 3 * N && size.1 >= 4 * N && threshold < d - 0.7 * d.abs() {
                assert_eq!(answer.outcome, Outcome::Above, "{name} {size:?} {o:?} {:?}", Seen::from(&answer));
            }
            if o.max_iterations > Some(800) && threshold > d + 1.0 && d > 0.0 {
                assert_eq!(answer.outcome, Outcome::Below, "{name} {size:?} {o:?} {:?}", Seen::from(&answer));
            }
        }
    }
}
every_type_and_dimension!(any_capacity_threshold_and_limit, odds);

// Rays.

/// What of A is left along a ray from the origin, in closed form; the numbers are those of T.
enum Body<const N: usize> {
    Box([f64; N]),
    Cross,
    Simplex,
    Ball,
}

/// t v leaves M body + at (with the origin inside) at this t.
fn crossing<const N: usize>(body: &Body<N>, m: &Matrix<N>, at: &Vector<f64, N>, v: &Vector<f64, N>) -> f64 {
    let inverse = m.try_inverse().unwrap();
    let (from, along) = (-(inverse * at), inverse * v);
    match body {
        Body::Box(h) => {
            least((0..N).map(|i| {
                if along[i] == 0.0 { f64::MAX } else { (h[i] - from[i] * along[i].signum()) / along[i].abs() }
            }))
        }
        // |from + t along|_1 = 1: one plane per orthant.
        Body::Cross => least((0..1usize << N).map(|k| {
            let sign = |i: usize| if k >> i & 1 == 1 { -1.0 } else { 1.0 };
            let (a, b) = (0..N).fold((1.0, 0.0), |(a, b), i| (a - sign(i) * from[i], b + sign(i) * along[i]));
            if b > 0.0 { a / b } else { f64::MAX }
        })),
        // x_i >= -1 and sum x <= 1.
        Body::Simplex => {
            let sides = (0..N).map(|i| if along[i] < 0.0 { (1.0 + from[i]) / -along[i] } else { f64::MAX });
            let sum = along.sum();
            let top = if sum > 0.0 { (1.0 - from.sum()) / sum } else { f64::MAX };
            least(sides.chain([top]))
        }
        Body::Ball => {
            let (a, b, c) = (along.dot(&along), from.dot(&along), from.dot(&from) - 1.0);
            let root = (b * b - a * c).sqrt();
            if b > 0.0 { -c / (b + root) } else { (root - b) / a }
        }
    }
}

/// Calls with the body as a set.
fn with_body<T: Real, const N: usize, R>(
    body: &Body<N>,
    m: &Matrix<N>,
    at: &Vector<f64, N>,
    f: impl FnOnce(&dyn Support<T, N>) -> R,
) -> R {
    let matrix = m.map(T::of);
    let at = at.map(T::of);
    let mut points: Vec<[T; N]> = Vec::new();
    match body {
        Body::Box(h) => return f(&Linear::new(BoxShape::new(vector::<T, N>(*h)).unwrap(), matrix, at).unwrap()),
        Body::Ball => {
            return f(&Linear::new(Ellipsoid::new(vector::<T, N>([1.0; N])).unwrap(), matrix, at).unwrap());
        }
        Body::Cross => {
            for i in 0..N {
                for s in [1.0, -1.0] {
                    points.push(std::array::from_fn(|j| T::of(if i == j { s } else { 0.0 })));
                }
            }
        }
        Body::Simplex => {
            // Corner k: all x_i = -1 but one, which makes the sum 1.
            points.push([T::of(-1.0); N]);
            for k in 0..N {
                points.push(std::array::from_fn(|j| T::of(if j == k { N as f64 } else { -1.0 })));
            }
        }
    }
    f(&Linear::new(Points::new(&points).unwrap(), matrix, at).unwrap())
}

/// A set of points as the vertices of Q, in one of the ways to say so.
fn with_unit<T: Real, const N: usize, R>(
    kind: usize,
    dice: &mut Dice,
    scale: f64,
    f: impl FnOnce(&dyn UnitSet<T, N>, &[Vector<f64, N>], &'static str) -> R,
) -> R {
    let mut sizes: [f64; N] = std::array::from_fn(|_| exact::<T>(scale * dice.range(0.5, 2.0)));
    let axis = |i: usize, x: f64| Vector::<f64, N>::from_fn(|j, _| if i == j { x } else { 0.0 });
    if kind % 2 == 1 {
        sizes[dice.below(N)] = 0.0; // flat
    }
    match kind {
        0 | 1 => {
            let corner = |k: usize| Vector::from_fn(|i, _| if k >> i & 1 == 1 { -sizes[i] } else { sizes[i] });
            f(&UnitBox::new(vector(sizes)).unwrap(), &(0..1 << N).map(corner).collect::<Vec<_>>(), "box")
        }
        2 | 3 => {
            let ends = (0..N).flat_map(|i| [axis(i, sizes[i]), axis(i, -sizes[i])]);
            let ends: Vec<_> = ends.filter(|v| v.amax() > 0.0).collect();
            f(&CrossPolytope::new(vector(sizes)).unwrap(), &ends, "cross")
        }
        4 => {
            let end: [f64; N] = dice.direction::<N>().map(|x| exact::<T>(x * scale));
            f(&Segment::new(vector(end)).unwrap(), &[Vector::from(end)], "segment")
        }
        5 => {
            let end: [f64; N] = dice.direction::<N>().map(|x| exact::<T>(x * scale));
            let ends = [end.map(T::of), end.map(|x| T::of(-x))];
            f(&Vertices::new(&ends).unwrap(), &[Vector::from(end), -Vector::from(end)], "two-sided segment")
        }
        _ => {
            // Any points: often the origin is a vertex of Q, or outside of their hull.
            let count = 1 + dice.below(2 * N + 2);
            let list: Vec<[f64; N]> =
                (0..count).map(|_| dice.direction::<N>().map(|x| exact::<T>(x * scale))).collect();
            let typed: Vec<[T; N]> = list.iter().map(|p| p.map(T::of)).collect();
            let all: Vec<Vector<f64, N>> = list.into_iter().map(Vector::from).collect();
            f(&Vertices::new(&typed).unwrap(), &all, "points")
        }
    }
}

fn rays<T: Real, const N: usize>() {
    let mut dice = Dice::new(56);
    let mut by_rays = [0; 2];
    for round in 0..150 {
        let body = match round % 4 {
            0 => Body::Box(std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0)))),
            1 => Body::Cross,
            2 => Body::Simplex,
            _ => Body::Ball,
        };
        let scale = dice.pick(&[1.0, 1.0, 1e-6, 1e-3, 1e3, 1e6]);
        let r = dice.rotation::<N>();
        let m = Matrix::<N>::from_fn(|i, j| exact::<T>(scale * (r[i][j] + 0.05 * dice.signed())));
        let shift = dice.direction::<N>();
        let at = Vector::<f64, N>::from_fn(|i, _| exact::<T>(scale * 0.15 / (N as f64).sqrt() * shift[i]));
        let unit = scale * dice.pick(&[1.0, 1.0, 1e-6, 1e-3, 1e3, 1e6]);
        with_unit::<T, N, _>(round % 9, &mut dice, unit, |q, ends, name| {
            let d = least(ends.iter().map(|v| crossing(&body, &m, &at, v)));
            let o = Options { relative: T::RELATIVE_TOLERANCE, ..Options::default() };
            let tell = format!("{name} in body {}, round {round}, scale {scale:e}, unit {unit:e}", round % 4);
            with_body::<T, N, _>(&body, &m, &at, |set| {
                let blur = 1e-13 * d;
                // In the least memory there are only rays.
                for size in [(N + 1, 2 * N), (64, 512)] {
                    let mut memory = Memory::new::<T, N>(size.0, size.1);
                    let answer = memory.solver::<T, N>().solve(set, q, &o);
                    let seen = Seen::from(&answer);
                    by_rays[usize::from(size.0 == 64)] += usize::from(answer.plan == Plan::Rays);
                    assert_eq!(broken_promise(&seen, &o, size.0, size.1), None, "{tell} {seen:?}");
                    assert!(seen.lower <= d + blur && d - blur <= seen.upper, "{tell}: d = {d:e} {seen:?}");
                    // Rounding: a flat Q asks A itself for a margin, and in f32 expansion may have the better one.
                    let fine = T::ROUNDOFF.to_f64() < 1e-10;
                    if fine {
                        assert_eq!(answer.outcome, Outcome::Converged, "{tell} d = {d:e} {seen:?}");
                    } else if size.0 == 64 {
                        assert!(seen.upper - seen.lower <= 3e-3 * d, "{tell} d = {d:e} {seen:?}");
                    }
                }
                let mut memory = Memory::new::<T, N>(64, 512);
                let o = options::<T, N>(1e-3, 200);
                let expanded = memory.solver::<T, N>().solve_by_expansion(set, q, &o);
                let other = Seen::from(&expanded);
                assert_eq!(expanded.plan, Plan::Expansion);
                assert!(other.lower <= d + blur && d - blur <= other.upper, "{tell}: d = {d:e} {other:?}");
            });
        });
    }
    // (In f32 what rays lose to rounding is often left to expansion.)
    let fine = T::ROUNDOFF.to_f64() < 1e-10;
    assert!(!fine || by_rays[0] >= 60 && by_rays[1] < 150, "{by_rays:?}");
}
every_type_and_dimension!(rays_against_closed_forms, rays);

/// Where rays decide nothing: outside, on the boundary, flat.
fn beside<T: Real, const N: usize>() {
    let mut dice = Dice::new(57);
    let size = (64, 512);
    let mut memory = Memory::new::<T, N>(size.0, size.1);
    for round in 0..63 {
        let h: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0)));
        let gap = dice.pick(&[0.0, 1e-9, -1e-9, 1e-3, 1.0, 1e3]);
        let mut at: [f64; N] = std::array::from_fn(|i| exact::<T>(dice.range(-0.4, 0.4) * h[i]));
        at[0] = exact::<T>(h[0] + gap);
        let cuboid = BoxShape::new(vector::<T, N>(h)).unwrap();
        let set = Rigid::new(cuboid, SMatrix::identity(), vector::<T, N>(at)).unwrap();
        let gap = at[0] - h[0];
        let unit = dice.pick(&[1.0, 1e-6, 1e6]);
        with_unit::<T, N, _>(round % 9, &mut dice, unit, |q, ends, name| {
            // (N = 2: the flat Q may be the point 0.)
            let low = |v: &Vector<f64, N>| {
                least((0..N).map(|i| match v[i] {
                    x if x > 0.0 => (at[i] + h[i]) / x,
                    x if x < 0.0 => (at[i] - h[i]) / x,
                    _ => f64::MAX,
                }))
            };
            let d = if gap > 0.0 { -gap } else { least(ends.iter().map(low)) };
            let o = options::<T, N>(1e-3, 500);
            let answer = memory.solver::<T, N>().solve(&set, q, &o);
            let seen = Seen::from(&answer);
            let tell = format!("{name} beside, round {round}, gap {gap:e}, unit {unit:e}: d = {d:e} {seen:?}");
            assert_eq!(broken_promise(&seen, &o, size.0, size.1), None, "{tell}");
            let blur = 1e-14 * d.abs();
            assert!(seen.lower <= d + blur && d - blur <= seen.upper, "{tell}");
            if gap > 0.1 {
                assert_eq!(answer.outcome, Outcome::Separated, "{tell}");
                assert!(seen.upper - seen.lower <= 1.1e-3 * gap, "{tell}");
            }
        });
    }
}
every_type_and_dimension!(rays_from_outside_and_from_the_boundary, beside);

/// A flat A with the origin in it: nothing of full dimension fits in, but a Q in its plane may.
fn flat<T: Real, const N: usize>() {
    let mut dice = Dice::new(58);
    let size = (64, 512);
    let mut memory = Memory::new::<T, N>(size.0, size.1);
    for round in 0..45 {
        let mut h: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0)));
        h[dice.below(N)] = 0.0;
        let turn = dice.rotation::<N>();
        let matrix =
            SMatrix::<T, N, N>::from_fn(
                |i, j| if round < 20 { T::count(usize::from(i == j)) } else { T::of(turn[i][j]) },
            );
        let set = Linear::new(BoxShape::new(vector::<T, N>(h)).unwrap(), matrix, Vector::zeros()).unwrap();
        with_unit::<T, N, _>(round % 9, &mut dice, 1.0, |q, ends, name| {
            let inside =
                |v: &Vector<f64, N>| least((0..N).map(|i| if v[i] == 0.0 { f64::MAX } else { h[i] / v[i].abs() }));
            let d = if round < 20 { least(ends.iter().map(inside)) } else { 0.0 };
            let o = options::<T, N>(1e-3, 500);
            let answer = memory.solver::<T, N>().solve(&set, q, &o);
            let seen = Seen::from(&answer);
            let tell = format!("{name} in flat, round {round}: d = {d:e} {seen:?} {:?}", answer.plan);
            assert_eq!(broken_promise(&seen, &o, size.0, size.1), None, "{tell}");
            assert!(seen.lower <= d + 1e-14 && d - 1e-14 <= seen.upper, "{tell}");
            assert!(seen.lower >= -1e-4, "{tell}");
        });
    }
}
every_type_and_dimension!(flat_sets, flat);

/// Random hulls, where no closed form is at hand: the rays and the expansion of a Q that does not tell its vertices agree.
fn agreement<const N: usize>() {
    let mut dice = Dice::new(59);
    let size = (300, 6000);
    let mut memory = Memory::new::<f64, N>(size.0, size.1);
    let mut closed = 0;
    for round in 0..27 {
        let points: Vec<[f64; N]> = (0..2 * N + 2 + dice.below(20)).map(|_| dice.direction::<N>()).collect();
        let set = Points::new(&points).unwrap();
        with_unit::<f64, N, _>(round % 9, &mut dice, 1.0, |q, _, name| {
            let o = options::<f64, N>(1e-6, None);
            // In the least memory there are only rays, but where the first simplex is enough.
            let by_rays = Memory::new::<f64, N>(N + 1, 2 * N).solver::<f64, N>().solve(&set, q, &o);
            let silent = UnitSetFn::new(|u: &Vector<f64, N>| q.value(u), q.error()).unwrap();
            let few = options::<f64, N>(1e-6, 600);
            let expanded = memory.solver::<f64, N>().solve(&set, &silent, &few);
            let (a, b) = (Seen::from(&by_rays), Seen::from(&expanded));
            let tell = format!("{name}, N = {N}, round {round}: {a:?} {:?} {b:?} {:?}", by_rays.plan, expanded.plan);
            for (s, o) in [(a, &o), (b, &few)] {
                assert_eq!(broken_promise(&s, o, size.0, size.1), None, "{tell}");
            }
            assert!(a.lower <= b.upper && b.lower <= a.upper, "{tell}");
            if a.upper > 1e-3 {
                assert_eq!(a.outcome, Outcome::Converged, "{tell}");
                closed += usize::from(by_rays.plan == Plan::Rays);
            }
        });
    }
    assert!(closed >= 8, "{closed}");
}

#[test]
fn rays_and_expansion_agree() {
    agreement::<2>();
    agreement::<3>();
    agreement::<4>();
    agreement::<5>();
    agreement::<6>();
}

// Gradients.

/// d of an ellipsoid is its least semi axis; of a moved box the least distance to a side.
#[test]
fn derivatives_of_closed_forms() {
    let size = (200, 2000);
    // 1 with respect to the least semi axis, 0 to the others.
    let semi = [1.5, 0.5, 1.0];
    let set = Round::aligned(semi);
    let o = options::<f64, 3>(1e-8, None);
    let answer = solve("ellipsoid", &set, &Ball::unit(), &o, size, 0.5);
    for axis in 0..3 {
        // The point x of the ellipsoid moves by x_i / s_i along e_i.
        let by = answer.derivative(|x| Vector::from_fn(|i, _| if i == axis { x[i] / semi[i] } else { 0.0 }));
        assert!((by - f64::from(axis == 1)).abs() < 2e-3, "{axis} {by}");
    }
    // Two directions, of course.
    let rival = answer.rival.expect("both ends of the short axis");
    assert!(rival.dot(&answer.direction) < -0.99, "{rival}");

    let cube = BoxShape::new(Vector::from([1.0; 4])).unwrap();
    let at = [0.1, -0.3, 0.05, 0.2];
    let moved = Rigid::new(cube, SMatrix::identity(), Vector::from(at)).unwrap();
    let answer = solve("moved box", &moved, &Ball::unit(), &options(1e-9, None), size, 0.7);
    assert!(answer.rival.is_none());
    for axis in 0..4 {
        let by = answer.derivative(|_| Vector::from_fn(|i, _| f64::from(i == axis)));
        assert!((by - f64::from(axis == 1)).abs() < 1e-6, "{axis} {by}");
    }
    // In units of Q: rays.
    let q = UnitBox::new(Vector::from([2.0; 4])).unwrap();
    let answer = solve("moved box", &moved, &q, &options(1e-9, None), size, 0.35);
    let by = answer.derivative(|_| Vector::from([0.0, 1.0, 0.0, 0.0]));
    assert!((by - 0.5).abs() < 1e-6, "{by}");
    assert!((answer.direction.dot(&answer.support) / answer.unit - 0.35).abs() < 1e-9);
}

/// A moved ellipsoid, by central differences; the plan is expansion, then cones.
#[test]
fn derivatives_by_central_differences() {
    let mut dice = Dice::new(60);
    for round in 0..6 {
        let turn = dice.rotation::<3>();
        let semi = [1.2, 0.6, 0.9];
        let at = dice.direction::<3>().map(|x| 0.15 * x);
        let d = |at: [f64; 3], semi: [f64; 3], relative: f64, facets: usize| {
            let set = Round { semi, turn, at, tells: false };
            let size = (facets / 2, facets);
            let o = options::<f64, 3>(relative, None);
            let answer = solve("moved ellipsoid", &set, &Ball::unit(), &o, size, f64::NAN);
            assert_eq!(answer.outcome, Outcome::Converged, "{:?}", Seen::from(&answer));
            answer
        };
        let middle = |a: &Answer<f64, 3>| 0.5 * (a.lower + a.upper);
        for (facets, relative, tolerance) in [(4000, 1e-9, 1e-3), (60, 1e-5, 2e-2)] {
            let answer = d(at, semi, relative, facets);
            assert_eq!(answer.plan == Plan::Cones, facets == 60);
            assert!(answer.rival.is_none(), "{round}");
            let step = 1e-3;
            for axis in 0..3 {
                let moved = |s: f64| std::array::from_fn(|i| at[i] + if i == axis { s * step } else { 0.0 });
                let grown = |s: f64| std::array::from_fn(|i| semi[i] + if i == axis { s * step } else { 0.0 });
                let shift = (middle(&d(moved(1.0), semi, 1e-9, 4000)) - middle(&d(moved(-1.0), semi, 1e-9, 4000)))
                    / (2.0 * step);
                let by = answer.derivative(|_| Vector::from_fn(|i, _| f64::from(i == axis)));
                assert!((by - shift).abs() < tolerance, "{round} {facets} {axis}: {by} {shift}");
                let growth =
                    (middle(&d(at, grown(1.0), 1e-9, 4000)) - middle(&d(at, grown(-1.0), 1e-9, 4000))) / (2.0 * step);
                let column = Vector::<f64, 3>::from_fn(|i, _| turn[i][axis]);
                let by = answer.derivative(|x| column * (column.dot(&(x - Vector::from(at))) / semi[axis]));
                assert!((by - growth).abs() < tolerance, "{round} {facets} {axis}: {by} {growth}");
            }
        }
    }
}

/// The first row of the paper has several minimisers, and it is told.
#[test]
fn rivals_are_told_where_the_minimiser_is_not_unique() {
    let answer =
        solve("a1", &TwoFingers { tells: false }, &Ball::<f64>::unit(), &options(1e-3, None), (512, 2048), a1());
    let rival = answer.rival.expect("any rotation about the axis");
    let h = TwoFingers { tells: false }.support(&rival).unwrap().dot(&rival);
    assert!(h <= a1() * 1.003 && rival.dot(&answer.direction) < 0.99, "{h}");
}
