//! Heights along a vector in two words, and what they bound.

use crate::math::{Accumulator, TwoWords};
use crate::scalar::Real;

/// Heights along a vector in two words.
pub struct Level<T: Real, const N: usize> {
    pub n: TwoWords<T, N>,
    /// 1 - 1 / |n|
    excess: T,
    /// The ball terms.
    balls: [T; 2],
    /// E
    error: T,
}

impl<T: Real, const N: usize> Level<T, N> {
    /// For a vector that is a unit vector but for rounding.
    #[inline(never)]
    pub fn new(n: TwoWords<T, N>, balls: [T; 2], error: T) -> Self {
        let mut squared = Accumulator::new(-T::one());
        for i in 0..N {
            squared.add_product(n.high[i], n.high[i]);
            squared.add_product(n.high[i], n.low[i] + n.low[i]);
            squared.add_product(n.low[i], n.low[i]);
        }
        let squared = squared.value();
        let length = (T::one() + squared).root();
        Level { n, excess: squared / ((T::one() + length) * length), balls, error }
    }

    /// The distance that a point's height stands for, with the ball terms, and its error, in the bodies' unit.
    #[inline(never)]
    pub fn distance(&self, point: &TwoWords<T, N>) -> (T, T) {
        let mut height = self.n.dot(point);
        let shrink = height.value() * self.excess;
        for term in [-shrink, self.balls[0], self.balls[1]] {
            height.add(term);
        }
        let distance = height.value();
        (distance, self.error + (shrink.abs() + distance.abs()) * (T::count(16) * T::ROUNDOFF))
    }

    /// The least distance that the heights of these points stand for.
    pub fn lower(&self, points: &[TwoWords<T, N>]) -> T {
        points.iter().fold(T::HUGE, |least, point| {
            let (distance, error) = self.distance(point);
            least.at_most(distance - error)
        })
    }

    /// d is not more than this, where no point is farther along n.
    pub fn upper(&self, point: &TwoWords<T, N>) -> T {
        let (distance, error) = self.distance(point);
        distance + error
    }
}
