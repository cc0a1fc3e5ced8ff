//! Random small meshes and poses, proper and broken, by the million: what must hold whatever they are. (`mesh_fuzz` looks longer at fewer.)
//!
//!     cargo run --release -p qdist-fuzz --bin mesh_fuzz_quick -- --cases 100000 [--seed 1] [--case 17]
//!
//! A case is a mesh that was not there before and a pose. Meshes: solids, with holes, turned inside out, crumpled, flattened to sheets and
//! needles, soups, indices out of range, no numbers; from 1e-60 to 1e60, one up to 1e6 times the other. Poses: overlapping,
//! touching along an axis, far away, no rotations, no numbers. Queries of all kinds, both metrics, all walks, few or many queries; the tracker. For every answer:
//!
//! * nothing panics, and nothing takes longer than ten seconds;
//! * 0 <= lower <= upper, no NaN, and outcome and numbers agree;
//! * the pose of a finite upper bound is free by a pair that was made for it, and its distance is the bound;
//! * where brute force over all triangles sees two of them cross, no query calls the pose free;
//! * no lower bound is above another answer's upper bound.
//!
//! The first find is printed with its case, and the exit code is 1.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use qdist::mesh::certificate::{BuildOptions, Effort};
use qdist::mesh::metric::Metric;
use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, MeshDepth, Model, Outcome, Pair, Screw, Walk};
use qdist_fuzz::common::dice::Dice;
use qdist_fuzz::mesh_common::{self, Shape, cuboid, icosphere, l_shape, random_pose, slot, tetrahedron, torus};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The case in work, for the panic hook and the watchdog.
static CURRENT: Mutex<(u64, Option<Instant>)> = Mutex::new((0, None));

fn case_in_work() -> u64 {
    CURRENT.lock().map_or(0, |c| c.0)
}

/// A find ends the program.
fn find(what: &str, detail: &str) -> ! {
    println!("FIND in --case {}: {what}\n{detail}", case_in_work());
    std::process::exit(1);
}

fn main() {
    let (mut cases, mut seed, mut only) = (10_000u64, 1u64, None);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().and_then(|v| v.parse().ok());
        match (arg.as_str(), value) {
            ("--cases", Some(n)) => cases = n,
            ("--seed", Some(n)) => seed = n,
            ("--case", Some(n)) => only = Some(n),
            _ => {
                eprintln!("usage: mesh_fuzz_quick [--cases N] [--seed N] [--case N]");
                std::process::exit(2);
            }
        }
    }
    std::panic::set_hook(Box::new(|info| {
        println!("FIND in --case {}: panic\n{info}", case_in_work());
        std::process::exit(1);
    }));
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let since = CURRENT.lock().ok().and_then(|c| c.1);
            if since.is_some_and(|t| t.elapsed() > Duration::from_secs(10)) {
                find("ten seconds", "");
            }
        }
    });
    let begin = Instant::now();
    let (mut tally, mut other) = (Tally::default(), None);
    for case in only.map_or(0..cases, |k| k..k + 1) {
        // Each from its own number, so that one can be repeated alone; the second mesh is made anew every eighth case.
        *CURRENT.lock().unwrap() = (case, Some(Instant::now()));
        if other.is_none() || case % 8 == 0 || only.is_some() {
            other = Some(body(&mut Dice::new(seed.wrapping_mul(1 << 40) ^ (case / 8) ^ (1 << 39))));
        }
        run(&mut Dice::new(seed.wrapping_mul(1 << 40) ^ case), other.as_ref(), &mut tally);
    }
    println!("{cases} cases in {} s, nothing found: {tally:?}", begin.elapsed().as_secs());
}

/// How many of what came up, so that a run that tests nothing is seen.
#[derive(Debug, Default)]
struct Tally {
    refused: u64,
    pairs: u64,
    solids: u64,
    with_pieces: u64,
    colliding: u64,
    finite: u64,
    above_zero: u64,
    separated: u64,
    invalid: u64,
}

