//! A body: a set with a place in the world, and what is known of it there.

use core::fmt;

use crate::bounds::Axes;
use crate::math::load::one_by_one;
use crate::math::{Accumulator, Vector, finite, norm};
use crate::scalar::Real;
use crate::support::failure::NOT_FINITE;
use crate::support::{Failure, Measured, Support};
use nalgebra::SMatrix;

/// A 3 x 3 matrix.
pub type Matrix3<T> = SMatrix<T, 3, 3>;
/// A 2 x 2 matrix.
pub type Matrix2<T> = SMatrix<T, 2, 2>;

/// Why a body cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BodyError {
    /// A coordinate is NaN or infinite.
    NonFinite,
    /// The matrix is not a rotation: |R^T R - I| > 1e-4 in some entry, or det R < 0.
    Rotation,
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NonFinite => "a coordinate of the body's pose is NaN or infinite",
            Self::Rotation => "the matrix of the body's pose is not a rotation to within 1e-4",
        })
    }
}

impl core::error::Error for BodyError {}

/// A set placed in the world, which is space or the plane (`N` = 2): x -> rotation x + translation. A rotation of the plane by
/// the angle of cosine c and sine s is the matrix (c, -s; s, c).
#[derive(Clone, Copy)]
pub struct Body<'a, T: Real, const N: usize = 3> {
    pub(super) shape: &'a (dyn Support<T, N> + Sync),
    pub(super) rotation: SMatrix<T, N, N>,
    pub(super) translation: Vector<T, N>,
    /// Radius of the ball swept over the placed core.
    pub(super) ball: T,
    /// Radius of the ball that goes into the support points instead: see `Support::rolling_radius`.
    pub(super) inflation: T,
}

impl<T: Real, const N: usize> fmt::Debug for Body<'_, T, N> {
    /// Where the shape is placed; of the shape itself nothing but its support function is known.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pose = (&self.rotation, &self.translation);
        f.debug_struct("Body").field("rotation", pose.0).field("translation", pose.1).finish_non_exhaustive()
    }
}

/// A matrix whose columns are orthonormal to so many roundoffs leaves balls what they are, but for an error.
pub(super) const SKEW_ROUNDOFFS: usize = 32;

impl<'a, T: Real, const N: usize> Body<'a, T, N> {
    /// Places a shape, which may serve several threads at a time. The matrix is used as it is given: the body is the image of the shape, except that balls (spheres,
    /// the rounding of capsules, margins) stay balls.
    ///
    /// # Errors
    /// [`BodyError`], naming what is wrong.
    pub fn new(
        shape: &'a (dyn Support<T, N> + Sync),
        rotation: SMatrix<T, N, N>,
        translation: Vector<T, N>,
    ) -> Result<Self, BodyError> {
        const { assert!(N == 2 || N == 3, "bodies are of dimension 2 or 3") };
        if !finite(&translation) {
            return Err(BodyError::NonFinite);
        }
        let skew = skew(&rotation);
        if !(skew <= T::of(1e-4)) || !is_proper(&rotation) {
            let numbers = rotation.iter().all(|x| x.finite());
            return Err(if numbers { BodyError::Rotation } else { BodyError::NonFinite });
        }
        let mut body = Body { rotation, ..Body::at(shape, translation) };
        if skew > T::count(SKEW_ROUNDOFFS) * T::ROUNDOFF {
            body.inflation = shape.rolling_radius();
            body.ball -= body.inflation;
        }
        Ok(body)
    }

    /// Places a shape without turning it.
    pub fn at(shape: &'a (dyn Support<T, N> + Sync), translation: Vector<T, N>) -> Self {
        Body { shape, rotation: SMatrix::identity(), translation, ball: shape.radius(), inflation: T::zero() }
    }

