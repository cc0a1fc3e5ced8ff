//! The length of the translation between two poses of equal rotation: every metric's value there, and a quadratic one.

use crate::mesh::metric::{BodyFrame, Metric};
use crate::mesh::optimize::Quadratic;
use nalgebra::{Isometry3, Matrix6, Vector3, Vector6};

pub(super) struct Translation {
    pub frame: BodyFrame,
}

impl Translation {
    fn between(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> Vector3<f64> {
        to * self.frame.centre - from * self.frame.centre
    }
}

impl Metric for Translation {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        self.between(from, to).norm()
    }

    fn frame(&self) -> &BodyFrame {
        &self.frame
    }

    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        let moved = self.between(from, at);
        let axes = at.rotation.to_rotation_matrix().into_inner() * self.frame.axes;
        let along = axes.tr_mul(&moved);
        // Turning wins nothing.
        let gradient = Vector6::new(along.x, along.y, along.z, 0.0, 0.0, 0.0);
        Quadratic { value: moved.norm_squared(), gradient, hessian: Matrix6::identity() }
    }
}
