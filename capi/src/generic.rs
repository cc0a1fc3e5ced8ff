//! What the entry points of both scalars share: checked pointers, callbacks as sets and unit sets, and loops over run-time
//! dimensions.

use super::status::qdist_interrupt;
use super::status::{
    Check, QDIST_ERROR_ALIGNMENT, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_NONFINITE, QDIST_ERROR_NULL,
    QDIST_ERROR_STRUCT_SIZE, from_shape,
};
use super::symmetry::qdist_mirrored;
use core::cell::Cell;
use core::ffi::c_void;
use qdist::NOT_FINITE;
use qdist::internal::norm;
use qdist::internal::{check_numbers, check_sizes, one_by_one};
use qdist::qset::UnitSet;
use qdist::support::Failure;
use qdist::{Real, Vector};

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

/// A struct of the header: where it has bytes that belong to no field.
pub trait Gaps {
    /// Where they begin, and how many.
    const GAPS: &'static [(usize, usize)];
}

/// `gaps!(type, field..next, last..)`: there may be a gap between these fields, and behind the last one. A field of a field is written with a dot.
macro_rules! gaps {
    ($type:ty, $($($from:ident).+ .. $($until:ident)?),*) => {
        impl $crate::generic::Gaps for $type {
            const GAPS: &'static [(usize, usize)] = &[$({
                let end = core::mem::offset_of!($type, $($from).+)
                    + $crate::generic::field_size(|all: &$type| &all.$($from).+);
                (end, gaps!(@until $type, $($until)?) - end)
            }),*];
        }
    };
    (@until $type:ty, $until:ident) => { core::mem::offset_of!($type, $until) };
    (@until $type:ty,) => { size_of::<$type>() };
}
pub(super) use gaps;

/// The size of the field that a function picks.
pub const fn field_size<S, F>(_: fn(&S) -> &F) -> usize {
    size_of::<F>()
}

/// Writes a struct to the caller's memory, and zeros where it has no field: the compiler would leave there what happened to be on the stack.
///
/// # Safety
/// The pointer is aligned and valid for writes.
#[inline(always)]
pub unsafe fn put<S: Gaps>(to: *mut S, value: S) {
    // SAFETY: the caller's promise.
    unsafe {
        to.write(value);
        clear_gaps(to);
    }
}

