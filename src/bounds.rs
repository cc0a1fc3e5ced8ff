//! The bracket: what certifies the lower bound, what certifies the upper, and the rounding of both.
//!
//! Everything below is for unit roundoff u, dimension N and R = the largest norm of a computed point.
//!
//! # Upper
//!
//! Proposition 1 holds for every single direction, so one support value is a proof. For a computed unit normal n and
//! computed support point p the promise of [`Support`](crate::support::Support) gives
//! h(n) <= (n.p + e)/|n|, and the dot product and the norm of n are off by at most (2N + 4) u R together. Hence
//!
//! ```text
//! d_Q(A) <= (h + m + r) / h_Q(n),      h = fl(n.p),   m = e + (2N + 4) u R
//! ```
//!
//! # Lower
//!
//! Let F be a facet and n *any* unit vector. Every point x of F is a convex combination of the facet's vertices, so
//! n.x >= min n.v =: e_F. If λ h_Q(n) < e_F then λQ does not meet F. When that holds for all facets, λQ
//! misses a closed surface that winds around the origin; Q is star-shaped, so λQ stays inside it, and what a closed
//! surface with vertices in V winds around lies in conv V. So
//!
//! ```text
//! d_Q(conv V) >= min over F of e_F / h_Q(n_F)
//! ```
//!
//! and neither the accuracy of n_F nor the convexity of the surface is used: a bad normal or a wrong visibility decision makes
//! the bound loose, not false. (Equality holds when n_F is exact, eq. 23.)
//!
//! Rounding: the computed e_F is off by at most (2N + 4) u R, and the vertices are off A by at most e; together m. If
//! λ h_Q(n_F) + m < e_F for all F, then λQ + mB, convex and around the origin, lies inside the true surface, so
//! h_V(u) >= λ h_Q(u) + e |u| and h_A(u) >= h_V(u) - e |u| >= λ h_Q(u). Hence, provided that all e_F > m,
//!
//! ```text
//! d_Q(A) >= min over F of (e_F - m) / h_Q(n_F)
//! ```
//!
//! # By direction
//!
//! m is that of the worst direction. With |p_i| <= R_i over the points of A, and errors e_i coordinate by coordinate, a height along n is off by no more
//! than
//!
//! ```text
//! m(n) = sum over i of |n_i| (e_i + (2N + 4) u R_i)
//! ```
//!
//! which for a floor of a kilometre, along its normal, is a millionth of m. The upper bound needs nothing new. For the lower, let v' be the
//! points of A behind the computed vertices v, and move each v straight to its v'. Every point x of a facet F keeps n_F.x >= e_F - m(n_F) > 0
//! meanwhile, so no facet crosses the origin, and the surface of the v' winds around it as that of the v did. λQ misses it
//! when λ h_Q(n_F) < e_F - m(n_F) for all F, and
//!
//! ```text
//! d_Q(A) >= min over F of (e_F - m(n_F)) / h_Q(n_F)
//! ```
//!
//! It costs a pass over the facets, and is asked for where m has left the answer open (module `second_look`).
//!
//! # Around the origin
//!
//! That the surface winds around the origin is not taken for granted: slivers can fold over. Let c be the centroid of the first
//! simplex as it was computed, and let every facet F ever made satisfy n.c < e_F by more than (3N + 8) u R, the
//! rounding of c, of both products and of the length of n.
//!
//! 1. The exact centroid lies inside the first simplex, and the segment from it to c is shorter than the distance of c from any
//!    facet: c lies inside too, and the surface winds around it once.
//! 2. A point p is inserted over facets F with n.p > e_F as computed. The rounding of n.p is like that of the heights that e_F was found from, and c is beneath
//!    F by more, so c is not in conv(F, p): replacing F by the cone of p does not change the winding around c. (That p is asked to be higher
//!    by more than rounding spares slivers; the proof does not need it.)
//! 3. At the end all e_F > m, so the segment from c to the origin lies beneath every facet and crosses none:
//!    the surface winds around the origin once as well.
//!
//! Where this cannot be shown (the origin is outside or on the boundary, or the set is too thin for the arithmetic at hand), the lower bound
//! is minus the norm of the point of conv V nearest to the origin.
//!
//! The error of h_Q itself is added to the quotient where it is made (`Query::key`, `Query::upper`). Plans that leave no such surface derive their lower bounds in
//! their own files, from the same margins: `plan::conewise`, `plan::rays`, `solver::depth::{meridian, sectors, ellipsoids, half_space, fine}`, `solver::warm`.
//!
//! A ball term r of A is added to both sides (Euclidean Q only; there h(core + rB) = h(core) + r |n|).

use crate::math::Vector;
use crate::scalar::Real;

/// A bracket of d_Q(A), in units of Q; negative values are minus a Euclidean distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bracket<T> {
    /// d is not less.
    pub lower: T,
    /// d is not more.
    pub upper: T,
}

impl<T: Real> Bracket<T> {
    /// In another unit.
    pub(crate) fn scaled(self, scale: T) -> Self {
        Bracket { lower: self.lower * scale, upper: self.upper * scale }
    }
}

