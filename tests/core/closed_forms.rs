//! Depths that are known in closed form, in 2 to 6 dimensions and both scalar types.
//!
//! References are `f64` expressions in the very numbers that the solver is given, so they are off by a few roundings
//! of `f64`; [`holds`] allows for that and for nothing else.

use crate::common;

use common::dice::Dice;
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::{Matrix3, SMatrix, Vector3};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, UnitSetFn, Vertices};
use qdist::support::{
    BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Failure, Linear, Margin, Point, Points, Rigid, Scaled, Sphere, Sum,
    Support,
};
use qdist::{Answer, Body, Depth, Options, Outcome, Real, Vector};

/// How narrow an answer must be.
#[derive(Clone, Copy)]
enum Want {
    /// upper - lower at most this share of |d|.
    Relative(f64),
    /// At most this many roundoffs of this length.
    Roundoffs(f64, f64),
    /// True is enough.
    Truth,
}

/// The type's own rounding of a coordinate.
fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

fn vector<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

/// The bracket contains d (up to the rounding of the reference), and is as narrow as wanted.
fn holds<T: Real>(what: &str, s: &Seen, d: f64, want: Want) {
    let blur = 16.0 * f64::EPSILON * d.abs();
    assert!(s.lower <= d + blur && d - blur <= s.upper, "{what}: {d:e} is not in {s:?}");
    let width = s.upper - s.lower;
    match want {
        Want::Relative(share) => assert!(width <= share * d.abs() * 1.001, "{what}: width {width:e} of {d:e}, {s:?}"),
        Want::Roundoffs(count, length) => {
            assert!(width <= count * T::ROUNDOFF.to_f64() * length, "{what}: width {width:e}, {s:?}");
        }
        Want::Truth => {}
    }
}

fn solve<T: Real, const N: usize>(
    a: &dyn Support<T, N>,
    q: &dyn UnitSet<T, N>,
    options: &Options<'_, T, N>,
) -> Answer<T, N> {
    let mut memory = Memory::new::<T, N>(768, 16384);
    let answer = memory.solver::<T, N>().solve(a, q, options);
    if let Some(text) = broken_promise(&Seen::from(&answer), options, 768, 16384) {
        panic!("{text}: {:?}", Seen::from(&answer));
    }
    answer
}

fn check<T: Real, const N: usize>(what: &str, a: &dyn Support<T, N>, q: &dyn UnitSet<T, N>, d: f64, want: Want) {
    let answer = solve(a, q, &brisk());
    holds::<T>(
        &format!("{what} ({} dimensions, roundoff {:e})", N, T::ROUNDOFF.to_f64()),
        &Seen::from(&answer),
        d,
        want,
    );
}

/// The default tolerance; in `f32` that is 1e-4, and the error margins of large coordinates may not allow it:
/// some thousand roundoffs do.
fn asked<T: Real>() -> Want {
    Want::Relative(T::RELATIVE_TOLERANCE.to_f64().max(8000.0 * T::ROUNDOFF.to_f64()))
}

/// Sizes between 1/2 and 2, exact in the scalar type.
fn sizes<T: Real, const N: usize>(dice: &mut Dice) -> [f64; N] {
    std::array::from_fn(|_| exact::<T>(dice.range(0.5, 2.0)))
}

fn least<const N: usize>(values: impl Fn(usize) -> f64) -> f64 {
    (0..N).map(values).fold(f64::MAX, f64::min)
}

