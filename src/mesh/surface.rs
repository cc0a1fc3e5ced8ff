//! A mesh, and everything that is derived from it once.

use super::bvh::Bvh;
use super::check::Report;
use super::cones::{Cap, caps};
use super::crossing::crosses_itself;
use super::topology::Topology;
use nalgebra::{Point3, Vector3};

/// Largest coordinate, in absolute value: products of four of them are still numbers.
pub const MAX_COORDINATE: f64 = 1e60;

/// Why these arrays are no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no triangle.
    NoTriangles,
    /// More than 2^30 vertices or triangles.
    TooMany,
    /// This triangle refers to a vertex that does not exist.
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// Its k-th corner, 0 to 2.
        corner: usize,
    },
    /// A coordinate of this vertex is not a number, infinite, or larger than [`MAX_COORDINATE`].
    BadCoordinate {
        /// Which vertex.
        vertex: usize,
    },
}

impl std::fmt::Display for MeshError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            MeshError::NoTriangles => write!(f, "triangles: there is none"),
            MeshError::TooMany => write!(f, "vertices or triangles: more than 2^30"),
            MeshError::IndexOutOfRange { triangle, corner } => {
                write!(f, "triangles: corner {corner} of triangle {triangle} is not the index of a vertex")
            }
            MeshError::BadCoordinate { vertex } => {
                write!(f, "vertices: a coordinate of vertex {vertex} is not finite or too large")
            }
        }
    }
}

impl std::error::Error for MeshError {}

/// A triangle mesh with its topology, its defects and its tree of boxes. It never changes.
#[derive(Clone, Debug)]
pub struct Mesh {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    corners: Vec<[Point3<f64>; 3]>,
    topology: Topology,
    report: Report,
    bvh: Bvh,
    /// Of the nodes of the tree; none for a polygon soup.
    caps: Vec<Cap>,
    scale: f64,
    /// Per vertex, the sum of the faces' unit normals, each times its angle there.
    vertex_normals: Vec<Vector3<f64>>,
    /// Per component, its vertices that are extreme along the axes: low x, high x, low y, ...
    extremes: Vec<[u32; 6]>,
}

impl Mesh {
    /// Takes triangles over vertices as they are; the corners of a triangle are counterclockwise seen from outside. What cannot be a
    /// mesh at all is refused; other defects are in the [`Report`]. Vertices may be `[f64; 3]` or points. O(n log n).
    pub fn new<P>(vertices: &[P], triangles: &[[u32; 3]]) -> Result<Mesh, MeshError>
    where
        P: Copy + Into<Point3<f64>>,
    {
        const MOST: usize = 1 << 30;
        if triangles.is_empty() {
            return Err(MeshError::NoTriangles);
        }
        if triangles.len() > MOST || vertices.len() > MOST {
            return Err(MeshError::TooMany);
        }
        let vertices: Vec<Point3<f64>> = vertices.iter().map(|&p| p.into()).collect();
        if let Some(vertex) = vertices.iter().position(|p| !p.iter().all(|x| x.abs() <= MAX_COORDINATE)) {
            return Err(MeshError::BadCoordinate { vertex });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(corner) = corners.iter().position(|&v| v as usize >= vertices.len()) {
                return Err(MeshError::IndexOutOfRange { triangle, corner });
            }
        }
        let mut topology = Topology::new(&vertices, triangles);
        let report = Report::new(&vertices, triangles, &topology);
        let corners: Vec<_> = triangles.iter().map(|t| t.map(|v| vertices[v as usize])).collect();
        let bvh = Bvh::new(&corners);
        let scale = corners.iter().flatten().fold(0.0f64, |m, p| m.max(p.coords.amax()));
        let plain = report.solid && !crosses_itself(&corners, &bvh, scale);
        topology.set_owners(vertices.len(), triangles, plain);
        let normals: Vec<_> = corners.iter().map(unit_normal).collect();
        let caps = if report.solid { caps(&bvh, vertices.len(), triangles, &topology, &normals) } else { Vec::new() };
        let extremes = extremes(&vertices, triangles, &topology);
        let vertex_normals = vertex_normals(vertices.len(), triangles, &corners);
        Ok(Mesh {
            vertices,
            triangles: triangles.to_vec(),
            corners,
            topology,
            report,
            bvh,
            caps,
            scale,
            vertex_normals,
            extremes,
        })
    }

