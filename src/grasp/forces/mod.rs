//! What is asked and answered about contact forces that resist a wrench. How they are found: [`ForceSolver`](super::ForceSolver).

mod program;
mod search;
mod solver;

use crate::math::Vector;
use crate::scalar::Real;
use crate::support::Failure;
use core::fmt;
pub use solver::ForceSolver;
pub use solver::check;

/// What sizes and equilibria are asked to: 1e-9 in `f64`, 1e-3 in `f32`.
pub(super) fn precision<T: Real>() -> T {
    T::of(1e-9).at_least(T::count(1 << 14) * T::ROUNDOFF)
}

/// When a search for contact forces ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceOptions<T> {
    /// The gap `upper - lower` asked for, relative to `upper`; 0 is as narrow as arithmetic allows. Default: 1e-9 in `f64`,
    /// 1e-3 in `f32`.
    pub relative: T,
    /// Larger forces are of no interest: the search ends when the least size is known to be above. Default: none.
    pub limit: T,
    /// The most steps (see [`Forces::iterations`]); twice as many where a search from what is known ends without an answer. Default: 1000.
    pub iterations: u32,
}

impl<T: Real> Default for ForceOptions<T> {
    fn default() -> Self {
        Self { relative: precision(), limit: T::HUGE, iterations: 1000 }
    }
}

/// Why a search for contact forces is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ForceError {
    /// A coordinate of the external wrench is not finite or too large.
    Wrench,
    /// The relative tolerance is negative or not finite.
    Tolerance,
    /// The limit is negative or not a number.
    Limit,
    /// The list for the shares is shorter than that of the contributions.
    Room,
}

impl fmt::Display for ForceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Wrench => "the external wrench is not finite or too large",
            Self::Tolerance => "the relative tolerance is negative or not finite",
            Self::Limit => "the limit of the size is negative or not a number",
            Self::Room => "there is no room for the shares of all contacts",
        })
    }
}

impl core::error::Error for ForceError {}

/// What a search for contact forces concluded. The bracket holds in each case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ForceOutcome {
    /// The bracket is as narrow as asked for, and so is the equilibrium.
    Converged,
    /// Stopped early: the least size is above the limit.
    Above,
    /// No contact forces resist the wrench, and `direction` u separates: h_W(u) <= 0 < u.w. That is a proof when `lower` is the scalar's
    /// largest number. Otherwise it is so up to rounding: h_W(u) cannot be told from 0, u.w is more than 1e-8 (`f32`: 2e-4) of its
    /// summands, and any forces that resist w are larger than `lower`, which is at least 1e5 (`f32`: 4000) times what W's largest
    /// coordinates would need.
    NotResistible,
    /// Arithmetic does not allow a narrower bracket, or a better equilibrium. So ends a wrench on the very boundary of what can be resisted.
    Precision,
    /// The iteration limit is reached.
    Iterations,
    /// A contribution failed, or returned a value that is not finite.
    SupportFailed,
}

/// What is known about the least size of contact forces that resist a wrench.
///
/// The size is a multiple of the force caps (eq. 4): 1 is the caps themselves, 0.5 half of them. Where there are shares, the bracket is that of the
/// wrench that they exert, which is -(external wrench) up to `residual`: on the very edge of what can be resisted that may make a difference.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Forces<T> {
    /// What was concluded.
    pub outcome: ForceOutcome,
    /// All forces that exert the wrench have at least this size: `direction` proves it.
    pub lower: T,
    /// The shares have at most this size; the scalar's largest number when there are none (all shares are zero then).
    pub upper: T,
    /// The unit direction u of wrenches that proves `lower` <= u.w / h_W(u), w = -(external wrench): what holds the forces up. Zero for a zero wrench.
    pub direction: Vector<T, 6>,
    /// |sum of the shares + external wrench|, in the unit of wrenches: how far the shares are from equilibrium.
    pub residual: T,
    /// Steps of the search: calls of the wrench set's support function, but for those at the beginning and those that prove the bracket.
    pub iterations: u32,
    /// Why a contribution gave no point, with outcome `SupportFailed`.
    pub failure: Option<Failure>,
}
