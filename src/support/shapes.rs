//! Shapes of any dimension, and why a shape is refused.
//!
//! All shapes are centred at the origin with their axes along the coordinates; place them with
//! [`Rigid`](super::Rigid) or [`Linear`](super::Linear). A size may be zero: flat shapes are legal. A size may
//! be at most `HUGE * ROUNDOFF` (2e31 in `f32`, 2e292 in `f64`), so that no sum of sizes overflows. Below
//! `floor / ROUNDOFF` (1e-23 in `f32`, 1e-275 in `f64`) a non-zero size is legal, but its error bound may underflow.

use core::fmt;

use super::range::{check_numbers, check_sizes, floor, length, rescaled, signed};
use super::{Failure, Route, Support, Symmetry};
use crate::math::load::one_by_one;
use crate::math::{TwoWords, Vector, largest, magnitude, unit};
use crate::scalar::Real;

/// Why a shape cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A size is less than zero.
    Negative,
    /// A number is not finite, or so large that sums of sizes could overflow.
    NonFinite,
    /// A list of points is empty, or a unit set is the origin alone.
    Empty,
    /// A rotation matrix is farther than 1e-3 from orthonormal: use [`Linear`](super::Linear).
    NotOrthonormal,
    /// A direction is zero.
    Direction,
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Negative => {
                "a size of the shape (a radius, half extent, semi axis, half height, margin or scale) is negative"
            }
            Self::NonFinite => "a number of the shape is NaN, infinite or too large",
            Self::Empty => "the shape has no points, or the unit set none but the origin",
            Self::NotOrthonormal => "the matrix of the shape is farther than 1e-3 from orthonormal",
            Self::Direction => "a direction of the shape is zero",
        })
    }
}

impl core::error::Error for ShapeError {}

/// A single point. Exact: `error` is 0.
///
/// ```
/// use qdist::{Vector, support::{Point, Support}};
/// let p = Point::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
/// assert_eq!(p.support(&Vector::from([1.0, 0.0, 0.0])).unwrap()[2], 3.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<T, const N: usize> {
    at: Vector<T, N>,
}

impl<T: Real, const N: usize> Point<T, N> {
    /// The point `at`.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`].
    pub fn new(at: Vector<T, N>) -> Result<Self, ShapeError> {
        check_numbers(at.iter())?;
        Ok(Self { at })
    }
}

impl<T: Real, const N: usize> Support<T, N> for Point<T, N> {
    #[inline]
    fn support(&self, _: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.at)
    }
    fn extent(&self) -> T {
        length(&self.at)
    }
    fn mirrored(&self, signs: u8) -> bool {
        (0..N).all(|i| signs >> i & 1 == 0 || self.at[i] == T::zero())
    }
    fn extents(&self) -> Vector<T, N> {
        self.at.map(magnitude)
    }
    fn support_in_two_words(&self, _: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        Some(TwoWords::from(self.at))
    }
    fn error(&self) -> T {
        T::zero()
    }
}

/// A ball of any dimension around the origin: its core is the origin. Exact: `error` is 0.
///
/// ```
/// use qdist::support::{Sphere, Support};
/// let s = Sphere::<f64, 3>::new(0.5).unwrap();
/// assert_eq!(s.radius(), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere<T, const N: usize> {
    radius: T,
}

impl<T: Real, const N: usize> Sphere<T, N> {
    /// The ball of radius `radius` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(radius: T) -> Result<Self, ShapeError> {
        check_sizes(core::iter::once(&radius))?;
        Ok(Self::trusted(radius))
    }

    /// The same for a radius that has been checked before.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(radius: T) -> Self {
        Self { radius }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Sphere<T, N> {
    #[inline]
    fn support(&self, _: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(Vector::zeros())
    }
    #[inline]
    fn radius(&self) -> T {
        self.radius
    }
    fn symmetry(&self) -> Symmetry {
        Symmetry::Full
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn error(&self) -> T {
        T::zero()
    }
    fn support_in_two_words(&self, _: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        Some(TwoWords::from(Vector::zeros()))
    }
}

/// A box [-h_1, h_1] x ... x [-h_N, h_N]. A vertex is chosen by signs alone, so `error` is 0 for every direction.
///
/// ```
/// use qdist::{Vector, support::{BoxShape, Support}};
/// let b = BoxShape::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
/// assert_eq!(b.support(&Vector::from([1.0, -1.0, 1e-30])).unwrap(), Vector::from([1.0, -2.0, 3.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxShape<T, const N: usize> {
    half: Vector<T, N>,
}

