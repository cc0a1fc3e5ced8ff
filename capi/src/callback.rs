//! Functions of the caller: support functions, mirror functions, deadlines. What the header asks of them is what makes the calls right.

use super::vocabulary::*;

pub type SupportFn<T> = unsafe extern "C" fn(user: *mut c_void, direction: *const T, point: *mut T) -> i32;

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

/// Asks a mirror function of the caller.
///
/// # Safety
/// The function may be called with `user`.
pub unsafe fn is_mirrored(function: qdist_mirrored, user: *mut c_void, signs: u8) -> bool {
    // SAFETY: the caller's promise.
    function.is_some_and(|function| unsafe { function(user, u32::from(signs)) } == 1)
}
