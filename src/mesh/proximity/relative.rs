//! The relative pose of a pair.
//!
//! All boxes of A share one rotation relative to all boxes of B, so R, |R| and the error bound of a query are computed
//! once. Two boxes with centres at distance d (in either frame) and half extents a, b leave between them, per axis, the gap
//!
//! ```text
//! frame of B:  |d| - b - |R| a          frame of A:  |R^T d| - a - |R|^T b
//! ```
//!
//! and the length of the positive gaps of one frame is a lower bound of the distance.

use super::super::Mesh;
use super::super::bvh::Node;
use super::super::pose::normalised;
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};

/// One query's relative pose.
#[derive(Clone, Debug)]
pub(super) struct Relative {
    rotation: Matrix3<f64>,
    absolute: Matrix3<f64>,
    translation: Vector3<f64>,
    /// Bound of the rounding error of a point of A in the frame of B, together with that of a point of B.
    pub doubt: f64,
}

impl Relative {
    pub fn new(pose: &Isometry3<f64>, a: &Mesh, b: &Mesh) -> Relative {
        let rotation = *normalised(pose).rotation.to_rotation_matrix().matrix();
        let translation = pose.translation.vector;
        let doubt = 16.0 * f64::EPSILON * (3.0 * a.scale() + translation.amax() + b.scale());
        Relative { absolute: rotation.abs(), rotation, translation, doubt }
    }

    pub fn rotation(&self) -> &Matrix3<f64> {
        &self.rotation
    }

    pub fn translation(&self) -> &Vector3<f64> {
        &self.translation
    }

    /// A point of A in the frame of B.
    #[inline]
    pub fn place(&self, p: &Point3<f64>) -> Point3<f64> {
        (self.rotation * p.coords + self.translation).into()
    }

    /// A triangle of A in the frame of B.
    #[inline]
    pub fn place_all(&self, triangle: &[Point3<f64>; 3]) -> [Point3<f64>; 3] {
        triangle.map(|p| self.place(&p))
    }

    /// A point of B in the frame of A.
    pub fn place_back(&self, p: &Point3<f64>) -> Point3<f64> {
        self.rotation.tr_mul(&(p.coords - self.translation)).into()
    }

    /// A direction of A in the frame of B.
    pub fn turn(&self, u: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * u
    }

    /// A direction of B in the frame of A.
    pub fn turn_back(&self, u: &Vector3<f64>) -> Vector3<f64> {
        self.rotation.tr_mul(u)
    }

    /// A lower bound of the squared distance of two boxes, or any number above `enough` when it is larger than that.
    #[inline]
    pub fn bound(&self, a: &Node, b: &Node, enough: f64) -> f64 {
        let d = self.rotation * a.centre + self.translation - b.centre;
        let gap = |x: Vector3<f64>| {
            let x = Vector3::new((x.x - self.doubt).max(0.0), (x.y - self.doubt).max(0.0), (x.z - self.doubt).max(0.0));
            x.norm_squared()
        };
        let in_b = gap(d.abs() - b.half - self.absolute * a.half);
        if in_b > enough {
            return in_b;
        }
        let d_a = self.rotation.tr_mul(&d);
        let in_a = gap(d_a.abs() - a.half - self.absolute.tr_mul(&b.half));
        // Along d itself, which no axis of the boxes may be near to: (|d|^2 - |d|.b - |R^T d|.a) / |d|.
        let size = d.norm_squared();
        let along = size * (1.0 - 16.0 * f64::EPSILON)
            - d.abs().dot(&b.half.add_scalar(self.doubt))
            - d_a.abs().dot(&a.half.add_scalar(self.doubt));
        let along = if along > 0.0 { along * along / size } else { 0.0 };
        in_b.max(in_a).max(along)
    }
}
