//! Which vertices are corners of the convex hull.
//!
//! The largest displacement of a body is that of a corner of its convex hull: a convex function has its maximum over a
//! polytope at a corner. So the others need not be looked at. The hull is that of [`prepare_hull`], exact but for 2^-59 of the
//! points' spread: a corner that sticks out by less may be missing, and what it would add to a displacement is less than a hundredth of what
//! rounding adds to the sum that displacements are made of.
//!
//! Flat sets are kept whole, but for repeated points.

use crate::solver::prepare::{HullFacet, hull_facets, prepare_hull};
use crate::support::large_graph_len;
use core::fmt;
use nalgebra::Point3;

/// Why a set of points has no hull.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
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

/// Positions of the points that are corners of the hull, ascending. Of equal points the first; of points in a plane all.
///
/// # Errors
/// [`HullError`].
///
/// Cost: O(n log n) for points as they come.
pub fn hull_vertices(points: &[Point3<f64>]) -> Result<Vec<u32>, HullError> {
    if points.is_empty() {
        return Err(HullError::Empty);
    }
    if let Some(vertex) = points.iter().position(|p| p.iter().any(|x| !(x.abs() < 1e150))) {
        return Err(HullError::NotFinite { vertex });
    }
    let mut kept = distinct(points);
    let place: Vec<[f64; 3]> = kept.iter().map(|&i| points[i as usize].into()).collect();
    let mut words = vec![0u32; large_graph_len(place.len())];
    let mut facets = vec![HullFacet::EMPTY; hull_facets(place.len())];
    if let Ok(graph) = prepare_hull(&place, &mut words, &mut facets, None) {
        let mut corners = (0..).map(|i| !graph.neighbors(i).is_empty());
        kept.retain(|_| corners.next() == Some(true));
    }
    Ok(kept)
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
