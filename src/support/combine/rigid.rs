//! Sets that are turned and moved.

use nalgebra::SMatrix;

use super::{if_known, mapped, total, transposed};
use crate::math::{Vector, magnitude, unit};
use crate::scalar::Real;
use crate::support::range::{above, check_numbers, length};
use crate::support::shapes::ShapeError;
use crate::support::{Failure, Support, Symmetry};

/// A set moved by x -> R x + t. The ball term stays: `R core + t + radius * ball`.
///
/// That is the set for the matrix *as given*: one that is off orthonormal moves the core by as much. (Where it is off by
/// more than rounding, a [`rolling_radius`](Support::rolling_radius) goes into the support points instead.) Cost: 2 N^2 products.
///
/// `error`: let s >= |R| (1 for a rotation). R^T u has rounding error at most `N sqrt(N) s u |u|`, which costs twice that
/// times E in the farthest point. R x + t has error `(N sqrt(N) s + 2) u E + 2 u |t|`. Together, with
/// room for second order terms, `s e + (4 N sqrt(N) + 2) s u (E + |t|)`. When E is unknown, `|x| <= |p| + |t|` for each point p
/// that the solver sees: |t| takes the place of E, and 16 N u max |p| covers the rest (N <= 15). Where all entries of R are 0, 1 or -1, both
/// products are exact, and `e + 2 u (E + |t|)` is left.
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{Vector, support::{BoxShape, Rigid, Support}};
/// let b = BoxShape::new(Vector::from([1.0, 2.0])).unwrap();
/// let quarter_turn = SMatrix::<f64, 2, 2>::new(0.0, -1.0, 1.0, 0.0);
/// let moved = Rigid::new(&b, quarter_turn, Vector::from([10.0, 0.0])).unwrap();
/// assert_eq!(moved.support(&Vector::from([1.0, 1.0])).unwrap(), Vector::from([12.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rigid<S, T, const N: usize> {
    shape: S,
    rotation: SMatrix<T, N, N>,
    translation: Vector<T, N>,
    /// At least the norm of `rotation`, and at least 1.
    stretch: T,
    /// At least |translation|.
    shift: T,
    /// Is the matrix off orthonormal by more than rounding?
    skewed: bool,
    /// Are products with the matrix rounded?
    rounds: bool,
}

impl<S, T: Real, const N: usize> Rigid<S, T, N> {
    /// `shape`, rotated (or mirrored), then translated. N^3 products.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`]; [`ShapeError::NotOrthonormal`] when R^T R is farther than 1e-3 from the identity.
    pub fn new(shape: S, rotation: SMatrix<T, N, N>, translation: Vector<T, N>) -> Result<Self, ShapeError> {
        check_numbers(rotation.iter())?;
        check_numbers(translation.iter())?;
        // |R|^2 = |R^T R| <= 1 + |R^T R - I|, and the Frobenius norm bounds the last one.
        let mut squares = T::zero();
        for (i, a) in rotation.data.0.iter().enumerate() {
            for (j, b) in rotation.data.0.iter().enumerate() {
                let unit = if i == j { -T::one() } else { T::zero() };
                let off = a.iter().zip(b).fold(unit, |s, (&x, &y)| s + x * y);
                squares += off * off;
            }
        }
        let off = squares.root();
        // Written so that NaN (from entries whose squares overflow) is refused.
        if off <= T::of(1e-3) {
            let stretch = T::one() + off + T::count(N * N + 8) * T::ROUNDOFF;
            let skewed = off > T::count(16 * N) * T::ROUNDOFF;
            let rounds = rotation.iter().any(|x| !x.is_zero() && magnitude(*x) != T::one());
            Ok(Self { shape, rotation, translation, stretch, shift: length(&translation), skewed, rounds })
        } else {
            Err(ShapeError::NotOrthonormal)
        }
    }
}

impl<S, T: Real, const N: usize> Rigid<S, T, N> {
    /// Radius of the ball that goes into the support points.
    #[inline]
    fn inflation(&self) -> T
    where
        S: Support<T, N>,
    {
        if self.skewed { self.shape.rolling_radius() } else { T::zero() }
    }

    /// |R| x: how far a box of half lengths x reaches along the axes, when it is turned.
    fn spread(&self, x: &Vector<T, N>) -> Vector<T, N> {
        let columns = self.rotation.data.0.iter().zip(x.iter());
        columns.fold(Vector::zeros(), |sum, (column, &x)| sum + Vector::from(*column).abs() * x)
    }

    #[inline]
    fn moved(&self, mut x: Vector<T, N>, local: &Vector<T, N>) -> Vector<T, N>
    where
        S: Support<T, N>,
    {
        if self.skewed {
            x += unit(local) * self.inflation();
        }
        mapped(&self.rotation, &x, &self.translation)
    }
}

