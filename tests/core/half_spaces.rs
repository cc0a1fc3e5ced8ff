//! Half spaces against every kind of body, in space and in the plane. The oracle is the definition, over all vertices and in
//! double-double: whatever the bracket loses, the oracle does not.

use crate::common;

use common::cases::{Placed, Shape};
use common::dd::{BLUR, Dd, dot, norm};
use common::dice::Dice;
use common::exact::body_value;
use common::memory::{Memory, Seen, broken_promise};
use nalgebra::SMatrix;
use qdist::support::{
    BoxShape, Capsule, Ellipsoid, Failure, HalfSpace, Join, Margin, Points, Rigid, Scaled, ShapeError, Sphere, Sum,
    Support,
};
use qdist::{Body, BodyError, Depth, NOT_FINITE, Options, Outcome, Real, UNBOUNDED, Vector};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

fn vector<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

fn matrix<T: Real, const N: usize>(rows: [[f64; N]; N]) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| T::of(rows[i][j]))
}

/// A pose in numbers of the scalar type.
#[derive(Clone, Copy, Debug)]
struct Pose<const N: usize> {
    rotation: [[f64; N]; N],
    translation: [f64; N],
}

impl<const N: usize> Pose<N> {
    fn identity() -> Self {
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
        Pose { rotation, translation: [0.0; N] }
    }

    fn random<T: Real>(dice: &mut Dice, far: f64) -> Self {
        let mut rotation = dice.rotation::<N>();
        let [a, b] = [rotation[0], rotation[1]];
        if N == 2 && a[0] * b[1] - a[1] * b[0] < 0.0 {
            rotation[1] = b.map(|x| -x);
        }
        if dice.chance(0.3) {
            rotation = Self::identity().rotation;
        }
        let translation = std::array::from_fn(|_| exact::<T>(far * dice.signed()));
        Pose { rotation: rotation.map(|row| row.map(exact::<T>)), translation }
    }

    fn turned(&self, x: &[f64; N]) -> [Dd; N] {
        std::array::from_fn(|i| (0..N).fold(Dd::from(0.0), |sum, j| sum + Dd::product(self.rotation[i][j], x[j])))
    }

    fn body<'a, T: Real>(&self, shape: &'a (dyn Support<T, N> + Sync)) -> Body<'a, T, N> {
        Body::new(shape, matrix(self.rotation), vector(self.translation)).unwrap()
    }
}

/// Depth of the hull of vertices, with a ball, in the half space: the largest of (c - w.y) / |w|.
fn truth<const N: usize>(
    (normal, offset, pose): (&[f64; N], f64, &Pose<N>),
    (vertices, ball, placed): (&[[f64; N]], f64, &Pose<N>),
) -> Dd {
    let w = pose.turned(normal);
    let height = |x: &[f64; N]| {
        let x = placed.turned(x);
        let y: [Dd; N] =
            std::array::from_fn(|i| x[i] + Dd::from(placed.translation[i]) - Dd::from(pose.translation[i]));
        (Dd::from(offset) - dot(&w, &y)) / norm(&w)
    };
    vertices.iter().map(height).reduce(Dd::max).unwrap() + Dd::from(ball)
}

