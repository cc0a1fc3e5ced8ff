//! The warm query of a 1 kHz loop: time of every tick, and its upper bound beside a cold query's.
//!
//! **Path.** A goes through the poses of a pair's queries in their order, its middle on straight lines and turning evenly, at rest at each of them
//! and at most [`STEP`] of its diagonal a tick in between: a tool of 10 cm at 20 cm/s. Most of that is deep inside.
//!
//! **Ways.** The bar is for the haptic example's budget, a clock that says "late" 0.4 ms after the tick began beside the default number of queries,
//! without a background. Without the clock, one sees how much of the time is the clock's doing; with a background, how
//! much a cold answer helps that is some ticks old.
//!
//! **Time** is the wall's, so on a busy machine it contains what a tick waits for a processor. Linux tells how much that is.

use std::fmt::Write;
use std::time::{Duration, Instant};

use qdist::mesh::metric::Metric;
use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, Model, Outcome, Pair};
use qdist::nalgebra::{Isometry3, Translation3, center};

use crate::scenes::Scenes;
use qdist_cli::mesh::bodies::metric;
use qdist_cli::mesh::input::Kind;
use qdist_cli::mesh::table::quantile;

/// The longest motion of a tick, in A's diagonals.
const STEP: f64 = 2e-3;
/// The haptic example's clock: no query begins later in a tick.
pub const LATE: Duration = Duration::from_micros(400);
/// A tick that takes longer is missed, in nanoseconds.
pub const TICK: f64 = 1e6;
/// Every so many ticks the answer is compared with a cold query's.
const SAMPLE: usize = 40;

/// Every so many ticks a cold answer begins in the background, and the one before is merged in.
const BACKGROUND: usize = 20;

/// What the tracker has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The default number of queries, and the clock.
    Clock,
    /// No clock.
    Queries,
    /// The clock and cold answers.
    Background,
}

impl Way {
    const ALL: [Way; 3] = [Way::Clock, Way::Queries, Way::Background];

    fn name(self) -> &'static str {
        match self {
            Way::Clock => "clock",
            Way::Queries => "queries",
            Way::Background => "background",
        }
    }
}

/// A path with a metric and a budget.
pub struct Warm {
    pub group: String,
    pub kind: Kind,
    pub way: Way,
    /// Nanoseconds of every tick, the first, without memory, too.
    pub times: Vec<f64>,
    /// The same without what the thread waited for a processor, where that is known.
    pub awake: Vec<f64>,
    /// Ticks in collision.
    pub inside: usize,
    /// Upper bounds over a cold query's of default effort, where the bodies collide.
    pub ratios: Vec<f64>,
    /// Ticks whose pose is not free, or whose bracket contradicts the cold one, of those compared.
    pub wrong: usize,
}

/// Every benchmark pair, both metrics, both budgets.
pub fn all(scenes: &Scenes, ticks: usize) -> Vec<Warm> {
    let mut all = Vec::new();
    for group in &scenes.benchmarks {
        let queries: Vec<_> = scenes.queries.iter().filter(|q| q.group == *group).collect();
        let Some(first) = queries.first() else { continue };
        let (a, b) = (scenes.bodies.get(&first.a), scenes.bodies.get(&first.b));
        let poses: Vec<_> = queries.iter().filter(|q| (&q.a, &q.b) == (&first.a, &first.b)).map(|q| q.pose).collect();
        let path = path(a, &poses, ticks);
        for kind in Kind::BOTH {
            let Some(metric) = metric(a, kind) else { continue };
            all.extend(Way::ALL.map(|way| follow(group, (a, b), kind, metric, way, &path)));
        }
    }
    all
}

