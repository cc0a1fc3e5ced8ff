//! Random problems of every kind, checked against what must hold whatever the problem is.
//!
//!     cargo run --release -p qdist-fuzz --bin fuzz -- --seconds 60 [--seed 1] [--case 17]
//!
//! Pairs of bodies, bodies and half spaces, hulls of two bodies against a third, sets and unit sets.
//! Shapes from 1e-6 to 1e6 with aspect ratios up to 1e9 and zero sizes; poses that are generic, aligned,
//! identical, touching or far away; all unit sets in 2 to 6 dimensions; any capacity, tolerance, threshold and
//! limit; callbacks that fail or return nonsense; both scalar types. For every answer:
//!
//! * it keeps the promises of `common::memory::broken_promise` (no NaN, lower <= upper, outcome and numbers
//!   agree, ...);
//! * its direction proves its upper bound, by textbook support functions in double-double;
//! * no direction of a search, and no other answer (another capacity, tolerance, guess, scalar type), contradicts
//!   its bracket;
//! * pairs of small polytopes have the exact depth in their bracket;
//! * it comes in time.
//!
//! The first find is printed with its seed, case and numbers, and the exit code is 1.

use nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, UnitSetFn, Vertices};
use qdist::support::{
    BoxShape, Ellipsoid, Failure, HalfSpace, Join, Linear, Margin, Points, Rigid, Sphere, Sum, Support,
};
use qdist::{Body, Options, Outcome, Plan, Real, Vector};
use qdist_fuzz::common::cases::{Placed, Shape};
use qdist_fuzz::common::dd::{BLUR, Dd, V3, dot, norm, v3};
use qdist_fuzz::common::dice::Dice;
use qdist_fuzz::common::exact::{body_value, pair_value, searched_upper};
use qdist_fuzz::common::hull::{ExactHull, signed_depth};
use qdist_fuzz::common::memory::{Memory, Seen, broken_promise};
use std::cell::Cell;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The problem in work, for the panic hook and the watchdog.
static CURRENT: Mutex<(String, Option<Instant>)> = Mutex::new((String::new(), None));

fn now_at(text: String) {
    *CURRENT.lock().unwrap() = (text, Some(Instant::now()));
}

/// A find ends the program.
fn find(what: &str, detail: &str) -> ! {
    let place = CURRENT.lock().map_or_else(|_| "?".to_string(), |c| c.0.clone());
    println!("FIND: {what}\n{place}\n{detail}");
    std::process::exit(1);
}

fn main() {
    let mut seconds = 10.0;
    let mut seed = 1u64;
    let mut only = None;
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let value = args.next().unwrap_or_else(|| panic!("{arg} needs a value"));
        match arg.as_str() {
            "--seconds" => seconds = value.parse().expect("seconds"),
            "--seed" => seed = value.parse().expect("seed"),
            "--case" => only = Some(value.parse::<u64>().expect("case")),
            _ => panic!("unknown argument {arg}"),
        }
    }
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        default(info);
        let place = CURRENT.lock().map_or_else(|_| "?".to_string(), |c| c.0.clone());
        println!("FIND: panic\n{place}");
        std::process::exit(1);
    }));
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let (place, since) = CURRENT.lock().unwrap().clone();
            if since.is_some_and(|t| t.elapsed() > Duration::from_secs(30)) {
                println!("FIND: no answer in 30 s\n{place}");
                std::process::exit(1);
            }
        }
    });
    let start = Instant::now();
    let mut case = only.unwrap_or(0);
    let mut counts = [0u64; 4];
    while start.elapsed().as_secs_f64() < seconds {
        now_at(format!("--seed {seed} --case {case}"));
        let mut dice = Dice::new(seed.wrapping_mul(0x9e37_79b9) ^ (case << 20));
        let kind = dice.below(8);
        match kind {
            0..=3 => {
                counts[0] += 1;
                match dice.below(8) {
                    0 => fuzz_half_space(&mut dice),
                    1 => fuzz_join(&mut dice),
                    _ => fuzz_pair(&mut dice),
                }
            }
            4..=6 => {
                counts[1] += 1;
                match dice.below(5) {
                    0 => fuzz_general::<2>(&mut dice),
                    1 => fuzz_general::<3>(&mut dice),
                    2 => fuzz_general::<4>(&mut dice),
                    3 => fuzz_general::<5>(&mut dice),
                    _ => fuzz_general::<6>(&mut dice),
                }
            }
            _ => {
                counts[2] += 1;
                match dice.below(4) {
                    0 => fuzz_bad::<f32, 2>(&mut dice),
                    1 => fuzz_bad::<f32, 3>(&mut dice),
                    2 => fuzz_bad::<f64, 3>(&mut dice),
                    _ => fuzz_bad::<f64, 5>(&mut dice),
                }
            }
        }
        if only.is_some() {
            println!("case {case} of seed {seed}: nothing found");
            return;
        }
        case += 1;
    }
    println!(
        "{case} problems: {} pairs, {} general, {} with bad callbacks; nothing found",
        counts[0], counts[1], counts[2]
    );
}

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