/// No memory is needed: the least that there is.
fn depth<T: Real, const N: usize>(
    a: &Body<'_, T, N>,
    b: &Body<'_, T, N>,
    options: &Options<'_, T, N>,
    ask: impl Fn(&mut Memory, &Body<'_, T, N>, &Body<'_, T, N>, &Options<'_, T, N>) -> Depth<T, N>,
) -> Depth<T, N> {
    let mut memory = Memory::least::<T, N>();
    let r = ask(&mut memory, a, b, options);
    assert_eq!(broken_promise(&Seen::from(&r), options, 0, 0), None, "{r:?}");
    r
}

macro_rules! asks {
    ($dimension:literal) => {
        |memory, a, b, options| memory.solver::<T, $dimension>().depth(a, b, options)
    };
}

/// A random body: its vertices and ball, and itself.
fn body<T: Real, const N: usize>(dice: &mut Dice, far: f64) -> (Vec<[f64; N]>, f64, Box<dyn Support<T, N> + Sync>) {
    let size = exact::<T>(dice.decade(-3.0, 2.0));
    let sizes: [f64; N] = std::array::from_fn(|_| exact::<T>(size * dice.unit()));
    match dice.below(4) {
        0 => (vec![[0.0; N]], size, Box::new(Sphere::<T, N>::new(T::of(size)).unwrap())),
        1 => {
            let corner = |signs: usize| std::array::from_fn(|i| if signs >> i & 1 == 0 { sizes[i] } else { -sizes[i] });
            ((0..1 << N).map(corner).collect(), 0.0, Box::new(BoxShape::<T, N>::new(vector(sizes)).unwrap()))
        }
        2 => {
            let end = |z: f64| std::array::from_fn(|i| if i == N - 1 { z } else { 0.0 });
            let capsule = Capsule::<T, N>::new(T::of(size), T::of(sizes[0])).unwrap();
            (vec![end(sizes[0]), end(-sizes[0])], size, Box::new(capsule))
        }
        _ => {
            let at = far * dice.signed();
            let vertices: Vec<[f64; N]> = (0..1 + dice.below(20))
                .map(|_| std::array::from_fn(|_| exact::<T>(at + size * dice.signed())))
                .collect();
            let list: Vec<[T; N]> = vertices.iter().map(|p| p.map(T::of)).collect();
            let points = Points::<T, N>::new(list.leak()).unwrap();
            (vertices, sizes[0], Box::new(Margin::new(points, T::of(sizes[0])).unwrap()))
        }
    }
}

fn random<T: Real, const N: usize>(
    seed: u64,
    ask: impl Fn(&mut Memory, &Body<'_, T, N>, &Body<'_, T, N>, &Options<'_, T, N>) -> Depth<T, N> + Copy,
) {
    let mut dice = Dice::new(seed);
    let u = T::ROUNDOFF.to_f64();
    for k in 0..2000 {
        let far = if dice.chance(0.3) { 0.0 } else { dice.decade(-1.0, 5.0) };
        let normal: [f64; N] = if dice.chance(0.3) {
            std::array::from_fn(|i| if i == N - 1 { 1.0 } else { 0.0 })
        } else {
            let length = dice.decade(-6.0, 6.0);
            dice.direction::<N>().map(|x| exact::<T>(x * length))
        };
        let (pose, placed) = (Pose::random::<T>(&mut dice, far), Pose::random::<T>(&mut dice, far));
        let (vertices, ball, shape) = body::<T, N>(&mut dice, far);
        // Half of the planes pass near the body.
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let near = truth((&normal, 0.0, &pose), (&vertices, ball, &placed)).to_f64() * length;
        let offset =
            exact::<T>(if dice.chance(0.5) { -near * (1.0 + 1e-3 * dice.signed()) } else { far * dice.signed() });
        let half_space = HalfSpace::<T, N>::new(vector(normal), T::of(offset)).unwrap();
        let (ground, a) = (pose.body(&half_space), placed.body(&*shape));
        let d = truth((&normal, offset, &pose), (&vertices, ball, &placed)).to_f64();
        let extent = vertices.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs())) * (N as f64).sqrt();
        let terms = 8.0 * (N as f64) * (extent + far) + offset.abs() / length;
        let what = format!("{k} {normal:?} {offset} {pose:?} {placed:?} {vertices:?} {ball} {d}");

        let r = depth(&a, &ground, &Options::default(), ask);
        let (lower, upper) = (r.lower.to_f64(), r.upper.to_f64());
        let blur = BLUR * terms + 1e-16 * d.abs();
        assert!(lower <= d + blur && d - blur <= upper, "{what} {r:?}");
        // A few roundoffs of depth and ball, the support function's own of the body's size, u^2 of the terms.
        let own = 100.0 * u * extent;
        let width = 64.0 * u * (d.abs() + ball) + own + 2000.0 * u * u * terms;
        assert!(upper - lower <= width, "{what} {width} {r:?}");
        // And those that measure a body that does not state its extent. A second one in two words where one is not enough.
        let measured = if shape.extent() > T::zero() { 0 } else { 2 * N as u32 };
        assert!(r.support_calls == 1 + measured || u > 1e-10 && r.support_calls == 2 + measured, "{what} {r:?}");
        let expected = if upper < 0.0 {
            Outcome::Separated
        } else if lower <= 0.0 {
            Outcome::Touching
        } else if upper - lower <= T::RELATIVE_TOLERANCE.to_f64() * lower {
            Outcome::Converged
        } else {
            Outcome::Precision
        };
        assert_eq!(r.outcome, expected, "{what} {r:?}");

        // Witnesses: depth * normal apart, that of B on the plane, up to the rounding of coordinates in the world.
        let coordinates = 64.0 * u * terms;
        for i in 0..N {
            let apart = (r.point_a[i] - r.point_b[i]).to_f64();
            assert!((apart - d * r.normal[i].to_f64()).abs() <= coordinates + width, "{what} {r:?}");
        }
        let w = pose.turned(&normal).map(Dd::to_f64);
        let height: f64 = (0..N).map(|i| w[i] * (r.point_b[i].to_f64() - pose.translation[i])).sum::<f64>() - offset;
        assert!(height.abs() <= (coordinates + width) * length, "{what} {r:?}");

        // The other way round: the same numbers, turned.
        let s = depth(&ground, &a, &Options::default(), ask);
        assert_eq!((s.lower, s.upper, s.outcome), (r.lower, r.upper, r.outcome));
        assert_eq!((s.normal, s.point_a, s.point_b), (-r.normal, r.point_b, r.point_a));

        let shift = 1e-2 * d.abs() + 2.0 * width;
        for (threshold, outcome) in [(d - shift, Outcome::Above), (d + shift, Outcome::Below)] {
            let options = Options { threshold: Some(T::of(threshold)), ..Options::default() };
            assert_eq!(depth(&a, &ground, &options, ask).outcome, outcome, "{what} {threshold}");
        }
    }
}

