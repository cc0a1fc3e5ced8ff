//! Minimisers on an arc, or nearly so: corners and edges on the axis of a body of revolution, and bodies of revolution about nearly the same
//! axis. Each bracket is checked in double-double from both sides: the normal must prove `upper`, and no direction that a search finds may
//! prove less than `lower`.

use crate::common;

use common::cases::{Placed, Shape};
use common::dd::{BLUR, Dd, v3};
use common::dice::Dice;
use common::exact::{pair_value, searched_upper};
use common::memory::{Memory, Seen, broken_promise};
use nalgebra::{Rotation3, Unit, Vector3};
use qdist::support::{Failure, Support, Symmetry};
use qdist::{Body, Depth, Options, Outcome, Real, Vector};

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn body(kind: &str, numbers: &[f64], rotation: [f64; 9], translation: [f64; 3]) -> Placed {
    Placed { shape: Shape { kind: kind.to_string(), numbers: numbers.to_vec() }, rotation, translation }
}

fn at(kind: &str, numbers: &[f64]) -> Placed {
    body(kind, numbers, IDENTITY, [0.0; 3])
}

/// A rotation by an angle about a direction across z, as a matrix.
fn tilt(angle: f64, azimuth: f64) -> [f64; 9] {
    let axis = Unit::new_normalize(Vector3::new(azimuth.cos(), azimuth.sin(), 0.0));
    rows(&Rotation3::from_axis_angle(&axis, angle))
}

fn rows(r: &Rotation3<f64>) -> [f64; 9] {
    std::array::from_fn(|i| r.matrix()[(i / 3, i % 3)])
}

fn depth<T: Real>(a: &Placed, b: &Placed, memory: &mut Memory, options: &Options<'_, T, 3>) -> Depth<T> {
    let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    memory.solver::<T, 3>().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), options)
}

/// The bodies as `f32` sees them.
fn single(body: &Placed) -> Placed {
    let down = |x: &f64| f64::from(*x as f32);
    Placed {
        shape: Shape { kind: body.shape.kind.clone(), numbers: body.shape.numbers.iter().map(down).collect() },
        rotation: body.rotation.map(|x| down(&x)),
        translation: body.translation.map(|x| down(&x)),
    }
}

/// All promises of an answer in the memory of README's table; what is broken, as text.
fn broken<T: Real>(a: &Placed, b: &Placed, dice: &mut Dice) -> Result<Seen, String> {
    let options = Options::<T, 3>::default();
    let mut memory = Memory::new::<T, 3>(64, 128);
    let r = depth::<T>(a, b, &mut memory, &options);
    let seen = Seen::from(&r);
    if let Some(text) = broken_promise(&seen, &options, 64, 128) {
        return Err(text);
    }
    let size = a.shape.numbers.iter().chain(&b.shape.numbers).fold(0.0f64, |m, x| m.max(x.abs()));
    let blur = Dd::new(BLUR * (size + a.translation.iter().chain(&b.translation).map(|x| x.abs()).sum::<f64>()));
    let normal = [r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64);
    let proved = pair_value(a, b, &v3(normal));
    if proved > Dd::new(seen.upper) + blur {
        return Err(format!("the normal proves {:e} only: {r:?}", proved.hi));
    }
    let searched = searched_upper(a, b, Some(normal), 200, dice);
    if Dd::new(seen.lower) > searched + blur {
        return Err(format!("depth is at most {:e}: {r:?}", searched.hi));
    }
    if seen.outcome == Outcome::Converged {
        // Their distance is the depth up to the tolerance: along the normal not more, in length not less. Sideways a few times its square root.
        let between: [f64; 3] = std::array::from_fn(|i| r.point_a[i].to_f64() - r.point_b[i].to_f64());
        let along: f64 = (0..3).map(|i| between[i] * normal[i]).sum();
        let miss = (0..3).map(|i| (between[i] - along * normal[i]).powi(2)).sum::<f64>().sqrt();
        let relative = options.relative.to_f64();
        // (The weights of a sliver's corners are off by some hundred roundoffs.)
        let roundoff = 512.0 * T::ROUNDOFF.to_f64() * size;
        let off = 2.0 * relative * seen.upper + roundoff;
        if along > seen.upper + off || along.hypot(miss) < seen.upper - off {
            return Err(format!("the witnesses are {along} apart: {r:?}"));
        }
        if miss > 6.0 * relative.sqrt() * seen.upper + roundoff {
            return Err(format!("the witnesses are {miss} aside: {r:?}"));
        }
    }
    Ok(seen)
}

