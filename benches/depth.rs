//! Time of depth queries, per family of shapes: `cargo bench -p qdist-benches --bench depth [-- FILE...]`, by default on tests/data.
//!
//! For every case the best of 8 batches (what the machine's other work adds is not ours); for every family the
//! median over its cases, with quartiles, and the median iterations and support calls.

use qdist::{Options, Workspace};
use qdist_benches::common;
use std::collections::BTreeMap;
use std::time::Instant;

const BATCHES: usize = 8;
const QUERIES: u32 = 500;

fn main() {
    let mut files: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    if files.is_empty() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data");
        let entries = std::fs::read_dir(folder).expect("tests/data").flatten();
        files = entries.map(|e| e.path().display().to_string()).filter(|p| p.ends_with(".txt")).collect();
    }
    let mut memory = Box::new(Workspace::<f64, 3, 256, 512>::new());
    let mut solver = memory.solver();
    let mut families: BTreeMap<String, Vec<(f64, u32, u32)>> = BTreeMap::new();
    for file in files {
        for case in common::cases::parse(&std::fs::read_to_string(&file).expect(&file)).unwrap() {
            let points: Vec<_> = case.bodies.iter().map(|b| b.shape.points::<f64>()).collect();
            let a = case.bodies[0].shape.build(&points[0]).unwrap();
            let b = case.bodies[1].shape.build(&points[1]).unwrap();
            let (a, b) = (case.bodies[0].body(&*a).unwrap(), case.bodies[1].body(&*b).unwrap());
            let options = Options { relative: 1e-6, absolute: 1e-12 * case.size, ..Options::default() };
            let depth = solver.depth(&a, &b, &options);
            let batch = || {
                let start = Instant::now();
                for _ in 0..QUERIES {
                    std::hint::black_box(solver.depth(&a, &b, &options));
                }
                start.elapsed().as_secs_f64() * 1e9 / f64::from(QUERIES)
            };
            let best = std::iter::repeat_with(batch).take(BATCHES).fold(f64::MAX, f64::min);
            families.entry(case.family()).or_default().push((best, depth.iterations, depth.support_calls));
        }
    }
    println!(
        "{:28} {:>5} {:>8} {:>8} {:>8} {:>11} {:>6}",
        "family", "cases", "ns 25%", "median", "75%", "iterations", "calls"
    );
    for (family, mut rows) in families {
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let at = |share: f64| rows[((rows.len() - 1) as f64 * share) as usize];
        let (low, middle, high) = (at(0.25), at(0.5), at(0.75));
        let (count, iterations, calls) = (rows.len(), middle.1, middle.2);
        println!("{family:28} {count:5} {:8.0} {:8.0} {:8.0} {iterations:11} {calls:6}", low.0, middle.0, high.0);
    }
}
