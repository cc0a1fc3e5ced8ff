//! SOLVERS
//!
//! A solver lives in memory that you own: a static array, a stack frame, a heap block. It is made once and then used for any
//! number of queries; it keeps nothing between them. There is nothing to free. The memory holds no addresses, so that a solver
//! may be moved with its memory.
//!
//! Capacities: `max_vertices` bounds the points that are stored, `max_facets` the facets at one time. In
//! dimension 3, facets = 2 * vertices suffices; in dimension 6 a hundred facets for a vertex is not
//! rare. When either is full, qdist_solve goes on cone by cone in the same memory, and qdist_depth3 ends with
//! QDIST_CAPACITY and a bracket that is still true; results say how much was used.

use super::super::generic::aligned;
use super::super::handle::{self, qdist_solver};
use super::super::status::{QDIST_ERROR_DIMENSION, qdist_status, status};
use core::ffi::c_void;

/// The number of bytes that a solver needs, the same number as QDIST_WORKSPACE_BYTES_F64.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_workspace_query_f64(
    dimension: u32,
    max_vertices: u32,
    max_facets: u32,
    bytes: *mut u32,
) -> qdist_status {
    let query = || {
        aligned(bytes)?;
        let needed = match dimension {
            2 => handle::bytes::<f64, 2>(max_vertices, max_facets),
            3 => handle::bytes::<f64, 3>(max_vertices, max_facets),
            4 => handle::bytes::<f64, 4>(max_vertices, max_facets),
            5 => handle::bytes::<f64, 5>(max_vertices, max_facets),
            6 => handle::bytes::<f64, 6>(max_vertices, max_facets),
            _ => Err(QDIST_ERROR_DIMENSION),
        }?;
        // SAFETY: checked.
        unsafe { bytes.write(needed) };
        Ok(())
    };
    status(query())
}

/// Makes a solver of dimension 2 in `bytes` bytes of memory, aligned to QDIST_WORKSPACE_ALIGN, and stores its address,
/// which is that of the memory.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solver_init2_f64(
    memory: *mut c_void,
    bytes: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { handle::init::<f64, 2>(memory, bytes, max_vertices, max_facets, solver) })
}

/// The same in dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solver_init3_f64(
    memory: *mut c_void,
    bytes: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { handle::init::<f64, 3>(memory, bytes, max_vertices, max_facets, solver) })
}

/// The same in dimension 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solver_init4_f64(
    memory: *mut c_void,
    bytes: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { handle::init::<f64, 4>(memory, bytes, max_vertices, max_facets, solver) })
}

/// The same in dimension 5.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solver_init5_f64(
    memory: *mut c_void,
    bytes: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { handle::init::<f64, 5>(memory, bytes, max_vertices, max_facets, solver) })
}

/// The same in dimension 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solver_init6_f64(
    memory: *mut c_void,
    bytes: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: *mut *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { handle::init::<f64, 6>(memory, bytes, max_vertices, max_facets, solver) })
}