fn converges(a: &Placed, b: &Placed, dice: &mut Dice) -> Seen {
    let seen = broken::<f64>(a, b, dice).unwrap_or_else(|text| panic!("{text}\n{a:?}\n{b:?}"));
    assert_eq!(seen.outcome, Outcome::Converged, "{seen:?}\n{a:?}\n{b:?}");
    seen
}

/// Brackets and witnesses true in both scalars and both orders, and all of `f64` converged.
fn all_converge(name: &str, pairs: impl Iterator<Item = (Placed, Placed)>) {
    converge_in(100, name, pairs);
}

/// Brackets and witnesses true in both scalars and both orders for all pairs, and `f64` converged for at least so many of a hundred. All exceptions
/// are told before the test fails.
fn converge_in(percent: usize, name: &str, pairs: impl Iterator<Item = (Placed, Placed)>) {
    let mut dice = Dice::new(99);
    let (mut count, mut worst, mut faults, mut open) = (0, 0, Vec::new(), 0);
    for (a, b) in pairs {
        for (a, b) in [(&a, &b), (&b, &a)] {
            count += 1;
            match broken::<f64>(a, b, &mut dice) {
                Ok(seen) if seen.outcome == Outcome::Converged => worst = worst.max(seen.iterations),
                Ok(_) => open += 1,
                Err(text) => faults.push(format!("{text}\n{a:?}\n{b:?}")),
            }
            let (a, b) = (single(a), single(b));
            if let Err(text) = broken::<f32>(&a, &b, &mut dice) {
                faults.push(format!("f32: {text}\n{a:?}\n{b:?}"));
            }
        }
    }
    println!("{name}: {count} pairs, {} faults, {open} open, at most {worst} iterations", faults.len());
    for fault in faults.iter().take(12) {
        println!("{fault}\n");
    }
    assert!(faults.is_empty(), "{name}: {} of {count}", faults.len());
    assert!((count - open) * 100 >= count * percent, "{name}: {open} of {count} are open");
}

const TETRAHEDRON: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn a_corner_on_the_axis_of_a_cylinder() {
    let (tetrahedron, cylinder) = (at("hull", &TETRAHEDRON), at("cylinder", &[0.1, 0.2]));
    let mut dice = Dice::new(1);
    for (a, b) in [(&tetrahedron, &cylinder), (&cylinder, &tetrahedron)] {
        let seen = converges(a, b, &mut dice);
        assert!(seen.lower <= 0.1 && 0.1 <= seen.upper, "{seen:?}");
    }
    // More memory is no reason to fill it.
    let mut memory = Memory::new::<f64, 3>(1024, 2048);
    let r = depth::<f64>(&tetrahedron, &cylinder, &mut memory, &Options::default());
    assert!(r.outcome == Outcome::Converged && r.vertices <= 64, "{r:?}");
}

/// In single precision the sectors' rounding takes the default tolerance. (The memory was full of tiles then, and the bracket 5e-4 wide.)
#[test]
fn a_corner_on_the_axis_in_single_precision() {
    let mut dice = Dice::new(18);
    let mut memory = Memory::new::<f32, 3>(64, 128);
    for case in 0..200 {
        let mut number = |least, most| f64::from(dice.range(least, most) as f32);
        let (r, h) = if case == 0 { (f64::from(0.1f32), 0.2) } else { (number(0.05, 0.25), number(0.1, 0.5)) };
        let sides = [0; 3].map(|_| if case == 0 { 1.0 } else { number(0.7, 1.7) });
        let corners: Vec<f64> =
            (0..12).map(|i| if i >= 3 && i % 3 == i / 3 - 1 { sides[i % 3] } else { 0.0 }).collect();
        let (corner, cylinder) = (at("hull", &corners), at("cylinder", &[r, h]));
        for (a, b) in [(&corner, &cylinder), (&cylinder, &corner)] {
            let seen = depth::<f32>(a, b, &mut memory, &Options::default());
            let (lower, upper) = (f64::from(seen.lower), f64::from(seen.upper));
            assert!(lower <= r.min(h) && r.min(h) <= upper && upper - lower < 3e-5, "{case} {r} {h}: {seen:?}");
            let known = if case == 0 { Outcome::Converged } else { Outcome::Precision };
            assert!(seen.outcome == Outcome::Converged || seen.outcome == known, "{case} {r} {h}: {seen:?}");
        }
    }
}