/// When a bracket is narrow enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance<T> {
    /// Width, in units of Q.
    pub absolute: T,
    /// Width as a share of the smaller end's size.
    pub relative: T,
}

impl<T: Real> Tolerance<T> {
    /// Is the bracket narrow enough?
    #[inline]
    pub fn met(&self, b: &Bracket<T>) -> bool {
        b.upper - b.lower <= self.absolute.at_least(self.relative * b.upper.abs().at_most(b.lower.abs()))
    }
}

impl<T: Real> Tolerance<T> {
    /// What is not told from a value: up to so much above it.
    pub(crate) fn above(&self, value: T) -> T {
        value + self.absolute.at_least(self.relative * value.abs())
    }

    /// The lowest lower end that meets the tolerance with this upper end > 0.
    pub(crate) fn below(&self, upper: T) -> T {
        (upper - self.absolute).at_most(upper / (T::one() + self.relative))
    }
}

/// Turns lengths measured on the core of A into bounds on d_Q(A).
#[derive(Clone, Copy, Debug)]
pub struct Bounds<T> {
    /// Error of the support function, e, in any direction.
    pub support_error: T,
    /// Ball term of A, r (Euclidean Q only).
    pub radius: T,
    /// N, for the rounding of a dot product.
    pub dimension: usize,
    /// A's support function does not know its extent: its error is estimated from R.
    pub unknown_extent: bool,
}

/// What is known of A along each coordinate axis, for margins by direction.
#[derive(Clone, Copy, Debug)]
pub struct Axes<T, const N: usize> {
    /// Errors of the support function, e_i.
    pub errors: Vector<T, N>,
    /// Bounds of |x_i| over the points of A, R_i.
    pub reach: Vector<T, N>,
}

/// Sum of |n_i| x_i.
#[inline]
fn sum_along<T: Real, const N: usize>(n: &Vector<T, N>, x: &Vector<T, N>) -> T {
    n.iter().zip(x.iter()).fold(T::zero(), |sum, (&n, &x)| sum + n.abs() * x)
}

impl<T: Real, const N: usize> Axes<T, N> {
    /// m(n), for a unit vector n.
    pub fn margin(&self, n: &Vector<T, N>) -> T {
        let sum = sum_along(n, &self.errors) + T::count(2 * N + 4) * T::ROUNDOFF * sum_along(n, &self.reach);
        sum + sum * (T::count(2 * N + 4) * T::ROUNDOFF) // The sum itself is rounded.
    }

    /// Lengths below this cannot be told from zero in a plane equation with the unit normal n: the rounding error of n.p, with room for the
    /// error of n itself.
    pub fn resolution(&self, n: &Vector<T, N>) -> T {
        T::count(8 * N) * T::ROUNDOFF * sum_along(n, &self.reach)
    }

    /// Is something known much better along one of the axes than `margin` says?
    pub fn are_uneven(&self, margin: T) -> bool {
        (0..N).any(|i| (self.errors[i] + T::count(2 * N + 4) * T::ROUNDOFF * self.reach[i]) * T::count(4) < margin)
    }
}

impl<T: Real> Bounds<T> {
    /// m: how far a computed height n.p can be from the true one, whatever the direction. `reach` is R.
    #[inline]
    pub fn margin(&self, reach: T) -> T {
        let n = self.dimension;
        let operations = if self.unknown_extent { 18 * n + 4 } else { 2 * n + 4 };
        self.support_error + T::count(operations) * T::ROUNDOFF * reach
    }

    /// A bound rounded away from the bracket, after a division by h_Q.
    #[inline]
    fn outward(value: T, up: bool) -> T {
        // Four roundings lie between the lengths and this value: two sums, the inverse of Q's size and the product with
        // it (or one quotient); one more is this function's own.
        let slack = value.abs() * (T::count(6) * T::ROUNDOFF);
        let moved = if up { value + slack } else { value - slack };
        moved.at_least(-T::HUGE).at_most(T::HUGE)
    }

    /// Upper bound from a support value of the core along a unit normal, for a ball of radius 1 / `per_ball`.
    #[inline]
    pub fn upper_ball(&self, height: T, margin: T, per_ball: T) -> T {
        Self::outward((height + margin + self.radius) * per_ball, true)
    }

    /// Lower bound from the offset of a plane that bounds everything on its far side, for a ball of radius 1 / `per_ball`.
    #[inline]
    pub fn lower_ball(&self, offset: T, margin: T, per_ball: T) -> T {
        Self::outward((offset - margin + self.radius) * per_ball, false)
    }

    /// Upper bound from a support value along a unit normal where a general Q has value `unit` >= 0, itself off by
    /// at most `unit_error`.
    #[inline]
    pub fn upper(&self, height: T, margin: T, unit: T, unit_error: T) -> T {
        let top = height + margin + self.radius;
        let bottom = if top > T::zero() { unit - unit_error } else { unit + unit_error };
        if bottom > T::zero() { Self::outward(top / bottom, true) } else { T::HUGE }
    }
}
