//! The generalized penetration depth of meshes.
#![cfg(feature = "mesh")]

mod common;
mod mesh_common;

use mesh_common::*;
use nalgebra::{Isometry3, Vector3};
use qdist::mesh::{DepthOptions, DepthSolver, Model, Outcome};

fn model(shape: &Shape) -> Model {
    Model::new(&shape.vertices, &shape.triangles).unwrap()
}

#[test]
fn free_bodies_have_a_distance_instead() {
    let cube = model(&cuboid([0.5; 3]));
    let mut solver = DepthSolver::new(&cube, &cube);
    let pose = Isometry3::from_parts(Vector3::new(0.0, 0.1, 1.25).into(), Default::default());
    let depth = solver.depth(&pose, cube.disp(), &DepthOptions::default(), None);
    assert_eq!((depth.outcome, depth.lower, depth.upper, depth.pose), (Outcome::Separated, 0.0, 0.0, pose));
    assert!((depth.distance.unwrap().distance - 0.25).abs() < 1e-12);
}