struct Body {
    shape: Shape,
    model: Option<Model>,
}

/// A mesh, and the model if it is accepted.
fn body(dice: &mut Dice) -> Body {
    let mut shape = match dice.below(8) {
        0 => tetrahedron(),
        1 => cuboid([dice.range(0.1, 1.0), dice.range(0.1, 1.0), dice.range(0.1, 1.0)]),
        2 => l_shape(),
        3 => slot(1.0, 1.0, dice.range(0.05, 1.0), dice.range(0.1, 0.9), dice.range(0.1, 1.0)),
        4 => torus(3 + dice.below(8), 3 + dice.below(4), 1.0, dice.range(0.05, 0.6)),
        5 => icosphere(dice.below(2)),
        6 => icosphere(0).and(&icosphere(0).flipped().placed(&Isometry3::identity(), 0.5)),
        _ => {
            let n = 3 + dice.below(12);
            let vertices = (0..n).map(|_| [dice.signed(), dice.signed(), dice.signed()]).collect();
            let corner = |dice: &mut Dice| dice.below(n) as u32;
            let triangles = (0..1 + dice.below(12)).map(|_| [corner(dice), corner(dice), corner(dice)]).collect();
            Shape { vertices, triangles }
        }
    };
    // What is done to it.
    if dice.chance(0.3) {
        let crumple = dice.decade(-9.0, 0.0);
        shape.vertices.iter_mut().flatten().for_each(|x| *x += crumple * dice.signed());
    }
    if dice.chance(0.15) {
        let (axis, flat) = (dice.below(3), dice.pick(&[0.0, 1e-15, 1e-9, 1e-4, 1e3]));
        shape.vertices.iter_mut().for_each(|v| v[axis] *= flat);
    }
    if dice.chance(0.1) {
        shape = shape.flipped();
    }
    if dice.chance(0.15) && shape.triangles.len() > 1 {
        shape = shape.without(dice.below(shape.triangles.len()));
    }
    if dice.chance(0.1) {
        let k = dice.below(shape.triangles.len());
        shape.triangles.push(shape.triangles[k]);
    }
    if dice.chance(0.1) {
        let (i, j) = (dice.below(shape.vertices.len()), dice.below(shape.vertices.len()));
        shape.vertices[i] = shape.vertices[j];
    }
    if dice.chance(0.5) {
        let size = if dice.chance(0.1) { dice.decade(-60.0, 60.0) } else { dice.decade(-3.0, 3.0) };
        let pose = if dice.chance(0.5) { random_pose(dice, size) } else { Isometry3::identity() };
        shape = shape.placed(&pose, size);
    }
    // What must be refused.
    if dice.chance(0.02) {
        let (i, k) = (dice.below(shape.vertices.len()), dice.below(3));
        shape.vertices[i][k] = dice.pick(&[f64::NAN, f64::INFINITY, 1e300, -1e61]);
    }
    if dice.chance(0.02) {
        let t = dice.below(shape.triangles.len());
        shape.triangles[t][dice.below(3)] = dice.pick(&[u32::MAX, 1_000_000, shape.vertices.len() as u32]);
    }
    if dice.chance(0.01) {
        shape.triangles.clear();
    }
    let model = Model::new(&shape.vertices, &shape.triangles).ok();
    let model = match model {
        Some(model) if dice.chance(0.2) && model.is_solid() => {
            let options = BuildOptions { max_pieces: 6, samples: 50, ..BuildOptions::default() };
            // The surface may cut itself: then there are no pieces.
            model.with_pieces(&options).ok()
        }
        model => model,
    };
    Body { shape, model }
}

