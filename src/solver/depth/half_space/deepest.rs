//! What of a body reaches farthest into a half space.

use crate::math::{TwoWords, finite, norm};
use crate::scalar::Real;
use crate::solver::depth::body::{Anchor, Body};
use crate::support::Failure;
use crate::support::failure::NOT_FINITE;

/// The farthest point along a direction, in the body's frame.
pub(super) struct Deepest<T, const N: usize> {
    /// The exact sum of both is meant: of a point of the core and what is put on it there, or of two words.
    pub point: TwoWords<T, N>,
    /// The balls around the placed point, one of them taken away.
    pub balls: [T; 2],
    /// How far the point is off what it stands for.
    pub error: T,
    /// How far the direction is off the one that was meant.
    pub astray: T,
}

impl<T: Real, const N: usize> Deepest<T, N> {
    /// By the support function, along the direction v, rounded; v is off by `lost`.
    pub fn in_one_word(
        a: &Body<'_, T, N>,
        v: &TwoWords<T, N>,
        lost: T,
        anchor: &Anchor<T, N>,
    ) -> Result<Self, Failure> {
        let direction = v.high;
        let point =
            if a.shape.has_shortcuts() { a.shape.exhaustive(&direction)?.0 } else { a.shape.support(&direction)? };
        if !finite(&point) {
            return Err(Failure(NOT_FINITE));
        }
        let swell = direction * (a.inflation / norm(&direction));
        let astray = norm(&v.low) * T::of(1.01) + lost;
        let point = TwoWords { high: point, low: swell };
        Ok(Deepest { point, balls: [a.shape.radius(), -a.inflation], error: anchor.error, astray })
    }

    /// The same in two words; `None` where the shape does not tell. A ball that rolls in the shape is its image under the body's matrix, as the shape is: it is in
    /// the point already, and taken away from the ball term.
    pub fn in_two_words(a: &Body<'_, T, N>, v: &TwoWords<T, N>, lost: T, anchor: &Anchor<T, N>) -> Option<Self> {
        // (Errors are told by what a shape says of its extents.)
        if !(a.shape.extent() > T::zero() || anchor.extent.is_zero()) {
            return None;
        }
        let point = a.shape.support_in_two_words(v)?;
        // 2^8 u^2 by contract, in the usual rounding mode.
        let error =
            a.shape.extents().sum() * (T::count(1 << 10) * T::ROUNDOFF * T::ROUNDOFF) + T::count(1 << 10) * T::TINY;
        let balls = [a.shape.radius(), -a.shape.rolling_radius()];
        let sane = finite(&point.high) && finite(&point.low) && error.finite();
        sane.then_some(Deepest { point, balls, error, astray: lost })
    }
}
