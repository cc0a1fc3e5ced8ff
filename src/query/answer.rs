//! What a query returns: an outcome, a bracket, and the evidence for both ends.

use core::fmt;

use crate::math::{Vector, norm};
use crate::polytope::simplex::{Simplex, Vertex};
use crate::qset::UnitSet;
use crate::scalar::Real;
use crate::support::Failure;

/// What a run concluded. Whatever it is, the bracket holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The bracket is as narrow as asked for, and the origin is inside A: d > 0.
    Converged,
    /// Stopped early: d >= the threshold.
    Above,
    /// Stopped early: d < the threshold.
    Below,
    /// The origin is outside A: `upper` < 0, and the bracket is that of minus the Euclidean distance. It is wider than asked for when
    /// a limit, a deadline or the scalar type ended the search for the distance.
    Separated,
    /// The bracket is as narrow as asked for, or as arithmetic allows, and contains 0.
    Touching,
    /// The bracket cannot be narrowed in this scalar type; the tolerance asked for more.
    Precision,
    /// The workspace is full.
    Capacity,
    /// The iteration limit is reached.
    Iterations,
    /// The caller's deadline has passed.
    Interrupted,
    /// A is flat, as far as the rounding of its points tells, and the origin lies in it: d is 0 for a full-dimensional Q. See
    /// [`Answer::dimension`]. (A set that is only thin ends with `Precision`.)
    Degenerate,
    /// A support or unit set function failed, or returned values that are not finite.
    SupportFailed,
    /// Two half spaces overlap without end: no translation separates them. d is infinite, and both bounds are the largest finite number.
    Unbounded,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Outcome::Converged => "converged",
            Outcome::Above => "above",
            Outcome::Below => "below",
            Outcome::Separated => "separated",
            Outcome::Touching => "touching",
            Outcome::Precision => "precision",
            Outcome::Capacity => "capacity",
            Outcome::Iterations => "iterations",
            Outcome::Interrupted => "interrupted",
            Outcome::Degenerate => "degenerate",
            Outcome::SupportFailed => "support failed",
            Outcome::Unbounded => "unbounded",
        })
    }
}

impl Outcome {
    /// Did rounding, or the memory, end the run before the bracket was as narrow as it was to be?
    pub(crate) fn is_inconclusive(self) -> bool {
        matches!(self, Outcome::Precision | Outcome::Degenerate | Outcome::Touching | Outcome::Capacity)
    }
}

/// How a query was answered: what it is decides (see [`Solver::solve`](crate::Solver::solve)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Plan {
    /// By the distance of the core from the origin: A has a ball term, and the origin is outside of what it is swept over.
    Distance,
    /// Two bodies on one axis: expansion in a plane through it.
    Meridian,
    /// Polytopal Q: one ray per vertex of Q, and no polytope.
    Rays,
    /// The bracket of the call before, moved ([`Tracker`](crate::Tracker)): nothing had to be expanded.
    Warm,
    /// Expansion of one polytope.
    Expansion,
    /// The polytope outgrew the memory: expansion cone by cone.
    Cones,
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Plan::Distance => "distance",
            Plan::Meridian => "meridian",
            Plan::Rays => "rays",
            Plan::Warm => "warm",
            Plan::Expansion => "expansion",
            Plan::Cones => "cones",
        })
    }
}

/// The result of a query.
///
/// Lengths are in the units of A; `lower` and `upper` are multiples of Q where positive, and minus Euclidean distances where
/// negative (in units of the radius where Q is a ball).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Answer<T, const N: usize> {
    /// What was concluded.
    pub outcome: Outcome,
    /// d_Q(A) >= lower.
    pub lower: T,
    /// d_Q(A) <= upper.
    pub upper: T,
    /// Unit direction u that proves `upper`: h_A(u) / h_Q(u) <= upper. The weakest direction of A.
    pub direction: Vector<T, N>,
    /// s_A(u), the point of A that is farthest along it (its ball term included).
    pub support: Vector<T, N>,
    /// h_Q(u); 1 where `upper` is minus a distance and Q no ball. With `direction` and `support` it makes the gradient of d: see [`Answer::derivative`].
    pub unit: T,
    /// Where the minimiser is known not to be unique (to the tolerance): another direction, more than 8 degrees away, that bounds d as
    /// tightly. `None` says that none was met, not that there is none.
    pub rival: Option<Vector<T, N>>,
    /// How the query was answered.
    pub plan: Plan,
    /// Evidence for `lower`: the facet (or the simplex nearest to the origin) that bounds it, with points of A, their
    /// witnesses and, for a Euclidean Q, the weights of its point nearest to the origin.
    pub witness: Simplex<T, N>,
    /// Affine dimension of the core of A, as far as it was found out: N unless `Degenerate` (or a flat core with a radius).
    pub dimension: usize,
    /// Steps of all plans, which [`Options::max_iterations`](crate::Options::max_iterations) limits: points of A that a plan asked for to go on
    /// with. No steps, and counted by `support_calls` alone, are the first points, the point with which a ray or a walk ends, what looks for a
    /// rival or for the ends of an arc, what is asked again (without shortcuts, in two words), and what pushes facets out that rounding would
    /// swallow. A pass of rays that ends without an answer counts a step that asks nothing.
    pub iterations: u32,
    /// Calls of A's support function.
    pub support_calls: u32,
    /// Vertices used: a workspace with as many would have done, unless the run was cut short.
    pub vertices: usize,
    /// Facets used at one time: a workspace with as many would have done, unless the run was cut short.
    pub facets: usize,
    /// With [`Plan::Cones`]: cones searched in the last completed pass.
    pub cones: u32,
    /// With [`Plan::Cones`]: the most halvings of an orthant, of at most 192.
    pub splits: u32,
    /// Why a set gave no point, with outcome `SupportFailed`.
    pub failure: Option<Failure>,
}

