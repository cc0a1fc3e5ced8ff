//! Cold queries, timed: every run begins with nothing but the bodies.

use std::time::{Duration, Instant};

use qdist::mesh::{DepthOptions, DepthSolver, Effort, Pair, Walk};

use crate::answer::{self, Row};
use crate::input::Kind;
use crate::scenes::Scenes;

/// A way to ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    pub name: &'static str,
    effort: Effort,
    walk: Walk,
    /// On all queries, not only the benchmark pairs'.
    everywhere: bool,
}

pub const DEFAULT: &str = "default";

pub const VARIANTS: [Variant; 4] = [
    Variant { name: "fast", effort: Effort::Fast, walk: Walk::Linearised, everywhere: false },
    Variant { name: DEFAULT, effort: Effort::Default, walk: Walk::Linearised, everywhere: true },
    Variant { name: "heavy", effort: Effort::Heavy, walk: Walk::Linearised, everywhere: false },
    // Section IV-B.1 of the paper.
    Variant { name: "sampling", effort: Effort::Default, walk: Walk::Sampling, everywhere: false },
];

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
    for query in &scenes.queries {
        let (a, b) = (scenes.bodies.get(&query.a), scenes.bodies.get(&query.b));
        let mut solver = DepthSolver::new(a, b);
        for kind in Kind::BOTH {
            for variant in VARIANTS {
                if !(variant.everywhere || scenes.is_benchmark(query)) {
                    continue;
                }
                let options = DepthOptions { effort: variant.effort, walk: variant.walk, ..DepthOptions::default() };
                let begin = Instant::now();
                let row = answer::ask(&mut solver, query, kind, &options, None);
                let mut times = Vec::new();
                // The first run also fills caches, so it counts only where it is the only one.
                while times.len() < repetitions
                    && (times.len() < 3 || begin.elapsed() < enough)
                    && begin.elapsed() < 8 * enough
                {
                    times.push(answer::ask(&mut solver, query, kind, &options, None).ns as f64);
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
