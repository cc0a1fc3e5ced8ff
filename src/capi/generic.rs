//! What the entry points of both scalars share: checked pointers, callbacks as sets and gauges, and loops over run-time
//! dimensions.

use super::status::{
    Check, QDIST_ERROR_ALIGNMENT, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_NONFINITE, QDIST_ERROR_NULL,
    QDIST_ERROR_STRUCT_SIZE, from_shape,
};
use crate::qset::Gauge;
use crate::scalar::{Real, Vector, norm};
use crate::support::{Failure, check_numbers, check_sizes, one_by_one};
use core::ffi::c_void;

/// The largest dimension.
pub const MAX_DIMENSION: usize = 6;
/// The most points of a simplex.
pub const MAX_POINTS: usize = MAX_DIMENSION + 1;

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
        return tiny();
    }
    // Scaled, so that no square overflows.
    let mut most = T::zero();
    for point in points.chunks_exact(dimension.max(1)) {
        most = most.at_least(point.iter().fold(T::zero(), |s, &x| s + (x / size) * (x / size)));
    }
    size * most.root() * (T::one() + T::count(32) * T::ROUNDOFF)
}

/// Stands for a length of zero that is known: 0 itself says "unknown", and products of a subnormal number are slow.
#[inline(always)]
pub fn tiny<T: Real>() -> T {
    let squared = T::ROUNDOFF * T::ROUNDOFF;
    squared * squared
}

/// The direction, scaled if its products could leave the range of the format. `store` keeps the scaled one.
#[inline(always)]
pub fn in_range<'a, T: Real>(u: &'a [T], store: &'a mut [T; MAX_DIMENSION]) -> &'a [T] {
    let size = largest(u);
    let limit = T::count(1 << 16);
    if (size < limit && size * limit > T::one()) || !(size > T::zero()) { u } else { scaled(u, size, store) }
}

#[cold]
#[inline(never)]
fn scaled<'a, T: Real>(u: &'a [T], size: T, store: &'a mut [T; MAX_DIMENSION]) -> &'a [T] {
    for (to, &from) in store.iter_mut().zip(u) {
        *to = from / size;
    }
    store.get(..u.len()).unwrap_or(u)
}

// ------------------------------------------------------------------------------------------------- lists of points

/// A point and its product with the direction.
type Candidate<'a, T> = (T, &'a [T]);

/// The point of a list of `dimension` coordinates each that is farthest along `u`, the first one of equals, and its product
/// with `u`.
pub fn farthest<'a, T: Real>(points: &'a [T], dimension: usize, u: &[T]) -> Option<Candidate<'a, T>> {
    let mut best: Option<Candidate<'a, T>> = None;
    for point in points.chunks_exact(dimension.max(1)) {
        let height = dot(point, u);
        if best.is_none_or(|(most, _)| height > most) {
            best = Some((height, point));
        }
    }
    best
}

/// Coordinates as points in space.
#[inline(always)]
pub fn in_space<T>(list: &[T]) -> &[[T; 3]] {
    list.as_chunks::<3>().0
}

// ---------------------------------------------------------------------------------------------------------- callbacks

pub type SupportFn<T> = unsafe extern "C" fn(user: *mut c_void, direction: *const T, point: *mut T) -> i32;
pub type ValueFn<T> = unsafe extern "C" fn(user: *mut c_void, direction: *const T) -> T;

/// Asks a support function of the caller.
///
/// # Safety
/// The function may be called with `user`, a direction and room for a point of dimension `N`.
#[inline(always)]
pub unsafe fn ask<T: Real, const N: usize>(
    function: Option<SupportFn<T>>,
    user: *mut c_void,
    u: &Vector<T, N>,
) -> Result<Vector<T, N>, Failure> {
    let function = function.ok_or(Failure(QDIST_ERROR_NULL))?;
    // A coordinate that the callback does not write stays NaN, and the query ends with that.
    let mut point = Vector::<T, N>::from_element(T::of(f64::NAN));
    // SAFETY: the caller's promise; both vectors are N numbers in a row.
    let code = unsafe { function(user, u.as_ptr(), point.as_mut_ptr()) };
    if code == 0 { Ok(one_by_one(&point)) } else { Err(Failure(code)) }
}

/// A gauge of the caller, as a [`Gauge`].
pub struct CallbackGauge<T> {
    function: ValueFn<T>,
    user: *mut c_void,
    error: T,
}

impl<T: Real> CallbackGauge<T> {
    /// Checks the numbers. Where the extent is not known, the values along the axes bound it.
    ///
    /// # Safety
    /// For the life of the value, the function may be called with `user` and a direction of dimension `N`.
    pub unsafe fn new<const N: usize>(function: Option<ValueFn<T>>, user: *mut c_void, extent: T) -> Check<Self> {
        let function = function.ok_or(QDIST_ERROR_NULL)?;
        let mut gauge = Self { function, user, error: T::zero() };
        let mut extent = length(extent)?;
        if !(extent > T::zero()) {
            let mut corner = Vector::<T, N>::zeros();
            let mut axis = Vector::<T, N>::zeros();
            for i in 0..N {
                for sign in [T::one(), -T::one()] {
                    axis[i] = sign;
                    // A value that is not finite ends the query when the solver meets one.
                    corner[i] = corner[i].at_least(gauge.ask(&axis));
                }
                axis[i] = T::zero();
            }
            extent = norm(&corner);
        }
        gauge.error = T::count(16 * N) * T::ROUNDOFF * extent;
        Ok(gauge)
    }

    #[inline(always)]
    fn ask<const N: usize>(&self, u: &Vector<T, N>) -> T {
        // SAFETY: the promise of `new`; the vector is N numbers in a row.
        unsafe { (self.function)(self.user, u.as_ptr()) }
    }
}

impl<T: Real, const N: usize> Gauge<T, N> for CallbackGauge<T> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(self.ask(u))
    }
    fn error(&self) -> T {
        self.error
    }
}
