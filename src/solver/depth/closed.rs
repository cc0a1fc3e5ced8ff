//! Depths that are closed forms: the bracket is as narrow as arithmetic lets it be, whatever was asked for.

use super::answer::Depth;
use crate::bounds::{Bracket, Tolerance};
use crate::math::{Vector, finite};
use crate::query::Options;
use crate::query::answer::{Outcome, Stop};
use crate::scalar::Real;
use crate::support::Failure;
use crate::support::failure::TOO_LARGE;

/// What was found.
pub(super) struct Found<T: Real, const N: usize> {
    pub bracket: Bracket<T>,
    /// Unit vector from A to B.
    pub normal: Vector<T, N>,
    pub on_a: Vector<T, N>,
    pub on_b: Vector<T, N>,
    pub calls: u32,
    /// What the bracket alone does not say.
    pub outcome: Option<Outcome>,
    /// The affine dimension of A - B.
    pub dimension: usize,
}

impl<T: Real, const N: usize> Found<T, N> {
    /// For B and A.
    pub fn swapped(self) -> Self {
        Found { normal: -self.normal, on_a: self.on_b, on_b: self.on_a, ..self }
    }

    pub fn conclude(self, options: &Options<'_, T, N>) -> Depth<T, N> {
        let Found { bracket: Bracket { lower, upper }, normal, on_a, on_b, calls, outcome, dimension } = self;
        // (Where a product overflowed:)
        if !(lower.finite() && upper.finite() && [&normal, &on_a, &on_b].iter().all(|v| finite(v))) {
            return Depth::failed(Failure(TOO_LARGE));
        }
        let met = upper < T::HUGE && is_met(&self.bracket, options);
        let stop = decided(&self.bracket, options);
        let outcome = match (stop, outcome) {
            (Stop::Met, Some(outcome)) => outcome,
            _ => stop.outcome(lower, upper, met, lower <= T::zero() && upper < T::HUGE),
        };
        let (point_a, point_b) = (on_a, on_b);
        Depth { outcome, lower, upper, normal, point_a, point_b, dimension, support_calls: calls, ..Depth::unknown() }
    }
}

fn is_met<T: Real, const N: usize>(bracket: &Bracket<T>, options: &Options<'_, T, N>) -> bool {
    Tolerance { absolute: options.absolute, relative: options.relative }.met(bracket)
}

/// What the bracket says of the threshold.
fn decided<T: Real, const N: usize>(bracket: &Bracket<T>, options: &Options<'_, T, N>) -> Stop {
    match options.threshold {
        Some(threshold) if bracket.lower >= threshold => Stop::Above,
        Some(threshold) if bracket.upper < threshold => Stop::Below,
        _ => Stop::Met,
    }
}

/// Does the bracket answer the query?
pub(super) fn is_enough<T: Real, const N: usize>(bracket: &Bracket<T>, options: &Options<'_, T, N>) -> bool {
    is_met(bracket, options) || decided(bracket, options) != Stop::Met
}
