//! `qdist haptic`: a tool in a haptic loop, its depth at 1 kHz, and the force that a hand would feel.
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
use std::fmt::Display;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::{Duration, Instant};

use clap::Args;

use crate::mesh::input::Kind;
use crate::mesh::{bodies, read};
use crate::{Trouble, flags, written};

/// What a tick may take.
const TICK: Duration = Duration::from_millis(1);
/// No query begins later in a tick.
const LATE: Duration = Duration::from_micros(400);
/// Of the spring, per length of the files.
const STIFFNESS: f64 = 1.0;
/// Every so many ticks a cold answer is asked for, to compare.
const SAMPLE: u32 = 50;

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

fn read(file: &Path) -> Result<Triangles, Trouble> {
    let mesh = read::mesh(file)?;
    Ok((mesh.vertices.into_iter().map(Point3::from).collect(), mesh.triangles))
}

fn body(name: impl Display, (vertices, triangles): Triangles) -> Result<Model, Trouble> {
    let model = Model::new(&vertices, &triangles).map_err(|error| format!("{name}: {error}"))?;
    Ok(bodies::with_pieces(model))
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

/// The object norm takes a volume: the tool of an open surface has none (`run` refuses it).
fn metric(a: &Model, sigma: bool) -> &dyn Metric {
    match a.sigma() {
        Some(norm) if sigma => norm,
        _ => a.disp(),
    }
}

/// Of a list that is not empty.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() as f64 * share) as usize).min(sorted.len() - 1)]
}

/// A tool in a haptic loop: its depth at 1 kHz, and the force that a hand would feel
///
/// The tool goes round its part on a closed curve, in and out of contact, turning as it goes. Every tick asks a tracker for the depth with a clock
/// that says "late" after 0.4 ms, and is timed; another thread asks cold queries, whose answers are merged in. Printed are a histogram of the
/// ticks, how far the warm upper bounds are above cold ones, in shares of the tool's size (of depths near 0 a ratio says nothing), and the
/// strongest force.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct Request {
    /// The two meshes (OBJ, STL, PLY, OFF); without them, a ring goes through a knot
    #[arg(value_names = ["TOOL", "PART"], num_args = 2)]
    files: Vec<PathBuf>,
    /// What is measured
    #[arg(long, default_value = "disp")]
    metric: Kind,
    /// Ticks of the curve, ten millions at most
    #[arg(long, value_name = "N", default_value = "5000", value_parser = flags::count::<1, 10_000_000>)]
    #[arg(allow_negative_numbers = true)]
    ticks: u32,
    /// A tick a millisecond, not as fast as they can: otherwise the background falls behind
    #[arg(long)]
    realtime: bool,
}

/// Goes round, and reports on the standard output.
pub fn run(request: &Request) -> Result<(), Trouble> {
    let sigma = request.metric == Kind::Sigma;
    let (a, b) = match request.files.as_slice() {
        [a, b] => (body(a.display(), read(a)?)?, body(b.display(), read(b)?)?),
        _ => (body("tool", tool())?, body("part", part())?),
    };
    if sigma && a.sigma().is_none() {
        return Err("--metric sigma: the tool is no solid, and an open surface has no volume to integrate over".into());
    }
    let mut out = io::stdout().lock();
    begin(&mut out, &a, &b).map_err(written)?;
    let metric = metric(&a, sigma);
    let mut times = vec![];
    let mut samples = vec![];
    let (mut merged, mut strongest) = (0, (0.0, Vector3::zeros(), Vector3::zeros(), 0));
    std::thread::scope(|scope| {
        let (ask, poses) = sync_channel(1);
        let (answers, results) = sync_channel(1);
        let (a, b) = (&a, &b);
        scope.spawn(move || background(a, b, sigma, poses, answers));
        let mut tracker = DepthTracker::new(a, b);
        let begin = Instant::now();
        for tick in 0..request.ticks {
            let pose = path(a, b, f64::from(tick) / f64::from(request.ticks));
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
            if request.realtime {
                std::thread::sleep((begin + TICK * (tick + 1)).saturating_duration_since(Instant::now()));
            }
        }
    });
    let mut cold = DepthSolver::new(&a, &b);
    let pairs = samples.iter().map(|(pose, warm)| {
        let cold = cold.depth(pose, metric, &DepthOptions::default(), None);
        (warm.upper, cold.upper)
    });
    let compared = compared(&pairs.collect::<Vec<_>>(), a.mesh().diagonal());
    let (size, force, torque, tick) = strongest;
    let force = match size > 0.0 {
        true => {
            format!("strongest force, tick {tick}: force {:.4?}, torque {:.4?}", force.as_slice(), torque.as_slice())
        }
        false => "no force: the tool touched nothing".into(),
    };
    let lines = format!("merged answers of the background: {merged}\n{compared}\n{force}");
    report(&mut out, times).and_then(|()| writeln!(out, "{lines}")).map_err(written)
}