#[test]
fn cylinders_whose_axes_nearly_agree() {
    let mut dice = Dice::new(2);
    let a = at("cylinder", &[1.0, 1.0]);
    for exponent in 1..=15 {
        let off = if exponent == 15 { 0.0 } else { 10f64.powi(-exponent) };
        // The plane across one axis cuts a disc of its own radius out of the other.
        let tilted = body("cylinder", &[0.99, 1.5], tilt(off, 0.3), [0.0; 3]);
        let seen = converges(&a, &tilted, &mut dice);
        assert!(seen.lower <= 1.99 && 1.99 <= seen.upper, "{off:e} {seen:?}");
        let beside = body("cylinder", &[0.99, 1.5], IDENTITY, [off * 0.6, off * 0.8, 0.0]);
        let seen = converges(&a, &beside, &mut dice);
        let known = 1.99 - off;
        assert!(seen.lower <= known + 1e-15 && known - 1e-15 <= seen.upper, "{off:e} {seen:?}");
    }
}

/// What is asked in one plane stands for all of them: an offset counts twice, whichever way it points.
#[test]
fn an_offset_that_the_tolerance_allows_is_charged_in_full() {
    let a = at("cylinder", &[1.0, 1.0]);
    let mut dice = Dice::new(7);
    for k in 0..200 {
        let (off, azimuth) = (dice.decade(-14.0, -6.5), dice.range(0.0, 6.25));
        let azimuth = if k < 8 { f64::from(k) * std::f64::consts::FRAC_PI_4 } else { azimuth };
        let beside = body("cylinder", &[0.99, 1.5], IDENTITY, [off * azimuth.cos(), off * azimuth.sin(), 0.0]);
        let seen = converges(&a, &beside, &mut dice);
        let known = 1.99 - off;
        assert!(seen.lower <= known + 1e-15 && known - 1e-15 <= seen.upper, "{off:e} {azimuth} {seen:?}");
    }
}

/// A body of revolution of about size 1 and its numbers.
fn turned(dice: &mut Dice) -> (&'static str, Vec<f64>) {
    match dice.below(5) {
        0 => ("cylinder", vec![dice.range(0.3, 1.5), dice.range(0.3, 1.5)]),
        1 => ("cylinder", vec![dice.range(0.3, 1.0), dice.range(1.0, 3.0)]),
        2 => ("cone", vec![dice.range(0.3, 1.5), dice.range(0.3, 1.5)]),
        3 => ("capsule", vec![dice.range(0.1, 1.0), dice.range(0.3, 1.5)]),
        _ => {
            let r = dice.range(0.3, 1.0);
            ("ellipsoid", vec![r, r, dice.range(0.3, 2.0)])
        }
    }
}

#[test]
fn bodies_of_revolution_whose_axes_nearly_agree() {
    let mut dice = Dice::new(3);
    all_converge(
        "nearly coaxial",
        (0..150).map(|k| {
            let ((ka, na), (kb, nb)) = (turned(&mut dice), turned(&mut dice));
            let angle = if k % 3 == 1 { 0.0 } else { dice.decade(-14.0, -1.0) };
            let aside = if k % 3 == 0 { 0.0 } else { dice.decade(-14.0, -1.0) };
            let azimuth = dice.range(0.0, 6.25);
            let up = if dice.chance(0.5) { dice.range(-0.2, 0.2) } else { 0.0 };
            let at_b = [aside * azimuth.cos(), aside * azimuth.sin(), up];
            (at(ka, &na), body(kb, &nb, tilt(angle, dice.range(0.0, 6.25)), at_b))
        }),
    );
}