fn everywhere<T: Real>() {
    random::<T, 3>(21, asks!(3));
    random::<T, 2>(22, asks!(2));
}

#[test]
fn brackets_hold_and_are_tight_wherever_the_ground_is() {
    everywhere::<f64>();
    everywhere::<f32>();
}

/// A cube 1 mm deep in the ground, ten kilometres away, in single precision: the numbers' own roundoff decides and nothing else.
#[test]
fn a_foot_on_the_ground_far_away() {
    let ground = HalfSpace::<f32, 3>::new(vector([0.0, 0.0, 1.0]), 0.0).unwrap();
    let cube = BoxShape::<f32, 3>::new(vector([0.01, 0.01, 0.01])).unwrap();
    let z = 0.009f32;
    let d = f64::from(0.01f32) - f64::from(z);
    for far in [0.0f32, 1.0, 1e2, 1e4, 1e6] {
        let mut memory = Memory::least::<f32, 3>();
        let a = Body::at(&cube, Vector::from([far, -far, z]));
        let r = memory.solver::<f32, 3>().depth(&a, &Body::at(&ground, Vector::zeros()), &Options::default());
        assert!(f64::from(r.lower) <= d && d <= f64::from(r.upper), "{r:?}");
        assert!(r.outcome == Outcome::Converged && f64::from(r.upper - r.lower) <= 1e-5 * d, "{far}: {r:?}");
    }
}