/// A pose where the bodies are likely to meet.
fn pose(dice: &mut Dice, a: &Model, b: &Model) -> Isometry3<f64> {
    let size = a.mesh().diagonal().max(b.mesh().diagonal());
    let middle = |m: &Model| {
        let (low, high) = m.mesh().bounds();
        nalgebra::center(&low, &high)
    };
    let mut pose = random_pose(dice, 0.0);
    if dice.chance(0.2) {
        pose.rotation = UnitQuaternion::identity();
    }
    let reach = dice.pick(&[0.0, 0.1, 0.3, 0.6, 3.0]) * size;
    let shift = nalgebra::Vector3::new(dice.signed(), dice.signed(), dice.signed()) * reach;
    let to = middle(b) + shift;
    pose.translation = Translation3::from(to - pose.rotation * middle(a));
    match dice.below(60) {
        0 => pose.translation.vector[dice.below(3)] = dice.pick(&[f64::NAN, f64::INFINITY, 1e70, 1e59]),
        1 => pose.rotation = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, dice.signed(), 0.0)),
        2 => pose.rotation = UnitQuaternion::new_unchecked(Quaternion::new(f64::NAN, 1.0, 0.0, 0.0)),
        _ => {}
    }
    pose
}

fn run(dice: &mut Dice, other: Option<&Body>, tally: &mut Tally) {
    let made = body(dice);
    let (Some(model), Some(other), Some(known)) = (&made.model, other, other.and_then(|o| o.model.as_ref())) else {
        tally.refused += u64::from(made.model.is_none());
        return;
    };
    let (a, b, shapes) = if dice.chance(0.5) {
        (model, known, [&made.shape, &other.shape])
    } else {
        (known, model, [&other.shape, &made.shape])
    };
    tally.pairs += 1;
    tally.solids += u64::from(a.is_solid() && b.is_solid());
    tally.with_pieces += u64::from(a.pieces().is_some() && b.pieces().is_some());
    let at = pose(dice, a, b);
    let mut pair = Pair::new(a.mesh(), b.mesh());
    let collides = pair.collides(&at);
    tally.colliding += u64::from(collides);
    let usable = at.translation.vector.iter().all(|x| x.abs() < 1e60) && (at.rotation.norm() - 1.0).abs() < 1e-6;
    let scene = || format!("{at:?}\nA {:?}\nB {:?}", shapes[0], shapes[1]);
    if !collides && usable && clearly_meet(a, b, &at) {
        find("triangles cross at a free pose", &scene());
    }
    proximity(dice, &mut pair, &at, collides, &scene);

    let metric: &dyn Metric = match a.sigma() {
        Some(sigma) if dice.chance(0.5) => sigma,
        _ => a.disp(),
    };
    let guess = [pose(dice, a, b)];
    let options = DepthOptions {
        effort: if dice.chance(0.97) { Effort::Fast } else { Effort::Default },
        seed: u64::from(dice.bits()),
        max_queries: dice.pick(&[0, 1, 10, 60, 200]),
        walk: dice.pick(&[Walk::Linearised, Walk::Linearised, Walk::Branching, Walk::Sampling]),
        rays: dice.chance(0.8),
        push_out: dice.chance(0.5),
        poses: if dice.chance(0.2) { &guess } else { &[] },
        ..DepthOptions::default()
    };
    let mut solver = DepthSolver::new(a, b);
    let depth = solver.depth(&at, metric, &options, None);
    check(&depth, a, b, &at, metric, usable, tally, &scene);
    if dice.chance(0.2) {
        let mut tracker = DepthTracker::new(a, b);
        let mut now = at;
        for _ in 0..3 {
            let tick = tracker.update(&now, metric, &Budget::default(), None);
            check(&tick, a, b, &now, metric, usable, tally, &scene);
            if now == at && (tick.lower > depth.upper * (1.0 + 1e-9) || depth.lower > tick.upper * (1.0 + 1e-9)) {
                find("brackets contradict each other", &format!("{depth:?}\n{tick:?}\n{}", scene()));
            }
            let _ = tracker.merge(&depth);
            now.translation.vector[dice.below(3)] += 1e-3 * a.mesh().diagonal();
        }
    }
}

