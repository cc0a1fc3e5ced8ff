//! A mesh as the certificate needs it: that it is closed, where its surface is, and what is inside.
//!
//! The surface is closed and consistently wound exactly when every directed edge (a, b) occurs as often as (b, a); then the
//! winding number is an integer away from the surface, and the solid is where it is positive. Two sheets that touch in an edge are
//! allowed.

use super::super::proximity::{Stack, descend, winds_around};
use super::super::topology::Topology;
use super::super::triangle::nearest_to_origin;
use super::super::{Mesh, MeshError};
use nalgebra::{Point3, Vector3};

/// Why a mesh has no certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SolidError {
    /// No triangles.
    Empty,
    /// This vertex has a coordinate that is NaN, infinite, or so large that products overflow (above 1e50).
    Vertex(usize),
    /// This triangle names a vertex that does not exist.
    Index(usize),
    /// The directed edge from the first vertex to the second has no partner: the surface is open there, or a neighbour is
    /// wound the other way. A polygon soup has no inside.
    Open(u32, u32),
    /// The signed volume is not positive: the mesh is wound inside out, or flat.
    Volume,
    /// This component is wound inside out and is no cavity ([`Report`](crate::mesh::Report)), so the mesh is a polygon soup.
    Inverted(u32),
}

impl std::fmt::Display for SolidError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SolidError::Empty => write!(f, "triangles: there is none"),
            SolidError::Vertex(index) => write!(f, "vertices: number {index} is NaN, infinite or above 1e50"),
            SolidError::Index(index) => write!(f, "triangles: number {index} names a vertex that does not exist"),
            SolidError::Open(from, to) => {
                write!(
                    f,
                    "triangles: the edge from vertex {from} to {to} is open, or a neighbour is wound the other way"
                )
            }
            SolidError::Volume => write!(f, "triangles: the volume is not positive (wound inside out, or flat)"),
            SolidError::Inverted(component) => {
                write!(f, "triangles: component {component} is wound inside out and is no cavity")
            }
        }
    }
}

impl std::error::Error for SolidError {}

impl From<MeshError> for SolidError {
    fn from(error: MeshError) -> Self {
        match error {
            MeshError::NoTriangles => SolidError::Empty,
            // (So many have none of a higher number.)
            MeshError::TooMany => SolidError::Index(1 << 30),
            MeshError::IndexOutOfRange { triangle, .. } => SolidError::Index(triangle),
            MeshError::BadCoordinate { vertex } => SolidError::Vertex(vertex),
        }
    }
}

/// Coordinates above this are refused: sixth powers must stay finite.
const LARGEST: f64 = 1e50;

/// A triangle by its corners.
pub(super) type Corners = [Vector3<f64>; 3];

/// What rounding moves a nearest point by, at most: this share of the coordinates. Boxes that are farther by less are looked at as well.
const DOUBT: f64 = 1e-13;

/// A mesh whose surface is closed and wound outward.
pub(super) struct Solid<'m> {
    pub mesh: &'m Mesh,
    /// Largest distance of a vertex from the middle of the bounding box.
    pub radius: f64,
    pub middle: Vector3<f64>,
}

impl<'m> Solid<'m> {
    pub fn new(mesh: &'m Mesh) -> Result<Self, SolidError> {
        check_size(mesh.vertices())?;
        check_closed(mesh.topology())?;
        let used = || corners(mesh).flatten();
        let low = used().fold(Vector3::repeat(f64::MAX), |low, p| low.inf(&p));
        let high = used().fold(Vector3::repeat(f64::MIN), |high, p| high.sup(&p));
        let middle = (low + high) * 0.5;
        let radius = used().map(|p| (p - middle).norm()).fold(0.0, f64::max);
        let volume: f64 =
            corners(mesh).map(|[a, b, c]| (a - middle).cross(&(b - middle)).dot(&(c - middle)) / 6.0).sum();
        if volume > 1e-15 * radius.powi(3) { Ok(Solid { mesh, radius, middle }) } else { Err(SolidError::Volume) }
    }

    /// All triangles by their corners.
    pub fn corners(&self) -> impl Iterator<Item = Corners> + 'm {
        corners(self.mesh)
    }

    /// Is the point, which is not near the surface, inside?
    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        winds_around(self.mesh, &Point3::from(*p), &mut Vec::new())
    }

    /// The surface point nearest to `p`, and its squared distance; of equally near ones that of the first triangle.
    pub fn nearest(&self, p: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let mut best = (*p, f64::MAX, u32::MAX);
        look_around(self.mesh, p, &mut Vec::new(), |triangle, q| {
            let squared = q.norm_squared();
            if squared < best.1 || squared == best.1 && triangle < best.2 {
                best = (p + q, squared, triangle);
            }
            best.1
        });
        (best.0, best.1)
    }
}

/// All triangles by their corners.
pub(super) fn corners(mesh: &Mesh) -> impl Iterator<Item = Corners> + '_ {
    (0..mesh.triangles().len() as u32).map(|t| mesh.corners(t).map(|p| p.coords))
}

/// Tells `look` of each triangle the vector from `p` to its nearest point, for all that may be nearer, squared, than what it returned last.
pub(super) fn look_around(
    mesh: &Mesh,
    p: &Vector3<f64>,
    stack: &mut Stack,
    mut look: impl FnMut(u32, Vector3<f64>) -> f64,
) {
    let doubt = DOUBT * (mesh.scale() + p.amax());
    descend(mesh, &Point3::from(*p), f64::INFINITY, stack, |triangle, _| {
        let corners = mesh.corners(triangle).map(|x| x.coords - p);
        let reach = look(triangle, nearest_to_origin(&corners)).sqrt() + doubt;
        reach * reach
    });
}

/// What is too large for products of six coordinates.
pub(super) fn check_size(vertices: &[Point3<f64>]) -> Result<(), SolidError> {
    let usable = |p: &Point3<f64>| p.iter().all(|x| x.abs() <= LARGEST);
    vertices.iter().position(|p| !usable(p)).map_or(Ok(()), |bad| Err(SolidError::Vertex(bad)))
}

/// Every directed edge needs its opposite; one from a vertex to itself is that.
fn check_closed(topology: &Topology) -> Result<(), SolidError> {
    for &edge in &topology.unbalanced {
        let ([along, against], [from, to]) = (topology.uses[edge as usize], topology.edges()[edge as usize].vertices);
        if from != to {
            return Err(if along > against { SolidError::Open(from, to) } else { SolidError::Open(to, from) });
        }
    }
    Ok(())
}
