//! Sets under any linear map.

use nalgebra::SMatrix;

use super::{if_known, mapped, total, transposed};
use crate::math::{Vector, norm, unit};
use crate::scalar::Real;
use crate::support::range::{above, check_numbers, in_range, length, rescaled};
use crate::support::shapes::ShapeError;
use crate::support::{Failure, Support};

/// A set under a linear map: x -> M x + t, for any finite matrix, singular ones included.
///
/// A ball does not stay a ball, so the ball term goes into the support point, `M (x + r w/|w|) + t` with w = M^T u, and
/// `radius` is 0. Cost: 2 N^2 products, and a root and a division when there is a ball term.
///
/// `error`: with F >= |M| (the Frobenius norm), r the radius and E + r the reach of the inner set: as for
/// [`Rigid`](super::Rigid), `3 N F u (E + r)` for M^T u and the product M y, `(N/2 + 5) u (E + r) F` for the unit vector and the sum y, `2 u` of the
/// result: `F e + (4 N + 8) u (F (E + r) + |t|)`. When E is unknown, 2 N support calls along the axes measure it,
/// each time `error` is asked for.
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{Vector, support::{Linear, Sphere, Support}};
/// let ball = Sphere::<f64, 2>::new(1.0).unwrap();
/// let ellipse = Linear::new(ball, SMatrix::<f64, 2, 2>::new(3.0, 0.0, 0.0, 0.0), Vector::zeros()).unwrap();
/// assert_eq!(ellipse.support(&Vector::from([2.0, 1.0])).unwrap(), Vector::from([3.0, 0.0]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Linear<S, T, const N: usize> {
    shape: S,
    matrix: SMatrix<T, N, N>,
    translation: Vector<T, N>,
    /// At least the Frobenius norm of `matrix`.
    stretch: T,
    /// At least |translation|.
    shift: T,
}

impl<S, T: Real, const N: usize> Linear<S, T, N> {
    /// `shape` under x -> M x + t.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`].
    pub fn new(shape: S, matrix: SMatrix<T, N, N>, translation: Vector<T, N>) -> Result<Self, ShapeError> {
        check_numbers(matrix.iter())?;
        check_numbers(translation.iter())?;
        let columns = Vector::<T, N>::from_fn(|j, _| length(&matrix.column(j).into_owned()));
        Ok(Self { shape, matrix, translation, stretch: length(&columns), shift: length(&translation) })
    }

    /// The direction for the inner set: M^T u, times a positive number.
    #[inline(always)]
    fn direction(&self, u: &Vector<T, N>) -> Vector<T, N> {
        let w = if in_range(u, self.stretch) {
            transposed(&self.matrix, u)
        } else {
            transposed(&self.matrix, &rescaled(*u, self.stretch))
        };
        // The inner set must not see a zero direction; here every point of it is as far as any other.
        if w.iter().all(|x| x.is_zero()) { *u } else { w }
    }

    #[inline(always)]
    fn image(&self, x: Vector<T, N>, w: &Vector<T, N>, radius: T) -> Vector<T, N> {
        let y = if radius > T::zero() { x + unit(w) * radius } else { x };
        mapped(&self.matrix, &y, &self.translation)
    }
}

impl<S: Support<T, N>, T: Real, const N: usize> Support<T, N> for Linear<S, T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let w = self.direction(u);
        Ok(self.image(self.shape.support(&w)?, &w, self.shape.radius()))
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let w = self.direction(u);
        let p = self.image(self.shape.exhaustive(&w)?.0, &w, self.shape.radius());
        Ok((p, p))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    fn contains_origin(&self) -> bool {
        self.translation.iter().all(|x| x.is_zero()) && self.shape.contains_origin()
    }
    fn extent(&self) -> T {
        let inner = self.shape.extent();
        if_known(&[inner], self.stretch * total(inner, self.shape.radius()) + self.shift)
    }
    fn error(&self) -> T {
        let (known, radius) = (self.shape.extent(), self.shape.radius());
        let inner = if known > T::zero() { known } else { measured_extent(&self.shape) };
        // What `Support::error` would be by default, had the shape known its extent.
        let own = if known > T::zero() { T::zero() } else { T::count(16 * N) * T::ROUNDOFF * inner };
        let stated = self.shape.error();
        let stated = if stated >= T::zero() { stated.at_least(own) } else { -T::HUGE };
        let reach = self.stretch * total(inner, radius) + self.shift;
        above(self.stretch * stated + T::count(4 * N + 8) * T::ROUNDOFF * reach, N)
    }
}