fn length(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// A box of half extents h, moved by t: the faces are at h_i - t_i and h_i + t_i. So for every Q that is
/// symmetric to the coordinate planes, d = min (h_i - |t_i|) / h_Q(e_i).
fn moved_boxes<T: Real, const N: usize>() {
    let mut dice = Dice::new(21);
    for round in 0..4 {
        let h = sizes::<T, N>(&mut dice);
        // Multiples of 1/64, so that h - |t| is what the solver sees in any type.
        let t: [f64; N] = std::array::from_fn(|_| if round == 0 { 0.0 } else { (dice.below(25) as f64 - 12.0) / 64.0 });
        let room = |i: usize| h[i] - t[i].abs();
        let cuboid = BoxShape::new(vector::<T, N>(h)).unwrap();
        let set = Rigid::new(cuboid, SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let g = sizes::<T, N>(&mut dice);
        let (ball, r) = (Ball::<T>::unit(), exact::<T>(dice.range(0.1, 3.0)));
        check("ball in box", &set, &ball, least::<N>(room), asked::<T>());
        check("larger ball in box", &set, &Ball::new(T::of(r)).unwrap(), least::<N>(room) / r, asked::<T>());
        let scaled = least::<N>(|i| room(i) / g[i]);
        check("box in box", &set, &UnitBox::new(vector::<T, N>(g)).unwrap(), scaled, asked::<T>());
        check("cross-polytope in box", &set, &CrossPolytope::new(vector::<T, N>(g)).unwrap(), scaled, asked::<T>());
        let turned = UnitEllipsoid::new(vector::<T, N>(g), SMatrix::identity()).unwrap();
        check("ellipsoid in box", &set, &turned, scaled, asked::<T>());
        // A Q of one dimension less, and one of one dimension: only the faces that it faces count.
        let flat: [f64; N] = std::array::from_fn(|i| if i == 0 { 0.0 } else { g[i] });
        let flat_least = (1..N).map(|i| room(i) / g[i]).fold(f64::MAX, f64::min);
        check("flat box in box", &set, &UnitBox::new(vector::<T, N>(flat)).unwrap(), flat_least, asked::<T>());
        check(
            "flat cross-polytope",
            &set,
            &CrossPolytope::new(vector::<T, N>(flat)).unwrap(),
            flat_least,
            asked::<T>(),
        );
        let flat_ellipsoid = UnitEllipsoid::new(vector::<T, N>(flat), SMatrix::identity()).unwrap();
        check("flat ellipsoid in box", &set, &flat_ellipsoid, flat_least, asked::<T>());
        let thin: [f64; N] = std::array::from_fn(|i| if i == N - 1 { g[i] } else { 0.0 });
        let needle = room(N - 1) / g[N - 1];
        check("needle in box", &set, &UnitBox::new(vector::<T, N>(thin)).unwrap(), needle, asked::<T>());
    }
}
every_type_and_dimension!(symmetric_units_in_a_moved_box_meet_the_nearest_face, moved_boxes);

/// The ray from the origin along `end` leaves the box where the first coordinate reaches its face.
fn rays_in_boxes<T: Real, const N: usize>() {
    let mut dice = Dice::new(22);
    for _ in 0..6 {
        let h = sizes::<T, N>(&mut dice);
        let end: [f64; N] =
            std::array::from_fn(|i| if i > 0 && dice.chance(0.3) { 0.0 } else { exact::<T>(dice.signed()) });
        let t: [f64; N] = std::array::from_fn(|_| (dice.below(25) as f64 - 12.0) / 64.0);
        let set =
            Rigid::new(BoxShape::new(vector::<T, N>(h)).unwrap(), SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let exit = least::<N>(|i| match end[i] {
            0.0 => f64::MAX,
            x if x > 0.0 => (h[i] + t[i]) / x,
            x => (h[i] - t[i]) / -x,
        });
        check("segment in box", &set, &Segment::new(vector::<T, N>(end)).unwrap(), exit, asked::<T>());
    }
}
every_type_and_dimension!(a_segment_unit_shoots_a_ray_out_of_a_box, rays_in_boxes);

/// Q as the hull of the origin and some points: each point is a ray, and the first to leave bounds all.
fn vertex_units_in_boxes<T: Real, const N: usize>() {
    let mut dice = Dice::new(23);
    for _ in 0..4 {
        let h = sizes::<T, N>(&mut dice);
        let set = BoxShape::new(vector::<T, N>(h)).unwrap();
        let corners: Vec<[f64; N]> =
            (0..1 + dice.below(2 * N)).map(|_| std::array::from_fn(|_| exact::<T>(dice.signed()))).collect();
        let typed: Vec<[T; N]> = corners.iter().map(|c| c.map(T::of)).collect();
        let d = corners.iter().map(|c| least::<N>(|i| h[i] / c[i].abs())).fold(f64::MAX, f64::min);
        check("vertices in box", &set, &Vertices::new(&typed).unwrap(), d, asked::<T>());
    }
}
every_type_and_dimension!(a_hull_of_points_as_unit_is_the_shortest_of_its_rays, vertex_units_in_boxes);

/// A centred ellipsoid, against unit sets with the same axes: ball and ellipsoid by the shortest axis ratio.
fn ellipsoids<T: Real, const N: usize>() {
    // Curved sets converge quickly in low dimensions only; in higher ones the bracket is true and not absurdly wide.
    let want = match N {
        2 => asked::<T>(),
        3 => Want::Relative(T::RELATIVE_TOLERANCE.to_f64().max(1e-3)),
        _ => Want::Relative(1.0),
    };
    let mut dice = Dice::new(24);
    for _ in 0..2 {
        let (a, g) = (sizes::<T, N>(&mut dice), sizes::<T, N>(&mut dice));
        let set = Ellipsoid::new(vector::<T, N>(a)).unwrap();
        check("ball in ellipsoid", &set, &Ball::unit(), least::<N>(|i| a[i]), want);
        let q = UnitEllipsoid::new(vector::<T, N>(g), SMatrix::identity()).unwrap();
        check("ellipsoid in ellipsoid", &set, &q, least::<N>(|i| a[i] / g[i]), want);
        // The corners of the box are the first to leave the ellipsoid, the tips of the cross-polytope likewise.
        let corner: [f64; N] = std::array::from_fn(|i| g[i] / a[i]);
        check("box in ellipsoid", &set, &UnitBox::new(vector::<T, N>(g)).unwrap(), 1.0 / length(&corner), want);
        let tips = least::<N>(|i| a[i] / g[i]);
        check("cross-polytope in ellipsoid", &set, &CrossPolytope::new(vector::<T, N>(g)).unwrap(), tips, want);
        check("segment in ellipsoid", &set, &Segment::new(vector::<T, N>(g)).unwrap(), 1.0 / length(&corner), want);
    }
}
every_type_and_dimension!(units_in_a_centred_ellipsoid, ellipsoids);

/// The simplex { x : x_i >= -1, sum x_i <= 1 }: faces at distance 1 and 1/sqrt(n). Its corners are exact numbers.
fn simplices<T: Real, const N: usize>() {
    let corners: Vec<[T; N]> =
        (0..=N).map(|k| std::array::from_fn(|i| if i + 1 == k { T::of(N as f64) } else { -T::one() })).collect();
    let set = Points::new(&corners).unwrap();
    let n = N as f64;
    check("ball in simplex", &set, &Ball::unit(), 1.0 / n.sqrt(), asked::<T>());
    check("box in simplex", &set, &UnitBox::new(vector::<T, N>([1.0; N])).unwrap(), 1.0 / n, asked::<T>());
    let cross = CrossPolytope::new(vector::<T, N>([1.0; N])).unwrap();
    check("cross-polytope in simplex", &set, &cross, 1.0, asked::<T>());
    check("diagonal in simplex", &set, &Segment::new(vector::<T, N>([1.0; N])).unwrap(), 1.0 / n, asked::<T>());
    check("other diagonal", &set, &Segment::new(vector::<T, N>([-1.0; N])).unwrap(), 1.0, asked::<T>());
    // A Q with the origin as its corner: the box [0, 1]^n is the hull of its 2^n corners.
    let cube: Vec<[T; N]> = (0..1usize << N).map(|m| std::array::from_fn(|i| T::count(m >> i & 1))).collect();
    check("corner box in simplex", &set, &Vertices::new(&cube).unwrap(), 1.0 / n, asked::<T>());
    // Grown by a margin, all faces move out by as much; scaled by 2, twice as far.
    let grown = Margin::new(set, T::of(0.25)).unwrap();
    check("ball in rounded simplex", &grown, &Ball::unit(), 1.0 / n.sqrt() + 0.25, asked::<T>());
    let doubled = Scaled::new(grown, T::of(2.0)).unwrap();
    check("ball in twice the rounded simplex", &doubled, &Ball::unit(), 2.0 / n.sqrt() + 0.5, asked::<T>());
}
every_type_and_dimension!(units_in_a_simplex_with_the_inradius_known, simplices);

/// The parallelotope M [-1, 1]^n with M = R D S (rotation, stretch, shear): facet normals are the rows of M^-1,
/// at height 1. Every Q then has d = min 1 / h_Q(row).
fn parallelotopes<T: Real, const N: usize>() {
    let mut dice = Dice::new(25);
    for _ in 0..3 {
        let r = dice.rotation::<N>();
        let stretch = sizes::<f64, N>(&mut dice);
        let m = SMatrix::<f64, N, N>::from_fn(|i, j| exact::<T>(r[i][j] * stretch[j] + 0.1 * dice.signed()));
        let inverse = m.try_inverse().unwrap();
        let set = Linear::new(BoxShape::new(vector::<T, N>([1.0; N])).unwrap(), m.map(T::of), Vector::zeros()).unwrap();
        let g = sizes::<T, N>(&mut dice);
        let facets = |h: &dyn Fn(&[f64; N]) -> f64| least::<N>(|i| 1.0 / h(&std::array::from_fn(|j| inverse[(i, j)])));
        // The inverse is off by rounding, times the condition number of M (some 10).
        let blurred = |what: &str, q: &dyn UnitSet<T, N>, d: f64| {
            let s = Seen::from(&solve(&set, q, &brisk()));
            let blur = 1e-13 * d;
            assert!(s.lower <= d + blur && d - blur <= s.upper, "{what}: {d:e} is not in {s:?}");
            assert!(s.upper - s.lower <= T::RELATIVE_TOLERANCE.to_f64() * 1.001 * d, "{what}: {s:?}");
        };
        blurred("ball", &Ball::unit(), facets(&|u| length(u)));
        let box_value = |u: &[f64; N]| (0..N).map(|i| g[i] * u[i].abs()).sum();
        blurred("box", &UnitBox::new(vector::<T, N>(g)).unwrap(), facets(&box_value));
        let cross_value = |u: &[f64; N]| (0..N).map(|i| g[i] * u[i].abs()).fold(0.0, f64::max);
        blurred("cross-polytope", &CrossPolytope::new(vector::<T, N>(g)).unwrap(), facets(&cross_value));
        let along = |u: &[f64; N]| (0..N).map(|i| g[i] * u[i]).sum::<f64>().abs();
        // A symmetric set: the ray and its opposite are as long.
        blurred("segment", &Segment::new(vector::<T, N>(g)).unwrap(), facets(&along));
        let own = UnitSetFn::new(
            |u: &Vector<T, N>| Ok((0..N).fold(T::zero(), |s, i| s + T::of(g[i]) * u[i].abs())),
            T::count(4 * N) * T::ROUNDOFF * T::of(length(&g)),
        )
        .unwrap();
        blurred("closure", &own, facets(&box_value));
    }
}
every_type_and_dimension!(any_unit_in_a_sheared_box, parallelotopes);

/// Sums: boxes add up face by face, balls add up by radius, in any mixture.
fn sums<T: Real, const N: usize>() {
    let mut dice = Dice::new(26);
    let (h, k) = (sizes::<T, N>(&mut dice), sizes::<T, N>(&mut dice));
    let r = exact::<T>(dice.range(0.1, 1.0));
    let sum = Sum::new(
        Sum::new(BoxShape::new(vector::<T, N>(h)).unwrap(), Sphere::<T, N>::new(T::of(r)).unwrap()),
        BoxShape::new(vector::<T, N>(k)).unwrap(),
    );
    check("ball in box + ball + box", &sum, &Ball::unit(), least::<N>(|i| h[i] + k[i]) + r, asked::<T>());
    // A ray along an axis leaves the rounded box straight through a face.
    let axis: [f64; N] = std::array::from_fn(|i| if i == 0 { -1.0 } else { 0.0 });
    let want = if N <= 3 { Want::Relative(1e-3) } else { Want::Truth };
    check("axis in box + ball + box", &sum, &Segment::new(vector::<T, N>(axis)).unwrap(), h[0] + k[0] + r, want);
    // The unit set is no ball, so the ball term has to be expanded.
    let ball = Sphere::<T, N>::new(T::of(r)).unwrap();
    let want = match N {
        2 => Want::Relative(1e-3),
        3 => Want::Relative(0.02),
        _ => Want::Truth,
    };
    let cube = UnitBox::new(vector::<T, N>([1.0; N])).unwrap();
    check("box in ball", &ball, &cube, r / (N as f64).sqrt(), want);
    check("cross-polytope in ball", &ball, &CrossPolytope::new(vector::<T, N>([1.0; N])).unwrap(), r, want);
    check("ball in ball", &ball, &Ball::new(T::of(0.5)).unwrap(), 2.0 * r, Want::Relative(64.0 * T::ROUNDOFF.to_f64()));
}
every_type_and_dimension!(minkowski_sums_and_ball_terms, sums);

/// A set in a coordinate subspace: d = 0 for a ball, and the dimension is told. Off the subspace, or beside the
/// set in it: the distance.
fn flats<T: Real, const N: usize>() {
    for dimension in 0..N {
        let h: [f64; N] = std::array::from_fn(|i| if i < dimension { 1.0 + i as f64 / 4.0 } else { 0.0 });
        let flat = BoxShape::new(vector::<T, N>(h)).unwrap();
        let answer = solve(&flat, &Ball::unit(), &brisk());
        holds::<T>("flat box", &Seen::from(&answer), 0.0, Want::Roundoffs(400.0, length(&h)));
        assert!(
            matches!(answer.outcome, Outcome::Degenerate | Outcome::Touching),
            "{N} {dimension} {:?}",
            Seen::from(&answer)
        );
        assert_eq!(answer.dimension, dimension, "{:?}", Seen::from(&answer));
        // With a radius it is not flat.
        let plate = Margin::new(flat, T::of(0.5)).unwrap();
        check("flat box with a margin", &plate, &Ball::unit(), 0.5, asked::<T>());
        // Beside it along the last axis, off the subspace.
        let mut t = [0.0; N];
        t[N - 1] = 3.0;
        t[0] += 0.25;
        let beside = Rigid::new(flat, SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let gap = 3.0 - if dimension == N { h[N - 1] } else { 0.0 };
        let sideways = if dimension == 0 { 0.25 } else { 0.0 };
        let s = Seen::from(&solve(&beside, &Ball::unit(), &brisk()));
        holds::<T>("beside a flat box", &s, -f64::hypot(gap, sideways), asked::<T>());
        assert_eq!(s.outcome, Outcome::Separated);
        if dimension > 0 {
            // In the subspace, outside the set.
            let mut t = [0.0; N];
            t[0] = 4.0;
            let past = Rigid::new(flat, SMatrix::identity(), vector::<T, N>(t)).unwrap();
            let s = Seen::from(&solve(&past, &Ball::unit(), &brisk()));
            holds::<T>("past a flat box", &s, -3.0, asked::<T>());
            // A ray within the flat set has a positive length in it, and the bracket must not deny it.
            let mut end = [0.0; N];
            end[0] = 0.5;
            let ray = Segment::new(vector::<T, N>(end)).unwrap();
            check("ray in a flat box", &flat, &ray, 2.0 * h[0], Want::Truth);
        }
    }
}
every_type_and_dimension!(flat_sets_have_depth_zero_and_tell_their_dimension, flats);

/// The origin exactly on a face, an edge, ... a vertex of a box, of a simplex and of an ellipsoid.
fn boundaries<T: Real, const N: usize>() {
    let h: [f64; N] = std::array::from_fn(|i| 1.0 + i as f64 / 8.0);
    for touched in 1..=N {
        let t: [f64; N] = std::array::from_fn(|i| if i < touched { h[i] } else { 0.125 });
        let set =
            Rigid::new(BoxShape::new(vector::<T, N>(h)).unwrap(), SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let s = Seen::from(&solve(&set, &Ball::unit(), &brisk()));
        holds::<T>("on the boundary of a box", &s, 0.0, Want::Roundoffs(2000.0, 2.0 * length(&h)));
        assert!(matches!(s.outcome, Outcome::Touching), "{N} {touched} {s:?}");
        // A Q that points inwards has a positive depth there: the bracket must contain it.
        let inwards: [f64; N] = std::array::from_fn(|i| h[i] / 2.0);
        check(
            "from the boundary inwards",
            &set,
            &Segment::new(vector::<T, N>(inwards)).unwrap(),
            (0..N).map(|i| if i < touched { 4.0 } else { (h[i] + t[i]) / inwards[i] }).fold(f64::MAX, f64::min),
            Want::Truth,
        );
    }
    let corner: Vec<[T; N]> =
        (0..=N).map(|k| std::array::from_fn(|i| if i + 1 == k { T::one() } else { T::zero() })).collect();
    let s = Seen::from(&solve(&Points::new(&corner).unwrap(), &Ball::unit(), &brisk()));
    holds::<T>("at the corner of a simplex", &s, 0.0, Want::Roundoffs(2000.0, 1.0));
    assert_eq!(s.outcome, Outcome::Touching);
    let mut t = [0.0; N];
    t[0] = 1.0;
    let ellipsoid =
        Rigid::new(Ellipsoid::new(vector::<T, N>(h)).unwrap(), SMatrix::identity(), vector::<T, N>(t)).unwrap();
    let s = Seen::from(&solve(&ellipsoid, &Ball::unit(), &brisk()));
    holds::<T>("on an ellipsoid", &s, 0.0, Want::Truth);
}
every_type_and_dimension!(the_origin_on_the_boundary_is_touching, boundaries);

/// Distances in any dimension: box, ellipsoid along an axis, point.
fn distances<T: Real, const N: usize>() {
    let mut dice = Dice::new(27);
    for _ in 0..4 {
        let h = sizes::<T, N>(&mut dice);
        // Far along some axes, beside the box in others.
        let t: [f64; N] = std::array::from_fn(|i| if i == 0 || dice.chance(0.5) { 3.0 + i as f64 / 2.0 } else { 0.25 });
        let gap: [f64; N] = std::array::from_fn(|i| (t[i] - h[i]).max(0.0));
        let set =
            Rigid::new(BoxShape::new(vector::<T, N>(h)).unwrap(), SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let answer = solve(&set, &Ball::unit(), &brisk());
        holds::<T>("away from a box", &Seen::from(&answer), -length(&gap), asked::<T>());
        assert_eq!(answer.outcome, Outcome::Separated);
        let near = answer.witness.point();
        for i in 0..N {
            // A distance within the tolerance leaves the point the square root of it, sideways.
            let sideways = (2.0 * T::RELATIVE_TOLERANCE.to_f64()).sqrt() * length(&gap);
            assert!((near[i].to_f64() - gap[i]).abs() < sideways, "{near:?} {gap:?}");
        }
        // With a radius: that much nearer, through zero.
        for r in [1.0, length(&gap), 6.0] {
            let r = exact::<T>(r);
            let grown = Margin::new(set, T::of(r)).unwrap();
            let s = Seen::from(&solve(&grown, &Ball::unit(), &brisk()));
            holds::<T>("away from a grown box", &s, r - length(&gap), Want::Truth);
        }
        let mut t = [0.0; N];
        t[N - 1] = 5.0;
        let ellipsoid =
            Rigid::new(Ellipsoid::new(vector::<T, N>(h)).unwrap(), SMatrix::identity(), vector::<T, N>(t)).unwrap();
        check("away from an ellipsoid", &ellipsoid, &Ball::unit(), h[N - 1] - 5.0, asked::<T>());
        let q: [f64; N] = std::array::from_fn(|_| exact::<T>(dice.signed()));
        check("away from a point", &Point::new(vector::<T, N>(q)).unwrap(), &Ball::unit(), -length(&q), asked::<T>());
        // Another Q measures distances as the Euclidean ball does.
        let cube = UnitBox::new(vector::<T, N>([3.0; N])).unwrap();
        check("box unit set outside", &set, &cube, -length(&gap), asked::<T>());
        // However long Q is in some direction.
        for along in 0..N {
            let long: [f64; N] = std::array::from_fn(|i| if i == along { 100.0 } else { 0.01 });
            let slab = UnitBox::new(vector::<T, N>(long)).unwrap();
            check("long box unit set outside", &set, &slab, -length(&gap), asked::<T>());
            let end: [f64; N] = std::array::from_fn(|i| if i == along { 1.0 } else { 0.0 });
            let ray = Segment::new(vector::<T, N>(end)).unwrap();
            check("segment unit set outside", &set, &ray, -length(&gap), asked::<T>());
        }
    }
}
every_type_and_dimension!(outside_the_answer_is_minus_the_distance, distances);

/// A threshold on either side of d is decided, rightly, and no slower than the full query.
fn thresholds<T: Real, const N: usize>() {
    let h: [f64; N] = std::array::from_fn(|i| 1.0 + i as f64 / 8.0);
    let cuboid = BoxShape::new(vector::<T, N>(h)).unwrap();
    let full = solve(&cuboid, &Ball::unit(), &brisk());
    for (threshold, outcome) in [
        (0.5, Outcome::Above),
        (0.99, Outcome::Above),
        (1.01, Outcome::Below),
        (2.0, Outcome::Below),
        (-1.0, Outcome::Above),
    ] {
        let options = Options { threshold: Some(T::of(threshold)), ..brisk() };
        let answer = solve(&cuboid, &Ball::unit(), &options);
        assert_eq!(answer.outcome, outcome, "{threshold} {:?}", Seen::from(&answer));
        holds::<T>("threshold", &Seen::from(&answer), 1.0, Want::Truth);
        assert!(answer.iterations <= full.iterations);
    }
    let mut t = [0.0; N];
    t[0] = 3.0;
    let apart = Rigid::new(cuboid, SMatrix::identity(), vector::<T, N>(t)).unwrap();
    for (threshold, outcome) in [
        (0.0, Outcome::Below),
        (-1.0, Outcome::Below),
        (-1.99, Outcome::Below),
        (-2.01, Outcome::Above),
        (-9.0, Outcome::Above),
    ] {
        let options = Options { threshold: Some(T::of(threshold)), ..brisk() };
        let answer = solve(&apart, &Ball::unit(), &options);
        assert_eq!(answer.outcome, outcome, "{threshold} {:?}", Seen::from(&answer));
        holds::<T>("threshold outside", &Seen::from(&answer), -2.0, Want::Truth);
    }
}
every_type_and_dimension!(thresholds_are_decided, thresholds);

/// The wrenches of soft-finger contacts on the x axis (paper, Section II): W is the Minkowski sum of
/// the hulls of the origin and each friction cone at unit normal force, h = sum of max(0, h_i), with
/// h_i = g1 + sqrt(mu^2 (g2^2 + g3^2) + mus^2 g4^2) and g = G_i^T u.
struct Grasp {
    /// (position on the x axis, sign of the inward normal).
    contacts: Vec<(f64, f64)>,
    mu: f64,
    mus: f64,
}

impl Grasp {
    /// Normal force, two tangential ones and the torque about the normal as wrenches (f, p x f).
    fn map<T: Real>(contact: (f64, f64)) -> SMatrix<T, 6, 4> {
        let (x, s) = contact;
        #[rustfmt::skip]
        let rows = [
            s,   0.0, 0.0, 0.0,
            0.0, 1.0, 0.0, 0.0,
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, s,
            0.0, 0.0, -x,  0.0,
            0.0, x,   0.0, 0.0,
        ];
        SMatrix::from_row_slice(&rows.map(T::of))
    }
}

impl<T: Real> Support<T, 6> for Grasp {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        let (mu, mus) = (T::of(self.mu), T::of(self.mus));
        let mut sum = Vector::<T, 6>::zeros();
        for &contact in &self.contacts {
            let map = Self::map::<T>(contact);
            let g = map.tr_mul(u);
            let (a, b, c) = (mu * g[1], mu * g[2], mus * g[3]);
            let s = (a * a + b * b + c * c).root();
            if g[0] + s > T::zero() {
                let share = |x: T| if s > T::zero() { x / s } else { T::zero() };
                sum += map * nalgebra::Vector4::new(T::one(), mu * share(a), mu * share(b), mus * share(c));
            }
        }
        Ok(sum)
    }
    fn extent(&self) -> T {
        T::of(4.0)
    }
}

fn two_soft_fingers() -> Grasp {
    Grasp { contacts: vec![(-0.75, 1.0), (1.3, -1.0)], mu: 0.2, mus: 0.2 }
}

/// Table I of the paper, rows (a1) to (a5): the values in closed form.
fn table_one<T: Real>() {
    let grasp = two_soft_fingers();
    let options = Options { relative: T::of(1e-3), ..brisk() };
    // Large enough for the polytopal Q; the round ones end with Capacity and a true bracket.
    let mut memory = Memory::new::<T, 6>(512, 8192);
    let mut row = |what: &str, q: &dyn UnitSet<T, 6>, d: f64, printed: f64, width: f64| {
        assert!((d - printed).abs() < 1.5e-4, "{what}: the closed form is not the paper's value");
        let s = Seen::from(&memory.solver::<T, 6>().solve(&grasp, q, &options));
        assert_eq!(broken_promise(&s, &options, 512, 8192), None);
        holds::<T>(what, &s, d, Want::Relative(width));
    };
    let ones = vector::<T, 6>([1.0; 6]);
    let a1 = 0.41 / (0.1681f64 + 1.69 + 1.0).sqrt();
    row("a1", &Ball::unit(), a1, 0.2425, 1.0);
    let mut semi = ones;
    semi[0] = T::of(2.0);
    let a2 = 0.41 / (4.0 * 0.1681f64 + 1.69 + 1.0).sqrt();
    row("a2", &UnitEllipsoid::new(semi, SMatrix::identity()).unwrap(), a2, 0.2235, 1.0);
    row("a3", &CrossPolytope::new(ones).unwrap(), 0.41 / 1.3, 0.3154, 0.3);
    row("a4", &UnitBox::new(ones).unwrap(), 0.41 / (0.41 + 2.3 * 2f64.sqrt()), 0.1119, 0.3);
    // x = [-1, 1] on the x axis, as a cross-polytope with one axis and as the hull of two points.
    let axis = vector::<T, 6>([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    row("a5", &CrossPolytope::new(axis).unwrap(), 1.0, 1.0, 1e-3);
    let ends = [axis, -axis].map(|v| v.data.0[0]);
    row("a5", &Vertices::new(&ends).unwrap(), 1.0, 1.0, 1e-3);
}

#[test]
fn table_one_of_the_paper_in_f64() {
    table_one::<f64>();
}

#[test]
fn table_one_of_the_paper_in_f32() {
    table_one::<f32>();
}

// Bodies in space.

fn pair<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>) -> Depth<T> {
    let options = brisk();
    let mut memory = Memory::new::<T, 3>(256, 512);
    let r = memory.solver::<T, 3>().depth(a, b, &options);
    assert_eq!(broken_promise(&Seen::from(&r), &options, 256, 512), None);
    r
}

fn at<T: Real>(shape: &(dyn Support<T, 3> + Sync), x: f64, y: f64, z: f64) -> Body<'_, T> {
    Body::at(shape, vector([x, y, z]))
}

fn near<T: Real>(what: &str, v: &Vector<T, 3>, want: [f64; 3], tolerance: f64) {
    let off = (0..3).map(|i| (v[i].to_f64() - want[i]).abs()).fold(0.0, f64::max);
    assert!(off <= tolerance, "{what}: {v:?} is not {want:?}");
}

fn spheres<T: Real>() {
    let (a, b) = (Sphere::<T, 3>::new(T::of(2.0)).unwrap(), Sphere::<T, 3>::new(T::of(1.5)).unwrap());
    // Centres 1, 3.5 and 5 apart, by Pythagorean triples: the reference is exact.
    let few = 16.0 * T::ROUNDOFF.to_f64();
    for (t, d) in [([0.6, 0.8, 0.0], 2.5), ([0.0, 2.1, 2.8], 0.0), ([3.0, 0.0, -4.0], -1.5), ([1.0, 2.0, 2.0], 0.5)] {
        let t = t.map(exact::<T>);
        let apart = length(&t);
        let r = pair(&at(&a, 1.0, 1.0, 1.0), &at(&b, 1.0 + t[0], 1.0 + t[1], 1.0 + t[2]));
        // The sum 1 + t is rounded in the scalar type.
        let blur = 4.0 * T::ROUNDOFF.to_f64() * 5.0;
        let s = Seen::from(&r);
        assert!(s.lower <= 3.5 - apart + blur && 3.5 - apart - blur <= s.upper, "{s:?}");
        assert!(s.upper - s.lower <= 40.0 * few, "spheres are exact: {s:?}");
        assert!((d - (3.5 - apart)).abs() < 1e-6);
        let n = t.map(|x| x / apart);
        near("normal", &r.normal, n, 1e3 * few);
        near("point on A", &r.point_a, n.map(|x| 1.0 + 2.0 * x), 1e3 * few);
        let on_b = std::array::from_fn(|i| 1.0 + t[i] - 1.5 * n[i]);
        near("point on B", &r.point_b, on_b, 1e3 * few);
    }
    // Concentric: any normal, the full depth, and witnesses that fit the normal.
    let r = pair(&at(&a, 1.0, 2.0, 3.0), &at(&b, 1.0, 2.0, 3.0));
    holds::<T>("concentric spheres", &Seen::from(&r), 3.5, Want::Relative(few));
    let between = (r.point_a - r.point_b) - r.normal * T::of(3.5);
    near("witnesses", &between, [0.0; 3], 1e2 * few);
    // Points are spheres of radius 0.
    let (p, q) = (Sphere::<T, 3>::new(T::zero()).unwrap(), Point::new(vector::<T, 3>([0.0; 3])).unwrap());
    let r = pair(&at(&p, 0.0, 0.0, 0.0), &at(&q, 2.0, 3.0, 6.0));
    holds::<T>("two points", &Seen::from(&r), -7.0, Want::Relative(10.0 * few));
    let r = pair(&at(&p, 1.0, 1.0, 1.0), &at(&q, 1.0, 1.0, 1.0));
    holds::<T>("one point twice", &Seen::from(&r), 0.0, Want::Roundoffs(100.0, 2.0));
}

#[test]
fn spheres_are_exact_at_any_distance() {
    spheres::<f64>();
    spheres::<f32>();
}

fn capsules<T: Real>() {
    let few = 16.0 * T::ROUNDOFF.to_f64();
    let capsule = Capsule::new(T::of(0.5), T::of(2.0)).unwrap();
    // Parallel, side by side: overlapping, touching, apart.
    for (x, d) in [(0.25, 0.75), (0.75, 0.25), (1.0, 0.0), (3.0, -2.0)] {
        let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &at(&capsule, x, 0.0, 0.5));
        holds::<T>("parallel capsules", &Seen::from(&r), d, Want::Roundoffs(1e3, 5.0));
        near("normal", &r.normal, [1.0, 0.0, 0.0], 1e3 * few);
        assert!(
            (r.point_a.x.to_f64() - 0.5).abs() < 100.0 * few && (r.point_b.x.to_f64() - (x - 0.5)).abs() < 100.0 * few
        );
        assert!((r.point_a.z - r.point_b.z).abs().to_f64() < 1e3 * few, "{r:?}");
    }
    // End to end on one axis.
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &at(&capsule, 0.0, 0.0, 5.5));
    holds::<T>("capsules end to end", &Seen::from(&r), -0.5, Want::Roundoffs(1e3, 10.0));
    near("point on A", &r.point_a, [0.0, 0.0, 2.5], 1e2 * few);
    near("point on B", &r.point_b, [0.0, 0.0, 3.0], 1e2 * few);
    // Crossed at a right angle: the axes are 0.75 apart.
    let quarter = Matrix3::<T>::from_row_slice(&[0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0].map(T::of));
    let lying = Body::new(&capsule, quarter, vector([0.25, 0.75, 0.5])).unwrap();
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &lying);
    holds::<T>("crossed capsules", &Seen::from(&r), 0.25, Want::Roundoffs(1e3, 5.0));
    near("normal", &r.normal, [0.0, 1.0, 0.0], 1e3 * few);
    near("point on A", &r.point_a, [0.0, 0.5, 0.5], 1e3 * few);
    near("point on B", &r.point_b, [0.0, 0.25, 0.5], 1e3 * few);
    // Crossed axes that meet: any of the two directions along the common perpendicular.
    let lying = Body::new(&capsule, quarter, vector([0.0, 0.0, 0.0])).unwrap();
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &lying);
    holds::<T>("capsules that share their centre", &Seen::from(&r), 1.0, asked::<T>());
    assert!((r.normal.y.to_f64().abs() - 1.0).abs() < 1e-3, "{r:?}");
    // The same segment: perpendicular to it, every direction.
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &at(&capsule, 0.0, 0.0, 0.0));
    holds::<T>("one capsule twice", &Seen::from(&r), 1.0, asked::<T>());
    assert!(r.normal.z.to_f64().abs() < 1e-2, "{r:?}");
    // On one axis, overlapping: sideways by 1, or by 2.5 + 2.5 - 1 along the axis.
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &at(&capsule, 0.0, 0.0, 1.0));
    holds::<T>("capsules on one axis", &Seen::from(&r), 1.0, asked::<T>());
    // Capsule and sphere: a point against a segment.
    let sphere = Sphere::<T, 3>::new(T::of(0.25)).unwrap();
    let r = pair(&at(&capsule, 0.0, 0.0, 0.0), &at(&sphere, 3.0, 0.0, 6.0));
    holds::<T>("capsule and sphere", &Seen::from(&r), -4.25, asked::<T>());
    near("point on A", &r.point_a, [0.3, 0.0, 2.4], 1e3 * few);
}

