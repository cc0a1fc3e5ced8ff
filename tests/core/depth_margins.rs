//! Margins of depth queries, beside those of a set's own error: what placing bodies rounds, and what routes of their own charge for being off (bodies
//! about nearly one axis, ellipsoids with nearly the same axes, matrices that are rotations only roughly). Sets here are exact, or off by as much as they
//! say and always to the same side. Oracles are closed forms in double-double, or what `f64` proves of bodies whose symmetries are hidden.
//! `scripts/margins.py` takes the margins away one by one, and some test fails each time.

use crate::common;

use common::cases::{Placed, Shape};
use common::dd::Dd;
use common::dice::Dice;
use common::hull::{ExactHull, signed_depth};
use common::lattice::{Lattice, Lean, ball, symmetric, truth};
use nalgebra::{Matrix3, Rotation3, Unit};
use qdist::support::{Ellipsoid, Failure, HalfSpace, Points, Route, Sphere, Support, Symmetry};
use qdist::{Body, Depth, Options, Real, TwoWords, Vector, Workspace};

/// So many cases, or more: MORE=100 searches for what a hundred times as many would show.
fn cases(few: usize) -> std::ops::Range<usize> {
    0..few * std::env::var("MORE").ok().and_then(|n| n.parse().ok()).unwrap_or(1)
}

fn holds<T: Real>(depth: &Depth<T>, d: Dd, what: &str) {
    let (lower, upper) = (Dd::new(depth.lower.to_f64()), Dd::new(depth.upper.to_f64()));
    assert!(lower <= d && d <= upper, "{what}: {d:?} is not in [{lower:?}, {upper:?}] {:?}", depth.outcome);
}

fn depth<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>, options: &Options<'_, T, 3>) -> Depth<T> {
    Workspace::<T, 3, 64, 128>::new().solver().depth(a, b, options)
}

/// A matrix of numbers that the scalar type has.
fn matrix<T: Real>(rows: [[f64; 3]; 3]) -> Matrix3<T> {
    Matrix3::from_fn(|i, j| T::of(rows[i][j]))
}

/// R p, exactly but for 2^-104.
fn turned<T: Real>(rotation: &Matrix3<T>, p: &[f64; 3]) -> [Dd; 3] {
    std::array::from_fn(|i| (0..3).fold(Dd::ZERO, |sum, j| sum + Dd::product(rotation[(i, j)].to_f64(), p[j])))
}

fn length(v: &[Dd; 3]) -> Dd {
    v.iter().fold(Dd::ZERO, |sum, &x| sum + x * x).sqrt()
}

/// One point, known exactly; measured from itself where it `stands_far`.
struct Single {
    at: [f64; 3],
    stands_far: bool,
}

impl<T: Real> Support<T, 3> for Single {
    fn support(&self, _: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        Ok(Vector::from(self.at.map(T::of)))
    }
    fn extent(&self) -> T {
        T::of(self.at.iter().map(|x| x * x).sum::<f64>().sqrt() * 1.0001)
    }
    fn center(&self) -> Option<(Vector<T, 3>, T)> {
        self.stands_far.then(|| (Vector::from(self.at.map(T::of)), T::zero()))
    }
    fn error(&self) -> T {
        T::zero()
    }
}

/// Two points far from their frames, in frames turned differently, come to lie next to each other: their difference is smaller than what either is rounded by.
fn points_that_nearly_meet<T: Real>(seed: u64, size: f64) {
    let mut dice = Dice::new(seed);
    for case in cases(200) {
        let p: [f64; 3] = std::array::from_fn(|_| (size * dice.signed()).round());
        let [r, s] = [0, 1].map(|_| matrix::<T>(dice.rotation()));
        let away = turned(&r, &p);
        // Where B's point would have to be.
        let q: [f64; 3] =
            std::array::from_fn(|j| (0..3).map(|i| s[(i, j)].to_f64() * away[i].to_f64()).sum::<f64>().round());
        let image = turned(&s, &q);
        let left: [T; 3] = std::array::from_fn(|i| T::of((image[i] - away[i]).to_f64()));
        let difference: [Dd; 3] = std::array::from_fn(|i| away[i] - image[i] + Dd::new(left[i].to_f64()));
        let d = -length(&difference);
        for stands_far in [false, true] {
            let [a, b] = [p, q].map(|at| Single { at, stands_far });
            let (a, b) =
                (Body::<T>::new(&a, r, Vector::from(left)).unwrap(), Body::<T>::new(&b, s, Vector::zeros()).unwrap());
            holds(&depth(&a, &b, &Options::default()), d, &format!("{case} {p:?} {q:?} {stands_far}"));
            holds(&depth(&b, &a, &Options::default()), d, &format!("{case} {p:?} {q:?} {stands_far}, swapped"));
        }
    }
}

#[test]
fn points_that_nearly_meet_f64() {
    points_that_nearly_meet::<f64>(1, 1e15);
}

#[test]
fn points_that_nearly_meet_f32() {
    points_that_nearly_meet::<f32>(2, 9e6);
}

/// One point far up, known exactly along z only.
struct Stick(f32);

