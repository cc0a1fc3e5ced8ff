//! Margins of the solver's own rounding. A set's stated error is larger than they are nearly always, and hides it when one is missing; so here sets are exact:
//! points with integer coordinates, chosen without error, `error` 0, and d a quotient of integers. Or their error is as large as a support function's may be,
//! and always to the same side. `scripts/margins.py` takes the margins away one by one, and some test here fails each time.

use crate::common;

use common::dd::Dd;
use common::dice::Dice;
use common::lattice::{
    Lattice, Lean, Leaning, Point, ball, crossing, cuboid, exact, moved, slab, symmetric, truth, truth_in_plane,
};
use nalgebra::Matrix3;
use qdist::internal::{Axes, Bounds};
use qdist::qset::{Ball, Segment, UnitBox, UnitEllipsoid, UnitSet, Vertices};
use qdist::support::BoxShape;
use qdist::{Answer, Options, Outcome, Plan, Real, Tracker, Vector, Workspace};

fn holds<T: Real>(answer: &Answer<T, 3>, d: Dd, what: &str) {
    let (lower, upper) = (Dd::new(answer.lower.to_f64()), Dd::new(answer.upper.to_f64()));
    assert!(lower <= d && d <= upper, "{what}: {d:?} is not in [{lower:?}, {upper:?}] {:?}", answer.outcome);
}

/// So many cases, or more: MORE=100 searches for what a hundred times as many would show.
fn cases(few: usize) -> std::ops::Range<usize> {
    0..few * std::env::var("MORE").ok().and_then(|n| n.parse().ok()).unwrap_or(1)
}

/// Answers by plan.
#[derive(Debug, Default)]
struct Plans([usize; 4]);

impl Plans {
    fn count<T: Real>(&mut self, answer: &Answer<T, 3>) {
        let of = [Plan::Expansion, Plan::Rays, Plan::Cones, Plan::Distance];
        for (n, plan) in self.0.iter_mut().zip(of) {
            *n += usize::from(answer.plan == plan);
        }
    }
}

/// Puts one query in all ways.
fn ask<T: Real>(set: &Lattice, q: &dyn UnitSet<T, 3>, d: Dd, what: &str, plans: &mut Plans) {
    let what = format!("{what} {set:?}");
    let mut large = Workspace::<T, 3, 64, 128>::new();
    // Without a tolerance the run ends where rounding does.
    let exactly = Options { relative: T::zero(), ..Options::default() };
    let roughly = Options { relative: T::of(0.1), ..exactly };
    for options in [exactly, Options::default(), roughly] {
        let answer = large.solver().solve(set, q, &options);
        holds(&answer, d, &what);
        plans.count(&answer);
        holds(&large.solver().solve_by_expansion(set, q, &options), d, &format!("by expansion {what}"));
    }
    // Too small for the polytope: cone by cone.
    let few = Options { relative: T::of(1e-3), ..Options::default() };
    let answer = Workspace::<T, 3, 9, 12>::new().solver().solve(set, q, &few);
    holds(&answer, d, &format!("in little memory {what}"));
    plans.count(&answer);
    // No room for a polytope: rays, where Q has vertices.
    for options in [exactly, Options::default(), roughly] {
        let answer = Workspace::<T, 3, 4, 6>::new().solver().solve(set, q, &options);
        holds(&answer, d, &format!("in the least memory {what}"));
        plans.count(&answer);
    }
    let mut tracker = Tracker::new();
    for _ in 0..2 {
        let answer = large.solver().solve_warm(&mut tracker, set, q, Some(T::zero()), &exactly);
        holds(&answer, d, &format!("warm {what}"));
    }
}

/// Sets Q: a box and an ellipsoid of these half axes, in units of a power of two; the box as its corners too. With their h of integer vectors.
struct Units<T> {
    cuboid: UnitBox<T, 3>,
    corners: Vec<[T; 3]>,
    round: UnitEllipsoid<T, 3>,
    half: Point,
    unit: f64,
}

impl<T: Real> Units<T> {
    fn new(half: Point, unit: f64) -> Self {
        let axes = half.map(|x| T::of(x as f64 * unit));
        let corner = |s: usize| std::array::from_fn(|i| if s >> i & 1 == 1 { axes[i] } else { -axes[i] });
        let cuboid = UnitBox::new(Vector::from(axes)).unwrap();
        let round = UnitEllipsoid::new(Vector::from(axes), Matrix3::identity()).unwrap();
        Units { cuboid, corners: (0..8).map(corner).collect(), round, half, unit }
    }

