//! The convex hull of two sets.

use super::linear::measured_extent;
use super::{above, total};
use crate::math::{Vector, finite, largest, unit};
use crate::scalar::Real;
use crate::support::range::{in_range, length, rescaled};
use crate::support::{Failure, Support, Symmetry};

/// The convex hull of the union of two sets, which geometry calls their join: the smallest convex set that contains both.
/// Tapered capsules are joins of two spheres, frustums of two discs (cylinders of height 0), swept shapes of a shape and its translate.
///
/// Its farthest point is the farther one of its parts' points,
///
/// ```text
/// h(u) = max(h_a(u), h_b(u))
/// ```
///
/// and a ball that both parts contain is one of the join: conv((X + rB) ∪ (Y + rB)) = conv(X ∪ Y) + rB. So the smaller of the two
/// radii is the join's ball term, and what the larger has beyond it goes into the support points of its part. Cost: both
/// parts' support functions, 3 N products, and a root and a division when the radii differ.
///
/// `error`: that of the parts. The larger radius' excess s is put on with relative error (N/2 + 4) u, and one rounding of the sum:
/// `(N/2 + 4) u s + u (E + s)` where there is an excess. And the part is chosen by the sign of u.(p - q), which is off by
/// (N + 1) u |u| |p - q|. An extent that is not known is measured by 2 N support calls along the axes, each time `extent` or
/// `error` is asked for.
///
/// ```
/// use nalgebra::Matrix3;
/// use qdist::{Vector, support::{Join, Rigid, Sphere, Support}};
/// let tip = Rigid::new(Sphere::new(0.25).unwrap(), Matrix3::identity(), Vector::from([0.0, 0.0, 2.0])).unwrap();
/// let tapered_capsule = Join::new(Sphere::<f64, 3>::new(1.0).unwrap(), tip);
/// assert_eq!(tapered_capsule.radius(), 0.25);
/// assert_eq!(tapered_capsule.support(&Vector::from([3.0, 0.0, 0.0])).unwrap(), Vector::from([0.75, 0.0, 0.0]));
/// assert_eq!(tapered_capsule.support(&Vector::from([0.0, 0.0, 3.0])).unwrap(), Vector::from([0.0, 0.0, 2.0]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Join<A, B> {
    /// The first part.
    pub a: A,
    /// The second part.
    pub b: B,
}

impl<A, B> Join<A, B> {
    /// The hull of two sets.
    #[inline]
    pub const fn new(a: A, b: B) -> Self {
        Self { a, b }
    }

    /// By how much the first part's radius is larger than the second's.
    #[inline(always)]
    fn excess<T: Real, const N: usize>(&self) -> T
    where
        A: Support<T, N>,
        B: Support<T, N>,
    {
        self.a.radius() - self.b.radius()
    }

    /// The farther of the parts' points, the larger ball's excess put on.
    #[inline(always)]
    fn farther<T: Real, const N: usize>(
        &self,
        u: &Vector<T, N>,
        mut p: Vector<T, N>,
        mut q: Vector<T, N>,
    ) -> Vector<T, N>
    where
        A: Support<T, N>,
        B: Support<T, N>,
    {
        let excess = self.excess();
        if excess > T::zero() {
            p += unit(u) * excess;
        } else if excess < T::zero() {
            q -= unit(u) * excess;
        }
        farther_of(u, p, q)
    }

    /// A bound of the distance between points of the two parts, excess included; for the rounding that is in proportion to it.
    fn spread<T: Real, const N: usize>(&self) -> T
    where
        A: Support<T, N>,
        B: Support<T, N>,
    {
        let excess = self.excess().abs();
        let apart = match (self.a.center(), self.b.center()) {
            (Some((a, near_a)), Some((b, near_b))) => length(&(a - b)) + near_a + near_b,
            _ => size(&self.a) + size(&self.b),
        };
        apart + excess
    }
}