impl Support<f32, 3> for Stick {
    fn support(&self, _: &Vector<f32, 3>) -> Result<Vector<f32, 3>, Failure> {
        Ok(Vector::from([0.0, 0.0, self.0]))
    }
    fn extent(&self) -> f32 {
        1.8e7
    }
    fn extents(&self) -> Vector<f32, 3> {
        Vector::from([0.0, 0.0, 1.8e7])
    }
    fn center(&self) -> Option<(Vector<f32, 3>, f32)> {
        Some((Vector::from([0.0, 0.0, self.0]), 0.0))
    }
    fn error(&self) -> f32 {
        1500.0
    }
    fn errors(&self) -> Vector<f32, 3> {
        Vector::from([1000.0, 1000.0, 0.0])
    }
}

/// Two points that nearly meet, seen along the one direction in which they are known: a roundoff of a roundoff of the terms that cancel is more than a
/// roundoff of what they leave.
#[test]
fn points_that_nearly_meet_along_an_axis() {
    let pairs = [
        [(716357.0, 11), (-8455269.0, 8)],
        [(-5709891.0, 7), (8875313.0, 4)],
        [(-8314849.0, 1), (8395571.0, 8)],
        [(-8327949.0, 13), (8514576.0, 6)],
        [(5445427.0, 1), (-8881218.0, 6)],
    ];
    for pair in pairs {
        // Matrices that shrink by so many roundoffs.
        let [(a, r, p), (b, s, q)] = pair.map(|(at, roundoffs): (f32, u8)| {
            let shrink = 1.0 - f32::from(roundoffs) * f32::ROUNDOFF;
            (
                Stick(at),
                Matrix3::from_diagonal(&Vector::from([1.0, 1.0, shrink])),
                Dd::product(at.into(), shrink.into()),
            )
        });
        let on_a = -(p.to_f64() as f32);
        let rest = p - q + Dd::new(on_a.into());
        let on_b = rest.to_f64() as f32;
        let d = -(rest - Dd::new(on_b.into())).abs();
        let a = Body::<f32>::new(&a, r, Vector::from([0.0, 0.0, on_a])).unwrap();
        let b = Body::<f32>::new(&b, s, Vector::from([0.0, 0.0, on_b])).unwrap();
        holds(&depth(&a, &b, &Options::default()), d, &format!("{pair:?}"));
    }
}

/// A box around the origin whose points are farther out, or less far, by what it states axis by axis.
struct Leaner {
    half: [f64; 3],
    by: [f64; 3],
}

impl<T: Real> Support<T, 3> for Leaner {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let corner = |i: usize| T::of(self.half[i] + self.by[i]);
        Ok(Vector::from_fn(|i, _| if u[i] < T::zero() { -corner(i) } else { corner(i) }))
    }
    fn extent(&self) -> T {
        T::of(self.half.iter().map(|x| x * x).sum::<f64>().sqrt() * 1.0001)
    }
    fn extents(&self) -> Vector<T, 3> {
        Vector::from(self.half.map(T::of))
    }
    fn error(&self) -> T {
        T::of(self.by.iter().map(|x| x * x).sum::<f64>().sqrt() * (1.0 + 1e-12))
    }
    fn errors(&self) -> Vector<T, 3> {
        Vector::from(self.by.map(|x| T::of(x.abs() * (1.0 + 1e-12))))
    }
}

/// A matrix that stretches by 4e-5 stretches errors as well.
#[test]
fn errors_under_a_matrix_that_stretches() {
    let stretched = Matrix3::identity() * (1.0 + 4e-5);
    // Half lengths, by how much they lean, and the radius of a ball in the middle: uneven errors are seen by direction.
    for (half, by) in [([2.0, 2.0, 2.0], 0.25), ([64.0, 64.0, 2.0], 0.25)] {
        for sign in [1.0, -1.0] {
            for by in [[by, by, by], [8.0 * by, 8.0 * by, by]] {
                let box_ = Leaner { half, by: by.map(|x| x * sign) };
                let a = Body::new(&box_, stretched, Vector::zeros()).unwrap();
                let ball = Sphere::new(1.0).unwrap();
                let b = Body::at(&ball, Vector::zeros());
                holds(
                    &depth(&a, &b, &Options::default()),
                    Dd::new(1.0 + half[2] * (1.0 + 4e-5)),
                    &format!("{half:?} {by:?}"),
                );
            }
        }
    }
    // Along one axis the error of all is that of the axis: a small box.
    for sign in [1.0, -1.0] {
        let stick = Leaner { half: [0.0625; 3], by: [0.0, 0.0, 0.25 * sign] };
        let a = Body::new(&stick, stretched, Vector::zeros()).unwrap();
        let ball = Sphere::new(1.0).unwrap();
        let b = Body::at(&ball, Vector::from([0.0, 0.0, 3.0]));
        holds(&depth(&a, &b, &Options::default()), Dd::new(0.0625 * (1.0 + 4e-5) - 2.0), "a stick");
    }
}