    fn random(dice: &mut Dice) -> Self {
        Units::new(std::array::from_fn(|_| 1 + dice.below(9) as i64), dice.pick(&[0.0625, 1.0, 16.0]))
    }

    /// `d` gives the d of an h; `ask` is told each Q, its d, and its name.
    fn each(&self, d: impl Fn(&dyn Fn(&[i128; 3]) -> Dd) -> Dd, mut ask: impl FnMut(&dyn UnitSet<T, 3>, Dd, &str)) {
        let half = self.half;
        let as_round =
            |n: &[i128; 3]| (0..3).map(|i| exact(n[i] * i128::from(half[i]))).fold(Dd::ZERO, |s, x| s + x * x).sqrt();
        // Outside, Q has no say.
        let [of_box, of_round] =
            [d(&cuboid(half)), d(&as_round)].map(|d| if d > Dd::ZERO { d / Dd::new(self.unit) } else { d });
        let name = |kind: &str| format!("{kind} {half:?} {}", self.unit);
        ask(&self.cuboid, of_box, &name("box"));
        ask(&Vertices::new(&self.corners).unwrap(), of_box, &name("points"));
        ask(&self.round, of_round, &name("ellipsoid"));
    }
}

/// Puts the query with all kinds of Q.
fn ask_all<T: Real>(set: &Lattice, units: &Units<T>, case: usize, plans: &mut Plans) {
    let d = |value: &dyn Fn(&[i128; 3]) -> Dd| truth(&set.points, value) * Dd::new(set.unit);
    ask(set, &Ball::<T>::unit(), d(&ball) + Dd::new(set.radius), &format!("{case} ball"), plans);
    units.each(d, |q, d, name| ask(set, q, d, &format!("{case} {name}"), plans));
}

/// d / R is near 1.
fn compact_sets<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let mut plans = Plans::default();
    for case in cases(200) {
        let set = Lattice::new(symmetric(&mut dice, [40; 3]));
        ask_all::<T>(&set, &Units::random(&mut dice), case, &mut plans);
    }
    assert!(plans.0[..3].iter().all(|&n| n > 10), "{plans:?}");
}

/// Thin sets: d is a few hundred roundoffs of R.
fn thin_sets<T: Real>(seed: u64, sizes: [f64; 2]) {
    let mut dice = Dice::new(seed);
    let mut plans = Plans::default();
    for case in cases(200) {
        let size = dice.decade(sizes[0].log10(), sizes[1].log10());
        let set = Lattice::new(slab(&mut dice, size));
        ask_all::<T>(&set, &Units::random(&mut dice), case, &mut plans);
    }
    assert!(plans.0[..3].iter().all(|&n| n > 10), "{plans:?}");
}

#[test]
fn compact_f64() {
    compact_sets::<f64>(1);
}

#[test]
fn compact_f32() {
    compact_sets::<f32>(2);
}

#[test]
fn thin_f64() {
    thin_sets::<f64>(3, [20.0, 3e6]);
}

#[test]
fn thin_f32() {
    thin_sets::<f32>(4, [20.0, 600.0]);
}

/// A ray's weights of 0, which rounding makes negative, are no weights of a point of A. (In the least memory rays alone answer.)
#[test]
fn a_ray_through_an_edge() {
    let corners = [[74, 40, 122], [-59, 55, 94], [-76, 76, 86], [-40, 148, 60]];
    let set = Lattice::new(corners.into_iter().flat_map(|p: Point| [p, p.map(|x| -x)]).collect());
    ask_all::<f32>(&set, &Units::new([3, 4, 5], 1.0), 0, &mut Plans::default());
}

/// Thin sets whose rays' crossings are off by more than the heights' own rounding.
fn crossings_off<T: Real>(corners: &[Point], units: [Point; 2], unit: f64) {
    let set = Lattice::new(corners.iter().flat_map(|&p| [p, p.map(|x| -x)]).collect());
    for half in units {
        ask_all::<T>(&set, &Units::new(half, unit), 0, &mut Plans::default());
    }
}

