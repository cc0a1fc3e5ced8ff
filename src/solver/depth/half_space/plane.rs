//! A half space in the world, and what is measured from it.

use super::deepest::Deepest;
use super::{Found, Unbounded};
use crate::bounds::Bracket;
use crate::math::{Accumulator, TwoWords, Vector};
use crate::query::answer::Outcome;
use crate::scalar::Real;
use crate::solver::depth::body::{Anchor, Body, is_exact};
use crate::support::Failure;
use crate::support::failure::NOT_FINITE;
use nalgebra::SMatrix;

/// A half space in the world.
pub(super) struct Plane<'b, 'a, T: Real, const N: usize> {
    body: &'b Body<'a, T, N>,
    /// In its own frame.
    local: Vector<T, N>,
    offset: T,
    normal: TwoWords<T, N>,
    /// The sums of the absolute values that `normal` is made of: no less than its coordinates' sizes.
    weights: Vector<T, N>,
    /// |normal|, rounded, and what that leaves out.
    length: T,
    slip: T,
}

/// A bound of what sums in twice the precision leave, in u^2 of the terms' sizes: in space up to eight in each coordinate of a point (and six of low words, which are u of
/// that) and three in that of a normal, products of the parts, and eleven in the end: 64 + 9 + 16 + 121 by the bound n^2 u^2 of Ogita, Rump & Oishi,
/// 2^5 of |w|, and room for second order and low words. Four times that, since other rounding modes double u.
const TWOFOLD_ROUNDOFFS: usize = 1024;

impl<'b, 'a, T: Real, const N: usize> Plane<'b, 'a, T, N> {
    pub fn new(half_space: &dyn Unbounded<T, N>, body: &'b Body<'a, T, N>) -> Self {
        let (&local, offset) = half_space.plane();
        let normal = TwoWords::of(|i| {
            let mut sum = Accumulator::new(T::zero());
            (0..N).for_each(|j| sum.add_product(body.rotation[(i, j)], local[j]));
            sum
        });
        let weights = sizes(&body.rotation, &local);
        let (length, slip) = normal.length();
        Plane { body, local, offset, normal, weights, length, slip }
    }

    /// c - w.y + |w| r for a point y relative to the half space's frame and balls of radius r in all, and a bound of its error; `sizes` bound the terms of
    /// y's coordinates.
    fn height(&self, y: &TwoWords<T, N>, sizes: &Vector<T, N>, balls: &[T]) -> (T, T) {
        let w = &self.normal;
        let mut sum = Accumulator::new(self.offset);
        for i in 0..N {
            sum.add_product(-w.high[i], y.high[i]);
            sum.add(-(w.high[i] * y.low[i] + w.low[i] * y.high[i]));
        }
        let mut terms = self.offset.abs() + self.weights.dot(sizes);
        for &ball in balls {
            sum.add_product(ball, self.length);
            sum.add(ball * self.slip);
            terms += ball.abs() * self.length;
        }
        // (Products with a normal's smallest coordinates may be subnormal, and these may have been lost.)
        let lost = T::ROUNDOFF * T::ROUNDOFF * terms + T::TINY + T::TINY * sizes.sum();
        (sum.value(), T::count(TWOFOLD_ROUNDOFFS) * lost)
    }

    /// Half the roundings of a quotient by |w|, a sum, and of a normal that is not quite a unit vector: in roundoffs of both.
    fn slack(parts: T) -> T {
        T::count(N + 8) * T::ROUNDOFF * parts
    }

    /// The depth of a compact body in the half space: with points in one word, or, where that is not enough, in two.
    pub fn overlap(&self, a: &Body<'_, T, N>, is_enough: impl Fn(&Bracket<T>) -> bool) -> Result<Found<T, N>, Failure> {
        let anchor = a.anchor()?;
        let sane = [anchor.extent, anchor.error, a.ball].iter().all(|x| x.finite() && *x >= T::zero());
        if !sane {
            return Err(Failure(NOT_FINITE));
        }
        let (v, lost) = self.downward(&a.rotation);
        let found = self.measure(a, &Deepest::in_one_word(a, &v, lost, &anchor)?, &anchor);
        if is_enough(&found.bracket) {
            return Ok(found);
        }
        let Some(deepest) = Deepest::in_two_words(a, &v, lost, &anchor) else { return Ok(found) };
        let finer = self.measure(a, &deepest, &Anchor { calls: found.calls, ..anchor });
        // (One word may be exact.)
        let bracket = Bracket {
            lower: finer.bracket.lower.at_least(found.bracket.lower),
            upper: finer.bracket.upper.at_most(found.bracket.upper),
        };
        Ok(Found { bracket, ..finer })
    }

