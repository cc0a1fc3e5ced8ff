//! The linear program behind contact forces: a wrench as a sum of points of W, with the least total weight.
//!
//! ```text
//! min Σ λ_k    such that    Σ λ_k s_k = w,  λ >= 0        over all points s_k of W
//! ```
//!
//! by the revised simplex method with column generation: six points are the basis, the dual y (y.s_k = 1 for all six) is the next
//! direction, s_W(y) the next point. It differs from [`plan::ray`](crate::plan) in what it does not take for granted: W may be flat or have the
//! origin on its boundary, and w may be out of reach.
//!
//! * **Two phases.** It begins with artificial points on the axes. While they carry weight, that weight is what is minimised (cost 1
//!   for artificial points, 0 for others); y is then a direction that separates w from the cone of the points so far. When
//!   they carry none, they cost nothing. In a flat W some stay for good: those across it.
//! * **An artificial point without weight must not get any.** In the second phase the first pivot is at such a point, if the new
//!   point has a coordinate there, of either sign.
//! * **Ties** are the rule in symmetric grasps, and with them a simplex method may go in circles. They are broken as if w were moved a
//!   little towards a generic point of the first basis' cone (lexicographic rule, Dantzig 1955), whose coordinates are carried along.

use crate::math::Vector;
use crate::plan::basis::Basis;
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;

/// A coordinate that is no larger than this many roundoffs of what it is made of is rounding.
const NOISE: usize = 32;

/// Artificial weight up to this many roundoffs of all weights is rounding, of the target, too: it need not lie in a flat W exactly.
const SLACK: usize = 1024;

/// Exchanges between two polishes of the inverse.
const POLISH: u32 = 8;

/// A target, six points, and the weights that make the target of them.
#[derive(Clone)]
pub(super) struct LinearProgram<T> {
    target: Vector<T, 6>,
    basis: Basis<T, 6>,
    weights: Vector<T, 6>,
    /// The coordinates of the generic point that breaks ties.
    ties: Vector<T, 6>,
    /// How far the points may be off, coordinate by coordinate.
    errors: Vector<T, 6>,
    /// Exchanges since the last polish.
    worn: u32,
}

impl<T: Real> LinearProgram<T> {
    /// Artificial points on the axes, at distance 1, on the side of the target. Points of W should be of that size, and are off by
    /// `errors` at most.
    pub fn new(target: &Vector<T, 6>, errors: &Vector<T, 6>) -> Self {
        let along = target.map(|x| if x < T::zero() { -T::one() } else { T::one() });
        let ties = Vector::from_fn(|i, _| T::one() / T::of(i as f64 + 1.618));
        Self {
            target: *target,
            basis: Basis::new(&along),
            weights: target.map(|x| x.abs()),
            ties,
            errors: *errors,
            worn: 0,
        }
    }

    /// What the weights make of the points.
    pub fn target(&self) -> &Vector<T, 6> {
        &self.target
    }

    /// Do artificial points carry weight, beyond rounding?
    pub fn is_short(&self) -> bool {
        self.total(|artificial| artificial) > self.slack()
    }

    fn slack(&self) -> T {
        let all = self.target.iter().fold(self.total(|_| true), |s, x| s + x.abs());
        all * (T::count(SLACK) * T::ROUNDOFF)
    }

    /// The total weight of the points of W.
    pub fn size(&self) -> T {
        self.total(|artificial| !artificial)
    }

    fn total(&self, counts: impl Fn(bool) -> bool) -> T {
        let mut sum = T::zero();
        for i in 0..6 {
            if counts(self.basis.artificial[i]) {
                sum += self.weights[i];
            }
        }
        sum
    }

    /// What a point of W costs in this phase.
    pub fn cost(&self) -> T {
        if self.is_short() { T::zero() } else { T::one() }
    }

    /// The dual of this phase: a point with y.s above its cost improves the weights.
    pub fn dual(&self) -> Vector<T, 6> {
        let cost = self.cost();
        self.basis.plane(&Vector::from(self.basis.artificial.map(|a| if a { T::one() - cost } else { cost })))
    }

    /// y.w.
    pub fn value(&self, y: &Vector<T, 6>) -> T {
        y.dot(&self.target)
    }

    /// How far y.s_k is off the costs, at most: what rounding has left of `dual`, y.
    pub fn miss(&self, y: &Vector<T, 6>) -> T {
        let cost = self.cost();
        let off = |vertex: &Vertex<T, 6>, c: T| (y.dot(&vertex.point) - c).abs();
        let points = self.basis.points.iter().zip(&self.basis.artificial);
        points.fold(T::zero(), |m, (v, &a)| m.at_least(off(v, if a { T::one() - cost } else { cost })))
    }

    /// Is the inverse as good as it gets?
    pub fn is_fresh(&self) -> bool {
        self.worn == 0
    }

