//! Support functions that take shortcuts and are wrong about it, and support functions that say what cannot be: every point comes with the
//! witness of the same call, every number is checked, every call is counted.

use crate::common;

use std::cell::Cell;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use common::dd::{Dd, V3, v3};
use common::dice::Dice;
use common::hull::{ExactHull, signed_depth};
use common::memory::Memory;
use nalgebra::{Matrix3, Vector3};
use qdist::qset::{Ball, Segment, UnitBox, UnitSet};
use qdist::support::{BoxShape, Difference, Failure, Margin, Rigid, Scaled, Sum, Support};
use qdist::{Body, NOT_FINITE, Options, Outcome, Real, Tracker, Vector};

/// What a shortcut does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sabotage {
    /// Sees every other vertex.
    Even,
    /// Falls short by 1 %.
    Short,
    /// Breaks ties the other way.
    Ties,
    /// Sees one vertex, which depends on the direction in no sensible way.
    Wild,
    /// Sees the first vertex only.
    Blind,
}

const SABOTAGES: [Sabotage; 5] = [Sabotage::Even, Sabotage::Short, Sabotage::Ties, Sabotage::Wild, Sabotage::Blind];

/// The hull of points around the origin, with a shortcut that is none.
struct Sabotaged<T: Real> {
    points: Vec<Vector<T, 3>>,
    sabotage: Sabotage,
    /// Does it know its extent?
    known: bool,
    calls: AtomicU32,
}

impl<T: Real> Sabotaged<T> {
    fn new(points: &[[f64; 3]], sabotage: Sabotage, known: bool) -> Self {
        let points = points.iter().map(|p| Vector::from(p.map(T::of))).collect();
        Self { points, sabotage, known, calls: AtomicU32::new(0) }
    }

    fn farthest(&self, u: &Vector<T, 3>) -> Vector<T, 3> {
        self.calls.fetch_add(1, Relaxed);
        self.points.iter().fold(self.points[0], |best, p| if p.dot(u) > best.dot(u) { *p } else { best })
    }
}

impl<T: Real> Support<T, 3> for Sabotaged<T> {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let exact = self.farthest(u);
        Ok(match self.sabotage {
            Sabotage::Even => {
                let first = self.points[0];
                self.points.iter().step_by(2).fold(first, |best, p| if p.dot(u) > best.dot(u) { *p } else { best })
            }
            Sabotage::Short => {
                let middle = self.points.iter().sum::<Vector<T, 3>>() / T::count(self.points.len());
                exact + (middle - exact) * T::of(0.01)
            }
            Sabotage::Ties => self.points.iter().fold(exact, |best, p| if p.dot(u) >= best.dot(u) { *p } else { best }),
            Sabotage::Wild => self.points[(u[0].to_f64() * 1e6).abs() as usize % self.points.len()],
            Sabotage::Blind => self.points[0],
        })
    }
    fn exhaustive(&self, u: &Vector<T, 3>) -> Result<(Vector<T, 3>, Vector<T, 3>), Failure> {
        let p = self.farthest(u);
        Ok((p, p))
    }
    fn has_shortcuts(&self) -> bool {
        true
    }
    fn extent(&self) -> T {
        if self.known {
            self.points.iter().fold(T::zero(), |m, p| m.max(p.norm())) * T::of(1.000_01)
        } else {
            T::zero()
        }
    }
}

fn cube(half: [f64; 3]) -> Vec<[f64; 3]> {
    (0..8).map(|i| std::array::from_fn(|k| if i >> k & 1 == 0 { -half[k] } else { half[k] })).collect()
}

/// Points around the origin.
fn cloud(dice: &mut Dice, count: usize) -> Vec<[f64; 3]> {
    (0..count).map(|_| dice.direction::<3>().map(|x| x * dice.range(0.7, 1.0))).collect()
}

fn shape(dice: &mut Dice) -> Vec<[f64; 3]> {
    match dice.below(3) {
        0 => cube([0.5; 3]),
        1 => cube([dice.range(0.2, 1.0), dice.range(0.2, 1.0), dice.range(0.2, 1.0)]),
        _ => {
            let count = 6 + dice.below(20);
            cloud(dice, count)
        }
    }
}