    /// The depth, where this is what reaches farthest into the half space.
    fn measure(&self, a: &Body<'_, T, N>, deepest: &Deepest<T, N>, anchor: &Anchor<T, N>) -> Found<T, N> {
        let point = &deepest.point;
        let relative = |frame: &Vector<T, N>| {
            TwoWords::of(|i| {
                let mut sum = Accumulator::new(a.translation[i]);
                sum.add(-frame[i]);
                for j in 0..N {
                    sum.add_product(a.rotation[(i, j)], point.high[j]);
                    sum.add_product(a.rotation[(i, j)], point.low[j]);
                }
                sum
            })
        };
        let sizes = sizes(&a.rotation, &(point.high.abs() + point.low.abs()))
            + a.translation.abs()
            + self.body.translation.abs();
        let (height, lost) = self.height(&relative(&self.body.translation), &sizes, &deepest.balls);
        let inverse = T::one() / self.length;
        let depth = height * inverse;
        // Both ways: the sums, the point's distance from A, and the quotient. Upwards: what A reaches beyond the point.
        let along = self.length * T::of(1.01);
        let off = deepest.error * along;
        let beyond = deepest.error * along + deepest.astray * (anchor.extent + deepest.error) * T::count(2);
        let slack = Self::slack(depth.abs());
        let bracket = Bracket {
            lower: depth - ((lost + off) * inverse * T::of(1.01) + slack),
            upper: depth + ((lost + beyond) * inverse * T::of(1.01) + slack),
        };
        let normal = -self.normal.high * inverse;
        let on_a = relative(&Vector::zeros()).high + normal * deepest.balls.iter().fold(T::zero(), |sum, &r| sum + r);
        Found {
            bracket,
            normal,
            on_a,
            on_b: on_a - normal * depth,
            calls: 1 + anchor.calls,
            outcome: None,
            dimension: N,
        }
    }

    /// The direction into the half space in the frame of a body, -R^T w, and a bound of what both words leave out.
    fn downward(&self, rotation: &SMatrix<T, N, N>) -> (TwoWords<T, N>, T) {
        let w = &self.normal;
        let v = TwoWords::of(|j| {
            let mut sum = Accumulator::new(T::zero());
            for i in 0..N {
                sum.add_product(-rotation[(i, j)], w.high[i]);
                sum.add(-rotation[(i, j)] * w.low[i]);
            }
            sum
        });
        (v, T::count(TWOFOLD_ROUNDOFFS) * (T::ROUNDOFF * T::ROUNDOFF * self.length + T::TINY))
    }

    /// The depth of two half spaces, the other one as A.
    pub fn facing(&self, a: &Self) -> Found<T, N> {
        let inverse = T::one() / a.length;
        let normal = a.normal.high * inverse;
        let foot = a.body.translation + normal * (a.offset * inverse);
        match self.is_opposite(a) {
            Some(false) => {
                let on_b = self.body.translation + self.normal.high * (self.offset / self.length / self.length);
                let bracket = Bracket { lower: T::HUGE, upper: T::HUGE };
                Found { bracket, normal, on_a: foot, on_b, calls: 0, outcome: Some(Outcome::Unbounded), dimension: N }
            }
            told => {
                // A's normal is along -w: its offset and the way between the frames count along it.
                let way = TwoWords::of(|i| {
                    let mut sum = Accumulator::new(self.body.translation[i]);
                    sum.add(-a.body.translation[i]);
                    sum
                });
                let sizes = self.body.translation.abs() + a.body.translation.abs();
                let (height, lost) = a.height(&way, &sizes, &[]);
                let (first, second) = (height * inverse, self.offset / self.length);
                let depth = first + second;
                let slack = lost * inverse * T::of(1.01) + Self::slack(first.abs() + second.abs() + depth.abs());
                let upper = if told.is_some() { depth + slack } else { T::HUGE };
                let bracket = Bracket { lower: depth - slack, upper };
                Found {
                    bracket,
                    normal,
                    on_a: foot,
                    on_b: foot - normal * depth,
                    calls: 0,
                    outcome: None,
                    dimension: N,
                }
            }
        }
    }

    /// Are the normals exactly opposite? `None` where rounding does not tell.
    fn is_opposite(&self, other: &Self) -> Option<bool> {
        let (r, s) = (&self.body.rotation, &other.body.rotation);
        // Turned alike, or by exact quarter turns: no rounding.
        if r == s {
            return Some(self.local.dot(&other.local) < T::zero() && is_parallel(&self.local, &other.local));
        }
        let (n, m) = (&self.normal.high, &other.normal.high);
        if is_exact(r) && is_exact(s) {
            return Some(n.dot(m) < T::zero() && is_parallel(n, m));
        }
        let mut across = T::zero();
        for i in 0..N {
            for j in 0..i {
                across = across.at_least((n[i] * m[j] - n[j] * m[i]).abs());
            }
        }
        let rounding = T::count(8) * T::ROUNDOFF * self.length * other.length;
        (n.dot(m) > T::zero() || across > rounding).then_some(false)
    }
}

/// |R| |x|, coordinate by coordinate: what the terms of R x add up to in size.
fn sizes<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    rotation.abs() * x.abs()
}

/// Are two vectors parallel, exactly?
fn is_parallel<T: Real, const N: usize>(n: &Vector<T, N>, m: &Vector<T, N>) -> bool {
    let product = |x: T, y: T| {
        let mut sum = Accumulator::new(T::zero());
        sum.add_product(x, y);
        sum.parts()
    };
    let mut parallel = true;
    for i in 0..N {
        for j in 0..i {
            parallel &= product(n[i], m[j]) == product(n[j], m[i]);
        }
    }
    parallel
}