/// Options of any kind, `size` being the length that tolerances and thresholds are near to.
fn random_options<T: Real, const N: usize>(dice: &mut Dice, size: f64, around: Option<f64>) -> Options<T, N> {
    let mut o = Options::<T, N>::default();
    if dice.chance(0.5) {
        o.relative = T::of(dice.pick(&[0.0, 1e-15, 1e-9, 1e-3, 0.1, 1.0, 100.0, -1.0]));
    }
    if dice.chance(0.3) {
        o.absolute = T::of(size * dice.pick(&[0.0, 1e-15, 1e-9, 1e-3, 1.0, 100.0, -1.0]));
    }
    if dice.chance(0.3) {
        let near = around.unwrap_or(size * dice.signed());
        o.threshold = Some(T::of(near + size * dice.pick(&[0.0, 1e-12, -1e-12, 1e-6, -1e-6, 0.1, -0.1, 3.0, -3.0])));
    }
    if dice.chance(0.3) {
        o.max_iterations = 1 + dice.below(40) as u32;
    }
    if dice.chance(0.4) {
        let length = dice.pick(&[0.0, 1e-30, 1e-6, 1.0, 1e6, 1e30]);
        o.guess = Some(Vector::from(dice.direction::<N>().map(|x| T::of(x * length))));
        if dice.chance(0.2) {
            o.guess = Some(Vector::from(std::array::from_fn(|i| T::of(if i == 0 { f64::NAN } else { f64::INFINITY }))));
        }
    }
    o
}

fn random_capacity<const N: usize>(dice: &mut Dice) -> (usize, usize) {
    match dice.below(5) {
        0 => (N + 1 + dice.below(4), 2 * N + dice.below(10)),
        1 => (N + 1 + dice.below(60), 2 * N + dice.below(600)),
        2 => (N + 1 + dice.below(1000), 2 * N + dice.below(30)),
        3 => (3 * N + dice.below(40), 4 * N + dice.below(100)), // cones
        _ => (256, if N <= 3 { 512 } else { 4096 }),
    }
}

/// A size: mostly of order one, sometimes extreme, sometimes zero.
fn random_size(dice: &mut Dice) -> f64 {
    match dice.below(10) {
        0 => 0.0,
        1 => dice.decade(-9.0, 0.0),
        2 => 1.0,
        3 => (1 + dice.below(8)) as f64 / 4.0,
        _ => dice.range(0.1, 2.0),
    }
}

// Pairs of bodies.

const KINDS: [&str; 7] = ["sphere", "box", "ellipsoid", "cylinder", "capsule", "cone", "hull"];

fn random_points(dice: &mut Dice) -> Vec<f64> {
    let n = match dice.below(6) {
        0 => 1 + dice.below(3),
        1 => 40,
        _ => 4 + dice.below(12),
    };
    let squash: [f64; 3] = std::array::from_fn(|_| if dice.chance(0.2) { random_size(dice) } else { 1.0 });
    let style = dice.below(4);
    let mut points: Vec<[f64; 3]> = Vec::new();
    for _ in 0..n {
        let p = match style {
            0 => std::array::from_fn(|_| dice.below(3) as f64 - 1.0),
            1 if !points.is_empty() && dice.chance(0.4) => {
                let (p, q) = (dice.pick(&points), dice.pick(&points));
                let blur = dice.pick(&[0.0, 1e-16, 1e-12, 1e-7]);
                std::array::from_fn(|i| (p[i] + q[i]) / 2.0 + blur * dice.signed())
            }
            _ => dice.direction::<3>(),
        };
        points.push(p);
    }
    points.iter().flat_map(|p| [p[0] * squash[0], p[1] * squash[1], p[2] * squash[2]]).collect()
}

fn random_shape(dice: &mut Dice, scale: f64) -> Shape {
    let kind = dice.pick(&KINDS);
    let numbers: Vec<f64> = match kind {
        "sphere" => vec![random_size(dice)],
        "box" | "ellipsoid" => {
            let mut n: Vec<f64> = (0..3).map(|_| random_size(dice)).collect();
            if dice.chance(0.2) {
                n[1] = n[0];
            }
            n
        }
        "hull" => random_points(dice),
        _ => (0..2).map(|_| random_size(dice)).collect(),
    };
    Shape { kind: kind.to_string(), numbers: numbers.into_iter().map(|x| x * scale).collect() }
}

/// Row by row.
fn random_rotation(dice: &mut Dice) -> [f64; 9] {
    let m = match dice.below(5) {
        0 | 1 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        2 => [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]],
        3 => {
            let angle = dice.decade(-17.0, -1.0);
            dice.tilt(angle)
        }
        _ => dice.rotation::<3>(),
    };
    std::array::from_fn(|k| m[k / 3][k % 3])
}

fn rounded<T: Real>(body: &Placed) -> Placed {
    let mut body = body.clone();
    body.shape.numbers.iter_mut().for_each(|x| *x = exact::<T>(*x));
    body.rotation = body.rotation.map(exact::<T>);
    body.translation = body.translation.map(exact::<T>);
    body
}

fn reach(body: &Placed) -> f64 {
    let size = body.shape.numbers.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    2.0 * size + body.translation.iter().map(|x| x.abs()).sum::<f64>()
}

fn hull_of(body: &Placed) -> Option<ExactHull> {
    let n = &body.shape.numbers;
    let points: Vec<[f64; 3]> = match body.shape.kind.as_str() {
        "hull" if n.len() <= 48 => n.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
        "box" => {
            let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
            (0..8).map(|i| [sign(i & 1) * n[0], sign(i & 2) * n[1], sign(i & 4) * n[2]]).collect()
        }
        _ => return None,
    };
    let r = &body.rotation;
    let place = |p: &[f64; 3]| -> V3 {
        std::array::from_fn(|i| {
            dot(&v3([r[3 * i], r[3 * i + 1], r[3 * i + 2]]), &v3(*p)) + Dd::new(body.translation[i])
        })
    };
    Some(ExactHull::new(&points.iter().map(place).collect::<Vec<_>>()))
}

/// What the runs on one pair have found so far: all of it must be consistent.
struct Ledger {
    lower: f64,
    upper: f64,
    by: [String; 2],
}

