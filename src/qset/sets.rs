//! The built-in unit sets that are polytopes, or a function of yours. All lengths are in the unit of the set A, or of the wrench that one unit of depth means.
//!
//! Each set contains the origin and is not the origin alone. The `error` of each is for unit directions; u is the unit
//! roundoff.

use super::UnitSet;
use crate::math::{Vector, largest, norm};
use crate::scalar::Real;
use crate::support::{BoxShape, Ellipsoid, Failure, Point, Points, ShapeError, Support};

/// `roundings` roundoffs of a length, with room for second order terms.
#[inline]
pub(super) fn roundings<T: Real>(roundings: usize, length: T) -> T {
    T::count(roundings) * T::ROUNDOFF * length
}

/// A size that must not be zero.
pub(super) fn positive<T: Real>(size: T) -> Result<T, ShapeError> {
    if size > T::zero() { Ok(size) } else { Err(ShapeError::Empty) }
}

impl<T: Real, const N: usize, G: UnitSet<T, N> + ?Sized> UnitSet<T, N> for &G {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        (**self).value(u)
    }
    #[inline]
    fn ball_radius(&self) -> Option<T> {
        (**self).ball_radius()
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        (**self).mapping(u)
    }
    fn vertex_count(&self) -> usize {
        (**self).vertex_count()
    }
    fn vertex(&self, index: usize) -> Vector<T, N> {
        (**self).vertex(index)
    }
    fn inner_radius(&self) -> T {
        (**self).inner_radius()
    }
    fn mirrored(&self, signs: u8) -> bool {
        (**self).mirrored(signs)
    }
    fn error(&self) -> T {
        (**self).error()
    }
}

/// A box [-h_1, h_1] x ...: `h = sum of h_i |u_i|`. Some half extents may be zero.
///
/// `error`: N roundoffs of the sum, which is at most |half|: `(N + 1) u |half|`.
///
/// ```
/// use qdist::{qset::{UnitBox, UnitSet}, Vector};
/// let q = UnitBox::new(Vector::from([1.0, 2.0])).unwrap();
/// assert_eq!(q.value(&Vector::from([1.0, -1.0])).unwrap(), 3.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitBox<T, const N: usize> {
    shape: BoxShape<T, N>,
}

impl<T: Real, const N: usize> UnitBox<T, N> {
    /// The box of half extents `half` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`]; [`ShapeError::Empty`] when all are zero.
    pub fn new(half: Vector<T, N>) -> Result<Self, ShapeError> {
        let shape = BoxShape::new(half)?;
        positive(shape.extent())?;
        Ok(Self { shape })
    }

    /// Of sizes that have been looked at before.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    pub fn trusted(half: Vector<T, N>) -> Self {
        Self { shape: BoxShape::trusted(half) }
    }

    /// An upper bound of |q|.
    #[doc(hidden)]
    #[must_use]
    pub fn extent(&self) -> T {
        self.shape.extent()
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for UnitBox<T, N> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(self.shape.support(u)?.dot(u))
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        self.shape.support(u).ok()
    }
    fn vertex_count(&self) -> usize {
        1 << self.shape.half().iter().filter(|&&h| h > T::zero()).count()
    }
    fn vertex(&self, index: usize) -> Vector<T, N> {
        // Gray code: one coordinate changes at a time.
        let mut code = index ^ (index >> 1);
        let half = *self.shape.half();
        half.map(|h| {
            let negative = h > T::zero() && code & 1 == 1;
            if h > T::zero() {
                code >>= 1;
            }
            if negative { -h } else { h }
        })
    }
    fn inner_radius(&self) -> T {
        self.shape.half().iter().fold(T::HUGE, |least, &h| least.at_most(h))
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn error(&self) -> T {
        roundings(N + 1, self.shape.extent())
    }
}

/// A cross-polytope, the hull of the points `+semi_i e_i` and `-semi_i e_i`: `h = max |semi_i u_i|`. Some may be zero.
///
/// `error`: one rounding of a product: `2 u max(semi)`.
///
/// ```
/// use qdist::{qset::{CrossPolytope, UnitSet}, Vector};
/// let q = CrossPolytope::new(Vector::from([1.0, 2.0])).unwrap();
/// assert_eq!(q.value(&Vector::from([1.0, -1.0])).unwrap(), 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossPolytope<T, const N: usize> {
    semi: Vector<T, N>,
    size: T,
}