/// Through the poses, so many ticks at most.
fn path(a: &Model, poses: &[Isometry3<f64>], ticks: usize) -> Vec<Isometry3<f64>> {
    let (low, high) = a.mesh().bounds();
    let (middle, diagonal) = (center(&low, &high), a.mesh().diagonal());
    let mut path: Vec<_> = poses.first().copied().into_iter().collect();
    for leg in poses.windows(2) {
        let [from, to] = [leg[0], leg[1]].map(|pose| pose * middle);
        let turn = leg[0].rotation.angle_to(&leg[1].rotation);
        let length = (to - from).norm() + turn * diagonal / 2.0;
        // The speed of 3 s^2 - 2 s^3 is 1.5 at its middle.
        let steps = (1.5 * length / (STEP * diagonal)).ceil().max(1.0) as usize;
        path.extend((1..=steps).map(|step| {
            let s = step as f64 / steps as f64;
            let s = s * s * (3.0 - 2.0 * s);
            let turn = leg[0].rotation.try_slerp(&leg[1].rotation, s, 1e-9).unwrap_or(leg[0].rotation);
            let at = from + (to - from) * s;
            Isometry3::from_parts(Translation3::from(at - turn * middle), turn)
        }));
    }
    path.truncate(ticks);
    path
}

fn follow(
    group: &str,
    (a, b): (&Model, &Model),
    kind: Kind,
    metric: &dyn Metric,
    way: Way,
    path: &[Isometry3<f64>],
) -> Warm {
    let mut tracker = DepthTracker::new(a, b);
    let mut warm =
        Warm { group: group.into(), kind, way, times: vec![], awake: vec![], inside: 0, ratios: vec![], wrong: 0 };
    let (mut samples, mut background, mut answer) = (Vec::new(), DepthSolver::new(a, b), None);
    for (tick, pose) in path.iter().enumerate() {
        let (slept, begin) = (waited(), Instant::now());
        if let Some(cold) = answer.take_if(|_| tick % BACKGROUND == 0) {
            tracker.merge(&cold);
        }
        let late = || begin.elapsed() > LATE;
        let clock: Option<&dyn Fn() -> bool> = if way == Way::Queries { None } else { Some(&late) };
        let depth = tracker.update(pose, metric, &Budget::default(), clock);
        let time = begin.elapsed().as_nanos() as f64;
        warm.times.push(time);
        warm.awake.extend(slept.zip(waited()).map(|(before, after)| time - (after - before)));
        if depth.outcome == Outcome::Separated {
            continue;
        }
        warm.inside += 1;
        if tick % SAMPLE == SAMPLE - 1 {
            samples.push((pose, depth));
        }
        if way == Way::Background && tick % BACKGROUND == 0 {
            answer = Some(background.depth(pose, metric, &DepthOptions::default(), None));
        }
    }
    // Afterwards, so that the ticks have their caches to themselves.
    let (mut solver, mut pair) = (DepthSolver::new(a, b), Pair::new(a.mesh(), b.mesh()));
    for (pose, depth) in samples {
        let cold = solver.depth(pose, metric, &DepthOptions::default(), None);
        let agrees = depth.lower <= cold.upper && cold.lower <= depth.upper;
        warm.wrong += usize::from(!agrees || depth.upper.is_infinite() || pair.collides(&depth.pose));
        warm.ratios.push(depth.upper / cold.upper);
    }
    warm
}

/// Nanoseconds that this thread was ready and waited for a processor.
fn waited() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().nth(1)?.parse().ok()
}

/// `warm.csv`: a line for every path, metric and budget.
pub fn csv(warm: &[Warm]) -> String {
    let mut text = "group,metric,way,ticks,inside,p50_ns,p90_ns,p99_ns,max_ns,missed,awake_p99_ns,awake_max_ns,\
                    compared,p50_ratio,p90_ratio,max_ratio,wrong\n"
        .to_string();
    for w in warm {
        let _ = write!(text, "{},{},{},{},{}", w.group, w.kind.name(), w.way.name(), w.times.len(), w.inside);
        [0.5, 0.9, 0.99, 1.0].iter().for_each(|share| _ = write!(text, ",{}", quantile(&w.times, *share)));
        let _ = write!(text, ",{}", w.times.iter().filter(|t| **t > TICK).count());
        for share in [0.99, 1.0] {
            let known = (!w.awake.is_empty()).then(|| quantile(&w.awake, share).to_string());
            let _ = write!(text, ",{}", known.unwrap_or_default());
        }
        let _ = write!(text, ",{}", w.ratios.len());
        [0.5, 0.9, 1.0].iter().for_each(|share| _ = write!(text, ",{}", quantile(&w.ratios, *share)));
        let _ = writeln!(text, ",{}", w.wrong);
    }
    text
}
