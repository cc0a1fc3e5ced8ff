//! Solids of revolution in three dimensions. The axis is z, the centre of the height is the origin. (The capsule exists in the plane too.)

use super::range::{check_sizes, in_range, length, rescaled, signed};
use super::shapes::ShapeError;
use super::{Failure, Route, Support, Symmetry};
use crate::math::load::one_by_one;
use crate::math::{TwoWords, Vector, unit};
use crate::scalar::Real;

/// A cylinder: `x^2 + y^2 <= radius^2`, `|z| <= half_height`. One square root and one division.
///
/// Straight up and down the point is the centre of the face. `error`: z is exact, and the two other coordinates
/// have relative error 5 roundoffs (the unit vector) + 1 (times the radius); `8 u radius`.
///
/// ```
/// use qdist::{Vector, support::{Cylinder, Support}};
/// let c = Cylinder::new(2.0, 1.0).unwrap();
/// assert_eq!(c.support(&Vector::from([3.0, 0.0, -1.0])).unwrap(), Vector::from([2.0, 0.0, -1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<T> {
    radius: T,
    half_height: T,
}

impl<T: Real> Cylinder<T> {
    /// The cylinder of this radius and half height, both >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(radius: T, half_height: T) -> Result<Self, ShapeError> {
        check_sizes([radius, half_height].iter())?;
        Ok(Self::trusted(radius, half_height))
    }

    /// The same for sizes that have been checked before.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(radius: T, half_height: T) -> Self {
        Self { radius, half_height }
    }
}

impl<T: Real> Support<T, 3> for Cylinder<T> {
    #[inline]
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let u = one_by_one(u);
        let n = unit(&Vector::<T, 2>::new(u.x, u.y));
        Ok(Vector::<T, 3>::new(self.radius * n.x, self.radius * n.y, signed(self.half_height, u.z)))
    }
    fn extent(&self) -> T {
        length(&Vector::<T, 2>::new(self.radius, self.half_height))
    }
    fn symmetry(&self) -> Symmetry {
        Symmetry::Axis
    }
    fn route(&self) -> Option<Route<T>> {
        Some(Route::arcs())
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn extents(&self) -> Vector<T, 3> {
        Vector::from([self.radius, self.radius, self.half_height])
    }
    fn support_in_two_words(&self, u: &TwoWords<T, 3>) -> Option<TwoWords<T, 3>> {
        Some(rim(self.radius, signed(self.half_height, u.high.z), u))
    }
    fn errors(&self) -> Vector<T, 3> {
        let rim = T::count(8) * T::ROUNDOFF * self.radius;
        Vector::from([rim, rim, T::zero()])
    }
    fn error(&self) -> T {
        T::count(8) * T::ROUNDOFF * self.radius
    }
}

/// A capsule: all points within `radius` of the segment from `-half_height` to `half_height` on the last axis, which is z in space
/// and y in the plane (`N` = 2). The core is the segment, the radius is the ball term. Exact: `error` is 0.
///
/// ```
/// use qdist::{Vector, support::{Capsule, Support}};
/// let c = Capsule::new(0.5, 2.0).unwrap();
/// assert_eq!(c.support(&Vector::from([3.0, 0.0, -1.0])).unwrap(), Vector::from([0.0, 0.0, -2.0]));
/// assert_eq!(c.radius(), 0.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<T, const N: usize = 3> {
    radius: T,
    half_height: T,
}

impl<T: Real, const N: usize> Capsule<T, N> {
    /// The capsule of this radius and half height of the segment (without the caps), both >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(radius: T, half_height: T) -> Result<Self, ShapeError> {
        check_sizes([radius, half_height].iter())?;
        Ok(Self::trusted(radius, half_height))
    }

    /// The same for sizes that have been checked before.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(radius: T, half_height: T) -> Self {
        Self { radius, half_height }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Capsule<T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let mut end = Vector::zeros();
        end[N - 1] = signed(self.half_height, u[N - 1]);
        Ok(end)
    }
    #[inline]
    fn radius(&self) -> T {
        self.radius
    }
    fn extent(&self) -> T {
        self.half_height
    }
    fn symmetry(&self) -> Symmetry {
        if N == 3 { Symmetry::Axis } else { Symmetry::None }
    }
    fn mirrored(&self, _signs: u8) -> bool {
        true
    }
    fn extents(&self) -> Vector<T, N> {
        let mut extents = Vector::<T, N>::zeros();
        if let Some(last) = extents.iter_mut().last() {
            *last = self.half_height;
        }
        extents
    }
    fn error(&self) -> T {
        T::zero()
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        Some(TwoWords::from(self.support(&u.high).ok()?))
    }
}

