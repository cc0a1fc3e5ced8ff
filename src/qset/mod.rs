//! The gauge set Q: what one unit of depth means in each direction.
//!
//! Q is a compact convex set that contains the origin (perhaps on its boundary) and may have any dimension
//! (paper, eq. 16 and 24). The solver needs its support function only:
//!
//! ```text
//! d_Q(A) = min over u of h_A(u) / h_Q(u)          (Proposition 1)
//! ```
//!
//! The Euclidean [`Ball`] makes d_Q the ordinary penetration depth; a [`Segment`] from the origin shoots a
//! ray; an [`Ellipsoid`](EllipsoidGauge) or [`Vertices`] weigh the directions of a task.

use crate::scalar::{Real, Vector};
use crate::support::Failure;

mod sets;

pub use sets::{Ball, BoxGauge, CrossPolytope, EllipsoidGauge, GaugeFn, Segment, Vertices};

/// The support function of Q.
pub trait Gauge<T: Real, const N: usize> {
    /// h_Q(u) = max { u.q : q in Q } >= 0; positively homogeneous in u.
    ///
    /// # Errors
    /// A [`Failure`] ends the query with outcome `SupportFailed`.
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure>;

    /// Is Q the ball of this radius around the origin? Then ball terms of A are taken out exactly.
    fn ball_radius(&self) -> Option<T> {
        None
    }

    /// An upper bound e of the rounding error of [`value`](Gauge::value) for unit u, as a length. Typically a few units
    /// of roundoff times the largest |q| in Q.
    fn error(&self) -> T;
}
