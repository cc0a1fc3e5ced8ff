//! Sizes and places from one end of the format to the other: bodies whose depth along x is a sum of three numbers, taken in double-double; and hulls far
//! away in their own frame, whose witnesses must be as accurate as the bracket.
//!
//! A body that reaches `half` along x, at a point of the x axis, contains the ellipsoid of semi-axes (half, half / 2, half / 2). Two of them, t apart along
//! x with sum S of their halves, have d = S - t wherever t > 3/4 S: for a direction of cosine c to x, the sum of heights is at least
//! S sqrt(1/4 + 3/4 c^2) - t c, which is convex in c and falls towards c = 1.

use crate::common;

use common::dd::Dd;
use common::dice::Dice;
use nalgebra::{Matrix3, Vector3};
use qdist::support::{BoxShape, Capsule, Cylinder, Ellipsoid, Failure, Points, ShapeError, Sphere, Support};
use qdist::{Body, Depth, Options, Outcome, Real, TOO_LARGE, Vector, Workspace};

type Shape<'a, T> = Box<dyn Support<T, 3> + Sync + 'a>;

fn depth<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>) -> Depth<T> {
    Workspace::<T, 3, 64, 128>::new().solver().depth(a, b, &Options::default())
}

/// A body that reaches `half` along x and at least half as far across.
fn along_x<T: Real>(dice: &mut Dice, half: T) -> Result<Shape<'static, T>, ShapeError> {
    let mut across = || half * T::of(dice.range(0.5, 2.0));
    let (p, q) = (across(), across());
    Ok(match dice.below(5) {
        0 => Box::new(BoxShape::new(Vector::from([half, p, q]))?),
        1 => Box::new(Sphere::new(half)?),
        2 => Box::new(Ellipsoid::new(Vector::from([half, p, q]))?),
        3 => Box::new(Cylinder::new(half, p)?),
        _ => Box::new(Capsule::new(half, p)?),
    })
}

/// The bracket holds `truth`, its normal is a unit vector along x, and no number is NaN or infinite.
fn holds<T: Real>(d: &Depth<T>, truth: Dd, what: &str) {
    assert!(Dd::new(d.lower.to_f64()) <= truth && truth <= Dd::new(d.upper.to_f64()), "{what}: {truth:?} {d:?}");
    let mut numbers = d.normal.iter().chain(d.point_a.iter()).chain(d.point_b.iter());
    assert!(numbers.all(|x| x.finite()), "{what}: {d:?}");
    assert!((d.normal.norm().to_f64() - 1.0).abs() < 1e-5, "{what}: {d:?}");
}

/// Pairs of all kinds, each of a random size out of a range of decades; overlapping or apart by at most a quarter of it.
fn pairs<T: Real>(seed: u64, decades: [f64; 2], tolerance: f64) {
    let mut dice = Dice::new(seed);
    for case in 0..400 {
        let size = dice.decade(decades[0], decades[1]);
        let [p, q] = [0; 2].map(|_| T::of(size * dice.range(0.5, 1.0)));
        let apart = T::of(size * dice.range(0.0, 0.1)) * if dice.chance(0.7) { -T::one() } else { T::one() };
        let at = p + q + apart;
        let (a, b) = (along_x(&mut dice, p).unwrap(), along_x(&mut dice, q).unwrap());
        let truth = Dd::new(p.to_f64()) + Dd::new(q.to_f64()) - Dd::new(at.to_f64());
        let d = depth(&Body::at(&*a, Vector::zeros()), &Body::at(&*b, Vector::from([at, T::zero(), T::zero()])));
        let what = format!("{case}, size {size:e}");
        holds(&d, truth, &what);
        let width = (d.upper.to_f64() - d.lower.to_f64()) / size;
        assert!(
            width <= tolerance && !matches!(d.outcome, Outcome::Degenerate | Outcome::SupportFailed),
            "{what}: {d:?}"
        );
        assert!(T::ROUNDOFF > T::of(1e-10) || d.outcome != Outcome::Precision, "{what}: {d:?}");
    }
}

/// The smallest sizes had a floor in their errors, the largest overflowed in a norm.
#[test]
fn bodies_of_any_promised_size() {
    pairs::<f64>(1, [-140.0, 140.0], 1e-6);
    pairs::<f32>(2, [-17.0, 17.0], 1e-4);
    // The ends themselves.
    pairs::<f64>(3, [-140.0, -139.0], 1e-6);
    pairs::<f32>(4, [-17.0, -16.0], 1e-4);
}

