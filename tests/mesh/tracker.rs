//! The warm query: true brackets along paths, free poses, budgets, merged answers, jumps.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use mesh_common::*;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use qdist::mesh::metric::Metric;
use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, MeshDepth, Model, Outcome, Pair};
use std::cell::Cell;

fn model(shape: &Shape) -> Model {
    Model::new(&shape.vertices, &shape.triangles).unwrap()
}

fn certified(shape: &Shape) -> Model {
    model(shape).with_pieces(&Default::default()).unwrap()
}

/// Updates, and checks what every answer promises.
fn update(tracker: &mut DepthTracker, pose: &Isometry3<f64>, metric: &dyn Metric, budget: &Budget) -> MeshDepth {
    let answer = tracker.update(pose, metric, budget, None);
    assert!(0.0 <= answer.lower && answer.lower <= answer.upper, "{answer:?}");
    let solver = tracker.solver();
    let mut pair = Pair::new(solver.a().mesh(), solver.b().mesh());
    assert!(answer.upper.is_finite() && !pair.collides(&answer.pose), "{answer:?}");
    if pair.collides(pose) {
        assert_ne!(answer.outcome, Outcome::Separated);
        assert_eq!(metric.distance(pose, &answer.pose), answer.upper);
    } else {
        assert_eq!((answer.outcome, answer.upper, answer.pose), (Outcome::Separated, 0.0, *pose));
    }
    answer
}

/// A path of a constant twist.
fn along(from: &Isometry3<f64>, velocity: Vector3<f64>, spin: Vector3<f64>, tick: u32) -> Isometry3<f64> {
    let s = f64::from(tick);
    Isometry3::from_parts(
        Translation3::from(from.translation.vector + velocity * s),
        UnitQuaternion::from_scaled_axis(spin * s) * from.rotation,
    )
}

fn total(answer: &MeshDepth) -> u64 {
    answer.counters.collision + answer.counters.contact + answer.counters.distance
}

/// For convex bodies the largest displacement has an exact value, which the certificate and the cold query both have.
#[test]
fn brackets_of_boxes_contain_the_depth() {
    let mut dice = Dice::new(3);
    let (a, b) = (certified(&cuboid([0.6, 0.5, 0.4])), certified(&cuboid([1.0, 0.7, 0.4])));
    let mut cold = DepthSolver::new(&a, &b);
    let mut ratios = vec![];
    for _ in 0..4 {
        let from = random_pose(&mut dice, 0.8);
        let (velocity, spin) = (random_pose(&mut dice, 0.01).translation.vector, Vector3::new(0.003, 0.002, -0.003));
        let mut tracker = DepthTracker::new(&a, &b);
        for tick in 0..100 {
            let pose = along(&from, velocity, spin, tick);
            let answer = update(&mut tracker, &pose, a.disp(), &Budget::default());
            if tick % 9 == 0 && answer.outcome != Outcome::Separated {
                let exact = cold.depth(&pose, a.disp(), &DepthOptions::default(), None);
                assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?} {exact:?}");
                ratios.push(answer.upper / exact.upper);
            }
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios.len() > 10 && ratios[ratios.len() / 2] < 1.05, "{ratios:?}");
}