#[test]
fn capsules_parallel_crossed_and_coaxial() {
    capsules::<f64>();
    capsules::<f32>();
}

fn solids<T: Real>() {
    let few = 16.0 * T::ROUNDOFF.to_f64();
    let cuboid = BoxShape::new(vector::<T, 3>([1.0, 2.0, 3.0])).unwrap();
    let cylinder = Cylinder::new(T::of(1.0), T::of(2.0)).unwrap();
    let cone = Cone::new(T::of(1.0), T::of(2.0)).unwrap();
    let sphere = Sphere::<T, 3>::new(T::of(0.5)).unwrap();
    let origin = |shape| at::<T>(shape, 0.0, 0.0, 0.0);
    // Sphere and box: face, edge and corner.
    let r = pair(&origin(&cuboid), &at(&sphere, 1.25, 0.5, 0.5));
    holds::<T>("sphere in a face", &Seen::from(&r), 0.25, asked::<T>());
    near("point on A", &r.point_a, [1.0, 0.5, 0.5], 1e3 * few);
    near("point on B", &r.point_b, [0.75, 0.5, 0.5], 1e3 * few);
    let r = pair(&origin(&cuboid), &at(&sphere, 1.3, 2.4, 0.5));
    holds::<T>(
        "sphere at an edge",
        &Seen::from(&r),
        0.5 - f64::hypot(exact::<T>(1.3) - 1.0, exact::<T>(2.4) - 2.0),
        Want::Roundoffs(1e4, 5.0),
    );
    let r = pair(&origin(&cuboid), &at(&sphere, 3.0, 4.0, 4.0));
    holds::<T>("sphere off a corner", &Seen::from(&r), -2.5, asked::<T>());
    near("point on A", &r.point_a, [1.0, 2.0, 3.0], 1e3 * few);
    let r = pair(&origin(&cuboid), &at(&sphere, 0.5, 0.0, 0.0));
    holds::<T>("sphere inside", &Seen::from(&r), 1.0, asked::<T>());
    // Boxes face to face.
    let r = pair(&origin(&cuboid), &at(&cuboid, 1.5, 0.25, -0.5));
    holds::<T>("two boxes", &Seen::from(&r), 0.5, asked::<T>());
    near("normal", &r.normal, [1.0, 0.0, 0.0], 1e3 * few);
    let r = pair(&origin(&cuboid), &at(&cuboid, -5.0, 0.0, 0.0));
    holds::<T>("two boxes apart", &Seen::from(&r), -3.0, asked::<T>());
    near("normal", &r.normal, [-1.0, 0.0, 0.0], 1e3 * few);
    assert!((r.point_a.x.to_f64() + 1.0).abs() < 1e2 * few && (r.point_b.x.to_f64() + 4.0).abs() < 1e2 * few);
    assert_eq!(r.outcome, Outcome::Separated);
    // Identical boxes: out through the thinnest side.
    let r = pair(&origin(&cuboid), &origin(&cuboid));
    holds::<T>("one box twice", &Seen::from(&r), 2.0, asked::<T>());
    // Cylinders: on end, side by side, coaxial.
    let r = pair(&origin(&cylinder), &at(&cylinder, 0.25, 0.0, 3.5));
    holds::<T>("cylinders on end", &Seen::from(&r), 0.5, asked::<T>());
    near("normal", &r.normal, [0.0, 0.0, 1.0], 1e3 * few);
    let r = pair(&origin(&cylinder), &at(&cylinder, 1.5, 0.0, 0.25));
    holds::<T>("cylinders side by side", &Seen::from(&r), 0.5, asked::<T>());
    near("normal", &r.normal, [1.0, 0.0, 0.0], 2e-2);
    let r = pair(&origin(&cylinder), &at(&cylinder, 0.9, 1.2, 0.0));
    holds::<T>(
        "cylinders diagonally",
        &Seen::from(&r),
        2.0 - f64::hypot(exact::<T>(0.9), exact::<T>(1.2)),
        asked::<T>(),
    );
    let r = pair(&origin(&cylinder), &at(&cylinder, 3.0, 4.0, 1.0));
    holds::<T>("cylinders apart", &Seen::from(&r), -3.0, asked::<T>());
    // Cone: point on the axis inside the base; sphere above the apex.
    let r = pair(&origin(&cone), &at(&sphere, 0.0, 0.0, 3.0));
    holds::<T>("sphere above a cone", &Seen::from(&r), -0.5, asked::<T>());
    near("point on A", &r.point_a, [0.0, 0.0, 2.0], 1e3 * few);
    let r = pair(&origin(&cone), &at(&sphere, 0.25, 0.0, -2.25));
    holds::<T>("sphere under a cone", &Seen::from(&r), 0.25, asked::<T>());
    // From the centre to the slant: height 4, radius 1, so the side is at distance 0.5 * 4 / sqrt(17).
    let point = Point::new(vector::<T, 3>([0.0; 3])).unwrap();
    let r = pair(&origin(&cone), &origin(&point));
    holds::<T>("point in a cone", &Seen::from(&r), 2.0 / 17f64.sqrt(), Want::Relative(1e-3));
    // Two unit cubes, one turned by 45 degrees about z: edge against face.
    let cube = BoxShape::new(vector::<T, 3>([1.0; 3])).unwrap();
    let s = exact::<T>(std::f64::consts::FRAC_1_SQRT_2);
    let turn = Matrix3::<T>::from_row_slice(&[s, -s, 0.0, s, s, 0.0, 0.0, 0.0, 1.0].map(T::of));
    for (x, d) in [(2.0, 1.0 + 2.0 * s - 2.0), (3.0, 1.0 + 2.0 * s - 3.0)] {
        let turned = Body::new(&cube, turn, vector([x, 0.0, 0.0])).unwrap();
        let r = pair(&origin(&cube), &turned);
        holds::<T>("edge against face", &Seen::from(&r), d, asked::<T>());
        near("normal", &r.normal, [1.0, 0.0, 0.0], 1e3 * few);
    }
}

