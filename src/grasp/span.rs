//! The smallest subspace that contains a wrench set.

use nalgebra::SMatrix;

use super::contact::ContactError;
use super::numbers::check_tolerance;
use super::primitive::Primitive;
use super::svd::Triangular;
use crate::math::{Vector, norm};
use crate::scalar::Real;

/// The minimal subspace R of R^6 that contains a wrench set (paper, end of Section III), by an orthonormal basis. {0}
/// is in the set, so R is the linear span of all centers and discs.
///
/// The basis is orthonormal to 64 roundoffs. Where R is spanned by coordinate axes, up to the same, the basis is these
/// axes, exactly.
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{Vector, grasp::{ContactError, Primitive, Subspace, default_tolerance}};
/// let forces_along_x = Primitive::new(Vector::from([2.0, 0.0, 0.0, 0.0, 0.0, 0.0]), SMatrix::zeros())?;
/// let subspace = Subspace::new(&[forces_along_x], default_tolerance())?;
/// assert_eq!(subspace.dimension(), 1);
/// assert_eq!(subspace.matrix::<1>().unwrap(), Vector::<f64, 6>::x());
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subspace<T> {
    /// An orthonormal basis of R^6; the first `dimension` vectors span R.
    basis: [[T; 6]; 6],
    dimension: usize,
}

impl<T: Real> Subspace<T> {
    /// The span of `primitives`.
    ///
    /// Each center and each column of a disc counts with length 1, so that the answer is about directions: a contact
    /// with little friction or a small force cap counts as much as any. (Columns that are no more than rounding, 64
    /// roundoffs of their primitive, do not count.) The dimension is the number of singular values above `tolerance`
    /// times the largest one. Cost: 4 m Givens rotations of 6 numbers, 6 times, and one 6 x 6 singular value
    /// decomposition.
    ///
    /// # Errors
    /// [`ContactError::Tolerance`].
    pub fn new(primitives: &[Primitive<T>], tolerance: T) -> Result<Self, ContactError> {
        check_tolerance(tolerance)?;
        let mut triangle = Triangular::new();
        let mut touched = [false; 6];
        for primitive in primitives {
            let columns = primitive.disc().data.0.map(Vector::from);
            let [a, b, c] = columns.map(|column| norm(&column));
            let size = norm(primitive.center()).at_least(a).at_least(b).at_least(c);
            let noise = T::count(64) * T::ROUNDOFF * size;
            for column in core::iter::once(primitive.center()).chain(&columns) {
                let length = norm(column);
                if length > noise {
                    triangle.add(column.data.0[0].map(|x| x / length));
                    touched.iter_mut().zip(column.iter()).for_each(|(t, x)| *t |= x.abs() > noise);
                }
            }
        }
        let svd = triangle.svd();
        let [sigma, ..] = svd.sigma;
        let dimension = svd.rank(tolerance * sigma);
        let axes = touched.iter().filter(|&&t| t).count() == dimension;
        Ok(Self { basis: if axes { touched_first(touched) } else { svd.v }, dimension })
    }

    /// Its dimension, 0 to 6.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The basis: unit vectors, orthogonal to each other.
    pub fn basis(&self) -> &[[T; 6]] {
        self.basis.get(..self.dimension).unwrap_or(&self.basis)
    }

    /// An orthonormal basis of the complement of R.
    pub(super) fn complement(&self) -> &[[T; 6]] {
        self.basis.get(self.dimension..).unwrap_or(&[])
    }

    /// The basis as columns of a matrix R, 6 x K; `None` unless K is the dimension. A point x of R^K is the wrench R x.
    pub fn matrix<const K: usize>(&self) -> Option<SMatrix<T, 6, K>> {
        let columns: &[[T; 6]; K] = self.basis().try_into().ok()?;
        Some(SMatrix::from(*columns))
    }

    /// The distance of a wrench from R.
    pub fn distance(&self, wrench: &Vector<T, 6>) -> T {
        let rest = self.basis().iter().map(|axis| Vector::from(*axis));
        norm(&rest.fold(*wrench, |rest, axis| rest - axis * axis.dot(&rest)))
    }
}

/// The coordinate axes, those of `touched` coordinates first.
fn touched_first<T: Real>(touched: [bool; 6]) -> [[T; 6]; 6] {
    let axis = |i: usize| core::array::from_fn(|j| if i == j { T::one() } else { T::zero() });
    let of = |kind: bool| touched.into_iter().enumerate().filter(move |(_, t)| *t == kind).map(|(i, _)| axis(i));
    let mut basis = [[T::zero(); 6]; 6];
    basis.iter_mut().zip(of(true).chain(of(false))).for_each(|(to, axis)| *to = axis);
    basis
}
