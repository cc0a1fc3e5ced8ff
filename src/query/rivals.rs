//! Directions far from the best one that bound d as tightly: signs that the minimiser is not unique.

use super::Query;
use crate::math::Vector;
use crate::scalar::Real;

/// Directions farther apart than this cosine (8 degrees) are not two guesses at the same minimiser.
const RIVAL_COSINE: f64 = 0.99;

/// What was met of them.
pub(crate) struct Rivals<T, const N: usize> {
    /// Are they of interest?
    pub sought: bool,
    /// A direction far from the best that bounds d about as well, and its quotient.
    pub(super) met: Option<(Vector<T, N>, T)>,
    /// About as well: with a quotient up to this.
    pub(super) bar: T,
}

impl<T: Real, const N: usize> Rivals<T, N> {
    /// None was met.
    pub(super) fn none() -> Self {
        Rivals { sought: true, met: None, bar: -T::HUGE }
    }
}

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// Keeps a direction that bounds d about as well as the best, well away from that.
    #[inline]
    pub(super) fn meet(&mut self, direction: &Vector<T, N>, ratio: T, best: &Vector<T, N>) {
        if self.ties(ratio) && self.is_far(direction, best) {
            self.rivals.met = Some((*direction, ratio));
        }
    }

    /// Does a quotient tie with the best, up to the tolerance?
    pub fn ties(&self, ratio: T) -> bool {
        ratio <= self.rivals.bar
    }

    /// Are two directions no two guesses at the same minimiser?
    pub fn is_far(&self, u: &Vector<T, N>, v: &Vector<T, N>) -> bool {
        u.dot(v) < T::of(RIVAL_COSINE)
    }

    /// The best direction, where rivals are sought and none is known.
    pub fn lonely(&self) -> Option<Vector<T, N>> {
        (self.rivals.sought && self.rival().is_none()).then_some(self.best.direction)
    }

    /// A direction well away from the best one that bounds d as tightly, up to the tolerance.
    pub(super) fn rival(&self) -> Option<Vector<T, N>> {
        let (direction, ratio) = self.rivals.met?;
        (self.is_far(&direction, &self.best.direction) && self.ties(ratio)).then_some(direction)
    }
}
