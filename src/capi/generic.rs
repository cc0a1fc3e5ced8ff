//! What the entry points of both scalars share: checked pointers, callbacks as sets and gauges, and loops over run-time
//! dimensions.

use super::status::{
    Check, QDIST_ERROR_ALIGNMENT, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_NONFINITE, QDIST_ERROR_NULL,
    QDIST_ERROR_STRUCT_SIZE, from_shape,
};
use crate::qset::Gauge;
use crate::scalar::{Real, Vector, norm};
use crate::support::{BoxShape, Failure, Point, Support};
use core::ffi::c_void;

/// The largest dimension.
pub const MAX_DIMENSION: usize = 6;

// ---------------------------------------------------------------------------------------------------------- pointers

pub fn not_null<S>(pointer: *const S) -> Check {
    if pointer.is_null() { Err(QDIST_ERROR_NULL) } else { Ok(()) }
}

/// Neither NULL nor misaligned.
#[inline(always)]
pub fn aligned<S>(pointer: *const S) -> Check {
    not_null(pointer)?;
    if pointer.is_aligned() { Ok(()) } else { Err(QDIST_ERROR_ALIGNMENT) }
}

/// A struct of the caller.
///
/// # Safety
/// If not NULL and aligned, `pointer` is valid for reads for the life `'a`.
#[inline(always)]
pub unsafe fn shared<'a, S>(pointer: *const S) -> Check<&'a S> {
    aligned(pointer)?;
    // SAFETY: checked, and the caller's promise.
    Ok(unsafe { &*pointer })
}

/// An array of the caller, never of length 0.
///
/// # Safety
/// If not NULL and aligned, `pointer` is valid for reads of `length` numbers for the life `'a`.
#[inline(always)]
pub unsafe fn array<'a, S>(pointer: *const S, length: Option<usize>) -> Check<&'a [S]> {
    aligned(pointer)?;
    let fits = |n: &usize| *n > 0 && n.checked_mul(size_of::<S>()).is_some_and(|bytes| bytes <= isize::MAX as usize);
    let length = length.filter(fits).ok_or(QDIST_ERROR_ARGUMENT)?;
    // SAFETY: not NULL, aligned, a length that an object can have, and the caller's promise.
    Ok(unsafe { core::slice::from_raw_parts(pointer, length) })
}

/// Is the struct of the version that this library knows?
pub fn known_size(size: u32, known: usize) -> Check {
    if size as usize == known { Ok(()) } else { Err(QDIST_ERROR_STRUCT_SIZE) }
}

// ------------------------------------------------------------------------------------------------------------ numbers

/// A length: finite, not too large, >= 0.
#[inline]
pub fn length<T: Real>(x: T) -> Check<T> {
    BoxShape::new(Vector::<T, 1>::new(x)).map(|_| x).map_err(from_shape)
}

/// Lengths: finite, not too large, >= 0, and not all zero.
pub fn semi_axes<T: Real>(list: &[T]) -> Check {
    let mut most = T::zero();
    for &x in list {
        most = most.at_least(length(x)?);
    }
    if most > T::zero() { Ok(()) } else { Err(QDIST_ERROR_ARGUMENT) }
}

/// Coordinates: finite and not too large.
pub fn coordinates<T: Real>(list: &[T]) -> Check {
    for &x in list {
        Point::new(Vector::<T, 1>::new(x)).map_err(from_shape)?;
    }
    Ok(())
}

pub fn finite<T: Real>(list: &[T]) -> Check {
    if list.iter().all(|x| x.finite()) { Ok(()) } else { Err(QDIST_ERROR_NONFINITE) }
}

pub fn flag(x: u32) -> Check<bool> {
    match x {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(QDIST_ERROR_ARGUMENT),
    }
}

/// A run-time dimension, 2 to 6.
#[inline]
pub fn dimension(n: u32) -> Check<usize> {
    if (2..=MAX_DIMENSION as u32).contains(&n) { Ok(n as usize) } else { Err(QDIST_ERROR_DIMENSION) }
}

/// The first `n` numbers of an array.
#[inline]
pub fn first<S>(list: &[S], n: usize) -> Check<&[S]> {
    list.get(..n).ok_or(QDIST_ERROR_DIMENSION)
}

/// `a.b`
#[inline(always)]
pub fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |s, (&x, &y)| s + x * y)
}

/// max |x_i|
#[inline(always)]
pub fn largest<T: Real>(list: &[T]) -> T {
    list.iter().fold(T::zero(), |m, &x| m.at_least(x).at_least(-x))
}

/// An upper bound of the largest norm of the points, for coordinates that passed [`coordinates`].
pub fn reach<T: Real>(points: &[T], dimension: usize) -> T {
    let size = largest(points);
    if !(size > T::zero()) {
        return T::TINY;
    }
    // Scaled, so that no square overflows.
    let mut most = T::zero();
    for point in points.chunks_exact(dimension.max(1)) {
        most = most.at_least(point.iter().fold(T::zero(), |s, &x| s + (x / size) * (x / size)));
    }
    size * most.root() * (T::one() + T::count(32) * T::ROUNDOFF)
}

/// Lengths that stand for "zero, and known".
pub trait Tiny: Real {
    /// A length that does not matter next to any other, and whose products with roundoff are normal numbers: exact
    /// zero would say "unknown", and subnormal numbers are slow.
    const TINY: Self;
}
