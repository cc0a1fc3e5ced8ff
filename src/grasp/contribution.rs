//! What a contact or a finger adds to a wrench set.

use crate::math::{Vector, largest};
use crate::scalar::Real;
use crate::support::{Failure, Support};

/// What one contact, or one finger, contributes to a wrench set: W_i, a compact convex set of wrenches (paper, eq. 6), by its support function.
///
/// [`Primitive`](super::Primitive) is the one of a single contact with a friction cone, [`Finger`](super::Finger) that of contacts with joints. Implement it for a model of your own: the [`Support`] is enough.
/// Its [`radius`](Support::radius) must be 0.
pub trait Contribution<T: Real>: Support<T, 6> {
    /// h_i(u) and the point, if h_i(u) > `floor`; `u` is near unit length. The value is within [`error`](Support::error) |u| of the true one.
    ///
    /// # Errors
    /// Those of the support function.
    fn support_above(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
        let point = self.support(u)?;
        let value = point.dot(u);
        Ok((value > floor).then_some((value, point)))
    }

    /// Is it provably the set `other` with coordinates multiplied by `signs`, each 1 or -1? False means that it is not known.
    fn is_mirror_of(&self, _other: &Self, _signs: &Vector<T, 6>) -> bool {
        false
    }
}

/// A positive multiple of `u` that is not far from unit length; `u` itself if it is.
#[inline]
pub(super) fn near_unit<T: Real>(u: &Vector<T, 6>) -> Vector<T, 6> {
    let far = T::count(16);
    let largest = largest(u);
    // Divided by, not multiplied with the reciprocal: that overflows for subnormal numbers.
    if largest < far && largest * far > T::one() || !(largest > T::zero()) { *u } else { u.map(|x| x / largest) }
}