#[test]
fn crossings_off_f64() {
    let corners = [
        [2535, 43138, 513],
        [223, 25708, 306],
        [-1534, 51212, 610],
        [1926, 8771, 104],
        [-2363, 16841, 201],
        [2750, 302, 3],
    ];
    crossings_off::<f64>(&corners, [[4, 5, 4], [4, 4, 4]], 1.0);
}

#[test]
fn crossings_off_f32() {
    let corners = [[24, 130, 21], [-11, -32, -5], [3, 84, 14], [-10, -157, -26], [-10, 135, 23]];
    crossings_off::<f32>(&corners, [[6, 5, 9], [6, 5, 8]], 16.0);
}

/// The origin is outside by less than the set's error, and seems inside: of a Q that is wide, d >= (e - m) / h would be more than minus the distance.
#[test]
fn the_origin_is_outside_by_less_than_the_error() {
    for thin in [2.0, 8.0, 32.0] {
        let q = UnitBox::new(Vector::from([64.0, thin, 0.0])).unwrap();
        for lean in [0.6, 0.75, 1.0, 1.25] {
            for lean in [Lean::By(lean), Lean::ByAxis([8.0, lean, 8.0]), Lean::ByAxis([0.01, lean, 9.0])] {
                let corner = |s: usize| [[-50, 60][s & 1], [-40, -1][s >> 1 & 1], [-70, 45][s >> 2]];
                let points = (0..8).map(corner).collect();
                let by_axis = matches!(lean, Lean::ByAxis(_));
                let set = Lattice { unit: 0.5, lean, by_axis, ..Lattice::new(points) };
                for relative in [0.0, 1e-6, 0.1] {
                    let options = Options { relative, ..Options::default() };
                    let mut memory = Workspace::<f64, 3, 64, 128>::new();
                    let answer = memory.solver().solve_by_expansion(&set, &q, &options);
                    holds(&answer, Dd::new(-0.5), &format!("by expansion {thin} {set:?}"));
                    holds(&memory.solver().solve(&set, &q, &options), Dd::new(-0.5), &format!("{thin} {set:?}"));
                }
            }
        }
    }
}

/// Somewhere around the origin: inside, outside, or at a vertex up to a few units.
fn placed(dice: &mut Dice, points: &[Point], near: i64) -> Vec<Point> {
    let aside =
        |dice: &mut Dice, by: i64| -> Point { std::array::from_fn(|_| dice.below(2 * by as usize + 1) as i64 - by) };
    match dice.below(4) {
        0 => moved(points, aside(dice, 40 * near)),
        1 | 2 => {
            let by = aside(dice, near);
            moved(&moved(points, points[0].map(|x| -x)), by)
        }
        _ => points.to_vec(),
    }
}

/// Support points are off as far as they may be, inwards or outwards.
#[test]
fn sets_that_lean() {
    let mut dice = Dice::new(5);
    let mut plans = Plans::default();
    for case in cases(200) {
        let points = symmetric(&mut dice, [160, 160, 40]);
        let points = placed(&mut dice, &points, 4);
        let lean = Lean::By(dice.pick(&[-1.0, 1.0]) * dice.decade(-1.5, 1.0));
        let set = Lattice { lean, ..Lattice::new(points) };
        ask_all::<f64>(&set, &Units::random(&mut dice), case, &mut plans);
    }
    assert!(plans.0[..3].iter().all(|&n| n > 10), "{plans:?}");
}

/// Support points are off by nearly 16 N roundoffs of the set's size: as the default of sets allows, where their extent is unknown or stated too large.
#[test]
fn sets_that_lean_by_rounding() {
    let mut dice = Dice::new(6);
    let mut plans = Plans::default();
    for case in cases(200) {
        let size = dice.decade(1.3, 2.3);
        let lean = Lean::Share(dice.pick(&[-44.0, 44.0]) * f64::from(f32::ROUNDOFF));
        let loose = dice.pick(&[0.0, 1e3]);
        let set = Lattice { lean, loose, ..Lattice::new(slab(&mut dice, size)) };
        ask_all::<f32>(&set, &Units::random(&mut dice), case, &mut plans);
    }
}

