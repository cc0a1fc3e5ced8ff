//! Numbers of the caller, checked, and loops over run-time dimensions.

use super::vocabulary::*;
use qdist::internal::{check_numbers, check_sizes};

/// The largest dimension.
pub const MAX_DIMENSION: usize = 6;
/// The most points of a simplex.
pub const MAX_POINTS: usize = MAX_DIMENSION + 1;

// ------------------------------------------------------------------------------------------------------------ numbers

/// A length: finite, not too large, >= 0.
#[inline(always)]
pub fn length<T: Real>(x: T) -> Check<T> {
    lengths([x]).map(|()| x)
}

/// Lengths: each finite, not too large, >= 0.
#[inline(always)]
pub fn lengths<T: Real, const K: usize>(list: [T; K]) -> Check {
    check_sizes(list.iter()).map_err(from_shape)
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
    check_numbers(list.iter()).map_err(from_shape)
}

pub fn finite<T: Real>(list: &[T]) -> Check {
    if list.iter().all(|x| x.finite()) { Ok(()) } else { Err(QDIST_ERROR_NONFINITE) }
}

/// Finite, and >= 0.
#[cfg(feature = "mesh")]
pub fn not_negative(x: f64) -> Check<f64> {
    finite(&[x])?;
    if x < 0.0 { Err(QDIST_ERROR_ARGUMENT) } else { Ok(x) }
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

/// Does what names the dimension `N`: the number in a struct of the header.
macro_rules! in_dimension {
    ($n:expr, $call:expr) => {
        match $n {
            2 => $crate::numbers::in_dimension!(@2, $call),
            3 => $crate::numbers::in_dimension!(@3, $call),
            4 => $crate::numbers::in_dimension!(@4, $call),
            5 => $crate::numbers::in_dimension!(@5, $call),
            6 => $crate::numbers::in_dimension!(@6, $call),
            _ => Err(QDIST_ERROR_DIMENSION),
        }
    };
    (@$n:literal, $call:expr) => {{
        const N: usize = $n;
        $call
    }};
}
pub(crate) use in_dimension;

/// The first numbers of a list that is filled up.
#[inline(always)]
pub fn leading<T: Real, const N: usize>(list: &[T; MAX_DIMENSION]) -> Vector<T, N> {
    Vector::from_fn(|i, _| list.get(i).copied().unwrap_or(T::zero()))
}

/// A list in an array, filled up with zeros.
#[inline]
pub fn padded<T: Real>(list: impl Iterator<Item = T>) -> [T; MAX_DIMENSION] {
    let mut all = [T::zero(); MAX_DIMENSION];
    for (to, x) in all.iter_mut().zip(list) {
        *to = x;
    }
    all
}

/// `a.b`
#[inline(always)]
pub fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |s, (&x, &y)| s + x * y)
}

/// Stands for a length of zero that is known: 0 itself says "unknown", and products of a subnormal number are slow. (Two roundoffs of it are
/// still normal: 1e-276, for `float` 3e-24.)
#[inline(always)]
pub fn tiny<T: Real>() -> T {
    T::SAFE_SQUARE
}

/// Coordinates as points.
#[inline(always)]
pub fn as_points<T, const N: usize>(list: &[T]) -> &[[T; N]] {
    list.as_chunks::<N>().0
}