/// Which of two points is farther along `u`.
#[inline(always)]
fn farther_of<T: Real, const N: usize>(u: &Vector<T, N>, p: Vector<T, N>, q: Vector<T, N>) -> Vector<T, N> {
    let between = p - q;
    if !in_range(u, largest(&between)) {
        return farther_out_of_range(*u, p, q);
    }
    if u.dot(&between) >= T::zero() { p } else { q }
}

#[cold]
#[inline(never)]
fn farther_out_of_range<T: Real, const N: usize>(u: Vector<T, N>, p: Vector<T, N>, q: Vector<T, N>) -> Vector<T, N> {
    let between = p - q;
    // What a part said must not get lost behind what the other one said.
    if !finite(&between) {
        return between;
    }
    if rescaled(u, T::one()).dot(&rescaled(between, T::one())) >= T::zero() { p } else { q }
}

/// The extent of a part: its own word, or measured.
fn size<T: Real, const N: usize>(part: &impl Support<T, N>) -> T {
    let known = part.extent();
    if known > T::zero() { known } else { measured_extent(part) }
}

/// The error of a part; where it does not know its extent, at least what the default would be.
fn stated_error<T: Real, const N: usize>(part: &impl Support<T, N>) -> T {
    let known = part.extent() > T::zero();
    let default = if known { T::zero() } else { T::count(16 * N) * T::ROUNDOFF * measured_extent(part) };
    let stated = part.error();
    if stated >= T::zero() { stated.at_least(default) } else { -T::HUGE }
}