/// A body that does not know its extent, with as large an error as that allows.
fn bodies_of_unknown_extent<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    for case in cases(100) {
        let lean = Lean::Share(dice.pick(&[-1.0, 1.0]) * 40.0 * T::ROUNDOFF.to_f64());
        let set = Lattice { lean, loose: 0.0, ..Lattice::new(symmetric(&mut dice, [40; 3])) };
        let point = Single { at: [0.0; 3], stands_far: false };
        let d = truth(&set.points, ball);
        let (a, b) = (Body::<T>::at(&set, Vector::zeros()), Body::<T>::at(&point, Vector::zeros()));
        holds(&depth(&a, &b, &Options::default()), d, &format!("{case} {set:?}"));
    }
}

#[test]
fn bodies_of_unknown_extent_f64() {
    bodies_of_unknown_extent::<f64>(3);
}

#[test]
fn bodies_of_unknown_extent_f32() {
    bodies_of_unknown_extent::<f32>(4);
}

/// A set of which nothing is known but its points: what it turns about is hidden.
struct Plain<'a>(&'a (dyn Support<f64, 3> + Sync));

impl Support<f64, 3> for Plain<'_> {
    fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        self.0.support(u)
    }
    fn radius(&self) -> f64 {
        self.0.radius()
    }
    fn rolling_radius(&self) -> f64 {
        self.0.rolling_radius()
    }
    fn extent(&self) -> f64 {
        self.0.extent()
    }
    fn error(&self) -> f64 {
        self.0.error()
    }
}

fn placed(kind: &str, numbers: &[f64], rotation: Matrix3<f64>, translation: [f64; 3]) -> Placed {
    let shape = Shape { kind: kind.to_string(), numbers: numbers.to_vec() };
    Placed { shape, rotation: std::array::from_fn(|i| rotation[(i / 3, i % 3)]), translation }
}

/// What `f64` proves of two bodies by expansion alone.
fn proved(a: &Placed, b: &Placed) -> [f64; 2] {
    let (pa, pb) = (a.shape.points(), b.shape.points());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    let (sa, sb) = (Plain(&*sa), Plain(&*sb));
    let options = Options { relative: 1e-9, max_iterations: Some(400), ..Options::default() };
    let mut memory = Box::new(Workspace::<f64, 3, 512, 1024>::new());
    let found = memory.solver().depth(&a.body(&sa).unwrap(), &b.body(&sb).unwrap(), &options);
    [found.lower, found.upper]
}

/// The bracket and what `f64` proves have a common point.
fn agrees<T: Real>(a: &Placed, b: &Placed, relative: f64, what: &str) {
    let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    let options = Options { relative: T::of(relative), ..Options::default() };
    let found = depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
    let (lower, upper) = (found.lower.to_f64(), found.upper.to_f64());
    let [least, most] = proved(a, b);
    assert!(
        lower <= most && least <= upper,
        "{what}: [{lower:e}, {upper:e}] {:?} for [{least:e}, {most:e}] {a:?} {b:?}",
        found.outcome
    );
}

fn rounded<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

/// A rotation, times a matrix that stretches by so much along the axes.
fn rough<T: Real>(dice: &mut Dice, turn: Matrix3<f64>, by: f64) -> Matrix3<f64> {
    let stretch = Matrix3::from_diagonal(&Vector::from_fn(|_, _| 1.0 + by * dice.pick(&[-1.0, 1.0])));
    let matrix = if dice.chance(0.5) { turn * stretch } else { stretch * turn };
    matrix.map(rounded::<T>)
}

fn turn(dice: &mut Dice, angle: f64) -> Matrix3<f64> {
    let axis = Unit::new_unchecked(Vector::from(dice.direction::<3>()));
    *Rotation3::from_axis_angle(&axis, angle).matrix()
}

/// A body of revolution of size 1.
fn solid<T: Real>(dice: &mut Dice) -> (&'static str, [f64; 2]) {
    (dice.pick(&["cylinder", "cone", "capsule"]), [0, 1].map(|_| rounded::<T>(dice.range(0.3, 1.0))))
}

/// Two bodies of revolution whose axes are off by what a tolerance allows, or whose matrices are.
fn nearly_coaxial<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let u = T::ROUNDOFF.to_f64();
    for case in cases(60) {
        let (first, second) = (solid::<T>(&mut dice), solid::<T>(&mut dice));
        let frame = if dice.chance(0.3) { Matrix3::identity() } else { turn(&mut dice, 2.0) };
        let relative = dice.decade(-2.0, 0.0);
        let aside = if case % 2 == 0 { relative * dice.decade(-3.0, -1.3) } else { 0.0 };
        let stretch = if case % 3 == 0 { 0.0 } else { 28.0 * u };
        let a = placed(first.0, &first.1, rough::<T>(&mut dice, frame, stretch), [0.0; 3]);
        let lean = turn(&mut dice, aside);
        let off = (frame.column(2) * dice.range(0.0, 0.3)).map(rounded::<T>).into();
        let b = placed(second.0, &second.1, rough::<T>(&mut dice, lean * frame, stretch), off);
        agrees::<T>(&a, &b, relative, &format!("{case} {relative:e}"));
    }
}

