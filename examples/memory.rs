//! Prints the table of workspace sizes in README.md: `cargo run --example memory`.

use qdist::Layout;

fn row<const N: usize>(vertices: usize, facets: usize) {
    let f32_bytes = Layout::new::<f32, N>(vertices, facets).map(|l| l.bytes());
    let f64_bytes = Layout::new::<f64, N>(vertices, facets).map(|l| l.bytes());
    let text = |bytes: Result<usize, _>| bytes.map_or("-".into(), |b| format!("{b}"));
    println!("| {N} | {vertices} | {facets} | {} | {} |", text(f32_bytes), text(f64_bytes));
}

fn main() {
    println!("| dimension | vertices | facets | f32 bytes | f64 bytes |");
    println!("|---|---|---|---|---|");
    row::<2>(32, 64);
    row::<3>(32, 64);
    row::<3>(64, 128);
    row::<3>(256, 512);
    row::<4>(64, 512);
    row::<5>(64, 1024);
    row::<6>(64, 2048);
    row::<6>(512, 8192);
}
