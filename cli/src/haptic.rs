//! A tool in a haptic loop: its depth at 1 kHz, and the force that a hand would feel.
//!
//! ```text
//! cargo run --release --features std --example haptic
//! cargo run --release --features std --example haptic -- TOOL.obj PART.obj [--metric disp|sigma] [--ticks N] [--realtime]
//! ```
//!
//! The tool goes round its part on a closed curve, in and out of contact, turning as it goes. Every tick asks a [`DepthTracker`] for the depth
//! with a clock that says "late" after 0.4 ms (a query or a certificate that has begun is finished), and is timed. Another thread asks cold queries at the newest pose all the time, whose answers are merged in. Without
//! `--realtime` ticks follow each other as fast as they can, so the background falls behind.
//!
//! **Force.** The answer's pose is where the tool would be if it could not enter the part, a god-object; a spring ties the tool to it.
//! The force on the tool is k times the displacement of its centre from the query's pose to the answer's, the torque about the centre is k r^2 times
//! the rotation vector between them, r being the metric's radius, which makes an angle a length. So the spring's energy is about k times half the depth squared,
//! and the force is continuous as long as the answer stays in one valley of the free space.

use qdist::mesh::metric::Metric;
use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, MeshDepth, Model, Outcome};
use qdist::nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3, center};
use std::f64::consts::TAU;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

/// What a tick may take.
const TICK: Duration = Duration::from_millis(1);
/// No query begins later in a tick.
const LATE: Duration = Duration::from_micros(400);
/// Of the spring, per length of the files.
const STIFFNESS: f64 = 1.0;
/// Every so many ticks a cold answer is asked for, to compare.
const SAMPLE: usize = 50;

/// Vertices and triangles.
type Triangles = (Vec<Point3<f64>>, Vec<[u32; 3]>);

/// A closed tube around a closed curve.
fn tube(around: usize, across: usize, radius: f64, curve: impl Fn(f64) -> Vector3<f64>) -> Triangles {
    let mut vertices = vec![];
    for i in 0..around {
        let s = TAU * i as f64 / around as f64;
        let tangent = (curve(s + 1e-4) - curve(s - 1e-4)).normalize();
        let side = tangent.cross(&Vector3::new(0.3, 0.2, 0.93)).normalize();
        let up = tangent.cross(&side);
        vertices.extend((0..across).map(|j| {
            let t = TAU * j as f64 / across as f64;
            Point3::from(curve(s) + (side * t.cos() + up * t.sin()) * radius)
        }));
    }
    let index = |i: usize, j: usize| ((i % around) * across + j % across) as u32;
    let quads = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let split = |(i, j)| {
        let [a, b, c, d] = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    (vertices, quads.flat_map(split).collect())
}

/// A ring with waves, the tool.
fn tool() -> Triangles {
    tube(96, 12, 0.12, |s| Vector3::new(0.5 * s.cos(), 0.4 * s.sin(), 0.1 * (3.0 * s).cos()))
}

/// A trefoil, the part.
fn part() -> Triangles {
    tube(192, 14, 0.3, |s| {
        let r = 1.0 + 0.4 * (3.0 * s).cos();
        Vector3::new(r * (2.0 * s).cos(), r * (2.0 * s).sin(), 0.6 * (3.0 * s).sin())
    })
}

fn read(file: &str) -> Result<Triangles, String> {
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let (models, _) = tobj::load_obj(file, &options).map_err(|error| format!("{file}: {error}"))?;
    let mut all: Triangles = Default::default();
    for model in models {
        let first = all.0.len() as u32;
        all.0.extend(model.mesh.positions.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2])));
        all.1.extend(model.mesh.indices.chunks_exact(3).map(|t| [t[0] + first, t[1] + first, t[2] + first]));
    }
    Ok(all)
}

fn body(name: &str, (vertices, triangles): Triangles) -> Result<Model, String> {
    let model = Model::new(&vertices, &triangles).map_err(|error| format!("{name}: {error}"))?;
    // A soup has no certificate: its lower bounds are 0.
    Ok(model.clone().with_pieces(&Default::default()).unwrap_or(model))
}

/// Where the tool is, at s in [0, 1]: its middle on a curve through the part's box.
fn path(a: &Model, b: &Model, s: f64) -> Isometry3<f64> {
    let middle = |model: &Model| {
        let (low, high) = model.mesh().bounds();
        (center(&low, &high), (high - low) * 0.5)
    };
    let ((centre_a, _), (centre_b, half)) = (middle(a), middle(b));
    let (x, y, z) = ((TAU * s).cos(), (TAU * s).sin(), (2.0 * TAU * s).sin());
    let at = centre_b + Vector3::new(1.3 * x * half.x, 1.1 * y * half.y, 0.8 * z * half.z);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.5 * y, 0.7 * z, TAU * 0.5 * x));
    Isometry3::from_parts(Translation3::from(at - turn * centre_a.coords), turn)
}

/// Force on the tool and torque about its centre.
fn spring(metric: &dyn Metric, pose: &Isometry3<f64>, depth: &MeshDepth) -> (Vector3<f64>, Vector3<f64>) {
    let frame = metric.frame();
    let force = STIFFNESS * (depth.pose * frame.centre - pose * frame.centre);
    let turn = (depth.pose.rotation * pose.rotation.inverse()).scaled_axis();
    (force, STIFFNESS * frame.radius * frame.radius * turn)
}

/// Answers cold queries until the other side hangs up.
fn background(a: &Model, b: &Model, sigma: bool, poses: Receiver<Isometry3<f64>>, answers: SyncSender<MeshDepth>) {
    let mut solver = DepthSolver::new(a, b);
    for pose in poses {
        let depth = solver.depth(&pose, metric(a, sigma), &DepthOptions::default(), None);
        if matches!(answers.try_send(depth), Err(TrySendError::Disconnected(_))) {
            return;
        }
    }
}