#[test]
fn nearly_coaxial_f64() {
    nearly_coaxial::<f64>(5);
}

#[test]
fn nearly_coaxial_f32() {
    nearly_coaxial::<f32>(6);
}

/// A body of revolution with this profile, whose points are known to a few roundoffs: where its circles are off shows.
struct Turned {
    profile: Vec<[f64; 2]>,
}

impl<T: Real> Support<T, 3> for Turned {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let across = (u[0] * u[0] + u[1] * u[1]).root();
        let height = |p: &[f64; 2]| Dd::product(across.to_f64(), p[0]) + Dd::product(u[2].to_f64(), p[1]);
        let far = self.profile.iter().reduce(|a, b| if height(b) > height(a) { b } else { a }).unwrap();
        let [r, h] = far.map(T::of);
        let (x, y) = if across > T::zero() { (u[0] / across, u[1] / across) } else { (T::one(), T::zero()) };
        Ok(Vector::from([r * x, r * y, h]))
    }
    fn extent(&self) -> T {
        T::of(self.profile.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max) * 1.0001)
    }
    fn error(&self) -> T {
        T::count(6) * T::ROUNDOFF // radii are at most 1
    }
    fn symmetry(&self) -> Symmetry {
        Symmetry::Axis
    }
    fn route(&self) -> Option<Route<T>> {
        Some(Route::arcs())
    }
}

/// Matrices that make ellipses of circles, of bodies about one axis: the plane that is asked is where they are widest.
fn circles_that_are_ellipses<T: Real>() {
    let half = [[1.0, 0.4375], [0.75, 0.8125], [0.25, 1.0625]];
    let shape = Turned { profile: half.iter().flat_map(|&[r, h]| [[r, h], [r, -h]]).collect() };
    for off in [30.0, 31.0, 32.0, -30.0, -32.0] {
        let [x, y] = [off, -off].map(|off| T::of(1.0 + off * T::ROUNDOFF.to_f64()));
        let rotation = Matrix3::from_diagonal(&Vector::from([x, y, T::one()]));
        let body = Body::<T>::new(&shape, rotation, Vector::zeros()).unwrap();
        let d = Dd::new(2.0 * x.to_f64().min(y.to_f64()));
        for relative in [0.0, 1e-6, 1e-4, 1e-2] {
            let options = Options { relative: T::of(relative), ..Options::default() };
            holds(&depth(&body, &body, &options), d, &format!("{off} {relative}"));
        }
    }
}

#[test]
fn circles_that_are_ellipses_f64() {
    circles_that_are_ellipses::<f64>();
}

#[test]
fn circles_that_are_ellipses_f32() {
    circles_that_are_ellipses::<f32>();
}

/// A point off the axis of a cylinder: within the sector of the nearest azimuth it is nearer than at both ends.
fn a_point_off_the_axis<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let cylinder = Turned { profile: vec![[1.0, 2.0], [1.0, -2.0]] };
    let a = Body::<T>::at(&cylinder, Vector::zeros());
    for case in cases(100) {
        let near = dice.decade(-4.0, -0.3);
        let at = dice.direction::<3>().map(|x| rounded::<T>(x * near));
        let point = Single { at, stands_far: false };
        let d = Dd::new(1.0) - length(&[Dd::new(at[0]), Dd::new(at[1]), Dd::ZERO]);
        for relative in [1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12] {
            let options = Options { relative: T::of(relative), ..Options::default() };
            let b = Body::<T>::at(&point, Vector::zeros());
            holds(&depth(&a, &b, &options), d, &format!("{case} {at:?} {relative:e}"));
        }
    }
}

#[test]
fn a_point_off_the_axis_f64() {
    a_point_off_the_axis::<f64>(51);
}

#[test]
fn a_point_off_the_axis_f32() {
    a_point_off_the_axis::<f32>(52);
}

/// A corner or an edge near the axis of a body of revolution: sectors.
fn corners_near_an_axis<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let u = T::ROUNDOFF.to_f64();
    for case in cases(60) {
        let first = solid::<T>(&mut dice);
        let frame = if dice.chance(0.3) { Matrix3::identity() } else { turn(&mut dice, 2.0) };
        let stretch = if case % 3 == 0 { 0.0 } else { 28.0 * u };
        let a = placed(first.0, &first.1, rough::<T>(&mut dice, frame, stretch), [0.0; 3]);
        let near = dice.decade(-4.0, -0.5);
        let b = match case % 3 {
            0 => {
                let corners: Vec<f64> = (0..12)
                    .map(|i| if i < 3 { near * dice.signed() } else { 2.0 * dice.signed() })
                    .map(rounded::<T>)
                    .collect();
                placed("hull", &corners, rough::<T>(&mut dice, frame, stretch), [0.0; 3])
            }
            1 => {
                let second = solid::<T>(&mut dice);
                let angle = dice.decade(-4.0, -0.3);
                let lean = turn(&mut dice, angle);
                let off = (Vector::from(dice.direction::<3>()) * near).map(rounded::<T>).into();
                placed(second.0, &second.1, rough::<T>(&mut dice, lean * frame, stretch), off)
            }
            _ => {
                let half: [f64; 3] = [near, near * dice.unit(), dice.range(0.3, 2.0)].map(rounded::<T>);
                let angle = dice.decade(-4.0, -0.3);
                let lean = turn(&mut dice, angle);
                placed("box", &half, rough::<T>(&mut dice, lean * frame, stretch), [0.0; 3])
            }
        };
        let relative = dice.decade(T::RELATIVE_TOLERANCE.to_f64().log10(), -1.0);
        agrees::<T>(&a, &b, relative, &format!("{case} {relative:e}"));
        agrees::<T>(&b, &a, relative, &format!("{case} {relative:e}, swapped"));
    }
}

