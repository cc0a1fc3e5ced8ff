//! MESHES
//!
//! A mesh with all that queries derive from it once. It never changes, and any number of pairs and threads may share it. Your arrays
//! are copied; they are taken as they are, and nothing is repaired. If the triangles close up with a consistent winding, counterclockwise
//! seen from outside, the mesh bounds a solid and is treated as one: what lies inside collides. Otherwise it is a surface without an
//! inside (a polygon soup), and queries see the surface only.

use super::*;
use qdist::mesh::certificate::BuildOptions;
use qdist::mesh::mass::MassProperties;
use qdist::mesh::{MeshError, ModelError};
use std::sync::Arc;

/// A mesh: opaque.
pub struct qdist_mesh {
    pub(super) model: Arc<Model>,
}

/// "There is none", where an index is expected.
pub const QDIST_MESH_NONE: u32 = 4294967295;

/// What is wrong with a mesh, and where: a number of defects and the first of them, QDIST_MESH_NONE if there is none. Edges are given by
/// their two vertices; triangles and vertices by their place in your arrays.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_report {
    pub struct_size: u32,
    /// 1 if the mesh bounds a solid, else 0.
    pub solid: u32,
    /// 1 if it bounds a solid and there is no defect at all, else 0.
    pub clean: u32,
    /// Number of parts that are connected by edges.
    pub components: u32,
    /// Edges of one triangle only.
    pub open_edges: u32,
    pub first_open_edge: [u32; 2],
    /// Edges of more than two triangles.
    pub non_manifold_edges: u32,
    pub first_non_manifold_edge: [u32; 2],
    /// Edges of two triangles that both use it in the same direction: one of them is wound the wrong way.
    pub inconsistent_edges: u32,
    pub first_inconsistent_edge: [u32; 2],
    /// Triangles without area, to rounding of their coordinates.
    pub degenerate_triangles: u32,
    pub first_degenerate_triangle: u32,
    /// Triangles with the same three vertices as one before, in any order.
    pub duplicate_triangles: u32,
    pub first_duplicate_triangle: u32,
    /// Vertices of no triangle.
    pub unreferenced_vertices: u32,
    pub first_unreferenced_vertex: u32,
    /// Closed components that are wound inward and are no cavity of another.
    pub inverted_components: u32,
    /// Closed components without volume, to rounding.
    pub flat_components: u32,
}
gaps!(qdist_mesh_report);
versioned!(qdist_mesh_report);

/// Volume integrals at density 1.
#[repr(C)]
pub struct qdist_mesh_mass {
    /// Positive.
    pub volume: f64,
    /// Centre of mass, in the mesh's frame.
    pub centre: [f64; 3],
    /// Inertia tensor about the centre of mass, integral of |x|^2 1 - x x^T, in the mesh's axes, row-major.
    pub inertia: [f64; 9],
}
gaps!(qdist_mesh_mass);

/// Makes a mesh of `vertex_count` vertices (x, y, z) and `triangle_count` triangles (three indices from 0), at most 2^30 of each
/// (else QDIST_ERROR_CAPACITY). Allocates; O(n log n), some 4 microseconds per triangle (`./x figures`).
///
/// which: of QDIST_ERROR_MESH_INDEX the triangle, of QDIST_ERROR_MESH_VERTEX the vertex; or NULL.
///
/// Status: MESH_EMPTY (triangle_count is 0), MESH_INDEX (triangles; also where vertex_count is 0), MESH_VERTEX (xyz), MESH_COLLINEAR (xyz),
/// CAPACITY (vertex_count or triangle_count).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_create(
    xyz: In<f64>,
    vertex_count: u32,
    triangles: In<u32>,
    triangle_count: u32,
    mesh: Out<*mut qdist_mesh>,
    which: Out<u32>,
) -> qdist_status {
    guard(|| {
        mesh.checked()?;
        which.optional()?;
        if triangle_count == 0 {
            return Err(QDIST_ERROR_MESH_EMPTY);
        }
        let times_three = |n: u32| (n as usize).checked_mul(3);
        let triangles = triangles.array(times_three(triangle_count))?;
        let xyz = match vertex_count {
            0 => &[],
            _ => xyz.array(times_three(vertex_count))?,
        };
        let (vertices, triangles) = (xyz.as_chunks::<3>().0, triangles.as_chunks::<3>().0);
        let model = Model::new(vertices, triangles).map_err(|error| {
            let (status, place) = from_model(error);
            if let Some(place) = place
                && !which.is_null()
            {
                // (Aligned: looked at before.)
                which.put(place as u32).ok();
            }
            status
        })?;
        mesh.put(Box::into_raw(Box::new(qdist_mesh { model: Arc::new(model) })))
    })
}