/// Q's values and vertices are off as far as they may be.
#[test]
fn units_that_lean() {
    let mut dice = Dice::new(7);
    let mut plans = Plans::default();
    for case in cases(200) {
        let points = symmetric(&mut dice, [160, 160, 40]);
        let set = Lattice::new(placed(&mut dice, &points, 4));
        let units = Units::<f64>::random(&mut dice);
        let by = dice.pick(&[-1.0, 1.0]) * dice.decade(-3.0, -0.5) * units.unit;
        let d = |value: &dyn Fn(&[i128; 3]) -> Dd| truth(&set.points, value);
        units.each(d, |unit, d, name| ask(&set, &Leaning { unit, by }, d, &format!("{case} {by} {name}"), &mut plans));
    }
    assert!(plans.0[..3].iter().all(|&n| n > 10), "{plans:?}");
}

/// Long and flat along the axes, and known axis by axis.
fn floors<T: Real>(seed: u64, long: f64) {
    let mut dice = Dice::new(seed);
    let mut plans = Plans::default();
    for case in cases(200) {
        let half = dice.decade(2.0, long) as i64;
        let points = symmetric(&mut dice, [half, half, 16]);
        let points = placed(&mut dice, &points, 2);
        let e = dice.pick(&[-1.0, 1.0]) * dice.decade(-2.0, 0.5);
        let lean = dice.pick(&[Lean::None, Lean::ByAxis([e, e, 0.0]), Lean::ByAxis([e, e, e * 0.01])]);
        let set = Lattice { lean, by_axis: true, ..Lattice::new(points) };
        ask_all::<T>(&set, &Units::random(&mut dice), case, &mut plans);
        let set = Lattice { radius: dice.decade(0.0, 2.0).round(), ..set };
        let d = truth(&set.points, ball) + Dd::new(set.radius);
        ask(&set, &Ball::<T>::unit(), d, &format!("{case} under a ball"), &mut plans);
    }
}

#[test]
fn floors_f64() {
    floors::<f64>(8, 6.0);
}

#[test]
fn floors_f32() {
    floors::<f32>(9, 4.0);
}

/// Points, segments and triangles beside the origin, known better along some axes than along others.
#[test]
fn few_points_beside_the_origin() {
    let mut dice = Dice::new(10);
    let mut plans = Plans::default();
    for case in cases(1000) {
        let long = 2 + dice.below(60) as i64;
        let flat = case % 3 == 0;
        let points: Vec<Point> = (0..1 + dice.below(3))
            .map(|_| {
                std::array::from_fn(|i| dice.below([long, long, 9][i] as usize * 2 + 1) as i64 - [long, long, 9][i])
            })
            .map(|p: Point| if flat { [p[0], p[1], 0] } else { p })
            .collect();
        let side = dice.pick(&[-1.0, 1.0]);
        let e = [dice.decade(-1.0, 1.0), dice.decade(-2.0, 1.0), 0.0].map(|e| e * side);
        let set = Lattice { lean: Lean::ByAxis(e), by_axis: true, ..Lattice::new(points) };
        let d = truth(&set.points, ball);
        ask(&set, &Ball::<f64>::unit(), d, &format!("{case}"), &mut plans);
        // Cores apart, bodies perhaps not.
        let set = Lattice { radius: dice.decade(0.0, 2.0).round(), ..set };
        ask(&set, &Ball::<f64>::unit(), d + Dd::new(set.radius), &format!("{case} ball"), &mut plans);
        let set = Lattice { lean: Lean::None, ..set };
        ask(&set, &Ball::<f32>::unit(), d + Dd::new(set.radius), &format!("{case} f32"), &mut plans);
    }
}

/// A ball around a small core: what is rounded is the ball.
#[test]
fn large_balls_around_small_cores() {
    let mut dice = Dice::new(11);
    let mut plans = Plans::default();
    for case in cases(200) {
        let points = symmetric(&mut dice, [9; 3]);
        let points = placed(&mut dice, &points, 2);
        let set = Lattice { radius: dice.decade(2.0, 7.0).round(), ..Lattice::new(points) };
        let d = truth(&set.points, ball) + Dd::new(set.radius);
        let three = Ball::new(3.0).unwrap();
        ask::<f64>(&set, &Ball::unit(), d, &format!("{case}"), &mut plans);
        ask::<f32>(&set, &Ball::unit(), d, &format!("{case} f32"), &mut plans);
        ask::<f64>(&set, &three, d / Dd::new(3.0), &format!("{case} radius 3"), &mut plans);
        ask::<f32>(&set, &Ball::new(3.0).unwrap(), d / Dd::new(3.0), &format!("{case} radius 3, f32"), &mut plans);
    }
}