/// A cylinder, a cone or a disc of radius about 0.1, and a point on its axis inside.
fn small(dice: &mut Dice) -> (Placed, f64) {
    let (r, h) = (dice.range(0.05, 0.2), dice.range(0.1, 0.3));
    match dice.below(2) {
        0 => (at("cylinder", &[r, h]), dice.range(-0.5, 0.5) * h),
        _ => (at("cone", &[r, h]), dice.range(-0.8, 0.2) * h),
    }
}

fn moved(points: &[[f64; 3]], by: [f64; 3]) -> Vec<f64> {
    points.iter().flat_map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]).collect()
}

/// How far off: exactly on, or by 1e-14 to 1e-1 of the radius.
fn off(dice: &mut Dice, size: f64) -> [f64; 3] {
    if dice.chance(0.25) {
        return [0.0; 3];
    }
    let by = size * dice.decade(-14.0, -0.5);
    dice.direction::<3>().map(|x| x * by)
}

#[test]
fn corners_near_the_axis() {
    let mut dice = Dice::new(4);
    // (1 of 300 ends with `Capacity`, 5e-4 wide.)
    converge_in(
        99,
        "corners",
        (0..150).map(|_| {
            let (turning, z) = small(&mut dice);
            // A corner at the origin: a cone of a few random directions.
            let lean = dice.direction::<3>();
            let mut points = vec![[0.0; 3]];
            while points.len() < 6 {
                let d = dice.direction::<3>();
                if (0..3).map(|i| d[i] * lean[i]).sum::<f64>() > 0.3 {
                    points.push(d.map(|x| x * dice.range(0.5, 2.0)));
                }
            }
            let by = off(&mut dice, 0.1);
            let at_corner = [by[0], by[1], by[2] + z];
            (at("hull", &moved(&points, at_corner)), turning)
        }),
    );
}

#[test]
fn corners_and_edges_of_boxes_near_the_axis() {
    let mut dice = Dice::new(5);
    all_converge(
        "boxes",
        (0..150).map(|k| {
            let (turning, z) = small(&mut dice);
            let half = [0; 3].map(|_| dice.range(0.3, 2.0));
            let by = off(&mut dice, 0.1);
            // The corner, the middle of an edge along the axis or across it, the middle of a face.
            let corner = match k % 4 {
                0 => half,
                1 => [half[0], half[1], 0.0],
                2 => [half[0], 0.0, half[2]],
                _ => [half[0], 0.0, 0.0],
            };
            let turn = if k % 8 < 4 {
                Rotation3::identity()
            } else if k % 4 == 1 {
                Rotation3::from_axis_angle(&Vector3::z_axis(), dice.range(0.0, 6.25))
            } else {
                Rotation3::from_euler_angles(dice.range(0.0, 6.25), dice.range(0.0, 6.25), dice.range(0.0, 6.25))
            };
            let t = -(turn * Vector3::from(corner)) + Vector3::new(by[0], by[1], by[2] + z);
            (body("box", &half, rows(&turn), t.into()), turning)
        }),
    );
}

#[test]
fn edges_through_discs_and_rings() {
    let mut dice = Dice::new(6);
    all_converge(
        "edges",
        (0..150).map(|k| {
            let r = dice.range(0.05, 0.2);
            let turning = match k % 3 {
                0 => at("cylinder", &[r, 0.0]),
                1 => at("cylinder", &[r, dice.range(0.0, 0.1)]),
                _ => at("cone", &[r, dice.range(0.01, 0.1)]),
            };
            // A blade whose edge is the axis, or nearly: tilted and moved.
            let (angle, azimuth) =
                (if dice.chance(0.3) { 0.0 } else { dice.decade(-14.0, -1.0) }, dice.range(0.0, 6.25));
            let turn = tilt(angle, dice.range(0.0, 6.25));
            let width = dice.range(0.1, 1.5);
            let side = |w: f64| [w.cos(), w.sin()];
            let ([x, y], [v, w]) = (side(azimuth), side(azimuth + width));
            let points = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.2], [x, y, -0.5], [x, y, 0.5], [v, w, -0.5], [v, w, 0.7]];
            (body("hull", &moved(&points, [0.0; 3]), turn, off(&mut dice, 0.1)), turning)
        }),
    );
}

