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
//! If they do not, the origin is on the boundary of A, or near it, and the ray may leave A at once. That is decided by a linear program of its own, the
//! first phase of the simplex method: from the same corners, the weight of the artificial ones is what is minimised. Either it
//! vanishes, and the ray goes on without them; or y.x = 0 separates: A is below that plane, up to rounding, and q above.
//! (An artificial corner without weight must not get any: the next point that has a coordinate there, of either sign, replaces it.)
//!
//! # Rounding
//!
//! The inverse is updated, and its error is not bounded; it does not need to be. The weights >= 0 stand for a point
//! x = Σ w a / Σ w of A, whatever they are, and t q is off x by what is measured ([`Ray::reach`]).

use super::basis::Basis;
use crate::math::{Vector, norm};
use crate::polytope::simplex::{Corner, Simplex, Vertex};
use crate::scalar::Real;
use heapless::Vec;

/// What is minimised.
#[derive(Clone, Copy, PartialEq)]
enum Phase {
    /// All weights: artificial corners are points like others.
    Near,
    /// The weights of artificial corners: is the target in the cone over A?
    Reaching,
    /// The weights of the others; artificial ones have none.
    Within,
}

/// A ray and the simplex that it pierces.
#[derive(Clone)]
pub(crate) struct Ray<T, const N: usize> {
    /// Where the ray begins; all points are seen from there.
    pub from: Vector<T, N>,
    /// Is the target a point of Q?
    pub measures: bool,
    target: Vector<T, N>,
    basis: Basis<T, N>,
    /// The target's coordinates in the basis, >= 0.
    weights: Vector<T, N>,
    phase: Phase,
}

impl<T: Real, const N: usize> Ray<T, N> {
    /// A ray along `target` from artificial corners at the distance `size` > 0.
    pub fn new(target: &Vector<T, N>, size: T) -> Self {
        let along = target.map(|x| if x < T::zero() { -size } else { size });
        let weights = target.map(|x| x.abs() / size);
        let basis = Basis::new(&along);
        Ray { from: Vector::zeros(), measures: true, target: *target, basis, weights, phase: Phase::Near }
    }

    /// The same from another point of A, for another purpose.
    pub fn begin(from: &Vector<T, N>, target: &Vector<T, N>, size: T) -> Self {
        Ray { from: *from, measures: false, ..Self::new(target, size) }
    }

    /// What h_Q is at least along a direction; the largest number where Q need not be asked.
    pub fn floor(&self, direction: &Vector<T, N>) -> T {
        if self.measures { direction.dot(&self.target) } else { T::HUGE }
    }

    /// The ray along another target, if that pierces the same simplex.
    pub fn aimed(mut self, target: &Vector<T, N>) -> Option<Self> {
        self.target = *target;
        self.weights = self.basis.coordinates(target);
        let idle = |i: usize| self.phase == Phase::Near || !self.basis.artificial[i];
        (0..N).all(|i| self.weights[i] >= T::zero() && idle(i)).then_some(self)
    }

    /// Goes over to the program that decides whether the ray leaves A at once.
    pub fn reach_out(&mut self) {
        self.phase = Phase::Reaching;
    }

    /// Is that still undecided?
    pub fn is_reaching(&self) -> bool {
        self.phase == Phase::Reaching
    }

    /// The plane y.x = 1 through the corners; while the ray is reaching, y.x = 0 through those that are points of A.
    pub fn plane(&self) -> Vector<T, N> {
        let cost = |artificial: bool| match self.phase {
            Phase::Near => true,
            Phase::Reaching => artificial,
            Phase::Within => !artificial,
        };
        self.basis.plane(&Vector::from(self.basis.artificial.map(|a| if cost(a) { T::one() } else { T::zero() })))
    }

    /// Puts a point beyond the plane in the place of the corner that the ray demands; false when rounding leaves none. With `patience` a ray that is
    /// reaching, which has nothing to show yet, takes a small pivot rather than none.
    pub fn enter(&mut self, vertex: &Vertex<T, N>, patience: bool) -> bool {
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
        if let Some((idle, share)) = self.idle(&shares, threshold) {
            (leaving, pivot) = (Some((idle, T::zero())), share.abs());
        }
        let Some((out, step)) = leaving else { return false };
        let wears = pivot < largest * T::ROUNDOFF.root();
        if wears && !(patience && self.is_reaching()) {
            return false; // The new corner is one of the old ones, as far as arithmetic can tell.
        }
        self.basis.exchange(out, vertex, &shares);
        for i in 0..N {
            let left = (self.weights[i] - shares[i] * step).at_least(T::zero());
            self.weights[i] = if i == out { step } else { left };
        }
        if wears {
            self.polish();
        }
        self.arrive(T::count(64 * N) * T::ROUNDOFF);
        true
    }

    /// The artificial corner without weight at which a point has the largest coordinate.
    fn idle(&self, shares: &Vector<T, N>, threshold: T) -> Option<(usize, T)> {
        let mut found: Option<(usize, T)> = None;
        for i in 0..N {
            let most = found.map_or(threshold, |(_, share)| share.abs());
            if self.phase == Phase::Within && self.basis.artificial[i] && shares[i].abs() > most {
                found = Some((i, shares[i]));
            }
        }
        found
    }

    /// While the ray is reaching: is what artificial corners carry of the target no more than this share of it? Then they carry nothing from now on.
    pub fn arrive(&mut self, share: T) -> bool {
        let carried = (0..N).filter(|&i| self.basis.artificial[i]);
        let left = carried.fold(Vector::<T, N>::zeros(), |sum, i| sum + self.basis.points[i].point * self.weights[i]);
        let arrives = self.phase == Phase::Reaching && norm(&left) <= norm(&self.target) * share;
        if arrives {
            self.phase = Phase::Within;
            self.lay_down();
        }
        arrives
    }

    /// Artificial corners within the cone over A have no weight.
    fn lay_down(&mut self) {
        for i in 0..N {
            if self.phase == Phase::Within && self.basis.artificial[i] {
                self.weights[i] = T::zero();
            }
        }
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
        self.lay_down();
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