/// The points in the world, as exact numbers, for a rotation and translation that are numbers of `T`.
fn placed<T: Real>(points: &[Vector<T, 3>], rotation: &Matrix3<T>, translation: &Vector3<T>) -> Vec<V3> {
    let at = |p: &Vector<T, 3>, i: usize| {
        (0..3).fold(Dd::new(translation[i].to_f64()), |sum, j| {
            sum + Dd::product(rotation[(i, j)].to_f64(), p[j].to_f64())
        })
    };
    points.iter().map(|p| std::array::from_fn(|i| at(p, i))).collect()
}

/// How far a point is outside of a hull; 0 inside.
fn outside(hull: &ExactHull, p: [f64; 3]) -> f64 {
    (-signed_depth(&ExactHull::new(&[v3(p)]), hull).depth.to_f64()).max(0.0)
}

fn plain<T: Real>(v: &Vector<T, 3>) -> [f64; 3] {
    [v[0].to_f64(), v[1].to_f64(), v[2].to_f64()]
}

/// A pair with its exact depth: bracket, witnesses and counts of `depth` and of `solve` are right.
fn right<T: Real>(a: &Sabotaged<T>, b: &Sabotaged<T>, turns: [Matrix3<T>; 2], at: [Vector3<T>; 2], what: &str) {
    let exact_a = ExactHull::new(&placed(&a.points, &turns[0], &at[0]));
    let exact_b = ExactHull::new(&placed(&b.points, &turns[1], &at[1]));
    let truth = signed_depth(&exact_a, &exact_b).depth.to_f64();
    let (near, options) = (if T::ROUNDOFF < T::of(1e-10) { 1e-9 } else { 1e-4 }, Options::default());
    let mut memory = Memory::new::<T, 3>(128, 256);

    let bodies = [Body::new(a, turns[0], at[0]).unwrap(), Body::new(b, turns[1], at[1]).unwrap()];
    a.calls.store(0, Relaxed);
    b.calls.store(0, Relaxed);
    let r = memory.solver::<T, 3>().depth(&bodies[0], &bodies[1], &options);
    assert_eq!(r.support_calls, a.calls.load(Relaxed).max(b.calls.load(Relaxed)), "{what}: calls");
    let (lower, upper) = (r.lower.to_f64(), r.upper.to_f64());
    assert!(lower <= truth && truth <= upper, "{what}: {truth} is not in [{lower}, {upper}]");
    assert!(upper - lower <= 1e-5 + 10.0 * near, "{what}: {truth}, {r:?}");
    let (pa, pb) = (plain(&r.point_a), plain(&r.point_b));
    let off = [outside(&exact_a, pa), outside(&exact_b, pb)];
    assert!(off[0] <= near && off[1] <= near, "{what}: witnesses are off by {off:?}");
    let apart = Vector3::from(pa) - Vector3::from(pb);
    let sideways = (apart - Vector3::from(plain(&r.normal)) * truth).norm();
    assert!((apart.norm() - truth.abs()).abs() <= 1e-4 && sideways <= 0.02, "{what}: {apart} for {truth}, {sideways}");

    // The same as a set made of sets.
    let (moved_a, moved_b) = (Rigid::new(a, turns[0], at[0]).unwrap(), Rigid::new(b, turns[1], at[1]).unwrap());
    let difference = Difference::new(moved_a, Scaled::new(moved_b, T::one()).unwrap());
    a.calls.store(0, Relaxed);
    b.calls.store(0, Relaxed);
    let r = memory.solver::<T, 3>().solve(&difference, &Ball::unit(), &options);
    assert_eq!(
        (r.support_calls, a.calls.load(Relaxed)),
        (a.calls.load(Relaxed), b.calls.load(Relaxed)),
        "{what}: calls"
    );
    assert!(r.lower.to_f64() <= truth && truth <= r.upper.to_f64(), "{what}: solve");
    for corner in r.witness.corners() {
        let on_a = corner.vertex.witness;
        let off = [outside(&exact_a, plain(&on_a)), outside(&exact_b, plain(&(on_a - corner.vertex.point)))];
        assert!(off[0] <= near && off[1] <= near, "{what}: witnesses of the set are off by {off:?}");
    }
}

