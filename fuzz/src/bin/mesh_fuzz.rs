//! Random bodies and poses of every kind for the queries of meshes, checked against what must hold whatever they are.
//!
//!     cargo run --release -p qdist-fuzz --bin mesh_fuzz -- --seconds 60 [--seed 1] [--case 17]
//!
//! Bodies: boxes, deformed balls, rings, slots, soups; crumpled, flat, inverted, split at every edge, with triangles missing, repeated or without
//! area; of sizes from 1e-150 to 1e150, far from their origin. Poses: at random, aligned, far away, no poses at all. For every answer:
//!
//! * nothing panics or hangs, and the bracket is one;
//! * its pose is free by a new pair, and crosses nothing by brute force over all triangles;
//! * no free pose that was found is nearer than a lower bound, whichever query each is from;
//! * distances, contacts and motions along a screw agree with the solid test.
//!
//! Finds are printed with their seed and case, and the exit code is 1.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use qdist::mesh::certificate::{BuildOptions, Effort};
use qdist::mesh::metric::Metric;
use qdist::mesh::{
    Budget, ContactSamples, DepthOptions, DepthSolver, DepthTracker, MeshDepth, Model, Outcome, Pair, Screw, Stop, Walk,
};
use qdist_fuzz::common::dice::Dice;
use qdist_fuzz::mesh_common::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The case in work, and finds.
static CASE: AtomicU64 = AtomicU64::new(0);
static FINDS: AtomicU64 = AtomicU64::new(0);
/// A case takes milliseconds, but for pieces and all effort.
const HANG: Duration = Duration::from_secs(60);

fn find(what: &str, detail: &dyn std::fmt::Debug) {
    FINDS.fetch_add(1, Ordering::Relaxed);
    println!("FIND in case {}: {what}: {detail:?}", CASE.load(Ordering::Relaxed));
}

fn main() {
    let (mut seconds, mut seed, mut only) = (10.0, 1u64, None);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().unwrap_or_else(|| panic!("{arg} needs a value"));
        match arg.as_str() {
            "--seconds" => seconds = value.parse().expect("seconds"),
            "--seed" => seed = value.parse().expect("seed"),
            "--case" => only = Some(value.parse::<u64>().expect("case")),
            _ => panic!("unknown argument {arg}"),
        }
    }
    std::panic::set_hook(Box::new(|info| println!("FIND in case {}: {info}", CASE.load(Ordering::Relaxed))));
    std::thread::spawn(|| {
        let mut last = (u64::MAX, Instant::now());
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let case = CASE.load(Ordering::Relaxed);
            if case != last.0 {
                last = (case, Instant::now());
            } else if last.1.elapsed() > HANG {
                println!("FIND in case {case}: it takes longer than {HANG:?}");
                std::process::exit(1);
            }
        }
    });
    let begin = Instant::now();
    let mut tally = Tally::default();
    let mut case = only.unwrap_or(0);
    while only.is_some_and(|only| only == case) || (only.is_none() && begin.elapsed().as_secs_f64() < seconds) {
        CASE.store(case, Ordering::Relaxed);
        run(&mut Dice::new(seed.wrapping_mul(0x9e37_79b9) ^ (case << 20)), &mut tally, only.is_some());
        case += 1;
    }
    let finds = FINDS.load(Ordering::Relaxed);
    println!("seed {seed}: {tally:?}, {finds} finds in {:.0} s", begin.elapsed().as_secs_f64());
    std::process::exit(i32::from(finds > 0));
}

#[derive(Debug, Default)]
struct Tally {
    pairs: u64,
    refused: u64,
    solids: u64,
    poses: u64,
    depths: u64,
    penetrating: u64,
    certified: u64,
    ticks: u64,
}

