//! MEMORY AT RUN TIME

use super::vocabulary::*;

/// The number of bytes that a solver needs, the same number as QDIST_WORKSPACE_BYTES_F64 and QDIST_WORKSPACE_BYTES_F32, for languages that
/// have no macros of C. scalar: sizeof(double) or sizeof(float), else QDIST_ERROR_SCALAR. dimension: 2 to 6.
///
/// Status: SCALAR (scalar), DIMENSION (dimension), CAPACITY (max_vertices or max_facets), WORKSPACE_SIZE (so many bytes have no number of 32
/// bits).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_workspace_query(
    scalar: u32,
    dimension: u32,
    max_vertices: u32,
    max_facets: u32,
    bytes: Out<u32>,
) -> qdist_status {
    status(match scalar {
        8 => handle::query::<f64>(dimension, max_vertices, max_facets, bytes),
        4 => handle::query::<f32>(dimension, max_vertices, max_facets, bytes),
        _ => Err(QDIST_ERROR_SCALAR),
    })
}
