//! Functions of the caller: support functions, unit sets, deadlines. What the header asks of them is what makes the calls right.

use super::vocabulary::*;
use core::cell::Cell;
use qdist::NOT_FINITE;
use qdist::internal::norm;
use qdist::qset::UnitSet;

pub type SupportFn<T> = unsafe extern "C" fn(user: *mut c_void, direction: *const T, point: *mut T) -> i32;
pub type ValueFn<T> = unsafe extern "C" fn(user: *mut c_void, direction: *const T) -> T;

/// Asks a support function of the caller; returns its code.
///
/// # Safety
/// The function may be called with `user`, in dimension `u.len()`, which is `point.len()` at most.
#[inline(always)]
pub(super) unsafe fn support<T>(function: Option<SupportFn<T>>, user: *mut c_void, u: &[T], point: &mut [T]) -> i32 {
    let Some(function) = function else { return QDIST_ERROR_NULL };
    // SAFETY: the caller's promise.
    unsafe { function(user, u.as_ptr(), point.as_mut_ptr()) }
}

/// Asks for a support point in two words.
///
/// # Safety
/// The function may be called with `user` in dimension `N`, which is 2 or 3.
pub(super) unsafe fn precise<T: Real, const N: usize>(
    function: SupportFn<T>,
    user: *mut c_void,
    u: &TwoWords<T, N>,
) -> Option<TwoWords<T, N>> {
    let mut direction = [T::zero(); MAX_DIMENSION];
    for (to, &word) in direction.iter_mut().zip(u.high.iter().chain(u.low.iter())) {
        *to = word;
    }
    let mut point = [T::of(f64::NAN); MAX_DIMENSION];
    // SAFETY: the caller's promise.
    let code = unsafe { function(user, direction.as_ptr(), point.as_mut_ptr()) };
    let (high, low) = (point.iter().take(N), point.iter().skip(N).take(N));
    let (high, low) = (Vector::from_iterator(high.copied()), Vector::from_iterator(low.copied()));
    (code == 0).then_some(TwoWords { high, low })
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

    /// The header: `interrupt` may be called with its `user` during the call.
    pub fn new(function: qdist_interrupt, user: *mut c_void) -> Self {
        Self { function, user }
    }

    /// Runs a query with these options and this deadline.
    #[inline(always)]
    pub fn during<T: Copy, const N: usize, R>(
        &self,
        options: &Options<'_, T, N>,
        query: impl FnOnce(&Options<'_, T, N>) -> R,
    ) -> R {
        self.asked(|interrupt| query(&Options { interrupt, ..*options }))
    }

    /// Does what asks for this deadline by itself.
    #[inline(always)]
    pub fn asked<R>(&self, work: impl FnOnce(Option<&dyn Fn() -> bool>) -> R) -> R {
        match self.function {
            // SAFETY: what the header asks of the caller, see `new`.
            Some(function) => work(Some(&|| unsafe { function(self.user) } != 0)),
            None => work(None),
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
    pub fn code(&self, failure: Option<Failure>) -> i32 {
        let failure = code(failure);
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
        let mut point = Vector::<T, N>::from_element(T::of(f64::NAN));
        // SAFETY: the promise of `new`.
        let code = unsafe { support(self.parts.point, self.parts.user, u.as_slice(), point.as_mut_slice()) };
        (code == 0).then(|| one_by_one(&point))
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
