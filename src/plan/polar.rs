//! Open sets: a direction in which A ends at the origin.
//!
//! Where A contains the origin, and Q is not flat, d is 0 exactly when some direction u has h_A(u) = 0, that is, when u is in the polar cone of A. For that
//! it only matters in which directions A's points are, not how far out. So the points known are put on the unit sphere, and the point x of their
//! hull that is nearest to the origin gives the deepest direction of their polar cone (N + 1 of them at a time, those that count):
//!
//! ```text
//! u = -x / |x|,     u.p <= -|x| |p|     for these p
//! ```
//!
//! A segment Q = [0, q] asks for more: u.q > 0, which -q as one more point gives. A is asked along u. If it ends at the origin there, that is the proof;
//! else its point joins the others (this is GJK, on the sphere). A grasp that is open takes a few such steps, where each
//! point in six dimensions makes dozens of facets. A hull with the origin in it, or nearly so, says that A does not end there, as far as
//! its points tell: expansion is the plan.

use crate::math::{Vector, norm};
use crate::polytope::Polytope;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::query::Query;
use crate::scalar::Real;
use crate::support::Failure;

/// Steps for each dimension.
const STEPS: usize = 2;

/// A hull this near to the origin has it inside, for what it is worth.
const NEAR: f64 = 1e-3;

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// After the first simplex: is A found to end at the origin?
    pub(super) fn ends_at_origin(&self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        let around = || self.nearest_facet().is_none_or(|(_, _, offset)| offset > T::zero());
        if !may_end(query) || query.options.threshold.is_some() || around() {
            return Ok(false);
        }
        let mut hull = Simplex::vacant();
        if query.rays() == 1 {
            join(&mut hull, &-query.ray(0));
        }
        for vertex in self.vertices() {
            join(&mut hull, &vertex.point);
        }
        look_for_end(query, &mut hull, |query, _, _| query.is_spent())
    }

    /// Is A, which rays have told nothing about, found to end within the margin of the origin? No surface around the origin proves anything then.
    #[cold]
    pub(super) fn ends_near_origin(&self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        let Some(nearest) = self.nearest_facet().and_then(|(index, ..)| self.facet(index)).filter(|_| may_end(query))
        else {
            return Ok(false);
        };
        let mut hull = Simplex::vacant();
        for corner in self.corners(nearest).corners() {
            join(&mut hull, &corner.vertex.point);
        }
        look_for_end(query, &mut hull, |query, direction, height| height <= query.margin_along(direction))
    }
}

/// A that contains a ball around the origin does not end there. In two and three dimensions a facet costs less than a step.
fn may_end<T: Real, const N: usize>(query: &Query<'_, T, N>) -> bool {
    N > 3 && query.contains_origin() && !(query.bounds.radius > T::zero())
}

/// With a support value in a direction, and the end that it may be; the hull has the directions of points of A. Without shortcuts in the end.
#[inline(never)]
fn look_for_end<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    hull: &mut Simplex<T, N>,
    is_end: impl Fn(&Query<'_, T, N>, &Vector<T, N>, T) -> bool,
) -> Result<bool, Failure> {
    for _ in 0..STEPS * N {
        hull.minimize(T::count(8 * N) * T::ROUNDOFF);
        let nearest = hull.point();
        let distance = norm(&nearest);
        if !(distance > T::of(NEAR)) || query.exhausted().is_some() {
            return Ok(false);
        }
        let direction = nearest * (-T::one() / distance);
        let (vertex, height) = query.support(&direction)?;
        if is_end(query, &direction, height) {
            return query.verify();
        }
        if !join(hull, &vertex.point) {
            return Ok(false);
        }
    }
    Ok(false)
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