impl<T: Real, const N: usize> CrossPolytope<T, N> {
    /// The cross-polytope of semi axes `semi` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`]; [`ShapeError::Empty`] when all are zero.
    pub fn new(semi: Vector<T, N>) -> Result<Self, ShapeError> {
        let size = positive(Ellipsoid::new(semi)?.extent())?;
        Ok(Self { semi, size })
    }

    /// Of sizes that have been looked at before.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    pub fn trusted(semi: Vector<T, N>) -> Self {
        Self { semi, size: largest(&semi) }
    }

    /// An upper bound of |q|.
    #[doc(hidden)]
    #[must_use]
    pub fn extent(&self) -> T {
        self.size
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for CrossPolytope<T, N> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        let farther = |m: T, (&s, &x): (&T, &T)| m.at_least(s * x).at_least(-s * x);
        Ok(self.semi.iter().zip(u.iter()).fold(T::zero(), farther))
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        let (mut best, mut point) = (T::zero(), Vector::zeros());
        for i in 0..N {
            let reach = (self.semi[i] * u[i]).abs();
            if reach > best {
                best = reach;
                point = Vector::zeros();
                point[i] = if u[i] < T::zero() { -self.semi[i] } else { self.semi[i] };
            }
        }
        Some(point)
    }
    fn vertex_count(&self) -> usize {
        2 * self.semi.iter().filter(|&&s| s > T::zero()).count()
    }
    fn vertex(&self, index: usize) -> Vector<T, N> {
        let mut point = Vector::<T, N>::zeros();
        let mut axes = self.semi.iter().enumerate().filter(|&(_, &s)| s > T::zero());
        if let Some((i, &s)) = axes.nth(index / 2)
            && let Some(x) = point.get_mut(i)
        {
            *x = if index % 2 == 1 { -s } else { s };
        }
        point
    }
    fn inner_radius(&self) -> T {
        // The ball touches the facet with the normal 1 / semi.
        let least = self.semi.iter().fold(T::HUGE, |least, &s| least.at_most(s));
        let sum = self.semi.iter().fold(T::zero(), |sum, &s| sum + (least / s) * (least / s));
        if least > T::zero() { least / sum.root() * (T::one() - T::count(4 * N) * T::ROUNDOFF) } else { T::zero() }
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn error(&self) -> T {
        roundings(2, self.size)
    }
}

/// The segment from the origin to `end`: `h = max(0, u.end)`. d_Q is then the length, in units of `end`, of the ray from the
/// origin along `end` until it leaves A (paper, ray shooting, after eq. 16).
///
/// `error`: N roundoffs of the product: `(N + 1) u |end|`.
///
/// ```
/// use qdist::{qset::{UnitSet, Segment}, Vector};
/// let q = Segment::new(Vector::from([0.0, 2.0])).unwrap();
/// assert_eq!(q.value(&Vector::from([1.0, 1.0])).unwrap(), 2.0);
/// assert_eq!(q.value(&Vector::from([1.0, -1.0])).unwrap(), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<T, const N: usize> {
    end: Vector<T, N>,
    length: T,
}

impl<T: Real, const N: usize> Segment<T, N> {
    /// The segment from the origin to `end`, which is not zero.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`]; [`ShapeError::Empty`] when `end` is zero.
    pub fn new(end: Vector<T, N>) -> Result<Self, ShapeError> {
        let length = positive(Point::new(end)?.extent())?;
        Ok(Self { end, length })
    }

    /// Of sizes that have been looked at before.
    #[doc(hidden)]
    #[inline(always)]
    #[must_use]
    pub fn trusted(end: Vector<T, N>) -> Self {
        Self { end, length: norm(&end) }
    }

    /// An upper bound of |q|.
    #[doc(hidden)]
    #[must_use]
    pub fn extent(&self) -> T {
        self.length
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for Segment<T, N> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(T::zero().at_least(self.end.dot(u)))
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        (self.end.dot(u) > T::zero()).then_some(self.end)
    }
    fn vertex_count(&self) -> usize {
        1
    }
    fn vertex(&self, _index: usize) -> Vector<T, N> {
        self.end
    }
    fn error(&self) -> T {
        roundings(N + 1, self.length)
    }
}