/// A segment from a corner of the set, which tells that the corner is in it: no ball around the origin is, only some along the segment.
fn segments_from_a_corner<T: Real>(seed: u64, long: i64) {
    let mut dice = Dice::new(seed);
    let (mut plans, mut proved) = (Plans::default(), 0);
    for case in cases(400) {
        let mut points: Vec<Point> = (0..4 + dice.below(4))
            .map(|_| [1 + dice.below(long as usize) as i64, dice.below(41) as i64 - 20, dice.below(41) as i64 - 20])
            .collect();
        // Inside the cone, or along its boundary.
        let count = 2 + dice.below(3);
        let end: Point = std::array::from_fn(|i| points[..count].iter().map(|p| p[i]).sum());
        points.push([0; 3]);
        let Some(d) = crossing(&points, &[end]) else { continue };
        let e = dice.pick(&[-1.0, 1.0]) * dice.decade(-4.0, -1.0);
        let lean = dice.pick(&[Lean::None, Lean::By(e)]);
        let set = Lattice { lean, ..Lattice::new(points) };
        let q = Segment::new(Vector::from(end.map(|x| T::of(x as f64)))).unwrap();
        ask(&set, &q, d, &format!("{case} {end:?}"), &mut plans);
        let answer = Workspace::<T, 3, 4, 6>::new().solver().solve(&set, &q, &Options::default());
        proved += usize::from(answer.lower > T::zero());
        let unit = &q;
        let by = dice.pick(&[-1.0, 1.0]) * dice.decade(-3.0, -0.5);
        ask(&set, &Leaning { unit, by: T::of(by) }, d, &format!("{case} {end:?} by {by}"), &mut plans);
    }
    assert!(plans.0[1] > 100 && proved > 100, "{plans:?} {proved}");
}

#[test]
fn segments_from_a_corner_f64() {
    segments_from_a_corner::<f64>(21, 40);
    segments_from_a_corner::<f64>(22, 100_000);
}

#[test]
fn segments_from_a_corner_f32() {
    segments_from_a_corner::<f32>(23, 40);
    segments_from_a_corner::<f32>(24, 1000);
}

/// A ball in a box, which it meets at the corners: d = r / |corner|. It has a core, across one of the diagonals.
fn balls_in_boxes<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    for case in cases(200) {
        let half: Point = std::array::from_fn(|_| 1 + dice.below(9) as i64);
        let across = [half[1], -half[0], 0];
        let set = Lattice { radius: dice.decade(1.0, 6.0).round(), ..Lattice::new(vec![across, across.map(|x| -x)]) };
        let square: i64 = half.iter().map(|x| x * x).sum();
        let d = Dd::new(set.radius) / exact(i128::from(square)).sqrt();
        let axes = half.map(|x| T::of(x as f64));
        let mut memory = Workspace::<T, 3, 64, 128>::new();
        let cuboid = UnitBox::new(Vector::from(axes)).unwrap();
        for relative in [0.1, 1e-3, 1e-6] {
            let options = Options { relative: T::of(relative), ..Options::default() };
            let answer = memory.solver().solve_by_expansion(&set, &cuboid, &options);
            holds(&answer, d, &format!("{case} by expansion"));
            let answer = memory.solver().solve(&set, &cuboid, &Options { max_iterations: Some(100), ..options });
            holds(&answer, d, &format!("{case}"));
        }
    }
}

#[test]
fn balls_in_boxes_f64() {
    balls_in_boxes::<f64>(19);
}

#[test]
fn balls_in_boxes_f32() {
    balls_in_boxes::<f32>(20);
}

/// Answers so small that they are no normal numbers.
#[test]
fn subnormal_answers() {
    let mut dice = Dice::new(12);
    let mut plans = Plans::default();
    for case in cases(200) {
        let set = Lattice { unit: 2f64.powi(-100), ..Lattice::new(symmetric(&mut dice, [40; 3])) };
        let radius = 2f64.powi(35 + (case % 8) as i32);
        let d = truth(&set.points, ball) * Dd::new(set.unit / radius);
        ask(&set, &Ball::new(radius as f32).unwrap(), d, &format!("{case}"), &mut plans);
    }
}