impl<T: Real, const N: usize> Answer<T, N> {
    /// The answer to no query: nothing is known of d.
    #[must_use]
    pub fn unknown() -> Self {
        Answer {
            outcome: Outcome::Interrupted,
            lower: -T::HUGE,
            upper: T::HUGE,
            direction: Vector::zeros(),
            support: Vector::zeros(),
            unit: T::one(),
            rival: None,
            plan: Plan::Expansion,
            witness: Simplex::new(Vertex::empty()),
            dimension: N,
            iterations: 0,
            support_calls: 0,
            vertices: 0,
            facets: 0,
            cones: 0,
            splits: 0,
            failure: None,
        }
    }

    /// Is d >= `threshold`? `None` when the bracket does not tell.
    pub fn is_at_least(&self, threshold: T) -> Option<bool> {
        if self.lower >= threshold { Some(true) } else { (self.upper < threshold).then_some(false) }
    }

    /// This answer of a second look, which has counted the calls of both, or the first one where that is narrower.
    pub(crate) fn or_wider(self, first: &Self) -> Self {
        let support_calls = self.support_calls;
        let iterations = self.iterations.saturating_add(first.iterations);
        // What is flat stays so, unless d is certainly another.
        let flat = first.outcome == Outcome::Degenerate && self.lower <= T::zero() && self.upper >= T::zero();
        let narrower = self.upper - self.lower <= first.upper - first.lower;
        let (vertices, facets) = (self.vertices.max(first.vertices), self.facets.max(first.facets));
        let better = if narrower && !flat { self } else { first.clone() };
        Answer { support_calls, iterations, vertices, facets, ..better }
    }

    /// The largest norm of a point of A in the answer.
    pub(crate) fn reach(&self) -> T {
        let corners = self.witness.corners.iter().map(|c| norm(&c.vertex.point));
        corners.fold(norm(&self.support), |most, x| most.at_least(x))
    }

    /// The point of dQ that touches A's boundary, d s_Q(u) with the upper bound for d: of all that Q asks for, what A reaches last. For the
    /// wrench set of a grasp it is the wrench that is hardest to exert, and its negative the external wrench that is hardest to resist. `None`
    /// where Q does not tell its [`mapping`](UnitSet::mapping). After [`solve_in_span`](crate::Solver::solve_in_span) its projection on A's span
    /// counts.
    pub fn weakest(&self, q: &dyn UnitSet<T, N>) -> Option<Vector<T, N>> {
        q.mapping(&self.direction).map(|point| point * self.upper)
    }

    /// The derivative of d with respect to a parameter of A, by the envelope theorem.
    ///
    /// d = min over u of max over a in A of u.a / h_Q(u). Where minimiser and maximiser change continuously, the first-order
    /// change of d is that of u.a at both of them as they are,
    ///
    /// ```text
    /// d' = Σ w_i (u . a_i') / h_Q(u),        a_i' = change of point a_i of A as the parameter changes
    /// ```
    ///
    /// over the points a_i of A that touch λQ at one point with weights w_i: the `witness`. `change` is asked for a_i' at each of
    /// its points. (Where A is smooth there, they are near `support`, and d' = u.s_A' / h_Q.)
    ///
    /// Exact up to about the square root of the relative gap of the bracket, because u and the points are. Where the minimiser is not unique
    /// (`rival`), d has one-sided derivatives only: the least of those at all minimisers, in each sense.
    pub fn derivative(&self, change: impl Fn(&Vector<T, N>) -> Vector<T, N>) -> T {
        let along = |point: &Vector<T, N>| self.direction.dot(&change(point));
        let sum = self.witness.corners.iter().fold(T::zero(), |sum, c| sum + along(&c.vertex.point) * c.weight);
        sum / self.unit
    }
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Met,
    /// The origin is certainly outside.
    Outside,
    Rounding,
    /// A height of A is 0, up to rounding: so is d.
    Zero,
    Above,
    Below,
    Capacity,
    Iterations,
    Interrupted,
    Flat,
    /// Flat but for a width that the margins swallow.
    Thin,
    /// It is another plan's turn: the end of no query.
    Turn,
    Failed(i32),
}

impl Stop {
    /// The outcome, given the final bracket, whether it meets the tolerance, and whether it cannot be told from zero.
    pub(crate) fn outcome<T: Real>(self, lower: T, upper: T, met: bool, at_zero: bool) -> Outcome {
        let zero = T::zero();
        match self {
            Stop::Failed(_) => Outcome::SupportFailed,
            Stop::Above => Outcome::Above,
            Stop::Below => Outcome::Below,
            _ if upper < zero => Outcome::Separated,
            Stop::Flat if lower <= zero => Outcome::Degenerate,
            Stop::Met | Stop::Rounding | Stop::Zero if at_zero => Outcome::Touching,
            _ if met && lower > zero => Outcome::Converged,
            Stop::Met | Stop::Outside | Stop::Rounding | Stop::Zero | Stop::Flat | Stop::Thin | Stop::Turn => {
                Outcome::Precision
            }
            Stop::Capacity => Outcome::Capacity,
            Stop::Iterations => Outcome::Iterations,
            Stop::Interrupted => Outcome::Interrupted,
        }
    }
}