/// The hull of the origin and a list of points, by linear scan: `h = max(0, max u.q)`.
///
/// `error`: that of [`Points`] for the choice, and N roundoffs of the product: `(3 N + 4) u max |q|`.
///
/// ```
/// use qdist::{qset::{UnitSet, Vertices}, Vector};
/// let corners = [[1.0, 0.0], [0.0, 3.0]];
/// let q = Vertices::new(&corners).unwrap();
/// assert_eq!(q.value(&Vector::from([1.0, 1.0])).unwrap(), 3.0);
/// assert_eq!(q.value(&Vector::from([-1.0, -1.0])).unwrap(), 0.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Vertices<'a, T, const N: usize> {
    points: Points<'a, T, N>,
}

impl<'a, T: Real, const N: usize> Vertices<'a, T, N> {
    /// The hull of the origin and `points`. Reads all of them once.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`]; [`ShapeError::Empty`] when there is no point but the origin.
    pub fn new(points: &'a [[T; N]]) -> Result<Self, ShapeError> {
        let points = Points::new(points)?;
        positive(points.extent())?;
        Ok(Self { points })
    }

    /// An upper bound of |q|.
    #[doc(hidden)]
    #[must_use]
    pub fn extent(&self) -> T {
        self.points.extent()
    }
}

impl<T: Real, const N: usize> UnitSet<T, N> for Vertices<'_, T, N> {
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        Ok(T::zero().at_least(self.points.support(u)?.dot(u)))
    }
    fn mapping(&self, u: &Vector<T, N>) -> Option<Vector<T, N>> {
        self.points.support(u).ok()
    }
    fn vertex_count(&self) -> usize {
        self.points.points().len()
    }
    fn vertex(&self, index: usize) -> Vector<T, N> {
        self.points.points().get(index).map_or(Vector::zeros(), |&p| Vector::from(p))
    }
    fn error(&self) -> T {
        self.points.error() + roundings(N + 2, self.points.extent())
    }
}

/// A unit set given by a closure `u -> h_Q(u)` and the bound of its rounding error.
///
/// ```
/// use qdist::{qset::{UnitSet, UnitSetFn}, Vector};
/// let q = UnitSetFn::new(|u: &Vector<f64, 2>| Ok(u[0].abs()), 0.0).unwrap();
/// assert_eq!(q.value(&Vector::from([-2.0, 5.0])).unwrap(), 2.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct UnitSetFn<F, T> {
    function: F,
    error: T,
}

impl<F, T: Real> UnitSetFn<F, T> {
    /// `function` computes h_Q(u) >= 0, positively homogeneous and convex in u, with rounding error at most `error` for
    /// unit u.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`] of `error`.
    pub fn new(function: F, error: T) -> Result<Self, ShapeError> {
        BoxShape::new(Vector::<T, 1>::new(error))?;
        Ok(Self { function, error })
    }
}

