//! Half spaces as bodies: the ground, a wall, a joint limit; in the plane, half planes.
//!
//! A half space H = { x : n.x <= c } has no end, so it has no support mapping, and nothing can be expanded. But M = A - H has a finite
//! height along one direction only, and there the depth is the height:
//!
//! ```text
//! depth = min over u of h_A(u) + h_H(-u) = h_A(-n/|n|) + c/|n|
//! ```
//!
//! One call of A's support function answers, whatever A is (after those that measure A, where it does not state its extent); A's
//! ball term is added as it is.
//!
//! # Rounding
//!
//! In the world, the height of A's point p over the plane is w.(R p + t - s) - c with w = S n, where (R, t) is the pose of A and (S, s) that of H, and A's ball
//! term r adds r |w|. These terms may be large and cancel: a foot on the ground, ten kilometres from the origin; a ball that touches it. So all sums of products carry
//! their rounding along ([`Accumulator`](crate::math::Accumulator)), and w, |w| and R p + t - s are kept as the sum of two numbers. What is left is u^2 times the
//! terms, and a few roundoffs of the depth itself.
//!
//! The direction that A is asked along, v = -R^T w, is known up to its own rounding g as well. The true height along v is at most that
//! of p, plus A's error e |v|, plus |g| times A's diameter. Where both poses are turned by multiples of 90 degrees, and the ground usually
//! is, g is 0.
//!
//! Where that does not meet the tolerance (shallow contact in `f32`), a shape that tells its points in two words is asked for the one along v in two words: g is
//! then u^2 of |w|, and e as small.
//!
//! # What a rotation that is none means
//!
//! Matrices are used as they are given: y belongs to the placed half space when n.S^T (y - s) <= c. For a rotation that is the image of H.
//!
//! # Two half spaces
//!
//! overlap without end, and no translation separates them, unless their normals are exactly opposite: d is infinite, and the outcome
//! [`Unbounded`](Outcome::Unbounded). Opposite normals (a floor and a ceiling) leave c_a/|n_a| + c_b/|n_b| between positions. Normals of turned
//! bodies are known up to rounding: where that does not tell, the lower bound is of the case that they are opposite, and there
//! is no upper bound.

mod deepest;
mod plane;

use super::answer::Depth;
use super::body::Body;
use super::closed::{Found, is_enough};
use crate::math::{Vector, finite, largest};
use crate::query::Options;
use crate::scalar::Real;
use crate::support::failure::{NOT_FINITE, UNBOUNDED};
use crate::support::range::check_numbers;
use crate::support::{Failure, ShapeError, Support};
use plane::Plane;

/// The half space { x : normal.x <= offset }; in the plane, a half plane. The normal points out of it.
///
/// A body for [`Solver::depth`](crate::Solver::depth), against compact bodies and other half spaces. It is the exception among sets: it has no end
/// and so no farthest points. In any other place (a sum, a join, a query of one set) its support function fails with code
/// [`UNBOUNDED`]. Bullet calls it a static plane shape, FCL a half space, most engines a plane.
///
/// ```
/// use qdist::{Body, Options, Vector, Workspace, support::{BoxShape, HalfSpace}};
/// let ground = HalfSpace::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
/// let cube = BoxShape::new(Vector::from([0.5, 0.5, 0.5])).unwrap();
/// let (ground, cube) = (Body::at(&ground, Vector::zeros()), Body::at(&cube, Vector::from([4.0, 2.0, 0.375])));
/// let mut memory = Workspace::<f64, 3, 4, 6>::new();
/// let depth = memory.solver().depth(&ground, &cube, &Options::default());
/// assert!(depth.lower <= 0.125 && 0.125 <= depth.upper);
/// assert_eq!(depth.normal, Vector::from([0.0, 0.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<T, const N: usize> {
    /// Scaled by a power of two: its largest coordinate is 1 to 2.
    normal: Vector<T, N>,
    offset: T,
}

impl<T: Real, const N: usize> HalfSpace<T, N> {
    /// { x : normal.x <= offset }, for a normal of any length.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`], also where offset / |normal| is too large; [`ShapeError::Direction`] when the normal is zero.
    pub fn new(normal: Vector<T, N>, offset: T) -> Result<Self, ShapeError> {
        check_numbers(normal.iter())?;
        check_numbers(core::iter::once(&offset))?;
        let size = largest(&normal);
        if size.is_zero() {
            return Err(ShapeError::Direction);
        }
        // Below the normal numbers a power of two is not had from the exponent; all is lifted first, which is exact.
        let lift = if size < T::TINY { T::one() / T::ROUNDOFF } else { T::one() };
        let (normal, offset, size) = (normal * lift, offset * lift, size * lift);
        let power = size.power_of_two();
        let half_space = HalfSpace { normal: normal / power, offset: offset / power };
        check_numbers(core::iter::once(&half_space.offset))?;
        Ok(half_space)
    }
}

impl<T: Real, const N: usize> Support<T, N> for HalfSpace<T, N> {
    /// Fails: there is no farthest point.
    fn support(&self, _: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Err(Failure(UNBOUNDED))
    }
    fn unbounded(&self) -> Option<&dyn Unbounded<T, N>> {
        Some(self)
    }
}

/// A set without end, with an answer of its own.
pub trait Unbounded<T: Real, const N: usize> {
    /// Normal and offset.
    fn plane(&self) -> (&Vector<T, N>, T);

    /// The depth of this set, placed like `own`, and of `other`; `first`: this is A.
    fn depth(
        &self,
        own: &Body<'_, T, N>,
        other: &Body<'_, T, N>,
        first: bool,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N>;
}

impl<T: Real, const N: usize> Unbounded<T, N> for HalfSpace<T, N> {
    fn plane(&self) -> (&Vector<T, N>, T) {
        (&self.normal, self.offset)
    }

    fn depth(
        &self,
        own: &Body<'_, T, N>,
        other: &Body<'_, T, N>,
        first: bool,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N> {
        if !finite(&own.translation) || !finite(&other.translation) {
            return Depth::failed(Failure(NOT_FINITE));
        }
        let plane = Plane::new(self, own);
        let found = match other.shape.unbounded() {
            None => plane.overlap(other, |bracket| is_enough(bracket, options)),
            Some(wall) => Ok(plane.facing(&Plane::new(wall, other))),
        };
        match found {
            Ok(found) => (if first { found.swapped() } else { found }).conclude(options),
            Err(failure) => Depth::failed(failure),
        }
    }
}
