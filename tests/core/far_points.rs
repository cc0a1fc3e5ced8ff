//! Sets of unknown extent, whose error is 16 N u times the largest norm of a point that was seen: one point is far away, and may be seen late. Whatever was
//! concluded before must then be concluded anew. Truths by integer arithmetic: the least crossing of the rays along the vertices of Q.
use crate::common;

use common::dd::Dd;
use common::dice::Dice;
use common::lattice::{Lattice, Lean, Point, crossing};
use common::memory::Memory;
use qdist::qset::Vertices;
use qdist::support::{Failure, Support};
use qdist::{Options, Real, Vector};
use std::cell::Cell;

/// Integer points, told with an error, as large as a set of unknown extent may make it for its farthest point; and the largest norm that was seen.
struct Off {
    set: Lattice,
    seen: Cell<f64>,
}

impl<T: Real> Support<T, 3> for Off {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let point = Support::<T, 3>::support(&self.set, u)?;
        self.seen.set(self.seen.get().max(point.dot(&point).root().to_f64()));
        Ok(point)
    }
    fn contains_origin(&self) -> bool {
        true
    }
}

fn ask<T: Real>(points: Vec<Point>, vertices: &[Point], far: f64, what: &str) -> usize {
    let Some(d) = crossing(&points, vertices) else { return 0 };
    let list: Vec<[T; 3]> = vertices.iter().map(|v| v.map(|x| T::of(x as f64))).collect();
    let Ok(q) = Vertices::new(&list) else { return 0 };
    let mut set = Off { set: Lattice::new(points), seen: Cell::new(0.0) };
    let (mut least, mut asked) = (Memory::new::<T, 3>(4, 6), 0);
    for sign in [1.0, -1.0] {
        for relative in [T::RELATIVE_TOLERANCE, T::of(1e-3), T::of(0.3)] {
            for max_iterations in [None, Some(500)] {
                set.set.lean = Lean::By(sign * 40.0 * T::ROUNDOFF.to_f64() * far);
                set.seen.set(0.0);
                let options = Options { relative, max_iterations, ..Options::default() };
                let answer = least.solver::<T, 3>().solve(&set, &q, &options);
                if set.seen.get() < 0.9 * far {
                    continue; // (The error is more than the set may have, as far as anybody has seen.)
                }
                asked += 1;
                let (lower, upper) = (Dd::new(answer.lower.to_f64()), Dd::new(answer.upper.to_f64()));
                let found = format!("[{:?}, {:?}] {:?} {:?}", answer.lower, answer.upper, answer.outcome, answer.plan);
                assert!(lower <= d && d <= upper, "{what} {sign} {relative:?}: {:e} {found}", d.to_f64());
            }
        }
    }
    asked
}

/// The lower bound of the rays was false: the margin was taken before the balls around the origin were looked for, which met the far point.
#[test]
fn a_far_point_that_is_met_after_the_rays() {
    let near = [
        [-12, 8, 9],
        [-7, -17, -5],
        [-6, 1, 9],
        [10, 10, -14],
        [7, -3, 5],
        [-13, -12, -14],
        [-11, 15, -5],
        [-14, -4, -5],
    ];
    let points = [&near[..], &[[-8498, 1940, -4899], [0; 3]]].concat();
    assert!(ask::<f32>(points, &[[11, 17, 2]], 1e4, "one vertex") > 0);
    let near =
        [[5, -11, 3], [16, 13, 5], [8, 10, -8], [-17, 6, 3], [7, -14, -4], [8, 0, -16], [-11, 16, -5], [16, 18, 6]];
    let points = [&near[..], &[[-3649, 1636, 9165]]].concat();
    assert!(ask::<f32>(points, &[[19, -9, -17], [-6, 3, -20], [-14, 16, -15]], 1e4, "three vertices") > 0);
}

/// The upper bound was false: the origin was taken to be outside when the far point had not been met.
#[test]
fn a_far_point_that_is_met_after_the_origin_seemed_outside() {
    let near = [
        [0, 17, -4],
        [0, 15, -12],
        [-16, 9, -14],
        [-9, -20, 16],
        [-11, -6, 9],
        [-15, 6, 16],
        [-4, -9, 20],
        [-4, 17, 13],
    ];
    let points = [&near[..], &[[-124_723, -822_496, 554_926], [0; 3]]].concat();
    assert!(ask::<f64>(points, &[[-6, 15, 11], [-17, 1, -7]], 1e6, "two vertices") > 0);
}

fn far_points<T: Real>(seed: u64, far: f64) {
    let mut dice = Dice::new(seed);
    let mut asked = 0;
    for case in 0..4000 {
        let mut near = |count: usize| -> Vec<Point> {
            (0..count).map(|_| std::array::from_fn(|_| dice.below(41) as i64 - 20)).collect()
        };
        let (mut points, vertices) = (near(8), near(3));
        points.push(dice.direction::<3>().map(|x| (x * far) as i64));
        if dice.chance(0.5) {
            points.push([0; 3]);
        }
        let count = 1 + dice.below(3);
        asked += ask::<T>(points, &vertices[..count], far, &format!("case {case}"));
    }
    assert!(asked > 1000, "{asked}");
}

#[test]
fn points_far_away_f64() {
    far_points::<f64>(5, 1e6);
}

#[test]
fn points_far_away_f32() {
    far_points::<f32>(6, 1e4);
}
