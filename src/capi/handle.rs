//! A solver in the caller's memory: a header that says what it is, then the block that [`Layout`] describes.
//!
//! The block is initialised once; a call opens it in constant time. It holds no address, so the memory may be moved.

use super::generic::{aligned, not_null};
use super::status::{
    Check, QDIST_ERROR_ALIGNMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_SCALAR, QDIST_ERROR_SOLVER,
    QDIST_ERROR_WORKSPACE_SIZE, from_workspace,
};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::workspace::{self, Layout};
use core::ffi::c_void;

/// A solver: opaque, in the caller's memory.
#[repr(C, align(8))]
pub struct qdist_solver {
    magic: u32,
    /// Size of the scalar.
    scalar: u16,
    dimension: u16,
    max_vertices: u32,
    max_facets: u32,
}

const MAGIC: u32 = u32::from_le_bytes(*b"qdst");

/// The block follows the header.
const HEADER: usize = size_of::<qdist_solver>();

const _: () =
    assert!(HEADER == 16 && HEADER.is_multiple_of(Layout::ALIGN) && align_of::<qdist_solver>() == Layout::ALIGN);

/// The macros QDIST_WORKSPACE_BYTES_F64 and _F32 of the header.
const fn promised(dimension: usize, scalar: usize, vertices: usize, facets: usize) -> usize {
    let indices = (4 * dimension + 3).next_multiple_of(scalar);
    HEADER + vertices * 2 * dimension * scalar + facets * ((dimension + 4) * scalar + indices)
}

/// Does the layout keep what the header promises? Both are linear in the capacities.
const fn keeps<T: Real, const N: usize>() -> bool {
    let (Ok(small), Ok(tall), Ok(wide)) =
        (Layout::new::<T, N>(7, 12), Layout::new::<T, N>(1007, 12), Layout::new::<T, N>(7, 1012))
    else {
        return false;
    };
    let s = size_of::<T>();
    HEADER + small.bytes() <= promised(N, s, 7, 12)
        && HEADER + tall.bytes() <= promised(N, s, 1007, 12)
        && HEADER + wide.bytes() <= promised(N, s, 7, 1012)
}

// On any target; that they are equal on this one is what ffi-tests/abi.c tests.
const _: () = {
    assert!(keeps::<f64, 2>() && keeps::<f64, 3>() && keeps::<f64, 4>() && keeps::<f64, 5>() && keeps::<f64, 6>());
    assert!(keeps::<f32, 2>() && keeps::<f32, 3>() && keeps::<f32, 4>() && keeps::<f32, 5>() && keeps::<f32, 6>());
};

/// Header and block, in bytes.
pub(super) fn bytes<T: Real, const N: usize>(max_vertices: u32, max_facets: u32) -> Check<u32> {
    let layout = layout::<T, N>(max_vertices, max_facets)?;
    u32::try_from(HEADER + layout.bytes()).map_err(|_| QDIST_ERROR_WORKSPACE_SIZE)
}

fn layout<T: Real, const N: usize>(max_vertices: u32, max_facets: u32) -> Check<Layout> {
    Layout::new::<T, N>(max_vertices as usize, max_facets as usize).map_err(from_workspace)
}

/// Makes a solver.
///
/// # Safety
/// `memory` is NULL or valid for writes of `length` bytes and used for nothing else; `solver` is NULL or valid for writes.
pub(super) unsafe fn init<T: Real, const N: usize>(
    memory: *mut c_void,
    length: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> Check {
    not_null(memory)?;
    aligned(solver)?;
    let layout = layout::<T, N>(max_vertices, max_facets)?;
    if (length as usize) < HEADER + layout.bytes() {
        return Err(QDIST_ERROR_WORKSPACE_SIZE);
    }
    let handle = memory.cast::<qdist_solver>();
    if !handle.is_aligned() {
        return Err(QDIST_ERROR_ALIGNMENT);
    }
    let scalar = size_of::<T>() as u16;
    // SAFETY: aligned, and long enough for header and block.
    unsafe {
        workspace::initialize::<T, N>(memory.cast::<u8>().add(HEADER), &layout);
        handle.write(qdist_solver { magic: MAGIC, scalar, dimension: N as u16, max_vertices, max_facets });
        solver.write(handle);
    }
    Ok(())
}

/// Opens a solver for one call. Constant time.
///
/// # Safety
/// `solver` is NULL or valid for reads of a header; if it was made by [`init`], its memory is unchanged since and
/// not in use by another call for the life `'w`.
pub(super) unsafe fn open<'w, T: Real, const N: usize>(solver: *mut qdist_solver) -> Check<Solver<'w, T, N>> {
    aligned(solver)?;
    // SAFETY: aligned, and readable as the caller promises.
    let header = unsafe { &*solver };
    if header.magic != MAGIC {
        return Err(QDIST_ERROR_SOLVER);
    }
    if usize::from(header.scalar) != size_of::<T>() {
        return Err(QDIST_ERROR_SCALAR);
    }
    if usize::from(header.dimension) != N {
        return Err(QDIST_ERROR_DIMENSION);
    }
    let layout = layout::<T, N>(header.max_vertices, header.max_facets).map_err(|_| QDIST_ERROR_SOLVER)?;
    // SAFETY: the header says that `init` wrote a block of this layout behind it.
    Ok(unsafe { workspace::open(solver.cast::<u8>().add(HEADER), &layout) })
}