/// The status, and the place of what is wrong.
fn from_model(error: ModelError) -> (qdist_status, Option<usize>) {
    match error {
        ModelError::Mesh(MeshError::NoTriangles) => (QDIST_ERROR_MESH_EMPTY, None),
        ModelError::Mesh(MeshError::TooMany) => (QDIST_ERROR_CAPACITY, None),
        ModelError::Mesh(MeshError::IndexOutOfRange { triangle, .. }) => (QDIST_ERROR_MESH_INDEX, Some(triangle)),
        ModelError::Mesh(MeshError::BadCoordinate { vertex }) => (QDIST_ERROR_MESH_VERTEX, Some(vertex)),
        // Points without a hull would have been refused above.
        _ => (QDIST_ERROR_MESH_COLLINEAR, None),
    }
}

/// Makes another mesh of the same triangles, with convex pieces inside of it from which depth queries prove lower bounds; both meshes of a pair
/// need them. Without, `lower` is 0. Allocates; about a second for 3,000 triangles (`./x figures`). QDIST_ERROR_MESH_NOT_SOLID if there is no inside,
/// rounding cannot tell it, or a coordinate is above 1e50.
///
/// Status: MESH_NOT_SOLID (mesh).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_certify(mesh: In<qdist_mesh>, certified: Out<*mut qdist_mesh>) -> qdist_status {
    guard(|| {
        certified.checked()?;
        let model = Model::clone(&mesh.get()?.model);
        let model = model.with_pieces(&BuildOptions::default()).map_err(|_| QDIST_ERROR_MESH_NOT_SOLID)?;
        certified.put(Box::into_raw(Box::new(qdist_mesh { model: Arc::new(model) })))
    })
}

/// Frees a mesh; NULL is nothing. Pairs of it stay valid: they share what they need, and the last one frees it.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_free(mesh: Out<qdist_mesh>) {
    // SAFETY: the header: from qdist_mesh_create or qdist_mesh_certify, once.
    drop(unsafe { mesh.boxed() });
}

/// What is wrong with the mesh, and whether it bounds a solid. Intersections of the mesh with itself are not looked for. O(1).
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_check(mesh: In<qdist_mesh>, report: Out<qdist_mesh_report>) -> qdist_status {
    guard(|| {
        report.known()?;
        let mesh = mesh.get()?.model.mesh();
        let found = mesh.report();
        let edge = |list: &[u32]| {
            let edge = list.first().and_then(|&e| mesh.topology().edges().get(e as usize));
            edge.map_or([QDIST_MESH_NONE; 2], |edge| edge.vertices)
        };
        let first = |list: &[u32]| list.first().copied().unwrap_or(QDIST_MESH_NONE);
        let count = |list: &[u32]| list.len() as u32;
        report.put_version(qdist_mesh_report {
            struct_size: size_of::<qdist_mesh_report>() as u32,
            solid: found.solid.into(),
            clean: found.is_clean().into(),
            components: found.components,
            open_edges: count(&found.open_edges),
            first_open_edge: edge(&found.open_edges),
            non_manifold_edges: count(&found.non_manifold_edges),
            first_non_manifold_edge: edge(&found.non_manifold_edges),
            inconsistent_edges: count(&found.inconsistent_edges),
            first_inconsistent_edge: edge(&found.inconsistent_edges),
            degenerate_triangles: count(&found.degenerate_triangles),
            first_degenerate_triangle: first(&found.degenerate_triangles),
            duplicate_triangles: count(&found.duplicate_triangles),
            first_duplicate_triangle: first(&found.duplicate_triangles),
            unreferenced_vertices: count(&found.unreferenced_vertices),
            first_unreferenced_vertex: first(&found.unreferenced_vertices),
            inverted_components: count(&found.inverted_components),
            flat_components: count(&found.flat_components),
        })
    })
}

/// Volume, centre of mass and inertia of the solid, or QDIST_ERROR_MESH_NOT_SOLID. Allocates for the time of the call; O(n log n).
///
/// Status: MESH_NOT_SOLID (mesh).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_integrate(mesh: In<qdist_mesh>, mass: Out<qdist_mesh_mass>) -> qdist_status {
    guard(|| {
        mass.checked()?;
        let model = &mesh.get()?.model;
        if model.sigma().is_none() {
            return Err(QDIST_ERROR_MESH_NOT_SOLID);
        }
        let found = MassProperties::new(model.mesh().vertices(), model.mesh().triangles());
        let found = found.map_err(|_| QDIST_ERROR_MESH_NOT_SOLID)?;
        let mut inertia = [0.0; 9];
        // The tensor is symmetric: rows are columns.
        inertia.copy_from_slice(found.inertia.as_slice());
        mass.put(qdist_mesh_mass { volume: found.volume, centre: found.centre.coords.into(), inertia })
    })
}