/// Sets in a plane through the origin, thin in it or not.
fn sets_in_planes<T: Real>(seed: u64, step: usize) {
    let mut dice = Dice::new(seed);
    for case in cases(600) {
        let mut axis = || -> Point { std::array::from_fn(|_| dice.below(21) as i64 - 10) };
        let (a, mut b) = (axis(), axis());
        if case % 4 == 0 {
            b = std::array::from_fn(|i| b[i] + a[i] * dice.below(step) as i64);
        }
        let flat: Vec<[i64; 2]> = symmetric(&mut dice, [9, 9, 0]).iter().map(|p| [p[0], p[1]]).collect();
        let points: Vec<Point> = flat.iter().map(|p| std::array::from_fn(|i| p[0] * a[i] + p[1] * b[i])).collect();
        let Some(d) = truth_in_plane(&points, ball) else { continue };
        let lean = if case % 3 == 0 { Lean::By(dice.pick(&[-1.0, 1.0]) * dice.decade(-3.0, -1.0)) } else { Lean::None };
        if let Lean::By(e) = lean
            && !(d > Dd::new(16.0 * e.abs()))
        {
            continue; // As far as the set tells, it is a line.
        }
        let set = Lattice { lean, ..Lattice::new(points) };
        let mut units = Units::<T>::random(&mut dice);
        if case % 2 == 0 {
            // Far from round.
            let mut half = units.half;
            half[case / 2 % 3] *= 1000;
            units = Units::new(half, units.unit);
        }
        let mut memory = Workspace::<T, 3, 64, 128>::new();
        let options = Options { relative: T::zero(), ..Options::default() };
        let mut ask = |q: &dyn UnitSet<T, 3>, d: Dd, name: &str| {
            let answer = memory.solver().solve_in_span(&set, q, &options);
            let what = format!("{case} {name} {} {set:?}", answer.dimension);
            // (What a leaning set spans is known up to its error: it may be found to be space, where d is 0.)
            let d = if answer.dimension == 3 && set.lean != Lean::None { Dd::ZERO } else { d };
            holds(&answer, d, &what);
        };
        ask(&Ball::unit(), truth_in_plane(&set.points, ball).unwrap(), "ball");
        if set.lean == Lean::None {
            let answer = Workspace::<T, 3, 64, 128>::new().solver().solve(&set, &Ball::unit(), &options);
            holds(&answer, Dd::ZERO, "in space");
            assert_eq!(answer.outcome, Outcome::Degenerate, "{set:?}");
        }
        units.each(|value| truth_in_plane(&set.points, value).unwrap(), ask);
    }
}

/// The plane is known up to the set's error, and what a long Q says of it even less.
#[test]
fn a_leaning_plane_under_a_long_unit() {
    let corners = [[0, 45, 27], [0, -38, -42], [0, 7, 49], [0, -59, -61], [0, -93, -107]];
    let points: Vec<Point> = corners.into_iter().flat_map(|p: Point| [p, p.map(|x| -x)]).collect();
    let set = Lattice { lean: Lean::By(-0.0216), ..Lattice::new(points) };
    Units::<f32>::new([5000, 3, 3], 0.0625).each(
        |value| truth_in_plane(&set.points, value).unwrap(),
        |q, d, name| {
            let options = Options { relative: 0.0, ..Options::default() };
            let answer = Workspace::<f32, 3, 64, 128>::new().solver().solve_in_span(&set, q, &options);
            holds(&answer, d, name);
        },
    );
}

#[test]
fn planes_f64() {
    sets_in_planes::<f64>(13, 10_000);
}

#[test]
fn planes_f32() {
    sets_in_planes::<f32>(14, 20);
}

/// What is left of a lower bound after a move.
fn moves<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    for _ in cases(20_000) {
        let inner = T::of(dice.decade(-3.0, 3.0));
        let lower = T::of(dice.decade(-3.0, 3.0) * dice.pick(&[1.0, 1.0, -1.0]));
        let near = lower.to_f64().abs() * inner.to_f64() * dice.decade(-2.0, 0.3);
        let moved = T::of(dice.pick(&[near, dice.clone().decade(-3.0, 3.0), 0.0]));
        let tracker = Tracker::<T, 3> { lower: Some(lower), ..Tracker::new() };
        let left = Dd::new(tracker.lower_after(moved, &Ball::new(inner).unwrap()).unwrap().to_f64());
        let [inner, lower, moved] = [inner, lower, moved].map(|x| Dd::new(x.to_f64()));
        // Below 0, the less favourable of both units.
        let truth = if lower > Dd::ZERO {
            let rest = lower - moved / inner;
            if rest < Dd::ZERO { rest.min(rest * inner) } else { rest }
        } else {
            lower - (moved / inner).max(moved)
        };
        assert!(left <= truth, "{left:?} {truth:?}: {lower:?} {moved:?} {inner:?}");
    }
}

