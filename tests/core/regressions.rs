//! What fuzzing (`fuzz/src/bin/fuzz.rs`) and the other tests found, as small as it gets, by name. An ignored test is
//! a bug that is known and not fixed.

use crate::common;

use common::cases::{Placed, Shape};
use common::dd::{BLUR, Dd, v3};
use common::dice::Dice;
use common::exact::pair_value;
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, Vertices};
use qdist::support::{BoxShape, Ellipsoid, Failure, Linear, Margin, Points, Rigid, Sphere, Sum, Support};
use qdist::{Options, Outcome, Plan, Real, Vector};
use std::cell::Cell;

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn body(kind: &str, numbers: &[f64], rotation: [f64; 9], translation: [f64; 3]) -> Placed {
    Placed { shape: Shape { kind: kind.to_string(), numbers: numbers.to_vec() }, rotation, translation }
}

/// The bracket of a pair, which keeps all promises, and whose lower bound does not exceed what `directions` prove.
fn pair<T: Real>(a: &Placed, b: &Placed, directions: &[[f64; 3]]) -> Seen {
    let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    let options = brisk();
    let mut memory = Memory::new::<T, 3>(256, 512);
    let r = memory.solver::<T, 3>().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
    let seen = Seen::from(&r);
    assert_eq!(broken_promise(&seen, &options, 256, 512), None, "{r:?}");
    let size = a.shape.numbers.iter().chain(&b.shape.numbers).fold(0.0f64, |m, x| m.max(x.abs()));
    let blur = Dd::new(BLUR * (size + a.translation.iter().chain(&b.translation).map(|x| x.abs()).sum::<f64>()));
    let own = [r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64);
    let proved = pair_value(a, b, &v3(own));
    assert!(proved <= Dd::new(seen.upper) + blur, "the normal proves {:e} only: {r:?}", proved.hi);
    for u in directions {
        let proved = pair_value(a, b, &v3(*u));
        assert!(Dd::new(seen.lower) <= proved + blur, "{u:?} proves depth <= {:e}: {r:?}", proved.hi);
    }
    seen
}

/// The surface of a thin difference folded: two facets with the same vertices and the same normal, one of them
/// turned inside out. No facet was below the lower bound, but the surface did not go around the origin.
#[test]
fn sliver_facets_that_turn_inside_out_in_f32() {
    let at = [206682.15625, -368593.6875, -69178.25];
    let a = body("ellipsoid", &[567.65283203125, 567.65283203125, 378.43524169921875], IDENTITY, at);
    let c = 1837052.125;
    let b = body("hull", &[c, c, c, -c, -c, -c, c, -c, c], IDENTITY, at);
    pair::<f32>(&a, &b, &[[-0.4082108996931551, -0.40828568007039345, 0.8164965797975894]]);
}

/// A small disc beside a plate, 2.5e-9 apart, was found inside it.
#[test]
fn sliver_facets_that_turn_inside_out_in_f64() {
    let turn = [0.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0];
    let a =
        body("cone", &[7.191731575218322e-9, 0.0], turn, [-66558.87185060514, -16350.638986851696, 178849.96512849745]);
    #[rustfmt::skip]
    let tilt = [
        -0.8306892925167055, -0.5549360947541915, -0.04473510966860857,
        -0.5388676610118638, 0.781234261332864, 0.3151105723953063,
        -0.13991763010320912, 0.2858652823598234, -0.9480000512276568,
    ];
    let b = body(
        "box",
        &[0.0, 0.7615809072902106, 1.1015206189407805],
        tilt,
        [-66558.76389954229, -16350.937516808048, 178850.4739588624],
    );
    pair::<f64>(&a, &b, &[[-0.8306892925167054, -0.5388676610118638, -0.13991763010320907]]);
}

/// The same in four dimensions, with a ray in a thin box: lower > upper.
#[test]
fn thin_boxes_in_four_dimensions() {
    #[rustfmt::skip]
    let turn = SMatrix::<f64, 4, 4>::from_row_slice(&[
        0.8192338943481445, 0.36123135685920715, 0.3570689558982849, 0.2662133276462555,
        -0.32364922761917114, 0.5572152733802795, 0.5639162659645081, -0.5164889097213745,
        -0.47069892287254333, 0.1674026995897293, 0.30651983618736267, 0.8102249503135681,
        -0.05049343407154083, 0.7286970019340515, -0.67863529920578, 0.07684545964002609,
    ]);
    let thin =
        BoxShape::new(Vector::from([1.0620429515838623, 5.31307975393247e-9, 1.5738245906504744e-7, 0.0])).unwrap();
    let set = Margin::new(Rigid::new(thin, turn, Vector::zeros()).unwrap(), 8.57301873935512e-9).unwrap();
    let ray = [-0.33436933159828186, -0.591943621635437, -0.5885173678398132, 0.43754681944847107];
    general(&set, &Segment::new(Vector::from(ray)).unwrap());
}