impl Ledger {
    fn new() -> Self {
        Ledger { lower: f64::NEG_INFINITY, upper: f64::INFINITY, by: [String::new(), String::new()] }
    }

    fn add(&mut self, lower: f64, upper: f64, who: &str) {
        if lower > self.lower {
            (self.lower, self.by[0]) = (lower, who.to_string());
        }
        if upper < self.upper {
            (self.upper, self.by[1]) = (upper, who.to_string());
        }
        if self.lower > self.upper {
            let detail = format!("{:e} from {}\n{:e} from {}", self.lower, self.by[0], self.upper, self.by[1]);
            find("two brackets contradict each other", &detail);
        }
    }
}

fn run_pair<T: Real>(
    a: &Placed,
    b: &Placed,
    dice: &mut Dice,
    runs: usize,
    ledger: &mut Ledger,
    known: &mut Option<f64>,
) -> Option<(f64, [f64; 3])> {
    let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
    let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
    let (ba, bb) = (a.body(&*sa).unwrap(), b.body(&*sb).unwrap());
    let size = reach(a) + reach(b);
    let blur = Dd::new(BLUR * size);
    let mut last = None;
    for run in 0..runs {
        let (options, (vertices, facets)) = if run == 0 {
            (Options::default(), (256, 512))
        } else {
            (random_options::<T, 3>(dice, size, *known), random_capacity::<3>(dice))
        };
        let mut memory = Memory::new::<T, 3>(vertices, facets);
        let who =
            format!("run {run}, u = {:.0e}, {vertices} vertices, {facets} facets, {options:?}", T::ROUNDOFF.to_f64());
        let r = memory.solver::<T, 3>().depth(&ba, &bb, &options);
        let seen = Seen::from(&r);
        let tell = format!("{who}\n{r:?}");
        if let Some(text) = broken_promise(&seen, &options, vertices, facets) {
            find(&text, &tell);
        }
        if seen.outcome == Outcome::SupportFailed {
            find("built-in shapes failed", &tell);
        }
        if r.iterations as usize > vertices + 300 {
            find("more iterations than vertices and steps", &tell);
        }
        if r.point_a.iter().chain(r.point_b.iter()).any(|x| !x.finite()) {
            find("a witness is not finite", &tell);
        }
        if run == 0 && seen.upper - seen.lower > 0.5 * size + seen.upper.abs().min(seen.lower.abs()) {
            find("a useless bracket", &tell);
        }
        let n = [r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64);
        if seen.upper < T::HUGE.to_f64() {
            let proved = pair_value(a, b, &v3(n));
            if !(proved <= Dd::new(seen.upper) + blur) {
                find("the normal does not prove the upper bound", &format!("{tell}\nproved {:e}", proved.hi));
            }
            // What the direction proves is sharper than the bracket's end.
            ledger.add(seen.lower, (proved + blur).hi, &tell);
            *known = Some(proved.hi);
            last = Some((proved.hi, n));
        }
        ledger.add(seen.lower, seen.upper, &tell);
    }
    last
}

fn fuzz_pair(dice: &mut Dice) {
    let scale = if dice.chance(0.5) { 1.0 } else { dice.decade(-6.0, 6.0) };
    let other_scale = if dice.chance(0.8) { scale } else { scale * dice.decade(-4.0, 4.0) };
    let (rotation_a, rotation_b) = (random_rotation(dice), random_rotation(dice));
    let mut a = Placed { shape: random_shape(dice, scale), rotation: rotation_a, translation: [0.0; 3] };
    let mut b = Placed { shape: random_shape(dice, other_scale), rotation: rotation_b, translation: [0.0; 3] };
    if dice.chance(0.15) {
        b.shape = a.shape.clone();
    }
    if dice.chance(0.3) {
        b.rotation = a.rotation;
    }
    let by = match dice.below(7) {
        0 => 0.0,
        1 => dice.decade(-16.0, 0.0),
        2 => dice.decade(0.0, 6.0),
        _ => dice.range(0.0, 3.0),
    };
    let along = match dice.below(3) {
        0 => [0.0, 0.0, 1.0],
        // The axis of the turned body.
        1 => [a.rotation[2], a.rotation[5], a.rotation[8]],
        _ => dice.direction::<3>(),
    };
    b.translation = along.map(|x| x * by * scale);
    if dice.chance(0.2) {
        let far = dice.direction::<3>();
        let distance = scale * dice.decade(0.0, 6.0);
        for i in 0..3 {
            a.translation[i] += far[i] * distance;
            b.translation[i] += far[i] * distance;
        }
    }
    let single = dice.chance(0.5);
    if single {
        (a, b) = (rounded::<f32>(&a), rounded::<f32>(&b));
    }
    // Once as it is, once moved to where it barely touches.
    for pass in 0..2 {
        let place = CURRENT.lock().unwrap().0.clone();
        let place = place.lines().next().unwrap_or("").to_string();
        now_at(format!("{place}\npass {pass}\nA = {a:?}\nB = {b:?}"));
        let mut ledger = Ledger::new();
        let mut known = None;
        let found = run_pair::<f64>(&a, &b, dice, 4, &mut ledger, &mut known);
        if single {
            run_pair::<f32>(&a, &b, dice, 3, &mut ledger, &mut known);
        }
        let size = reach(&a) + reach(&b);
        let upper = searched_upper(&a, &b, found.map(|(_, n)| n), 30, dice);
        ledger.add(f64::NEG_INFINITY, upper.hi + BLUR * size, "search");
        if let (Some(ha), Some(hb)) = (hull_of(&a), hull_of(&b)) {
            let exact = signed_depth(&ha, &hb).depth.hi;
            let blur = BLUR * size + 1e-13 * exact.abs();
            ledger.add(exact - blur, exact + blur, "exact");
        }
        let Some((depth, n)) = found else { return };
        let target = size * dice.pick(&[0.0, 1e-15, -1e-15, 1e-9, -1e-9]);
        for i in 0..3 {
            b.translation[i] += (depth - target) * n[i];
        }
        if single {
            b = rounded::<f32>(&b);
        }
    }
}

