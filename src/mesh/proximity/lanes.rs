//! Four numbers in single precision that are worked on together: one register where the machine is known to have vectors, an array elsewhere.

use std::ops::{Add, Mul, Sub};

#[cfg(target_arch = "x86_64")]
mod machine {
    use std::arch::x86_64::*;
    pub(super) type Four = __m128;

    #[inline(always)]
    pub fn four(x: f32, y: f32, z: f32, w: f32) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_set_ps(w, z, y, x) }
    }
    #[inline(always)]
    pub fn all(x: f32) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_set1_ps(x) }
    }
    #[inline(always)]
    pub fn add(x: Four, y: Four) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_add_ps(x, y) }
    }
    #[inline(always)]
    pub fn sub(x: Four, y: Four) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_sub_ps(x, y) }
    }
    #[inline(always)]
    pub fn mul(x: Four, y: Four) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_mul_ps(x, y) }
    }
    #[inline(always)]
    pub fn abs(x: Four) -> Four {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_andnot_ps(_mm_set1_ps(-0.0), x) }
    }
    #[inline(always)]
    pub fn positive(x: Four) -> Four {
        // The second where the first is no number.
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_max_ps(x, _mm_setzero_ps()) }
    }
    #[inline(always)]
    pub fn sum(x: Four) -> f32 {
        // SAFETY: every x86-64 has SSE.
        unsafe {
            let pairs = _mm_add_ps(x, _mm_movehl_ps(x, x));
            _mm_cvtss_f32(_mm_add_ss(pairs, _mm_shuffle_ps::<1>(pairs, pairs)))
        }
    }
    #[inline(always)]
    pub fn any_above(x: Four, y: Four) -> bool {
        // SAFETY: every x86-64 has SSE.
        unsafe { _mm_movemask_ps(_mm_cmpgt_ps(x, y)) != 0 }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod machine {
    pub(super) type Four = [f32; 4];

    #[inline(always)]
    fn zip([a, b, c, d]: Four, [p, q, r, s]: Four, f: impl Fn(f32, f32) -> f32) -> Four {
        [f(a, p), f(b, q), f(c, r), f(d, s)]
    }
    #[inline(always)]
    pub fn four(x: f32, y: f32, z: f32, w: f32) -> Four {
        [x, y, z, w]
    }
    #[inline(always)]
    pub fn all(x: f32) -> Four {
        [x; 4]
    }
    #[inline(always)]
    pub fn add(x: Four, y: Four) -> Four {
        zip(x, y, |x, y| x + y)
    }
    #[inline(always)]
    pub fn sub(x: Four, y: Four) -> Four {
        zip(x, y, |x, y| x - y)
    }
    #[inline(always)]
    pub fn mul(x: Four, y: Four) -> Four {
        zip(x, y, |x, y| x * y)
    }
    #[inline(always)]
    pub fn abs(x: Four) -> Four {
        x.map(f32::abs)
    }
    #[inline(always)]
    pub fn positive(x: Four) -> Four {
        x.map(|x| if x > 0.0 { x } else { 0.0 })
    }
    #[inline(always)]
    pub fn sum([a, b, c, d]: Four) -> f32 {
        (a + c) + (b + d)
    }
    #[inline(always)]
    pub fn any_above([a, b, c, d]: Four, [p, q, r, s]: Four) -> bool {
        (a > p) | (b > q) | (c > r) | (d > s)
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Lanes(machine::Four);

impl Lanes {
    #[inline(always)]
    pub fn new(x: f32, y: f32, z: f32) -> Lanes {
        Lanes(machine::four(x, y, z, 0.0))
    }

    #[inline(always)]
    pub fn all(x: f32) -> Lanes {
        Lanes(machine::all(x))
    }

    #[inline(always)]
    pub fn abs(self) -> Lanes {
        Lanes(machine::abs(self.0))
    }

    /// The larger of each and 0; 0 for what is no number.
    #[inline(always)]
    pub fn positive(self) -> Lanes {
        Lanes(machine::positive(self.0))
    }

    /// Whether one is larger than its counterpart.
    #[inline(always)]
    pub fn any_above(self, other: Lanes) -> bool {
        machine::any_above(self.0, other.0)
    }

    #[inline(always)]
    pub fn sum(self) -> f32 {
        machine::sum(self.0)
    }
}

impl Add for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn add(self, other: Lanes) -> Lanes {
        Lanes(machine::add(self.0, other.0))
    }
}

impl Sub for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn sub(self, other: Lanes) -> Lanes {
        Lanes(machine::sub(self.0, other.0))
    }
}

impl Mul for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn mul(self, other: Lanes) -> Lanes {
        Lanes(machine::mul(self.0, other.0))
    }
}
