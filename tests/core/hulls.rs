//! Prepared hulls of every kind of points: there is a graph or the points are flat, never an error of memory where the documented
//! memory was given; and climbing finds what scanning finds.

use crate::common;

use common::dd::{Dd, v3};
use common::dice::Dice;
use common::memory::Memory;
use qdist::support::{Hull, HullGraph, Support, Word, graph_len, large_graph_len};
use qdist::{GraphError, HullFacet, hull_facets, prepare_hull};
use qdist::{Real, Vector};
use std::cell::Cell;
use std::time::{Duration, Instant};

type Cloud<T> = Vec<[T; 3]>;

fn direction(dice: &mut Dice) -> [f64; 3] {
    loop {
        let d = [dice.signed(), dice.signed(), dice.signed()];
        let n = dot(&d, &d).sqrt();
        if n > 0.1 && n < 1.0 {
            return d.map(|x| x / n);
        }
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Three orthonormal directions.
fn frame(dice: &mut Dice) -> [[f64; 3]; 3] {
    let a = direction(dice);
    loop {
        let b = direction(dice);
        let along = dot(&a, &b);
        let c = [0, 1, 2].map(|i| b[i] - along * a[i]);
        let n = dot(&c, &c).sqrt();
        if n > 0.1 {
            let b = c.map(|x| x / n);
            return [a, b, cross(&a, &b)];
        }
    }
}

/// Points of one of some kinds: random, on a sphere, on a lattice, with repeated, collinear and coplanar ones, in clusters.
fn unit_cloud(dice: &mut Dice, kind: usize, count: usize) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = Vec::new();
    while points.len() < count {
        let p = match kind {
            0 => [dice.signed(), dice.signed(), dice.signed()],
            1 => direction(dice),
            2 => [0; 3].map(|_| dice.below(4) as f64 / 3.0),
            3 if points.len() > 2 && dice.below(2) == 0 => {
                let [a, b] = [0; 2].map(|_| points[dice.below(points.len())]);
                let random = dice.signed();
                let t = dice.pick(&[0.0, 0.5, 0.25, random]);
                [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
            }
            4 if points.len() > 3 && dice.below(2) == 0 => {
                let [a, b, c] = [0; 3].map(|_| points[dice.below(points.len())]);
                let [s, t] = [dice.signed(), dice.signed()];
                [0, 1, 2].map(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]))
            }
            5 if points.len() > 3 && dice.below(4) != 0 => {
                let a = points[dice.below(points.len())];
                let size = dice.decade(-9.0, -1.0);
                a.map(|x| x + size * dice.signed())
            }
            _ => [dice.signed(), dice.signed(), dice.signed()],
        };
        points.push(p);
    }
    points
}
const KINDS: usize = 6;

