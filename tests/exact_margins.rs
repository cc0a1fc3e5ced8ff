//! Margins of the solver's own rounding. A set's stated error is larger than they are nearly always, and hides it when one is missing; so here sets are exact:
//! points with small integer coordinates, chosen without error, `error` 0, and d a quotient of integers. Without a margin some bracket of these is false.

mod common;

use common::dd::Dd;
use common::dice::Dice;
use qdist::qset::{Ball, BoxGauge, Gauge, Vertices};
use qdist::support::{Failure, Support};
use qdist::{Options, Plan, Real, Tracker, Vector, Workspace};

type Point = [i64; 3];

/// The hull of integer points.
struct Exact(Vec<Point>);

impl<T: Real> Support<T, 3> for Exact {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        // Products of 53 and 7 bits: exact in two words.
        let height = |p: &Point| (0..3).fold(Dd::new(0.0), |s, i| s + Dd::product(u[i].to_f64(), p[i] as f64));
        let far = self.0.iter().reduce(|a, b| if height(b) > height(a) { b } else { a });
        Ok(Vector::from(far.unwrap().map(|x| T::of(x as f64))))
    }
    fn extent(&self) -> T {
        T::of(self.0.iter().map(|p| (p.iter().map(|x| x * x).sum::<i64>() as f64).sqrt()).fold(0.0, f64::max) * 1.01)
    }
    fn error(&self) -> T {
        T::zero()
    }
}

/// Supporting planes n.x <= k of the hull, by trying all triples: integers.
fn planes(points: &[Point]) -> Vec<(Point, i64)> {
    let dot = |a: &Point, b: &Point| (0..3).map(|i| a[i] * b[i]).sum::<i64>();
    let minus = |a: &Point, b: &Point| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let mut found = Vec::new();
    for i in 0..points.len() {
        for j in 0..i {
            for k in 0..j {
                let (a, b) = (minus(&points[j], &points[i]), minus(&points[k], &points[i]));
                let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                for n in [n, n.map(|x| -x)] {
                    let offset = dot(&n, &points[i]);
                    if n != [0; 3] && points.iter().all(|p| dot(&n, p) <= offset) {
                        found.push((n, offset));
                    }
                }
            }
        }
    }
    found
}

/// d of the unit ball and of a box: the least of k / h_Q(n) over all facets.
fn truths(points: &[Point], half: [i64; 3]) -> (Dd, Dd) {
    let exact = |x: i64| Dd::new(x as f64);
    planes(points).iter().fold((Dd::new(f64::MAX), Dd::new(f64::MAX)), |(ball, cuboid), (n, k)| {
        let squared: i64 = n.iter().map(|x| x * x).sum();
        let value: i64 = (0..3).map(|i| n[i].abs() * half[i]).sum();
        (ball.min(exact(*k) / exact(squared).sqrt()), cuboid.min(exact(*k) / exact(value)))
    })
}

fn holds<T: Real>(lower: T, upper: T, d: Dd, what: &str) {
    let (lower, upper) = (Dd::new(lower.to_f64()), Dd::new(upper.to_f64()));
    assert!(lower <= d && d <= upper, "{what}: {d:?} is not in [{lower:?}, {upper:?}]");
}

fn run<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let mut plans = [0; 3];
    for case in 0..400 {
        let mut points: Vec<Point> = (0..4 + dice.below(3))
            .map(|_| std::array::from_fn(|_| dice.below(81) as i64 - 40))
            .flat_map(|p: Point| [p, p.map(|x| -x)])
            .collect();
        points.dedup();
        let half: Point = std::array::from_fn(|_| 1 + dice.below(9) as i64);
        let (ball, cuboid) = truths(&points, half);
        if !(ball > Dd::new(0.5)) {
            continue; // flat, or nearly
        }
        let set = Exact(points);
        // No tolerance: the run ends where rounding does.
        let options = Options { relative: T::zero(), ..Options::default() };
        let what = format!("{case} {:?} {half:?}", set.0);
        let half = half.map(|x| T::of(x as f64));
        let corners: Vec<[T; 3]> =
            (0..8).map(|s| std::array::from_fn(|i| if s >> i & 1 == 1 { half[i] } else { -half[i] })).collect();
        let (unit, as_box) = (Ball::unit(), BoxGauge::new(Vector::from(half)).unwrap());
        let as_points = Vertices::new(&corners).unwrap();
        let gauges: [(&dyn Gauge<T, 3>, Dd, &str); 3] =
            [(&unit, ball, "ball"), (&as_box, cuboid, "box"), (&as_points, cuboid, "points")];
        for (q, d, name) in gauges {
            let mut large = Workspace::<T, 3, 64, 128>::new();
            let answer = large.solver().solve(&set, q, &options);
            holds(answer.lower, answer.upper, d, &format!("{name} {what}"));
            plans[0] += usize::from(answer.plan == Plan::Expansion);
            // Rays end where the tolerance is met.
            let answer = large.solver().solve(&set, q, &Options::default());
            holds(answer.lower, answer.upper, d, &format!("{name} by default {what}"));
            plans[1] += usize::from(answer.plan == Plan::Rays);
            let answer = large.solver().solve_by_expansion(&set, q, &options);
            holds(answer.lower, answer.upper, d, &format!("{name} by expansion {what}"));
            // Too small for the polytope: cone by cone.
            let few = Options { relative: T::of(1e-3), ..options };
            let answer = Workspace::<T, 3, 9, 12>::new().solver().solve(&set, q, &few);
            holds(answer.lower, answer.upper, d, &format!("{name} in little memory {what}"));
            plans[2] += usize::from(answer.plan == Plan::Cones);
            let mut tracker = Tracker::new();
            for _ in 0..2 {
                let answer = large.solver().solve_warm(&mut tracker, &set, q, T::zero(), &options, None);
                holds(answer.lower, answer.upper, d, &format!("{name} warm {what}"));
            }
        }
    }
    assert!(plans.iter().all(|&n| n > 20), "{plans:?}");
}

#[test]
fn exact_sets_are_answered_rightly_f64() {
    run::<f64>(1);
}

#[test]
fn exact_sets_are_answered_rightly_f32() {
    run::<f32>(2);
}