#[test]
fn a_cube_whose_shortcut_sees_its_even_vertices_only() {
    fn run<T: Real>() {
        let one = Matrix3::identity();
        let at = [Vector3::zeros(), Vector3::new(T::of(1.5), T::zero(), T::zero())];
        for sabotage in SABOTAGES {
            for known in [true, false] {
                let a = Sabotaged::<T>::new(&cube([1.0; 3]), sabotage, known);
                let b = Sabotaged::<T>::new(&cube([1.0; 3]), Sabotage::Even, true);
                right(&a, &b, [one, one], at, &format!("{sabotage:?}"));
                right(&b, &a, [one, one], at, &format!("{sabotage:?}, swapped"));
            }
        }
    }
    run::<f64>();
    run::<f32>();
}

#[test]
fn sabotaged_shortcuts_in_random_poses() {
    fn run<T: Real>(seed: u64) {
        let mut dice = Dice::new(seed);
        for case in 0..400 {
            let [first, second] = [dice.pick(&SABOTAGES), dice.pick(&SABOTAGES)];
            let a = Sabotaged::<T>::new(&shape(&mut dice), first, dice.chance(0.5));
            let b = Sabotaged::<T>::new(&shape(&mut dice), second, dice.chance(0.5));
            let turn = |dice: &mut Dice| {
                let r = if dice.chance(0.3) {
                    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                } else {
                    dice.rotation()
                };
                Matrix3::from_fn(|i, j| T::of(r[i][j]))
            };
            let turns = [turn(&mut dice), turn(&mut dice)];
            let far = dice.range(0.05, 2.5);
            let at = [[0.0; 3], dice.direction::<3>().map(|x| x * far)].map(|t| Vector3::from(t.map(T::of)));
            right(&a, &b, turns, at, &format!("case {case}, {first:?} {second:?}"));
        }
    }
    run::<f64>(1);
    run::<f32>(2);
}

/// The one that is reported beside the best direction is asked without shortcuts too.
#[test]
fn a_rival_that_only_a_shortcut_sees() {
    // A slab 2 x 2 x 3 whose shortcut sees nothing of its third dimension: its ends are no minimisers.
    struct Slab;
    impl Support<f64, 3> for Slab {
        fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
            BoxShape::new(Vector::from([1.0, 4.0, 1.0])).unwrap().support(u)
        }
        fn exhaustive(&self, u: &Vector<f64, 3>) -> Result<(Vector<f64, 3>, Vector<f64, 3>), Failure> {
            BoxShape::new(Vector::from([1.0, 4.0, 3.0])).unwrap().support_with_witness(u)
        }
        fn has_shortcuts(&self) -> bool {
            true
        }
        fn extent(&self) -> f64 {
            6.0
        }
    }
    let mut memory = Memory::new::<f64, 3>(64, 128);
    for guess in [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.2, 1.0], [-1.0, 0.1, 0.0]] {
        let options = Options { guess: Some(Vector::from(guess)), ..Options::default() };
        let r = memory.solver::<f64, 3>().solve(&Slab, &Ball::unit(), &options);
        assert!(r.lower <= 1.0 && r.upper >= 1.0 && r.upper < 1.001, "{:?} {} {}", r.outcome, r.lower, r.upper);
        if let Some(rival) = r.rival {
            let (p, _) = Slab.exhaustive(&rival).unwrap();
            assert!(p.dot(&rival) <= 1.001, "{rival}");
        }
    }
}

/// A box that says one thing wrong.
#[derive(Clone, Copy, Debug)]
struct Liar {
    lie: Lie,
    number: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Point,
    Witness,
    Radius,
    Extent,
    Error,
    Center,
    Spread,
}