/// A cloud pressed flat along one axis or two, turned, moved and rounded.
fn pressed<T: Real>(dice: &mut Dice, kind: usize, count: usize, aspect: f64) -> Cloud<T> {
    let axes = if dice.below(3) == 0 { frame(dice) } else { [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
    let needle = dice.below(4) == 0;
    let size = dice.decade(-6.0, 6.0);
    let offset = if dice.below(4) == 0 { direction(dice).map(|x| x * size * 100.0) } else { [0.0; 3] };
    let press = [1.0, aspect, if needle { aspect } else { 1.0 }];
    let place = |p: &[f64; 3]| {
        let p = [0, 1, 2].map(|i| p[i] * press[i] * size);
        [0, 1, 2].map(|i| T::of((0..3).map(|k| axes[k][i] * p[k]).sum::<f64>() + offset[i]))
    };
    unit_cloud(dice, kind, count).iter().map(place).collect()
}

/// A bound from above of the least width: the least along normals of some triples, and along what lines leave out.
fn least_width<T: Real>(points: &[[T; 3]], dice: &mut Dice) -> f64 {
    let from = |p: &[T; 3]| [0, 1, 2].map(|i| p[i].to_f64() - points[0][i].to_f64());
    let points: Cloud<f64> = points.iter().map(from).collect();
    let mut least = f64::MAX;
    for _ in 0..3000 {
        let [a, b, c] = [0; 3].map(|_| points[dice.below(points.len())]);
        let [e, f] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let mut u = cross(&e, &f);
        if dot(&u, &u) == 0.0 {
            u = cross(&e, &direction(dice));
        }
        // Cancellation leaves the normal of a sliver along its edges.
        let along = |x: &[f64; 3], axis: &[f64; 3]| {
            let square = dot(axis, axis);
            let part = if square > 0.0 { dot(x, axis) / square } else { 0.0 };
            [0, 1, 2].map(|i| x[i] - part * axis[i])
        };
        let across = along(&along(&f, &e), &e);
        for _ in 0..2 {
            u = along(&along(&u, &e), &across);
        }
        let n = dot(&u, &u).sqrt();
        if n > 0.0 {
            let heights = || points.iter().map(|p| dot(&u, p) / n);
            least = least.min(heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min));
        } else if points.iter().all(|p| p == &points[0]) {
            return 0.0;
        }
    }
    least
}

/// max u.p - u.q over the points p, exactly, for a |u| of about 1.
fn deficit<T: Real>(points: &[[T; 3]], u: &[f64; 3], q: &Vector<T, 3>) -> f64 {
    let u = v3(*u);
    let height = |p: [f64; 3]| {
        let p = v3(p);
        u[0] * p[0] + u[1] * p[1] + u[2] * p[2]
    };
    let best = points.iter().map(|p| height(p.map(Real::to_f64))).fold(None, |m: Option<Dd>, h| match m {
        Some(m) if m >= h => Some(m),
        _ => Some(h),
    });
    (best.unwrap() - height([q.x, q.y, q.z].map(Real::to_f64))).hi
}

/// The worst deficit of climbing over some directions, in units of the error that the hull states.
fn worst_climb<T: Real, W: Word>(points: &[[T; 3]], graph: HullGraph<'_, W>, dice: &mut Dice, tries: usize) -> f64 {
    let hull = Hull::new(points, graph).unwrap();
    let mut worst = 0.0f64;
    for k in 0..tries {
        let u = match k % 3 {
            0 => direction(dice),
            // Along the normals of triples, where plateaus are.
            1 => {
                let [a, b, c] = [0; 3].map(|_| points[dice.below(points.len())].map(Real::to_f64));
                let [e, f] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
                cross(&e, &f)
            }
            _ => {
                let d = direction(dice);
                d.map(|x| x * dice.decade(-12.0, 0.0))
            }
        };
        let n = dot(&u, &u).sqrt();
        if !(n > 0.0) {
            continue;
        }
        let u = u.map(|x| T::of(x / n));
        let p = hull.support(&Vector::from(u)).unwrap();
        assert!(points.contains(&p.into()));
        worst = worst.max(deficit(points, &u.map(Real::to_f64), &p) / hull.error().to_f64());
    }
    worst
}

/// Prepares in a solver of the documented size and in wide words: both end the same way. `None` when the points are flat.
fn climbs<T: Real>(points: &[[T; 3]], dice: &mut Dice) -> Option<f64> {
    let count = points.len();
    let mut memory = Memory::new::<T, 3>(4, (2 * count).max(6));
    let mut solver = memory.solver::<T, 3>();
    let mut words = vec![7; graph_len(count)];
    let small = solver.prepare_hull(points, &mut words, None);
    let (mut wide, mut facets) = (vec![9u32; large_graph_len(count)], vec![HullFacet::EMPTY; hull_facets(count)]);
    let large = prepare_hull(points, &mut wide, &mut facets, None);
    match (small, large) {
        (Ok(small), Ok(large)) => {
            for i in 0..count as u32 {
                let list = small.neighbors(i as u16).iter().map(|&v| u32::from(v));
                assert!(list.eq(large.neighbors(i).iter().copied()));
            }
            Some(worst_climb(points, small, dice, 30))
        }
        (Err(GraphError::Flat), Err(GraphError::Flat)) => None,
        (small, large) => panic!("{small:?} {large:?}: {points:?}"),
    }
}

fn any_points_have_a_graph<T: Real>(aspects: i32, runs: usize) {
    let mut dice = Dice::new(71);
    for decade in 0..=aspects {
        let (mut flat, mut worst, mut above) = (0, 0.0f64, 0);
        for run in 0..runs {
            let count = 4 + dice.below(57);
            let points = pressed::<T>(&mut dice, run % KINDS, count, 10f64.powi(-decade));
            let reach = points.iter().fold(0.0f64, |m, p| {
                let d = [0, 1, 2].map(|i| p[i].to_f64() - points[0][i].to_f64());
                m.max(dot(&d, &d).sqrt())
            });
            match climbs(&points, &mut dice) {
                Some(ratio) => {
                    worst = worst.max(ratio);
                    above += usize::from(ratio > 1.0);
                }
                None => {
                    flat += 1;
                    let width = least_width(&points, &mut dice);
                    assert!(
                        width <= 400.0 * T::ROUNDOFF.to_f64() * reach,
                        "{decade} {run} {width:e} {reach:e} {points:?}"
                    );
                }
            }
        }
        println!("aspect 1e-{decade}: {flat} of {runs} flat, worst climb {worst:.2} errors, {above} above");
        assert!(worst <= 1.0);
    }
}

#[test]
fn any_points_have_a_graph_or_are_flat() {
    any_points_have_a_graph::<f32>(8, 1000);
    any_points_have_a_graph::<f64>(16, 1000);
}

#[test]
fn six_points_that_differ_by_1e_5_along_y_have_a_graph() {
    let points = [
        [-0.172454029, 7.14247108e-06, -0.678314567],
        [0.0897212848, 6.2423228e-06, -0.776069701],
        [0.815044343, -1.74616491e-06, 0.552459776],
        [0.937620878, -9.01898545e-07, -0.335757196],
        [-0.151917607, 4.48652781e-06, -0.880699575],
        [0.25318408, 6.1916021e-06, -0.743329346],
    ]
    .map(|p: [f64; 3]| p.map(|x| x as f32));
    assert!(climbs(&points, &mut Dice::new(1)).unwrap() <= 1.0);
    let mut dice = Dice::new(7);
    let mut graphs = 0;
    for _ in 0..3000 {
        let points = points.map(|p| p.map(|x| x * (1.0 + 0.3 * dice.signed() as f32)));
        graphs += usize::from(climbs(&points, &mut dice).is_some());
    }
    assert!(graphs > 1500, "{graphs}");
}

/// A point of Fibonacci's spiral.
fn on_sphere(k: usize, count: usize) -> [f64; 3] {
    let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
    let (sin, cos) = (2.399963229728653 * k as f64).sin_cos();
    let r = (1.0 - z * z).sqrt();
    [r * cos, r * sin, z]
}

/// Prepares in wide words, in seconds at most; the number of vertices.
fn large<T: Real>(points: &[[T; 3]]) -> usize {
    let count = points.len();
    let (mut words, mut facets) = (vec![0u32; large_graph_len(count)], vec![HullFacet::EMPTY; hull_facets(count)]);
    let start = Instant::now();
    let graph = prepare_hull(points, &mut words, &mut facets, None).unwrap();
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    println!("{count} points: {:?}", start.elapsed());
    let degrees: Vec<usize> = (0..count as u32).map(|i| graph.neighbors(i).len()).collect();
    let vertices = degrees.iter().filter(|&&d| d > 0).count();
    // Euler: a triangulated sphere.
    assert_eq!(degrees.iter().sum::<usize>(), 6 * vertices - 12);
    assert!(worst_climb(points, graph, &mut Dice::new(5), 30) <= 1.0);
    vertices
}

#[test]
fn hundred_thousand_points_on_a_sphere_in_a_ball_and_on_a_lattice() {
    let count = 100_000;
    let sphere: Vec<_> = (0..count).map(|k| on_sphere(k, count)).collect();
    assert_eq!(large(&sphere), count);
    // In f32 some are inside of what rounding makes of their neighbours.
    let rounded: Vec<_> = sphere.iter().map(|p| p.map(|x| x as f32)).collect();
    assert!(large(&rounded) > count / 2);
    let mut dice = Dice::new(3);
    let in_ball = |dice: &mut Dice| {
        let radius = dice.unit().cbrt();
        direction(dice).map(|x| x * radius)
    };
    let ball: Vec<_> = (0..count).map(|_| in_ball(&mut dice)).collect();
    assert!(large(&ball) < count / 10);
    let lattice: Vec<_> = (0..count).map(|i| [i % 50, i / 50 % 50, i / 2500].map(|x| x as f64)).collect();
    assert_eq!(large(&lattice), 8);
    let turned = frame(&mut dice);
    let lattice: Vec<_> = lattice.iter().map(|p| turned.map(|axis| dot(&axis, p))).collect();
    assert!(large(&lattice) < 2000);
    let cube: Vec<_> = (0..count).map(|_| [dice.signed(), dice.signed(), dice.signed()]).collect();
    assert!(large(&cube) < 1000);
}

#[test]
fn words_of_16_bits_hold_what_is_promised() {
    let mut memory = Memory::new::<f64, 3>(4, 65_535);
    let mut solver = memory.solver::<f64, 3>();
    let mut words = vec![0; graph_len(65_535)];
    // As many vertices as promised, and the 30,001 that are more but fit.
    for count in [<u16 as Word>::MAX_POINTS, 30_001] {
        let sphere: Vec<_> = (0..count).map(|k| on_sphere(k, count)).collect();
        let graph = solver.prepare_hull(&sphere, &mut words, None).unwrap();
        assert!((0..count as u16).all(|i| !graph.neighbors(i).is_empty()));
    }
    let sphere: Vec<_> = (0..40_000).map(|k| on_sphere(k, 40_000)).collect();
    assert_eq!(solver.prepare_hull(&sphere, &mut words, None).unwrap_err(), GraphError::Points);
    // As many points as words can number, few of which are vertices; one more is too many.
    let mut dice = Dice::new(4);
    let cube: Vec<_> = (0..65_535).map(|_| [dice.signed(), dice.signed(), dice.signed()]).collect();
    assert!(solver.prepare_hull(&cube[1..], &mut words, None).is_ok());
    assert_eq!(solver.prepare_hull(&cube, &mut words, None).unwrap_err(), GraphError::Points);
}

#[test]
fn memory_of_the_documented_size_suffices_for_the_worst_order() {
    // A double pyramid: the last apex sees half of all facets.
    for count in [5usize, 50, 1000] {
        let base = (0..count - 2).map(|k| {
            let (sin, cos) = (core::f64::consts::TAU * k as f64 / (count - 2) as f64).sin_cos();
            [cos, sin, 0.0]
        });
        for height in [1e-6, 1.0, 1e6] {
            let points: Vec<_> = base.clone().chain([[0.0, 0.0, 1.0], [0.0, 0.0, -height]]).collect();
            let mut words = vec![0u16; graph_len(count)];
            let mut facets = vec![HullFacet::EMPTY; hull_facets(count) - 4];
            prepare_hull(&points, &mut words, &mut facets, None).unwrap();
            let facets = &mut facets[1..];
            assert_eq!(prepare_hull(&points, &mut words, facets, None).unwrap_err(), GraphError::Capacity);
        }
    }
    let words = &mut [0u16; 12];
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
    let facets = &mut [HullFacet::EMPTY; 4];
    assert_eq!(prepare_hull(&corners, words, facets, None).unwrap_err(), GraphError::Words);
}

#[test]
fn a_deadline_is_asked_while_a_hull_is_prepared() {
    let count = 20_000;
    let mut dice = Dice::new(8);
    let sphere: Vec<_> = (0..count).map(|_| direction(&mut dice)).collect();
    let (mut words, mut facets) = (vec![0u16; graph_len(count)], vec![HullFacet::EMPTY; hull_facets(count)]);
    let asked = Cell::new(0);
    for left in [0, 1, 10, 100, 1000, usize::MAX] {
        asked.set(0);
        let interrupt = || {
            asked.set(asked.get() + 1);
            asked.get() > left
        };
        let graph = prepare_hull(&sphere, &mut words, &mut facets, Some(&interrupt));
        assert_eq!(graph.err(), (left < usize::MAX).then_some(GraphError::Interrupted));
        assert!(asked.get() > left.min(1000));
    }
}

#[test]
fn lists_that_overlap_cost_no_more_than_the_points() {
    // Vertex i's list is 65,535 words long, has i + 1 in it, and nothing that is higher.
    let count = 16_000usize;
    let points: Vec<_> = (0..count).map(|i| [i as f32, (i % 7) as f32, (i % 11) as f32]).collect();
    let mut words = vec![1, count as u16, 0];
    words.extend((0..count).map(|i| (count - i) as u16));
    for block in 0..=count + (1 << 14) {
        let vertex = (count + 1).saturating_sub(block).min(count - 1) as u16;
        words.extend([u16::MAX, vertex, vertex, vertex]);
    }
    let graph = HullGraph::from_words(&words).unwrap();
    for i in 0..count - 1 {
        let highest = graph.neighbors(i as u16).iter().filter(|&&v| usize::from(v) < count).max();
        assert_eq!((graph.neighbors(i as u16).len(), highest), (65_535, Some(&(i as u16 + 1))));
    }
    let hull = Hull::new(&points, graph).unwrap();
    let start = Instant::now();
    for k in 0..200 {
        let u = Vector::from([1.0, k as f32 * 1e-4, 0.0]);
        assert_eq!(hull.support(&u), hull.exhaustive(&u).map(|(p, _)| p));
    }
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

/// A graph in which vertices lead up one by one, through lists that overlap and are as long as a word of 16 bits can say. Vertex i is as high as `rank[i]`.
fn overlapping<W: Word>(dice: &mut Dice, rank: &[usize]) -> Vec<W> {
    let (count, word) = (rank.len(), |x: usize| W::from_position(x).unwrap_or(W::EMPTY));
    let mut upwards = vec![0; count];
    rank.iter().enumerate().for_each(|(vertex, &rank)| upwards[rank] = vertex);
    // A list's length, which is no vertex, the next one up, and some that are lower. What follows is the lists of those below, and then more of the lowest.
    let chunk = W::BLOCK.max(2);
    let longest = dice.pick(&[1 << 12, 1 << 14, 65_535]);
    let mut words = vec![word(1), word(count), word(upwards[0])];
    words.extend(rank.iter().map(|&rank| word((count - rank) * chunk / W::BLOCK)));
    for k in 0..=count + longest / chunk {
        let next = (count + 1).saturating_sub(k).min(count - 1);
        words.push(word(count + 1 + dice.below(longest - count)));
        words.push(word(upwards[next]));
        words.extend((2..chunk).map(|_| word(upwards[dice.below(next + 1)])));
    }
    words
}

/// What a support call costs, beside a scan of all points: a graph may make it longer by a factor that is the same for any number of points.
fn no_dearer_than_points<T: Real, W: Word>(seed: u64, graphs: usize) {
    let mut dice = Dice::new(seed);
    let (mut climbing, mut scanning) = (Duration::ZERO, Duration::ZERO);
    for case in 0..graphs {
        let count = 200 + dice.below(2000);
        let mut rank: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            rank.swap(i, dice.below(i + 1));
        }
        let mut place = |i: usize| [rank[i] as f64 + 0.4 * dice.unit(), (i % 7) as f64, (i % 11) as f64].map(T::of);
        let points: Vec<[T; 3]> = (0..count).map(&mut place).collect();
        // Chains through lists that overlap, and words that mean nothing.
        let nonsense = case % 4 == 3;
        let words: Vec<W> = if nonsense {
            let header = [4, count].map(|x| W::from_position(x).unwrap());
            let random = (0..8 * count).map(|_| W::from_position(dice.below(2 * count)).unwrap());
            header.into_iter().chain(random).collect()
        } else {
            overlapping(&mut dice, &rank)
        };
        let hull = Hull::new(&points, HullGraph::from_words(&words).unwrap()).unwrap();
        for _ in 0..8 {
            let [y, z] = [0; 2].map(|_| T::of(0.02 * dice.signed()));
            let u = Vector::from(if nonsense { direction(&mut dice).map(T::of) } else { [T::one(), y, z] });
            let start = Instant::now();
            let (climbed, between) = (hull.support(&u).unwrap(), Instant::now());
            let scanned = hull.exhaustive(&u).unwrap().0;
            (climbing, scanning) = (climbing + (between - start), scanning + between.elapsed());
            assert!(points.contains(&climbed.into()), "{case}");
            assert!(nonsense || climbed == scanned, "{case}: {climbed} {scanned}");
        }
    }
    println!("{climbing:?} with graphs, {scanning:?} without");
    // 25 products a point instead of one; without a bound it is thousands, and half a minute. (Some seconds are for whatever else the machine does.)
    let most = 200 * scanning + Duration::from_secs(5);
    assert!(climbing < most, "{climbing:?} with graphs, {scanning:?} without");
}

#[test]
fn no_graph_makes_a_hull_dearer_than_its_points() {
    no_dearer_than_points::<f32, u16>(31, 120);
    no_dearer_than_points::<f64, u32>(32, 120);
}

/// Hulls of more points than 16 bits promise, few of which are vertices: both widths of words have the same graph, and climbing it is as good as a scan (tried
/// of some, which costs more than the graph).
#[test]
fn any_number_of_points_up_to_what_words_can_number() {
    let mut dice = Dice::new(33);
    let mut memory = Memory::new::<f32, 3>(4, 65_535);
    let mut solver = memory.solver::<f32, 3>();
    let (mut words, mut wide) = (vec![0; graph_len(65_535)], vec![0; large_graph_len(100_000)]);
    let mut facets = vec![HullFacet::EMPTY; hull_facets(100_000)];
    let mut beyond = 0;
    for case in 0..100 {
        let count = match case % 8 {
            0 => dice.pick(&[26_214, 26_215, 30_000, 30_001, 65_533, 65_534, 65_535, 65_536, 100_000]),
            1 => 65_535 + dice.below(1000),
            _ => 26_215 + dice.below(8000),
        };
        // A few random points, and others between them: deep inside (which is cheap), or nearly as far out.
        let inside = if case % 25 == 24 { 0.99 } else { 0.1 };
        let few = unit_cloud(&mut dice, case / 2 % 2, 12 + case % 20);
        let between = |dice: &mut Dice| {
            let [p, q] = [0; 2].map(|_| few[dice.below(few.len())]);
            let t = dice.unit();
            [0, 1, 2].map(|i| (p[i] + t * (q[i] - p[i])) * inside)
        };
        let mut points: Vec<_> = (few.len()..count).map(|_| between(&mut dice).map(|x| x as f32)).collect();
        for p in &few {
            points.insert(dice.below(points.len()), p.map(|x| x as f32));
        }
        let large = prepare_hull(&points, &mut wide, &mut facets, None).unwrap();
        assert!(case % 4 > 0 || worst_climb(&points, large, &mut dice, 1) <= 1.0, "{case} {count}");
        let small = solver.prepare_hull(&points, &mut words, None);
        if count < 65_535 {
            let small = small.unwrap();
            let same =
                |i: u32| small.neighbors(i as u16).iter().map(|&v| u32::from(v)).eq(large.neighbors(i).iter().copied());
            assert!((0..count as u32).all(same), "{case} {count}");
        } else {
            assert_eq!(small.unwrap_err(), GraphError::Points, "{case} {count}");
            beyond += 1;
        }
    }
    assert!(beyond >= 12);
}
