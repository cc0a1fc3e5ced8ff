use qdist::{Options, Workspace};
#[path = "../tests/common/mod.rs"]
mod common;
fn main() {
    let f = std::env::args().nth(1).unwrap();
    let reps: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let cases = common::parse(&std::fs::read_to_string(f).unwrap());
    let mut memory = Box::new(Workspace::<f64, 3, 256, 512>::new());
    let mut solver = memory.solver();
    let mut times = vec![];
    let mut total = 0.0;
    let (mut it, mut calls) = (0, 0);
    for case in &cases {
        let points: Vec<_> = case.bodies.iter().map(|b| common::points::<f64>(&b.shape)).collect();
        let a = common::shape(&case.bodies[0].shape, &points[0]);
        let b = common::shape(&case.bodies[1].shape, &points[1]);
        let (a, b) = (common::body(&case.bodies[0], &*a), common::body(&case.bodies[1], &*b));
        let options = Options { relative: 1e-6, absolute: 1e-12 * case.size, ..Options::default() };
        let mut best = f64::MAX;
        for _ in 0..8 {
            let start = std::time::Instant::now();
            for _ in 0..reps {
                let r = std::hint::black_box(solver.depth(&a, &b, &options));
                total += r.upper;
                it += r.iterations;
                calls += r.support_calls;
            }
            best = best.min(start.elapsed().as_nanos() as f64 / reps as f64);
        }
        times.push(best);
    }
    let n = 8 * reps * cases.len();
    println!(
        "{} ns/query  it {:.2} calls {:.2} {}",
        {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        },
        it as f64 / n as f64,
        calls as f64 / n as f64,
        total
    );
}
