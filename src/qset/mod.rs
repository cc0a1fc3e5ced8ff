//! The unit set Q: what one unit of depth means in each direction.
//!
//! Q is a compact convex set that contains the origin (perhaps on its boundary) and may have any dimension
//! (paper, eq. 16 and 24). The solver needs its support function only:
//!
//! ```text
//! d_Q(A) = min over u of h_A(u) / h_Q(u)          (Proposition 1)
//! ```
//!
//! The Euclidean [`Ball`] makes d_Q the ordinary penetration depth; a [`Segment`] from the origin shoots a
//! ray; an [`Ellipsoid`](UnitEllipsoid) or [`Vertices`] weigh the directions of a task.

use crate::math::Vector;
use crate::scalar::Real;
use crate::support::Failure;

mod round;
mod sets;

pub use round::{Ball, UnitEllipsoid};
pub use sets::{CrossPolytope, Segment, UnitBox, UnitSetFn, Vertices};

/// The support function of Q.
pub trait UnitSet<T: Real, const N: usize> {
    /// h_Q(u) = max { u.q : q in Q } >= 0; positively homogeneous in u.
    ///
    /// # Errors
    /// A [`Failure`] ends the query with outcome `SupportFailed`.
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure>;

    /// Is Q the ball of this radius around the origin? Then ball terms of A are taken out exactly.
    fn ball_radius(&self) -> Option<T> {
        None
    }

    /// s_Q(u): a point of Q that attains `value`. Used to look for small upper bounds; `None`: not known.
    fn mapping(&self, _u: &Vector<T, N>) -> Option<Vector<T, N>> {
        None
    }

    /// For the hull of the origin and finitely many points: how many. 0: Q is not given that way.
    ///
    /// d_Q is then the smallest of as many ray crossings, each a convex problem.
    fn vertex_count(&self) -> usize {
        0
    }

    /// Point number `index` of [`vertex_count`](UnitSet::vertex_count).
    fn vertex(&self, _index: usize) -> Vector<T, N> {
        Vector::zeros()
    }

    /// Radius of a ball around the origin that Q certainly contains; 0: none that is known.
    fn inner_radius(&self) -> T {
        self.ball_radius().unwrap_or(T::zero())
    }

    /// Does Q not change when the coordinates named by the bits of `signs` change sign? `true` is a proof, `false` says nothing.
    fn mirrored(&self, _signs: u8) -> bool {
        self.ball_radius().is_some()
    }

    /// An upper bound e of the rounding error of [`value`](UnitSet::value) for unit u, as a length. Typically a few units
    /// of roundoff times the largest |q| in Q.
    fn error(&self) -> T;
}
