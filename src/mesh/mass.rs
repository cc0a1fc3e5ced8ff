//! Volume, centre of mass and inertia of a solid given by its surface.
//!
//! The divergence theorem turns a volume integral into a sum over triangles: with any point o as apex, every triangle
//! (a, b, c) is a tetrahedron of signed volume D/6, D = det(a-o, b-o, c-o), and over all of them
//!
//! ```text
//! V = sum D / 6       integral x = sum D (a+b+c) / 24       integral x x^T = sum D (s s^T + a a^T + b b^T + c c^T) / 120
//! ```
//!
//! with s = a + b + c. These are exact for polyhedra. The apex is the middle of the mesh's box, so a mesh far from the
//! frame's origin loses nothing to cancellation but what its coordinates lost already.
//!
//! A surface bounds a solid when its edges cancel: every directed edge is met by as many of the opposite direction.
//! Corners are compared by position, so a triangle soup with repeated vertices is closed when its corners are equal bit
//! for bit. An open surface has no volume, and that is an error, not a guess.

use core::fmt;
use nalgebra::{Matrix3, Point3, Vector3};

/// Mass properties at density 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Volume, positive.
    pub volume: f64,
    /// Centre of mass, in the mesh's frame.
    pub centre: Point3<f64>,
    /// Inertia tensor about the centre of mass, integral of |x|^2 1 - x x^T, in the mesh's axes.
    pub inertia: Matrix3<f64>,
}

/// Why a surface has no mass properties.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MassError {
    /// There are no triangles.
    Empty,
    /// This triangle names a vertex that does not exist.
    Index {
        /// Position in the list of triangles.
        triangle: usize,
    },
    /// This vertex has a coordinate that is not finite, or so large that its products are not.
    NotFinite {
        /// Position in the list of vertices.
        vertex: usize,
    },
    /// The surface is not closed, so that it has no volume.
    Open {
        /// Directed edges without an opposite one.
        edges: usize,
        /// One of them, by its vertices.
        example: [u32; 2],
    },
    /// The surface is inside out: its volume is negative.
    Inverted {
        /// The negative volume.
        volume: f64,
    },
    /// The surface encloses no volume beyond rounding.
    Flat,
    /// The surface crosses itself, and so much of it is wound inward that the integrals are those of no body: the centre of mass is
    /// out of the box, or a second moment is negative.
    Tangled,
}

impl fmt::Display for MassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MassError::Empty => write!(f, "no triangles"),
            MassError::Index { triangle } => write!(f, "triangle {triangle} names a vertex that does not exist"),
            MassError::NotFinite { vertex } => write!(f, "vertex {vertex} is not finite, or too large"),
            MassError::Open { edges, example: [a, b] } => {
                write!(f, "the surface is open and has no volume: {edges} unmatched edges, one from vertex {a} to {b}")
            }
            MassError::Inverted { volume } => write!(f, "the surface is inside out: volume {volume}"),
            MassError::Flat => write!(f, "the surface encloses no volume"),
            MassError::Tangled => write!(f, "the surface crosses itself and is inside out in parts"),
        }
    }
}

impl std::error::Error for MassError {}

/// Rounding of the centre, in sizes of the box, and of second moments, in the largest.
const TANGLED: f64 = 1e-9;

impl MassProperties {
    /// Integrates over the solid that these triangles bound (counterclockwise seen from outside).
    ///
    /// # Errors
    /// [`MassError`]: bad indices or coordinates, a surface that is open, inside out, flat or tangled. Where parts overlap,
    /// their volumes add up.
    ///
    /// Cost: sorts the edges; O(n log n).
    pub fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<Self, MassError> {
        if triangles.is_empty() {
            return Err(MassError::Empty);
        }
        let corner = |index: u32| vertices.get(index as usize);
        if let Some(triangle) = triangles.iter().position(|t| t.iter().any(|&i| corner(i).is_none())) {
            return Err(MassError::Index { triangle });
        }
        if let Some(vertex) = vertices.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(MassError::NotFinite { vertex });
        }
        closed(vertices, triangles)?;