/// A body with a random shape, at most so far from the origin.
fn random_body(dice: &mut Dice, scale: f64, far: f64) -> Placed {
    let rotation = random_rotation(dice);
    let translation = std::array::from_fn(|_| far * dice.signed());
    Placed { shape: random_shape(dice, scale), rotation, translation }
}

fn fuzz_half_space(dice: &mut Dice) {
    let scale = dice.decade(-6.0, 6.0);
    let far = scale * dice.pick(&[0.0, 1.0, 1e3, 1e6]);
    let (mut a, mut frame) = (random_body(dice, scale, far), random_body(dice, scale, far));
    let length = dice.decade(-6.0, 6.0);
    let normal = if dice.chance(0.5) { [0.0, 0.0, 1.0] } else { dice.direction::<3>().map(|x| x * length) };
    let aside = scale * length * dice.signed();
    let offset = dice.pick(&[0.0, aside]);
    let place = CURRENT.lock().unwrap().0.clone();
    now_at(format!("{place}\nhalf space {normal:?} {offset}\nA = {a:?}\nframe = {frame:?}"));
    if dice.chance(0.5) {
        (a, frame) = (rounded::<f32>(&a), rounded::<f32>(&frame));
        run_half_space::<f32>(&a, normal, offset, &frame);
    }
    run_half_space::<f64>(&a, normal, offset, &frame);
}

/// Against the definition: (h_A(-w) + c + w.s) / |w|, with w = S n.
fn run_half_space<T: Real>(a: &Placed, normal: [f64; 3], offset: f64, frame: &Placed) {
    let (normal, offset) = (normal.map(exact::<T>), exact::<T>(offset));
    let points = a.shape.points::<T>();
    let shape = a.shape.build(&points).unwrap();
    let ground = HalfSpace::<T, 3>::new(Vector::from(normal.map(T::of)), T::of(offset)).unwrap();
    let mut memory = Memory::least::<T, 3>();
    let options = Options::default();
    let r = memory.solver::<T, 3>().depth(&a.body(&*shape).unwrap(), &frame.body(&ground).unwrap(), &options);
    let seen = Seen::from(&r);
    if let Some(text) = broken_promise(&seen, &options, 0, 0) {
        find(&text, &format!("{r:?}"));
    }
    let row = |i: usize| v3([frame.rotation[3 * i], frame.rotation[3 * i + 1], frame.rotation[3 * i + 2]]);
    let w: V3 = std::array::from_fn(|i| dot(&row(i), &v3(normal)));
    let down: V3 = std::array::from_fn(|i| -w[i]);
    let d = (body_value(a, &down) + Dd::new(offset) + dot(&w, &v3(frame.translation))) / norm(&w);
    let blur = Dd::new(BLUR * (reach(a) + reach(frame) + offset.abs() / norm(&w).hi));
    if !(Dd::new(seen.lower) <= d + blur && d - blur <= Dd::new(seen.upper)) {
        find("the bracket of a half space misses the definition", &format!("{r:?}\n{d:?}"));
    }
}

fn fuzz_join(dice: &mut Dice) {
    let scale = dice.decade(-6.0, 6.0);
    let mut parts: [Placed; 3] = std::array::from_fn(|_| random_body(dice, scale, 2.0 * scale));
    let place = CURRENT.lock().unwrap().0.clone();
    now_at(format!("{place}\njoin of the first two, and the third: {parts:?}"));
    let mut ledger = Ledger::new();
    if dice.chance(0.5) {
        parts = parts.map(|part| rounded::<f32>(&part));
        run_join::<f32>(&parts, dice, &mut ledger);
    }
    run_join::<f64>(&parts, dice, &mut ledger);
}

/// Against heights in double-double: the larger of the parts' along the normal, and along random directions.
fn run_join<T: Real>(parts: &[Placed; 3], dice: &mut Dice, ledger: &mut Ledger) {
    let [a, b, other] = parts;
    let points = parts.each_ref().map(|part| part.shape.points::<T>());
    let shapes = [0, 1, 2].map(|i| parts[i].shape.build(&points[i]).unwrap());
    let moved = |i: usize| {
        let rotation = SMatrix::<T, 3, 3>::from_row_slice(&parts[i].rotation.map(T::of));
        Rigid::new(&*shapes[i], rotation, Vector::from(parts[i].translation.map(T::of))).unwrap()
    };
    let join = Join::new(moved(0), moved(1));
    let mut memory = Memory::new::<T, 3>(256, 512);
    let options = Options { max_iterations: 300, ..Options::default() };
    let placed = Body::at(&join, Vector::zeros());
    let r = memory.solver::<T, 3>().depth(&placed, &other.body(&*shapes[2]).unwrap(), &options);
    let seen = Seen::from(&r);
    if let Some(text) = broken_promise(&seen, &options, 256, 512) {
        find(&text, &format!("{r:?}"));
    }
    let height = |n: &V3| {
        let back: V3 = std::array::from_fn(|i| -n[i]);
        (body_value(a, n).max(body_value(b, n)) + body_value(other, &back)) / norm(n)
    };
    let blur = BLUR * parts.iter().map(reach).sum::<f64>();
    let n = v3([r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64));
    if seen.upper < T::HUGE.to_f64() && !(height(&n) <= Dd::new(seen.upper + blur)) {
        find("the normal does not prove the upper bound of a join", &format!("{r:?}\nproved {:e}", height(&n).hi));
    }
    ledger.add(seen.lower, seen.upper, &format!("{r:?}"));
    for _ in 0..50 {
        ledger.add(f64::NEG_INFINITY, height(&v3(dice.direction::<3>())).hi + blur, "a direction");
    }
}

