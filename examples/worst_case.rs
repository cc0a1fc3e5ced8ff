//! The worst case of polytope expansion, a ball that is not given as one: how far the bracket closes, at which cost.
//! `cargo run --release --features std --example worst_case`

use qdist::support::{Failure, Support};
use qdist::{Options, Vector, Workspace, qset::Ball};
use std::time::Instant;

/// The unit ball as points, in N dimensions.
struct Points;

impl<const N: usize> Support<f64, N> for Points {
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        Ok(u / u.norm())
    }
    fn extent(&self) -> f64 {
        1.0
    }
}

fn row<const N: usize, const V: usize, const F: usize>() {
    let mut memory = Box::new(Workspace::<f64, N, V, F>::new());
    let mut solver = memory.solver();
    let start = Instant::now();
    let answer = solver.solve(&Points, &Ball::unit(), &Options::default());
    let time = start.elapsed().as_secs_f64() * 1e6;
    let gap = answer.upper - answer.lower;
    let plan = format!("{:?}", answer.plan).to_lowercase();
    println!("| {N} | {F} | {plan} | {} | {gap:.1e} | {:.1} |", answer.iterations, time / 1e3);
}

fn main() {
    println!("| dimension | facets | plan | points | upper - lower | ms |");
    println!("|---|---|---|---|---|---|");
    row::<2, 64, 128>();
    row::<3, 64, 128>();
    row::<3, 256, 512>();
    row::<3, 1024, 2048>();
    row::<4, 1024, 8192>();
    row::<6, 512, 16000>();
}
