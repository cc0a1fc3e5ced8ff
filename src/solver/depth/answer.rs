//! What a depth query answers: the bracket, its normal and the points on both bodies, in the world.

use super::pair::Pair;
use crate::math::Vector;
use crate::query::answer::{Answer, Outcome};
use crate::scalar::Real;
use crate::support::Failure;

/// The penetration of two bodies, or their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Depth<T, const N: usize = 3> {
    /// What was concluded.
    pub outcome: Outcome,
    /// The signed depth is not less. Positive: penetration; negative: minus the distance.
    pub lower: T,
    /// The signed depth is not more.
    pub upper: T,
    /// Unit vector from A to B, which proves `upper`: after moving B by `upper * normal` the bodies do not overlap.
    pub normal: Vector<T, N>,
    /// Witness on A, world frame.
    pub point_a: Vector<T, N>,
    /// Witness on B, world frame. Where converged, `point_a - point_b` is depth * normal: in length up to the tolerance, sideways up
    /// to a few times its square root. The points that touch after B is moved, or the nearest points of separated bodies.
    pub point_b: Vector<T, N>,
    /// Affine dimension of the cores' difference, as far as it was found out.
    pub dimension: usize,
    /// Steps of all plans, as of [`Answer::iterations`]: points of A - B that a plan asked for to go on with.
    pub iterations: u32,
    /// Calls of the support function of the body that was asked more often: of both, unless one alone had to be measured because it does not
    /// know its extent.
    pub support_calls: u32,
    /// Vertices used.
    pub vertices: usize,
    /// Facets used at one time.
    pub facets: usize,
    /// Why a set gave no point, with outcome `SupportFailed`.
    pub failure: Option<Failure>,
}

impl<T: Real, const N: usize> Depth<T, N> {
    pub(super) fn new(answer: &Answer<T, N>, pair: &Pair<'_, '_, T, N>) -> Self {
        let n = answer.direction;
        let (a, b) = (pair.a, pair.b);
        let origin = a.origin(&pair.on_a);
        // b = a - (a - b), both from A's anchor.
        let on_a = answer.witness.witness();
        let on_b = on_a - answer.witness.point();
        Depth {
            outcome: answer.outcome,
            lower: answer.lower,
            upper: answer.upper,
            normal: n,
            point_a: origin + on_a + n * a.ball,
            point_b: origin + on_b - n * b.ball,
            dimension: answer.dimension,
            iterations: answer.iterations,
            support_calls: answer.support_calls,
            vertices: answer.vertices,
            facets: answer.facets,
            failure: answer.failure,
        }
    }

    /// The same in `f64`, to the last bit.
    #[must_use]
    pub fn to_f64(&self) -> Depth<f64, N> {
        Depth {
            outcome: self.outcome,
            lower: self.lower.to_f64(),
            upper: self.upper.to_f64(),
            normal: self.normal.map(T::to_f64),
            point_a: self.point_a.map(T::to_f64),
            point_b: self.point_b.map(T::to_f64),
            dimension: self.dimension,
            iterations: self.iterations,
            support_calls: self.support_calls,
            vertices: self.vertices,
            facets: self.facets,
            failure: self.failure,
        }
    }

    pub(super) fn failed(failure: Failure) -> Self {
        Depth { outcome: Outcome::SupportFailed, failure: Some(failure), ..Depth::unknown() }
    }

    /// Nothing is known.
    pub(super) fn unknown() -> Self {
        Depth {
            outcome: Outcome::Interrupted,
            lower: -T::HUGE,
            upper: T::HUGE,
            normal: Vector::zeros(),
            point_a: Vector::zeros(),
            point_b: Vector::zeros(),
            dimension: 0,
            iterations: 0,
            support_calls: 0,
            vertices: 0,
            facets: 0,
            failure: None,
        }
    }
}
