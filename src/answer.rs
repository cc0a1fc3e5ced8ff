//! What a query returns: an outcome, a bracket, and the evidence for both ends.

use crate::scalar::{Real, Vector};
use crate::simplex::Simplex;

/// What a run concluded. Whatever it is, the bracket holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The bracket is as narrow as asked for, and the origin is inside A: d > 0.
    Converged,
    /// Stopped early: d >= the threshold.
    Above,
    /// Stopped early: d < the threshold.
    Below,
    /// The origin is outside A: `upper` < 0, and the bracket is that of minus the Euclidean distance. It is wider than asked for when
    /// an iteration limit or the scalar type ended the search for the distance.
    Separated,
    /// The bracket is as narrow as asked for, or as arithmetic allows, and contains 0.
    Touching,
    /// The bracket cannot be narrowed in this scalar type; the tolerance asked for more.
    Precision,
    /// The workspace is full.
    Capacity,
    /// The iteration limit is reached.
    Iterations,
    /// A is flat and the origin lies in it: d is 0 for a full-dimensional Q. See [`Answer::dimension`].
    Degenerate,
    /// A support or gauge function failed, or returned values that are not finite.
    SupportFailed,
}

/// The result of a query.
///
/// Lengths are in the units of A; `lower` and `upper` are multiples of Q where positive, and minus Euclidean distances where
/// negative.
#[derive(Clone)]
pub struct Answer<T, const N: usize> {
    /// What was concluded.
    pub outcome: Outcome,
    /// d_Q(A) >= lower.
    pub lower: T,
    /// d_Q(A) <= upper.
    pub upper: T,
    /// Unit direction u that proves `upper`: h_A(u) / h_Q(u) <= upper. The weakest direction of A.
    pub direction: Vector<T, N>,
    /// Evidence for `lower`: the facet (or the simplex nearest to the origin) that bounds it, with points of A, their
    /// witnesses and, for a Euclidean Q, the weights of its point nearest to the origin.
    pub witness: Simplex<T, N>,
    /// Affine dimension of the core of A, as far as it was found out: N unless `Degenerate` (or a flat core with a radius).
    pub dimension: usize,
    /// Points added, in expansion and distance iteration.
    pub iterations: u32,
    /// Calls of A's support function.
    pub support_calls: u32,
    /// Vertices used: a workspace with as many would have done, unless the run was cut short.
    pub vertices: usize,
    /// Facets used at one time: a workspace with as many would have done, unless the run was cut short.
    pub facets: usize,
    /// The code of a [`Failure`](crate::support::Failure), else 0.
    pub failure: i32,
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    Met,
    /// The origin is certainly outside.
    Outside,
    Rounding,
    Above,
    Below,
    Capacity,
    Iterations,
    Flat,
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
            Stop::Met | Stop::Rounding if at_zero => Outcome::Touching,
            _ if met && lower > zero => Outcome::Converged,
            Stop::Met | Stop::Outside | Stop::Rounding | Stop::Flat => Outcome::Precision,
            Stop::Capacity => Outcome::Capacity,
            Stop::Iterations => Outcome::Iterations,
        }
    }
}