fn metric(a: &Model, sigma: bool) -> &dyn Metric {
    match a.sigma() {
        Some(norm) if sigma => norm,
        _ => a.disp(),
    }
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted
        .get(((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1)))
        .copied()
        .unwrap_or(f64::NAN)
}

struct Request {
    files: Vec<String>,
    sigma: bool,
    ticks: usize,
    real_time: bool,
}

fn parse() -> Result<Request, String> {
    let mut request = Request { files: vec![], sigma: false, ticks: 5000, real_time: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--metric" => match words.next().as_deref() {
                Some("disp") => request.sigma = false,
                Some("sigma") => request.sigma = true,
                _ => return Err("--metric is disp or sigma".into()),
            },
            "--ticks" => {
                let count = words.next().and_then(|word| word.parse().ok()).filter(|&n| n > 0);
                request.ticks = count.ok_or("--ticks is a whole number from 1 up")?;
            }
            "--realtime" => request.real_time = true,
            file if !file.starts_with('-') => request.files.push(file.into()),
            other => return Err(format!("{other}: unknown option")),
        }
    }
    if ![0, 2].contains(&request.files.len()) {
        return Err("two mesh files, or none".into());
    }
    Ok(request)
}

fn run(request: &Request) -> Result<(), String> {
    let (a, b) = match request.files.as_slice() {
        [a, b] => (body(a, read(a)?)?, body(b, read(b)?)?),
        _ => (body("tool", tool())?, body("part", part())?),
    };
    for (name, model) in [("tool", &a), ("part", &b)] {
        if !model.mesh().report().solid {
            println!("the {name} is no solid: its surface only is asked, there are no lower bounds");
        }
    }
    println!("tool: {} triangles, part: {} triangles", a.mesh().triangles().len(), b.mesh().triangles().len());
    let metric = metric(&a, request.sigma);
    let mut times = vec![];
    let mut samples = vec![];
    let (mut merged, mut strongest) = (0, (0.0, Vector3::zeros(), Vector3::zeros(), 0));
    std::thread::scope(|scope| {
        let (ask, poses) = sync_channel(1);
        let (answers, results) = sync_channel(1);
        let (a, b) = (&a, &b);
        scope.spawn(move || background(a, b, request.sigma, poses, answers));
        let mut tracker = DepthTracker::new(a, b);
        let begin = Instant::now();
        for tick in 0..request.ticks {
            let pose = path(a, b, tick as f64 / request.ticks as f64);
            let start = Instant::now();
            if let Ok(cold) = results.try_recv() {
                merged += u32::from(tracker.merge(&cold));
            }
            let depth = tracker.update(&pose, metric, &Budget::default(), Some(&|| start.elapsed() > LATE));
            let (force, torque) = spring(metric, &pose, &depth);
            times.push(start.elapsed().as_secs_f64() * 1e3);
            if depth.outcome != Outcome::Separated {
                // A full queue means that the background is busy.
                let _ = ask.try_send(pose);
                if force.norm() > strongest.0 {
                    strongest = (force.norm(), force, torque, tick);
                }
                if tick % SAMPLE == 0 {
                    samples.push((pose, depth));
                }
            }
            if request.real_time {
                std::thread::sleep((begin + TICK * (tick as u32 + 1)).saturating_duration_since(Instant::now()));
            }
        }
    });
    let mut cold = DepthSolver::new(&a, &b);
    let mut ratios: Vec<_> = samples
        .iter()
        .map(|(pose, warm)| warm.upper / cold.depth(pose, metric, &DepthOptions::default(), None).upper)
        .collect();
    ratios.sort_by(f64::total_cmp);
    report(times);
    println!("merged answers of the background: {merged}");
    println!(
        "upper bound, warm / cold, on {} ticks: median {:.3}, 90 % {:.3}, worst {:.3}",
        ratios.len(),
        quantile(&ratios, 0.5),
        quantile(&ratios, 0.9),
        quantile(&ratios, 1.0)
    );
    let (_, force, torque, tick) = strongest;
    println!("strongest force, tick {tick}: force {:.4?}, torque {:.4?}", force.as_slice(), torque.as_slice());
    Ok(())
}

/// The histogram of the ticks, in milliseconds.
fn report(mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let edges = [0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0, 5.0, f64::INFINITY];
    for edge in edges.windows(2) {
        let count = times.iter().filter(|&&t| edge[0] <= t && t < edge[1]).count();
        let bar = "#".repeat((60 * count).div_ceil(times.len()));
        println!("{:>5.2} to {:>5.2} ms {count:>7} {bar}", edge[0], edge[1]);
    }
    println!(
        "{} ticks: median {:.3} ms, p99 {:.3} ms, max {:.3} ms, missed (above 1 ms, also when the machine took the processor away) {}",
        times.len(),
        quantile(&times, 0.5),
        quantile(&times, 0.99),
        quantile(&times, 1.0),
        times.iter().filter(|&&t| t > 1.0).count()
    );
}

const USAGE: &str = "usage: haptic [TOOL.obj PART.obj] [--metric disp|sigma] [--ticks N] [--realtime]";

fn main() -> std::process::ExitCode {
    if std::env::args().any(|word| word == "--help" || word == "-h") {
        println!("{USAGE}");
        return std::process::ExitCode::SUCCESS;
    }
    match parse().and_then(|request| run(&request)) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(trouble) => {
            eprintln!("haptic: {trouble}");
            std::process::ExitCode::FAILURE
        }
    }
}