/// A cube that sinks into a larger one: its depth is what it sank, for both metrics.
#[test]
fn a_cube_that_sinks_keeps_its_depth() {
    let (a, b) = (certified(&cuboid([0.5; 3])), certified(&cuboid([2.0; 3])));
    for metric in [a.disp() as &dyn Metric, a.sigma().unwrap()] {
        let mut tracker = DepthTracker::new(&a, &b);
        for tick in 0..150 {
            let pose = Isometry3::translation(0.2, -0.1, 2.6 - 2e-3 * f64::from(tick));
            let answer = update(&mut tracker, &pose, metric, &Budget::default());
            let depth = 2e-3 * f64::from(tick) - 0.1;
            if depth > 1e-3 {
                assert!(answer.lower <= depth * (1.0 + 1e-9), "{tick} {answer:?}");
                assert!(answer.upper <= depth * 1.05 + 1e-3, "{tick} {depth} {answer:?}");
            } else if depth < -1e-3 {
                assert!((answer.distance.unwrap().distance + depth).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn concave_bodies_are_tracked_near_the_cold_answer() {
    let (a, b) = (certified(&l_shape()), certified(&torus_knot(48, 8, 0.25)));
    let from = Isometry3::translation(-0.9, -0.7, 0.1);
    let (velocity, spin) = (Vector3::new(2e-3, -1e-3, 1e-3), Vector3::new(2e-3, 1e-3, -3e-3));
    for metric in [a.disp() as &dyn Metric, a.sigma().unwrap()] {
        let (mut tracker, mut cold) = (DepthTracker::new(&a, &b), DepthSolver::new(&a, &b));
        let mut ratios = vec![];
        for tick in 0..120 {
            let pose = along(&from, velocity, spin, tick);
            let answer = update(&mut tracker, &pose, metric, &Budget::default());
            if tick % 12 == 11 && answer.outcome != Outcome::Separated {
                let cold = cold.depth(&pose, metric, &DepthOptions::default(), None);
                assert!(answer.lower <= cold.upper && cold.lower <= answer.upper);
                ratios.push(answer.upper / cold.upper);
                assert!(tracker.merge(&cold));
            }
        }
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[ratios.len() / 2] < 1.1, "{ratios:?}");
    }
}

#[test]
fn budgets_hold() {
    let (a, b) = (model(&l_shape()), model(&torus_knot(48, 8, 0.25)));
    let from = Isometry3::translation(-0.9, -0.7, 0.1);
    for max_queries in [0, 1, 2, 3, 5, 8, 13, 40] {
        let mut tracker = DepthTracker::new(&a, &b);
        let budget = Budget { max_queries, ..Budget::default() };
        for tick in 0..60 {
            let pose = along(&from, Vector3::new(2e-3, -1e-3, 1e-3), Vector3::new(2e-3, 1e-3, -3e-3), tick);
            let answer = update(&mut tracker, &pose, a.sigma().unwrap(), &budget);
            let escape = if tick == 0 { 6 } else { 0 };
            assert!(total(&answer) <= max_queries.max(1) + escape, "{tick} {max_queries} {answer:?}");
        }
    }
}

/// A clock that is late from the n-th look on: no query follows, and the bracket is true.
#[test]
fn no_query_begins_when_it_is_late() {
    let (a, b) = (certified(&l_shape()), certified(&torus_knot(48, 8, 0.25)));
    let from = Isometry3::translation(-0.9, -0.7, 0.1);
    let mut tracker = DepthTracker::new(&a, &b);
    update(&mut tracker, &from, a.disp(), &Budget::default());
    for tick in 1..60 {
        let pose = along(&from, Vector3::new(2e-3, -1e-3, 1e-3), Vector3::zeros(), tick);
        let looks = Cell::new(0);
        let late = || {
            looks.set(looks.get() + 1);
            looks.get() > tick % 8
        };
        let answer = tracker.update(&pose, a.disp(), &Budget::default(), Some(&late));
        assert!(answer.lower <= answer.upper && answer.upper.is_finite());
        assert!(total(&answer) <= 1 + u64::from(tick % 8), "{tick} {answer:?}");
    }
}

#[test]
fn a_merged_answer_is_taken_if_it_is_free_and_better() {
    let (a, b) = (model(&cuboid([0.5; 3])), model(&cuboid([2.0; 3])));
    let pose = Isometry3::translation(0.0, 0.3, 1.9);
    let tight = Budget { max_queries: 1, ..Budget::default() };
    let mut tracker = DepthTracker::new(&a, &b);
    let first = update(&mut tracker, &pose, a.disp(), &tight);
    let cold = DepthSolver::new(&a, &b).depth(&pose, a.disp(), &DepthOptions::default(), None);
    assert!(tracker.merge(&cold));
    let merged = update(&mut tracker, &pose, a.disp(), &tight);
    assert!(merged.upper <= cold.upper && merged.upper <= first.upper);
    // One that is not free is refused, whatever it claims.
    assert!(!tracker.merge(&MeshDepth { pose, upper: 0.0, ..cold }));
    assert!(update(&mut tracker, &pose, a.disp(), &tight).upper > 0.5);
}

/// The certificate used to come last, after the outcome was settled: a closed bracket was called `Budget`, and all queries were spent.
#[test]
fn a_closed_bracket_converges_within_any_budget() {
    let shape = cuboid([0.5; 3]);
    let body = certified(&shape);
    let pose = Isometry3::translation(0.05, 0.1, 0.9);
    let cold = DepthSolver::new(&body, &body).depth(&pose, body.disp(), &DepthOptions::default(), None);
    assert_eq!(cold.outcome, Outcome::Converged);
    for max_queries in [1, 16] {
        let mut tracker = DepthTracker::new(&body, &body);
        tracker.merge(&cold);
        let warm = update(&mut tracker, &pose, body.disp(), &Budget { max_queries, ..Budget::default() });
        assert_eq!(warm.outcome, Outcome::Converged, "{warm:?}");
        assert_eq!(total(&warm), 1);
    }
}

#[test]
fn jumps_and_returns_keep_the_bracket_true() {
    let (a, b) = (certified(&l_shape()), certified(&torus_knot(48, 8, 0.25)));
    let mut dice = Dice::new(11);
    let (mut tracker, mut cold) = (DepthTracker::new(&a, &b), DepthSolver::new(&a, &b));
    let mut separated = 0;
    for jump in 0..40 {
        let pose = random_pose(&mut dice, if jump % 3 == 0 { 6.0 } else { 0.8 });
        for metric in [a.disp() as &dyn Metric, a.sigma().unwrap()] {
            let answer = update(&mut tracker, &pose, metric, &Budget::default());
            if answer.outcome == Outcome::Separated {
                separated += 1;
            } else if jump % 4 == 1 {
                let cold = cold.depth(&pose, metric, &DepthOptions::default(), None);
                assert!(answer.lower <= cold.upper && cold.lower <= answer.upper, "{answer:?} {cold:?}");
            }
        }
    }
    assert!(separated > 5);
}

#[test]
fn the_same_path_has_the_same_answers() {
    let (a, b) = (certified(&l_shape()), certified(&torus_knot(48, 8, 0.25)));
    let from = Isometry3::translation(-0.9, -0.7, 0.1);
    let mut tracker = DepthTracker::new(&a, &b);
    let mut run = || {
        tracker.reset();
        let ticks = (0..40).map(|tick| along(&from, Vector3::new(2e-3, -1e-3, 1e-3), Vector3::zeros(), tick));
        let answers = ticks.map(|pose| tracker.update(&pose, a.disp(), &Budget::default(), None));
        answers.map(|answer| (answer.lower, answer.upper, answer.pose)).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[test]
fn improper_poses_are_invalid_and_change_nothing() {
    let a = model(&cuboid([0.5; 3]));
    let mut tracker = DepthTracker::new(&a, &a);
    let pose = Isometry3::translation(0.0, 0.0, 0.9);
    let before = update(&mut tracker, &pose, a.disp(), &Budget::default());
    let wrong = Isometry3::translation(f64::NAN, 0.0, 0.0);
    assert_eq!(tracker.update(&wrong, a.disp(), &Budget::default(), None).outcome, Outcome::Invalid);
    let budget = Budget { relative: f64::NAN, ..Budget::default() };
    assert_eq!(tracker.update(&pose, a.disp(), &budget, None).outcome, Outcome::Invalid);
    assert!(update(&mut tracker, &pose, a.disp(), &Budget::default()).upper <= before.upper);
}
