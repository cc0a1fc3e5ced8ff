//! Hulls of two sets: tapered capsules and frustums against their signed distance functions, swept shapes against polytopes, joins
//! of any two shapes against a scan.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::Matrix3;
use qdist::support::{BoxShape, Cylinder, Ellipsoid, Join, Points, Rigid, Sphere, Support};
use qdist::{Body, Depth, Options, Outcome, Real, Vector};

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

fn vector<T: Real>(x: [f64; 3]) -> Vector<T, 3> {
    Vector::from(x.map(T::of))
}

fn moved<T: Real, S: Support<T, 3>>(shape: S, t: [f64; 3]) -> Rigid<S, T, 3> {
    Rigid::new(shape, Matrix3::identity(), vector(t)).unwrap()
}

fn depth<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>) -> Depth<T> {
    let options: Options<T, 3> = brisk();
    let mut memory = Memory::new::<T, 3>(256, 512);
    let r = memory.solver::<T, 3>().depth(a, b, &options);
    assert_eq!(broken_promise(&Seen::from(&r), &options, 256, 512), None, "{r:?}");
    r
}

/// The bracket holds, is narrow, and the outcome fits.
fn check<T: Real>(what: &str, r: &Depth<T>, d: f64, blur: f64) {
    let u = T::ROUNDOFF.to_f64();
    let (lower, upper) = (r.lower.to_f64(), r.upper.to_f64());
    assert!(lower <= d + blur && d - blur <= upper, "{what}: {d} {r:?}");
    let narrow = 1.01 * T::RELATIVE_TOLERANCE.to_f64() * d.abs() + 4000.0 * u;
    assert!(upper - lower <= narrow, "{what}: {d} {r:?}");
    assert!(r.outcome != Outcome::Capacity && r.outcome != Outcome::Iterations, "{what}: {d} {r:?}");
}

/// Least h(u) - u.x over unit vectors of the half plane that contains x and the axis, for heights of a body of revolution:
/// minus the signed distance of (out, up) from it. A scan, and a search between its steps.
fn least(height: impl Fn(f64, f64) -> f64, out: f64, up: f64) -> f64 {
    let at = |angle: f64| {
        let (s, c) = angle.sin_cos();
        height(c, s) - c * out - s * up
    };
    let steps = 4000;
    let step = std::f64::consts::TAU / f64::from(steps);
    let start = (0..steps).map(|k| f64::from(k) * step).min_by(|x, y| at(*x).total_cmp(&at(*y))).unwrap();
    let (mut low, mut high) = (start - step, start + step);
    for _ in 0..80 {
        let third = (high - low) / 3.0;
        if at(low + third) < at(high - third) { high -= third } else { low += third }
    }
    at(0.5 * (low + high))
}

/// Signed distance of a point outside of the hull of the balls (0, r) and ((0, 0, h), s): the closed form of the round cone.
fn round_cone(out: f64, up: f64, r: f64, s: f64, h: f64) -> f64 {
    let b = (r - s) / h;
    if b.abs() >= 1.0 {
        return if r > s { out.hypot(up) - r } else { out.hypot(up - h) - s };
    }
    let a = (1.0 - b * b).sqrt();
    // Along the slanted side: where does the normal through the point meet the axis?
    let k = up * a - out * b;
    if k < 0.0 {
        out.hypot(up) - r
    } else if k > a * h {
        out.hypot(up - h) - s
    } else {
        out * a + up * b - r
    }
}

