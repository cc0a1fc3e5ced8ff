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
//! so points of the half plane (the other half is its mirror image) give the same bracket in a few steps. (They are points in one word. Shallow contact
//! that needs two is expanded in space after all, where its minimum is at a pole. A circle stays as it is: tips of cones, long thin bodies.)
//!
//! # The chain, and what it proves
//!
//! Write x = (radius, height) for points of the half plane. A chain of points leads from the lowest support point to the farthest one and on
//! to the highest. Each edge has a unit normal n with n.radius >= 0, pointing down or level in the lower part and up or level in the upper
//! part, and an offset: both ends of the edge have n.x >= offset. The ends of the chain have the normals (0, -1) and (0, 1), the farthest
//! point (1, 0) as well.
//!
//! *If all these offsets are at least d > 0, then every direction u of the half plane has a point of the chain with u.x >= d.* For u
//! lies between two normals n, m that follow one another, and they share a point x: u = a n + b m with a, b >= 0, and a + b >= 1
//! since u, n and m are unit vectors; so u.x = a n.x + b m.x >= (a + b) d >= d. (The normals of each part lie in one quadrant, so the arcs
//! between them cover it.)
//!
//! Nothing is asked of the chain's shape, nor of the accuracy of the normals: what is not convex, by rounding or because the points are bounds themselves (module
//! `sectors`), is loose, not false. The edge that bounds d is pushed out as in Algorithm 1; where its normal would leave its
//! quadrant it is turned back to the border.

use crate::bounds::Bracket;
use crate::math::{Vector, norm};
use crate::polytope::simplex::{Simplex, Vertex};
use crate::polytope::{Edge, Index, Polytope};
use crate::query::Query;
use crate::query::answer::{Answer, Plan, Stop};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::Failure;