/// A rotation by angles of all sizes.
fn anyhow(dice: &mut Dice) -> Rotation3<f64> {
    Rotation3::from_euler_angles(dice.range(0.0, 6.25), dice.range(0.0, 6.25), dice.range(0.0, 6.25))
}

/// The body, turned and moved.
fn placed(body: &Placed, turn: &Rotation3<f64>, by: &Vector3<f64>) -> Placed {
    let own = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_row_slice(&body.rotation));
    let translation = (turn * Vector3::from(body.translation) + by).into();
    Placed { shape: body.shape.clone(), rotation: rows(&(turn * own)), translation }
}

/// A polytope with an edge along z through the origin, or with one that begins there.
fn edged(dice: &mut Dice, kind: u32, long: f64) -> Placed {
    let (up, down) = (long * dice.range(0.3, 1.0), -long * dice.range(0.3, 1.0));
    let (azimuth, width) = (dice.range(0.0, 6.25), dice.range(0.1, 2.8));
    let mut side = |w: f64| {
        let far = dice.range(0.3, 1.5);
        [w.cos() * far, w.sin() * far, dice.range(down, up)]
    };
    let ends = [[0.0, 0.0, down], [0.0, 0.0, up]];
    let (one, two, three, four) = (side(azimuth), side(azimuth + width), side(azimuth), side(azimuth + width));
    match kind {
        0 => at("hull", &moved(&[ends[0], ends[1], one, two, three, four], [0.0; 3])),
        1 => at("hull", &moved(&[ends[0], ends[1], one, two], [0.0; 3])),
        2 => at("hull", &moved(&[ends[0], ends[1], one], [0.0; 3])),
        3 => at("hull", &moved(&ends, [0.0; 3])),
        _ => {
            let half = [dice.range(0.3, 2.0), dice.range(0.3, 2.0), (up - down) / 2.0];
            body("box", &half, IDENTITY, [-half[0], -half[1], (up + down) / 2.0])
        }
    }
}

/// Edges of all kinds of polytopes, all leans, any pose: the arc, where there is one, is around the edge.
#[test]
fn edges_along_the_axis_at_any_pose() {
    let mut dice = Dice::new(10);
    // (Of 3,000 runs of this kind 2 end with `Capacity`, 3e-3 wide.)
    converge_in(
        99,
        "edges at any pose",
        (0..300).map(|k| {
            let r = dice.range(0.05, 0.3);
            let h = r * dice.decade(-2.0, 0.3);
            let turning = match k % 5 {
                0 => at("cylinder", &[r, 0.0]),
                1 | 2 => at("cylinder", &[r, h]),
                3 => at("cone", &[r, h]),
                _ => at("capsule", &[r, h]),
            };
            let long = dice.decade(-0.3, 0.3);
            let edged = edged(&mut dice, (k / 5 % 5) as u32, long);
            let angle = if dice.chance(0.2) { 0.0 } else { dice.decade(-14.0, 0.19) };
            let lean = Rotation3::from_matrix_unchecked(nalgebra::Matrix3::from_row_slice(&tilt(
                angle,
                dice.range(0.0, 6.25),
            )));
            let edged = placed(&edged, &lean, &Vector3::from(off(&mut dice, r)));
            let (turn, by) = (anyhow(&mut dice), Vector3::from(dice.direction::<3>()) * dice.range(0.0, 3.0));
            (placed(&edged, &turn, &by), placed(&turning, &turn, &by))
        }),
    );
}

/// A body of revolution given as a callback: the profile is rounded, of 60,000 points.
struct Turned {
    profile: Vec<[f64; 2]>,
}

impl Turned {
    fn new(points: usize, radius: f64, height: f64) -> Self {
        let at = |i: usize| std::f64::consts::PI * i as f64 / (points - 1) as f64;
        Turned { profile: (0..points).map(|i| [radius * at(i).sin(), -height * at(i).cos()]).collect() }
    }
}