fn tapered<T: Real>() {
    let mut dice = Dice::new(31);
    for k in 0..400 {
        let size = |dice: &mut Dice| exact::<T>(dice.range(0.05, 1.0));
        let [r, s, h, ball] = [(); 4].map(|()| size(&mut dice));
        let join =
            Join::new(Sphere::new(T::of(r)).unwrap(), moved(Sphere::<T, 3>::new(T::of(s)).unwrap(), [0.0, 0.0, h]));
        let at: [f64; 3] =
            std::array::from_fn(|i| exact::<T>(dice.range(-2.0, 2.0) * if i < 2 && k % 5 == 0 { 0.0 } else { 1.0 }));
        let sphere = Sphere::<T, 3>::new(T::of(ball)).unwrap();
        let (out, up) = (at[0].hypot(at[1]), at[2]);
        let by_scan = ball + least(|_, sine| r.max(s + sine * h), out, up);
        let distance = round_cone(out, up, r, s, h);
        if distance > 1e-9 {
            assert!((ball - distance - by_scan).abs() < 1e-12, "{r} {s} {h} {at:?}: {distance} {by_scan}");
        }
        let (a, b) = (Body::at(&join, Vector::zeros()), Body::at(&sphere, vector(at)));
        let what = format!("{r} {s} {h} {at:?} {ball}");
        check(&what, &depth(&a, &b), by_scan, 1e-12);
        check(&what, &depth(&b, &a), by_scan, 1e-12);
    }
}

#[test]
fn tapered_capsules_have_the_distance_of_the_round_cone() {
    tapered::<f64>();
    tapered::<f32>();
}

fn from_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = ((to[0] * along[0] + to[1] * along[1]) / (along[0].powi(2) + along[1].powi(2))).clamp(0.0, 1.0);
    (to[0] - t * along[0]).hypot(to[1] - t * along[1])
}

/// Signed distance of a point from the frustum with radii r at -h and s at h: that of its meridian section.
fn frustum(out: f64, up: f64, r: f64, s: f64, h: f64) -> f64 {
    let corners = [[0.0, -h], [r, -h], [s, h], [0.0, h]];
    let distance = (0..3).map(|i| from_segment([out, up], corners[i], corners[i + 1])).fold(f64::MAX, f64::min);
    let inside = up.abs() <= h && out <= r + (s - r) * (up + h) / (2.0 * h);
    if inside { -distance } else { distance }
}

fn frustums<T: Real>() {
    let mut dice = Dice::new(32);
    for k in 0..400 {
        let [r, s, h, ball] = [(); 4].map(|()| exact::<T>(dice.range(0.05, 1.0)));
        let disc = |r: f64| Cylinder::new(T::of(r), T::zero()).unwrap();
        let join = Join::new(moved(disc(r), [0.0, 0.0, -h]), moved(disc(s), [0.0, 0.0, h]));
        let at: [f64; 3] =
            std::array::from_fn(|i| exact::<T>(dice.range(-2.0, 2.0) * if i < 2 && k % 5 == 0 { 0.0 } else { 1.0 }));
        let d = ball - frustum(at[0].hypot(at[1]), at[2], r, s, h);
        let sphere = Sphere::<T, 3>::new(T::of(ball)).unwrap();
        let (a, b) = (Body::at(&join, Vector::zeros()), Body::at(&sphere, vector(at)));
        check(&format!("{r} {s} {h} {at:?} {ball}"), &depth(&a, &b), d, 1e-14);
    }
}

#[test]
fn frustums_have_the_distance_of_their_section() {
    frustums::<f64>();
    frustums::<f32>();
}

/// A box in two places is the hull of its sixteen corners; so is the join of two lists of points that of the list of both.
fn swept<T: Real>() {
    let mut dice = Dice::new(33);
    for k in 0..300 {
        let half: [f64; 3] = std::array::from_fn(|_| exact::<T>(dice.range(0.1, 1.0)));
        let way: [f64; 3] = std::array::from_fn(|_| exact::<T>(dice.range(-2.0, 2.0)));
        let cuboid = BoxShape::<T, 3>::new(vector(half)).unwrap();
        let join = Join::new(cuboid, moved(cuboid, way));
        let corner = |k: usize| -> [T; 3] {
            std::array::from_fn(|i| {
                T::of(if k >> i & 1 == 0 { half[i] } else { -half[i] }) + if k < 8 { T::zero() } else { T::of(way[i]) }
            })
        };
        let corners: Vec<[T; 3]> = (0..16).map(corner).collect();
        let polytope = Points::new(&corners).unwrap();
        let rows = dice.rotation::<3>();
        let turn = Matrix3::from_fn(|i, j| T::of(rows[i][j]));
        let at: [f64; 3] = std::array::from_fn(|_| exact::<T>(dice.range(-2.0, 2.0)));
        let other = BoxShape::<T, 3>::new(vector([0.5, 0.25, 0.75])).unwrap();
        let b = Body::new(&other, turn, vector(at)).unwrap();
        let (r, s) = (depth(&Body::at(&join, Vector::zeros()), &b), depth(&Body::at(&polytope, Vector::zeros()), &b));
        // The sum of half extent and way is rounded in the list, and is in the join's support function.
        let slack = T::of(8.0) * T::ROUNDOFF;
        assert!(r.lower <= s.upper + slack && s.lower <= r.upper + slack, "{k} {half:?} {way:?} {at:?}: {r:?} {s:?}");
        check("swept box", &r, 0.5 * (s.lower + s.upper).to_f64(), (s.upper - s.lower + slack).to_f64());
    }
}