impl<F, T: Real, const N: usize> UnitSet<T, N> for UnitSetFn<F, T>
where
    F: Fn(&Vector<T, N>) -> Result<T, Failure>,
{
    #[inline]
    fn value(&self, u: &Vector<T, N>) -> Result<T, Failure> {
        (self.function)(u)
    }
    fn error(&self) -> T {
        self.error
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Ball, UnitEllipsoid};
    use super::*;
    use nalgebra::SMatrix;

    fn directions(n: usize) -> impl Iterator<Item = Vector<f32, 3>> {
        let mut s = 3u64;
        let mut next = move || {
            s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((s >> 33) as f64 / f64::from(1u32 << 30) - 1.0) as f32
        };
        (0..n).map(move |_| Vector::from([next(), next(), next()]))
    }

    /// The value in `f32` against an exact form in `f64`, at unit directions, to within the unit set's own error.
    fn check(unit: &impl UnitSet<f32, 3>, exact: impl Fn(&Vector<f64, 3>) -> f64) {
        for u in directions(3000) {
            let u = u / u.dot(&u).sqrt();
            let v = u.map(f64::from);
            let (value, truth) = (f64::from(unit.value(&u).unwrap()), exact(&v));
            assert!(value >= 0.0 && (value - truth).abs() <= f64::from(unit.error()), "{u} {value} {truth}");
        }
    }

    #[test]
    fn values_are_within_their_error() {
        for semi in [[1.0f32, 2.0, 3.0], [1e-9, 1.0, 1e9], [0.0, 0.0, 1e-9], [1e-25, 1e-26, 0.0], [1e25, 0.0, 1e25]] {
            let v = Vector::from(semi);
            let w = v.map(f64::from);
            check(&UnitBox::new(v).unwrap(), |u| u.zip_map(&w, |x, h| x.abs() * h).sum());
            check(&CrossPolytope::new(v).unwrap(), |u| u.zip_map(&w, |x, h| x.abs() * h).max());
            check(&Segment::new(v).unwrap(), |u| u.dot(&w).max(0.0));
            let points = [semi, [-semi[1], semi[2], semi[0]], [semi[2], -semi[0], -semi[1]]];
            let all = points.map(|p| Vector::from(p.map(f64::from)));
            check(&Vertices::new(&points).unwrap(), |u| all.iter().fold(0.0, |m, p| p.dot(u).max(m)));
            let (s, c) = 0.7f32.sin_cos();
            // Off orthonormal by rounding and a little more.
            let r = SMatrix::<f32, 3, 3>::new(c, -s, 0.0, s, c, 1e-7, 0.0, 0.0, 1.0);
            let r64 = r.map(f64::from);
            check(&UnitEllipsoid::new(v, r).unwrap(), |u| (r64.transpose() * u).component_mul(&w).norm());
        }
        check(&Ball::new(1e9f32).unwrap(), |u| 1e9 * u.norm());
        check(&UnitSetFn::new(|u: &Vector<f32, 3>| Ok(u.x.abs()), 0.0).unwrap(), |u| u.x.abs());
        check(&&Ball::<f32>::unit(), |u| u.norm());
    }

    #[test]
    fn inner_balls_are_inside() {
        let (s, c) = 0.7f32.sin_cos();
        for off in [0.0, 1e-4, -1e-3] {
            let r = SMatrix::<f32, 3, 3>::new(c, -s, 0.0, s, c, off, 0.0, off, 1.0);
            for semi in [[1.0f32, 2.0, 3.0], [1e-6, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 1.0, 2.0]] {
                let (v, least) = (Vector::from(semi), semi[0]);
                let turned = UnitEllipsoid::new(v, r).unwrap();
                let units: [&dyn UnitSet<f32, 3>; 3] =
                    [&turned, &UnitBox::new(v).unwrap(), &CrossPolytope::new(v).unwrap()];
                assert!(turned.inner_radius() > least * 0.99 || least == 0.0);
                for unit in units {
                    for u in directions(500) {
                        let u = u / u.dot(&u).sqrt();
                        assert!(unit.value(&u).unwrap() >= unit.inner_radius() - unit.error());
                    }
                }
            }
        }
    }

    #[test]
    fn failures_and_radii_pass_through() {
        let q = UnitSetFn::new(|_: &Vector<f64, 2>| Err(Failure(7)), 0.0).unwrap();
        assert_eq!(q.value(&Vector::from([1.0, 0.0])), Err(Failure(7)));
        assert_eq!(UnitSet::<f64, 3>::ball_radius(&&Ball::new(2.0).unwrap()), Some(2.0));
    }

    #[test]
    fn constructors_refuse() {
        let identity = SMatrix::<f64, 2, 2>::identity();
        let zero = Vector::<f64, 2>::zeros();
        assert_eq!(Ball::new(0.0), Err(ShapeError::Empty));
        assert_eq!(Ball::new(-1.0f32), Err(ShapeError::Negative));
        assert_eq!(Ball::new(f64::NAN), Err(ShapeError::NonFinite));
        assert_eq!(UnitEllipsoid::new(zero, identity), Err(ShapeError::Empty));
        assert_eq!(UnitEllipsoid::new(Vector::from([1.0, 1.0]), identity * 2.0), Err(ShapeError::NotOrthonormal));
        assert_eq!(UnitEllipsoid::new(Vector::from([1.0, 1.0]), identity * f64::NAN), Err(ShapeError::NonFinite));
        assert_eq!(UnitBox::new(zero), Err(ShapeError::Empty));
        assert_eq!(CrossPolytope::new(zero), Err(ShapeError::Empty));
        assert_eq!(CrossPolytope::new(Vector::from([-1.0, 1.0])), Err(ShapeError::Negative));
        assert_eq!(Segment::new(zero), Err(ShapeError::Empty));
        assert_eq!(Vertices::<f64, 2>::new(&[]).err(), Some(ShapeError::Empty));
        assert_eq!(Vertices::new(&[[0.0f64, 0.0]]).err(), Some(ShapeError::Empty));
    }
}
