//! Cold queries, timed: every run begins with nothing but the bodies.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use qdist::mesh::certificate::Effort;
use qdist::mesh::{ContactSamples, DepthOptions, DepthSolver, Pair, Walk};

use crate::scenes::Scenes;
use qdist_cli::mesh::answer::{self, Row};
use qdist_cli::mesh::input::{Kind, Query};
use qdist_cli::mesh::seeds;

/// Where walks begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seeds {
    /// Rays and push-out.
    Own,
    /// The nearest contact samples, and nothing else.
    Samples,
    /// Both.
    Both,
}

/// A way to ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    pub name: &'static str,
    effort: Effort,
    walk: Walk,
    seeds: Seeds,
    /// On all queries, not only the benchmark pairs'.
    everywhere: bool,
    /// Whether it belongs to the curve of error against time.
    pub is_effort: bool,
}

pub const DEFAULT: &str = "default";

const fn effort(name: &'static str, effort: Effort) -> Variant {
    Variant { name, effort, walk: Walk::Linearised, seeds: Seeds::Own, everywhere: false, is_effort: true }
}

const fn beside(name: &'static str, walk: Walk, seeds: Seeds) -> Variant {
    Variant { name, effort: Effort::Default, walk, seeds, everywhere: false, is_effort: false }
}

pub const VARIANTS: [Variant; 7] = [
    effort("fast", Effort::Fast),
    Variant { everywhere: true, ..effort(DEFAULT, Effort::Default) },
    effort("heavy", Effort::Heavy),
    // Sections IV-A and IV-B.2 of the paper.
    beside("branching", Walk::Branching, Seeds::Own),
    // Section IV-B.1.
    beside("sampling", Walk::Sampling, Seeds::Own),
    // Section IV-D.
    beside("nearest", Walk::Linearised, Seeds::Samples),
    beside("nearest+", Walk::Linearised, Seeds::Both),
];

/// Contact samples of a pair.
const SAMPLES: usize = 500;

impl Variant {
    /// Asks. Looking for the nearest samples counts; making them does not.
    fn ask(self, solver: &mut DepthSolver, query: &Query, kind: Kind, samples: &ContactSamples) -> Row {
        let begin = Instant::now();
        let near = match self.seeds {
            Seeds::Own => Vec::new(),
            Seeds::Samples | Seeds::Both => seeds::nearest(samples, solver.a(), kind, &query.pose),
        };
        let search = begin.elapsed().as_nanos() as u64;
        let own = self.seeds != Seeds::Samples;
        let options = DepthOptions {
            effort: self.effort,
            walk: self.walk,
            poses: &near,
            rays: own,
            push_out: own,
            ..DepthOptions::default()
        };
        let row = answer::ask(solver, query, kind, &options, None);
        Row { ns: row.ns + search, ..row }
    }
}

/// A query's answer, and all times.
pub struct Cold {
    pub variant: &'static str,
    pub row: Row,
    /// Nanoseconds.
    pub times: Vec<f64>,
    /// Whether a pair that knows nothing of the search finds the pose free.
    pub free: bool,
}

/// Everything, with so many repetitions, and no more of them when a query took that long in total.
pub fn cold(scenes: &Scenes, repetitions: usize, enough: Duration) -> Vec<Cold> {
    let mut all = Vec::new();
    let mut samples = HashMap::new();
    for query in &scenes.queries {
        let (a, b) = (scenes.bodies.get(&query.a), scenes.bodies.get(&query.b));
        let mut solver = DepthSolver::new(a, b);
        let count = if scenes.is_benchmark(query) { SAMPLES } else { 0 };
        let samples = samples.entry((&query.a, &query.b)).or_insert_with(|| ContactSamples::new(a, b, count, 0, None));
        for kind in Kind::BOTH {
            for variant in VARIANTS {
                if !(variant.everywhere || scenes.is_benchmark(query)) {
                    continue;
                }
                let begin = Instant::now();
                let row = variant.ask(&mut solver, query, kind, samples);
                let mut times = Vec::new();
                // The first run also fills caches, so it counts only where it is the only one.
                while times.len() < repetitions
                    && (times.len() < 3 || begin.elapsed() < enough)
                    && begin.elapsed() < 8 * enough
                {
                    times.push(variant.ask(&mut solver, query, kind, samples).ns as f64);
                }
                if times.is_empty() {
                    times.push(row.ns as f64);
                }
                let free = row.upper.is_finite() && !Pair::new(a.mesh(), b.mesh()).collides(&row.pose);
                all.push(Cold { variant: variant.name, row, times, free });
            }
        }
    }
    if !scenes.shared {
        know_the_best(&mut all);
    }
    all
}

/// Where nothing is known, the best of all variants is the reference.
fn know_the_best(all: &mut [Cold]) {
    let key = |c: &Cold| (c.row.query.clone(), c.row.kind);
    let mut best = std::collections::HashMap::new();
    for c in all.iter() {
        let value = best.entry(key(c)).or_insert(f64::INFINITY);
        *value = c.row.upper.min(*value);
    }
    for c in all.iter_mut() {
        c.row.known.best = best.get(&key(c)).copied().filter(|b| b.is_finite());
    }
}