/// # Safety
/// As for [`put`].
#[inline(always)]
pub unsafe fn clear_gaps<S: Gaps>(to: *mut S) {
    for &(from, length) in S::GAPS {
        // SAFETY: the caller's promise; the gap is in the struct.
        unsafe { to.cast::<u8>().add(from).write_bytes(0, length) };
    }
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

/// Stands for a length of zero that is known: 0 itself says "unknown", and products of a subnormal number are slow. (Two roundoffs of it are
/// still normal: 1e-276, for `float` 3e-24.)
#[inline(always)]
pub fn tiny<T: Real>() -> T {
    T::SAFE_SQUARE
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

/// Coordinates as points.
#[inline(always)]
pub fn as_points<T, const N: usize>(list: &[T]) -> &[[T; N]] {
    list.as_chunks::<N>().0
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

/// The interrupt callback of the options.
#[derive(Clone, Copy)]
pub struct Deadline {
    function: qdist_interrupt,
    user: *mut c_void,
}

impl Deadline {
    /// None.
    pub const NEVER: Deadline = Deadline { function: None, user: core::ptr::null_mut() };

    /// # Safety
    /// For the life of the value, the function may be called with `user`.
    pub unsafe fn new(function: qdist_interrupt, user: *mut c_void) -> Self {
        Self { function, user }
    }

    /// Runs a query with this deadline.
    #[inline(always)]
    pub fn during<R>(&self, query: impl FnOnce(Option<&dyn Fn() -> bool>) -> R) -> R {
        match self.function {
            // SAFETY: the promise of `new`.
            Some(function) => query(Some(&|| unsafe { function(self.user) } != 0)),
            None => query(None),
        }
    }
}

pub type VertexFn<T> = unsafe extern "C" fn(user: *mut c_void, index: u32, point: *mut T) -> i32;

/// What a unit set struct of the caller says, NULL and 0 included.
pub struct Parts<T> {
    pub value: Option<ValueFn<T>>,
    pub point: Option<SupportFn<T>>,
    pub vertex: Option<VertexFn<T>>,
    pub mirrored: qdist_mirrored,
    pub user: *mut c_void,
    pub extent: T,
    pub inner_radius: T,
    pub vertex_count: u32,
}

/// A unit set of the caller, as a [`UnitSet`].
pub struct CallbackUnit<T> {
    parts: Parts<T>,
    function: ValueFn<T>,
    error: T,
    /// The code of the vertex function that failed, else 0.
    code: Cell<i32>,
}

impl<T: Real> CallbackUnit<T> {
    /// Checks the numbers. Where the extent is not known, the values along the axes bound it.
    ///
    /// # Safety
    /// For the life of the value, the functions may be called with `user` in dimension `N`.
    pub unsafe fn new<const N: usize>(parts: Parts<T>) -> Check<Self> {
        let function = parts.value.ok_or(QDIST_ERROR_NULL)?;
        if parts.vertex_count > 0 && parts.vertex.is_none() {
            return Err(QDIST_ERROR_NULL);
        }
        let mut extent = length(parts.extent)?;
        if length(parts.inner_radius)? > extent && extent > T::zero() {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let mut unit = Self { parts, function, error: T::zero(), code: Cell::new(0) };
        if !(extent > T::zero()) {
            let mut corner = Vector::<T, N>::zeros();
            let mut axis = Vector::<T, N>::zeros();
            let mut empty = true;
            for i in 0..N {
                for sign in [T::one(), -T::one()] {
                    axis[i] = sign;
                    let value = unit.ask(&axis);
                    // What is no value of a unit set makes the error NaN, and ends the query.
                    corner[i] = if value >= T::zero() { corner[i].at_least(value) } else { T::of(f64::NAN) };
                    empty &= value == T::zero();
                }
                axis[i] = T::zero();
            }
            if empty {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            extent = norm(&corner);
        }
        unit.error = T::count(16 * N) * T::ROUNDOFF * extent;
        Ok(unit)
    }

    /// The code of the vertex function, if that ended the query with `failure`.
    pub fn code(&self, failure: i32) -> i32 {
        if failure == NOT_FINITE && self.code.get() != 0 { self.code.get() } else { failure }
    }

    #[inline(always)]
    fn ask<const N: usize>(&self, u: &Vector<T, N>) -> T {
        // SAFETY: the promise of `new`; the vector is N numbers in a row.
        unsafe { (self.function)(self.parts.user, u.as_ptr()) }
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for CallbackUnit<T> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(self.ask(u))
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        // SAFETY: the promise of `new`.
        unsafe { ask(self.parts.point, self.parts.user, u) }.ok()
    }
    fn vertex_count(&self) -> usize {
        self.parts.vertex_count as usize
    }
    /// NaN, which no ray is shot at, when the function fails.
    fn vertex(&self, index: usize) -> Vector<T, N> {
        let mut point = Vector::<T, N>::from_element(T::of(f64::NAN));
        if let Some(function) = self.parts.vertex {
            // SAFETY: the promise of `new`; the vector is N numbers in a row.
            let code = unsafe { function(self.parts.user, index as u32, point.as_mut_ptr()) };
            if code != 0 {
                self.code.set(code);
            }
            if code != 0 || coordinates(point.as_slice()).is_err() {
                point = Vector::from_element(T::of(f64::NAN));
            }
        }
        point
    }
    fn inner_radius(&self) -> T {
        self.parts.inner_radius
    }
    fn mirrored(&self, signs: u8) -> bool {
        // SAFETY: the promise of `new`.
        unsafe { is_mirrored(self.parts.mirrored, self.parts.user, signs) }
    }
    fn error(&self) -> T {
        self.error
    }
}

/// Asks a mirror function of the caller.
///
/// # Safety
/// The function may be called with `user`.
pub unsafe fn is_mirrored(function: qdist_mirrored, user: *mut c_void, signs: u8) -> bool {
    // SAFETY: the caller's promise.
    function.is_some_and(|function| unsafe { function(user, u32::from(signs)) } == 1)
}

/// The mirror function of sets that are symmetric in every coordinate.
pub unsafe extern "C" fn mirrored_always(_user: *mut c_void, _signs: u32) -> i32 {
    1
}