/// Again, flattened by a linear map, with a small ball inside.
#[test]
fn a_flattened_set_with_a_small_ball_in_four_dimensions() {
    #[rustfmt::skip]
    let map = SMatrix::<f64, 4, 4>::from_row_slice(&[
        0.11884836107492447, -0.06353690475225449, -0.14217601716518402, -0.19737136363983154,
        -1.2377711534500122, 0.14073386788368225, 0.496372789144516, 0.1576375961303711,
        -0.484654039144516, -0.08439212292432785, -1.0228191614151, 0.1789035201072693,
        -0.6989096403121948, 0.11748950928449631, -0.22786860167980194, -0.28897762298583984,
    ]);
    let thick = BoxShape::new(Vector::from([0.9201626181602478, 0.75, 0.7682242393493652, 0.0])).unwrap();
    let inner = Sum::new(thick, Sphere::new(1.6996777318922796e-8).unwrap());
    let set = Linear::new(inner, map, Vector::zeros()).unwrap();
    general(&set, &Segment::new(Vector::from([1.0, 0.0, 1.25, 1.0])).unwrap());
}

fn general<const N: usize>(set: &dyn Support<f64, N>, unit: &dyn UnitSet<f64, N>) -> Seen {
    let options = brisk();
    let mut memory = Memory::new::<f64, N>(128, 1024);
    let seen = Seen::from(&memory.solver::<f64, N>().solve(set, unit, &options));
    assert_eq!(broken_promise(&seen, &options, 128, 1024), None, "{seen:?}");
    seen
}

