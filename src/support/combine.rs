//! Sets made of sets: moved, mapped, added, subtracted, scaled, grown.
//!
//! A combination owns its parts; since a reference to a set is a set, `Rigid::new(&shape, ...)` borrows.
//!
//! # Rounding
//!
//! u is the unit roundoff, E the extent of an inner core, e its error. An extent of 0 means "unknown" (or truly 0, as of a
//! sphere), and then the extent of the combination is 0 too. The rounding that a combination adds is in
//! proportion to coordinates; what is in proportion to an unknown E is left out of `error` and is covered by the
//! solver's own margin, 16 N u times the largest norm that it sees, as each type explains.

use nalgebra::SMatrix;

use super::shapes::{ShapeError, above, check_numbers, check_sizes, in_range, length, rescaled, unit};
use super::{Failure, Support, Symmetry};
use crate::scalar::{Real, Vector};

/// M^T u.
#[inline(always)]
fn transposed<T: Real, const N: usize>(m: &SMatrix<T, N, N>, u: &Vector<T, N>) -> Vector<T, N> {
    let mut w = Vector::<T, N>::zeros();
    for (w, column) in w.iter_mut().zip(&m.data.0) {
        *w = column.iter().zip(u.iter()).fold(-T::zero(), |s, (&a, &b)| s + a * b);
    }
    w
}

/// M x + t.
#[inline(always)]
fn mapped<T: Real, const N: usize>(m: &SMatrix<T, N, N>, x: &Vector<T, N>, t: &Vector<T, N>) -> Vector<T, N> {
    let mut p = Vector::<T, N>::from_element(-T::zero());
    for (column, &x) in m.data.0.iter().zip(x.iter()) {
        for (p, &a) in p.iter_mut().zip(column) {
            *p += a * x;
        }
    }
    // The translation comes last: added first, every partial sum would be rounded at its size.
    p + t
}

/// The extent of a combination: `known` if the parts are known.
#[inline(always)]
fn if_known<T: Real>(parts: &[T], known: T) -> T {
    if parts.iter().all(|&e| e > T::zero()) { above(known, 0) } else { T::zero() }
}

impl<T: Real, const N: usize, S: Support<T, N> + ?Sized> Support<T, N> for &S {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        (**self).support(u)
    }
    #[inline]
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        (**self).support_with_witness(u)
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        (**self).exhaustive(u)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        (**self).has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        (**self).radius()
    }
    fn rolling_radius(&self) -> T {
        (**self).rolling_radius()
    }
    fn extent(&self) -> T {
        (**self).extent()
    }
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        (**self).center()
    }
    fn symmetry(&self) -> Symmetry {
        (**self).symmetry()
    }
    fn error(&self) -> T {
        (**self).error()
    }
}

/// A set moved by x -> R x + t. The ball term stays: `R core + t + radius * ball`.
///
/// That is the set for the matrix *as given*: one that is off orthonormal moves the core by as much. (Where it is off by
/// more than rounding, a [`rolling_radius`](Support::rolling_radius) goes into the support points instead.) Cost: 2 N^2 products.
///
/// `error`: let s >= |R| (1 for a rotation). R^T u has rounding error at most `N sqrt(N) s u |u|`, which costs twice that
/// times E in the farthest point. R x + t has error `(N sqrt(N) s + 2) u E + 2 u |t|`. Together, with
/// room for second order terms, `s e + (4 N sqrt(N) + 2) s u (E + |t|)`. When E is unknown, `|x| <= |p| + |t|` for each point p
/// that the solver sees: |t| takes the place of E, and 16 N u max |p| covers the rest (N <= 15).
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{scalar::Vector, support::{BoxShape, Rigid, Support}};
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
            Ok(Self { shape, rotation, translation, stretch, shift: length(&translation), skewed })
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let local = transposed(&self.rotation, u);
        Ok(self.moved(self.shape.exhaustive(&local)?, &local))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
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
    fn error(&self) -> T {
        let inner = self.shape.extent();
        let reach = if inner > T::zero() { inner } else { self.shift } + self.shift + self.inflation();
        let n = T::count(4 * N) * T::count(N).root() + T::count(N + 10);
        self.stretch * above(self.shape.error() + n * T::ROUNDOFF * reach, N)
    }
}

