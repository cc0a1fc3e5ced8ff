//! Why a set gives no point.

use core::fmt;

/// A support function gave up; the number is the caller's own code (never zero).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failure(pub i32);

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            NOT_FINITE => f.write_str("a set or unit set returned a number that is NaN, infinite or negative"),
            TOO_LARGE => f.write_str("the numbers are so large that arithmetic with them overflows"),
            UNBOUNDED => f.write_str("a half space was asked for a farthest point"),
            code => write!(f, "a support or unit set function failed with code {code}"),
        }
    }
}

impl core::error::Error for Failure {}

/// Failure code: a callback returned a value that is not finite.
pub const NOT_FINITE: i32 = i32::MIN;
/// Failure code: nothing that was returned is wrong, but the numbers are so large that arithmetic with them overflows.
pub const TOO_LARGE: i32 = i32::MIN + 3;
/// Failure code: a set without end ([`HalfSpace`](crate::support::HalfSpace)) was asked for a farthest point.
pub const UNBOUNDED: i32 = i32::MIN + 4;
/// Failure code: an internal set has no points.
pub(crate) const EMPTY: i32 = i32::MIN + 1;