/// A cone: apex at `(0, 0, half_height)`, base disk of this radius at `z = -half_height`. One square root and one
/// division.
///
/// The apex is farthest when `2 half_height u_z > radius |(u_x, u_y)|`. `error`: the two sides have relative errors 1 and
/// 5 roundoffs, so a wrong choice costs at most `(2 half_height + 5 radius) u |u|`; the rim point itself is off by
/// `6 u radius`, as for the cylinder; together less than `16 u (radius + half_height)`.
///
/// ```
/// use qdist::{Vector, support::{Cone, Support}};
/// let c = Cone::new(1.0, 2.0).unwrap();
/// assert_eq!(c.support(&Vector::from([1.0, 0.0, 1.0])).unwrap(), Vector::from([0.0, 0.0, 2.0]));
/// assert_eq!(c.support(&Vector::from([1.0, 0.0, 0.0])).unwrap(), Vector::from([1.0, 0.0, -2.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<T> {
    radius: T,
    half_height: T,
}

impl<T: Real> Cone<T> {
    /// The cone of this base radius and half height, both >= 0.
    ///
    /// # Errors
    /// [`ShapeError::Negative`], [`ShapeError::NonFinite`].
    pub fn new(radius: T, half_height: T) -> Result<Self, ShapeError> {
        check_sizes([radius, half_height].iter())?;
        Ok(Self::trusted(radius, half_height))
    }

    /// The same for sizes that have been checked before.
    #[inline(always)]
    #[doc(hidden)]
    pub fn trusted(radius: T, half_height: T) -> Self {
        Self { radius, half_height }
    }

    /// For a direction whose products with the sizes are in range.
    #[inline(always)]
    fn choose(&self, u: &Vector<T, 3>) -> Vector<T, 3> {
        let across = Vector::<T, 2>::new(u.x, u.y);
        let n = unit(&across);
        // |across| as a product with its unit vector: in range whenever the parts are, unlike the squares.
        if (self.half_height + self.half_height) * u.z > self.radius * n.dot(&across) {
            Vector::<T, 3>::new(T::zero(), T::zero(), self.half_height)
        } else {
            Vector::<T, 3>::new(self.radius * n.x, self.radius * n.y, -self.half_height)
        }
    }
}

impl<T: Real> Support<T, 3> for Cone<T> {
    #[inline]
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let u = one_by_one(u);
        let size = self.radius + self.half_height;
        Ok(self.choose(&if in_range(&u, size) { u } else { rescaled(u, size) }))
    }
    fn extent(&self) -> T {
        length(&Vector::<T, 2>::new(self.radius, self.half_height))
    }
    fn symmetry(&self) -> Symmetry {
        Symmetry::Axis
    }
    fn route(&self) -> Option<Route<T>> {
        Some(Route::arcs())
    }
    fn mirrored(&self, signs: u8) -> bool {
        signs & 4 == 0
    }
    fn extents(&self) -> Vector<T, 3> {
        Vector::from([self.radius, self.radius, self.half_height])
    }
    fn support_in_two_words(&self, u: &TwoWords<T, 3>) -> Option<TwoWords<T, 3>> {
        let apex = TwoWords::from(Vector::from([T::zero(), T::zero(), self.half_height]));
        let base = rim(self.radius, -self.half_height, u);
        Some(if u.dot(&apex).minus(&u.dot(&base)) > T::zero() { apex } else { base })
    }
    fn errors(&self) -> Vector<T, 3> {
        self.extents() * (T::count(16) * T::ROUNDOFF)
    }
    fn error(&self) -> T {
        T::count(16) * T::ROUNDOFF * (self.radius + self.half_height)
    }
}

