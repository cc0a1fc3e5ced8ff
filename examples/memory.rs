//! Prints the tables of memory in README.md: `cargo run --release --example memory --features std`.

use qdist::nalgebra::SMatrix;
use qdist::support::Ellipsoid;
use qdist::{Body, Layout, Options, Outcome, Real, Vector, Workspace};
use std::f64::consts::TAU;

fn row<const N: usize>(vertices: usize, facets: usize) {
    let f32_bytes = Layout::new::<f32, N>(vertices, facets).map(|l| l.bytes());
    let f64_bytes = Layout::new::<f64, N>(vertices, facets).map(|l| l.bytes());
    let text = |bytes: Result<usize, _>| bytes.map_or("-".into(), |b| format!("{b}"));
    println!("| {N} | {vertices} | {facets} | {} | {} |", text(f32_bytes), text(f64_bytes));
}

/// Numbers from 0 to 1, the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.roll()
    }
}

/// How two ellipses lie.
#[derive(Clone, Copy)]
enum Pair {
    Anywhere,
    OneCentre,
    /// Equal and unturned, too: both ends of the axes are minimisers.
    Equal,
}

/// Semi axes of any aspect up to 100, and an angle.
fn ellipse(dice: &mut Dice) -> ([f64; 2], f64) {
    let size = 10f64.powf(dice.range(-0.5, 0.5));
    ([size, size * 10f64.powf(dice.range(-2.0, 0.0))], dice.range(0.0, TAU))
}

fn body<T: Real>(shape: &Ellipsoid<T, 2>, angle: f64, at: [f64; 2]) -> Body<'_, T, 2> {
    let (s, c) = angle.sin_cos();
    let rotation = SMatrix::from_row_slice(&[c, -s, s, c].map(T::of));
    Body::new(shape, rotation, Vector::from(at.map(T::of))).expect("a rotation")
}

/// What the depth of two ellipses that overlap needs, to the default tolerance: of 10,000 pairs the median, the most, and how many need no
/// more than 32, 64 or 128 vertices, and as many facets.
fn ellipses<T: Real>(name: &str, pair: Pair) {
    let mut dice = Dice(1);
    let mut memory = Box::new(Workspace::<T, 2, 2048, 2048>::new());
    let mut used = Vec::new();
    while used.len() < 10_000 {
        let (axes, angle) = ellipse(&mut dice);
        let (other, turned) = if matches!(pair, Pair::Equal) { (axes, angle) } else { ellipse(&mut dice) };
        let far = if matches!(pair, Pair::Anywhere) { (axes[0] + other[0]) * dice.roll() } else { 0.0 };
        let (s, c) = dice.range(0.0, TAU).sin_cos();
        let [a, b] = [axes, other].map(|axes| Ellipsoid::new(Vector::from(axes.map(T::of))).expect("semi axes"));
        let (a, b) = (body(&a, angle, [0.0, 0.0]), body(&b, turned, [c * far, s * far]));
        let depth = memory.solver().depth(&a, &b, &Options::default());
        assert!(depth.outcome != Outcome::Capacity);
        if depth.lower > T::of(0.0) {
            used.push(depth.vertices.max(depth.facets));
        }
    }
    used.sort_unstable();
    let within = |count: usize| 100.0 * used.iter().filter(|&&u| u <= count).count() as f64 / used.len() as f64;
    let (median, most) = (used[used.len() / 2], used[used.len() - 1]);
    println!("| {name} | {median} | {most} | {:.2} % | {:.2} % | {:.2} % |", within(32), within(64), within(128));
}

fn main() {
    println!("| dimension | vertices | facets | f32 bytes | f64 bytes |");
    println!("|---|---|---|---|---|");
    row::<2>(32, 64);
    row::<2>(128, 128);
    row::<3>(32, 64);
    row::<3>(64, 128);
    row::<3>(256, 512);
    row::<4>(64, 512);
    row::<5>(64, 1024);
    row::<6>(64, 2048);
    row::<6>(512, 8192);
    println!("\n| two ellipses in the plane | vertices, or facets, median | most | within 32 | 64 | 128 |");
    println!("|---|---|---|---|---|---|");
    ellipses::<f64>("f64, anywhere", Pair::Anywhere);
    ellipses::<f64>("f64, of one centre", Pair::OneCentre);
    ellipses::<f64>("f64, equal, of one centre and axes", Pair::Equal);
    ellipses::<f32>("f32, anywhere", Pair::Anywhere);
    ellipses::<f32>("f32, of one centre", Pair::OneCentre);
    ellipses::<f32>("f32, equal, of one centre and axes", Pair::Equal);
}