/// An ellipsoid is a core and a ball inside the crate, and the ball ignored that the body's matrix is not quite
/// orthonormal.
#[test]
fn an_ellipsoid_under_a_matrix_of_seven_digits() {
    // A diagonal matrix with entries off by 1e-5, within what `Body::new` takes.
    let stretch = [1.0 + 1e-5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let a = body("ellipsoid", &[1.0, 1.0, 1.0], stretch, [0.0; 3]);
    let b = body("box", &[1.0, 10.0, 10.0], IDENTITY, [1.5, 0.0, 0.0]);
    let seen = pair::<f64>(&a, &b, &[[1.0, 0.0, 0.0]]);
    assert!(seen.lower <= 0.50001 && 0.50001 <= seen.upper + 1e-15, "{seen:?}");
}

/// One point twice: the squares of a rounding error of 1e-25 underflow.
#[test]
fn points_nearer_than_the_root_of_the_smallest_number() {
    let a = body("sphere", &[0.0], IDENTITY, [0.0; 3]);
    let b = body("sphere", &[0.0], IDENTITY, [0.0, 0.0, -2.407412430484045e-34]);
    pair::<f32>(&a, &b, &[]);
    let b = body("sphere", &[0.0], IDENTITY, [0.0, 0.0, -2e-200]);
    pair::<f64>(&a, &b, &[]);
}

/// Needles of 5e-12 and 8e-15 (sizes that are legal in f32): products of three lengths underflow, and witnesses
/// were NaN.
#[test]
fn needles_of_a_millionth_of_a_millionth_in_f32() {
    let (thin, long) = (7.704535455259863e-15, 4.7029554729738354e-12);
    let a = body("cylinder", &[thin, long], IDENTITY, [0.0; 3]);
    let turn = [0.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0];
    let b =
        body("cylinder", &[thin, long], turn, [1.5409070910519726e-14, -4.7029554729738354e-12, 4.710667619867159e-12]);
    let (sa, sb) = (a.shape.build::<f32>(&[]).unwrap(), b.shape.build::<f32>(&[]).unwrap());
    for limit in [None, Some(5), Some(33)] {
        for (vertices, facets) in [(6, 6), (64, 128)] {
            let options = Options { max_iterations: limit, relative: 0.0, guess: Some(Vector::zeros()), ..brisk() };
            let mut memory = Memory::new::<f32, 3>(vertices, facets);
            let r = memory.solver::<f32, 3>().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
            assert_eq!(broken_promise(&Seen::from(&r), &options, vertices, facets), None, "{r:?}");
            assert!(r.point_a.iter().chain(r.point_b.iter()).all(|x| x.is_finite()), "{r:?}");
        }
    }
}

/// The reported direction was 3e-5 short of a unit vector, and the upper bound takes it for one.
#[test]
fn a_point_at_the_apex_of_a_cone_in_f32() {
    #[rustfmt::skip]
    let tilt = [
        1.0, -1.071875471410702e-14, 1.8248681103553988e-14,
        1.071875471410702e-14, 1.0, -2.5220819356575053e-14,
        -1.8248681103553988e-14, 2.5220819356575053e-14, 1.0,
    ];
    let a = body("cone", &[0.1151161789894104, 1.3573238849639893], tilt, [0.0; 3]);
    let at = [2.476936943041335e-14, -3.423282301075539e-14, 1.3573238849639893];
    let b = body("sphere", &[0.0], IDENTITY, at);
    pair::<f32>(&a, &b, &[]);
}

/// Two points far from their frames, 4e-12 apart: what the sum that cancels leaves is of the size of their distance.
#[test]
fn points_far_from_their_frames() {
    let p = [0.0, -34167.2734375, -34167.2734375];
    #[rustfmt::skip]
    let tilt = [
        1.0, 1.5228254421351117e-11, -1.3498708227588363e-11,
        -1.5228254421351117e-11, 1.0, 5.83046111390928e-11,
        1.3498708227588363e-11, -5.83046111390928e-11, 1.0,
    ];
    let a = body("hull", &p, IDENTITY, [0.0; 3]);
    let b = body("hull", &p, tilt, [5.9093878235216835e-8, 1.9921096736652544e-6, -1.992113539017737e-6]);
    pair::<f32>(&a, &b, &[[0.00012920049379839356, 0.020820687978679173, -0.999783217632366]]);
    // The same point under the same tiny turn: d is 0.
    let p = [-0.007826474495232105, 0.018241850659251213, 0.03335132449865341];
    #[rustfmt::skip]
    let tilt = [
        1.0, -2.1055061929369667e-17, -1.643070375180829e-17,
        2.1055061929369667e-17, 1.0, -3.539718591967954e-17,
        1.643070375180829e-17, 3.539718591967954e-17, 1.0,
    ];
    let a = body("hull", &p, tilt, [0.0; 3]);
    let seen = pair::<f32>(&a, &a, &[]);
    assert!(seen.upper >= 0.0, "{seen:?}");
}

/// A box with words of its own about its extent, error and radius.
struct Talkative {
    radius: f64,
    extent: f64,
    error: f64,
}

impl Support<f64, 3> for Talkative {
    fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        Ok(u.map(|x| if x < 0.0 { -1.0 } else { 1.0 }))
    }
    fn radius(&self) -> f64 {
        self.radius
    }
    fn extent(&self) -> f64 {
        self.extent
    }
    fn error(&self) -> f64 {
        self.error
    }
}

/// What is not a number in these words must not come out as a bracket.
#[test]
fn extent_error_and_radius_that_are_no_numbers() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for set in [
            Talkative { radius: bad, extent: 2.0, error: 0.0 },
            Talkative { radius: 0.0, extent: bad, error: 0.0 },
            Talkative { radius: 0.0, extent: 2.0, error: bad },
        ] {
            let mut memory = Memory::new::<f64, 3>(64, 128);
            for seen in [
                Seen::from(&memory.solver::<f64, 3>().solve(&set, &Ball::unit(), &brisk())),
                Seen::from(&memory.solver::<f64, 3>().solve(
                    &set,
                    &UnitBox::new(Vector::from([1.0; 3])).unwrap(),
                    &brisk(),
                )),
            ] {
                assert!(seen.lower <= seen.upper, "{} {} {}: {seen:?}", set.radius, set.extent, set.error);
                assert!(seen.lower <= 1.0 || seen.outcome == Outcome::SupportFailed, "{seen:?}");
            }
        }
    }
}

