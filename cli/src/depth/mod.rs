//! Runs case files: brackets against references, iterations and time:
//! `cargo run --release --features std --example cases -- [-v] [-f32] FILE...`
use qdist::support::{Hull, Support, graph_len};
use qdist::{Options, Outcome, Real, Workspace};
use std::collections::BTreeMap;
use std::time::Instant;

#[path = "../../../tests/common/mod.rs"]
mod common;

/// Large hulls with their graph, other shapes as they are.
fn prepared<'a, T: Real>(
    text: &common::ShapeText,
    points: &'a [[T; 3]],
    words: &'a mut [u16],
) -> Box<dyn Support<T, 3> + 'a> {
    if points.len() <= 32 || text.kind != "hull" {
        return common::shape(text, points);
    }
    let mut memory = Box::new(Workspace::<T, 3, 6000, 12100>::new());
    match memory.solver().prepare_hull(points, words) {
        Ok(graph) => Box::new(Hull::new(points, graph).unwrap()),
        Err(e) => {
            println!("{e:?}");
            common::shape(text, points)
        }
    }
}

fn run<T: Real>(file: &str, rel: f64, abs: f64, verbose: bool) {
    let cases = common::parse(&std::fs::read_to_string(file).unwrap());
    let mut memory = Box::new(Workspace::<T, 3, 256, 512>::new());
    let mut solver = memory.solver();
    let mut stats: BTreeMap<String, Vec<(f64, f64, u32, usize)>> = BTreeMap::new();
    let (mut bad, mut converged, mut normals, mut n) = (0, 0, 0, 0);
    for case in &cases {
        let points: Vec<_> = case.bodies.iter().map(|b| common::points::<T>(&b.shape)).collect();
        let mut words: Vec<Vec<u16>> = points.iter().map(|p| vec![0; graph_len(p.len())]).collect();
        let (left, right) = words.split_at_mut(1);
        let a = prepared(&case.bodies[0].shape, &points[0], &mut left[0]);
        let b = prepared(&case.bodies[1].shape, &points[1], &mut right[0]);
        let (a, b) = (common::body(&case.bodies[0], &*a), common::body(&case.bodies[1], &*b));
        let options = Options { relative: T::of(rel), absolute: T::of(abs * case.size), ..Options::default() };
        let r = solver.depth(&a, &b, &options);
        let reps = 20;
        let mut times: Vec<f64> = (0..5)
            .map(|_| {
                let start = Instant::now();
                for _ in 0..reps {
                    std::hint::black_box(solver.depth(&a, &b, &options));
                }
                start.elapsed().as_secs_f64() / reps as f64 * 1e6
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let (lo, up) = (r.lower.to_f64(), r.upper.to_f64());
        let input = if T::ROUNDOFF.to_f64() > 1e-10 {
            let t: f64 = case.bodies.iter().map(|b| b.translation.iter().map(|x| x.abs()).sum::<f64>()).sum();
            let s: f64 = case.bodies.iter().map(|b| b.shape.numbers.iter().fold(0.0f64, |m, x| m.max(x.abs()))).sum();
            8.0 * T::ROUNDOFF.to_f64() * (t + 3.0 * s)
        } else {
            0.0
        };
        let ok = lo - input <= case.upper && case.lower <= up + input;
        let width = up - lo;
        let conv = width <= (1e-6 * case.depth.abs()).max(1e-12 * case.size);
        let normal_ok = case.normal.is_none_or(|m| {
            let d: f64 = (0..3).map(|i| m[i] * r.normal[i].to_f64()).sum();
            d > 1.0 - 0.5e-6
        });
        n += 1;
        bad += !ok as usize;
        converged += conv as usize;
        normals += normal_ok as usize;
        if verbose && (!ok || !conv || !normal_ok || r.outcome == Outcome::Precision) {
            println!(
                "  {} {:?} ref {:e} lo-ref {:e} up-ref {:e} size {:.3e} it {} v {} f {} ok {} conv {} normal {} us {:.2}",
                case.id,
                r.outcome,
                case.depth,
                lo - case.depth,
                up - case.depth,
                case.size,
                r.iterations,
                r.vertices,
                r.facets,
                ok,
                conv,
                normal_ok,
                times[2]
            );
        }
        stats.entry(case.family()).or_default().push((times[2], width / case.size, r.iterations, r.facets));
    }
    println!("{file}: {n} cases, bad brackets {bad}, converged {converged}, normals {normals}");
    for (family, mut v) in stats {
        v.sort_by(|a, b| a.0.total_cmp(&b.0));
        let m = v[v.len() / 2];
        println!(
            "   {family:22} n {:3} us {:.2} [{:.2} {:.2}] it {} facets {}",
            v.len(),
            m.0,
            v[0].0,
            v[v.len() - 1].0,
            m.2,
            m.3
        );
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let verbose = args.iter().any(|a| a == "-v");
    let single = args.iter().any(|a| a == "-f32");
    for file in args.iter().filter(|a| !a.starts_with('-')) {
        if single {
            run::<f32>(file, 1e-4, 1e-5, verbose)
        } else {
            run::<f64>(file, std::env::var("REL").map_or(1e-6, |x| x.parse().unwrap()), 1e-12, verbose)
        }
    }
}
