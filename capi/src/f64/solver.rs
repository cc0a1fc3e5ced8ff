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

use super::*;

/// Makes a solver of a dimension of 2 to 6 in `bytes` bytes of memory, aligned to QDIST_WORKSPACE_ALIGN, and stores its address,
/// which is that of the memory.
///
/// Status: DIMENSION (dimension), CAPACITY (max_vertices or max_facets), WORKSPACE_SIZE (bytes), ALIGNMENT (memory, to QDIST_WORKSPACE_ALIGN).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_solver_init_f64(
    memory: Out<c_void>,
    bytes: u32,
    dimension: u32,
    max_vertices: u32,
    max_facets: u32,
    solver: Out<*mut qdist_solver>,
) -> qdist_status {
    status(handle::init::<f64>(memory, bytes, dimension, max_vertices, max_facets, solver))
}