#[test]
fn corners_near_an_axis_f64() {
    corners_near_an_axis::<f64>(7);
}

#[test]
fn corners_near_an_axis_f32() {
    corners_near_an_axis::<f32>(8);
}

/// Ellipsoids whose centres and axes agree, but for what a tolerance allows.
fn ellipsoids_with_nearly_common_axes<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let u = T::ROUNDOFF.to_f64();
    for case in cases(60) {
        let mut semi = || -> [f64; 3] { std::array::from_fn(|_| rounded::<T>(dice.range(0.3, 1.0))) };
        let (first, second) = (semi(), semi());
        let frame = if dice.chance(0.3) { Matrix3::identity() } else { turn(&mut dice, 2.0) };
        let relative = dice.decade(-3.0, 0.0);
        let aside = if case % 2 == 0 { relative * dice.decade(-3.0, -1.0) } else { 0.0 };
        let apart = if case % 3 == 0 { relative * dice.decade(-3.0, -0.5) } else { 0.0 };
        let stretch = if case % 5 == 0 { 0.0 } else { 14.0 * u };
        let a = placed("ellipsoid", &first, rough::<T>(&mut dice, frame, stretch), [0.0; 3]);
        let lean = turn(&mut dice, aside);
        let off = (Vector::from(dice.direction::<3>()) * apart).map(rounded::<T>).into();
        let b = placed("ellipsoid", &second, rough::<T>(&mut dice, lean * frame, stretch), off);
        agrees::<T>(&a, &b, relative, &format!("{case} {relative:e}"));
    }
}

#[test]
fn ellipsoids_with_nearly_common_axes_f64() {
    ellipsoids_with_nearly_common_axes::<f64>(9);
}

#[test]
fn ellipsoids_with_nearly_common_axes_f32() {
    ellipsoids_with_nearly_common_axes::<f32>(10);
}

/// The ball that rolls in an ellipsoid is none under a matrix that stretches.
#[test]
fn ellipsoids_under_a_matrix_that_stretches() {
    let stretched = Matrix3::identity() * (1.0 + 4e-5);
    for semi in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.75], [1.0, 0.75, 0.625]] {
        let a = placed("ellipsoid", &semi, stretched, [0.0; 3]);
        let shape = a.shape.build::<f64>(&[]).unwrap();
        let ball = Sphere::new(1.0).unwrap();
        let found = depth(&a.body(&*shape).unwrap(), &Body::at(&ball, Vector::zeros()), &Options::default());
        let d = 1.0 + semi.into_iter().fold(1.0, f64::min) * (1.0 + 4e-5);
        assert!(found.lower <= d + 1e-15 && d - 1e-15 <= found.upper, "{semi:?} {found:?} {d}");
    }
}

/// A ball of radius 1 that rolled in a rounded body, of which a point is left.
struct Rolled;

impl<T: Real> Support<T, 3> for Rolled {
    fn support(&self, _: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        Ok(Vector::zeros())
    }
    fn radius(&self) -> T {
        T::one()
    }
    fn rolling_radius(&self) -> T {
        T::one()
    }
    fn extent(&self) -> T {
        T::of(1e-30)
    }
    fn error(&self) -> T {
        T::zero()
    }
}

/// Such a ball stays one where the matrix is a rotation but for some roundoffs. Its image is none, and the image is meant.
fn rolling_balls_under_a_matrix_off_by_roundoffs<T: Real>() {
    let n = [1.0; 3];
    let ground = HalfSpace::new(Vector::from(n.map(T::of)), T::zero()).unwrap();
    let ground = Body::at(&ground, Vector::zeros());
    for off in [-31.0, -28.0, -16.0, 16.0, 28.0, 31.0] {
        let stretch = Matrix3::identity() + Matrix3::repeat(0.5 * off * T::ROUNDOFF.to_f64());
        let rotation = stretch.map(T::of);
        let along = |semi: [f64; 3]| {
            let local = turned(&rotation.transpose(), &n);
            length(&std::array::from_fn(|i| local[i] * Dd::new(semi[i]))) / Dd::new(3.0).sqrt()
        };
        for semi in [[1.0, 1.0, 1.0], [1.0, 1.0, 0.9375], [0.9375, 1.0, 0.96875]] {
            let ellipsoid = Ellipsoid::new(Vector::from(semi.map(T::of))).unwrap();
            let a = Body::new(&ellipsoid, rotation, Vector::zeros()).unwrap();
            holds(&depth(&a, &ground, &Options::default()), along(semi), &format!("{off} {semi:?}"));
        }
        // Across n, the matrix leaves lengths as they are.
        let d = along([1.0; 3]).min(Dd::new(1.0));
        let a = Body::<T>::new(&Rolled, rotation, Vector::zeros()).unwrap();
        let point = Single { at: [0.0; 3], stands_far: false };
        holds(&depth(&a, &Body::<T>::at(&point, Vector::zeros()), &Options::default()), d, &format!("{off} rolled"));
        holds(&depth(&a, &ground, &Options::default()), along([1.0; 3]), &format!("{off} rolled, on the ground"));
    }
}

