//! Translational penetration depth of two bodies in space or in the plane: the query that collision code asks.
//!
//! The Minkowski difference M = A - B = { a - b } contains the origin exactly when the bodies overlap. Moving B by x turns M into
//! M - x, so the shortest x that separates them ends on the boundary of M:
//!
//! ```text
//! depth = min over unit u of h_M(u),     h_M(u) = h_A(u) + h_B(-u)
//! ```
//!
//! which is d_Q(M) for the unit ball Q; where the bodies are apart, the same minimum is minus their distance.
//! The minimiser u points from A to B. In the plane everything is the same, with polygons for polyhedra; only bodies that share an
//! axis of revolution, and the plan for them, are of space alone.
//!
//! # Where it is found
//!
//! * `body` is a set with a place in the world, `pair` two of them as one set, M; `answer` is what is said of it.
//! * `half_space` answers in a closed form. Other bodies name a `route`, by what their shapes need: `boxes`, by their axes; expansion; `axis`, in a plane (`meridian`), where both
//!   bodies turn about one axis; where one of them does, `arcs` (by `sectors`), and `ellipsoids`.
//! * Where rounding leaves an answer open, `second_look` asks again, in two words where that serves (`fine`).

use crate::qset::Ball;
use crate::query::answer::Answer;
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use answer::Depth;
use body::Body;
use pair::Pair;
use route::Route;

pub(crate) mod answer;
pub(crate) mod arcs;
mod axis;
pub(crate) mod body;
mod boxes;
mod closed;
#[cfg(test)]
mod dice;
mod ellipsoids;
mod fine;
pub(crate) mod half_space;
mod meridian;
mod pair;
pub(crate) mod route;
mod second_look;
mod sectors;

impl<T: Real> Solver<'_, T, 3> {
    /// Translational penetration depth of two bodies, or their distance, as a bracket with witness points.
    ///
    /// Swapping the bodies turns the normal and swaps the witnesses. Balls (spheres, capsules, margins) are exact. Against a
    /// [half space](crate::support::HalfSpace) the answer is a closed form, and the solver is not used.
    /// `options.guess` is a direction from A to B to look in first; without one, that of the bodies' positions.
    pub fn depth(&mut self, a: &Body<'_, T>, b: &Body<'_, T>, options: &Options<'_, T, 3>) -> Depth<T> {
        if let Some(depth) = unbounded(a, b, options) {
            return depth;
        }
        let of = |body: &Body<'_, T>| body.shape.route().unwrap_or_else(Route::axis);
        Route::find([of(a), of(b)], self, a, b, options)
    }
}

/// [`Solver::depth`] of bodies with an end, by the routes that their shapes name, both of them: nothing else is linked. `None` where one does not.
#[doc(hidden)]
pub fn by_routes<T: Real>(
    solver: &mut Solver<'_, T, 3>,
    a: &Body<'_, T>,
    b: &Body<'_, T>,
    options: &Options<'_, T, 3>,
) -> Option<Depth<T>> {
    Some(Route::find([a.shape.route()?, b.shape.route()?], solver, a, b, options))
}

impl<T: Real> Solver<'_, T, 2> {
    /// Translational penetration depth of two bodies in the plane, or their distance, as a bracket with witness points.
    ///
    /// Everything is as in space, with polygons for polyhedra: discs are [`Sphere`](crate::support::Sphere)s, and
    /// what else is generic over the dimension serves. For polygons of m and n vertices, m + n vertices and as many facets suffice.
    ///
    /// ```
    /// use nalgebra::Matrix2;
    /// use qdist::{Body, Options, Vector, Workspace, support::{BoxShape, Sphere}};
    /// let door = BoxShape::new(Vector::from([1.0, 0.125])).unwrap();
    /// let ball = Sphere::new(0.5).unwrap();
    /// let (c, s) = (0.8, 0.6);
    /// let a = Body::new(&door, Matrix2::new(c, -s, s, c), Vector::from([1.0, 2.0])).unwrap();
    /// // Half a unit from the middle of the door's long side, which is 1/8 thick.
    /// let b = Body::at(&ball, Vector::from([1.0 - 0.6 * 0.5, 2.0 + 0.8 * 0.5]));
    /// let mut memory = Workspace::<f64, 2, 8, 8>::new();
    /// let depth = memory.solver().depth(&a, &b, &Options::default());
    /// assert!((depth.upper - 0.125).abs() < 1e-6 && depth.lower <= depth.upper);
    /// assert!((depth.normal - Vector::from([-0.6, 0.8])).amax() < 1e-6);
    /// ```
    pub fn depth(&mut self, a: &Body<'_, T, 2>, b: &Body<'_, T, 2>, options: &Options<'_, T, 2>) -> Depth<T, 2> {
        if let Some(depth) = unbounded(a, b, options) {
            return depth;
        }
        match Pair::new(a, b) {
            Ok(pair) => self.expand_pair(&pair, pair.calls(), options),
            Err(failure) => Depth::failed(failure),
        }
    }
}

/// The answer of a body without end, which needs no solver.
#[doc(hidden)]
pub fn unbounded<T: Real, const N: usize>(
    a: &Body<'_, T, N>,
    b: &Body<'_, T, N>,
    options: &Options<'_, T, N>,
) -> Option<Depth<T, N>> {
    if let Some(half_space) = b.shape.unbounded() {
        return Some(half_space.depth(b, a, false, options));
    }
    a.shape.unbounded().map(|half_space| half_space.depth(a, b, true, options))
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The depth of a pair by expansion, or by distance where that decides, after so many support calls.
    fn expand_pair(&mut self, pair: &Pair<'_, '_, T, N>, calls: u32, options: &Options<'_, T, N>) -> Depth<T, N> {
        let options = pair.aimed(options);
        let answer = self.expand_once(pair, calls, &options);
        self.conclude_pair(pair, &answer, &options)
    }

    /// The answer of a first look. (Its query leaves the stack before a second one begins.)
    #[inline(never)]
    fn expand_once(&mut self, pair: &Pair<'_, '_, T, N>, calls: u32, options: &Options<'_, T, N>) -> Answer<T, N> {
        let ball = Ball::unit();
        let (mut query, checked) = Pair::query(pair, &ball, calls, options);
        match checked.and_then(|()| query.normalize()) {
            Ok(()) => self.expand_apart(&mut query),
            Err(failure) => self.give_up(&mut query, failure),
        }
    }

    /// Expansion for a first and a second look, with a place on the stack of its own.
    #[inline(never)]
    fn expand_apart(&mut self, query: &mut Query<'_, T, N>) -> Answer<T, N> {
        self.expand_ready(query)
    }
}