/// Sizes and translations far beyond what is promised: refused by name, or true. `decades` of sizes, and of distances.
fn beyond<T: Real>(seed: u64, sizes: [f64; 2], distances: [f64; 2]) -> [usize; 2] {
    let mut dice = Dice::new(seed);
    let (mut refused, mut answered) = (0, 0);
    for case in 0..400 {
        let (size, far) = (dice.decade(sizes[0], sizes[1]), dice.decade(distances[0], distances[1]));
        let [p, q] = [0; 2].map(|_| T::of(size * dice.range(0.5, 1.0)));
        let (Ok(a), Ok(b)) = (along_x(&mut dice, p), along_x(&mut dice, q)) else {
            refused += 1;
            continue;
        };
        let [at_a, at_b] = match case % 3 {
            // Apart by far, from the origin or from both sides of it.
            0 => [T::zero(), T::of(far)],
            1 => [-T::of(far), T::of(0.75 * far)],
            // Within each other, far away.
            _ => [T::zero(), (p + q) * T::of(0.95)],
        };
        let across = if case % 3 == 2 { T::of(far) } else { T::zero() };
        let [at_a, at_b] = [at_a, at_b].map(|x| Vector::from([x, across, T::zero()]));
        let d = depth(&Body::at(&*a, at_a), &Body::at(&*b, at_b));
        let what = format!("{case}, size {size:e}, {far:e} away");
        if d.outcome == Outcome::SupportFailed {
            assert_eq!(d.failure.map(|f| f.0), Some(TOO_LARGE), "{what}: {d:?}");
            refused += 1;
        } else {
            let sum = Dd::new(p.to_f64()) + Dd::new(q.to_f64());
            let truth = sum - (Dd::new(at_b.x.to_f64()) - Dd::new(at_a.x.to_f64()));
            answered += 1;
            if case % 3 == 2 {
                holds(&d, truth, &what);
                // (What far away is rounded is rounded in proportion to how far. Of bodies below the normal numbers nothing but the truth is asked.)
                let width = T::of(1e-4) * (p + q) + T::of(far) * T::count(64) * T::ROUNDOFF + T::count(4) * T::TINY;
                assert!(d.upper - d.lower <= width, "{what}: {d:?}");
            } else if far > 4.0 * size {
                holds(&d, truth, &what);
                // (Where d is subnormal, a few of the smallest numbers more.)
                let width = T::of(1e-4) * -d.lower + T::count(64) * T::ROUNDOFF * T::TINY;
                assert!(d.outcome == Outcome::Separated && d.upper - d.lower <= width, "{what}: {d:?}");
            } else {
                // Near enough to overlap, deep perhaps: along x at most.
                assert!(Dd::new(d.lower.to_f64()) <= truth, "{what}: {truth:?} {d:?}");
                assert!(d.lower <= d.upper && d.lower.finite() && d.upper.finite(), "{what}: {d:?}");
            }
        }
    }
    [refused, answered]
}

/// Translations whose squares overflow, sizes that only just have a place in the format: refused by name, or true.
#[test]
fn sizes_and_distances_that_arithmetic_hardly_bears() {
    for (name, [refused, answered]) in [
        ("far", beyond::<f64>(5, [-140.0, 140.0], [140.0, 308.0])),
        ("far f32", beyond::<f32>(6, [-17.0, 17.0], [17.0, 38.5])),
        ("large", beyond::<f64>(7, [150.0, 307.0], [150.0, 308.0])),
        ("large f32", beyond::<f32>(8, [18.0, 38.0], [18.0, 38.5])),
        ("small", beyond::<f64>(9, [-307.0, -140.0], [-320.0, 0.0])),
        ("small f32", beyond::<f32>(10, [-44.0, -17.0], [-44.0, 0.0])),
    ] {
        println!("{name}: {refused} refused, {answered} answered");
        assert!(answered >= 200, "{name}: {refused} refused, {answered} answered");
    }
}

/// A turn that permutes the axes: exact.
fn permutation<T: Real>(turns: usize) -> Matrix3<T> {
    let (o, l) = (T::zero(), T::one());
    let cycle = Matrix3::new(o, o, l, l, o, o, o, l, o);
    (0..turns % 3).fold(Matrix3::identity(), |m, _| m * cycle)
}