// General sets and unit sets.

/// A set by its numbers: (base + ball) placed.
#[derive(Clone, Debug)]
struct SetText<const N: usize> {
    /// Half extents of a box, semi axes of an ellipsoid, points, or nothing for the origin.
    boxes: Option<[f64; N]>,
    ellipsoid: Option<[f64; N]>,
    points: Vec<[f64; N]>,
    ball: f64,
    margin: f64,
    matrix: [[f64; N]; N],
    translation: [f64; N],
    /// The matrix is not a rotation: balls are mapped too.
    linear: bool,
}

#[derive(Clone, Debug)]
enum UnitText<const N: usize> {
    Ball(f64),
    Box([f64; N]),
    Cross([f64; N]),
    Ellipsoid([f64; N], [[f64; N]; N]),
    Segment([f64; N]),
    Vertices(Vec<[f64; N]>),
    Closure([f64; N]),
}

fn wide(x: &[f64]) -> Vec<Dd> {
    x.iter().map(|&x| Dd::new(x)).collect()
}

fn mapped<const N: usize>(m: &[[f64; N]; N], u: &[Dd]) -> Vec<Dd> {
    (0..N).map(|j| (0..N).fold(Dd::ZERO, |s, i| s + Dd::new(m[i][j]) * u[i])).collect()
}

fn product(u: &[Dd], h: &[f64]) -> Vec<Dd> {
    u.iter().zip(h).map(|(&u, &h)| u * Dd::new(h)).collect()
}

fn largest(values: impl Iterator<Item = Dd>) -> Dd {
    values.fold(Dd::new(f64::MIN), Dd::max)
}

impl<const N: usize> SetText<N> {
    fn value(&self, u: &[Dd]) -> Dd {
        let w = mapped(&self.matrix, u);
        let mut h = Dd::ZERO;
        if let Some(b) = &self.boxes {
            h = h + product(&w, b).iter().fold(Dd::ZERO, |s, x| s + x.abs());
        }
        if let Some(e) = &self.ellipsoid {
            h = h + norm(&product(&w, e));
        }
        if !self.points.is_empty() {
            h = h + largest(self.points.iter().map(|p| dot(&w, &wide(p))));
        }
        let ball = if self.linear { norm(&w) } else { norm(u) };
        h + Dd::new(self.ball) * ball + Dd::new(self.margin) * norm(u) + dot(u, &wide(&self.translation))
    }

    fn random(dice: &mut Dice) -> Self {
        let scale = if dice.chance(0.5) { 1.0 } else { dice.decade(-6.0, 6.0) };
        let sizes = |dice: &mut Dice| -> [f64; N] { std::array::from_fn(|_| scale * random_size(dice)) };
        let kinds = 1 + dice.below(7);
        let linear = dice.chance(0.2);
        let identity: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
        let mut matrix = if dice.chance(0.5) { identity } else { dice.rotation::<N>() };
        if linear {
            let stretch: [f64; N] = std::array::from_fn(|_| random_size(dice));
            matrix = matrix.map(|row| std::array::from_fn(|j| row[j] * stretch[j] + 0.3 * dice.signed()));
        }
        let boxes = (kinds & 1 != 0).then(|| sizes(dice));
        let ellipsoid = (kinds & 2 != 0 && dice.chance(0.5)).then(|| sizes(dice));
        let points = if kinds & 4 != 0 {
            let style = dice.below(2);
            (0..1 + dice.below(2 * N + 6))
                .map(|_| {
                    if style == 0 {
                        std::array::from_fn(|_| scale * (dice.below(3) as f64 - 1.0))
                    } else {
                        dice.direction::<N>().map(|x| x * scale)
                    }
                })
                .collect()
        } else {
            Vec::new()
        };
        let ball = if dice.chance(0.2) { scale * random_size(dice) } else { 0.0 };
        let margin = if dice.chance(0.2) { scale * random_size(dice) } else { 0.0 };
        let shift = match dice.below(4) {
            0 => 0.0,
            1 => 3.0,
            2 => dice.decade(-9.0, 3.0),
            _ => 0.3,
        };
        let translation = std::array::from_fn(|_| if dice.chance(0.3) { 0.0 } else { shift * scale * dice.signed() });
        SetText { boxes, ellipsoid, points, ball, margin, matrix, translation, linear }
    }

    fn rounded(&self) -> Self {
        let r = |x: f64| f64::from(x as f32);
        SetText {
            boxes: self.boxes.map(|b| b.map(r)),
            ellipsoid: self.ellipsoid.map(|b| b.map(r)),
            points: self.points.iter().map(|p| p.map(r)).collect(),
            ball: r(self.ball),
            margin: r(self.margin),
            matrix: self.matrix.map(|row| row.map(r)),
            translation: self.translation.map(r),
            linear: self.linear,
        }
    }

    fn size(&self) -> f64 {
        let most = |x: &[f64]| x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let parts = [self.boxes.map_or(0.0, |b| most(&b)), self.ellipsoid.map_or(0.0, |b| most(&b)), self.ball];
        let inner = self.points.iter().map(|p| most(p)).fold(parts.iter().sum(), f64::max);
        inner * most(self.matrix.as_flattened()) * N as f64 + self.margin + most(&self.translation)
    }