impl<T: Real, const N: usize, A: Support<T, N>, B: Support<T, N>> Support<T, N> for Join<A, B> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.farther(u, self.a.support(u)?, self.b.support(u)?))
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let p = self.farther(u, self.a.exhaustive(u)?.0, self.b.exhaustive(u)?.0);
        Ok((p, p))
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        self.a.has_shortcuts() || self.b.has_shortcuts()
    }
    #[inline]
    fn radius(&self) -> T {
        self.a.radius().at_most(self.b.radius())
    }
    /// The whole ball where one of the parts' is not one by definition: it is then mapped like all else.
    fn rolling_radius(&self) -> T {
        let rolling = self.a.rolling_radius() > T::zero() || self.b.rolling_radius() > T::zero();
        if rolling { self.radius() } else { T::zero() }
    }
    fn extent(&self) -> T {
        let excess = self.excess();
        let a = size(&self.a) + excess.at_least(T::zero());
        above(a.at_least(size(&self.b) + (-excess).at_least(T::zero())), 0)
    }
    /// Between the parts' centers. Where a ball's excess is put on, points are rounded at their distance from the origin, and nothing is gained.
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        let ((a, near_a), (b, near_b)) = (self.a.center()?, self.b.center()?);
        let center = (a + b) * T::of(0.5);
        let reach = (length(&(a - center)) + near_a).at_least(length(&(b - center)) + near_b);
        (self.excess() == T::zero()).then(|| (center, above(reach, N)))
    }
    fn symmetry(&self) -> Symmetry {
        match (self.a.symmetry(), self.b.symmetry()) {
            (Symmetry::None, _) | (_, Symmetry::None) => Symmetry::None,
            (Symmetry::Full, Symmetry::Full) => Symmetry::Full,
            _ => Symmetry::Axis,
        }
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.a.mirrored(signs) && self.b.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.a.contains_origin() || self.b.contains_origin()
    }
    fn error(&self) -> T {
        let excess = self.excess().abs();
        let put_on = if excess > T::zero() { T::count(N / 2 + 5) * excess + self.extent() } else { T::zero() };
        let rounding = (T::count(N + 2) * self.spread() + put_on) * T::ROUNDOFF;
        // A negative number, which a query refuses, must not hide behind a positive one.
        let (a, b) = (stated_error(&self.a), stated_error(&self.b));
        above(total(a, b).at_most(a.at_least(b)) + rounding, 0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::{Dice, down, single, up};
    use super::*;
    use crate::support::{BoxShape, Cylinder, Ellipsoid, Margin, Points, Rigid, Sphere};
    use nalgebra::Matrix3;

    /// Height of the whole set, ball included, along a vector.
    fn height(set: &dyn Support<f32, 3>, u: &Vector<f32, 3>) -> f64 {
        up(&set.support(u).unwrap()).dot(&up(u)) + f64::from(set.radius()) * up(u).norm()
    }

    #[test]
    fn the_farther_part_decides_within_the_stated_error() {
        let mut dice = Dice(11);
        let cuboid = BoxShape::new(Vector::from([1.0f32, 0.5, 2.0])).unwrap();
        let fat = Margin::new(Cylinder::new(0.5f32, 0.25).unwrap(), 0.75).unwrap();
        let round = Ellipsoid::new(Vector::from([1.0f32, 0.75, 0.5])).unwrap();
        let ball = Sphere::<f32, 3>::new(0.5).unwrap();
        let shapes: [&dyn Support<f32, 3>; 4] = [&cuboid, &fat, &round, &ball];
        for k in 0..4000 {
            let (first, second) = (shapes[k % 4], shapes[k / 4 % 4]);
            let pose = |dice: &mut Dice| (single(&dice.rotation(0.0)), down(&(dice.vector() * 2.0)));
            let ((r, t), (s, v)) = (pose(&mut dice), pose(&mut dice));
            let (a, b) = (Rigid::new(first, r, t).unwrap(), Rigid::new(second, s, v).unwrap());
            let join = Join::new(&a, &b);
            for scale in [1.0, 1e-25, 1e30] {
                let u = down(&(dice.vector() * scale));
                let want = height(&a, &u).max(height(&b, &u));
                let got = height(&join, &u);
                let most = f64::from(join.error() + join.radius() * 1e-6) * up(&u).norm();
                assert!((got - want).abs() <= most, "{k} {scale}: {got} {want} {most}");
                assert!(up(&join.support(&u).unwrap()).norm() <= f64::from(join.extent() + join.error()));
            }
        }
    }

    #[test]
    fn hulls_far_from_their_frame_have_a_center_and_shortcuts_are_told() {
        let far = |x: f64| [[x, 1e6, 0.0], [x + 1.0, 1e6, 0.0], [x, 1e6 + 1.0, 1.0]];
        let (p, q) = (far(1e6), far(1e6 + 4.0));
        let (a, b) = (Points::new(&p).unwrap(), Points::new(&q).unwrap());
        let join = Join::new(&a, &b);
        let (center, reach) = join.center().unwrap();
        for x in p.iter().chain(&q) {
            assert!((Vector::from(*x) - center).norm() <= reach);
        }
        assert!(reach < 10.0 && join.error() < 1e-13);
        assert!(Join::new(&a, Sphere::new(1.0).unwrap()).center().is_none());
    }

    #[test]
    fn symmetry_is_common_symmetry() {
        let at = |z: f64| {
            Rigid::new(Sphere::<f64, 3>::new(1.0).unwrap(), Matrix3::identity(), Vector::from([0.0, 0.0, z])).unwrap()
        };
        let aside = Rigid::new(Sphere::<f64, 3>::new(1.0).unwrap(), Matrix3::identity(), Vector::from([1.0, 0.0, 0.0]))
            .unwrap();
        let cuboid = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap();
        let disc = Cylinder::new(1.0, 0.0).unwrap();
        assert_eq!(Join::new(at(0.0), at(0.0)).symmetry(), Symmetry::Full);
        assert_eq!(Join::new(at(0.0), at(1.0)).symmetry(), Symmetry::Axis);
        assert_eq!(Join::new(disc, at(1.0)).symmetry(), Symmetry::Axis);
        assert_eq!(Join::new(disc, aside).symmetry(), Symmetry::None);
        assert_eq!(Join::new(disc, cuboid).symmetry(), Symmetry::None);
        assert!(Join::new(disc, cuboid).mirrored(7));
    }
}