#[test]
fn moves_f64() {
    moves::<f64>(15);
}

#[test]
fn moves_f32() {
    moves::<f32>(16);
}

/// A lower bound that turns out to be none costs no answer.
#[test]
fn a_floor_that_is_disproved() {
    let mut dice = Dice::new(17);
    for _ in cases(100) {
        let set = Lattice::new(symmetric(&mut dice, [40; 3]));
        let d = truth(&set.points, ball);
        if !(d > Dd::new(1.0)) {
            continue;
        }
        let mut tracker = Tracker::<f64, 3> { lower: Some(d.to_f64() * dice.range(1.5, 9.0)), ..Tracker::new() };
        let mut memory = Workspace::<f64, 3, 64, 128>::new();
        let answer = memory.solver().solve_warm(&mut tracker, &set, &Ball::unit(), Some(0.0), &Options::default());
        holds(&answer, d, "disproved");
        assert_eq!(answer.outcome, Outcome::Converged);
    }
}

/// A lower bound that is known, of a plate so thin for its size that the bound is below the normal numbers in units of the size.
#[test]
fn a_floor_below_the_normal_numbers() {
    for step in 0..40 {
        let thin = f64::from(8 + step) / 8.0 * 2f64.powi(-119);
        let plate = BoxShape::new(Vector::from([2f32.powi(30), 2f32.powi(30), thin as f32])).unwrap();
        let mut tracker = Tracker::<f32, 3> { lower: Some(thin as f32), ..Tracker::new() };
        let mut memory = Workspace::<f32, 3, 64, 128>::new();
        let answer = memory.solver().solve_warm(&mut tracker, &plate, &Ball::unit(), Some(0.0), &Options::default());
        holds(&answer, Dd::new(thin), &format!("{step}"));
    }
}

/// Margins by direction are no less than they are said to be.
#[test]
fn margins_by_direction() {
    let mut dice = Dice::new(18);
    for _ in cases(2000) {
        let n = Vector::from(dice.direction::<3>().map(|x| x as f32));
        let mut lengths = || Vector::from(std::array::from_fn::<f32, 3, _>(|_| dice.decade(-3.0, 3.0) as f32));
        let axes = Axes { errors: lengths(), reach: lengths() };
        let along =
            |x: &Vector<f32, 3>| (0..3).fold(Dd::ZERO, |s, i| s + Dd::product(f64::from(n[i].abs()), f64::from(x[i])));
        let truth = along(&axes.errors) + along(&axes.reach) * Dd::new(10.0 * f64::from(f32::ROUNDOFF));
        assert!(Dd::new(f64::from(axes.margin(&n))) >= truth, "{axes:?} {n:?}", axes = (axes.errors, axes.reach));
    }
}

/// An upper bound below zero, with an h_Q that is off.
#[test]
fn a_negative_height_over_a_unit_that_leans() {
    let bounds = Bounds { support_error: 0.0, radius: 0.0, dimension: 3, unknown_extent: false };
    assert!(bounds.upper(-1.0, 0.0, 1.0, 0.25) >= -1.0 / 1.25);
    assert!(bounds.upper(1.0, 0.0, 1.0, 0.25) >= 1.0 / 0.75);
}

/// Q says nothing about a direction, up to its error: the height there, which is 0, bounds nothing.
#[test]
fn a_unit_without_extent_along_a_face() {
    let corners: Vec<Point> = (0..8).map(|s| [[-3, 5][s & 1], [-7, 4][s >> 1 & 1], [-6, 0][s >> 2]]).collect();
    let set = Lattice::new(corners);
    let flat = UnitBox::new(Vector::from([1.0, 2.0, 0.0])).unwrap();
    let mut memory = Workspace::<f64, 3, 64, 128>::new();
    for by in [0.0, 1e-9, -1e-9] {
        let answer = memory.solver().solve(&set, &Leaning { unit: &flat, by }, &Options::default());
        assert!(answer.upper >= 2.0 && answer.upper < 2.1 && answer.lower <= 2.0, "{} {}", answer.lower, answer.upper);
    }
}
