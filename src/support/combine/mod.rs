//! Sets made of sets: moved, mapped, added, subtracted, joined, scaled, grown.
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

use super::range::above;
use super::{Failure, Route, Support, Symmetry};
use crate::math::{TwoWords, Vector};
use crate::scalar::Real;
use crate::solver::depth::half_space::Unbounded;

#[cfg(test)]
mod dice;
mod join;
mod linear;
mod measured;
mod rigid;
mod scaled;
mod sums;

pub use join::Join;
pub use linear::Linear;
pub(crate) use measured::{Measured, is_worth_measuring, measuring_calls};
pub use rigid::Rigid;
pub use scaled::{Margin, Scaled};
pub use sums::{Difference, Sum};

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

/// The sum of two lengths, each of which must be >= 0: a part's negative length must not hide in a sum that is positive. The query that
/// reads the combination's refuses it.
#[inline(always)]
pub(crate) fn total<T: Real>(a: T, b: T) -> T {
    if a >= T::zero() && b >= T::zero() { a + b } else { -T::HUGE }
}

/// What a sum of two radii is off, where it is rounded.
fn rounding_of_radii<T: Real>(a: T, b: T) -> T {
    if a > T::zero() && b > T::zero() { (a + b) * T::ROUNDOFF } else { T::zero() }
}

/// The extent of a combination: `known` if the parts are known.
#[inline(always)]
fn if_known<T: Real>(parts: &[T], known: T) -> T {
    if parts.iter().all(|&e| e > T::zero()) { above(known, 0) } else { T::zero() }
}

/// The error of a sum or difference of two points; the extents are widened by the error of the points.
#[inline]
fn pair_error<T: Real>(errors: T, extents: T) -> T {
    above(total(errors, T::ROUNDOFF * (extents + errors)), 0)
}

/// The same coordinate by coordinate.
fn pair_errors<T: Real, const N: usize>(errors: Vector<T, N>, extents: Vector<T, N>) -> Vector<T, N> {
    errors.zip_map(&extents, pair_error)
}

/// The extents of a combination: `known` if all parts are known.
fn all_if_known<T: Real, const N: usize>(parts: &[T], known: Vector<T, N>) -> Vector<T, N> {
    if parts.iter().all(|&e| e > T::zero()) { known.map(|x| above(x, N)) } else { Vector::zeros() }
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
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
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
    fn unbounded(&self) -> Option<&dyn Unbounded<T, N>> {
        (**self).unbounded()
    }
    fn route(&self) -> Option<Route<T>> {
        (**self).route()
    }
    fn mirrored(&self, signs: u8) -> bool {
        (**self).mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        (**self).contains_origin()
    }
    fn error(&self) -> T {
        (**self).error()
    }
    fn errors(&self) -> Vector<T, N> {
        (**self).errors()
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        (**self).support_in_two_words(u)
    }
    fn extents(&self) -> Vector<T, N> {
        (**self).extents()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::{Ellipsoid, HalfSpace, Join, Points};

    /// All that a set says, but for its size.
    fn said(set: &dyn Support<f64, 3>) -> impl PartialEq + core::fmt::Debug {
        let u = Vector::from([1.0, -2.0, 0.5]);
        let points = (set.support(&u), set.support_with_witness(&u), set.exhaustive(&u));
        let two = set.support_in_two_words(&TwoWords::from(u));
        let lengths = [set.radius(), set.rolling_radius(), set.extent(), set.error()];
        let kinds = (set.has_shortcuts(), set.symmetry(), set.unbounded().is_some(), set.route().is_some());
        let mirrors = ([0, 1, 2, 3, 4, 5, 6, 7].map(|signs| set.mirrored(signs)), set.contains_origin());
        (points, two, lengths, kinds, mirrors, set.center(), [set.errors(), set.extents()])
    }

    #[test]
    fn a_reference_says_what_the_set_says() {
        let ellipsoid = Ellipsoid::new(Vector::from([1.0, 1.0, 2.0])).unwrap();
        let far = [[1e6, 1e6, 0.0], [1e6 + 1.0, 1e6, 0.0], [1e6, 1e6 + 1.0, 1.0]];
        let points = Points::new(&far).unwrap();
        let ground = HalfSpace::new(Vector::from([0.0, 0.0, 1.0]), 1.0).unwrap();
        let difference = Difference::new(ellipsoid, points);
        let sets: [[&dyn Support<f64, 3>; 2]; 5] = [
            [&ellipsoid, &&ellipsoid],
            [&points, &&points],
            [&ground, &&ground],
            [&difference, &&difference],
            [&Join::new(points, points), &&Join::new(points, points)],
        ];
        for [set, reference] in sets {
            assert_eq!(said(set), said(reference));
        }
    }
}
