//! No panic leaves the library: the boundary of every call.
//!
//! The C library of meshes is built with unwinding, and a panic becomes QDIST_ERROR_INTERNAL. In a build with `panic = "abort"` the process
//! ends instead.

use super::super::status::{Check, QDIST_ERROR_INTERNAL, qdist_status, status};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs a call. What it leaves behind after a panic is for its caller to clean up, or to be freed.
pub(super) fn guard(call: impl FnOnce() -> Check) -> qdist_status {
    silence();
    status(caught(call).unwrap_or(Err(QDIST_ERROR_INTERNAL)))
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
    use crate::capi::status::QDIST_OK;

    #[test]
    fn panic_is_a_status() {
        assert_eq!(guard(|| Ok(())), QDIST_OK);
        assert_eq!(guard(|| panic!("on purpose")), QDIST_ERROR_INTERNAL);
    }
}
