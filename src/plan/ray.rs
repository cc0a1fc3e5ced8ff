//! Ray shooting: how far along q until the ray leaves A.
//!
//! The ray from the origin along q leaves A at t q, t = max { t : t q in A }. With the origin in A that is the linear program
//!
//! ```text
//! 1 / t = min Σ w_i    such that    Σ w_i a_i = q,  w >= 0,  a_i in A
//! ```
//!
//! over all points of A, solved by column generation, the revised simplex method with N points and the inverse of
//! their matrix: the plane y.x = 1 through the N corners is crossed by the ray at 1 / Σ w, the support point along y is beyond
//! it (or the crossing is final), and replaces the corner that the ratio test names. In the picture: of the polytope
//! expansion only the facet that the ray pierces is kept. No hull, N^2 numbers, and every step raises the crossing (lower bound) and gives a
//! plane (upper bound, h_A(y) / y.q).
//!
//! The first corners are *artificial*: points at a tiny distance along the axes, in the orthant of q. If the ball of that
//! radius is in A they all leave; while one carries weight there is no lower bound.
//!
//! # Rounding
//!
//! The inverse is updated, and its error is not bounded; it does not need to be. The weights >= 0 stand for a point
//! x = Σ w a / Σ w of A, whatever they are, and t q is off x by what is measured ([`Ray::reach`]).

use super::basis::Basis;
use crate::scalar::{Real, Vector, norm};
use crate::simplex::{Corner, Simplex, Vertex};
use heapless::Vec;

/// A ray and the simplex that it pierces.
#[derive(Clone)]
pub(crate) struct Ray<T, const N: usize> {
    target: Vector<T, N>,
    basis: Basis<T, N>,
    /// The target's coordinates in the basis, >= 0.
    weights: Vector<T, N>,
}

impl<T: Real, const N: usize> Ray<T, N> {
    /// A ray along `target` from artificial corners at the distance `size` > 0.
    pub fn new(target: &Vector<T, N>, size: T) -> Self {
        let along = target.map(|x| if x < T::zero() { -size } else { size });
        Ray { target: *target, basis: Basis::new(&along), weights: target.map(|x| x.abs() / size) }
    }

    /// The ray along another target, if that pierces the same simplex.
    pub fn aimed(mut self, target: &Vector<T, N>) -> Option<Self> {
        self.target = *target;
        self.weights = self.basis.coordinates(target);
        self.weights.iter().all(|&w| w >= T::zero()).then_some(self)
    }

    /// The plane y.x = 1 through the corners.
    pub fn plane(&self) -> Vector<T, N> {
        self.basis.plane(&Vector::repeat(T::one()))
    }

    /// Puts a point beyond the plane in the place of the corner that the ray demands; false when rounding leaves none.
    pub fn enter(&mut self, vertex: &Vertex<T, N>) -> bool {
        let shares = self.basis.coordinates(&vertex.point);
        // The first weight to vanish decides (Harris' ratio test: of those that vanish together, up to rounding, the one with
        // the largest pivot).
        let sum = self.weights.iter().fold(T::zero(), |sum, &w| sum + w);
        let blur = sum * (T::count(16) * T::ROUNDOFF);
        let largest = shares.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
        let threshold = largest * (T::count(16 * N) * T::ROUNDOFF);
        let mut first = T::HUGE;
        for i in 0..N {
            if shares[i] > threshold {
                first = first.at_most((self.weights[i] + blur) / shares[i]);
            }
        }
        let mut leaving: Option<(usize, T)> = None;
        let mut pivot = threshold;
        for i in 0..N {
            if shares[i] > pivot && self.weights[i] <= first * shares[i] {
                pivot = shares[i];
                leaving = Some((i, self.weights[i] / pivot));
            }
        }
        let Some((out, step)) = leaving else { return false };
        if pivot < largest * T::ROUNDOFF.root() {
            return false; // The new corner is one of the old ones, as far as arithmetic can tell.
        }
        self.basis.exchange(out, vertex, &shares);
        for i in 0..N {
            let left = (self.weights[i] - shares[i] * step).at_least(T::zero());
            self.weights[i] = if i == out { step } else { left };
        }
        true
    }

    /// (t, e): t q is at most e off a point of conv A, up to the rounding of one sum. `None` while an artificial corner
    /// carries weight.
    pub fn reach(&self) -> Option<(T, T)> {
        let carried = (0..N).all(|i| !self.basis.artificial[i] || self.weights[i] == T::zero());
        let sum = self.weights.iter().fold(T::zero(), |sum, &w| sum + w);
        if !carried || !(sum > T::zero()) {
            return None;
        }
        let t = T::one() / sum;
        let miss = self.basis.point(&(self.weights * t)) - self.target * t;
        Some((t, norm(&miss)))
    }

    /// Polishes the inverse, after which the weights are as good as rounding allows.
    pub fn polish(&mut self) {
        self.basis.polish();
        self.weights = self.basis.coordinates(&self.target).map(|w| w.at_least(T::zero()));
    }

    /// The pierced simplex; its weights are those of the crossing.
    pub fn simplex(&self) -> Simplex<T, N> {
        let sum = self.weights.iter().fold(T::zero(), |sum, &w| sum + w);
        let mut corners = Vec::new();
        for i in 0..N {
            if !self.basis.artificial[i] {
                let _ = corners.push(Corner { vertex: self.basis.points[i], weight: self.weights[i] / sum });
            }
        }
        Simplex { corners }
    }
}
