//! Double-double arithmetic: a number as the unevaluated sum of two `f64`, about 106 bits.
//!
//! The oracles are evaluated in it, so that a bracket of `f64` numbers can be checked without a tolerance for the
//! oracle's own rounding (relative 1e-30 or so; see [`BLUR`]).

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// How far an oracle's value may be off, relative to the coordinates that went into it: many thousand roundings
/// of 1e-32.
pub const BLUR: f64 = 1e-26;

/// hi + lo with |lo| <= ulp(hi)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dd {
    pub hi: f64,
    pub lo: f64,
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

/// Dekker's product: exact while nothing overflows or underflows.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl Dd {
    pub const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };

    pub const fn new(hi: f64) -> Dd {
        Dd { hi, lo: 0.0 }
    }

    /// The exact product of two numbers.
    pub fn product(a: f64, b: f64) -> Dd {
        let (hi, lo) = two_product(a, b);
        Dd { hi, lo }
    }

    pub fn to_f64(self) -> f64 {
        self.hi
    }

    pub fn abs(self) -> Dd {
        if self.hi < 0.0 { -self } else { self }
    }

    pub fn max(self, other: Dd) -> Dd {
        if other > self { other } else { self }
    }

    pub fn min(self, other: Dd) -> Dd {
        if other < self { other } else { self }
    }

    /// Square root; zero for what is not positive.
    pub fn sqrt(self) -> Dd {
        if self.hi <= 0.0 {
            return Dd::ZERO;
        }
        let mut x = Dd::new(self.hi.sqrt());
        for _ in 0..2 {
            x = x + (self - x * x) / (x + x);
        }
        x
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Dd {
        Dd::new(x)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, b: Dd) -> Dd {
        let (s, e) = two_sum(self.hi, b.hi);
        let (t, f) = two_sum(self.lo, b.lo);
        let (s, e) = quick_two_sum(s, e + t);
        let (hi, lo) = quick_two_sum(s, e + f);
        Dd { hi, lo }
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, b: Dd) -> Dd {
        self + -b
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, b: Dd) -> Dd {
        let (p, e) = two_product(self.hi, b.hi);
        let (hi, lo) = quick_two_sum(p, e + (self.hi * b.lo + self.lo * b.hi));
        Dd { hi, lo }
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, b: Dd) -> Dd {
        let q1 = self.hi / b.hi;
        let r = self - b * Dd::new(q1);
        let q2 = r.hi / b.hi;
        let r = r - b * Dd::new(q2);
        Dd::new(q1) + Dd::new(q2) + Dd::new(r.hi / b.hi)
    }
}

impl PartialOrd for Dd {
    fn partial_cmp(&self, b: &Dd) -> Option<Ordering> {
        match self.hi.partial_cmp(&b.hi) {
            Some(Ordering::Equal) => self.lo.partial_cmp(&b.lo),
            order => order,
        }
    }
}

/// A vector in space.
pub type V3 = [Dd; 3];

pub fn v3(v: [f64; 3]) -> V3 {
    v.map(Dd::new)
}

pub fn add(a: &V3, b: &V3) -> V3 {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn sub(a: &V3, b: &V3) -> V3 {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn scale(a: &V3, s: Dd) -> V3 {
    a.map(|x| x * s)
}

pub fn dot(a: &[Dd], b: &[Dd]) -> Dd {
    a.iter().zip(b).fold(Dd::ZERO, |s, (&x, &y)| s + x * y)
}

pub fn norm(a: &[Dd]) -> Dd {
    dot(a, a).sqrt()
}

pub fn cross(a: &V3, b: &V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