fn run(dice: &mut Dice, tally: &mut Tally, verbose: bool) {
    tally.pairs += 1;
    let unit = match dice.below(8) {
        0 => dice.decade(-150.0, 150.0),
        1..3 => dice.decade(-50.0, 50.0),
        _ => dice.decade(-3.0, 3.0),
    };
    let ratio = if dice.chance(0.3) { dice.decade(-6.0, 6.0) } else { dice.decade(-0.5, 0.5) };
    let [Some(a), Some(b)] = [unit, unit * ratio].map(|size| body(dice, size, verbose)) else {
        tally.refused += 1;
        return;
    };
    tally.solids += u64::from(a.is_solid() && b.is_solid());
    for _ in 0..3 {
        tally.poses += 1;
        let pose = pose(dice, &a, &b);
        if verbose {
            println!("{pose:?}");
        }
        proximity(dice, &a, &b, &pose);
        depths(dice, &a, &b, &pose, tally, verbose);
    }
}

fn body(dice: &mut Dice, size: f64, verbose: bool) -> Option<Model> {
    let mut shape = base(dice);
    spoil(dice, &mut shape);
    let shift: [f64; 3] = if dice.chance(0.2) {
        let far = dice.decade(-1.0, 7.0);
        [0; 3].map(|_| far * dice.signed())
    } else {
        [0.0; 3]
    };
    for v in &mut shape.vertices {
        *v = std::array::from_fn(|k| (v[k] + shift[k]) * size);
    }
    if dice.chance(0.02) && !shape.triangles.is_empty() {
        match dice.below(3) {
            0 => shape.vertices[0][1] = dice.pick(&[f64::NAN, f64::INFINITY, 1e61, -1e300]),
            1 => shape.triangles[0][2] = dice.pick(&[u32::MAX, shape.vertices.len() as u32]),
            _ => shape.triangles.clear(),
        }
    }
    if verbose {
        println!("{shape:?}");
    }
    let model = Model::new(&shape.vertices, &shape.triangles).ok()?;
    let pieces = dice.chance(0.7).then(|| model.clone().with_pieces(&BuildOptions::default()).ok()).flatten();
    Some(pieces.unwrap_or(model))
}

fn base(dice: &mut Dice) -> Shape {
    let mut point = |r: f64| -> [f64; 3] { [0; 3].map(|_| r * dice.signed()) };
    let four = Shape { vertices: (0..4).map(|_| point(1.0)).collect(), ..tetrahedron() };
    match dice.below(10) {
        0 => four,
        1 => cuboid([0; 3].map(|_| if dice.chance(0.3) { dice.decade(-9.0, 0.0) } else { dice.range(0.2, 1.0) })),
        2 | 3 => {
            let mut ball = icosphere(dice.below(2));
            let rough = dice.pick(&[0.0, 0.2, 0.6, 1.5]);
            ball.vertices.iter_mut().for_each(|v| {
                let r = 1.0 + rough * dice.signed();
                *v = v.map(|x| x * r);
            });
            ball
        }
        4 => torus(3 + dice.below(8), 3 + dice.below(4), 1.0, dice.range(0.05, 1.3)),
        5 => l_shape(),
        6 => {
            let g = dice.decade(-6.0, 0.0);
            slot(0.5 * g + dice.range(0.05, 1.0), 1.0, g, dice.range(0.01, 0.9), dice.range(0.1, 1.0))
        }
        7 => {
            let n = 3 + dice.below(8);
            let vertices = (0..n).map(|_| [0; 3].map(|_| dice.signed())).collect();
            let corner = |dice: &mut Dice| dice.below(n) as u32;
            let triangles = (0..1 + dice.below(16)).map(|_| [0; 3].map(|_| corner(dice))).collect();
            Shape { vertices, triangles }
        }
        8 => {
            // A box in a box: a cavity, an overlap, an inverted part, or a box that touches.
            let inner = cuboid([dice.pick(&[0.3, 0.5, 1.0]); 3]);
            let inner = if dice.chance(0.5) { inner.flipped() } else { inner };
            cuboid([0.5; 3]).and(&inner.moved([0; 3].map(|_| dice.pick(&[0.0, 0.5, 1.0]))))
        }
        _ => torus_knot(12 + dice.below(10), 3 + dice.below(3), dice.range(0.05, 0.5)),
    }
}

