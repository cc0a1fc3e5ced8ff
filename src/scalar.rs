//! The scalar: `f32` or `f64`, with every square root and every tolerance in one place.
//!
//! The rest of the crate is generic over [`Real`]. What depends on the machine (the square root
//! instruction) and what depends on the format (the unit roundoff and the tolerances made from it) is
//! written here and nowhere else.

use nalgebra::RealField;

/// Bounds are proved for the arithmetic of these two types, and hold for no other.
mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A floating-point scalar: `f32` or `f64`. No other type can be one.
pub trait Real: RealField + Copy + sealed::Sealed {
    /// 0, where memory is made before the program runs.
    const ZERO: Self;
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
    /// The number rounded to the upper half of its bits (f32: 12 of 24, f64: 26 of 53), to nearest whatever the rounding mode: what that leaves has no more, and
    /// products of halves are exact.
    fn upper_half(self) -> Self;
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
    ($t:ident, $sqrt:path, $tolerance:expr, $half:expr, $exponent:expr) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            const ROUNDOFF: Self = $t::EPSILON / 2.0;
            const HUGE: Self = $t::MAX;
            const TINY: Self = $t::MIN_POSITIVE;
            const SAFE_SQUARE: Self = $t::MIN_POSITIVE / (Self::ROUNDOFF * Self::ROUNDOFF);
            const RELATIVE_TOLERANCE: Self = $tolerance;

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
            #[inline(always)]
            fn upper_half(self) -> Self {
                // (A carry into the exponent is what rounding does. Infinite is what rounds to it; NaN stays so, or becomes infinite.)
                $t::from_bits(self.to_bits().wrapping_add($half) & !(2 * $half - 1))
            }
        }
    };
}

/// Square roots without the standard library. libm's are made of integers, but for the processors that it knows.
#[cfg(not(any(test, feature = "std")))]
mod root {
    // A function with a body of one instruction, since the compiler has no name for it here: hard-float Cortex-M4F, M7 and their like pass the argument in s0.
    #[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
    #[unsafe(naked)]
    pub extern "C" fn single(x: f32) -> f32 {
        core::arch::naked_asm!(".fpu fpv4-sp-d16", "vsqrt.f32 s0, s0", "bx lr")
    }
    #[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
    pub use libm::sqrtf as single;

    // (`vfp2`, a compiler's name for the double-precision unit that Cortex-M7 may have.)
    #[cfg(all(target_arch = "arm", target_abi = "eabihf", target_feature = "vfp2"))]
    #[unsafe(naked)]
    pub extern "C" fn double(x: f64) -> f64 {
        core::arch::naked_asm!(".fpu fpv5-d16", "vsqrt.f64 d0, d0", "bx lr")
    }
    #[cfg(not(all(target_arch = "arm", target_abi = "eabihf", target_feature = "vfp2")))]
    pub use libm::sqrt as double;
}

real!(f32, root::single, 1e-4, 0x800, 0x7F80_0000);
real!(f64, root::double, 1e-6, 0x400_0000, 0x7FF0_0000_0000_0000);