/// Outside, d is minus the distance for every Q; the direction must be chosen by height, not by h_A/h_Q.
#[test]
fn a_long_unit_outside_a_box() {
    let cube = BoxShape::new(Vector::from([1.0, 1.0])).unwrap();
    let beside = Rigid::new(cube, SMatrix::identity(), Vector::from([3.0, 3.0])).unwrap();
    let seen = general(&beside, &UnitBox::new(Vector::from([100.0, 0.01])).unwrap());
    let d = -(8f64.sqrt());
    assert!(seen.lower <= d && d <= seen.upper + 1e-15, "{seen:?}");
    assert!(seen.upper - seen.lower <= 1e-6 * 2.9, "{seen:?}");
}

/// One more iteration must not cost what the stored vertices have proved.
#[test]
fn a_limit_just_after_the_origin_was_found_outside() {
    let h: [f64; 5] = [1.0, 1.25, 1.5, 0.75, 0.5];
    let mut t = [0.125; 5];
    t[0] = h[0] + 1e-3;
    let set = Rigid::new(BoxShape::new(Vector::from(h)).unwrap(), SMatrix::identity(), Vector::from(t)).unwrap();
    let mut best = f64::MIN;
    for limit in 1..20 {
        let options = Options { max_iterations: Some(limit), relative: 0.0, ..brisk() };
        let mut memory = Memory::new::<f64, 5>(64, 512);
        let seen = Seen::from(&memory.solver::<f64, 5>().solve(&set, &Ball::unit(), &options));
        assert!(seen.lower >= best - 1e-12, "{limit}: {best:e} before, {seen:?}");
        best = best.max(seen.lower);
    }
}

/// Nearly round in the plane of a flattened ellipsoid: the ball term and the core must still add up to the ellipsoid.
#[test]
fn an_ellipsoid_alone_is_its_least_semi_axis() {
    for semi in [[1.0, 1.0, 1.0], [1.0, 1.5, 2.0], [0.3, 1.0, 1.0], [1e-9, 1.0, 1.0], [0.0, 1.0, 1.0]] {
        let options = brisk();
        let mut memory = Memory::new::<f64, 3>(256, 512);
        let set = Ellipsoid::new(Vector::from(semi)).unwrap();
        let seen = Seen::from(&memory.solver::<f64, 3>().solve(&set, &Ball::unit(), &options));
        assert!(seen.lower <= semi[0] && semi[0] <= seen.upper, "{semi:?} {seen:?}");
    }
}

/// Two soft fingers on the x axis (Table I of the paper).
struct TwoFingers;

impl Support<f64, 6> for TwoFingers {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        let mut sum = Vector::<f64, 6>::zeros();
        for (x, s) in [(-0.75, 1.0), (1.3, -1.0)] {
            let g = [u[1] + x * u[5], u[2] - x * u[4], s * u[3]];
            let length = 0.2 * (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]).sqrt();
            if s * u[0] + length > 0.0 {
                let f = g.map(|x| if length > 0.0 { 0.04 * x / length } else { 0.0 });
                sum += Vector::from([s, f[0], f[1], s * f[2], -x * f[1], x * f[0]]);
            }
        }
        Ok(sum)
    }
    fn extent(&self) -> f64 {
        3.0
    }
}

/// Cut short before any pass over the cones was complete, and before the first polytope had the origin inside: the polytope of the
/// cone in work was taken for that of A, and its lower bound for one of d (0.2349 for 0.2236, `Converged`).
#[test]
fn an_iteration_limit_in_the_middle_of_a_cone() {
    let q = UnitEllipsoid::new(Vector::from([2.0, 1.0, 1.0, 1.0, 1.0, 1.0]), SMatrix::identity()).unwrap();
    let d = 0.41 / (4.0 * 0.1681f64 + 1.69 + 1.0).sqrt();
    for size in [(18, 24), (20, 30), (24, 40)] {
        let mut best = f64::MIN;
        for limit in 1..400 {
            let options = Options { max_iterations: Some(limit), relative: 1e-3, ..Options::default() };
            let mut memory = Memory::new::<f64, 6>(size.0, size.1);
            let seen = Seen::from(&memory.solver::<f64, 6>().solve(&TwoFingers, &q, &options));
            assert!(seen.lower <= d && d <= seen.upper, "{size:?} {limit}: {seen:?}");
            // What the first polytope has shown is not forgotten.
            assert!(seen.lower >= best - 1e-12, "{size:?} {limit}: {best} before, {seen:?}");
            best = best.max(seen.lower);
        }
    }
}