fn opposite<T: Real>() {
    let up = HalfSpace::<T, 3>::new(vector([0.0, 0.0, 1.0]), T::of(0.25)).unwrap();
    let down = HalfSpace::<T, 3>::new(vector([0.0, 0.0, -3.0]), T::of(-3.0)).unwrap();
    let slanted = HalfSpace::<T, 3>::new(vector([0.0, 1e-3, -1.0]), T::zero()).unwrap();
    let zero = Vector::zeros();
    let ask = |a: &Body<'_, T, 3>, b: &Body<'_, T, 3>| depth(a, b, &Options::default(), asks!(3));
    // z <= 0.25 and z >= 1.
    for (lift, d) in [(0.0, -0.75), (0.75, 0.0), (1.5, 0.75)] {
        let (a, b) = (Body::at(&up, vector([5.0, 7.0, lift])), Body::at(&down, zero));
        let r = ask(&a, &b);
        assert!(r.lower.to_f64() <= d && d <= r.upper.to_f64(), "{r:?}");
        assert!((r.upper - r.lower).to_f64() <= 100.0 * T::ROUNDOFF.to_f64(), "{r:?}");
        assert_eq!(r.normal, vector([0.0, 0.0, 1.0]));
        let apart = (r.point_a - r.point_b)[2].to_f64();
        assert!((apart - d).abs() <= 100.0 * T::ROUNDOFF.to_f64(), "{r:?}");
        let s = ask(&b, &a);
        assert!(s.lower.to_f64() <= d && d <= s.upper.to_f64() && s.normal == -r.normal, "{r:?}");
    }
    for other in [&up, &slanted] {
        let r = ask(&Body::at(&up, zero), &Body::at(other, vector([0.0, 0.0, 1e3])));
        assert_eq!((r.outcome, r.lower, r.upper), (Outcome::Unbounded, T::HUGE, T::HUGE));
        let above = Options { threshold: Some(T::one()), ..Options::default() };
        let r = depth(&Body::at(&up, zero), &Body::at(other, zero), &above, asks!(3));
        assert_eq!(r.outcome, Outcome::Above);
    }
    // Turned alike, opposite stays opposite, exactly; turned apart by a half turn whose matrix is rounded, it is not known.
    let mut dice = Dice::new(23);
    for _ in 0..100 {
        let turn = Pose::<3>::random::<T>(&mut dice, 1.0);
        let r = ask(&turn.body(&up), &turn.body(&down));
        assert!(r.lower.to_f64() <= -0.75 && -0.75 <= r.upper.to_f64() && r.outcome == Outcome::Separated, "{r:?}");
        let flat = HalfSpace::<T, 3>::new(vector([0.0, 0.0, 1.0]), T::of(-1.0)).unwrap();
        // A half turn about x in the body's frame: columns y and z change sign. Known where the matrices are exact.
        let half = Pose { rotation: turn.rotation.map(|[x, y, z]| [x, -y, -z]), ..turn };
        let r = ask(&turn.body(&up), &half.body(&flat));
        let exact = turn.rotation == Pose::<3>::identity().rotation;
        assert!(r.lower.to_f64() <= -0.75 && (r.outcome == Outcome::Separated) == exact, "{r:?}");
        assert!(if exact { r.upper.to_f64() < -0.7 } else { r.upper == T::HUGE }, "{r:?}");
    }
}

#[test]
fn two_half_spaces() {
    opposite::<f64>();
    opposite::<f32>();
}

/// Points that a body is the hull of, told without error.
struct Exact(Vec<[f64; 3]>);

impl<T: Real> Support<T, 3> for Exact {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let height = |p: &[f64; 3]| (0..3).fold(Dd::from(0.0), |sum, i| sum + Dd::product(u[i].to_f64(), p[i]));
        let far = self.0.iter().reduce(|a, b| if height(b) > height(a) { b } else { a }).unwrap();
        Ok(Vector::from(far.map(T::of)))
    }
    fn extent(&self) -> T {
        T::of(self.0.iter().map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt()).fold(0.0, f64::max) * 1.0001)
    }
    fn error(&self) -> T {
        T::zero()
    }
}

fn ask<T: Real>(a: &Body<'_, T, 3>, b: &Body<'_, T, 3>) -> Depth<T, 3> {
    depth(a, b, &Options::default(), asks!(3))
}

