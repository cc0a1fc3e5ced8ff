//! Growing a convex polytope inside a solid, from a point and a metric (Deits and Tedrake, *Computing large convex regions of
//! obstacle-free space through semidefinite programming*, 2014).
//!
//! The triangles are visited from near to far in the metric. One that no plane separates from the seed yet gets a plane through its nearest
//! point, tangent to the ellipsoid there: the triangle lies beyond. In the end every triangle lies beyond some plane, so what is
//! below all of them holds no surface, and is inside because the seed is. Then the metric becomes that of the polytope's
//! own inertia and the seed its centroid, and the polytope grows anew: along a tube, into the corners of a box.
//!
//! Where the nearest point is on a reentrant edge or corner, the triangle's own plane separates as well, and may leave more: it is
//! taken where its distance is at least a share `snap` of the point's. So polyhedral solids get pieces with their own faces.

use super::super::triangle::nearest_to_origin;
use super::cell::{Cell, Plane};
use super::solid::Solid;
use nalgebra::{Matrix3, Vector3};

/// A polytope grown around `seed`.
pub(super) struct Grown {
    pub seed: Vector3<f64>,
    /// Relative to the seed.
    pub cell: Cell,
    /// Relative to the seed, with unit normals.
    pub planes: Vec<Plane>,
}

impl Grown {
    /// The distance of the nearest plane from the seed.
    pub fn inradius(&self) -> f64 {
        self.planes.iter().map(|plane| plane.offset).fold(f64::MAX, f64::min)
    }
}

/// The first so many planes touch what they separate from; later ones cut deeper, ever more, so that smooth convex surfaces do
/// not ask for a plane per triangle.
const EXACT_PLANES: usize = 24;
const DEEPER: f64 = 3e-4;
const MOST_PLANES: usize = 200;

/// Grows from `seed`, which must be inside. `to_ball` maps the metric's unit ellipsoid to the unit ball. A triangle's own plane
/// is taken when its distance is at least the share `snap` of that of its nearest point. `None` where the polytope would
/// be too thin or too intricate.
pub(super) fn grow(solid: &Solid, seed: Vector3<f64>, to_ball: &Matrix3<f64>, snap: f64) -> Option<Grown> {
    let vertices: Vec<_> = solid.mesh.vertices().iter().map(|p| p.coords - seed).collect();
    let mapped: Vec<_> = vertices.iter().map(|p| to_ball * p).collect();
    let from_ball = to_ball.try_inverse()?.transpose();
    let mut order: Vec<_> = solid
        .mesh
        .triangles()
        .iter()
        .map(|t| {
            let nearest = nearest_to_origin(&t.map(|i| mapped[i as usize]));
            (nearest.norm_squared(), nearest, t)
        })
        .collect();
    order.sort_by(|x, y| x.0.total_cmp(&y.0));
    let half = 2.0 * (solid.radius + (seed - solid.middle).norm());
    let mut cell = Cell::cube(half);
    let mut planes: Vec<Plane> = Vec::new();
    let mut last = 0;
    for (squared, nearest, t) in order {
        let corners = t.map(|i| vertices[i as usize]);
        let beyond = |plane: &Plane| corners.iter().all(|p| plane.height(p) >= 0.0);
        if planes.get(last).is_some_and(beyond) {
            continue;
        }
        if let Some(found) = planes.iter().position(beyond) {
            last = found;
            continue;
        }
        let tangent = (to_ball.transpose() * nearest).try_normalize(0.0)?;
        let mut normal = tangent;
        if let Some(own) = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(0.0) {
            // The distance of the plane n.x = o from the origin, in the metric: o / |L^-T n|.
            let distance = own.dot(&corners[0]) / (from_ball * own).norm();
            if distance > 0.0 && distance * distance >= snap * snap * squared {
                normal = own;
            }
        }
        let reach = corners.iter().map(|p| normal.dot(p)).fold(f64::MAX, f64::min);
        let depth = DEEPER * planes.len().saturating_sub(EXACT_PLANES) as f64;
        let plane = Plane { normal, offset: reach * (1.0 - depth.min(0.5)) };
        if !(plane.offset > 1e-9 * solid.radius) || planes.len() >= MOST_PLANES {
            return None;
        }
        cell.cut(&plane);
        planes.push(plane);
        last = planes.len() - 1;
    }
    Some(Grown { seed, cell, planes })
}

/// The metric of a covariance: L with L^T L its inverse.
pub(super) fn metric_of(covariance: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let scale = covariance.trace();
    let lower = (covariance / scale).cholesky()?.l();
    let metric = lower.try_inverse()?;
    metric.iter().all(|x| x.is_finite()).then_some(metric)
}