#[test]
fn swept_boxes_are_polytopes() {
    swept::<f64>();
    swept::<f32>();
}

/// Two coaxial bodies of revolution, one of them a join: answered in a plane, in few steps.
#[test]
fn joins_about_one_axis_are_a_plane_problem() {
    let tip = Sphere::<f64, 3>::new(0.25).unwrap();
    let tapered = Join::new(Sphere::new(1.0).unwrap(), moved(tip, [0.0, 0.0, 3.0]));
    let cylinder = Cylinder::new(0.5, 0.5).unwrap();
    let r = depth(&Body::at(&tapered, Vector::zeros()), &Body::at(&cylinder, Vector::from([0.0, 0.0, 0.25])));
    assert!(r.outcome == Outcome::Converged && r.vertices <= 32, "{r:?}");
    // Sideways 1.5 at most, along the axis 1 + 0.75 down.
    let height = |c: f64, s: f64| 1.0f64.max(0.25 + 3.0 * s) + 0.5 * c.abs() + 0.5 * s.abs();
    let d = least(height, 0.0, 0.25);
    assert!(r.lower <= d + 1e-12 && d - 1e-12 <= r.upper, "{d} {r:?}");
}

/// Joins of joins, of sets with rolling balls, far from their frames, against the larger height of a dense set of directions: an upper bound that
/// no lower end may pass, and the normal's own height is `upper`.
#[test]
fn nested_joins_hold_against_sampled_directions() {
    let mut dice = Dice::new(34);
    for k in 0..100 {
        let far = if k % 3 == 0 { 1e5 } else { 0.0 };
        let round = Ellipsoid::new(Vector::from([0.5, 0.75, 1.0])).unwrap();
        let place = |dice: &mut Dice| [far + dice.signed(), dice.signed(), dice.signed()];
        let (p, q, t) = (place(&mut dice), place(&mut dice), place(&mut dice));
        let inner = Join::new(moved(&round, p), moved(Sphere::new(0.25).unwrap(), q));
        let join = Join::new(&inner, moved(BoxShape::new(Vector::from([0.25, 0.25, 0.25])).unwrap(), t));
        let ball = Sphere::new(0.5).unwrap();
        let x = place(&mut dice);
        let r = depth(&Body::at(&join, Vector::zeros()), &Body::at(&ball, Vector::from(x)));
        let height = |u: &[f64; 3]| {
            let along = |p: &[f64; 3]| (0..3).map(|i| u[i] * (p[i] - x[i])).sum::<f64>();
            let of_round = (0.25 * u[0] * u[0] + 0.5625 * u[1] * u[1] + u[2] * u[2]).sqrt() + along(&p);
            let of_box = 0.25 * u.iter().map(|x| x.abs()).sum::<f64>() + along(&t);
            of_round.max(0.25 + along(&q)).max(of_box) + 0.5
        };
        let n: [f64; 3] = r.normal.into();
        let blur = 1e-14 * (1.0 + far);
        assert!(height(&n) <= r.upper + blur && height(&n) >= r.lower - blur, "{k} {r:?}");
        for _ in 0..2000 {
            assert!(r.lower <= height(&dice.direction::<3>()) + blur, "{k} {r:?}");
        }
    }
}