    /// The vertices, as given.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// The triangles, as given.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> &[Point3<f64>; 3] {
        &self.corners[triangle as usize]
    }

    /// Edges and neighbourhoods.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// What is wrong with it.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Whether it bounds a solid; otherwise it is a polygon soup and has no inside.
    pub fn is_solid(&self) -> bool {
        self.report.solid
    }

    /// Lowest and highest coordinates of its triangles, to rounding outward.
    pub fn bounds(&self) -> (Point3<f64>, Point3<f64>) {
        let root = self.bvh.root();
        ((root.centre - root.half).into(), (root.centre + root.half).into())
    }

    /// The diagonal of its bounding box.
    pub fn diagonal(&self) -> f64 {
        2.0 * self.bvh.root().half.norm()
    }

    /// Largest coordinate of its triangles in absolute value: what rounding is relative to.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// The angle-weighted normal of a vertex. Where the vertex is nearest to a point, it says on which side of a closed
    /// surface the point is (Baerentzen and Aanaes 2005).
    pub(super) fn vertex_normal(&self, vertex: u32) -> Vector3<f64> {
        self.vertex_normals[vertex as usize]
    }

    /// The unit normal of a triangle; zero for a degenerate one.
    pub(super) fn normal(&self, triangle: u32) -> Vector3<f64> {
        unit_normal(self.corners(triangle))
    }

    pub(super) fn bvh(&self) -> &Bvh {
        &self.bvh
    }

    /// The cones of normals of the tree's nodes; empty for a polygon soup, which is met from any side.
    pub(super) fn caps(&self) -> &[Cap] {
        &self.caps
    }

    pub(super) fn extremes(&self) -> &[[u32; 6]] {
        &self.extremes
    }

    /// Whether the point is in the bounding box, or nearly.
    pub(super) fn is_in_bounds(&self, p: &Point3<f64>, slack: f64) -> bool {
        let root = self.bvh.root();
        let x: Vector3<f64> = (p.coords - root.centre).abs() - root.half;
        x.max() <= slack
    }
}

fn extremes(vertices: &[Point3<f64>], triangles: &[[u32; 3]], topology: &Topology) -> Vec<[u32; 6]> {
    let mut found: Vec<Option<[u32; 6]>> = vec![None; topology.component_count() as usize];
    for (corners, &component) in triangles.iter().zip(topology.components()) {
        for &v in corners {
            let six = found[component as usize].get_or_insert([v; 6]);
            for axis in 0..3 {
                let x = |v: u32| vertices[v as usize][axis];
                if x(v) < x(six[2 * axis]) {
                    six[2 * axis] = v;
                }
                if x(v) > x(six[2 * axis + 1]) {
                    six[2 * axis + 1] = v;
                }
            }
        }
    }
    found.into_iter().flatten().collect()
}

fn unit_normal([p, q, r]: &[Point3<f64>; 3]) -> Vector3<f64> {
    (q - p).cross(&(r - p)).try_normalize(0.0).unwrap_or_default()
}

fn vertex_normals(count: usize, triangles: &[[u32; 3]], corners: &[[Point3<f64>; 3]]) -> Vec<Vector3<f64>> {
    let mut sums = vec![Vector3::zeros(); count];
    for (triangle, p) in triangles.iter().zip(corners) {
        let normal = unit_normal(p);
        for k in 0..3 {
            sums[triangle[k] as usize] += normal * (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
        }
    }
    sums
}