impl<T: Real, const N: usize> BoxShape<T, N> {
    /// The box of half extents `half` >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(half: Vector<T, N>) -> Result<Self, ShapeError> {
        check_sizes(half.iter())?;
        Ok(Self::trusted(half))
    }

    /// The same for sizes that have been checked before.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(half: Vector<T, N>) -> Self {
        Self { half }
    }

    /// The half extents.
    pub(crate) fn half(&self) -> &Vector<T, N> {
        &self.half
    }
}

impl<T: Real, const N: usize> Support<T, N> for BoxShape<T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.half.zip_map(&one_by_one(u), signed))
    }
    fn extent(&self) -> T {
        length(&self.half)
    }
    fn route(&self) -> Option<Route<T>> {
        if const { N == 3 } { Some(Route::boxes()) } else { None }
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn extents(&self) -> Vector<T, N> {
        self.half
    }
    fn error(&self) -> T {
        T::zero()
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        // (The high word has the sign of the sum.)
        Some(TwoWords::from(self.half.zip_map(&u.high, signed)))
    }
}

/// An ellipsoid with its axes along the coordinates: `{D x : |x| <= 1}` with D the diagonal matrix of the semi axes.
/// Two square roots and two divisions.
///
/// The smallest radius of curvature of an ellipsoid is ρ = min(D)^2 / max(D), so a ball of radius ρ rolls inside
/// it, and by Blaschke's rolling theorem the ellipsoid is a Minkowski sum: core + ρ B. The core's support mapping is
/// `D D u / |D u| - ρ u / |u|`. The ball is exact for the solver, and the core that is left for expansion is
/// smaller: nearly round ellipsoids, the hardest smooth sets for expansion, become the easiest. Where the axes
/// differ by more than a factor of 4 the ball is too small to help, and `radius` is 0.
///
/// `error`: the coordinates of the point have relative error at most (N/2 + 6) roundoff: one for D u, N/2 + 1 for
/// the squared norm under the root, one each for root, reciprocal and two products. The exact point is at most
/// max(D) long; the ball adds as much for its ρ <= max(D) and one roundoff for the difference. Hence
/// `(2 N + 16) u max(D)`; in the cold path underflow adds less than roundoff.
///
/// ```
/// use qdist::{Vector, support::{Ellipsoid, Support}};
/// let e = Ellipsoid::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
/// let u = Vector::from([0.0, 5.0, 0.0]);
/// let farthest = e.support(&u).unwrap() + u / 5.0 * e.radius();
/// assert!((farthest - Vector::from([0.0, 2.0, 0.0])).amax() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<T, const N: usize> {
    semi: Vector<T, N>,
    /// The ball term: the largest ball that rolls inside, or 0.
    ball: T,
}

