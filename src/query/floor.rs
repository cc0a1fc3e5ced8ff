//! Lower bounds of d that are known without this query's polytope: from the tick before, from another plan.

use super::Query;
use crate::query::answer::Answer;
use crate::scalar::Real;

/// The best of them, in scaled units.
pub(super) struct Floor<T> {
    /// 0: none that says anything.
    pub lower: T,
    /// The largest norm of a point when that was proved.
    pub reach: T,
}

impl<T: Real> Floor<T> {
    /// Nothing is known.
    pub fn none() -> Self {
        Floor { lower: T::zero(), reach: T::HUGE }
    }
}

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// Tells the query a lower bound of d that holds anyway, in the caller's units. (Positive ones end it earlier.)
    pub fn know(&mut self, lower: T) {
        // The product with a power of two is exact, down to the least normal number: below that it may be rounded upwards.
        let lower = lower * self.scale;
        if lower >= T::TINY && lower < T::HUGE {
            self.raise(lower, T::HUGE);
        }
    }

    /// Goes on from another query of the same set: its lower bound holds, and its points count.
    pub fn resume(&mut self, before: &Answer<T, N>) {
        self.know(before.lower);
        self.limits.iterations = self.limits.iterations.saturating_add(before.iterations);
    }

    /// The same in scaled units, for a bound that was proved when the largest norm of a point was `reach`.
    pub fn raise(&mut self, lower: T, reach: T) {
        if lower > self.floor.lower && self.still_holds(reach) {
            (self.floor.lower, self.floor.reach) = (lower, reach);
        }
    }

    /// Are margins what they were when the largest norm of a point was `reach`? Where A does not know its extent, its error grows with that.
    pub fn still_holds(&self, reach: T) -> bool {
        !self.bounds.unknown_extent || self.reach <= reach
    }
}