    /// Do the weights still make the target of the points, to a share `tolerance`? Not when the points have become almost dependent.
    pub fn holds(&self, tolerance: T) -> bool {
        let one_norm = |v: &Vector<T, 6>| v.iter().fold(T::zero(), |s, x| s + x.abs());
        let miss = one_norm(&(self.target - self.basis.point(&self.weights)));
        miss + one_norm(&self.weights) * T::ROUNDOFF <= one_norm(&self.target) * tolerance
    }

    /// Takes points for less exact than before: what is across a flat W is then told from rounding with more caution.
    pub fn doubt(&mut self) {
        let rounding = T::count(NOISE) * T::ROUNDOFF;
        self.errors = self.errors.map(|e| e.at_least(rounding) * T::count(64));
    }

    /// Puts a point into the basis; false when rounding leaves it no place.
    pub fn enter(&mut self, vertex: &Vertex<T, 6>) -> bool {
        let point = &vertex.point;
        let coordinates = self.basis.coordinates(point);
        // A row of the inverse is off in proportion to its size, which counts with the coordinates of the point and of all others. What
        // is across a flat W is the error of its points besides.
        let all = T::count(2) + coordinates.iter().fold(T::zero(), |s, x| s + x.abs());
        let rounding = T::count(NOISE) * T::ROUNDOFF;
        let slack = self.slack();
        let coordinates = Vector::from_fn(|i, _| {
            let idle = self.basis.artificial[i] && self.weights[i] <= slack;
            let own = |j: usize| if idle { self.errors[j].at_least(rounding) } else { rounding };
            let noise = (0..6).fold(T::zero(), |s, j| s + self.basis.inverse[(i, j)].abs() * own(j));
            if coordinates[i].abs() > noise * all { coordinates[i] } else { T::zero() }
        });
        let Some(out) = self.idle(&coordinates).or_else(|| self.first(&coordinates)) else { return false };
        let ratio = |of: &Vector<T, 6>| (0..6).find(|&i| i == out).map_or(T::zero(), |i| of[i] / coordinates[i]);
        let (step, shift) = (ratio(&self.weights).at_least(T::zero()), ratio(&self.ties));
        self.basis.exchange(out, vertex, &coordinates);
        for i in 0..6 {
            if i == out {
                (self.weights[i], self.ties[i]) = (step, shift);
            } else {
                self.weights[i] = (self.weights[i] - coordinates[i] * step).at_least(T::zero());
                self.ties[i] -= coordinates[i] * shift;
            }
        }
        self.worn += 1;
        if self.worn >= POLISH {
            self.polish();
        }
        true
    }

    /// In the second phase: the artificial point at which the new one has the largest coordinate.
    fn idle(&self, coordinates: &Vector<T, 6>) -> Option<usize> {
        let mut found = None;
        let mut pivot = T::zero();
        if !self.is_short() {
            for i in 0..6 {
                if self.basis.artificial[i] && coordinates[i].abs() > pivot {
                    pivot = coordinates[i].abs();
                    found = Some(i);
                }
            }
        }
        found
    }

    /// The point whose weight vanishes first; of those that vanish together, up to rounding, and do not have a far smaller pivot
    /// than others, the one that the generic target would lose first.
    fn first(&self, coordinates: &Vector<T, 6>) -> Option<usize> {
        let blur = self.total(|_| true) * (T::count(16) * T::ROUNDOFF);
        let mut step = T::HUGE;
        for i in 0..6 {
            if coordinates[i] > T::zero() {
                step = step.at_most((self.weights[i] + blur) / coordinates[i]);
            }
        }
        let vanishes = |i: usize| coordinates[i] > T::zero() && self.weights[i] <= step * coordinates[i];
        let mut largest = T::zero();
        for i in 0..6 {
            if vanishes(i) {
                largest = largest.at_least(coordinates[i]);
            }
        }
        let mut found = None;
        let mut least = T::HUGE;
        for i in 0..6 {
            if vanishes(i) && coordinates[i] >= largest * T::of(1e-3) {
                let tie = self.ties[i] / coordinates[i];
                if found.is_none() || tie < least {
                    least = tie;
                    found = Some(i);
                }
            }
        }
        found
    }

    /// Makes the inverse and the weights as good as rounding allows.
    pub fn polish(&mut self) {
        self.worn = 0;
        self.basis.rebuild();
        let weights = self.basis.coordinates(&self.target);
        let miss = self.target - self.basis.point(&weights);
        self.weights = (weights + self.basis.coordinates(&miss)).map(|w| w.at_least(T::zero()));
    }

    /// The points of W in the basis, and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (&Vertex<T, 6>, T)> {
        let real = |(_, artificial): &(_, &bool)| !**artificial;
        let parts = self.basis.points.iter().zip(self.weights.iter()).zip(&self.basis.artificial);
        parts.filter(real).map(|((vertex, &weight), _)| (vertex, weight))
    }
}