    fn with<T: Real, R>(&self, f: impl FnOnce(&dyn Support<T, N>) -> R) -> R {
        let v = |x: &[f64; N]| Vector::<T, N>::from(x.map(T::of));
        let points: Vec<[T; N]> = self.points.iter().map(|p| p.map(T::of)).collect();
        let mut base: Box<dyn Support<T, N> + '_> = Box::new(Sphere::<T, N>::new(T::of(self.ball)).unwrap());
        if let Some(b) = &self.boxes {
            base = Box::new(Sum::new(BoxShape::new(v(b)).unwrap(), Held(base)));
        }
        if let Some(e) = &self.ellipsoid {
            base = Box::new(Sum::new(Held(base), Ellipsoid::new(v(e)).unwrap()));
        }
        if !points.is_empty() {
            base = Box::new(Sum::new(Held(base), Points::new(&points).unwrap()));
        }
        let matrix = SMatrix::<T, N, N>::from_fn(|i, j| T::of(self.matrix[i][j]));
        let margin = T::of(self.margin);
        if self.linear {
            f(&Margin::new(Linear::new(&*base, matrix, v(&self.translation)).unwrap(), margin).unwrap())
        } else {
            f(&Margin::new(Rigid::new(&*base, matrix, v(&self.translation)).unwrap(), margin).unwrap())
        }
    }
}

/// A boxed set as a set.
struct Held<'a, T: Real, const N: usize>(Box<dyn Support<T, N> + 'a>);

impl<T: Real, const N: usize> Support<T, N> for Held<'_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        self.0.support(u)
    }
    fn radius(&self) -> T {
        self.0.radius()
    }
    fn rolling_radius(&self) -> T {
        self.0.rolling_radius()
    }
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        self.0.center()
    }
    fn extent(&self) -> T {
        self.0.extent()
    }
    fn error(&self) -> T {
        self.0.error()
    }
}

impl<const N: usize> UnitText<N> {
    fn value(&self, u: &[Dd]) -> Dd {
        match self {
            UnitText::Ball(r) => Dd::new(*r) * norm(u),
            UnitText::Box(g) | UnitText::Closure(g) => product(u, g).iter().fold(Dd::ZERO, |s, x| s + x.abs()),
            UnitText::Cross(g) => largest(product(u, g).iter().map(|x| x.abs())),
            UnitText::Ellipsoid(g, m) => norm(&product(&mapped(m, u), g)),
            UnitText::Segment(g) => dot(u, &wide(g)).max(Dd::ZERO),
            UnitText::Vertices(p) => largest(p.iter().map(|p| dot(u, &wide(p)))).max(Dd::ZERO),
        }
    }

    fn random(dice: &mut Dice) -> Self {
        let scale = if dice.chance(0.7) { 1.0 } else { dice.decade(-6.0, 6.0) };
        let mut g: [f64; N] = std::array::from_fn(|_| scale * random_size(dice));
        // At least one size is not zero.
        g[dice.below(N)] = scale;
        let mut signed = || -> [f64; N] { dice.direction::<N>().map(|x| x * scale) };
        let (end, corners) = (signed(), [signed(), signed(), signed()]);
        match dice.below(8) {
            0 | 1 => UnitText::Ball(scale),
            2 => UnitText::Box(g),
            3 => UnitText::Cross(g),
            4 => UnitText::Ellipsoid(
                g,
                if dice.chance(0.5) {
                    dice.rotation::<N>()
                } else {
                    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }))
                },
            ),
            5 => UnitText::Segment(if dice.chance(0.5) { end } else { g }),
            6 => UnitText::Vertices(corners[..1 + dice.below(3)].to_vec()),
            _ => UnitText::Closure(g),
        }
    }

    fn rounded(&self) -> Self {
        let r = |x: f64| f64::from(x as f32);
        match self {
            UnitText::Ball(x) => UnitText::Ball(r(*x)),
            UnitText::Box(g) => UnitText::Box(g.map(r)),
            UnitText::Cross(g) => UnitText::Cross(g.map(r)),
            UnitText::Ellipsoid(g, m) => UnitText::Ellipsoid(g.map(r), m.map(|row| row.map(r))),
            UnitText::Segment(g) => UnitText::Segment(g.map(r)),
            UnitText::Vertices(p) => UnitText::Vertices(p.iter().map(|p| p.map(r)).collect()),
            UnitText::Closure(g) => UnitText::Closure(g.map(r)),
        }
    }

    fn with<T: Real, R>(&self, f: impl FnOnce(&dyn UnitSet<T, N>) -> R) -> R {
        let v = |x: &[f64; N]| Vector::<T, N>::from(x.map(T::of));
        match self {
            UnitText::Ball(r) => f(&Ball::new(T::of(*r)).unwrap()),
            UnitText::Box(g) => f(&UnitBox::new(v(g)).unwrap()),
            UnitText::Cross(g) => f(&CrossPolytope::new(v(g)).unwrap()),
            UnitText::Ellipsoid(g, m) => {
                f(&UnitEllipsoid::new(v(g), SMatrix::<T, N, N>::from_fn(|i, j| T::of(m[i][j]))).unwrap())
            }
            UnitText::Segment(g) => f(&Segment::new(v(g)).unwrap()),
            UnitText::Vertices(p) => {
                let points: Vec<[T; N]> = p.iter().map(|p| p.map(T::of)).collect();
                f(&Vertices::new(&points).unwrap())
            }
            UnitText::Closure(g) => {
                let g = v(g);
                let size = g.iter().fold(T::zero(), |s, &x| s + x);
                let value =
                    |u: &Vector<T, N>| Ok(u.iter().zip(g.iter()).fold(T::zero(), |s, (&u, &g)| s + u.abs() * g));
                f(&UnitSetFn::new(value, T::count(N + 2) * T::ROUNDOFF * size).unwrap())
            }
        }
    }
}

