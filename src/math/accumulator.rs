//! Sums and products that carry their rounding along.

use crate::scalar::Real;

/// A sum that carries its rounding error along (Ogita, Rump & Oishi: as accurate as in twice the precision).
#[derive(Clone, Copy)]
pub(crate) struct Accumulator<T> {
    sum: T,
    error: T,
}

impl<T: Real> Accumulator<T> {
    pub fn new(start: T) -> Self {
        Accumulator { sum: start, error: T::zero() }
    }

    /// Adds a number.
    pub fn add(&mut self, x: T) {
        let sum = self.sum + x;
        let virtual_x = sum - self.sum;
        self.error += (self.sum - (sum - virtual_x)) + (x - virtual_x);
        self.sum = sum;
    }

    /// Adds a product. (Never where time counts; inlined into every loop it would be half of a small program.)
    #[inline(never)]
    pub fn add_product(&mut self, a: T, b: T) {
        if a == T::zero() || b == T::zero() {
            return; // Low words and axes often are.
        }
        let halves = |x: T| (x.upper_half(), x - x.upper_half());
        // (Each step below is exact, in every rounding mode: low halves are signed, so that none has a bit more than there is room for.)
        let product = a * b;
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        self.error += a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2);
        self.add(product);
    }

    pub fn value(&self) -> T {
        self.sum + self.error
    }

    /// The difference of two values.
    pub fn minus(mut self, other: &Self) -> T {
        self.add(-other.sum);
        self.sum + (self.error - other.error)
    }

    /// The value, and what its rounding leaves out.
    pub fn parts(&self) -> (T, T) {
        let mut whole = Accumulator::new(self.sum);
        whole.add(self.error);
        (whole.sum, whole.error)
    }
}