fn holds(set: &Exact, placed: &Pose<3>, normal: [f64; 3], pose: &Pose<3>) {
    let half_space = HalfSpace::<f32, 3>::new(vector(normal), 0.0).unwrap();
    let r = ask(&placed.body::<f32>(set), &pose.body(&half_space));
    let d = truth((&normal, 0.0, pose), (&set.0, 0.0, placed));
    let (lower, upper) = (Dd::from(f64::from(r.lower)), Dd::from(f64::from(r.upper)));
    assert!(lower <= d && d <= upper, "{d:?} {r:?} {:?} {placed:?} {normal:?} {pose:?}", set.0);
}

/// A point far from its frame, which the frame's position brings back to the plane: what is left is less than a roundoff of a roundoff of the terms.
#[test]
fn a_point_on_the_plane_far_from_its_frame() {
    let mut dice = Dice::new(41);
    for _ in 0..200 {
        let set = Exact(vec![std::array::from_fn(|_| (9e6 * dice.signed()).round())]);
        let mut placed = Pose::<3> { rotation: dice.rotation(), ..Pose::identity() };
        placed.rotation = placed.rotation.map(|row| row.map(exact::<f32>));
        let away = placed.turned(&set.0[0]);
        placed.translation = away.map(|x| -exact::<f32>(x.to_f64()));
        let left = std::array::from_fn(|i| exact::<f32>((away[i] + Dd::from(placed.translation[i])).to_f64()));
        let pose = Pose { translation: left, ..Pose::identity() };
        holds(&set, &placed, dice.direction().map(exact::<f32>), &pose);
    }
}

/// Two corners that are equally deep, up to what the turned direction is rounded by: the wrong one may be asked.
#[test]
fn two_corners_that_are_equally_deep() {
    let mut dice = Dice::new(42);
    for _ in 0..200 {
        let rotation = dice.rotation::<3>().map(|row| row.map(exact::<f32>));
        let placed = Pose { rotation, ..Pose::identity() };
        let normal = dice.direction::<3>().map(exact::<f32>);
        let [x, y]: [f64; 2] = std::array::from_fn(|j| (0..3).map(|i| rotation[i][j] * normal[i]).sum());
        let size = 8e6 / x.abs().max(y.abs());
        let end = [(y * size).round(), -(x * size).round(), 0.0];
        holds(&Exact(vec![end, end.map(|x| -x)]), &placed, normal, &Pose::identity());
    }
}

/// Exactly opposite normals that are rounded differently are not told from others: that the half spaces overlap without end is not certain.
#[test]
fn opposite_normals_that_are_rounded() {
    let mut dice = Dice::new(43);
    for _ in 0..100 {
        let n: [f64; 3] = std::array::from_fn(|_| (1e6 * dice.signed()).round());
        let turn = Pose { rotation: dice.rotation(), ..Pose::<3>::identity() };
        // A quarter turn about z in the body's frame.
        let quarter = Pose { rotation: turn.rotation.map(|[x, y, z]| [y, -x, z]), ..turn };
        let up = HalfSpace::<f64, 3>::new(vector(n), 0.0).unwrap();
        let down = HalfSpace::<f64, 3>::new(vector([-3.0 * n[1], 3.0 * n[0], -3.0 * n[2]]), 0.0).unwrap();
        let r = ask(&turn.body(&up), &quarter.body(&down));
        assert!(r.lower <= 0.0 && r.upper >= 0.0, "{r:?}");
    }
}

/// A box whose `support` is wrong, and which counts.
struct Lazy {
    calls: AtomicU32,
    shape: BoxShape<f64, 3>,
}

impl Support<f64, 3> for Lazy {
    fn support(&self, _: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        Ok(Vector::zeros())
    }
    fn exhaustive(&self, u: &Vector<f64, 3>) -> Result<(Vector<f64, 3>, Vector<f64, 3>), Failure> {
        self.calls.fetch_add(1, Relaxed);
        self.shape.support_with_witness(u)
    }
    fn has_shortcuts(&self) -> bool {
        true
    }
    fn extent(&self) -> f64 {
        self.shape.extent()
    }
}

