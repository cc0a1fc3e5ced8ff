//! The ways to search the boundary of the free space, against each other.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use mesh_common::*;
use nalgebra::{Isometry3, Vector3};
use qdist::mesh::metric::Metric;
use qdist::mesh::{DepthOptions, DepthSolver, Model, Pair, Walk};

const WALKS: [Walk; 3] = [Walk::Linearised, Walk::Branching, Walk::Sampling];

fn model(shape: &Shape) -> Model {
    Model::new(&shape.vertices, &shape.triangles).unwrap()
}

/// With corners on corners, notches, curved surfaces, and a polygon soup.
#[test]
fn every_walk_has_a_free_pose_that_is_about_as_near_and_the_same_again() {
    let mut dice = Dice::new(8);
    for (a, b) in [
        (l_shape(), l_shape().moved([-0.5, -0.5, 0.0])),
        (tetrahedron(), cuboid([0.5; 3])),
        (torus(16, 8, 0.5, 0.15), l_shape()),
        (tetrahedron(), cuboid([0.5; 3]).without(0)),
    ] {
        let (a, b) = (model(&a), model(&b));
        let (mut solver, mut pair) = (DepthSolver::new(&a, &b), Pair::new(a.mesh(), b.mesh()));
        let mut metrics: Vec<&dyn Metric> = vec![a.disp()];
        metrics.extend(a.sigma().map(|sigma| sigma as &dyn Metric));
        let mut count = 0;
        while count < 4 {
            let pose = random_pose(&mut dice, 0.5);
            if !pair.collides(&pose) {
                continue;
            }
            count += 1;
            for &metric in &metrics {
                let mut ask = |walk| {
                    let options = DepthOptions { walk, ..Default::default() };
                    let answer = solver.depth(&pose, metric, &options, None);
                    assert!(!pair.collides(&answer.pose) && metric.distance(&pose, &answer.pose) == answer.upper);
                    answer
                };
                let values = WALKS.map(|walk| ask(walk).upper);
                let least = values.into_iter().fold(f64::INFINITY, f64::min);
                assert!(values.iter().all(|value| *value <= 1.25 * least), "{values:?}");
                // Whatever was asked before.
                assert_eq!(WALKS.map(|walk| ask(walk).upper), values);
            }
        }
    }
}

/// The translational depth of a corner below an edge is to either face, whichever walk.
#[test]
fn a_corner_below_an_edge_leaves_to_a_face() {
    let (a, b) = (model(&tetrahedron().moved([0.0, -0.25, 0.0])), model(&cuboid([0.5, 2.0, 0.5])));
    // The tetrahedron's right angle points into the box from its edge at x = z = 1/2.
    let (x, z) = (0.04, 0.06);
    let pose = Isometry3::from_parts(Vector3::new(0.5 - x, 0.0, 0.5 - z).into(), Default::default());
    for walk in WALKS {
        let options = DepthOptions { walk, ..Default::default() };
        let found = DepthSolver::new(&a, &b).depth(&pose, a.disp(), &options, None);
        // Of convex bodies the depth is that of a translation.
        let worse = if walk == Walk::Sampling { 1e-2 } else { 1e-5 };
        assert!(found.upper >= x - 1e-12 && found.upper <= x * (1.0 + worse), "{walk:?} {}", found.upper);
    }
}