fn spoil(dice: &mut Dice, shape: &mut Shape) {
    if dice.chance(0.1) {
        // Crumpled.
        shape.vertices.iter_mut().for_each(|v| *v = [0; 3].map(|_| dice.signed()));
    }
    if dice.chance(0.1) {
        let strength = dice.decade(-12.0, 0.0);
        shape.vertices.iter_mut().for_each(|v| *v = v.map(|x| x + strength * dice.signed()));
    }
    if dice.chance(0.15) {
        let grid = dice.pick(&[0.5, 0.25, 0.1]);
        shape.vertices.iter_mut().for_each(|v| *v = v.map(|x| (x / grid).round() * grid));
    }
    if dice.chance(0.1) {
        let (axis, factor) = (dice.below(3), dice.pick(&[0.0, 1e-15, 1e-9, 1e-4, 1e3]));
        shape.vertices.iter_mut().for_each(|v| v[axis] *= factor);
    }
    if dice.chance(0.1) {
        *shape = shape.flipped();
    }
    if dice.chance(0.08) {
        let n = dice.below(shape.triangles.len());
        *shape = shape.without(n);
    }
    if dice.chance(0.06) && !shape.triangles.is_empty() {
        let t = dice.pick(&shape.triangles);
        shape.triangles.push(if dice.chance(0.5) { t } else { [t[0], t[1], t[0]] });
    }
    if dice.chance(0.06) {
        // Every triangle has corners of its own.
        let corners: Vec<_> = shape.triangles.iter().flatten().map(|&v| shape.vertices[v as usize]).collect();
        shape.triangles = (0..shape.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        shape.vertices = corners;
    }
    if dice.chance(0.05) {
        shape.vertices.push([dice.decade(0.0, 6.0); 3]);
    }
}

fn pose(dice: &mut Dice, a: &Model, b: &Model) -> Isometry3<f64> {
    let [(low_a, high_a), (low_b, high_b)] = [a, b].map(|m| m.mesh().bounds());
    let rotation = match dice.below(6) {
        0 | 1 => UnitQuaternion::identity(),
        2 => UnitQuaternion::from_scaled_axis(Vector3::from([0; 3].map(|_| dice.signed() * dice.decade(-12.0, 0.0)))),
        _ => random_rotation(dice),
    };
    let rotation = match dice.below(25) {
        0 => UnitQuaternion::new_unchecked(rotation.into_inner() * dice.pick(&[0.0, 0.9, 1.0 + 1e-7, 1.2, 1e200])),
        1 => UnitQuaternion::new_unchecked(Quaternion::new(f64::NAN, 0.0, 0.0, dice.unit())),
        _ => rotation,
    };
    // A point of A's box on a point of B's.
    let inside = |dice: &mut Dice, low: &nalgebra::Point3<f64>, high: &nalgebra::Point3<f64>| {
        let snap = dice.chance(0.2);
        let mut at = |k: usize| {
            let s = if snap { dice.pick(&[0.0, 0.5, 1.0]) } else { dice.unit() };
            low[k] + (high[k] - low[k]) * s
        };
        Vector3::new(at(0), at(1), at(2))
    };
    let translation = inside(dice, &low_b, &high_b) - rotation * inside(dice, &low_a, &high_a);
    let translation = match dice.below(30) {
        0 => Vector3::repeat(dice.pick(&[f64::NAN, f64::INFINITY, 1e300, 1e61, 1e60])),
        1 => translation * dice.decade(0.0, 12.0),
        _ => translation,
    };
    Isometry3::from_parts(Translation3::from(translation), rotation)
}

fn proper(pose: &Isometry3<f64>) -> bool {
    (pose.rotation.norm() - 1.0).abs() < 1e-12 && pose.translation.vector.amax() < 1e60
}

/// Rounding of lengths.
fn blur(a: &Model, b: &Model, pose: &Isometry3<f64>) -> f64 {
    let reach = |m: &Model| m.mesh().vertices().iter().map(|v| v.coords.amax()).fold(0.0, f64::max);
    1e-13 * (reach(a) + reach(b) + pose.translation.vector.amax())
}

/// Whether triangles cross at a pose that is said to be free, or a corner is inside.
fn overlap(a: &Model, b: &Model, pose: &Isometry3<f64>) -> bool {
    let nudge = blur(a, b, pose);
    let nudges = [Vector3::x(), -Vector3::y(), Vector3::z(), Vector3::new(-1.0, 1.0, -1.0)];
    let (a, b) = (a.mesh(), b.mesh());
    let inside = |host: &qdist::mesh::Mesh, guest: &qdist::mesh::Mesh, pose: &Isometry3<f64>| {
        host.is_solid()
            && guest.triangles().iter().any(|t| winding(host, &(pose * guest.vertices()[t[0] as usize]).coords) > 0.5)
    };
    let at = |pose: &Isometry3<f64>| brute_meet(a, b, pose) || inside(b, a, pose) || inside(a, b, &pose.inverse());
    // Signs of volumes are rounding for slender bodies: what overlaps does so when moved by rounding, too.
    at(pose) && nudges.iter().all(|u| at(&(Translation3::from(u * nudge) * pose)))
}

fn proximity(dice: &mut Dice, a: &Model, b: &Model, pose: &Isometry3<f64>) {
    let mut pair = Pair::new(a.mesh(), b.mesh());
    let (collides, meet) = (pair.collides(pose), pair.surfaces_meet(pose));
    let distance = pair.distance(pose);
    let size = a.mesh().diagonal();
    if meet && !collides {
        find("surfaces meet and bodies do not", pose);
    }
    if !(distance.distance >= 0.0) || (!meet && distance.distance == 0.0) {
        find("distance", &(distance, meet));
    }
    if !collides && pair.distance_greater_than(pose, distance.distance * (1.0 + 1e-9)) {
        // By how much, to within a factor of ten.
        let wrong = (1..9)
            .rev()
            .map(|k| 10f64.powi(k - 9))
            .find(|x| pair.distance_greater_than(pose, distance.distance * (1.0 + x)));
        find("distance is greater than itself", &(distance, wrong));
    }
    if !collides && proper(pose) && overlap(a, b, pose) {
        find("free by the solid test, but not by brute force", pose);
    }
    let margin = size * dice.pick(&[0.0, 1e-3, 0.1, 1.0, 1e3, f64::INFINITY, f64::NAN]);
    let mut contacts = Vec::new();
    pair.contacts(pose, margin, &mut contacts);
    for c in &contacts {
        if !(c.gap.abs() <= margin && (c.normal.norm() - 1.0).abs() < 1e-9) {
            find("contact", &(c, margin));
        }
    }
    let mut work = 1000;
    pair.overlaps(pose, margin, dice.unit(), &mut work, &mut contacts);
    let other = self::pose(dice, a, b);
    let screw = Screw::new(pose, &other);
    let impact = pair.advance(&screw, 0.0, 1e-3 * size, 60);
    if impact.stop != Stop::Start {
        for s in [0.0, impact.s * dice.unit(), impact.s] {
            if pair.collides(&screw.at(s)) && s == 0.0 {
                find("motion that is not free", &(impact, s));
            }
        }
        let middle = screw.at(impact.s * dice.unit());
        if proper(pose) && proper(&other) && overlap(a, b, &middle) {
            find("motion that is not free by brute force", &(impact, pose, other));
        }
    }
    let s = pair.bisect(&screw, 0.0, 1.0, 1e-6 * size);
    if !(0.0..=1.0).contains(&s) || (s > 0.0 && pair.collides(&screw.at(s))) {
        find("bisection", &s);
    }
}

fn depths(dice: &mut Dice, a: &Model, b: &Model, start: &Isometry3<f64>, tally: &mut Tally, verbose: bool) {
    let metrics: Vec<&dyn Metric> = std::iter::once(a.disp() as &dyn Metric).chain(a.sigma().map(|s| s as _)).collect();
    let samples = if dice.chance(0.1) {
        ContactSamples::new(a, b, 4, 3, None).poses().to_vec()
    } else if dice.chance(0.2) {
        vec![pose(dice, a, b), pose(dice, a, b)]
    } else {
        Vec::new()
    };
    let mut solver = DepthSolver::new(a, b);
    let mut lower = vec![0.0f64; metrics.len()];
    let mut free = Vec::new();
    for (k, metric) in metrics.iter().enumerate() {
        for _ in 0..2 {
            let options = DepthOptions {
                effort: dice.pick(&[Effort::Fast, Effort::Fast, Effort::Fast, Effort::Default]),
                seed: dice.bits().into(),
                relative: dice.pick(&[0.0, 1e-3, 0.5]),
                max_queries: dice.pick(&[0, 1, 30, 300, 3000]),
                walk: dice.pick(&[Walk::Linearised, Walk::Linearised, Walk::Branching, Walk::Sampling]),
                rays: dice.chance(0.8),
                push_out: dice.chance(0.8),
                poses: &samples,
            };
            let effort = if dice.chance(0.01) { Effort::Heavy } else { options.effort };
            let options = DepthOptions { effort, ..options };
            let depth = solver.depth(start, *metric, &options, None);
            if verbose {
                println!("{options:?} {depth:?}");
            }
            tally.depths += 1;
            tally.penetrating += u64::from(depth.upper > 0.0 && depth.upper.is_finite());
            tally.certified += u64::from(depth.lower > 0.0);
            check(a, b, *metric, start, &depth, &mut free);
            lower[k] = lower[k].max(depth.lower);
        }
    }
    let mut tracker = DepthTracker::new(a, b);
    let mut at = *start;
    for tick in 0..4 {
        let k = dice.below(metrics.len());
        let budget = Budget { max_queries: dice.pick(&[0, 1, 16, 60]), ..Budget::default() };
        let depth = tracker.update(&at, metrics[k], &budget, None);
        tally.ticks += 1;
        check(a, b, metrics[k], &at, &depth, &mut Vec::new());
        free.push(depth.pose);
        if tick == 0 {
            lower[k] = lower[k].max(depth.lower);
        }
        if at != *start {
            free.pop();
        }
        let step = a.mesh().diagonal() * dice.decade(-4.0, 0.0);
        at.translation.vector += Vector3::from([0; 3].map(|_| step * dice.signed()));
    }
    let mut pair = Pair::new(a.mesh(), b.mesh());
    free.extend(samples);
    for pose in free.iter().filter(|pose| proper(pose)) {
        for (metric, lower) in metrics.iter().zip(&lower) {
            if !pair.collides(pose) && metric.distance(start, pose) < *lower && proper(start) {
                find("a free pose below a lower bound", &(lower, metric.distance(start, pose), pose));
            }
        }
        let values: Vec<_> = metrics.iter().map(|metric| metric.distance(start, pose)).collect();
        if let [disp, sigma] = values[..]
            && proper(start)
            && !(sigma <= disp * (1.0 + 1e-9) + blur(a, b, start).max(blur(a, b, pose)))
        {
            find("the root mean square is larger than the largest", &(sigma, disp));
        }
    }
}

fn check(
    a: &Model,
    b: &Model,
    metric: &dyn Metric,
    start: &Isometry3<f64>,
    depth: &MeshDepth,
    free: &mut Vec<Isometry3<f64>>,
) {
    let MeshDepth { outcome, lower, upper, pose, .. } = depth;
    if !(*lower >= 0.0 && lower <= upper) {
        find("bracket", depth);
    }
    match outcome {
        Outcome::Invalid | Outcome::Stuck => {
            if upper.is_finite() {
                find("no pose, but a number", depth);
            }
        }
        _ if upper.is_finite() => {
            free.push(*pose);
            let value = metric.distance(start, pose);
            if proper(start) && !((value - upper).abs() <= 1e-12 * upper + blur(a, b, start)) {
                find("the pose is not at the upper bound", &(value, depth));
            }
            if Pair::new(a.mesh(), b.mesh()).collides(pose) {
                find("the pose is not free", depth);
            }
            if overlap(a, b, pose) {
                find("the pose is not free by brute force", depth);
            }
            if *outcome == Outcome::Separated && *upper > 0.0 {
                find("separated, but deep", depth);
            }
        }
        Outcome::Budget | Outcome::Interrupted => {}
        _ => find("neither a pose nor a reason", depth),
    }
}
