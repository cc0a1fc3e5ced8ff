//! Vectors of twice the precision.

use super::{Accumulator, Vector};
use crate::scalar::Real;

/// A vector in twice the precision: the exact sum of both is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoWords<T, const N: usize> {
    /// The sum, rounded.
    pub high: Vector<T, N>,
    /// What that leaves out.
    pub low: Vector<T, N>,
}

impl<T: Real, const N: usize> From<Vector<T, N>> for TwoWords<T, N> {
    fn from(high: Vector<T, N>) -> Self {
        TwoWords { high, low: Vector::zeros() }
    }
}

impl<T: Real, const N: usize> core::ops::Neg for TwoWords<T, N> {
    type Output = Self;
    fn neg(self) -> Self {
        TwoWords { high: -self.high, low: -self.low }
    }
}

impl<T: Real, const N: usize> TwoWords<T, N> {
    /// Coordinate by coordinate.
    pub(crate) fn of(coordinate: impl Fn(usize) -> Accumulator<T>) -> Self {
        let mut whole = Self::from(Vector::zeros());
        for i in 0..N {
            (whole.high[i], whole.low[i]) = coordinate(i).parts();
        }
        whole
    }

    /// R x.
    pub(crate) fn turned(&self, rotation: &nalgebra::SMatrix<T, N, N>) -> Self {
        self.mapped(|i, j| rotation[(i, j)])
    }

    /// R^T x.
    pub(crate) fn turned_back(&self, rotation: &nalgebra::SMatrix<T, N, N>) -> Self {
        self.mapped(|i, j| rotation[(j, i)])
    }

    /// The image under the matrix with these entries.
    #[inline(always)]
    fn mapped(&self, entry: impl Fn(usize, usize) -> T) -> Self {
        let mut image = Self::from(Vector::zeros());
        for i in 0..N {
            let mut sum = Accumulator::new(T::zero());
            for j in 0..N {
                sum.add_product(self.high[j], entry(i, j));
                sum.add_product(self.low[j], entry(i, j));
            }
            (image.high[i], image.low[i]) = sum.parts();
        }
        image
    }

    /// x.p, without the last rounding.
    pub(crate) fn dot(&self, p: &Self) -> Accumulator<T> {
        let mut sum = Accumulator::new(T::zero());
        for i in 0..N {
            sum.add_product(self.high[i], p.high[i]);
            sum.add_product(self.low[i], p.high[i]);
            sum.add_product(self.high[i], p.low[i]);
            sum.add_product(self.low[i], p.low[i]);
        }
        sum
    }

    /// Coordinate by coordinate: x_i d_i.
    pub(crate) fn times(&self, d: &Vector<T, N>) -> Self {
        let mut product = Self::from(Vector::zeros());
        for i in 0..N {
            let mut sum = Accumulator::new(T::zero());
            sum.add_product(self.high[i], d[i]);
            sum.add_product(self.low[i], d[i]);
            (product.high[i], product.low[i]) = sum.parts();
        }
        product
    }

    /// x + y.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let mut whole = *self;
        for i in 0..N {
            let mut sum = Accumulator::new(self.high[i]);
            for word in [other.high[i], self.low[i], other.low[i]] {
                sum.add(word);
            }
            (whole.high[i], whole.low[i]) = sum.parts();
        }
        whole
    }

    /// |x|, for x neither very small nor very large: its root, rounded, and what that leaves out, to 2^5 u^2 of it.
    pub(crate) fn length(&self) -> (T, T) {
        let mut squared = Accumulator::new(T::zero());
        for i in 0..N {
            squared.add_product(self.high[i], self.high[i]);
            squared.add_product(self.high[i], self.low[i] + self.low[i]);
        }
        let root = squared.value().root();
        squared.add_product(-root, root);
        (root, squared.value() / (root + root))
    }

    /// x / |x|, each coordinate to 2^6 u^2: one step of Newton's method for the root, and one for each quotient. Zero where |x| is next to nothing.
    pub(crate) fn unit(&self) -> Self {
        let largest = self.high.iter().fold(T::zero(), |most, x| most.at_least(x.abs()));
        if !(largest > T::count(4) * T::TINY) {
            return Self::from(Vector::zeros());
        }
        let scale = T::one() / largest.power_of_two();
        let (high, low) = (self.high * scale, self.low * scale);
        let (root, slip) = TwoWords { high, low }.length();
        let mut unit = Self::from(Vector::zeros());
        for i in 0..N {
            let quotient = high[i] / root;
            let mut left = Accumulator::new(high[i]);
            left.add(low[i]);
            left.add_product(-quotient, root);
            left.add_product(-quotient, slip);
            let mut whole = Accumulator::new(quotient);
            whole.add(left.value() / root);
            (unit.high[i], unit.low[i]) = whole.parts();
        }
        unit
    }
}
