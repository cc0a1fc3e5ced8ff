//! The worst case of polytope expansion, a ball that is not given as one: how far the bracket closes, at which cost. And how little roundness that takes.
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

/// An ellipsoid as points, around a centre: semi axes from 1 to 2.
struct Moved(Vector<f64, 6>);

impl Support<f64, 6> for Moved {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        let reach = u.zip_map(&Vector::from([1.0, 1.2, 1.4, 1.6, 1.8, 2.0]), |u, a| (u * a, a));
        let length = reach.map(|(x, _)| x).norm();
        Ok(reach.map(|(x, a)| x * a / length) + self.0)
    }
    fn extent(&self) -> f64 {
        2.0 + self.0.norm()
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
    println!("| dimension | facets | plan | steps | upper - lower | ms |");
    println!("|---|---|---|---|---|---|");
    row::<2, 64, 128>();
    row::<3, 64, 128>();
    row::<3, 256, 512>();
    row::<3, 1024, 2048>();
    row::<4, 1024, 8192>();
    row::<6, 512, 16000>();
    let mut memory = Box::new(Workspace::<f64, 6, 80, 512>::new());
    println!("\nan ellipsoid with axes from 1 to 2 in six dimensions, to three digits in 64 KB:");
    for apart in [0.0, 0.1, 0.5] {
        let options = Options { relative: 1e-3, ..Options::default() };
        let shift = Vector::from([apart, 0.0, 0.0, 2.0 * apart, 0.0, 0.0]);
        let answer = memory.solver().solve(&Moved(shift), &Ball::unit(), &options);
        println!("origin {apart} and {} off its centre: {}, {} steps", 2.0 * apart, answer.outcome, answer.iterations);
    }
}