/// Half the diagonal of the box that support calls along the axes draw around the core: an upper bound of |x|. Infinite when
/// a call fails.
pub(super) fn measured_extent<T: Real, const N: usize>(shape: &impl Support<T, N>) -> T {
    let mut corner = Vector::<T, N>::zeros();
    for i in 0..N {
        for sign in [T::one(), -T::one()] {
            let mut axis = Vector::<T, N>::zeros();
            axis[i] = sign;
            // (Without shortcuts, which may fall short.)
            let Ok((point, _)) = shape.exhaustive(&axis) else { return T::one() / T::zero() };
            corner[i] = corner[i].at_least(point[i].abs());
        }
    }
    norm(&corner)
}

#[cfg(test)]
mod tests {
    use super::super::dice::{Dice, M, down, single, up};
    use super::*;
    use crate::support::{BoxShape, Cylinder, Ellipsoid, Margin, Sphere};

    #[test]
    fn linear_of_ball_and_box_keeps_its_promise() {
        let mut dice = Dice(6);
        for k in 0..1500 {
            let mut m = M::from_fn(|_, _| dice.next());
            match k % 4 {
                0 => m.set_column(1, &(m.column(0) * 2.0)),
                1 => m *= 1e-9,
                2 => m.set_column(2, &(m.column(2) * 1e9)),
                _ => (),
            }
            let (m32, t) = (single(&m), down(&dice.vector()));
            let b = BoxShape::new(Vector::from([1.0f32, 0.5, 2.0])).unwrap();
            let fat = Linear::new(Margin::new(b, 0.25).unwrap(), m32, t).unwrap();
            let m = m32.map(f64::from);
            for scale in [1.0, 1e-15, 1e30] {
                let u32 = down(&(dice.vector() * scale));
                let (u, p) = (up(&u32), up(&fat.support(&u32).unwrap()));
                let w = m.transpose() * u;
                let h = w[0].abs() + 0.5 * w[1].abs() + 2.0 * w[2].abs() + 0.25 * w.norm() + u.dot(&up(&t));
                assert!(u.dot(&p) >= h - f64::from(fat.error()) * u.norm(), "{k} {scale}");
                assert!(p.norm() <= f64::from(fat.extent() + fat.error()));
            }
        }
    }

    #[test]
    fn a_linear_ball_is_an_ellipsoid_and_a_zero_map_is_a_point() {
        let d = Vector::from([1.0, 1e-9, 1e9]);
        let ball = Linear::new(Sphere::<f64, 3>::new(1.0).unwrap(), M::from_diagonal(&d), Vector::zeros()).unwrap();
        let direct = Ellipsoid::new(d).unwrap();
        let mut dice = Dice(7);
        for _ in 0..100 {
            let u = dice.vector();
            assert!((ball.support(&u).unwrap() - direct.support(&u).unwrap()).norm() <= 1e-5);
        }
        assert_eq!(Support::<f64, 3>::radius(&ball), 0.0);
        let t = Vector::from([1.0, 2.0, 3.0]);
        let zero = Linear::new(Cylinder::new(1.0, 1.0).unwrap(), M::zeros(), t).unwrap();
        assert_eq!(zero.support(&Vector::from([1.0, 0.0, 0.0])).unwrap(), t);
    }
}