/// The point of a circle around the axis, at height z, that is farthest along a direction, in two words.
fn rim<T: Real>(radius: T, z: T, u: &TwoWords<T, 3>) -> TwoWords<T, 3> {
    let across = |v: &Vector<T, 3>| Vector::from([v.x, v.y, T::zero()]);
    let n = TwoWords { high: across(&u.high), low: across(&u.low) }.unit();
    let mut point = n.times(&Vector::repeat(radius));
    point.high.z = z;
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};

    const SIZES: [(f32, f32); 7] =
        [(1.0, 2.0), (1e-9, 1e9), (1e9, 1e-9), (0.0, 1.0), (1.0, 0.0), (0.0, 0.0), (1e-9, 1e-9)];

    /// Directions around the sphere, with near-axis ones, times the scale.
    fn directions(scale: f64) -> impl Iterator<Item = [f32; 3]> {
        let tilts = [0.0, 1e-30, 1e-20, 1e-9, 1e-5, 0.3, 0.5, 1.0, 1.3, FRAC_PI_2, 1.6, 2.5, PI];
        tilts.into_iter().flat_map(move |t: f64| {
            (0..40).map(move |k| {
                let a = f64::from(k) * 0.1570796;
                [scale * t.sin() * a.cos(), scale * t.sin() * a.sin(), scale * t.cos()].map(|x| x as f32)
            })
        })
    }

    /// The support value and how far outside a point is, in `f64`.
    fn check(shape: &impl Support<f32, 3>, value: impl Fn(f64, f64) -> f64, outside: impl Fn(f64, f64) -> f64) {
        for scale in [1.0, 1e-15, 1e-8, 1e30] {
            for u in directions(scale) {
                let p = shape.support(&Vector::from(u)).unwrap();
                assert!(p.iter().all(|x| x.is_finite()), "{u:?}");
                let (v, q) = (u.map(f64::from), [p.x, p.y, p.z].map(f64::from));
                let n = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
                let up = v[0] * q[0] + v[1] * q[1] + v[2] * q[2];
                let e = f64::from(shape.error());
                let h = value(v[0].hypot(v[1]), v[2]);
                // 1e-14: the rounding of this test itself.
                assert!(up >= h - e * n - 1e-14 * h.abs(), "{u:?} {q:?} {up} {h} {}", e * n);
                assert!(outside(q[0].hypot(q[1]), q[2]) <= e, "{u:?} {q:?}");
            }
        }
    }

    #[test]
    fn cylinder_and_cone_keep_their_promise() {
        for (radius, half) in SIZES {
            let (r, h) = (f64::from(radius), f64::from(half));
            let beyond = move |rho: f64, z: f64| (rho - r).max(0.0).hypot((z.abs() - h).max(0.0));
            check(&Cylinder::new(radius, half).unwrap(), |rho, z| r * rho + h * z.abs(), beyond);
            // A returned point is the apex or on the base.
            let on_cone = move |rho: f64, z: f64| {
                if rho == 0.0 { (z.abs() - h).max(0.0) } else { beyond(rho, z).max((z + h).abs()) }
            };
            check(&Cone::new(radius, half).unwrap(), |rho, z| (h * z).max(r * rho - h * z), on_cone);
            let segment = move |rho: f64, z: f64| rho.hypot((z.abs() - h).max(0.0));
            check(&Capsule::new(radius, half).unwrap(), |_, z| h * z.abs(), segment);
        }
    }

    #[test]
    fn cone_agrees_with_samples_of_its_surface() {
        let cone = Cone::new(1.5f64, 0.75).unwrap();
        for u in directions(1.0) {
            let u = Vector::from(u.map(f64::from));
            let value = cone.support(&u).unwrap().dot(&u);
            for k in 0..200 {
                let a = f64::from(k) * 0.0314159265;
                for s in [0.0, 0.25, 0.5, 1.0] {
                    let p = Vector::from([1.5 * s * a.cos(), 1.5 * s * a.sin(), 0.75 - 1.5 * s]);
                    assert!(p.dot(&u) <= value + 1e-14);
                }
            }
        }
    }

    #[test]
    fn constructors_refuse() {
        assert_eq!(Cylinder::new(-1.0, 1.0), Err(ShapeError::Negative));
        assert_eq!(Cone::new(1.0, f64::NAN), Err(ShapeError::NonFinite));
        assert_eq!(Capsule::<_, 3>::new(f32::INFINITY, 1.0), Err(ShapeError::NonFinite));
    }
}