/// Says what it is told to.
struct Says(Result<Vector<f64, 3>, Failure>);

impl Support<f64, 3> for Says {
    fn support(&self, _: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        self.0
    }
    fn extent(&self) -> f64 {
        1.0
    }
}

#[test]
fn callbacks_are_asked_once_and_without_shortcuts_and_may_fail() {
    let ground = HalfSpace::<f64, 3>::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
    let ground = Body::at(&ground, Vector::zeros());
    let mut memory = Memory::least::<f64, 3>();
    let mut ask = |shape: &(dyn Support<f64, 3> + Sync)| {
        memory.solver::<f64, 3>().depth(&Body::at(shape, Vector::zeros()), &ground, &Options::default())
    };
    let lazy = Lazy { calls: AtomicU32::new(0), shape: BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap() };
    let r = ask(&lazy);
    assert!(r.lower <= 1.0 && 1.0 <= r.upper && lazy.calls.load(Relaxed) == 1, "{r:?}");
    let r = ask(&Says(Err(Failure(7))));
    assert_eq!((r.outcome, r.failure, r.upper), (Outcome::SupportFailed, Some(Failure(7)), f64::MAX));
    for bad in [f64::NAN, f64::INFINITY] {
        let r = ask(&Says(Ok(Vector::from([0.0, bad, 0.0]))));
        assert_eq!((r.outcome, r.failure), (Outcome::SupportFailed, Some(Failure(NOT_FINITE))));
    }
}

#[test]
fn where_it_cannot_serve_it_says_so() {
    let ground = HalfSpace::<f64, 3>::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
    let ball = Sphere::<f64, 3>::new(1.0).unwrap();
    let lifted = Rigid::new(ground, SMatrix::identity(), Vector::from([0.0, 0.0, 1.0])).unwrap();
    let sets: [&(dyn Support<f64, 3> + Sync); 4] =
        [&Sum::new(ground, ball), &Join::new(ball, ground), &lifted, &Margin::new(ground, 1.0).unwrap()];
    for set in sets {
        let mut memory = Memory::new::<f64, 3>(32, 64);
        let (a, b) = (Body::at(set, Vector::zeros()), Body::at(&ball, Vector::zeros()));
        let r = memory.solver::<f64, 3>().depth(&a, &b, &Options::default());
        assert_eq!((r.outcome, r.lower, r.upper), (Outcome::SupportFailed, -f64::MAX, f64::MAX));
        assert!([UNBOUNDED, NOT_FINITE].map(|code| Some(Failure(code))).contains(&r.failure), "{r:?}");
    }
}

#[test]
fn numbers_that_make_no_half_space_are_refused() {
    let make = |normal: [f64; 2], offset: f64| HalfSpace::<f64, 2>::new(Vector::from(normal), offset).err();
    assert_eq!(make([0.0, 0.0], 1.0), Some(ShapeError::Direction));
    assert_eq!(make([f64::NAN, 1.0], 1.0), Some(ShapeError::NonFinite));
    assert_eq!(make([1.0, 0.0], f64::INFINITY), Some(ShapeError::NonFinite));
    assert_eq!(make([1e-300, 0.0], 1.0), Some(ShapeError::NonFinite));
    assert_eq!(make([1e-310, 1e-310], 0.0), None);
    assert_eq!(make([1e290, 0.0], 1.0), None);
    // The same set in other units.
    let plane = HalfSpace::<f64, 2>::new(Vector::from([1e-310, 0.0]), 1e-310).unwrap();
    let x = 1e-310 * 2f64.powi(70);
    assert_eq!(plane, HalfSpace::new(Vector::from([x, 0.0]), x).unwrap());
    let mirror = SMatrix::<f64, 2, 2>::new(1.0, 0.0, 0.0, -1.0);
    assert_eq!(Body::new(&plane, mirror, Vector::zeros()).err(), Some(BodyError::Rotation));
}