/// A set under a linear map: x -> M x + t, for any finite matrix, singular ones included.
///
/// A ball does not stay a ball, so the ball term goes into the support point, `M (x + r w/|w|) + t` with w = M^T u, and
/// `radius` is 0. Cost: 2 N^2 products, and a root and a division when there is a ball term.
///
/// `error`: with F >= |M| (the Frobenius norm), r the radius and E + r the reach of the inner set: as for
/// [`Rigid`], `3 N F u (E + r)` for M^T u and the product M y, `(N/2 + 5) u (E + r) F` for the unit vector and the sum y, `2 u` of the
/// result: `F e + (4 N + 8) u (F (E + r) + |t|)`. When E is unknown, F E is replaced by |t|, and the solver's margin
/// covers the rest only as far as M is well conditioned: a flattened set of large coordinates can look small. Give
/// your own shape an `extent` before you flatten it.
///
/// ```
/// use nalgebra::SMatrix;
/// use qdist::{scalar::Vector, support::{Linear, Sphere, Support}};
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let w = self.direction(u);
        Ok(self.image(self.shape.exhaustive(&w)?, &w, self.shape.radius()))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    fn extent(&self) -> T {
        let inner = self.shape.extent();
        if_known(&[inner], self.stretch * (inner + self.shape.radius()) + self.shift)
    }
    fn error(&self) -> T {
        let (inner, radius) = (self.shape.extent(), self.shape.radius());
        let core = if inner > T::zero() { self.stretch * inner } else { self.shift };
        let reach = core + self.stretch * radius + self.shift;
        above(self.stretch * self.shape.error() + T::count(4 * N + 8) * T::ROUNDOFF * reach, N)
    }
}

/// The Minkowski sum `{x + y : x in a, y in b}`. Ball terms add up.
///
/// `error`: the sum of the errors, and one rounding of the sum of the points, `u (E_a + E_b)`; an unknown extent is
/// covered by the solver's margin, since that rounding is at most u |p|.
///
/// ```
/// use qdist::{scalar::Vector, support::{BoxShape, Sphere, Sum, Support}};
/// let rounded = Sum::new(BoxShape::new(Vector::from([1.0, 1.0])).unwrap(), Sphere::new(0.1).unwrap());
/// assert_eq!(rounded.radius(), 0.1);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sum<A, B> {
    /// The first set.
    pub a: A,
    /// The second set.
    pub b: B,
}

impl<A, B> Sum<A, B> {
    /// The sum of two sets.
    #[inline]
    pub const fn new(a: A, b: B) -> Self {
        Self { a, b }
    }
}

impl<T: Real, const N: usize, A: Support<T, N>, B: Support<T, N>> Support<T, N> for Sum<A, B> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.a.support(u)? + self.b.support(u)?)
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.a.exhaustive(u)? + self.b.exhaustive(u)?)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.a.has_shortcuts() || self.b.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        self.a.radius() + self.b.radius()
    }
    fn rolling_radius(&self) -> T {
        self.a.rolling_radius() + self.b.rolling_radius()
    }
    fn extent(&self) -> T {
        let (a, b) = (self.a.extent(), self.b.extent());
        if_known(&[a, b], a + b)
    }
    fn error(&self) -> T {
        pair_error(self.a.error() + self.b.error(), self.a.extent() + self.b.extent())
    }
}

/// The error of a sum or difference of two points; the extents are widened by the error of the points.
#[inline]
fn pair_error<T: Real>(errors: T, extents: T) -> T {
    above(errors + T::ROUNDOFF * (extents + errors), 0)
}

/// The Minkowski difference `{x - y : x in a, y in b}` of two bodies: it contains the origin exactly when they overlap
/// with their ball terms. Ball terms add up. The witness is the core point of `a`.
///
/// `error` as for [`Sum`].
///
/// ```
/// use qdist::{scalar::Vector, support::{BoxShape, Difference, Point, Support}};
/// let b = BoxShape::new(Vector::from([1.0, 1.0])).unwrap();
/// let p = Point::new(Vector::from([0.25, 0.0])).unwrap();
/// let d = Difference::new(&b, &p);
/// let (x, witness) = d.support_with_witness(&Vector::from([1.0, 1.0])).unwrap();
/// assert_eq!((x[0], witness[0]), (0.75, 1.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Difference<A, B> {
    /// The first body.
    pub a: A,
    /// The second body.
    pub b: B,
}

impl<A, B> Difference<A, B> {
    /// The difference of two bodies in the same frame.
    #[inline]
    pub const fn new(a: A, b: B) -> Self {
        Self { a, b }
    }
}

