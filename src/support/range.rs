//! The few lines of careful arithmetic that all shapes share: which sizes are usable, and which directions.
//!
//! A direction need not be a unit vector, and its squares may leave the range of the format. Each shape
//! tests one sum that it has at hand, and takes a rescaled direction in a cold path when it is out of range. That
//! branch is always predicted; scaling every direction would cost a division.

use super::ShapeError;
use crate::math::load::one_by_one;
use crate::math::{Vector, largest, magnitude, norm};
use crate::scalar::Real;

/// Squares and products below this lose digits to underflow: 8e-31 in `f32`, 8e-292 in `f64`.
#[inline(always)]
pub(super) fn floor<T: Real>() -> T {
    T::of(16.0) / (T::HUGE * T::ROUNDOFF)
}

/// The largest size: sums of many of them, even times 1/ROUNDOFF, stay finite.
#[inline(always)]
fn ceiling<T: Real>() -> T {
    T::HUGE * T::ROUNDOFF
}

/// `size` >= 0 with the sign bit of `x`: bit masks only.
#[inline(always)]
pub(crate) fn signed<T: Real>(size: T, x: T) -> T {
    size.copysign(x)
}

/// A list of sizes is usable: each finite, not too large, >= 0.
#[inline(always)]
pub fn check_sizes<'a, T: Real>(sizes: impl Iterator<Item = &'a T> + Clone) -> Result<(), ShapeError> {
    // NaN and infinity fail the comparisons, so there is no test for them. All are compared before the one branch.
    let usable = sizes.clone().fold(true, |all, &x| all & (x >= T::zero()) & (x <= ceiling()));
    if usable { Ok(()) } else { Err(wrong_size(sizes)) }
}

#[cold]
fn wrong_size<'a, T: Real>(sizes: impl Iterator<Item = &'a T>) -> ShapeError {
    let first = sizes.copied().find(|&x| !(x >= T::zero() && x <= ceiling()));
    if first.is_some_and(|x| x < T::zero() && x.finite()) { ShapeError::Negative } else { ShapeError::NonFinite }
}

/// A list of coordinates is usable: each finite and not too large.
#[inline]
pub fn check_numbers<'a, T: Real>(mut numbers: impl Iterator<Item = &'a T>) -> Result<(), ShapeError> {
    // NaN and infinity fail the comparison, so there is no test for them.
    if numbers.all(|&x| magnitude(x) <= ceiling()) { Ok(()) } else { Err(ShapeError::NonFinite) }
}

/// Do products of `u` with coordinates of size up to `size` neither overflow nor lose digits that count?
#[inline(always)]
pub(crate) fn in_range<T: Real, const N: usize>(u: &Vector<T, N>, size: T) -> bool {
    let s = u.iter().fold(-T::zero(), |s, &x| s + magnitude(x)) * size;
    s > floor() && s < ceiling()
}

/// A positive multiple of `u` for which [`in_range`] holds (unless `u` or `size` is zero). In and out by value and one by one, so
/// that the callers' `u` stays in registers on the usual path.
#[inline(always)]
pub(crate) fn rescaled<T: Real, const N: usize>(u: Vector<T, N>, size: T) -> Vector<T, N> {
    one_by_one(&rescaled_out_of_line(u, size))
}

#[cold]
#[inline(never)]
fn rescaled_out_of_line<T: Real, const N: usize>(u: Vector<T, N>, size: T) -> Vector<T, N> {
    let m = largest(&u);
    if m > T::zero() {
        // Divided by, not multiplied with 1/m: that overflows for subnormal m.
        let r = T::ROUNDOFF * T::ROUNDOFF;
        let lift = if size < T::one() { T::one() / (r * r) } else { T::one() };
        u.map(|x| x / m * lift)
    } else {
        u
    }
}

/// A direction for points of usual sizes: `u` itself if it is not far from unit length, else a multiple that is.
#[inline(always)]
pub fn near_unit<T: Real, const N: usize>(u: Vector<T, N>) -> Vector<T, N> {
    let s = u.iter().fold(-T::zero(), |s, &x| s + magnitude(x));
    let far = T::count(1 << 16);
    if s < far && s * far > T::one() { u } else { rescaled(u, T::one()) }
}

/// An upper bound of |v|, tight to a few roundoffs, for every finite `v`.
#[inline]
pub(crate) fn length<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    above(norm(v), N)
}

/// Slightly more than `x`: covers a result of `n` additions and a few other operations.
#[inline(always)]
pub(crate) fn above<T: Real>(x: T, n: usize) -> T {
    x * (T::one() + T::count(n + 8) * T::ROUNDOFF)
}