#[test]
fn rolling_balls_under_a_matrix_off_by_roundoffs_f64() {
    rolling_balls_under_a_matrix_off_by_roundoffs::<f64>();
}

#[test]
fn rolling_balls_under_a_matrix_off_by_roundoffs_f32() {
    rolling_balls_under_a_matrix_off_by_roundoffs::<f32>();
}

/// Long, flat, and rounded by a ball that rolled in it.
struct RolledFloor;

impl<T: Real> Support<T, 3> for RolledFloor {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let along = |x: T| T::of(if x < T::zero() { -1024.0 } else { 1024.0 });
        Ok(Vector::from([along(u[0]), along(u[1]), T::zero()]))
    }
    fn radius(&self) -> T {
        T::one()
    }
    fn rolling_radius(&self) -> T {
        T::one()
    }
    fn extent(&self) -> T {
        T::of(1449.0)
    }
    fn extents(&self) -> Vector<T, 3> {
        Vector::from([1024.0, 1024.0, 0.0].map(T::of))
    }
    fn error(&self) -> T {
        T::zero()
    }
}

/// Where margins by direction count, the image of the ball does.
fn a_floor_under_a_matrix_off_by_roundoffs<T: Real>() {
    for off in [-15.0, -14.0, -12.0, 12.0, 14.0] {
        let high = T::of(1.0 + off * T::ROUNDOFF.to_f64());
        let rotation = Matrix3::from_diagonal(&Vector::from([T::one(), T::one(), high]));
        let a = Body::<T>::new(&RolledFloor, rotation, Vector::zeros()).unwrap();
        let b = Single { at: [0.0; 3], stands_far: false };
        let options = Options { relative: T::zero(), ..Options::default() };
        let found = depth(&a, &Body::<T>::at(&b, Vector::zeros()), &options);
        holds(&found, Dd::new(high.to_f64()), &format!("{off}"));
    }
}

#[test]
fn a_floor_under_a_matrix_off_by_roundoffs_f64() {
    a_floor_under_a_matrix_off_by_roundoffs::<f64>();
}

#[test]
fn a_floor_under_a_matrix_off_by_roundoffs_f32() {
    a_floor_under_a_matrix_off_by_roundoffs::<f32>();
}

/// A shape of size 1 with numbers of `f32`: round, nearly round, thin, or with a small ball.
fn shape(dice: &mut Dice, kind: &'static str) -> (&'static str, Vec<f64>) {
    let numbers: Vec<f64> = match kind {
        "sphere" => vec![dice.decade(-3.0, 0.0)],
        "box" => (0..3).map(|_| dice.range(0.3, 1.0)).collect(),
        "hull" => (0..4 + dice.below(8)).flat_map(|_| dice.direction::<3>()).collect(),
        "capsule" => vec![dice.decade(-4.0, 0.0), dice.range(0.3, 1.0)],
        "round" => (0..3).map(|_| 1.0 - dice.decade(-6.0, -1.0)).collect(),
        _ => (0..if kind == "ellipsoid" { 3 } else { 2 }).map(|_| dice.range(0.3, 1.0)).collect(),
    };
    (if kind == "round" { "ellipsoid" } else { kind }, numbers.into_iter().map(rounded::<f32>).collect())
}

/// What `f64` proves of two bodies.
fn proved_at_all(a: &Placed, b: &Placed, relative: f64) -> Depth<f64> {
    let (pa, pb) = (a.shape.points(), b.shape.points());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    let options = Options { relative, max_iterations: Some(1000), ..Options::default() };
    let mut memory = Box::new(Workspace::<f64, 3, 512, 1024>::new());
    memory.solver().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options)
}

/// In `f32`, asked for more and less exactly.
fn agrees_in_two_words(a: &Placed, b: &Placed, what: &str) {
    let truth = proved_at_all(a, b, 1e-12);
    let (pa, pb) = (a.shape.points::<f32>(), b.shape.points::<f32>());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    for relative in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
        let options = Options { relative, ..Options::default() };
        let found = depth::<f32>(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
        let (lower, upper) = (f64::from(found.lower), f64::from(found.upper));
        let seen = (found.outcome, truth.lower, truth.upper);
        assert!(lower <= truth.upper && truth.lower <= upper, "{what} [{lower:e}, {upper:e}] {seen:?} {a:?} {b:?}");
    }
}