impl<S: Support<T, N>, T: Real, const N: usize> Support<T, N> for Rigid<S, T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let local = transposed(&self.rotation, u);
        Ok(self.moved(self.shape.support(&local)?, &local))
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let local = transposed(&self.rotation, u);
        let p = self.moved(self.shape.exhaustive(&local)?.0, &local);
        Ok((p, p))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    fn contains_origin(&self) -> bool {
        self.translation.iter().all(|x| x.is_zero()) && self.shape.contains_origin()
    }
    #[inline]
    fn radius(&self) -> T {
        self.shape.radius() - self.inflation()
    }
    fn rolling_radius(&self) -> T {
        self.shape.rolling_radius() - self.inflation()
    }
    fn extent(&self) -> T {
        let inner = self.shape.extent();
        if_known(&[inner], self.stretch * (inner + self.inflation()) + self.shift)
    }
    /// Of sets that are moved along the axis only.
    fn symmetry(&self) -> Symmetry {
        let still = |length: &T| length.is_zero();
        let unturned = self.rotation == SMatrix::<T, N, N>::identity();
        match (self.shape.symmetry(), self.translation.as_slice()) {
            (Symmetry::Full, t) if unturned && t.iter().all(still) => Symmetry::Full,
            (Symmetry::Full | Symmetry::Axis, [x, y, _]) if unturned && still(x) && still(y) => Symmetry::Axis,
            _ => Symmetry::None,
        }
    }
    fn error(&self) -> T {
        let inner = self.shape.extent();
        // (And the radius that is left when a ball goes into the points is rounded.)
        let reach = if inner > T::zero() { inner } else { self.shift } + self.shift + self.inflation();
        let reach = if self.inflation() > T::zero() { reach + self.radius() } else { reach };
        if !self.rounds {
            return above(self.shape.error() + T::count(2) * T::ROUNDOFF * reach, N);
        }
        let n = T::count(4 * N) * T::count(N).root() + T::count(N + 10);
        self.stretch * above(total(self.shape.error(), n * T::ROUNDOFF * reach), N)
    }
    /// As for `error`, with |R| x in the place of s |x|: R^T u has rounding error N u |R|^T |u|, which costs twice that times |R| E; R x + t
    /// has (N + 1) u |R| E + u |t|.
    fn errors(&self) -> Vector<T, N> {
        if !(self.shape.extent() > T::zero()) || self.skewed {
            return Vector::repeat(self.error());
        }
        let rounding = self.spread(&self.shape.extents()) * T::count(3 * N + 4) + self.translation.abs() * T::count(2);
        (self.spread(&self.shape.errors()) + rounding * T::ROUNDOFF).map(|x| above(x, 2 * N))
    }
    fn extents(&self) -> Vector<T, N> {
        if !(self.shape.extent() > T::zero()) || self.skewed {
            return Vector::repeat(self.extent());
        }
        (self.spread(&self.shape.extents()) + self.translation.abs()).map(|x| above(x, N))
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::{Dice, M, down, single, up};
    use super::*;
    use crate::support::BoxShape;

    #[test]
    fn rigid_keeps_its_promise_for_inexact_rotations() {
        let mut dice = Dice(5);
        for half in [[1.0f32, 2.0, 3.0], [1e-9, 1e9, 1.0], [1e9, 1e9, 1e-9], [0.0, 0.0, 1.0], [1e-9, 1e-9, 1e-9]] {
            let b = BoxShape::new(Vector::from(half)).unwrap();
            for far in [0.0, 1.0, 1e6] {
                for _ in 0..300 {
                    let r = single(&dice.rotation(1e-7));
                    let t = down(&(dice.vector() * far));
                    let moved = Rigid::new(&b, r, t).unwrap();
                    let r = r.map(f64::from);
                    let e = f64::from(moved.error());
                    for scale in [1.0, 1e-15, 1e28] {
                        let u32 = down(&(dice.direction(&r) * scale));
                        let u = up(&u32);
                        let p = moved.support(&u32).unwrap();
                        assert!(p.iter().all(|x| x.is_finite()));
                        let w = r.transpose() * u;
                        let h = (0..3).map(|i| w[i].abs() * f64::from(half[i])).sum::<f64>() + u.dot(&up(&t));
                        assert!(u.dot(&up(&p)) >= h - e * u.norm() - 1e-12 * h.abs(), "{half:?} {far} {scale}");
                        // Within e of the core: undo the map.
                        let x = r.try_inverse().unwrap() * (up(&p) - up(&t));
                        let out = Vector::<f64, 3>::from_fn(|i, _| (x[i].abs() - f64::from(half[i])).max(0.0)).norm();
                        assert!(out <= 1.000001 * e + 1e-25, "{out} {e}");
                        assert!(p.norm() <= moved.extent() + moved.error());
                    }
                }
            }
        }
        let b = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap();
        assert_eq!(Rigid::new(b, M::identity() * 1.01, Vector::zeros()).err(), Some(ShapeError::NotOrthonormal));
        assert_eq!(Rigid::new(b, M::identity() * f64::NAN, Vector::zeros()).err(), Some(ShapeError::NonFinite));
    }
}
