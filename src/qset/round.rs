//! The built-in unit sets that are round: ball and ellipsoid.

use nalgebra::SMatrix;

use super::UnitSet;
use super::sets::{positive, roundings};
use crate::math::{Vector, largest, norm};
use crate::scalar::Real;
use crate::support::{BoxShape, Ellipsoid, Failure, ShapeError, Support};

/// The Euclidean ball, `h = radius |u|`: with radius 1, d_Q is the ordinary penetration depth (paper, eq. 16).
///
/// `error`: N/2 + 1 roundoffs of the norm, one of the product: `(N + 4) u radius`.
///
/// ```
/// use qdist::{qset::{Ball, UnitSet}, Vector};
/// let q = Ball::new(2.0).unwrap();
/// assert_eq!(q.value(&Vector::from([0.0, 3.0, 4.0])).unwrap(), 10.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<T> {
    radius: T,
}

impl<T: Real> Ball<T> {
    /// The ball of radius `radius` > 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`]; [`ShapeError::Empty`] for radius 0, or one so small that its inverse is infinite.
    pub fn new(radius: T) -> Result<Self, ShapeError> {
        BoxShape::new(Vector::<T, 1>::new(radius))?;
        let radius = positive(radius)?;
        if (T::one() / radius).finite() { Ok(Self { radius }) } else { Err(ShapeError::Empty) }
    }

    /// The unit ball.
    #[must_use]
    pub fn unit() -> Self {
        Self { radius: T::one() }
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for Ball<T> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(self.radius * norm(u))
    }
    #[inline]
    fn ball_radius(&self) -> Option<T> {
        Some(self.radius)
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        Some(u * (self.radius / norm(u)))
    }
    fn error(&self) -> T {
        roundings(N + 4, self.radius)
    }
}

/// An ellipsoid `{R D x : |x| <= 1}`, D the diagonal matrix of the semi axes: `h = |D R^T u|`. Some semi axes may be zero.
///
/// The product D R^T is prepared, divided by the largest semi axis m so that its squares stay in range. `error`: with F
/// the Frobenius norm of that matrix, `N + 3` roundoffs of F for its entries and the product, `N/2 + 2` roundoffs of the
/// value (at most m F): `(2 N + 6) u m F`.
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{qset::{UnitEllipsoid, UnitSet}, Vector};
/// let q = UnitEllipsoid::new(Vector::from([2.0, 0.0]), SMatrix::<f64, 2, 2>::new(0.0, -1.0, 1.0, 0.0)).unwrap();
/// assert_eq!(q.value(&Vector::from([7.0, 1.0])).unwrap(), 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitEllipsoid<T, const N: usize> {
    /// Column i is semi_i / size times column i of R.
    columns: SMatrix<T, N, N>,
    size: T,
    inner: T,
    error: T,
}

impl<T: Real, const N: usize> UnitEllipsoid<T, N> {
    /// The ellipsoid with these semi axes >= 0 along the columns of `rotation`.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`]; [`ShapeError::Empty`] when the set is the origin alone;
    /// [`ShapeError::NotOrthonormal`] when a column of `rotation` is not of unit length (to 1e-3).
    pub fn new(semi_axes: Vector<T, N>, rotation: SMatrix<T, N, N>) -> Result<Self, ShapeError> {
        let size = positive(Ellipsoid::new(semi_axes)?.extent())?;
        if !rotation.iter().all(|x| x.finite()) {
            return Err(ShapeError::NonFinite);
        }
        // Orthogonality is not needed for h; the length is, for Q to be the set that the semi axes say.
        let unit = |c: &[T; N]| {
            let off = c.iter().fold(-T::one(), |s, &x| s + x * x);
            off <= T::of(2e-3) && off >= T::of(-2e-3)
        };
        if !rotation.data.0.iter().all(unit) {
            return Err(ShapeError::NotOrthonormal);
        }
        let columns = scaled_columns(semi_axes, rotation, size);
        let frobenius = columns.iter().fold(T::zero(), |s, &x| s + x * x).root();
        // The least singular value of R D: |R^T x| >= sqrt(1 - |R^T R - I|) |x|, for any matrix.
        let gram = rotation.tr_mul(&rotation) - SMatrix::identity();
        let skew = gram.iter().fold(T::zero(), |s, &x| s + x * x).root() + T::count(4 * N * N) * T::ROUNDOFF;
        let least = semi_axes.iter().fold(size, |least, &x| least.at_most(x));
        let inner = (least - least * skew).at_least(T::zero());
        Ok(Self { columns, size, inner, error: roundings(2 * N + 6, size * frobenius) })
    }

    /// Of semi axes and a rotation that have been looked at before: as a support function alone.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    pub fn trusted(semi_axes: Vector<T, N>, rotation: SMatrix<T, N, N>) -> Self {
        let size = largest(&semi_axes);
        Self { columns: scaled_columns(semi_axes, rotation, size), size, inner: T::zero(), error: T::zero() }
    }
}

/// D R^T transposed, divided by the largest semi axis.
#[inline(always)]
fn scaled_columns<T: Real, const N: usize>(
    semi_axes: Vector<T, N>,
    rotation: SMatrix<T, N, N>,
    size: T,
) -> SMatrix<T, N, N> {
    SMatrix::from_fn(|i, j| semi_axes[j] / size * rotation[(i, j)])
}

impl<T: Real, const N: usize> UnitSet<T, N> for UnitEllipsoid<T, N> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        let mut squares = -T::zero();
        for column in &self.columns.data.0 {
            let x = column.iter().zip(u.iter()).fold(-T::zero(), |s, (&a, &b)| s + a * b);
            squares += x * x;
        }
        Ok(self.size * squares.root())
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        let inner = self.columns.tr_mul(u);
        let length = norm(&inner);
        (length > T::zero()).then(|| self.columns * (inner * (self.size / length)))
    }
    fn mirrored(&self, signs: u8) -> bool {
        // Each axis must stay on its line.
        (0..N).all(|j| {
            let column = &self.columns.data.0[j];
            let flips = |flipped: bool| (0..N).any(|i| column[i] != T::zero() && (signs >> i & 1 == 1) == flipped);
            !(flips(true) && flips(false))
        })
    }
    fn inner_radius(&self) -> T {
        self.inner
    }
    fn error(&self) -> T {
        self.error
    }
}
