//! Bodies that turn about a common axis: a plane problem.
//!
//! When A and B are both symmetric about one axis (two cylinders on a shaft, a cone in a coaxial capsule), so is M = A - B,
//! and its minima of h_M often form a circle. Expansion in space would have to tile that circle: N facets leave an
//! error of order 1/N^2. But M is the solid of revolution of its meridian section, and
//!
//! ```text
//! min over u of h_M(u) = min over u in the meridian plane of h_M(u)
//! ```
//!
//! so the polygon that grows in the half plane (the other half is its mirror image) gives the same bracket in a few steps. Its
//! vertices, ordered by direction, are a chain from the lowest support point to the highest; the edge that bounds d is pushed
//! out as in Algorithm 1.

use crate::answer::{Answer, Plan, Stop};
use crate::bounds::Bracket;
use crate::query::Query;
use crate::scalar::{Real, Vector, norm};
use crate::simplex::Simplex;
use crate::solver::Solver;
use crate::support::Failure;

/// An edge of the chain: its first vertex, its unit outward normal and its offset.
struct Edge<T: Real> {
    position: usize,
    normal: Vector<T, 3>,
    offset: T,
}

impl<T: Real> Solver<'_, T, 3> {
    /// The bracket by expansion in the plane of `axis` and a vector orthogonal to it (both unit). `None` when the origin is not certainly
    /// inside the section, when the section is flat, or when memory is short: then expansion in space decides.
    pub(crate) fn solve_meridian(&mut self, query: &mut Query<'_, T, 3>, axis: &Vector<T, 3>) -> Option<Answer<T, 3>> {
        self.polytope.reset();
        let (stop, edge, lower) = match self.expand_chain(query, axis, &across(axis)) {
            Ok(found) => found?,
            Err(_) => return None,
        };
        let vertices = self.polytope.vertices();
        let mut witness = Simplex::new(*vertices.get(edge.position)?);
        witness.push(*vertices.get(edge.position + 1)?);
        witness.minimize(self.polytope.resolution());
        query.plan = Plan::Meridian;
        Some(self.report(query, stop, lower, witness))
    }

    /// Grows the chain until its bracket ends the query.
    #[allow(clippy::type_complexity)]
    fn expand_chain(
        &mut self,
        query: &mut Query<'_, T, 3>,
        axis: &Vector<T, 3>,
        outward: &Vector<T, 3>,
    ) -> Result<Option<(Stop, Edge<T>, T)>, Failure> {
        let (bottom, depth) = query.support(&-axis)?;
        let (side, _) = query.support(outward)?;
        let (top, height) = query.support(axis)?;
        for vertex in [bottom, side, top] {
            if self.polytope.add_vertex(vertex).is_none() {
                return Ok(None);
            }
        }
        // The plane faces at both ends are final: their offsets are support values.
        let ends = depth.at_most(height);
        loop {
            let Some(edge) = self.lowest_edge(axis, outward) else { return Ok(None) };
            let inradius = edge.offset.at_most(ends);
            let Some(lower) = query.lower_from_offset(inradius, query.margin()) else { return Ok(None) };
            let verdict = |query: &Query<'_, T, 3>| query.verdict(&Bracket { lower, upper: query.upper() });
            if let Some(stop) = verdict(query)
                && query.verify()?
            {
                return Ok(Some((stop, edge, lower)));
            }
            if let Some(stop) = query.exhausted() {
                return Ok(Some((stop, edge, lower)));
            }
            let (vertex, reached) = query.support(&edge.normal)?;
            if let Some(stop) = verdict(query)
                && query.verify()?
            {
                return Ok(Some((stop, edge, lower)));
            }
            if reached - edge.offset <= self.polytope.resolution() || edge.offset > ends {
                return Ok(Some((Stop::Rounding, edge, lower)));
            }
            if self.polytope.insert_in_chain(edge.position + 1, vertex).is_none() {
                return Ok(Some((Stop::Capacity, edge, lower)));
            }
        }
    }

    /// The edge of the chain with the lowest offset.
    fn lowest_edge(&self, axis: &Vector<T, 3>, outward: &Vector<T, 3>) -> Option<Edge<T>> {
        let vertices = self.polytope.vertices();
        let mut lowest: Option<Edge<T>> = None;
        for (position, (from, to)) in vertices.iter().zip(vertices.iter().skip(1)).enumerate() {
            let along = to.point - from.point;
            let (out, up) = (along.dot(outward), along.dot(axis));
            let length = (out * out + up * up).root();
            if !(length > T::zero()) {
                continue;
            }
            let normal = outward * (up / length) - axis * (out / length);
            let offset = normal.dot(&from.point).at_most(normal.dot(&to.point));
            if lowest.as_ref().is_none_or(|edge| offset < edge.offset) {
                lowest = Some(Edge { position, normal, offset });
            }
        }
        lowest
    }
}

/// A unit vector orthogonal to a unit vector.
fn across<T: Real>(axis: &Vector<T, 3>) -> Vector<T, 3> {
    let mut seed = Vector::<T, 3>::zeros();
    let [x, y, z] = [axis[0].abs(), axis[1].abs(), axis[2].abs()];
    let smallest = if x <= y && x <= z {
        0
    } else if y <= z {
        1
    } else {
        2
    };
    for i in 0..3 {
        if i == smallest {
            seed[i] = T::one();
        }
    }
    let mut out = seed - axis * axis.dot(&seed);
    out -= axis * axis.dot(&out);
    out * (T::one() / norm(&out))
}
