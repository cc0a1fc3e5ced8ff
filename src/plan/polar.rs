//! Open sets: a direction in which A ends at the origin.
//!
//! Where A contains the origin, d is 0 exactly when some direction u has h_A(u) = 0, that is, when u is in the polar cone of A. For that it only matters
//! in which directions A's points are, not how far out. So the points known are put on the unit sphere, and the point x of their
//! hull that is nearest to the origin gives the deepest direction of their polar cone:
//!
//! ```text
//! u = -x / |x|,     u.p <= -|x| |p|     for all p known
//! ```
//!
//! A segment Q = [0, q] asks for more: u.q > 0, which -q as one more point gives. A is asked along u. If it ends at the origin there, that is the proof; else its point joins the others (this is GJK, on the sphere). A grasp that is
//! open takes a few steps of some hundred instructions each, where facets in six dimensions cost a hundred times as much. Where the hull contains the
//! origin, or nearly so, the first simplex is around the origin, nearly so: expansion is the plan.

use crate::math::{Vector, norm};
use crate::polytope::Polytope;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::query::Query;
use crate::scalar::Real;
use crate::support::Failure;

/// Steps for each dimension.
const STEPS: usize = 2;

/// A cone of points this near to a half space is left to expansion.
const WIDE: f64 = 1e-3;

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// After the first simplex: is A found to end at the origin? Not asked in two and three dimensions, where a facet costs less than a step.
    pub(super) fn ends_at_origin(&self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        let around = || self.nearest_facet().is_none_or(|(_, _, offset)| offset > T::zero());
        if N <= 3 || !query.contains_origin() || query.options.threshold.is_some() || around() {
            return Ok(false);
        }
        self.look_for_end(query)
    }

    #[inline(never)]
    fn look_for_end(&self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        let mut hull = Simplex::vacant();
        if query.rays() == 1 {
            join(&mut hull, &-query.ray(0));
        }
        for vertex in self.vertices() {
            join(&mut hull, &vertex.point);
        }
        for _ in 0..STEPS * N {
            hull.minimize(T::count(8 * N) * T::ROUNDOFF);
            let nearest = hull.point();
            let distance = norm(&nearest);
            if !(distance > T::of(WIDE)) || query.exhausted().is_some() {
                return Ok(false);
            }
            let (vertex, _) = query.support(&(nearest * (-T::one() / distance)))?;
            if query.is_spent() {
                return query.verify();
            }
            if !join(&mut hull, &vertex.point) {
                return Ok(false);
            }
        }
        Ok(false)
    }
}

/// Adds the direction of a point; false when the point is the origin or the hull has enough.
fn join<T: Real, const N: usize>(hull: &mut Simplex<T, N>, point: &Vector<T, N>) -> bool {
    let length = norm(point);
    if !(length > T::zero()) {
        return false;
    }
    let point = point * (T::one() / length);
    let vertex = Vertex { point, witness: point };
    if !hull.corners().is_empty() {
        return hull.push(vertex);
    }
    hull.restart(&vertex);
    true
}