impl Support<f64, 3> for Liar {
    fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        let mut p = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap().support(u)?;
        if self.lie == Lie::Point {
            p[1] = self.number;
        }
        Ok(p)
    }
    fn support_with_witness(&self, u: &Vector<f64, 3>) -> Result<(Vector<f64, 3>, Vector<f64, 3>), Failure> {
        let p = self.support(u)?;
        let number = if self.lie == Lie::Witness { self.number } else { p[2] };
        Ok((p, Vector::from([p[0], p[1], number])))
    }
    fn radius(&self) -> f64 {
        if self.lie == Lie::Radius { self.number } else { 0.0 }
    }
    fn extent(&self) -> f64 {
        if self.lie == Lie::Extent { self.number } else { 2.0 }
    }
    fn error(&self) -> f64 {
        if self.lie == Lie::Error { self.number } else { 1e-14 }
    }
    fn center(&self) -> Option<(Vector<f64, 3>, f64)> {
        match self.lie {
            Lie::Center => Some((Vector::from([0.0, self.number, 0.0]), 2.0)),
            Lie::Spread => Some((Vector::from([0.1, 0.0, 0.0]), self.number)),
            _ => None,
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let mut memory = Memory::new::<f64, 3>(64, 128);
    let options = Options::default();
    let honest = Margin::new(BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap(), 0.5).unwrap();
    let known = Scaled::new(&honest, 3.0).unwrap();
    for lie in [Lie::Point, Lie::Witness, Lie::Radius, Lie::Extent, Lie::Error, Lie::Center, Lie::Spread] {
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.25] {
            if number == -0.25 && matches!(lie, Lie::Point | Lie::Witness | Lie::Center) {
                continue;
            }
            let liar = Liar { lie, number };
            let what = format!("{liar:?}");
            // As a body, on either side of a sound one. (A body's witness is its point.)
            if lie != Lie::Witness {
                let (a, b) = (Body::at(&liar, Vector::zeros()), Body::at(&honest, Vector::from([1.0, 0.2, 0.3])));
                for (a, b) in [(&a, &b), (&b, &a), (&a, &a)] {
                    let r = memory.solver::<f64, 3>().depth(a, b, &options);
                    assert_eq!((r.outcome, r.failure), (Outcome::SupportFailed, Some(Failure(NOT_FINITE))), "{what}");
                    let numbers = [r.lower, r.upper].into_iter().chain(r.normal.iter().copied());
                    let points = r.point_a.iter().chain(r.point_b.iter()).copied();
                    assert!(numbers.chain(points).all(f64::is_finite) && r.lower <= r.upper, "{what}: {r:?}");
                }
            }
            // As a set, alone and as a part of others.
            if matches!(lie, Lie::Center | Lie::Spread) {
                continue;
            }
            let turned = Rigid::new(liar, Matrix3::identity(), Vector::from([0.1, 0.0, 0.0])).unwrap();
            let sets: [&(dyn Support<f64, 3> + Sync); 6] = [
                &liar,
                &Margin::new(liar, 1.0).unwrap(),
                &Sum::new(liar, &known),
                &Difference::new(&known, liar),
                &turned,
                &Scaled::new(liar, 2.0).unwrap(),
            ];
            for (i, set) in sets.into_iter().enumerate() {
                // Where only the point counts, a witness is not asked for; where a part's extent is no length, that of the whole is not known.
                let hidden = lie == Lie::Witness && i > 1 || lie == Lie::Extent && matches!(i, 2..=4);
                for unit in
                    [&Ball::unit() as &dyn UnitSet<f64, 3>, &UnitBox::new(Vector::from([1.0, 2.0, 3.0])).unwrap()]
                {
                    let r = memory.solver::<f64, 3>().solve(set, unit, &options);
                    let refused = (r.outcome, r.failure) == (Outcome::SupportFailed, Some(Failure(NOT_FINITE)));
                    assert!(refused || hidden, "{what}, set {i}: {:?} [{}, {}]", r.outcome, r.lower, r.upper);
                    let numbers = [r.lower, r.upper, r.unit].into_iter().chain(r.direction.iter().copied());
                    let mut points =
                        r.witness.corners().iter().flat_map(|c| c.vertex.point.iter().chain(c.vertex.witness.iter()));
                    assert!(numbers.chain(r.support.iter().copied()).all(f64::is_finite), "{what}, set {i}");
                    assert!(r.lower <= r.upper && points.all(|x| x.is_finite()), "{what}, set {i}");
                }
            }
        }
    }
}

