//! Which poses queries accept, and what they mean.
//!
//! A quaternion that was rounded to single precision on its way, or has been multiplied a million times, is of unit length only nearly. As a
//! matrix it would scale A by its square, and products with points would shear it, so what it means is fixed here, once: the rotation of
//! the quaternion over its length.

use super::MAX_COORDINATE;
use nalgebra::{Isometry3, UnitQuaternion};

/// How much a quaternion's length may differ from 1.
const UNIT: f64 = 1e-6;

/// Finite, with a translation of at most [`MAX_COORDINATE`], and a rotation.
pub(super) fn is_usable(pose: &Isometry3<f64>) -> bool {
    (pose.rotation.quaternion().norm() - 1.0).abs() <= UNIT
        && pose.translation.vector.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

/// A usable pose with a quaternion of unit length: the same bits where it is that already, to rounding. Any other pose as it is.
pub(super) fn normalised(pose: &Isometry3<f64>) -> Isometry3<f64> {
    let squared = pose.rotation.quaternion().norm_squared();
    if (squared - 1.0).abs() <= 8.0 * f64::EPSILON || !is_usable(pose) {
        return *pose;
    }
    Isometry3::from_parts(pose.translation, UnitQuaternion::new_normalize(pose.rotation.into_inner()))
}