impl<T: Real, const N: usize> Ellipsoid<T, N> {
    /// The ellipsoid of semi axes `semi` >= 0 along the coordinates.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(semi: Vector<T, N>) -> Result<Self, ShapeError> {
        check_sizes(semi.iter())?;
        Ok(Self::trusted(semi))
    }

    /// The same for semi axes that have been checked before. One division.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(semi: Vector<T, N>) -> Self {
        let (most, least) = (largest(&semi), semi.iter().fold(T::HUGE, |m, &x| m.at_most(x)));
        let ball = if least > most * T::of(0.25) {
            least / most * least * (T::one() - T::count(8) * T::ROUNDOFF)
        } else {
            T::zero()
        };
        Self { semi, ball }
    }

    #[cold]
    #[inline(never)]
    fn out_of_range(self, u: Vector<T, N>) -> Vector<T, N> {
        let size = largest(&self.semi);
        if size > T::zero() {
            // Both factors at most 1: what underflows now is far below roundoff relative to |u| max(D).
            let u = rescaled(u, T::one());
            let w = self.semi.zip_map(&u, |d, x| d / size * x);
            self.semi.component_mul(&unit(&w)) - unit(&u) * self.ball
        } else {
            Vector::zeros()
        }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Ellipsoid<T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let u = one_by_one(u);
        let w = self.semi.component_mul(&u);
        let (s, t) = (w.dot(&w), u.dot(&u));
        if s > floor() && s < T::HUGE && t > floor() && t < T::HUGE {
            let inverse = T::one() / s.root();
            let point = self.semi.zip_map(&w, |d, x| d * (x * inverse));
            if self.ball > T::zero() { Ok(point - u * (self.ball / t.root())) } else { Ok(point) }
        } else {
            Ok(one_by_one(&self.out_of_range(u)))
        }
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        let size = largest(&self.semi);
        if !(size > T::count(4) * T::TINY) {
            return Some(TwoWords::from(Vector::zeros()));
        }
        let scale = T::one() / size.power_of_two();
        Some(u.times(&(self.semi * scale)).unit().times(&self.semi))
    }
    fn rolling_radius(&self) -> T {
        self.ball
    }
    fn radius(&self) -> T {
        self.ball
    }
    fn extent(&self) -> T {
        largest(&self.semi)
    }
    fn symmetry(&self) -> Symmetry {
        match self.semi.as_slice() {
            [x, y, _] if x == y => Symmetry::Axis,
            _ => Symmetry::None,
        }
    }
    fn route(&self) -> Option<Route<T>> {
        if const { N != 3 } {
            return None; // (No code of bodies for what is none.)
        }
        let turns = Support::<T, N>::symmetry(self) == Symmetry::Axis;
        Some(if turns { Route::arcs() } else { Route::ellipsoid() })
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn extents(&self) -> Vector<T, N> {
        self.semi
    }
    fn errors(&self) -> Vector<T, N> {
        self.semi * (T::count(2 * N + 16) * T::ROUNDOFF)
    }
    fn error(&self) -> T {
        T::count(2 * N + 16) * T::ROUNDOFF * largest(&self.semi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator: the tests must not depend on a crate or on the clock.
    struct Dice(u64);

    impl Dice {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 11) as f64) / ((1u64 << 53) as f64) * 2.0 - 1.0
        }
        /// Coordinates of very different sizes, some zero, times `size`.
        fn direction(&mut self, size: f64) -> [f64; 3] {
            [0; 3].map(|_| {
                let s = self.next();
                let x = self.next() * 10f64.powf(5.0 * (s - 1.0));
                size * if s.abs() < 0.05 { 0.0 } else { x }
            })
        }
    }

    const SIZES: [[f64; 3]; 6] =
        [[1.0, 2.0, 3.0], [1e-9, 1.0, 1e9], [0.0, 0.0, 0.0], [0.0, 1e-9, 1.0], [1e9, 1e9, 1e-9], [1e-9, 1e-9, 2e-9]];

    /// |D u| / scale of u, and the farthest point, in `f64` with the sizes and the direction scaled.
    fn ellipsoid_value(d: &[f64; 3], u: &[f64; 3]) -> f64 {
        let m = u.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        m * (0..3).map(|i| (d[i] * (u[i] / m)).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn ellipsoid_keeps_its_promise_in_f32() {
        let mut dice = Dice(1);
        for d in SIZES {
            let d32 = d.map(|x| x as f32);
            let d = d32.map(f64::from);
            let e = Ellipsoid::new(Vector::from(d32)).unwrap();
            for scale in [1.0, 1e-15, 1e-22, 1e30] {
                for _ in 0..2000 {
                    let u32 = dice.direction(scale).map(|x| x as f32);
                    let u = u32.map(f64::from);
                    let n = u.iter().map(|x| x * x).sum::<f64>().sqrt();
                    if n == 0.0 {
                        continue;
                    }
                    let p = e.support(&Vector::from(u32)).unwrap();
                    assert!(finite_all(&p));
                    // The core's point and the ball's together.
                    let p: [f64; 3] = std::array::from_fn(|i| f64::from(p[i]) + f64::from(e.radius()) * u[i] / n);
                    let up: f64 = (0..3).map(|i| u[i] * p[i]).sum();
                    let bound = f64::from(e.error());
                    assert!(up >= ellipsoid_value(&d, &u) - bound * n, "{d:?} {u:?} {p:?}");
                    // In the set, up to the error: the nearest point on the ray to p is in it.
                    let g = (0..3).filter(|&i| d[i] > 0.0).map(|i| (p[i] / d[i]).powi(2)).sum::<f64>().sqrt();
                    let length = p.iter().map(|&x| x.powi(2)).sum::<f64>().sqrt();
                    assert!((g - 1.0).max(0.0) * length <= bound + 1e-40);
                }
            }
        }
    }

    fn finite_all(p: &Vector<f32, 3>) -> bool {
        p.iter().all(|x| x.is_finite())
    }

    #[test]
    fn ellipsoid_takes_extreme_directions_in_f64() {
        for s in [1e-300, 1e-30, 1.0, 1e30, 1e300, 5e-324] {
            let e = Ellipsoid::new(Vector::from([1e-9, 1e9, 1.0])).unwrap();
            let p = e.support(&Vector::from([0.0, 0.0, s])).unwrap();
            assert!((p - Vector::from([0.0, 0.0, 1.0])).norm() < 1e-14, "{s} {p}");
        }
        let flat = Ellipsoid::new(Vector::from([0.0, 2.0])).unwrap();
        assert_eq!(flat.support(&Vector::from([1.0, 0.0])).unwrap(), Vector::from([0.0, 0.0]));
    }

    #[test]
    fn box_is_exact() {
        let mut dice = Dice(2);
        for d in SIZES {
            let b = BoxShape::new(Vector::from(d)).unwrap();
            for scale in [1.0, 1e-30, 1e30] {
                for _ in 0..500 {
                    let u = dice.direction(scale);
                    let p = b.support(&Vector::from(u)).unwrap();
                    for i in 0..3 {
                        assert_eq!(p[i] * u[i], d[i] * u[i].abs());
                        assert_eq!(p[i].abs(), d[i]);
                    }
                }
            }
            assert!(b.extent() >= d.iter().map(|x| x * x).sum::<f64>().sqrt());
        }
    }

    #[test]
    fn point_and_sphere() {
        let p = Point::new(Vector::from([3.0f32, -4.0])).unwrap();
        assert!(p.extent() >= 5.0 && p.extent() < 5.001);
        let s = Sphere::<f32, 2>::new(0.0).unwrap();
        assert_eq!(s.support(&Vector::from([1.0, 1.0])).unwrap(), Vector::from([0.0, 0.0]));
    }

    #[test]
    fn constructors_refuse() {
        assert_eq!(Sphere::<f64, 3>::new(-1.0), Err(ShapeError::Negative));
        assert_eq!(Sphere::<f32, 3>::new(f32::NAN), Err(ShapeError::NonFinite));
        assert_eq!(BoxShape::new(Vector::from([1.0f32, f32::MAX])), Err(ShapeError::NonFinite));
        assert_eq!(Point::new(Vector::from([f64::INFINITY])), Err(ShapeError::NonFinite));
        assert!(Ellipsoid::new(Vector::from([0.0f32, 0.0])).is_ok());
    }

    #[test]
    fn lengths_are_upper_bounds_at_any_size() {
        for s in [1e-44f32, 1e-30, 1e-10, 1.0, 1e20, 1e30] {
            let l = f64::from(length(&Vector::from([3.0 * s, 4.0 * s])));
            let exact = (f64::from(3.0 * s).powi(2) + f64::from(4.0 * s).powi(2)).sqrt();
            assert!(l >= exact * (1.0 - 1e-9) - 1e-45 && l <= exact * 1.00001 + 3e-45, "{s} {l} {exact}");
        }
    }
}
