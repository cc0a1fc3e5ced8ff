//! ALLOCATOR
//!
//! Where memory comes from. Everything that this library allocates, handles and all that is inside of them, comes from one allocator:
//! malloc and free of the system, or yours. It is chosen for the whole process, once, since memory must go back where it came from.
//! (A static library has a heap interface of its own: your program's malloc is not replaced.)

use super::*;
use core::ptr::null_mut;
use core::sync::atomic::{AtomicPtr, Ordering};
use std::alloc::{GlobalAlloc, Layout, System};

/// Functions that allocate. They may be called by all threads that call the library, at the same time, and must not unwind, longjmp, or call it.
#[repr(C)]
pub struct qdist_allocator {
    /// Memory of `size` bytes, at least 1, aligned to `align`, a power of two, which may be more than malloc's own (a cache line); or NULL
    /// when there is none. Then the process is aborted: the library's containers cannot go on without.
    pub alloc: Option<unsafe extern "C" fn(user: *mut c_void, size: usize, align: usize) -> *mut c_void>,
    /// Takes back what `alloc` returned for the same size and alignment.
    pub free: Option<unsafe extern "C" fn(user: *mut c_void, memory: *mut c_void, size: usize, align: usize)>,
    /// For both.
    pub user: *mut c_void,
}

/// Sets the allocator of the process. The struct is not copied: it must stay valid and unchanged until the process ends. Once only, and before
/// the first mesh: afterwards QDIST_ERROR_ALLOCATOR.
///
/// Status: NULL (also: alloc or free), ALLOCATOR (it is too late).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_set_allocator(allocator: In<qdist_allocator>) -> qdist_status {
    status_of(|| {
        let functions = allocator.get()?;
        if functions.alloc.is_none() || functions.free.is_none() {
            return Err(QDIST_ERROR_NULL);
        }
        CHOSEN
            .compare_exchange(null_mut(), allocator.address().cast_mut(), Ordering::AcqRel, Ordering::Acquire)
            .map_err(|_| QDIST_ERROR_ALLOCATOR)?;
        Ok(())
    })
}

/// NULL before the first allocation, then the caller's struct or [`SYSTEM`], forever.
static CHOSEN: AtomicPtr<qdist_allocator> = AtomicPtr::new(null_mut());

/// Stands for the system's allocator: functions that are `None`, and an address of its own.
static SYSTEM: Silent = Silent(qdist_allocator { alloc: None, free: None, user: null_mut() });

struct Silent(qdist_allocator);
// SAFETY: never written, and its pointer is NULL.
unsafe impl Sync for Silent {}

/// The caller's functions, or nothing for the system's. The first call decides.
fn chosen() -> &'static qdist_allocator {
    let now = CHOSEN.load(Ordering::Acquire);
    let now = if now.is_null() {
        let system = (&raw const SYSTEM.0).cast_mut();
        CHOSEN.compare_exchange(now, system, Ordering::AcqRel, Ordering::Acquire).map_or_else(|set| set, |_| system)
    } else {
        now
    };
    // SAFETY: SYSTEM, or the caller's struct, which stays valid and unchanged.
    unsafe { &*now }
}

struct Chosen;

#[global_allocator]
static GLOBAL: Chosen = Chosen;

// SAFETY: the system's allocator, or the caller's promise of the same. The choice never changes, so that memory goes back where it came from.
unsafe impl GlobalAlloc for Chosen {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let chosen = chosen();
        match chosen.alloc {
            // SAFETY: the caller's promise.
            Some(alloc) => unsafe { alloc(chosen.user, layout.size(), layout.align()).cast() },
            // SAFETY: passed on.
            None => unsafe { System.alloc(layout) },
        }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        let chosen = chosen();
        match chosen.free {
            // SAFETY: the caller's promise.
            Some(free) => unsafe { free(chosen.user, memory.cast(), layout.size(), layout.align()) },
            // SAFETY: passed on.
            None => unsafe { System.dealloc(memory, layout) },
        }
    }
}