impl<T: Real, const N: usize, A: Support<T, N>, B: Support<T, N>> Support<T, N> for Difference<A, B> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.a.support(u)? - self.b.support(&-u)?)
    }
    #[inline]
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let a = self.a.support(u)?;
        Ok((a - self.b.support(&-u)?, a))
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.a.exhaustive(u)? - self.b.exhaustive(&-u)?)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.a.has_shortcuts() || self.b.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        self.a.radius() + self.b.radius()
    }
    fn rolling_radius(&self) -> T {
        self.a.rolling_radius() + self.b.rolling_radius()
    }
    fn extent(&self) -> T {
        let (a, b) = (self.a.extent(), self.b.extent());
        if_known(&[a, b], a + b)
    }
    fn error(&self) -> T {
        pair_error(self.a.error() + self.b.error(), self.a.extent() + self.b.extent())
    }
}

/// A set scaled about the origin by a factor >= 0, ball term included.
///
/// `error`: `factor e`, and one rounding of each coordinate, `u factor E`; an unknown E is covered by the solver's
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.shape.exhaustive(u)? * self.factor)
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
    fn error(&self) -> T {
        self.factor * pair_error(self.shape.error(), self.shape.extent())
    }
}

/// A set grown by a ball of radius `margin` >= 0: only the ball term changes, so the points and their error are those
/// of the set.
///
/// ```
/// use qdist::{scalar::Vector, support::{BoxShape, Margin, Support}};
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        self.shape.exhaustive(u)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.shape.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        self.shape.radius() + self.margin
    }
    fn rolling_radius(&self) -> T {
        self.shape.rolling_radius()
    }
    fn extent(&self) -> T {
        self.shape.extent()
    }
    fn symmetry(&self) -> Symmetry {
        self.shape.symmetry()
    }
    fn error(&self) -> T {
        self.shape.error()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BoxShape, Cylinder, Ellipsoid, Point, Points, Sphere};
    use super::*;

    type M = SMatrix<f64, 3, 3>;

    struct Dice(u64);

    impl Dice {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 11) as f64) / ((1u64 << 53) as f64) * 2.0 - 1.0
        }
        fn vector(&mut self) -> Vector<f64, 3> {
            Vector::from([0; 3].map(|_| self.next()))
        }
        /// A rotation whose entries are off by up to `off`.
        fn rotation(&mut self, off: f64) -> M {
            let a = self.vector().normalize();
            let b = a.cross(&self.vector()).normalize();
            M::from_columns(&[a, b, a.cross(&b)]) + M::from_fn(|_, _| off * self.next())
        }
        /// Mostly generic, sometimes almost along a column: where the signs of a box are decided by rounding.
        fn direction(&mut self, r: &M) -> Vector<f64, 3> {
            let noise = self.vector();
            if self.next() > 0.0 { noise } else { r.column(0) + noise * 1e-8 * self.next() }
        }
    }

    fn down(v: &Vector<f64, 3>) -> Vector<f32, 3> {
        v.map(|x| x as f32)
    }

    fn up(v: &Vector<f32, 3>) -> Vector<f64, 3> {
        v.map(f64::from)
    }

    fn single(m: &M) -> SMatrix<f32, 3, 3> {
        m.map(|x| x as f32)
    }

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

    #[test]
    fn sums_and_differences_agree_with_all_pairs() {
        let mut dice = Dice(8);
        let a: Vec<[f64; 3]> = (0..9).map(|_| dice.vector().into()).collect();
        let b: Vec<[f64; 3]> = (0..7).map(|_| dice.vector().into()).collect();
        let (pa, pb) = (Points::new(&a).unwrap(), Points::new(&b).unwrap());
        let (sum, difference) = (Sum::new(&pa, &pb), Difference::new(&pa, &pb));
        for _ in 0..200 {
            let u = dice.vector();
            let all = |sign: f64| {
                let pair = |x: &[f64; 3]| {
                    b.iter().map(|y| (Vector::from(*x) + Vector::from(*y) * sign).dot(&u)).fold(f64::MIN, f64::max)
                };
                a.iter().map(pair).fold(f64::MIN, f64::max)
            };
            assert!((sum.support(&u).unwrap().dot(&u) - all(1.0)).abs() < 1e-15 * 10.0);
            let (p, witness) = difference.support_with_witness(&u).unwrap();
            assert!((p.dot(&u) - all(-1.0)).abs() < 1e-15 * 10.0);
            assert_eq!(witness, pa.support(&u).unwrap());
            assert_eq!(p, difference.exhaustive(&u).unwrap());
        }
    }

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