/// The rolling ball of an ellipsoid, where the matrix is a rotation only roughly: the image is meant.
#[test]
fn rough_rotations_take_ellipsoids_along() {
    let mut dice = Dice::new(24);
    let ground = HalfSpace::<f64, 3>::new(Vector::from([0.0, 0.0, 1.0]), 0.5).unwrap();
    for _ in 0..200 {
        let semi: [f64; 3] = std::array::from_fn(|_| dice.range(0.5, 1.0));
        let ellipsoid = Ellipsoid::new(Vector::from(semi)).unwrap();
        let rows = dice.rotation::<3>().map(|row| row.map(|x| x + 2e-5 * dice.signed()));
        let mut memory = Memory::least::<f64, 3>();
        let a = Body::new(&ellipsoid, matrix(rows), Vector::from([1.0, 2.0, 0.75])).unwrap();
        let r = memory.solver::<f64, 3>().depth(&a, &Body::at(&ground, Vector::zeros()), &Options::default());
        let reach = (0..3).map(|j| (rows[2][j] * semi[j]).powi(2)).sum::<f64>().sqrt();
        let d = 0.5 - 0.75 + reach;
        assert!(r.lower <= d + 1e-15 && d - 1e-15 <= r.upper && r.upper - r.lower <= 1e-13, "{r:?} {d}");
    }
}

/// A random shape of a kind of the case files, of size 0.2 to 1, in numbers of single precision.
fn shape(kind: &str, dice: &mut Dice) -> Shape {
    let count = match kind {
        "sphere" => 1,
        "box" | "ellipsoid" => 3,
        "hull" => 36,
        _ => 2,
    };
    let number = |dice: &mut Dice| if kind == "hull" { dice.signed() } else { dice.range(0.2, 1.0) };
    Shape { kind: kind.to_string(), numbers: (0..count).map(|_| exact::<f32>(number(dice))).collect() }
}

/// Every kind of body on the ground in single precision, whichever way both are turned: overlaps of 0.001 to 0.1 converge, and the least that numbers allow
/// is told to some roundoffs of a roundoff of the bodies' size.
#[test]
fn shallow_contact_with_the_ground_in_f32() {
    let mut dice = Dice::new(46);
    for kind in ["box", "sphere", "capsule", "cylinder", "cone", "ellipsoid", "hull"] {
        for index in 0..300 {
            let pose = Pose::<3>::random::<f32>(&mut dice, 0.0);
            let turn = Pose::<3>::random::<f32>(&mut dice, 0.0).rotation;
            let flat = std::array::from_fn(|k| turn[k / 3][k % 3]);
            let placed = Placed { shape: shape(kind, &mut dice), rotation: flat, translation: [0.0; 3] };
            let normal = dice.direction::<3>().map(exact::<f32>);
            let w = pose.turned(&normal);
            let least = body_value(&placed, &w.map(|x| Dd::from(0.0) - x));
            // The offset brings the ground to a roundoff of the body, and the ground's place closer.
            let deep = if index % 3 == 0 { 0.0 } else { exact::<f32>(dice.decade(-3.0, -1.0)) };
            let offset = exact::<f32>(deep - least.to_f64());
            let left = Dd::from(deep) - least - Dd::from(offset);
            let place = w.map(|x| exact::<f32>(x.to_f64() * left.to_f64()));
            let ground = Pose { translation: place, ..pose };
            let depth = (least + Dd::from(offset) + dot(&w, &place.map(Dd::from))) / norm(&w);
            let half_space = HalfSpace::<f32, 3>::new(vector(normal), offset as f32).unwrap();
            let points = placed.shape.points::<f32>();
            let set = placed.shape.build(&points).unwrap();
            let r = ask(&placed.body(&*set).unwrap(), &ground.body(&half_space));
            let (lower, upper) = (Dd::from(f64::from(r.lower)), Dd::from(f64::from(r.upper)));
            assert!(lower <= depth && depth <= upper, "{kind} {depth:?} {r:?} {placed:?} {normal:?} {ground:?}");
            if deep == 0.0 {
                assert!(r.upper - r.lower <= 1e-10, "{kind} {depth:?} {r:?} {placed:?}");
            } else {
                assert_eq!(r.outcome, Outcome::Converged, "{kind} {depth:?} {r:?} {placed:?}");
            }
        }
    }
}