/// Directions to hold a bracket against: random ones, axes, and a walk downhill from the reported one.
fn opponents<const N: usize>(set: &SetText<N>, unit: &UnitText<N>, first: [f64; N], dice: &mut Dice) -> Vec<[f64; N]> {
    let mut all = vec![first];
    for i in 0..N {
        for s in [1.0, -1.0] {
            all.push(std::array::from_fn(|j| if i == j { s } else { 0.0 }));
        }
    }
    all.extend((0..20).map(|_| dice.direction::<N>()));
    let quotient = |u: &[f64; N]| {
        let u = wide(u);
        let (top, bottom) = (set.value(&u).hi, unit.value(&u).hi);
        if top < 0.0 { top } else { top / bottom }
    };
    let mut best = all.iter().map(|u| (quotient(u), *u)).filter(|b| !b.0.is_nan()).min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((value, u)) = &mut best {
        let mut step = 0.3;
        while step > 1e-7 {
            let mut improved = false;
            for _ in 0..4 {
                let d = dice.direction::<N>();
                let v: [f64; N] = std::array::from_fn(|i| u[i] + step * d[i]);
                let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                let v = v.map(|x| x / length);
                let q = quotient(&v);
                if q < *value {
                    (*value, *u, improved) = (q, v, true);
                }
            }
            if !improved {
                step *= 0.4;
            }
        }
        all.push(*u);
    }
    all
}

fn run_general<T: Real, const N: usize>(
    set: &SetText<N>,
    unit: &UnitText<N>,
    dice: &mut Dice,
    runs: usize,
    ledger: &mut Ledger,
) {
    let size = set.size();
    let blur = BLUR * size;
    let euclidean = matches!(unit, UnitText::Ball(_));
    for run in 0..runs {
        let (mut options, (vertices, facets)) = if run == 0 {
            (Options::default(), (128, 1024))
        } else {
            (random_options::<T, N>(dice, size, None), random_capacity::<N>(dice))
        };
        // Cones go on for as long as they may.
        if options.max_iterations == 0 {
            options.max_iterations = match N {
                2 | 3 => 3000,
                _ => dice.pick(&[60, 60, 300, 1500]),
            };
        }
        // Now and then it is a deadline that ends the run.
        let (asked, deadline) = (Cell::new(0), dice.below(400));
        let interrupt = || {
            asked.set(asked.get() + 1);
            asked.get() > deadline
        };
        let interrupt: Option<&dyn Fn() -> bool> = if run > 0 && dice.chance(0.3) { Some(&interrupt) } else { None };
        let mut memory = Memory::new::<T, N>(vertices, facets);
        let answer =
            set.with::<T, _>(|a| unit.with::<T, _>(|q| memory.solver::<T, N>().solve_until(a, q, &options, interrupt)));
        let seen = Seen::from(&answer);
        let tell = format!(
            "run {run}, N = {N}, u = {:.0e}, {vertices} vertices, {facets} facets, {options:?}, deadline {:?}\n{seen:?} {:?}, {} cones, {} splits\ndirection {:?}",
            T::ROUNDOFF.to_f64(),
            interrupt.map(|_| deadline),
            answer.plan,
            answer.cones,
            answer.splits,
            answer.direction
        );
        if let Some(text) = broken_promise(&seen, &options, vertices, facets) {
            find(&text, &tell);
        }
        if seen.outcome == Outcome::SupportFailed {
            find("built-in sets failed", &tell);
        }
        if seen.outcome == Outcome::Interrupted && interrupt.is_none() {
            find("interrupted by nobody", &tell);
        }
        let bounded = seen.upper < T::HUGE.to_f64();
        let n: [f64; N] = std::array::from_fn(|i| answer.direction[i].to_f64());
        let u = wide(&n);
        let (top, bottom, length) = (set.value(&u), unit.value(&u), norm(&u));
        if bounded {
            let proof = if seen.upper < 0.0 && !euclidean {
                top - Dd::new(seen.upper) * length
            } else {
                top - Dd::new(seen.upper) * bottom
            };
            let scale = blur + 1e-26 * (seen.upper * bottom.hi).abs();
            if proof.hi > scale {
                find("the direction does not prove the upper bound", &format!("{tell}\noff by {:e}", proof.hi));
            }
        }
        if seen.lower > f64::MIN {
            for u in opponents(set, unit, n, dice) {
                let w = wide(&u);
                let (top, bottom, length) = (set.value(&w), unit.value(&w), norm(&w));
                let slack = blur + 1e-26 * (seen.lower * bottom.hi).abs();
                // Outside, d is minus the distance (in units of the ball); inside, the quotient.
                let unit = if let UnitText::Ball(r) = unit { Dd::new(*r) } else { Dd::new(1.0) };
                let wrong = if top.hi < -slack {
                    (Dd::new(seen.lower) * unit * length - top).hi > slack
                } else {
                    seen.lower > 0.0 && (Dd::new(seen.lower) * bottom - top).hi > slack
                };
                if wrong {
                    find(
                        "a direction contradicts the lower bound",
                        &format!("{tell}\nu = {u:?}\nh_A = {:e}, h_Q = {:e}", top.hi, bottom.hi),
                    );
                }
            }
        }
        ledger.add(seen.lower, seen.upper, &tell);
    }
}