/// The first vertex was the origin itself, so nothing was known of A's size; whatever had no progress along an axis was taken for flat
/// without a look at the other side.
#[test]
fn a_first_vertex_in_the_origin() {
    let points = [[0.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]];
    let set = Points::new(&points).unwrap();
    let mut memory = Memory::new::<f64, 3>(64, 128);
    let answer = memory.solver::<f64, 3>().solve(&set, &Ball::unit(), &brisk());
    assert_eq!((answer.outcome, answer.dimension), (Outcome::Touching, 3), "{:?}", Seen::from(&answer));
    // In the plane x = 0, its projection has the origin deep inside.
    let answer = memory.solver::<f64, 3>().solve_in_span(&set, &Ball::unit(), &brisk());
    assert!(answer.lower <= 0.0 && 0.0 <= answer.upper, "{:?}", Seen::from(&answer));
}

/// A flat set that contains the origin by definition, and rays along it: a limit on their way was told as precision, or as an open set.
#[test]
fn a_limit_while_rays_run_along_a_flat_set() {
    for (half, target, last) in [([1.0, 0.7, 0.0], [0.3, 0.2, 0.0], 20), ([0.0, 0.3, 0.9], [0.0, 0.2, 0.1], 10)] {
        let set = BoxShape::new(Vector::from(half)).unwrap();
        let segment = Segment::new(Vector::from(target)).unwrap();
        for limit in 0..last {
            let options = Options { max_iterations: Some(limit), ..Options::default() };
            let mut memory = Memory::new::<f64, 3>(64, 128);
            let seen = Seen::from(&memory.solver::<f64, 3>().solve(&set, &segment, &options));
            assert_eq!(seen.outcome, Outcome::Iterations, "{half:?} {limit}: {seen:?}");
        }
    }
}

/// A set that answers so many times.
struct Answers<S> {
    set: S,
    left: Cell<u32>,
}

impl<S: Support<f64, N>, const N: usize> Support<f64, N> for Answers<S> {
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        let left = self.left.get().checked_sub(1).ok_or(Failure(7))?;
        self.left.set(left);
        self.set.support(u)
    }
    fn extent(&self) -> f64 {
        self.set.extent()
    }
    fn contains_origin(&self) -> bool {
        true
    }
}

/// The plan that ends the query when the set always answers. Until then each answer more costs nothing of the lower bound.
fn failing_later_and_later<const N: usize>(
    set: impl Support<f64, N> + Copy,
    q: &dyn UnitSet<f64, N>,
    relative: f64,
) -> Plan {
    let options = Options { max_iterations: Some(100_000), relative, ..Options::default() };
    let mut best = f64::MIN;
    for calls in 1.. {
        let set = Answers { set, left: Cell::new(calls) };
        let mut memory = Memory::new::<f64, N>(500, 4000);
        let answer = memory.solver::<f64, N>().solve(&set, q, &options);
        assert!(answer.lower >= best - 1e-12, "{calls}: {best} before, {:?}", Seen::from(&answer));
        best = best.max(answer.lower);
        if answer.outcome != Outcome::SupportFailed {
            return answer.plan;
        }
    }
    unreachable!()
}

/// When the support function failed during an expansion, its lower bound was lost, and that of the rays that took turns with it (0 for 0.44).
#[test]
fn a_failure_does_not_cost_what_was_shown() {
    let mut dice = Dice::new(41);
    let points: Vec<[f64; 6]> = (0..12).map(|_| dice.direction()).collect();
    let q = Vertices::new(&points).unwrap();
    let round = Ellipsoid::new(Vector::from([1.0, 1.3, 1.6, 1.9, 2.2, 2.5])).unwrap();
    assert_eq!(failing_later_and_later(round, &q, 1e-3), Plan::Rays);
    let set = BoxShape::new(Vector::from([1.0, 1.3, 1.6, 1.9, 2.2, 2.5])).unwrap();
    failing_later_and_later(set, &q, 1e-3);
    let set = Ellipsoid::new(Vector::from([1.0, 1.3])).unwrap();
    failing_later_and_later(set, &CrossPolytope::new(Vector::from([1.0, 0.7])).unwrap(), 1e-15);
    let set = Ellipsoid::new(Vector::from([1.0, 1.3, 2.0])).unwrap();
    assert_eq!(failing_later_and_later(set, &Ball::unit(), 1e-9), Plan::Expansion);
    failing_later_and_later(set, &UnitBox::new(Vector::from([1.0, 0.7, 0.5])).unwrap(), 1e-9);
}
