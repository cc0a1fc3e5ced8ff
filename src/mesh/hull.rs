//! Which vertices can be corners of the convex hull.
//!
//! The largest displacement of a body is that of a corner of its convex hull: a convex function has its maximum over a
//! polytope at a corner. So the others need not be looked at. What is wanted is a *filter*: it may keep points that are no
//! corners, which costs time, and must never drop a corner, which would cost truth. That makes it simple and robust:
//!
//! 1. Take the points farthest in some directions (in coordinates scaled to the box, so that needles and plates get
//!    their share), and let the core's polytope bookkeeping build the hull P of these few.
//! 2. Drop the points that lie beneath every facet of P by more than rounding. They are inside the hull of the points
//!    taken, whatever the error of the facets' normals: P is closed, winds once around its centre, and the segment from the
//!    centre to the point meets no facet (module `bounds`).
//! 3. Again with the normals of P's facets as directions, as long as that drops many.
//!
//! Flat sets and sets that are too small to be worth it are kept whole, but for repeated points.

use crate::scalar::Vector;
use crate::support::graph_len;
use crate::workspace::Workspace;
use core::fmt;
use nalgebra::{Point3, Vector3};

/// Corners of P at most: a facet takes 2 corners' memory, and every point is compared with every facet.
const CORNERS: usize = 512;
const FACETS: usize = 1100;
/// Directions of the first round.
const DIRECTIONS: usize = 100;

/// Why a set of points has no hull.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HullError {
    /// There are no points.
    Empty,
    /// This point has a coordinate that is not finite, or so large that its products are not.
    NotFinite {
        /// Position in the list.
        vertex: usize,
    },
}

impl fmt::Display for HullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            HullError::Empty => write!(f, "no points"),
            HullError::NotFinite { vertex } => write!(f, "point {vertex} is not finite, or too large"),
        }
    }
}

impl std::error::Error for HullError {}

/// Positions of the points that may be corners of the hull, ascending: all corners, and points within rounding of the
/// hull's surface or near where it is finely curved. Of equal points the first.
///
/// # Errors
/// [`HullError`].
///
/// Cost: some hundred operations a point for each of a few rounds.
pub fn hull_vertices(points: &[Point3<f64>]) -> Result<Vec<u32>, HullError> {
    if points.is_empty() {
        return Err(HullError::Empty);
    }
    if let Some(vertex) = points.iter().position(|p| p.iter().any(|x| !(x.abs() < 1e150))) {
        return Err(HullError::NotFinite { vertex });
    }
    let mut kept = distinct(points);
    let low = points.iter().fold(points[0].coords, |m, p| m.inf(&p.coords));
    let high = points.iter().fold(points[0].coords, |m, p| m.sup(&p.coords));
    let (middle, extent) = (low + (high - low) / 2.0, high - low);
    let near = |i: u32| points[i as usize].coords - middle;

    let weigh = extent.map(|e| if e > 0.0 { extent.amax() / e } else { 0.0 });
    let mut directions: Vec<Vector3<f64>> = sphere(DIRECTIONS).map(|d| d.component_mul(&weigh)).collect();
    let mut corners: Vec<u32> = Vec::new();
    while kept.len() > 2 * corners.len() + 16 {
        let known = corners.len();
        for direction in &directions {
            let height = |i: &&u32| near(**i).dot(direction);
            corners.extend(kept.iter().max_by(|i, j| height(i).total_cmp(&height(j))));
        }
        corners.sort_unstable();
        corners.dedup();
        if corners.len() == known || corners.len() > CORNERS {
            break;
        }
        let place: Vec<[f64; 3]> = corners.iter().map(|&i| near(i).into()).collect();
        let Some(facets) = facets(&place) else { break };
        // What rounding can do to a height: of the facet's normal, its offset, and the point.
        let tolerance = 128.0 * f64::EPSILON * extent.norm();
        let inside = |i: u32| facets.iter().all(|(n, offset)| n.dot(&near(i)) < offset - tolerance);
        let before = kept.len();
        kept.retain(|&i| !inside(i));
        if kept.len() > before - before / 8 {
            break;
        }
        directions = facets.into_iter().map(|(n, _)| n).collect();
    }
    Ok(kept)
}

/// Facets (outward unit normal, offset) of the hull of a few points; `None` where they are flat or the bookkeeping has doubts.
fn facets(points: &[[f64; 3]]) -> Option<Vec<(Vector3<f64>, f64)>> {
    let mut memory = Box::new(Workspace::<f64, 3, CORNERS, FACETS>::new());
    let mut solver = memory.solver();
    let mut words = vec![0; graph_len(points.len())];
    solver.prepare_hull(points, &mut words).ok()?;
    // The bookkeeping measures from the first point.
    let first = Vector::from(*points.first()?);
    let facets = solver.polytope.facets().map(|f| (f.normal, f.offset + f.normal.dot(&first))).collect();
    solver.polytope.is_sound().then_some(facets)
}

/// The first of each set of equal points.
fn distinct(points: &[Point3<f64>]) -> Vec<u32> {
    // -0.0 equals 0.0.
    let key = |i: &u32| points[*i as usize].coords.map(|x| (x + 0.0).to_bits()).into();
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by_key::<[u64; 3], _>(key);
    order.dedup_by_key::<_, [u64; 3]>(|i| key(i));
    order.sort_unstable();
    order
}

/// Evenly spread directions: Fibonacci's spiral.
fn sphere(count: usize) -> impl Iterator<Item = Vector3<f64>> {
    let golden = core::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z
    })
}