/// Contacts in `f32` that end in two words, asked for more and less exactly; under matrices that are off by so many roundoffs.
fn contacts_in_two_words(seed: u64, [first, second]: [&'static str; 2], roundoffs: f64) {
    let mut dice = Dice::new(seed);
    for case in cases(40) {
        let mut body = |kind, at| {
            let (kind, numbers) = shape(&mut dice, kind);
            let frame = turn(&mut dice, 2.0);
            let matrix = match case % 3 {
                0 => frame.map(rounded::<f32>),
                1 => rough::<f32>(&mut dice, frame, roundoffs * 0.5 * f64::from(f32::ROUNDOFF)),
                _ => {
                    let off = roundoffs * 0.5 * f64::from(f32::ROUNDOFF) * dice.pick(&[-1.0, 1.0]);
                    ((Matrix3::identity() + Matrix3::repeat(off)) * frame).map(rounded::<f32>)
                }
            };
            placed(kind, &numbers, matrix, at)
        };
        let (a, mut b) = (body(first, [0.0; 3]), body(second, [0.25, 0.125, -0.0625]));
        let near = proved_at_all(&a, &b, 1e-4);
        let wanted = dice.decade(-4.5, -0.5);
        let moved = Vector::from(b.translation) + near.normal * (near.upper - wanted);
        b.translation = moved.map(rounded::<f32>).into();
        agrees_in_two_words(&a, &b, &format!("{case}"));
    }
}

/// A long facet whose nearest point is a little aside of where it was computed.
#[test]
fn a_nearest_point_aside() {
    let ellipsoid = placed(
        "ellipsoid",
        &[0.3963099718093872, 0.5765498280525208, 0.6147245764732361],
        Matrix3::from_row_slice(&[
            0.9717864990234375,
            0.029607435688376427,
            -0.23399654030799866,
            0.22572998702526093,
            -0.4044032692909241,
            0.8862866163253784,
            -0.06838829070329666,
            -0.9141014218330383,
            -0.3996769189834595,
        ]),
        [0.0; 3],
    );
    let capsule = placed(
        "capsule",
        &[0.00011491403711261228, 0.7787713408470154],
        Matrix3::from_row_slice(&[
            -0.29182249307632446,
            -0.6966344118118286,
            0.655393123626709,
            -0.04663874953985214,
            0.6947678923606873,
            0.7177203297615051,
            -0.9553347229957581,
            0.1788802146911621,
            -0.23523904383182526,
        ]),
        [0.5341081023216248, -0.1297389715909958, -0.04817324876785278],
    );
    agrees_in_two_words(&ellipsoid, &capsule, "");
}

#[test]
fn polyhedra_in_two_words() {
    contacts_in_two_words(11, ["box", "hull"], 28.0);
    contacts_in_two_words(12, ["hull", "hull"], 28.0);
}

#[test]
fn small_balls_in_two_words() {
    contacts_in_two_words(13, ["capsule", "box"], 28.0);
    contacts_in_two_words(14, ["capsule", "capsule"], 28.0);
    contacts_in_two_words(15, ["sphere", "hull"], 28.0);
}

#[test]
fn curved_bodies_in_two_words() {
    contacts_in_two_words(16, ["ellipsoid", "box"], 28.0);
    contacts_in_two_words(17, ["cylinder", "cone"], 28.0);
    contacts_in_two_words(18, ["ellipsoid", "capsule"], 28.0);
}

#[test]
fn nearly_round_bodies_in_two_words() {
    contacts_in_two_words(19, ["round", "box"], 28.0);
    contacts_in_two_words(20, ["round", "round"], 28.0);
    contacts_in_two_words(21, ["round", "sphere"], 28.0);
    contacts_in_two_words(22, ["round", "hull"], 1.0);
}

/// [`Rolled`], told in two words as well: with the ball put on.
struct RolledInTwoWords;

impl Support<f32, 3> for RolledInTwoWords {
    fn support(&self, u: &Vector<f32, 3>) -> Result<Vector<f32, 3>, Failure> {
        Rolled.support(u)
    }
    fn support_in_two_words(&self, u: &TwoWords<f32, 3>) -> Option<TwoWords<f32, 3>> {
        let unit = (u.high.map(f64::from) + u.low.map(f64::from)).normalize();
        let high = unit.map(|x| x as f32);
        Some(TwoWords { high, low: (unit - high.map(f64::from)).map(|x| x as f32) })
    }
    fn radius(&self) -> f32 {
        1.0
    }
    fn rolling_radius(&self) -> f32 {
        1.0
    }
    fn extent(&self) -> f32 {
        Rolled.extent()
    }
    fn error(&self) -> f32 {
        0.0
    }
}

/// Its image under this matrix stands on a face across the axis, beside the origin: so the face's corners are found along directions far aside. Less a ball
/// that does not roll in the image, its points there reach farther along the normal than its point along the normal does.
fn stands_on_a_face(dice: &mut Dice, rotation: Matrix3<f32>, axis: usize, what: &str) {
    let [across, beside] = [(axis + 1) % 3, (axis + 2) % 3];
    let place = |at: [f64; 2], high: f64| {
        let mut p = [0.0; 3];
        [p[across], p[beside], p[axis]] = [at[0], at[1], high].map(|x| x as f32);
        p
    };
    let (far, spin) = (dice.decade(-1.0, 0.7), dice.range(0.0, 2.0));
    let middle = [dice.signed() * far, dice.signed() * far];
    let mut corners: Vec<[f32; 3]> = (0..3)
        .map(|i| {
            let (sin, cos) = (spin + f64::from(i) * 2.1 + 0.3 * dice.signed()).sin_cos();
            let wide = dice.range(0.5, 3.0);
            place([middle[0] + cos * wide, middle[1] + sin * wide], 0.0)
        })
        .collect();
    corners.push(place(middle, -0.5));
    let high = rounded::<f32>(1.0 - dice.decade(-4.5, -2.5));
    let d = length(&std::array::from_fn(|j| Dd::new(rotation[(axis, j)].into()))) - Dd::new(high);
    let face = Points::new(&corners).unwrap();
    let a = Body::new(&RolledInTwoWords, rotation, Vector::from(place(middle, high))).unwrap();
    for relative in [1e-4, 1e-3, 1e-2] {
        let options = Options { relative, ..Options::default() };
        holds(&depth(&a, &Body::at(&face, Vector::zeros()), &options), d, &format!("{what} {relative:e} {rotation:?}"));
    }
}

/// A matrix that stretches along one axis and shrinks along another.
#[test]
fn an_image_of_a_ball_in_two_words() {
    let mut dice = Dice::new(61);
    for case in cases(60) {
        let off = 14.0 * f32::ROUNDOFF;
        let rotation = Matrix3::from_diagonal(&Vector::from_fn(|_, _| 1.0 + dice.pick(&[-off, off])));
        stands_on_a_face(&mut dice, rotation, case % 3, &format!("{case}"));
    }
}

/// A matrix that turns about an axis, and shrinks across it by what nobody sees who measures it.
#[test]
fn an_image_of_a_ball_by_roundoffs_in_two_words() {
    let (mut dice, mut found) = (Dice::new(62), 0);
    for case in cases(20_000) {
        let (sin, cos) = dice.range(0.1, 1.4).sin_cos();
        let (s, c) = (sin as f32, cos as f32);
        let short = Dd::new(1.0) - Dd::product(c.into(), c.into()) - Dd::product(s.into(), s.into());
        if c * c + s * s == 1.0 && short > Dd::new(f32::ROUNDOFF.into()) {
            let rotation = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
            stands_on_a_face(&mut dice, rotation, found % 3, &format!("{case}"));
            found += 1;
        }
    }
    assert!(found > 20, "{found}");
}

/// Bodies far from the world's origin, which overlap by next to nothing: what two words lose far away is more than a roundoff of the depth.
#[test]
fn far_contacts_in_two_words() {
    let (mut dice, mut found) = (Dice::new(63), 0);
    for case in cases(2000) {
        let mut body = || {
            let points: Vec<[f32; 3]> = (0..6).map(|_| dice.direction::<3>().map(|x| x as f32)).collect();
            (points, matrix::<f32>(dice.rotation()))
        };
        let ((points, turn_a), (others, turn_b)) = (body(), body());
        let far = dice.decade(4.0, 4.6);
        let at = Vector::from([far, dice.signed(), dice.signed()].map(|x| x as f32));
        let mut to = Vector::from([far + dice.signed(), dice.signed(), dice.signed()].map(|x| x as f32));
        let hull = |points: &[[f32; 3]], turn: &Matrix3<f32>, at: &Vector<f32, 3>| {
            let moved = |p: &[f32; 3]| {
                let turned = turned(turn, &p.map(f64::from));
                std::array::from_fn(|i| turned[i] + Dd::new(at[i].into()))
            };
            ExactHull::new(&points.iter().map(moved).collect::<Vec<_>>())
        };
        // Across the far axis, where coordinates are fine, B is moved until the bodies overlap by this.
        let wanted = dice.decade(-5.4, -5.1);
        let first = hull(&points, &turn_a, &at);
        let seen = |to: &Vector<f32, 3>| signed_depth(&first, &hull(&others, &turn_b, to));
        for _ in 0..3 {
            let found = seen(&to);
            let across = found.normal[1].hypot(found.normal[2]).powi(2);
            let by = (found.depth.to_f64() - wanted) / across;
            if found.depth > Dd::ZERO && across > 0.05 {
                to.y += (by * found.normal[1]) as f32;
                to.z += (by * found.normal[2]) as f32;
            }
        }
        let d = seen(&to).depth;
        if (d.to_f64() - wanted).abs() > 0.1 * wanted {
            continue;
        }
        let (a, b) = (Points::new(&points).unwrap(), Points::new(&others).unwrap());
        let (a, b) = (Body::new(&a, turn_a, at).unwrap(), Body::new(&b, turn_b, to).unwrap());
        let options = Options { relative: 1.0, ..Options::default() };
        holds(&depth(&a, &b, &options), d, &format!("{case} {far:e}"));
        found += 1;
    }
    assert!(found > 100, "{found}");
}
