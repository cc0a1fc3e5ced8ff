//! Minkowski sums and differences.

use super::{all_if_known, if_known, pair_error, pair_errors, rounding_of_radii, total};
use crate::math::Vector;
use crate::scalar::Real;
use crate::support::{Failure, Support};

/// The Minkowski sum `{x + y : x in a, y in b}`. Ball terms add up.
///
/// `error`: the sum of the errors, one rounding of the sum of the points, `u (E_a + E_b)`, and one of that of two ball terms; an unknown extent is
/// covered by the solver's margin, since that rounding is at most u |p|.
///
/// ```
/// use qdist::{Vector, support::{BoxShape, Sphere, Sum, Support}};
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let p = self.a.exhaustive(u)?.0 + self.b.exhaustive(u)?.0;
        Ok((p, p))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.a.has_shortcuts() || self.b.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        total(self.a.radius(), self.b.radius())
    }
    fn rolling_radius(&self) -> T {
        total(self.a.rolling_radius(), self.b.rolling_radius())
    }
    fn extent(&self) -> T {
        let (a, b) = (self.a.extent(), self.b.extent());
        if_known(&[a, b], a + b)
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.a.mirrored(signs) && self.b.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.a.contains_origin() && self.b.contains_origin()
    }
    fn error(&self) -> T {
        let radii = rounding_of_radii(self.a.radius(), self.b.radius());
        pair_error(total(self.a.error(), self.b.error()), self.a.extent() + self.b.extent()) + radii
    }
    fn errors(&self) -> Vector<T, N> {
        let radii = rounding_of_radii(self.a.radius(), self.b.radius());
        pair_errors(self.a.errors() + self.b.errors(), self.a.extents() + self.b.extents()).add_scalar(radii)
    }
    fn extents(&self) -> Vector<T, N> {
        all_if_known(&[self.a.extent(), self.b.extent()], self.a.extents() + self.b.extents())
    }
}

/// The Minkowski difference `{x - y : x in a, y in b}` of two bodies: it contains the origin exactly when they overlap
/// with their ball terms. Ball terms add up. The witness is the core point of `a`.
///
/// `error` as for [`Sum`].
///
/// ```
/// use qdist::{Vector, support::{BoxShape, Difference, Point, Support}};
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let a = self.a.exhaustive(u)?.0;
        Ok((a - self.b.exhaustive(&-u)?.0, a))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.a.has_shortcuts() || self.b.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        total(self.a.radius(), self.b.radius())
    }
    fn rolling_radius(&self) -> T {
        total(self.a.rolling_radius(), self.b.rolling_radius())
    }
    fn extent(&self) -> T {
        let (a, b) = (self.a.extent(), self.b.extent());
        if_known(&[a, b], a + b)
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.a.mirrored(signs) && self.b.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.a.contains_origin() && self.b.contains_origin()
    }
    fn error(&self) -> T {
        let radii = rounding_of_radii(self.a.radius(), self.b.radius());
        pair_error(total(self.a.error(), self.b.error()), self.a.extent() + self.b.extent()) + radii
    }
    fn errors(&self) -> Vector<T, N> {
        let radii = rounding_of_radii(self.a.radius(), self.b.radius());
        pair_errors(self.a.errors() + self.b.errors(), self.a.extents() + self.b.extents()).add_scalar(radii)
    }
    fn extents(&self) -> Vector<T, N> {
        all_if_known(&[self.a.extent(), self.b.extent()], self.a.extents() + self.b.extents())
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::Dice;
    use super::*;
    use crate::support::Points;

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
            assert_eq!((p, witness), difference.exhaustive(&u).unwrap());
        }
    }

    #[test]
    fn mirrors_are_proofs() {
        use crate::plan::distance::Inflated;
        use crate::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Margin, Point, Scaled, Sphere};
        let at = |x: [f64; 3]| Point::new(Vector::from(x)).unwrap();
        let cuboid = BoxShape::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
        let cone = Cone::new(1.0, 2.0).unwrap();
        let sets: [(&dyn Support<f64, 3>, u8); 12] = [
            (&cuboid, 7),
            (&Ellipsoid::new(Vector::from([1.0, 2.0, 3.0])).unwrap(), 7),
            (&Sphere::new(1.0).unwrap(), 7),
            (&Cylinder::new(1.0, 2.0).unwrap(), 7),
            (&Capsule::new(1.0, 2.0).unwrap(), 7),
            (&cone, 3),
            (&at([0.0, 1.0, -0.0]), 5),
            (&Margin::new(&cone, 1.0).unwrap(), 3),
            (&Scaled::new(&cone, 2.0).unwrap(), 3),
            (&Sum::new(cuboid, at([0.0, 0.0, 1.0])), 3),
            (&Difference::new(at([1.0, 0.0, 0.0]), &cone), 2),
            (&Inflated(&Margin::new(&cone, 1.0).unwrap()), 3),
        ];
        let mut dice = Dice(9);
        for (k, (set, mirrors)) in sets.iter().enumerate() {
            for signs in 1..8u8 {
                let mirrored = set.mirrored(signs);
                assert_eq!(mirrored, signs & !mirrors == 0, "{k} {signs}");
                let flip = |v: Vector<f64, 3>| Vector::from_fn(|i, _| if signs >> i & 1 == 1 { -v[i] } else { v[i] });
                for _ in 0..if mirrored { 20 } else { 0 } {
                    let u = dice.vector();
                    let (here, there) =
                        (set.support(&u).unwrap().dot(&u), set.support(&flip(u)).unwrap().dot(&flip(u)));
                    assert!((here - there).abs() < 1e-14, "{k} {signs}");
                }
            }
        }
    }
}