impl Support<f64, 3> for Turned {
    fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        let across = u.x.hypot(u.y);
        // The profile is convex: heights rise and fall along it.
        let height = |p: &[f64; 2]| across * p[0] + u.z * p[1];
        let (mut low, mut high) = (0, self.profile.len() - 1);
        while low < high {
            let middle = (low + high) / 2;
            if height(&self.profile[middle]) < height(&self.profile[middle + 1]) {
                low = middle + 1
            } else {
                high = middle
            }
        }
        let [r, z] = self.profile[low];
        Ok(if across > 0.0 {
            Vector::from([r * u.x / across, r * u.y / across, z])
        } else {
            Vector::from([0.0, 0.0, z])
        })
    }
    fn extent(&self) -> f64 {
        2.0
    }
    fn symmetry(&self) -> Symmetry {
        Symmetry::Axis
    }
}

/// Two balls as callbacks: the worst case of a search in the plane.
#[test]
fn round_profiles_cost_n_log_n() {
    let ball = Turned::new(60_000, 1.0, 1.0);
    let mut memory = Memory::new::<f64, 3>(30_000, 60_000);
    let a = Body::at(&ball, Vector::zeros());
    // Where the tolerance is met, it ends.
    let r = memory.solver::<f64, 3>().depth(&a, &a, &Options::default());
    assert!(r.outcome == Outcome::Converged && r.iterations < 5_000, "{r:?}");
    assert!(r.lower <= 2.0 && 2.0 <= r.upper + 1e-8, "{r:?}");
    let mut spent = Vec::new();
    for limit in [2_000, 16_000] {
        let options = Options { relative: 1e-12, max_iterations: Some(limit), ..Options::default() };
        let start = std::time::Instant::now();
        let r = memory.solver::<f64, 3>().depth(&a, &a, &options);
        spent.push(start.elapsed().as_secs_f64());
        assert!(r.outcome == Outcome::Iterations && r.iterations == limit, "{r:?}");
        assert!(r.lower <= 2.0 && 2.0 <= r.upper + 1e-8, "{r:?}");
    }
    // Eight times the work: quadratic would take sixty-four times the time.
    println!("{spent:?}");
    assert!(spent[1] < 32.0 * spent[0], "{spent:?}");
    // The deadline is asked in every iteration.
    let asked = std::cell::Cell::new(0);
    let late = || {
        asked.set(asked.get() + 1);
        asked.get() > 100
    };
    let options = Options { relative: 1e-12, interrupt: Some(&late), ..Options::default() };
    let r = memory.solver::<f64, 3>().depth(&a, &a, &options);
    assert!(r.outcome == Outcome::Interrupted && r.iterations == 100, "{r:?}");
}

/// Spheroids as callbacks, about one centre: the least sum of axes, but for what 20,000 points cut off. Round ones need thousands of points.
#[test]
fn round_profiles_of_any_shape() {
    let mut dice = Dice::new(11);
    let mut memory = Memory::new::<f64, 3>(8_000, 16_000);
    let mut most = 0;
    for k in 0..100 {
        let mut axes = || {
            let radius = dice.range(0.3, 1.0);
            [radius, if k % 3 == 0 { radius } else { dice.range(0.3, 1.0) }]
        };
        let ([r, h], [s, i]) = (axes(), axes());
        let (a, b) = (Turned::new(20_000, r, h), Turned::new(20_000, s, i));
        let turn = anyhow(&mut dice);
        let place = Vector::from(dice.direction::<3>()) * if k % 2 == 0 { 0.0 } else { 3.0 };
        let body = |shape| Body::new(shape, *turn.matrix(), place).unwrap();
        let (a, b) = (body(&a as &(dyn Support<f64, 3> + Sync)), body(&b as &(dyn Support<f64, 3> + Sync)));
        let d = memory.solver::<f64, 3>().depth(&a, &b, &Options::default());
        let least = (r + s).min(h + i);
        assert!(d.outcome == Outcome::Converged && d.lower <= least && least - 2e-8 <= d.upper, "{k} {least} {d:?}");
        most = most.max(d.iterations);
    }
    assert!(most > 500, "{most}");
}

/// Ellipsoids of the same axes about the same centre: two smooth minima that expansion must tile, and the least sum of axes in closed form.
#[test]
fn equal_ellipsoids_about_one_centre() {
    let mut dice = Dice::new(8);
    let e = at("ellipsoid", &[0.5, 0.7, 0.9]);
    let seen = converges(&e, &e, &mut dice);
    assert!(seen.lower <= 1.0 && 1.0 <= seen.upper && seen.upper - seen.lower < 1e-13, "{seen:?}");
}

