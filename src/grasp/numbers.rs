//! Which numbers are accepted.

use super::ContactError;
use crate::scalar::Real;

/// The default relative tolerance of ranks: 1e-9 in `f64`. In `f32`, where the entries of a Jacobian are known to 6e-8 at
/// best, 64 roundoffs, 3.8e-6.
///
/// ```
/// assert_eq!(qdist::grasp::default_tolerance::<f64>(), 1e-9);
/// ```
pub fn default_tolerance<T: Real>() -> T {
    T::of(1e-9).at_least(T::count(64) * T::ROUNDOFF)
}

/// A rank tolerance is between 16 roundoffs, what the arithmetic can tell apart, and 1/2.
pub(super) fn check_tolerance<T: Real>(tolerance: T) -> Result<(), ContactError> {
    if tolerance >= T::count(16) * T::ROUNDOFF && tolerance <= T::of(0.5) {
        Ok(())
    } else {
        Err(ContactError::Tolerance)
    }
}

/// The largest number that is accepted: products of two are far from overflow. 4.5e15 in `f32`, 1.4e146 in `f64`.
pub(super) fn ceiling<T: Real>() -> T {
    (T::HUGE * T::ROUNDOFF).root()
}

/// All finite and not too large. NaN fails the comparison.
pub fn usable<'a, T: Real>(mut numbers: impl Iterator<Item = &'a T>) -> bool {
    numbers.all(|x| x.abs() <= ceiling())
}