#[test]
fn spheres_boxes_cylinders_and_cones() {
    solids::<f64>();
    solids::<f32>();
}

/// Plates, needles and points as bodies: the difference is flat, and the depth 0 or minus the distance.
fn flat_bodies<T: Real>() {
    let plate = BoxShape::new(vector::<T, 3>([1.0, 2.0, 0.0])).unwrap();
    let needle = BoxShape::new(vector::<T, 3>([0.0, 0.0, 1.0])).unwrap();
    let lying = BoxShape::new(vector::<T, 3>([1.0, 0.0, 0.0])).unwrap();
    let origin = |shape| at::<T>(shape, 0.0, 0.0, 0.0);
    let coplanar = pair(&origin(&plate), &at(&plate, 0.5, 0.5, 0.0));
    holds::<T>("coplanar plates", &Seen::from(&coplanar), 0.0, Want::Roundoffs(500.0, 6.0));
    assert_eq!((coplanar.dimension, coplanar.outcome), (2, Outcome::Degenerate));
    assert!((coplanar.normal.z.to_f64().abs() - 1.0).abs() < 1e-3, "{coplanar:?}");
    let stacked = pair(&origin(&plate), &at(&plate, 0.5, 0.5, 0.25));
    holds::<T>("stacked plates", &Seen::from(&stacked), -0.25, asked::<T>());
    let beside = pair(&origin(&plate), &at(&plate, 3.0, 0.5, 0.0));
    holds::<T>("plates side by side", &Seen::from(&beside), -1.0, asked::<T>());
    // A needle through a plate has a difference with volume: 2 x 4 x 2, and the needle's ends are the nearest
    // way out.
    let through = pair(&origin(&plate), &at(&needle, 0.25, 0.5, 0.5));
    holds::<T>("needle through a plate", &Seen::from(&through), 0.5, asked::<T>());
    let along = pair(&origin(&plate), &at(&lying, 0.25, 0.5, 0.0));
    holds::<T>("needle in a plate", &Seen::from(&along), 0.0, Want::Roundoffs(500.0, 6.0));
    assert_eq!(along.dimension, 2);
    let one_line = pair(&origin(&lying), &at(&lying, 0.5, 0.0, 0.0));
    holds::<T>("needles on one line", &Seen::from(&one_line), 0.0, Want::Roundoffs(500.0, 4.0));
    assert_eq!((one_line.dimension, one_line.outcome), (1, Outcome::Degenerate));
    let crossed = pair(&origin(&lying), &at(&needle, 0.25, 0.0, 0.0));
    holds::<T>("crossed needles", &Seen::from(&crossed), 0.0, Want::Roundoffs(500.0, 4.0));
    assert_eq!(crossed.dimension, 2);
    let skew = pair(&origin(&lying), &at(&needle, 0.25, 0.5, 0.0));
    holds::<T>("skew needles", &Seen::from(&skew), -0.5, asked::<T>());
    // A flat core with a radius is a full body: two discs of thickness 1/2.
    let padded = Margin::new(plate, T::of(0.25)).unwrap();
    let r = pair(&origin(&padded), &at(&padded, 0.5, 0.5, 0.125));
    holds::<T>("padded plates", &Seen::from(&r), 0.375, Want::Relative(1e-3));
    let r = pair(&origin(&padded), &at(&padded, 0.5, 0.5, 0.0));
    holds::<T>("coplanar padded plates", &Seen::from(&r), 0.5, Want::Relative(1e-3));
}