/// Radii that are sums or products of numbers, and rounded: they touch the ground where the rounded number does, which is not where they do.
#[test]
fn balls_whose_radius_is_rounded() {
    let mut dice = Dice::new(47);
    let ground = HalfSpace::<f32, 3>::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
    let number = |dice: &mut Dice| exact::<f32>(dice.range(0.1, 1.0));
    for index in 0..400 {
        let [r, s] = if index == 0 { [0.1f32, 0.2].map(f64::from) } else { [number(&mut dice), number(&mut dice)] };
        let ball = Sphere::<f32, 3>::new(r as f32).unwrap();
        let other = Sphere::<f32, 3>::new(s as f32).unwrap();
        let (shape, radius): (Box<dyn Support<f32, 3> + Sync>, Dd) = match index % 3 {
            0 => (Box::new(Margin::new(ball, s as f32).unwrap()), Dd::from(r) + Dd::from(s)),
            1 => (Box::new(Sum::new(ball, other)), Dd::from(r) + Dd::from(s)),
            _ => (Box::new(Scaled::new(ball, s as f32).unwrap()), Dd::product(r, s)),
        };
        let up = exact::<f32>(radius.to_f64());
        let r = ask(&Body::at(&*shape, vector([0.0, 0.0, up])), &Body::at(&ground, Vector::zeros()));
        let depth = radius - Dd::from(up);
        let (lower, upper) = (Dd::from(f64::from(r.lower)), Dd::from(f64::from(r.upper)));
        assert!(lower <= depth && depth <= upper, "{index} {depth:?} {r:?}");
        assert!(r.upper - r.lower <= 1e-6, "{r:?}");
    }
}

/// An ellipsoid in a margin, turned by a matrix that is a rotation only roughly: what is left of the radius when the rolling ball goes into the points is rounded.
#[test]
fn a_margin_around_a_rough_ellipsoid() {
    let ellipsoid = Ellipsoid::new(Vector::from([1e-3; 3])).unwrap();
    let shape = Margin::new(ellipsoid, 1000.0).unwrap();
    let ground = HalfSpace::<f64, 3>::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
    let mut rows = Pose::<3>::identity().rotation;
    rows[0][1] = 1e-6;
    let body = Body::new(&shape, matrix(rows), Vector::from([0.0, 0.0, shape.radius()])).unwrap();
    let options = Options { absolute: 1e-15, ..Options::default() };
    let r = depth(&body, &Body::at(&ground, Vector::zeros()), &options, |memory, a, b, options| {
        memory.solver::<f64, 3>().depth(a, b, options)
    });
    let depth = Dd::from(1000.0) + Dd::from(1e-3) - Dd::from(shape.radius());
    assert!(Dd::from(r.lower) <= depth && depth <= Dd::from(r.upper), "{depth:?} {r:?}");
}

/// A normal whose small coordinates are lost when it is scaled, far from the origin.
#[test]
fn a_normal_of_very_different_coordinates() {
    let point = Points::<f32, 3>::new(&[[0.0; 3]]).unwrap();
    let ground = HalfSpace::<f32, 3>::new(Vector::from([1e15, 0.0, 1e-31]), 0.0).unwrap();
    let r = ask(&Body::at(&point, Vector::from([0.0, 0.0, 1e31])), &Body::at(&ground, Vector::zeros()));
    assert!(r.lower <= -9.9e-16 && r.upper >= -1.01e-15, "{r:?}");
}
