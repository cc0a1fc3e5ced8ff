//! The boundary of every call: no panic leaves the library, and what a call uses no callback of it can.
//!
//! The C library of meshes is built with unwinding, and a panic becomes QDIST_ERROR_INTERNAL. In a build with `panic = "abort"` the process
//! ends instead.

use super::*;
use std::cell::UnsafeCell;
use std::ops::{Deref, DerefMut};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs a call. What it leaves behind after a panic is for its caller to clean up, or to be freed.
pub(super) fn guard(call: impl FnOnce() -> Check) -> qdist_status {
    silence();
    status(caught(call).unwrap_or(Err(QDIST_ERROR_INTERNAL)))
}

/// What an opaque struct holds, for one call at a time: a callback that uses the struct of the call that is calling it gets an error.
pub(super) struct Exclusive<S> {
    busy: AtomicBool,
    inside: UnsafeCell<S>,
}

impl<S> Exclusive<S> {
    pub(super) fn new(inside: S) -> Self {
        Self { busy: AtomicBool::new(false), inside: UnsafeCell::new(inside) }
    }

    /// Takes it for one call.
    pub(super) fn take(&self) -> Check<Taken<'_, S>> {
        if self.busy.swap(true, Ordering::Acquire) { Err(QDIST_ERROR_BUSY) } else { Ok(Taken(self)) }
    }
}

// SAFETY: as for a mutex: `take` gives it to one call at a time.
unsafe impl<S: Send> Sync for Exclusive<S> {}

/// Taken for the life of this value.
pub(super) struct Taken<'a, S>(&'a Exclusive<S>);

impl<S> Deref for Taken<'_, S> {
    type Target = S;
    fn deref(&self) -> &S {
        // SAFETY: there is one `Taken` at a time, and it is borrowed.
        unsafe { &*self.0.inside.get() }
    }
}

impl<S> DerefMut for Taken<'_, S> {
    fn deref_mut(&mut self) -> &mut S {
        // SAFETY: there is one `Taken` at a time, and it is borrowed mutably.
        unsafe { &mut *self.0.inside.get() }
    }
}

impl<S> Drop for Taken<'_, S> {
    fn drop(&mut self) {
        self.0.busy.store(false, Ordering::Release);
    }
}

/// The result, or nothing where there was a panic.
pub(super) fn caught<R>(work: impl FnOnce() -> R) -> Option<R> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}

/// The C library has a standard library of its own, whose panics print nothing. A Rust program keeps its hook.
fn silence() {
    #[cfg(feature = "c-allocator")]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::status::QDIST_OK;

    #[test]
    fn one_call_at_a_time() {
        let cell = Exclusive::new(1);
        let mut first = cell.take().unwrap();
        assert_eq!(cell.take().err(), Some(QDIST_ERROR_BUSY));
        *first = 2;
        drop(first);
        assert_eq!(guard(|| cell.take().map(|_| panic!("on purpose"))), QDIST_ERROR_INTERNAL);
        assert_eq!(cell.take().map(|held| *held), Ok(2));
    }

    #[test]
    fn panic_is_a_status() {
        assert_eq!(guard(|| Ok(())), QDIST_OK);
        assert_eq!(guard(|| panic!("on purpose")), QDIST_ERROR_INTERNAL);
    }
}