/// Whether triangles cross, and do so when A moves a little: by the signs of volumes, that rounding may change.
fn clearly_meet(a: &Model, b: &Model, at: &Isometry3<f64>) -> bool {
    let (large, small) = (a.mesh().diagonal().max(b.mesh().diagonal()), a.mesh().diagonal().min(b.mesh().diagonal()));
    let extent = large + at.translation.vector.amax() + b.mesh().bounds().0.coords.amax();
    small > 1e-4 * extent
        && [0.0, -1.0, 1.0].into_iter().all(|s| {
            let shift = Translation3::from(nalgebra::Vector3::new(0.3, 0.5, -0.8) * (s * 1e-7 * extent));
            mesh_common::brute_meet(a.mesh(), b.mesh(), &(shift * at))
        })
}

/// The other queries of a pair.
fn proximity(dice: &mut Dice, pair: &mut Pair, at: &Isometry3<f64>, collides: bool, scene: &dyn Fn() -> String) {
    if dice.chance(0.3) {
        let distance = pair.distance(at).distance;
        if !(distance >= 0.0) {
            find("distance", &format!("{distance}\n{}", scene()));
        }
        if distance > 0.0 && pair.distance_greater_than(at, 1.01 * distance) {
            find("distance is greater than itself", &format!("{distance}\n{}", scene()));
        }
    }
    if dice.chance(0.3) {
        let mut contacts = Vec::new();
        let margin = dice.pick(&[0.0, 0.01, 1.0]) * pair.a().diagonal();
        pair.contacts(at, margin, &mut contacts);
        if contacts
            .iter()
            .any(|c| !(c.gap.abs() <= margin * (1.0 + 1e-9) + 1e-300 && c.normal.iter().all(|x| x.is_finite())))
        {
            find("contacts", &format!("{contacts:?}\n{}", scene()));
        }
    }
    if dice.chance(0.1) && !collides {
        let mut to = *at;
        to.translation.vector[dice.below(3)] += dice.signed() * pair.b().diagonal();
        let screw = Screw::new(at, &to);
        let size = pair.a().diagonal();
        let impact = pair.advance(&screw, 1e-3 * size, 1e-4 * size, 100);
        if !(impact.s >= 0.0 && impact.s <= 1.0) || pair.collides(&screw.at(impact.s)) {
            find("continuous collision", &format!("{impact:?}\n{}", scene()));
        }
    }
}

#[allow(clippy::too_many_arguments)]
fn check(
    depth: &MeshDepth,
    a: &Model,
    b: &Model,
    at: &Isometry3<f64>,
    metric: &dyn Metric,
    usable: bool,
    tally: &mut Tally,
    scene: &dyn Fn() -> String,
) {
    let fail = |what: &str| find(what, &format!("{depth:?}\n{}", scene()));
    let MeshDepth { outcome, lower, upper, .. } = *depth;
    if !(0.0 <= lower && lower <= upper) {
        fail("bracket");
    }
    tally.above_zero += u64::from(lower > 0.0);
    match outcome {
        Outcome::Separated => tally.separated += 1,
        Outcome::Invalid => tally.invalid += 1,
        _ => {}
    }
    if (outcome == Outcome::Separated) != (upper == 0.0 && depth.distance.is_some() || outcome == Outcome::Separated) {
        fail("outcome");
    }
    if outcome != Outcome::Invalid && !usable {
        fail("an improper pose has an answer");
    }
    if upper.is_finite() && outcome != Outcome::Invalid {
        tally.finite += 1;
        if Pair::new(a.mesh(), b.mesh()).collides(&depth.pose) {
            fail("the pose collides");
        }
        // A quaternion of nearly unit length means the rotation of it over its length.
        let rotation = UnitQuaternion::new_normalize(at.rotation.into_inner());
        let value = metric.distance(&Isometry3::from_parts(at.translation, rotation), &depth.pose);
        if (value - upper).abs() > 1e-12 * (value + upper) + 1e-14 * a.mesh().diagonal() {
            fail("the pose has another distance");
        }
    }
}
