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
    /// R^T x.
    pub(crate) fn turned_back(&self, rotation: &nalgebra::SMatrix<T, N, N>) -> Self {
        let mut turned = Self::from(Vector::zeros());
        for j in 0..N {
            let mut sum = Accumulator::new(T::zero());
            for i in 0..N {
                sum.add_product(self.high[i], rotation[(i, j)]);
                sum.add_product(self.low[i], rotation[(i, j)]);
            }
            (turned.high[j], turned.low[j]) = sum.parts();
        }
        turned
    }

    /// x.p, without the last rounding.
    pub(crate) fn dot(&self, p: &Vector<T, N>) -> Accumulator<T> {
        let mut sum = Accumulator::new(T::zero());
        for i in 0..N {
            sum.add_product(self.high[i], p[i]);
            sum.add_product(self.low[i], p[i]);
        }
        sum
    }
}