#[test]
fn units_that_cannot_be_are_refused() {
    struct Odd(Lie, f64);
    impl UnitSet<f64, 3> for Odd {
        fn value(&self, u: &Vector<f64, 3>) -> Result<f64, Failure> {
            Ok(if self.0 == Lie::Point && u[0] > 0.9 { self.1 } else { u.norm() })
        }
        fn inner_radius(&self) -> f64 {
            if self.0 == Lie::Radius { self.1 } else { 0.5 }
        }
        fn ball_radius(&self) -> Option<f64> {
            (self.0 == Lie::Extent).then_some(self.1)
        }
        fn error(&self) -> f64 {
            if self.0 == Lie::Error { self.1 } else { 1e-15 }
        }
    }
    let set = BoxShape::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
    let mut memory = Memory::new::<f64, 3>(64, 128);
    for lie in [Lie::Point, Lie::Radius, Lie::Extent, Lie::Error] {
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.25] {
            let q = Odd(lie, number);
            let r = memory.solver::<f64, 3>().solve(&set, &q, &Options::default());
            assert_eq!((r.outcome, r.failure), (Outcome::SupportFailed, Some(Failure(NOT_FINITE))), "{lie:?} {number}");
            assert!(r.lower <= 1.0 && r.upper >= 1.0, "{lie:?} {number}");
            // A loop that remembers does not believe it either.
            if lie == Lie::Radius {
                let tracker = Tracker { lower: Some(1.0), ..Tracker::<f64, 3>::new() };
                assert_eq!(tracker.lower_after(0.5, &q), None, "{number}");
            }
        }
    }
}

/// Points of a flat set are counted in its own subspace and in the search for that.
#[test]
fn calls_in_subspaces_are_counted() {
    struct Counted<'a>(&'a Cell<u32>, Vector<f64, 3>);
    impl Support<f64, 3> for Counted<'_> {
        fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
            self.0.set(self.0.get() + 1);
            BoxShape::new(self.1).unwrap().support(u)
        }
        fn extent(&self) -> f64 {
            self.1.norm() * 1.001
        }
    }
    let mut memory = Memory::new::<f64, 3>(64, 128);
    for half in [[1.0, 2.0, 3.0], [1.0, 2.0, 0.0], [0.0, 2.0, 0.0], [0.0; 3]] {
        let calls = Cell::new(0);
        let r = memory.solver::<f64, 3>().solve_in_span(
            &Counted(&calls, Vector::from(half)),
            &Ball::unit(),
            &Options::default(),
        );
        assert_eq!(r.support_calls, calls.get(), "{half:?}");
    }
}

/// Rays that a shortcut cuts off at the origin have shown nothing: the query was given up, [0, 100] for d = 2.2.
#[test]
fn a_shortcut_that_ends_at_the_origin() {
    struct Cut<'a>(&'a BoxShape<f64, 4>);
    impl Support<f64, 4> for Cut<'_> {
        fn support(&self, u: &Vector<f64, 4>) -> Result<Vector<f64, 4>, Failure> {
            let p = self.0.support(u)?;
            Ok(Vector::from([p[0].min(0.0), p[1], p[2], p[3]]))
        }
        fn exhaustive(&self, u: &Vector<f64, 4>) -> Result<(Vector<f64, 4>, Vector<f64, 4>), Failure> {
            let p = self.0.support(u)?;
            Ok((p, p))
        }
        fn has_shortcuts(&self) -> bool {
            true
        }
        fn extent(&self) -> f64 {
            self.0.extent()
        }
        fn contains_origin(&self) -> bool {
            true
        }
    }
    let half = [1.0, 1.1, 1.2, 1.3];
    let whole = BoxShape::new(Vector::from(half)).unwrap();
    let mut dice = Dice::new(61);
    for case in 0..100 {
        let least = if case % 2 == 0 { 0.0 } else { -1.0 };
        let end = if case == 0 { [0.01, 0.5, 0.3, 0.1] } else { [0; 4].map(|_| dice.range(least, 1.0)) };
        let d = half.iter().zip(end).map(|(h, x)| h / x.abs()).fold(f64::MAX, f64::min);
        let q = Segment::new(Vector::from(end)).unwrap();
        for mut memory in [Memory::new::<f64, 4>(64, 1024), Memory::least::<f64, 4>()] {
            let answer = memory.solver::<f64, 4>().solve(&Cut(&whole), &q, &Options::default());
            assert!(answer.lower <= d * (1.0 + 1e-15) && d <= answer.upper * (1.0 + 1e-15), "{case} {d}: {answer:?}");
            assert_eq!(answer.outcome, Outcome::Converged, "{case} {d}: {answer:?}");
        }
    }
}