/// Asked for more than single precision tells: the closed form's bracket stands, where expansion fills its memory with tiles of a pole.
#[test]
fn equal_ellipsoids_as_well_as_one_word_tells() {
    let mut dice = Dice::new(10);
    for k in 0..100 {
        let semi = if k == 0 { [0.368347, 0.374666, 1.04961] } else { [0; 3].map(|_| dice.range(0.3, 1.2) as f32) };
        let egg = qdist::support::Ellipsoid::new(semi.into()).unwrap();
        let angles = [0; 3].map(|_| dice.range(0.0, 6.25));
        let turn = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]).matrix().map(|x| x as f32);
        let at = dice.direction::<3>().map(|x| x as f32).into();
        let body = qdist::Body::new(&egg, turn, at).unwrap();
        let options = Options::<f32, 3> { relative: 1e-6, ..Options::default() };
        let found = qdist::Workspace::<f32, 3, 64, 128>::new().solver().depth(&body, &body, &options);
        // (The matrix is a rotation to some roundoffs.)
        let least = 2.0 * f64::from(semi.into_iter().fold(f32::MAX, f32::min));
        let (lower, upper) = (f64::from(found.lower), f64::from(found.upper));
        assert!(lower <= least * (1.0 + 3e-7) && least * (1.0 - 3e-7) <= upper, "{k}: {found:?}, {least}");
        assert!(upper - lower < 1e-4 * least, "{k}: {found:?}");
    }
}

#[test]
fn ellipsoids_about_nearly_one_centre() {
    let mut dice = Dice::new(9);
    let mut memory = Memory::new::<f64, 3>(128, 256);
    let options = Options::<f64, 3>::default();
    for k in 0..200 {
        let axes = |dice: &mut Dice| [0; 3].map(|_| dice.decade(-1.0, 0.5));
        let first = axes(&mut dice);
        let mut second = if k % 2 == 0 { first } else { axes(&mut dice) };
        let turn = if k % 3 == 0 {
            Rotation3::identity()
        } else {
            Rotation3::from_euler_angles(dice.range(0.0, 6.25), dice.range(0.0, 6.25), dice.range(0.0, 6.25))
        };
        // The same axes in another order, by a quarter turn about the third.
        let quarter = k % 8 == 5;
        let sums: [f64; 3] = std::array::from_fn(|i| first[i] + second[i]);
        if quarter {
            second.swap(0, 1);
        }
        let spun =
            Rotation3::from_matrix_unchecked(nalgebra::Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0));
        let turn_b = if quarter { turn * spun } else { turn };
        let off = if k % 4 < 2 { 0.0 } else { dice.decade(-16.0, -3.0) };
        let place = dice.direction::<3>().map(|x| x * 3.0);
        let aside = dice.direction::<3>().map(|x| x * off);
        let at_b: [f64; 3] = std::array::from_fn(|i| place[i] + aside[i]);
        let (a, b) = (body("ellipsoid", &first, rows(&turn), place), body("ellipsoid", &second, rows(&turn_b), at_b));
        let least = sums.iter().fold(f64::MAX, |m, &x| m.min(x));
        for (a, b) in [(&a, &b), (&b, &a)] {
            let seen = broken::<f64>(a, b, &mut dice).unwrap_or_else(|text| panic!("{text}\n{a:?}\n{b:?}"));
            let seen = if off == 0.0 { seen } else { Seen::from(&depth::<f64>(a, b, &mut memory, &options)) };
            let blur = off + 1e-14;
            assert!(seen.lower <= least + blur && least - blur <= seen.upper, "{least} {seen:?}\n{a:?}\n{b:?}");
            if off < 1e-8 {
                assert!(seen.outcome == Outcome::Converged && seen.vertices == 0, "{seen:?}\n{a:?}\n{b:?}");
            }
            let (a, b) = (single(a), single(b));
            broken::<f32>(&a, &b, &mut dice).unwrap_or_else(|text| panic!("f32: {text}\n{a:?}\n{b:?}"));
        }
    }
}