#[test]
fn flat_bodies_touch_or_are_apart() {
    flat_bodies::<f64>();
    flat_bodies::<f32>();
}

/// Thresholds of a pair: the certain answer, on either side.
#[test]
fn a_pair_is_decided_against_a_threshold() {
    let cube = BoxShape::new(vector::<f64, 3>([1.0; 3])).unwrap();
    let mut memory = Memory::new::<f64, 3>(64, 128);
    for (x, threshold, outcome) in [
        (1.5, 0.25, Outcome::Above),
        (1.5, 0.75, Outcome::Below),
        (1.5, 0.0, Outcome::Above),
        (2.5, 0.0, Outcome::Below),
        (2.5, -0.25, Outcome::Below),
        (2.5, -0.75, Outcome::Above),
        (100.0, -1.0, Outcome::Below),
    ] {
        let options = Options { threshold: Some(threshold), ..brisk() };
        let r = memory.solver::<f64, 3>().depth(&at(&cube, 0.0, 0.0, 0.0), &at(&cube, x, 0.125, 0.25), &options);
        assert_eq!(r.outcome, outcome, "{x} {threshold}: {r:?}");
        holds::<f64>("threshold", &Seen::from(&r), 2.0 - x, Want::Truth);
    }
}

/// Vectors of a body that is used in two places keep their own frame: witnesses are in the world frame.
#[test]
fn witnesses_are_in_the_world_frame() {
    let cuboid = BoxShape::new(Vector3::new(1.0, 2.0, 3.0)).unwrap();
    let turn = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let a = Body::new(&cuboid, turn, Vector3::new(10.0, 20.0, 30.0)).unwrap();
    let tip = Sphere::<f64, 3>::new(0.5).unwrap();
    // A's half extents are 2, 1, 3 in the world: its side at x = 12.
    let b = Body::at(&tip, Vector3::new(14.0, 20.25, 31.0));
    let r = pair(&a, &b);
    holds::<f64>("sphere beside a turned box", &Seen::from(&r), -1.5, asked::<f64>());
    near("normal", &r.normal, [1.0, 0.0, 0.0], 1e-9);
    near("point on A", &r.point_a, [12.0, 20.25, 31.0], 1e-9);
    near("point on B", &r.point_b, [13.5, 20.25, 31.0], 1e-9);
}
