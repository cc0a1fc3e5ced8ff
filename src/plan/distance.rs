//! The point of a convex set nearest to the origin: the Gilbert-Johnson-Keerthi iteration (reference [20] of Zheng & Yamane), with Wolfe's
//! sub-problem (module [`simplex`](crate::polytope::simplex)).
//!
//! The solver needs it where expansion has nothing to expand: for the distance of separated bodies, for bodies whose
//! cores are points or segments, and to bound d from below when the origin lies on the boundary.

use crate::bounds::Axes;
use crate::math::{Vector, norm};
use crate::polytope::simplex::{Simplex, Vertex};
use crate::qset::UnitSet;
use crate::scalar::Real;
use crate::support::failure::EMPTY;
use crate::support::{Failure, Support, total};

/// Where the iteration ended.
pub struct Nearest<T, const N: usize> {
    /// Its weights stand for a point of the set; the nearest one, as far as the iteration got.
    pub simplex: Simplex<T, N>,
    /// Norm of that point.
    pub distance: T,
    /// Is the origin in the simplex, as far as rounding can tell?
    pub inside: bool,
}

/// More steps than any convergent walk takes: rounding ends them earlier.
const STEPS: usize = 128;

/// Walks to the point nearest to the origin, starting with the support point along `first`. The distance is at most the norm
/// of the current point, and at least minus any support value along a unit direction, which `support` gets to
/// see. `watch` is shown the simplex and told the norm of its point after every support call, and ends the walk by returning `true`. With `axes`
/// lengths are told from zero by direction.
pub fn nearest<T: Real, const N: usize>(
    first: &Vector<T, N>,
    axes: Option<&Axes<T, N>>,
    mut support: impl FnMut(&Vector<T, N>) -> Result<Vertex<T, N>, Failure>,
    mut watch: impl FnMut(&Simplex<T, N>, T) -> bool,
) -> Result<Nearest<T, N>, Failure> {
    let vertex = support(first)?;
    let mut reach = norm(&vertex.point);
    let mut simplex = Simplex::new(vertex);
    let mut distance = reach;
    let mut inside = false;
    for _ in 0..STEPS {
        let resolution = T::count(8 * N) * T::ROUNDOFF * reach;
        let least = axes.map_or(resolution, |axes| {
            let towards = simplex.towards_origin(distance.at_least(T::TINY), reach);
            axes.resolution(&towards).at_most(resolution)
        });
        if !(distance > least) || simplex.corners.len() > N {
            inside = true;
            break;
        }
        let direction = simplex.towards_origin(distance, reach);
        let vertex = support(&direction)?;
        let height = direction.dot(&vertex.point);
        reach = reach.at_least(norm(&vertex.point));
        if watch(&simplex, distance) || height + distance <= least {
            break;
        }
        let before = simplex.clone();
        if !simplex.push(vertex) {
            break;
        }
        let solved = simplex.minimize(resolution);
        let now = norm(&simplex.point());
        if now >= distance {
            // Rounding has the last word: keep the better point.
            simplex = before;
            break;
        }
        distance = now;
        if !solved {
            break;
        }
    }
    Ok(Nearest { simplex, distance, inside })
}

/// The convex hull of stored vertices, seen from `origin`.
pub struct Cloud<'a, T, const N: usize> {
    pub vertices: &'a [Vertex<T, N>],
    pub origin: Vector<T, N>,
}

impl<T: Real, const N: usize> Cloud<'_, T, N> {
    /// The point of the hull nearest to `origin`.
    pub fn nearest(&self, first: &Vector<T, N>) -> Option<Nearest<T, N>> {
        nearest(first, None, |u| self.farthest(u), |_, _| false).ok()
    }

    fn farthest(&self, u: &Vector<T, N>) -> Result<Vertex<T, N>, Failure> {
        let mut best: Option<(T, &Vertex<T, N>)> = None;
        for vertex in self.vertices {
            let height = vertex.point.dot(u);
            if best.is_none_or(|(highest, _)| height > highest) {
                best = Some((height, vertex));
            }
        }
        let (_, vertex) = best.ok_or(Failure(EMPTY))?;
        Ok(Vertex { point: vertex.point - self.origin, witness: vertex.witness })
    }
}

/// A set with its ball term put back into the support mapping, for a Q that is not a ball.
pub struct Inflated<'a, T, const N: usize>(pub &'a dyn Support<T, N>);

impl<T: Real, const N: usize> Inflated<'_, T, N> {
    /// The set to ask and the ball term to add at the end: the core and its radius where Q is a ball, else the inflated set and none.
    pub fn for_unit(&self, q: &dyn UnitSet<T, N>) -> (&dyn Support<T, N>, T) {
        let radius = self.0.radius();
        if q.ball_radius().is_none() && radius > T::zero() { (self, T::zero()) } else { (self.0, radius) }
    }

    fn ball(&self, u: &Vector<T, N>) -> Vector<T, N> {
        u * (self.0.radius() / norm(u))
    }
}

impl<T: Real, const N: usize> Support<T, N> for Inflated<'_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.0.support(u)? + self.ball(u))
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let (p, w) = self.0.support_with_witness(u)?;
        let ball = self.ball(u);
        Ok((p + ball, w + ball))
    }
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let (p, w) = self.0.exhaustive(u)?;
        let ball = self.ball(u);
        Ok((p + ball, w + ball))
    }
    fn has_shortcuts(&self) -> bool {
        self.0.has_shortcuts()
    }
    fn extent(&self) -> T {
        let extent = self.0.extent();
        if extent > T::zero() { extent + self.0.radius() } else { extent }
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.0.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.0.contains_origin()
    }
    fn error(&self) -> T {
        total(self.0.error(), T::count(8 + N) * T::ROUNDOFF * self.0.radius())
    }
    fn errors(&self) -> Vector<T, N> {
        self.0.errors().add_scalar(T::count(8 + N) * T::ROUNDOFF * self.0.radius())
    }
    fn extents(&self) -> Vector<T, N> {
        if self.0.extent() > T::zero() { self.0.extents().add_scalar(self.0.radius()) } else { Vector::zeros() }
    }
}
