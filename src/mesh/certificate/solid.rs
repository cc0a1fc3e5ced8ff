//! A closed mesh as the certificate needs it: where its surface is, and what is inside.
//!
//! The surface is closed and consistently wound exactly when every directed edge (a, b) occurs as often as (b, a); then the
//! winding number is an integer away from the surface, and the solid is where it is positive. Two sheets that touch in an edge are
//! allowed.

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

/// Coordinates above this are refused: sixth powers must stay finite.
const LARGEST: f64 = 1e50;

/// A triangle by its corners.
pub(super) type Corners = [Vector3<f64>; 3];

/// A closed, outward-wound surface.
pub(super) struct Solid {
    pub vertices: Vec<Vector3<f64>>,
    pub triangles: Vec<[usize; 3]>,
    /// Largest distance of a vertex from the middle of the bounding box.
    pub radius: f64,
    pub middle: Vector3<f64>,
}

impl Solid {
    pub fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<Self, SolidError> {
        if triangles.is_empty() {
            return Err(SolidError::Empty);
        }
        let usable = |p: &Point3<f64>| p.iter().all(|x| x.abs() <= LARGEST);
        if let Some(bad) = vertices.iter().position(|p| !usable(p)) {
            return Err(SolidError::Vertex(bad));
        }
        if let Some(bad) = triangles.iter().position(|t| t.iter().any(|&i| i as usize >= vertices.len())) {
            return Err(SolidError::Index(bad));
        }
        check_closed(triangles)?;
        let extreme = |far: fn(&Vector3<f64>, &Vector3<f64>) -> Vector3<f64>, start: f64| {
            let used = triangles.iter().flatten().map(|&i| vertices[i as usize].coords);
            used.fold(Vector3::repeat(start), |most, p| far(&most, &p))
        };
        let middle = (extreme(Vector3::inf, f64::MAX) + extreme(Vector3::sup, f64::MIN)) * 0.5;
        let solid = Solid {
            vertices: vertices.iter().map(|p| p.coords).collect(),
            triangles: triangles.iter().map(|t| t.map(|i| i as usize)).collect(),
            radius: 0.0,
            middle,
        };
        let radius = solid.triangles.iter().flatten().map(|&i| (solid.vertices[i] - middle).norm()).fold(0.0, f64::max);
        let volume: f64 =
            solid.corners().map(|[a, b, c]| (a - middle).cross(&(b - middle)).dot(&(c - middle)) / 6.0).sum();
        if volume > 1e-15 * radius.powi(3) { Ok(Solid { radius, ..solid }) } else { Err(SolidError::Volume) }
    }

    /// All triangles by their corners.
    pub fn corners(&self) -> impl Iterator<Item = Corners> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.vertices[i]))
    }

    /// Is the point, which is not near the surface, inside?
    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        contains(self.corners(), p)
    }

    /// The surface point nearest to `p`, and its squared distance.
    pub fn nearest(&self, p: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let mut best = (*p, f64::MAX);
        for t in self.corners() {
            let q = nearest_to_origin(&t.map(|x| x - p));
            if q.norm_squared() < best.1 {
                best = (p + q, q.norm_squared());
            }
        }
        best
    }
}

/// Is the winding number positive? By solid angles (van Oosterom and Strackee).
pub(super) fn contains(triangles: impl Iterator<Item = Corners>, p: &Vector3<f64>) -> bool {
    let half: f64 = triangles
        .map(|t| {
            let [a, b, c] = t.map(|x| x - p);
            let [x, y, z] = [a.norm(), b.norm(), c.norm()];
            let denominator = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
            a.dot(&b.cross(&c)).atan2(denominator)
        })
        .sum();
    half > std::f64::consts::PI
}

/// Every directed edge needs its opposite.
fn check_closed(triangles: &[[u32; 3]]) -> Result<(), SolidError> {
    let edge = |t: &[u32; 3], k: usize| (t[k], t[(k + 1) % 3]);
    let mut forth: Vec<_> = triangles.iter().flat_map(|t| (0..3).map(move |k| edge(t, k))).collect();
    let mut back: Vec<_> = forth.iter().map(|&(a, b)| (b, a)).collect();
    forth.sort_unstable();
    back.sort_unstable();
    match forth.iter().zip(&back).find(|(f, b)| f != b) {
        // The smaller one is in one list only.
        Some((&f, &b)) => Err(if f < b { SolidError::Open(f.0, f.1) } else { SolidError::Open(b.1, b.0) }),
        None => Ok(()),
    }
}

/// The point of a triangle nearest to the origin (Ericson, *Real-Time Collision Detection*, 5.1.5).
pub(super) fn nearest_to_origin(t: &Corners) -> Vector3<f64> {
    let [a, b, c] = t;
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return if d1 > d3 { a + ab * (d1 / (d1 - d3)) } else { *a };
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return if d2 > d6 { a + ac * (d2 / (d2 - d6)) } else { *a };
    }
    let va = d3 * d6 - d5 * d4;
    let (e, f) = (d4 - d3, d5 - d6);
    if va <= 0.0 && e >= 0.0 && f >= 0.0 {
        return if e + f > 0.0 { b + (c - b) * (e / (e + f)) } else { *b };
    }
    let sum = va + vb + vc;
    if sum > 0.0 { a + ab * (vb / sum) + ac * (vc / sum) } else { *a }
}