        let used = || triangles.iter().flatten().filter_map(|&i| corner(i));
        let low = used().fold(Vector3::repeat(f64::MAX), |m, p| m.inf(&p.coords));
        let high = used().fold(Vector3::repeat(f64::MIN), |m, p| m.sup(&p.coords));
        let apex = low + (high - low) / 2.0;
        // In units of the size: no power of it overflows or vanishes on the way.
        let size = (high - low).amax();
        if size == 0.0 {
            return Err(MassError::Flat);
        }

        let (mut volume, mut gross) = (0.0, 0.0);
        let mut first = Vector3::zeros();
        let mut second = Matrix3::zeros();
        for t in triangles {
            let [a, b, c] = t.map(|i| (vertices[i as usize].coords - apex) / size);
            let (det, s) = (a.dot(&b.cross(&c)), a + b + c);
            volume += det / 6.0;
            gross += det.abs() / 6.0;
            first += s * (det / 24.0);
            second += (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose()) * (det / 120.0);
        }
        // Each determinant is off by a few roundoffs of the box.
        if volume.abs() <= 1e-13 * gross || volume.abs() <= 1e-16 * triangles.len() as f64 {
            return Err(MassError::Flat);
        }
        let scaled = |x: f64, power: i32| x * size.powi(power);
        if volume < 0.0 {
            return Err(MassError::Inverted { volume: scaled(volume, 3) });
        }
        let centre = first / volume;
        let central = second - centre * centre.transpose() * volume;
        let moments = central.symmetric_eigenvalues();
        if centre.amax() > 0.5 + TANGLED || !(moments.min() >= -TANGLED * moments.max()) {
            return Err(MassError::Tangled);
        }
        let inertia = Matrix3::identity() * central.trace() - central;
        let properties = MassProperties {
            volume: scaled(volume, 3),
            centre: Point3::from(apex + centre * size),
            inertia: inertia.map(|x| scaled(x, 5)),
        };
        let positive = properties.volume.is_normal() && properties.inertia.iter().all(|x| x.is_finite());
        if positive { Ok(properties) } else { Err(MassError::NotFinite { vertex: extreme(vertices) }) }
    }
}

/// The vertex with the largest coordinate.
fn extreme(vertices: &[Point3<f64>]) -> usize {
    let reach = |p: &Point3<f64>| p.coords.amax();
    (0..vertices.len()).max_by(|&i, &j| reach(&vertices[i]).total_cmp(&reach(&vertices[j]))).unwrap_or(0)
}

/// Every directed edge must cancel against the opposite one. `-0.0` equals `0.0`.
fn closed(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Result<(), MassError> {
    let place = |i: u32| vertices[i as usize].coords.map(|x| (x + 0.0).to_bits());
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.sort_unstable_by_key(|&i| <[u64; 3]>::from(place(i)));
    // The first vertex at each position stands for all of them.
    let mut stands: Vec<u32> = (0..vertices.len() as u32).collect();
    for pair in order.windows(2) {
        if let &[before, at] = pair
            && place(before) == place(at)
        {
            stands[at as usize] = stands[before as usize];
        }
    }
    let edges = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let mut balance: Vec<([u32; 2], i32, [u32; 2])> = triangles
        .iter()
        .flat_map(edges)
        .filter_map(|edge| {
            let [a, b] = edge.map(|i| stands[i as usize]);
            (a != b).then_some(if a < b { ([a, b], 1, edge) } else { ([b, a], -1, edge) })
        })
        .collect();
    balance.sort_unstable();
    let (mut open, mut example) = (0, [0, 0]);
    for group in balance.chunk_by(|x, y| x.0 == y.0) {
        let sum: i32 = group.iter().map(|x| x.1).sum();
        if sum != 0 {
            open += sum.unsigned_abs() as usize;
            example = group.iter().find(|x| x.1 == sum.signum()).map_or(example, |x| x.2);
        }
    }
    if open == 0 { Ok(()) } else { Err(MassError::Open { edges: open, example }) }
}
