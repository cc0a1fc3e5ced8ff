//! Convex sets as support functions: the only thing that the solver ever asks of a set A.
//!
//! A compact convex set is known by its support function and mapping (paper, eq. 17)
//!
//! ```text
//! h_A(u) = max { u.a : a in A }        s_A(u) = a point of A that attains it
//! ```
//!
//! A set is given in two parts, `A = core + r B`: the points that [`Support::support`] returns belong to
//! the *core*, and [`Support::radius`] is the radius r of a ball swept over it. A sphere is a point with a
//! radius, a capsule a segment with a radius, a margin is a radius on anything. With a Euclidean Q the
//! solver never expands the ball, since d(core + r B) = d(core) + r exactly (and a ball is the worst case of polytope
//! expansion).
//!
//! # What a support function promises, in floating point
//!
//! For a direction u, let p be the returned point and e = [`Support::error`].
//! * p is within distance e of the core, and
//! * u.p >= h(u) - e |u|, where h is the support function of the core.
//!
//! The solver's bracket rests on these two lines and on nothing else.

use crate::math::{TwoWords, Vector};
use crate::scalar::Real;
pub use crate::solver::depth::half_space::HalfSpace;
use crate::solver::depth::half_space::Unbounded;
pub use crate::solver::depth::route::Route;

mod combine;
pub(crate) mod failure;
mod graph;
pub(crate) mod hull;
pub(crate) mod range;
mod shapes;
mod solids;

pub use combine::{Difference, Join, Linear, Margin, Rigid, Scaled, Sum};
pub(crate) use combine::{Measured, is_worth_measuring, measuring_calls, total};
pub use failure::Failure;
pub(crate) use graph::{GraphWriter, SEEDS};
pub use graph::{HullGraph, Word, graph_len, large_graph_len};
pub use hull::{Hull, Points};
pub use shapes::{BoxShape, Ellipsoid, Point, ShapeError, Sphere};
pub use solids::{Capsule, Cone, Cylinder};

/// Rotations that leave a set in R^3 unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// None that is known.
    None,
    /// All rotations about the z axis of the set's frame.
    Axis,
    /// All rotations about the origin of the set's frame.
    Full,
}

/// A compact convex set `core + radius * ball` in R^N, given by its support mapping.
///
/// Every number is checked: a query of a set that returns a point, witness or center that is not finite, or states a length that is negative or
/// not finite, ends with outcome `SupportFailed`, code [`NOT_FINITE`](crate::support::failure::NOT_FINITE) and a bracket that says nothing false.
///
/// Implement it for your own shapes: only [`support`](Support::support) is required. All lengths are in
/// the caller's unit; the solver is invariant to it.
pub trait Support<T: Real, const N: usize> {
    /// A point of the core that is farthest along `u`. `u` is finite and not zero; it need not be a unit vector.
    ///
    /// # Errors
    /// A [`Failure`] ends the query with outcome `SupportFailed`, a true bracket and the code.
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure>;

    /// The same with a *witness*: for a difference of two bodies the point of the first one. Elsewhere the
    /// point itself.
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let p = self.support(u)?;
        Ok((p, p))
    }

    /// Point and witness without shortcuts, for the direction that is about to be reported. Only sets whose
    /// [`support`](Support::support) takes shortcuts (hill climbing) differ. Both come from one call, as those of
    /// [`support_with_witness`](Support::support_with_witness) do: a shortcut may see another point, whose witness this is not.
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.support_with_witness(u)
    }

    /// Does [`exhaustive`](Support::exhaustive) differ from [`support`](Support::support)?
    fn has_shortcuts(&self) -> bool {
        false
    }

    /// Radius of the ball swept over the core, >= 0.
    fn radius(&self) -> T {
        T::zero()
    }

    /// The part of [`radius`](Support::radius) that is not a ball by definition, as that of a sphere, capsule or margin is, but was split off a
    /// rounded body ([`Ellipsoid`]). A matrix that is a rotation only roughly does not leave it a ball. A wrapper that forwards `radius`
    /// must forward this too.
    fn rolling_radius(&self) -> T {
        T::zero()
    }

    /// An upper bound of |x| over the core, or 0 when it is not known. Rounding margins scale with it; where
    /// it is not known the solver takes the largest norm it has seen.
    fn extent(&self) -> T {
        T::zero()
    }

    /// For a set far from the origin of its frame (a mesh in world coordinates): a point near it, and an upper bound of
    /// the core's distance from that point. Whoever places the set can then measure from there, and rounding
    /// scales with the set's size instead of its position. `None`: nothing to gain.
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        None
    }

    /// For a set in R^3: exact rotational symmetry. Two bodies that turn about a common axis are measured in a plane.
    fn symmetry(&self) -> Symmetry {
        Symmetry::None
    }

    /// What answers in place of a support function, where the set has no end and so no farthest points. Of the sets of this crate only
    /// [`HalfSpace`] has that, and no other set can: the trait is not to be had elsewhere.
    #[doc(hidden)]
    fn unbounded(&self) -> Option<&dyn Unbounded<T, N>> {
        None
    }

    /// For a set in R^3: how its depth in another one is found. `None`: by expansion, and in a plane with a body that turns about the same axis. A set whose
    /// [`symmetry`](Support::symmetry) is `Axis` may say [`Some(Route::arcs())`](Route::arcs); programs without such sets are spared that code. A wrapper that
    /// changes the set must not forward this.
    fn route(&self) -> Option<Route<T>> {
        None
    }

    /// Does the core not change when the coordinates named by the bits of `signs` (bit 0: the first) change sign? `true` is a proof,
    /// `false` says nothing. A search by cones then leaves out cones that are images of others.
    fn mirrored(&self, _signs: u8) -> bool {
        false
    }

    /// Does the core, by its definition, contain the origin? `true` is a proof, `false` says nothing. Where the origin lies on the boundary no
    /// support value can tell, and then this is what d >= 0 rests on. The default knows that what is its own mirror image in all coordinates
    /// does. A wrapper that keeps the origin in its place should forward this.
    fn contains_origin(&self) -> bool {
        N < 8 && self.mirrored(u8::MAX >> (8 - N))
    }

    /// The rounding error e of the promise above, as a length. The default, `16 N u extent`, covers a
    /// support mapping that does a few operations on coordinates of size `extent` (u: unit roundoff).
    fn error(&self) -> T {
        T::count(16 * N) * T::ROUNDOFF * self.extent()
    }

    /// The same coordinate by coordinate: the promise holds with sum of e_i |u_i| in the place of e |u|, and with the box of half lengths e_i in
    /// that of the ball of radius e. A body that is long in some directions is known better along the others. The default is
    /// [`error`](Support::error) for every coordinate.
    fn errors(&self) -> Vector<T, N> {
        Vector::repeat(self.error())
    }

    /// The support function in twice the precision: a point of the core that is farthest along a direction near unit length, both in two words; of an ellipsoid,
    /// whose core lacks its [`rolling_radius`](Support::rolling_radius), the point with that put on. With the unit roundoff u, coordinate i of the point is off by no more than e_i = 2^8 u^2 [`extents`](Support::extents)_i, and its height by no more than the sum of
    /// |u_i| e_i. Shallow contact of such bodies is measured to the last digits. `None`: not offered.
    fn support_in_two_words(&self, _u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        None
    }

    /// Upper bounds of |x_i| over the core, coordinate by coordinate; zeros where [`extent`](Support::extent) is not known. The default is the
    /// extent for every coordinate.
    fn extents(&self) -> Vector<T, N> {
        Vector::repeat(self.extent())
    }
}