fn begin(out: &mut dyn Write, a: &Model, b: &Model) -> io::Result<()> {
    for (name, model) in [("tool", a), ("part", b)] {
        if !model.mesh().report().solid {
            writeln!(out, "the {name} is no solid: its surface only is asked, there are no lower bounds")?;
        }
    }
    let [tool, part] = [a, b].map(|model| model.mesh().triangles().len());
    writeln!(out, "tool: {tool} triangles, part: {part} triangles")?;
    // The loop takes seconds.
    out.flush()
}

/// Upper bounds of warm answers beside those of cold ones, in shares of the tool's size: a depth may be next to nothing, and a ratio of two such says
/// nothing of either.
fn compared(pairs: &[(f64, f64)], size: f64) -> String {
    let known = |x: f64| x < f64::MAX;
    let mut off: Vec<_> = pairs
        .iter()
        .filter(|(warm, cold)| known(*warm) && known(*cold))
        .map(|(warm, cold)| (warm - cold) / size)
        .collect();
    off.sort_by(f64::total_cmp);
    let lacking = match pairs.len() - off.len() {
        0 => String::new(),
        count => format!(" ({count} more have no upper bound)"),
    };
    if off.is_empty() {
        return format!("warm and cold upper bounds: none of both were sampled in contact{lacking}");
    }
    let [median, late, most] = [0.5, 0.9, 1.0].map(|share| 100.0 * quantile(&off, share));
    format!(
        "upper bound, warm less cold, in % of the tool's size ({size:.4}), on {} ticks: median {median:.3}, 90 % {late:.3}, worst {most:.3}{lacking}",
        off.len()
    )
}

/// The histogram of the ticks, in milliseconds.
fn report(out: &mut dyn Write, mut times: Vec<f64>) -> io::Result<()> {
    times.sort_by(f64::total_cmp);
    let edges = [0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0, 5.0, f64::INFINITY];
    for edge in edges.windows(2) {
        let count = times.iter().filter(|&&t| edge[0] <= t && t < edge[1]).count();
        let bar = "#".repeat((60 * count).div_ceil(times.len()));
        writeln!(out, "{:>5.2} to {:>5.2} ms {count:>7} {bar}", edge[0], edge[1])?;
    }
    writeln!(
        out,
        "{} ticks: median {:.3} ms, p99 {:.3} ms, max {:.3} ms, missed (above 1 ms, also when the machine took the processor away) {}",
        times.len(),
        quantile(&times, 0.5),
        quantile(&times, 0.99),
        quantile(&times, 1.0),
        times.iter().filter(|&&t| t > 1.0).count()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flags::{parse, refuses};

    #[test]
    fn what_may_be_asked() {
        assert_eq!(parse::<Request>("--ticks 7").unwrap().ticks, 7);
        refuses::<Request>("", "ticks", &["0", "-1", "nan", "1.5", "10000001", "99999999999999999999"]);
        assert!(parse::<Request>("a.obj").is_err());
    }

    /// Nothing is divided by a depth that may be 0; a loop that never touches has a word for it.
    #[test]
    fn depths_near_nothing_are_compared() {
        let told = compared(&[(1e-9, 0.0), (0.5, 0.4), (0.2, 0.3)], 2.0);
        assert!(told.contains("on 3 ticks: median 0.000, 90 % 5.000, worst 5.000"), "{told}");
        let told = compared(&[(f64::INFINITY, 1.0), (f64::INFINITY, f64::INFINITY)], 2.0);
        assert!(told.contains("none of both") && told.contains("2 more have no upper bound"), "{told}");
        assert!(compared(&[], 1.0).contains("none of both"));
    }
}
