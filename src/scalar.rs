//! The scalar: `f32` or `f64`, with every square root and every tolerance in one place.
//!
//! The rest of the crate is generic over [`Real`]. What depends on the machine (the square root
//! instruction) and what depends on the format (the unit roundoff and the tolerances made from it) is
//! written here and nowhere else.

use nalgebra::{RealField, SVector};

/// A vector of dimension `N`.
pub type Vector<T, const N: usize> = SVector<T, N>;

/// A floating-point scalar: `f32` or `f64`.
pub trait Real: RealField + Copy {
    /// Unit roundoff u: half the distance between 1 and the next number. Every elementary operation,
    /// the square root included, has relative error at most u.
    const ROUNDOFF: Self;
    /// The largest finite number: stands for "unbounded" where no arithmetic follows.
    const HUGE: Self;
    /// The smallest normal number.
    const TINY: Self;
    /// A sum of squares above this has lost nothing that counts to underflow: the smallest normal number / u^2.
    const SAFE_SQUARE: Self;
    /// The default relative tolerance of a query: 1e-6 in `f64`, 1e-4 in `f32`.
    const RELATIVE_TOLERANCE: Self;

    /// 2^ceil(p/2) + 1 for p bits of mantissa: Veltkamp's constant, which splits a number in two halves whose products are
    /// exact.
    const SPLIT: Self;

    /// Correctly rounded square root; the argument must not be negative.
    fn root(self) -> Self;
    /// Nearest `f64`, for reports and constants.
    fn to_f64(self) -> f64;
    /// Nearest value of this type to a constant.
    fn of(value: f64) -> Self;
    /// A small count as a scalar, without a detour over `f64`.
    fn count(n: usize) -> Self;
    /// Rounded towards 0; the nearest integer that there is for what is out of range, 0 for NaN.
    fn to_integer(self) -> i64;
    /// Neither infinite nor NaN.
    fn finite(self) -> bool;
    /// The power of two with the same exponent, for a normal number > 0.
    fn power_of_two(self) -> Self;
    /// `self` if it is larger or `other` is not a number (unlike `RealField::max`, never a call).
    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    /// `self` if it is smaller or `other` is not a number.
    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
}

macro_rules! real {
    ($t:ident, $sqrt:path, $tolerance:expr, $split:expr, $exponent:expr) => {
        impl Real for $t {
            const ROUNDOFF: Self = $t::EPSILON / 2.0;
            const HUGE: Self = $t::MAX;
            const TINY: Self = $t::MIN_POSITIVE;
            const SAFE_SQUARE: Self = $t::MIN_POSITIVE / (Self::ROUNDOFF * Self::ROUNDOFF);
            const RELATIVE_TOLERANCE: Self = $tolerance;
            const SPLIT: Self = $split;

            #[inline(always)]
            fn root(self) -> Self {
                #[cfg(any(test, feature = "std"))]
                return self.sqrt();
                #[cfg(not(any(test, feature = "std")))]
                return $sqrt(self);
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn count(n: usize) -> Self {
                n as u32 as $t
            }
            #[inline(always)]
            fn to_integer(self) -> i64 {
                self as i64
            }
            #[inline(always)]
            fn finite(self) -> bool {
                self.is_finite()
            }
            #[inline]
            fn power_of_two(self) -> Self {
                $t::from_bits(self.to_bits() & $exponent)
            }
        }
    };
}

real!(f32, libm::sqrtf, 1e-4, 4097.0, 0x7F80_0000);
real!(f64, libm::sqrt, 1e-6, 134_217_729.0, 0x7FF0_0000_0000_0000);

/// Euclidean norm, also where squares under- or overflow.
#[inline(always)]
pub fn norm<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    let squared = v.dot(v);
    if squared > T::SAFE_SQUARE && squared <= T::HUGE { squared.root() } else { far_norm(v) }
}

/// v / |v| for v not zero, also where squares under- or overflow.
#[inline]
pub(crate) fn unit<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    let squared = v.dot(v);
    if squared > T::SAFE_SQUARE && squared <= T::HUGE {
        return v * (T::one() / squared.root());
    }
    let largest = v.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
    let scaled = v.map(|x| x / largest);
    scaled * (T::one() / scaled.dot(&scaled).root())
}

#[cold]
#[inline(never)]
fn far_norm<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    let largest = v.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
    if !(largest > T::zero()) {
        return T::zero();
    }
    let scaled = v.map(|x| x / largest);
    largest * scaled.dot(&scaled).root()
}

/// Are all coordinates finite?
#[inline]
pub fn finite<T: Real, const N: usize>(v: &Vector<T, N>) -> bool {
    v.iter().all(|x| x.finite())
}

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
        let halves = |x: T| {
            let c = T::SPLIT * x;
            let high = c - (c - x);
            (high, x - high)
        };
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
