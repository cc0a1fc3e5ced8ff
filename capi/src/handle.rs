//! A solver in the caller's memory: a header that says what it is, then the block that [`Layout`] describes.
//!
//! The block is initialised once; a call opens it in constant time. It holds no address, so the memory may be moved.
//!
//! While a call runs, the header's tag is another one: a callback that would use the solver that is calling it meets that, and an error.

use super::vocabulary::*;
use core::ops::{Deref, DerefMut};
use qdist::{Layout, internal};

/// A solver: opaque, in the caller's memory.
#[repr(C, align(8))]
#[derive(Clone, Copy)]
pub struct qdist_solver {
    magic: u32,
    /// Size of the scalar.
    scalar: u16,
    dimension: u16,
    max_vertices: u32,
    max_facets: u32,
}

const MAGIC: u32 = u32::from_le_bytes(*b"qdst");
/// The same while a call uses it.
const BUSY: u32 = u32::from_le_bytes(*b"qdsB");

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

fn layout<T: Real, const N: usize>(max_vertices: u32, max_facets: u32) -> Check<Layout> {
    Layout::new::<T, N>(max_vertices as usize, max_facets as usize).map_err(from_workspace)
}

fn layout_of<T: Real>(dimension: u32, max_vertices: u32, max_facets: u32) -> Check<Layout> {
    in_dimension!(dimension, layout::<T, N>(max_vertices, max_facets))
}

/// Header and block, in bytes.
pub(super) fn query<T: Real>(dimension: u32, max_vertices: u32, max_facets: u32, bytes: Out<u32>) -> Check {
    bytes.checked()?;
    let layout = layout_of::<T>(dimension, max_vertices, max_facets)?;
    bytes.put(u32::try_from(HEADER + layout.bytes()).map_err(|_| QDIST_ERROR_WORKSPACE_SIZE)?)
}

/// Makes a solver.
pub(super) fn init<T: Real>(
    memory: Out<c_void>,
    length: u32,
    dimension: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: Out<*mut qdist_solver>,
) -> Check {
    memory.checked()?;
    solver.checked()?;
    let layout = layout_of::<T>(dimension, max_vertices, max_facets)?;
    if (length as usize) < HEADER + layout.bytes() {
        return Err(QDIST_ERROR_WORKSPACE_SIZE);
    }
    let handle = memory.address().cast::<qdist_solver>();
    if !handle.is_aligned() {
        return Err(QDIST_ERROR_ALIGNMENT);
    }
    let scalar = size_of::<T>() as u16;
    // SAFETY: aligned, and the header: long enough for header and block, and used for nothing else.
    unsafe {
        let block = handle.cast::<u8>().add(HEADER);
        internal::initialize(block, &layout);
        handle.write(qdist_solver { magic: MAGIC, scalar, dimension: dimension as u16, max_vertices, max_facets });
    }
    solver.put(handle)
}

/// The dimension of a solver that may be opened.
pub(super) fn dimension(solver: &Out<qdist_solver>) -> Check<u16> {
    let header = solver.get()?;
    match header.magic {
        MAGIC if (2..=6).contains(&header.dimension) => Ok(header.dimension),
        BUSY => Err(QDIST_ERROR_BUSY),
        _ => Err(QDIST_ERROR_SOLVER),
    }
}

/// A solver that is open for one call, at the end of which it is no longer busy.
pub(super) struct Opened<'w, T, const N: usize> {
    solver: Solver<'w, T, N>,
    header: *mut qdist_solver,
}

impl<'w, T, const N: usize> Deref for Opened<'w, T, N> {
    type Target = Solver<'w, T, N>;
    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.solver
    }
}

impl<T, const N: usize> DerefMut for Opened<'_, T, N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.solver
    }
}

impl<T, const N: usize> Drop for Opened<'_, T, N> {
    #[inline(always)]
    fn drop(&mut self) {
        // SAFETY: the promise of `open`; nothing else refers to the header.
        unsafe { (&raw mut (*self.header).magic).write(MAGIC) };
    }
}

/// Opens a solver for one call. Constant time.
#[inline]
pub(super) fn open<T: Real, const N: usize>(solver: &Out<qdist_solver>) -> Check<Opened<'_, T, N>> {
    let header = *solver.get()?;
    if header.magic == BUSY {
        return Err(QDIST_ERROR_BUSY);
    }
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
    let header = solver.address();
    // SAFETY: the header says that `init` wrote a block of this layout behind it, and C promises that it is unchanged since and not in use by
    // another thread.
    unsafe {
        (&raw mut (*header).magic).write(BUSY);
        Ok(Opened { solver: internal::open(header.cast::<u8>().add(HEADER), &layout), header })
    }
}