/// Cubes given by corners that are exact, far away in their own frame, brought back by their pose.
fn hulls_far_from_their_frame<T: Real>(seed: u64, farthest: f64, near: f64) {
    let mut dice = Dice::new(seed);
    for case in 0..200 {
        let far = [0; 3].map(|_| (dice.decade(2.0, farthest) * dice.pick(&[1.0, -1.0])).round());
        let corner = |i: usize| std::array::from_fn(|k| T::of(far[k] + 2.0 * (i >> k & 1) as f64));
        let corners: Vec<[T; 3]> = (0..8).map(corner).collect();
        let (hull, cube) = (Points::new(&corners).unwrap(), BoxShape::new(Vector::from([T::one(); 3])).unwrap());
        let turn = permutation::<T>(case);
        let middle = turn * Vector3::from(far.map(|x| T::of(x + 1.0)));
        let offset = [1.25 + dice.below(32) as f64 / 64.0, dice.below(32) as f64 / 64.0 - 0.25, -0.5];
        let (near_origin, beside) =
            (Body::new(&hull, turn, -middle).unwrap(), Body::at(&cube, Vector::from(offset.map(T::of))));
        let swapped = case % 2 == 1;
        let d = if swapped { depth(&beside, &near_origin) } else { depth(&near_origin, &beside) };
        holds(&d, Dd::new(2.0 - offset[0]), &format!("{case} {far:?}"));
        assert!((d.upper - d.lower).to_f64() <= near, "{case} {far:?}: {d:?}");
        let (on_hull, on_cube) = if swapped { (d.point_b, d.point_a) } else { (d.point_a, d.point_b) };
        let off = |p: &Vector<T, 3>, c: [f64; 3]| (0..3).fold(0.0f64, |m, i| m.max((p[i].to_f64() - c[i]).abs())) - 1.0;
        assert!(off(&on_hull, [0.0; 3]).abs() <= near && off(&on_cube, offset).abs() <= near, "{case} {far:?}: {d:?}");
        let apart = d.point_a - d.point_b - d.normal * d.upper;
        assert!(apart.amax().to_f64() <= near, "{case} {far:?}: {d:?}");
    }
}

/// 1e9 away in double precision, and like that in single: the bracket was right to 1e-14, the witnesses to 1e-7.
#[test]
fn witnesses_are_as_accurate_as_the_bracket() {
    hulls_far_from_their_frame::<f64>(11, 9.0, 1e-12);
    hulls_far_from_their_frame::<f32>(12, 6.0, 1e-4);
}

/// A cube that states its reach along the axes as it is, and in all as far too much: the least length that C states.
struct Loose<T: Real>(BoxShape<T, 3>);

impl<T: Real> Support<T, 3> for Loose<T> {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        assert!(u.iter().all(|x| x.finite()) && u.iter().any(|&x| x != T::zero()), "asked along {u:?}");
        self.0.support(u)
    }
    fn extent(&self) -> T {
        T::SAFE_SQUARE
    }
    fn error(&self) -> T {
        T::zero()
    }
    fn extents(&self) -> Vector<T, 3> {
        self.0.extents()
    }
}

/// Edges whose squares have no inverse made normals of zeros, and with them an upper end of 0 for cubes of 1e-44.
fn cubes_below_the_normal_numbers<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let least = T::TINY * T::ROUNDOFF * T::count(2);
    for case in 0..200 {
        let half = least * T::count(if case < 64 { 1 + case } else { 1 + dice.below(1 << 20) });
        let at = half * T::count(dice.below(4)) / T::count(2);
        let cube = Loose(BoxShape::new(Vector::from([half; 3])).unwrap());
        let d = depth(&Body::at(&cube, Vector::zeros()), &Body::at(&cube, Vector::from([at, T::zero(), T::zero()])));
        let truth = Dd::new(2.0 * half.to_f64()) - Dd::new(at.to_f64());
        holds(&d, truth, &format!("{case}: {half:?} {at:?}"));
    }
}

#[test]
fn cubes_below_the_normal_numbers_that_state_more() {
    cubes_below_the_normal_numbers::<f32>(44);
    cubes_below_the_normal_numbers::<f64>(45);
}