fn fuzz_general<const N: usize>(dice: &mut Dice) {
    let (mut set, mut unit) = (SetText::<N>::random(dice), UnitText::<N>::random(dice));
    let single = dice.chance(0.5);
    if single {
        (set, unit) = (set.rounded(), unit.rounded());
    }
    let place = CURRENT.lock().unwrap().0.clone();
    now_at(format!("{place}\nset = {set:?}\nunit = {unit:?}"));
    let mut ledger = Ledger::new();
    run_general::<f64, N>(&set, &unit, dice, 3, &mut ledger);
    if single {
        run_general::<f32, N>(&set, &unit, dice, 2, &mut ledger);
    }
}

// Callbacks that fail or lie.

/// A box whose support function goes wrong at some call.
struct Faulty<T: Real, const N: usize> {
    half: Vector<T, N>,
    at: Cell<usize>,
    kind: usize,
    radius: T,
    extent: T,
    error: T,
}

impl<T: Real, const N: usize> Support<T, N> for Faulty<T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        assert!(u.iter().all(|x| x.finite()) && u.iter().any(|&x| x != T::zero()), "asked along {u:?}");
        let p = u.zip_map(&self.half, |u, h| if u < T::zero() { -h } else { h });
        if self.at.get() > 0 {
            self.at.set(self.at.get() - 1);
            return Ok(p);
        }
        let bad = |x: f64| Vector::<T, N>::from_element(T::of(x));
        match self.kind {
            0 => Err(Failure(7)),
            1 => Ok(bad(f64::NAN)),
            2 => Ok(bad(f64::INFINITY)),
            3 => Ok(bad(f64::MAX)),
            4 => Ok(-p),
            5 => Ok(Vector::zeros()),
            6 => Ok(p * T::of(1e-30)),
            _ => Ok(bad(if T::ROUNDOFF.to_f64() > 1e-10 { 1e30 } else { 1e200 })),
        }
    }
    fn radius(&self) -> T {
        self.radius
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error
    }
}

fn fuzz_bad<T: Real, const N: usize>(dice: &mut Dice) {
    let odd = |dice: &mut Dice, usual: f64| {
        let odd = dice.pick(&[0.0, 1e-30, 1e30, f64::NAN, f64::INFINITY, -1.0]);
        if dice.chance(0.8) { usual } else { odd }
    };
    let set = Faulty::<T, N> {
        half: Vector::from(std::array::from_fn(|_| T::of(random_size(dice)))),
        at: Cell::new(dice.below(25)),
        kind: dice.below(8),
        radius: T::of(if dice.chance(0.7) { 0.0 } else { odd(dice, 0.5) }),
        extent: T::of(odd(dice, 5.0)),
        error: T::of(odd(dice, 1e-15)),
    };
    let fail_unit = dice.chance(0.3);
    let after = Cell::new(dice.below(40));
    let bad_value = dice.pick(&[f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300]);
    let fail = dice.chance(0.3);
    let unit_error = T::of(dice.pick(&[0.0, 1e-15, 1e-3, 10.0]));
    let value = move |u: &Vector<T, N>| {
        if after.get() > 0 {
            after.set(after.get() - 1);
            return Ok(u.iter().fold(T::zero(), |s, x| s + x.abs()));
        }
        if fail { Err(Failure(9)) } else { Ok(T::of(bad_value)) }
    };
    let (vertices, facets) = random_capacity::<N>(dice);
    let mut options = random_options::<T, N>(dice, 1.0, None);
    if dice.chance(0.3) {
        options.relative = T::of(dice.pick(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY]));
        options.absolute = T::of(dice.pick(&[f64::NAN, 0.0, f64::INFINITY]));
        options.threshold = Some(T::of(dice.pick(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY])));
    }
    let text = format!(
        "{}\nN = {N}, u = {:.0e}, {vertices} vertices, {facets} facets, half {:?}, bad support {} after {}, radius {:?}, extent {:?}, error {:?}, bad unit set {fail_unit} ({bad_value}, fail {fail}, error {unit_error:?}), {options:?}",
        CURRENT.lock().unwrap().0,
        T::ROUNDOFF.to_f64(),
        set.half,
        set.kind,
        set.at.get(),
        set.radius,
        set.extent,
        set.error,
    );
    now_at(text);
    let mut memory = Memory::new::<T, N>(vertices, facets);
    let answer = if fail_unit {
        let unit = UnitSetFn::new(value, unit_error).unwrap();
        memory.solver::<T, N>().solve(&set, &unit, &options)
    } else {
        memory.solver::<T, N>().solve(&set, &Ball::unit(), &options)
    };
    let seen = Seen::from(&answer);
    // Lies have no true bracket; but no NaN, nor an empty one, comes out, and failures are told.
    if seen.lower.is_nan() || seen.upper.is_nan() || seen.lower > seen.upper {
        let lying = set.kind >= 3
            || fail_unit
            || !(set.error >= T::zero())
            || !(set.radius >= T::zero())
            || !set.extent.finite();
        if seen.lower.is_nan() || seen.upper.is_nan() || !lying {
            find("NaN or an empty bracket from bad callbacks", &format!("{seen:?}"));
        }
    }
    if seen.iterations as usize > vertices + 300 && matches!(answer.plan, Plan::Expansion | Plan::Distance) {
        find("more iterations than vertices and steps", &format!("{seen:?}"));
    }
    if (seen.failure != 0) != (seen.outcome == Outcome::SupportFailed) {
        find("failure code and outcome disagree", &format!("{seen:?}"));
    }
}