    /// The same body, with its shape as it was measured.
    pub(super) fn remade<'m>(
        &'m self,
        measured: Option<&'m Measured<'m, dyn Support<T, N> + Sync + 'm, T, N>>,
    ) -> Body<'m, T, N> {
        let shape = measured.map_or(self.shape, |measured| measured);
        Body { shape, ..*self }
    }

    /// Where the body's support points are measured from, in its own frame, and an upper bound of the core's distance
    /// from there: the shape's own word, else half the diagonal of the box that support calls along the axes draw around it.
    pub(super) fn anchor(&self) -> Result<Anchor<T, N>, Failure> {
        let mut anchor = self.core_anchor()?;
        // What the shape says of itself, NaN refused. (Sums would hide a negative length; what else is infinite is found in them.)
        let zero = T::zero();
        let ball = (self.ball >= zero) & (self.ball <= T::HUGE) & (self.inflation >= zero);
        if !(ball & (anchor.extent >= zero) & (anchor.error >= zero)) {
            return Err(Failure(NOT_FINITE));
        }
        anchor.extent += self.inflation;
        anchor.error += self.ball_error();
        Ok(anchor)
    }

    /// What the ball that was split off a rounded shape is off. In the support points it is rounded. Left as it is, it stands for its image, whose height along a
    /// unit vector n is |R^T n| times the radius: with s the largest entry of R^T R - I, that is 1 up to N s / 2. (Measuring s costs 4 roundoffs.)
    fn ball_error(&self) -> T {
        let rolling = self.shape.rolling_radius();
        if self.inflation > T::zero() {
            (T::count(8) * self.inflation + self.ball) * T::ROUNDOFF
        } else if rolling > T::zero() && !is_exact(&self.rotation) {
            (skew(&self.rotation) + T::count(4) * T::ROUNDOFF) * T::of(N as f64 * 0.505) * rolling
        } else {
            T::zero()
        }
    }

    fn core_anchor(&self) -> Result<Anchor<T, N>, Failure> {
        if let Some((center, extent)) = self.shape.center() {
            if !finite(&center) {
                return Err(Failure(NOT_FINITE));
            }
            return Ok(Anchor { center: Some(center), extent, error: self.shape.error(), calls: 0 });
        }
        let known = self.shape.extent();
        if known != T::zero() {
            return Ok(Anchor { center: None, extent: known, error: self.shape.error(), calls: 0 });
        }
        let extent = norm(&self.corner()?);
        // What `Support::error` would be, had the shape known its extent.
        let error = self.shape.error().at_least(T::count(16 * N) * T::ROUNDOFF * extent);
        Ok(Anchor { center: None, extent, error, calls: 2 * N as u32 })
    }

    /// The box that support calls along the axes draw around the core.
    fn corner(&self) -> Result<Vector<T, N>, Failure> {
        let mut corner = Vector::<T, N>::zeros();
        for i in 0..N {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, N>::zeros();
                axis[i] = sign;
                // Without shortcuts, which may fall short. Written so that NaN is kept.
                let reach = self.shape.exhaustive(&axis)?.0[i].abs();
                corner[i] = if reach < corner[i] { corner[i] } else { reach };
            }
        }
        Ok(corner)
    }

    /// The anchor in the world, computed as in twice the precision: the shape may be far from its frame, and the frame's position undo that.
    pub(super) fn origin(&self, anchor: &Anchor<T, N>) -> Vector<T, N> {
        let Some(center) = &anchor.center else { return self.translation };
        Vector::from_fn(|i, _| {
            let mut sum = Accumulator::new(self.translation[i]);
            for j in 0..N {
                sum.add_product(self.rotation[(i, j)], center[j]);
            }
            sum.value()
        })
    }

    /// Extents and errors along the axes of the world.
    pub(super) fn axes(&self, anchor: &Anchor<T, N>) -> Axes<T, N> {
        let (mut extents, mut errors) = (self.shape.extents(), self.shape.errors());
        if anchor.center.is_some() || !(self.shape.extent() > T::zero()) {
            extents = Vector::repeat(anchor.extent);
            errors = errors.map(|e| if self.shape.extent() > T::zero() { e } else { e.at_least(anchor.error) });
        }
        let reach = spread(&self.rotation, &extents.add_scalar(self.inflation));
        Axes { errors: spread(&self.rotation, &errors.add_scalar(self.ball_error())), reach }
    }

    /// The support point relative to the placed anchor.
    pub(super) fn farthest(
        &self,
        u: &Vector<T, N>,
        anchor: &Anchor<T, N>,
        exhaustive: bool,
    ) -> Result<Vector<T, N>, Failure> {
        let local = self.rotation.tr_mul(u);
        let point =
            if exhaustive { self.shape.exhaustive(&local).map(|(point, _)| point) } else { self.shape.support(&local) };
        let point = match &point {
            Ok(point) => one_by_one(point),
            Err(failure) => return Err(*failure),
        };
        let point = match &anchor.center {
            Some(center) => point - center,
            None => point,
        };
        let point = if self.inflation > T::zero() {
            let swell = self.inflation / norm(&local);
            point + local * swell
        } else {
            point
        };
        Ok(turned(&self.rotation, &point))
    }
}

/// R x, the columns added from the first to the last.
#[inline(always)]
fn turned<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    let mut sum = rotation.column(0) * x[0];
    for j in 1..N {
        sum += rotation.column(j) * x[j];
    }
    sum
}

/// |R| x: how far a box of half lengths x reaches along the axes, when it is turned.
fn spread<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    let mut sum = Vector::zeros();
    for j in 0..N {
        sum += rotation.column(j).abs() * x[j];
    }
    sum
}

/// The largest entry of |R^T R - I|.
pub(super) fn skew<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>) -> T {
    let mut most = T::zero();
    for i in 0..N {
        let column = rotation.column(i);
        most = most.at_least((column.dot(&column) - T::one()).abs());
        for j in i + 1..N {
            most = most.at_least(column.dot(&rotation.column(j)).abs());
        }
    }
    most
}

/// Are all entries 0, 1 or -1?
pub(super) fn is_exact<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>) -> bool {
    rotation.iter().all(|x| x.is_zero() || x.abs() == T::one())
}

/// Does an almost orthonormal matrix of dimension 2 or 3 leave right what is right? (One with NaN in it does not.)
fn is_proper<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> bool {
    let minor = |i: usize, j: usize| matrix[(i, 0)] * matrix[(j, 1)] - matrix[(j, 0)] * matrix[(i, 1)];
    let determinant = if N == 2 {
        minor(0, 1)
    } else {
        minor(1, 2) * matrix[(0, 2)] + minor(2, 0) * matrix[(1, 2)] + minor(0, 1) * matrix[(2, 2)]
    };
    determinant > T::zero()
}

/// Where a body is measured from: the origin of its frame, or a point near the shape when that is far away.
pub(super) struct Anchor<T: Real, const N: usize> {
    pub(super) center: Option<Vector<T, N>>,
    pub(super) extent: T,
    /// Error of the shape's support function.
    pub(super) error: T,
    /// Calls of the support function that it took to find out.
    pub(super) calls: u32,
}
