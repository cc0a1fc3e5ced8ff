//! Sets that are scaled, or grown by a margin.

use super::{pair_error, pair_errors, rounding_of_radii, total};
use crate::math::Vector;
use crate::scalar::Real;
use crate::support::range::{above, check_sizes};
use crate::support::shapes::ShapeError;
use crate::support::{Failure, Support, Symmetry};

/// A set scaled about the origin by a factor >= 0, ball term included.
///
/// `error`: `factor e`, one rounding of each coordinate, `u factor E`, and one of the radius; an unknown E is covered by the solver's
/// margin, since that rounding is at most u |p|.
///
/// ```
/// use qdist::support::{Scaled, Sphere, Support};
/// let s = Scaled::new(Sphere::<f64, 3>::new(0.5).unwrap(), 4.0).unwrap();
/// assert_eq!(s.radius(), 2.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Scaled<S, T> {
    shape: S,
    factor: T,
}

impl<S, T: Real> Scaled<S, T> {
    /// `shape` times `factor` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(shape: S, factor: T) -> Result<Self, ShapeError> {
        check_sizes(core::iter::once(&factor))?;
        Ok(Self { shape, factor })
    }
}

impl<S: Support<T, N>, T: Real, const N: usize> Support<T, N> for Scaled<S, T> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.shape.support(u)? * self.factor)
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let p = self.shape.exhaustive(u)?.0 * self.factor;
        Ok((p, p))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        self.shape.radius() * self.factor
    }
    fn rolling_radius(&self) -> T {
        self.shape.rolling_radius() * self.factor
    }
    fn extent(&self) -> T {
        above(self.shape.extent() * self.factor, 0)
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.shape.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.shape.contains_origin()
    }
    fn error(&self) -> T {
        self.factor * pair_error(self.shape.error(), self.shape.extent() + self.shape.radius())
    }
    fn errors(&self) -> Vector<T, N> {
        pair_errors(self.shape.errors(), self.shape.extents().add_scalar(self.shape.radius())) * self.factor
    }
    fn extents(&self) -> Vector<T, N> {
        self.shape.extents().map(|x| above(x * self.factor, 0))
    }
}

/// A set grown by a ball of radius `margin` >= 0: only the ball term changes, so the points are those of the set, and so is their error, but for the rounding of the
/// sum where the set has a ball term of its own.
///
/// ```
/// use qdist::{Vector, support::{BoxShape, Margin, Support}};
/// let b = Margin::new(BoxShape::new(Vector::from([1.0, 1.0])).unwrap(), 0.1).unwrap();
/// assert_eq!(b.radius(), 0.1);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Margin<S, T> {
    shape: S,
    margin: T,
}

impl<S, T: Real> Margin<S, T> {
    /// `shape` grown by `margin` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(shape: S, margin: T) -> Result<Self, ShapeError> {
        check_sizes(core::iter::once(&margin))?;
        Ok(Self { shape, margin })
    }
}

impl<S: Support<T, N>, T: Real, const N: usize> Support<T, N> for Margin<S, T> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        self.shape.support(u)
    }
    #[inline]
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.shape.support_with_witness(u)
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.shape.exhaustive(u)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        total(self.shape.radius(), self.margin)
    }
    fn rolling_radius(&self) -> T {
        self.shape.rolling_radius()
    }
    fn extent(&self) -> T {
        self.shape.extent()
    }
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        self.shape.center()
    }
    fn symmetry(&self) -> Symmetry {
        self.shape.symmetry()
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.shape.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.shape.contains_origin()
    }
    fn error(&self) -> T {
        self.shape.error() + rounding_of_radii(self.shape.radius(), self.margin)
    }
    fn errors(&self) -> Vector<T, N> {
        self.shape.errors().add_scalar(rounding_of_radii(self.shape.radius(), self.margin))
    }
    fn extents(&self) -> Vector<T, N> {
        self.shape.extents()
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::M;
    use super::*;
    use crate::support::{BoxShape, Difference, Point, Rigid, Sphere, Sum};

    #[test]
    fn bounds_propagate() {
        let ball = Margin::new(Sphere::<f64, 3>::new(1.0).unwrap(), 0.5).unwrap();
        let b = BoxShape::new(Vector::from([3.0, 4.0, 0.0])).unwrap();
        let all = Sum::new(Scaled::new(&ball, 2.0).unwrap(), &b);
        assert_eq!((all.radius(), all.extent()), (3.0, 0.0));
        let moved = Rigid::new(&ball, M::identity(), Vector::from([5.0, 0.0, 0.0])).unwrap();
        assert_eq!((moved.radius(), moved.extent()), (1.5, 0.0));
        assert!(moved.error() > 0.0 && moved.error() < 1e-13);
        let known = Difference::new(&b, Point::new(Vector::from([1.0, 0.0, 0.0])).unwrap());
        assert!(known.extent() >= 6.0 && known.extent() < 6.000_001);
        assert!(!known.has_shortcuts());
        assert_eq!(Scaled::new(&b, -1.0).err(), Some(ShapeError::Negative));
        assert_eq!(Margin::new(&b, f64::NAN).err(), Some(ShapeError::NonFinite));
        let nothing = Scaled::new(&b, 0.0).unwrap();
        assert_eq!(
            (nothing.extent(), nothing.support(&Vector::from([1.0, 1.0, 1.0])).unwrap()),
            (0.0, Vector::from([0.0, 0.0, 0.0]))
        );
    }
}