/// The half plane that a chain lies in, and what may be stored for its directions.
pub(crate) trait Section<T: Real> {
    /// The axis and the direction of growing radius, orthogonal unit vectors.
    fn frame(&self) -> (&Vector<T, 3>, &Vector<T, 3>);
    /// The point for a direction of the half plane.
    fn ask(&self, query: &mut Query<'_, T, 3>, direction: &Vector<T, 3>) -> Result<Vertex<T, 3>, Failure>;
    /// Radius of a stored point, and its height towards the upper or the lower pole.
    fn place(&self, vertex: &Vertex<T, 3>, upper: bool) -> [T; 2];
    /// Does this lowest offset end the search?
    fn judge(&self, query: &mut Query<'_, T, 3>, offset: T) -> Result<Option<Stop>, Failure>;
}

/// Where the growth of a chain ended.
pub(crate) struct Traced<T> {
    pub stop: Stop,
    /// The lowest offset.
    pub offset: T,
    /// The vertices of the lowest edge.
    pub ends: [Index; 2],
}

/// Grows a chain from its three first points: lowest, farthest, highest. `None` when one of them is not
/// beyond the origin, or the memory too small for a chain.
pub(crate) fn trace<T: Real, S: Section<T>>(
    polytope: &mut Polytope<'_, T, 3>,
    query: &mut Query<'_, T, 3>,
    section: &S,
    [lowest, farthest, highest]: [Vertex<T, 3>; 3],
) -> Result<Option<Traced<T>>, Failure> {
    polytope.reset();
    let [_, down] = section.place(&lowest, false);
    let [out, _] = section.place(&farthest, true);
    let [_, up] = section.place(&highest, true);
    let (Some(below), Some(side), Some(above)) =
        (polytope.add_vertex(lowest), polytope.add_vertex(farthest), polytope.add_vertex(highest))
    else {
        return Ok(None);
    };
    let first = [edge(polytope, section, [side, below], false), edge(polytope, section, [side, above], true)];
    for edge in first {
        if edge.and_then(|edge| polytope.add_edge(&edge)).is_none() {
            return Ok(None);
        }
    }
    // These normals are final.
    let fixed = down.at_most(up).at_most(out);
    if !(fixed > T::zero()) {
        return Ok(None);
    }
    loop {
        let Some(lowest) = polytope.take_lowest_edge() else { return Ok(None) };
        let offset = lowest.offset.at_most(fixed);
        let end = |stop| Ok(Some(Traced { stop, offset, ends: lowest.ends }));
        if let Some(stop) = section.judge(query, offset)? {
            return end(stop);
        }
        if let Some(stop) = query.exhausted() {
            return end(stop);
        }
        let vertex = section.ask(query, &lowest.normal)?;
        if let Some(stop) = section.judge(query, offset)? {
            return end(stop);
        }
        let least = lowest.normal_height(section, &vertex) - lowest.offset;
        if !(least > query.resolution()) || lowest.offset > fixed {
            return end(Stop::Rounding);
        }
        let Some(middle) = polytope.add_vertex(vertex) else { return end(Stop::Capacity) };
        let [from, to] = lowest.ends;
        let halves = [[from, middle], [middle, to]].map(|ends| edge(polytope, section, ends, lowest.upper));
        for half in halves {
            let Some(half) = half else { return end(Stop::Rounding) };
            // What is no better than before is no convex chain: its points are bounds that this plane cannot sharpen.
            if half.offset < lowest.offset - query.resolution() {
                return end(Stop::Rounding);
            }
            if polytope.add_edge(&half).is_none() {
                return end(Stop::Capacity);
            }
        }
    }
}

impl<T: Real> Edge<T> {
    /// The height of a stored point over the origin, along the edge's normal.
    fn normal_height<S: Section<T>>(&self, section: &S, vertex: &Vertex<T, 3>) -> T {
        let (axis, outward) = section.frame();
        let [radius, height] = section.place(vertex, self.upper);
        self.normal.dot(outward) * radius + self.normal.dot(axis).abs() * height
    }
}

/// The edge between two stored points, its normal in its quadrant.
fn edge<T: Real, S: Section<T>>(
    polytope: &Polytope<'_, T, 3>,
    section: &S,
    ends: [Index; 2],
    upper: bool,
) -> Option<Edge<T>> {
    let (axis, outward) = section.frame();
    let [from, to] = ends;
    let [r, h] = section.place(polytope.vertices().get(usize::from(from))?, upper);
    let [s, g] = section.place(polytope.vertices().get(usize::from(to))?, upper);
    let across = Vector::<T, 2>::new((g - h).at_least(T::zero()), (r - s).at_least(T::zero()));
    let length = norm(&across);
    let n = if length > T::zero() { across * (T::one() / length) } else { Vector::<T, 2>::new(T::one(), T::zero()) };
    let offset = (n.x * r + n.y * h).at_most(n.x * s + n.y * g);
    let normal = outward * n.x + if upper { axis * n.y } else { axis * -n.y };
    Some(Edge { ends, upper, normal, offset })
}

/// The half plane of an axis that all of M turns about.
struct Half<T: Real> {
    axis: Vector<T, 3>,
    outward: Vector<T, 3>,
}

impl<T: Real> Section<T> for Half<T> {
    fn frame(&self) -> (&Vector<T, 3>, &Vector<T, 3>) {
        (&self.axis, &self.outward)
    }
    fn ask(&self, query: &mut Query<'_, T, 3>, direction: &Vector<T, 3>) -> Result<Vertex<T, 3>, Failure> {
        Ok(query.support(direction)?.0)
    }
    fn place(&self, vertex: &Vertex<T, 3>, upper: bool) -> [T; 2] {
        let height = vertex.point.dot(&self.axis);
        [vertex.point.dot(&self.outward), if upper { height } else { -height }]
    }
    fn judge(&self, query: &mut Query<'_, T, 3>, offset: T) -> Result<Option<Stop>, Failure> {
        let Some(lower) = query.lower_from_offset(offset, query.margin()) else { return Ok(None) };
        let verdict = query.verdict(&Bracket { lower, upper: query.upper() });
        Ok(if verdict.is_some() && query.verify()? { verdict } else { None })
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// The bracket by expansion in the plane of `axis` and a vector orthogonal to it (both unit). `None` when the origin is not certainly
    /// inside the section, when the section is flat, or when memory is short: then expansion in space decides.
    pub(crate) fn solve_meridian(&mut self, query: &mut Query<'_, T, 3>, axis: &Vector<T, 3>) -> Option<Answer<T, 3>> {
        let half = Half { axis: *axis, outward: across(axis) };
        let mut ask = |direction: &Vector<T, 3>| query.support(direction).ok();
        let first = [ask(&-axis)?.0, ask(&half.outward)?.0, ask(axis)?.0];
        let traced = trace(&mut self.polytope, query, &half, first).ok()??;
        let lower = query.lower_from_offset(traced.offset, query.margin())?;
        let witness = self.touching_edge(query, axis, &traced)?;
        query.plan = Plan::Meridian;
        Some(self.report(query, traced.stop, lower, witness))
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// The points of M that the best direction's plane touches: of the lowest edge, or the end of the axis. (A body of revolution contains the
    /// middle of its highest circle.)
    fn touching_edge(&self, query: &Query<'_, T, 3>, axis: &Vector<T, 3>, traced: &Traced<T>) -> Option<Simplex<T, 3>> {
        let vertices = self.polytope.vertices();
        let best = query.best.direction.dot(axis);
        let pole = if best > T::zero() { *axis } else { -axis };
        if query.best.direction == pole {
            let Vertex { point, witness } = vertices.get(if best > T::zero() { 2 } else { 0 })?;
            let on_axis = |x: &Vector<T, 3>| axis * x.dot(axis);
            return Some(Simplex::new(Vertex { point: on_axis(point), witness: on_axis(witness) }));
        }
        let [from, to] = traced.ends.map(usize::from);
        let mut witness = Simplex::new(*vertices.get(from)?);
        witness.push(*vertices.get(to)?);
        witness.minimize(self.polytope.resolution());
        Some(witness)
    }
}

/// A unit vector orthogonal to a unit vector.
pub(crate) fn across<T: Real>(axis: &Vector<T, 3>) -> Vector<T, 3> {
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
