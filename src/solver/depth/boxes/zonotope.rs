//! The difference of two boxes: heights, points and normals.

use crate::math::{Accumulator, TwoWords, Vector, finite, largest, magnitude, norm};
use crate::scalar::Real;
use crate::solver::depth::body::{Body, skew};
use crate::support::Failure;
use crate::support::failure::{NOT_FINITE, TOO_LARGE};
use crate::support::range::signed;

/// The edges of two boxes.
pub(super) const EDGES: usize = 6;

/// The normal of a face that two edges span.
pub(super) enum Normal<T: Real> {
    /// They are parallel: there is no such face.
    None,
    /// They are so nearly parallel that M changes by less than E when they are.
    Unknown,
    /// A unit vector, and what it is off, for [`Zonotope::error`].
    Known(TwoWords<T, 3>, Vector<T, 3>),
}

/// A - B of two boxes A and B (see the module's head).
pub(super) struct Zonotope<T: Real> {
    /// Columns of A's matrix, then of B's: g.
    pub along: [Vector<T, 3>; EDGES],
    /// Half sizes: w.
    pub half: [T; EDGES],
    places: [Vector<T, 3>; 2],
    /// Bounds what is added up in one word: S.
    pub size: T,
    /// Bounds what is added up in two words, axis by axis of the world.
    sizes: Vector<T, 3>,
    pub balls: [T; 2],
    /// The sum of both.
    pub ball: T,
    /// What they are off: where they were split off rounded bodies, they are images under the matrices.
    pub ball_error: T,
}

impl<T: Real> Zonotope<T> {
    pub fn new(a: &Body<'_, T>, b: &Body<'_, T>) -> Result<Self, Failure> {
        let ones = Vector::repeat(T::one());
        let (corner_a, corner_b) = (a.shape.support(&ones)?, b.shape.support(&ones)?);
        let (mut along, mut half) = ([Vector::zeros(); EDGES], [T::zero(); EDGES]);
        let columns = a.rotation.column_iter().chain(b.rotation.column_iter());
        for (to, column) in along.iter_mut().zip(columns) {
            *to = column.into_owned();
        }
        for (to, &w) in half.iter_mut().zip(corner_a.iter().chain(corner_b.iter())) {
            *to = magnitude(w);
        }
        let balls = [a.shape.radius(), b.shape.radius()];
        let ball = balls[0] + balls[1];
        let places = [a.translation, b.translation];
        let sum = |x: &Vector<T, 3>| x.iter().fold(T::zero(), |sum, &x| sum + magnitude(x));
        let edges = half.iter().fold(T::zero(), |sum, &w| sum + w);
        let known = edges.finite() && ball.finite() && balls.iter().all(|&r| r >= T::zero());
        if !(known && places.iter().all(finite)) {
            return Err(Failure(NOT_FINITE));
        }
        // (So far from where sums overflow that no rounding mode hides it.)
        let size = (edges + sum(&(places[0] - places[1]))) * T::of(1.01);
        if !(size + ball + sum(&places[0]) + sum(&places[1]) < T::HUGE * T::of(0.25)) {
            return Err(Failure(TOO_LARGE));
        }
        let rolled = |body: &Body<'_, T>| match body.shape.rolling_radius() {
            rolling if rolling > T::zero() => {
                (skew(&body.rotation) * T::count(2) + T::count(8) * T::ROUNDOFF) * rolling
            }
            _ => T::zero(),
        };
        let apart = (places[0] - places[1]).abs();
        let sizes = along.iter().zip(&half).fold(apart, |sizes, (g, &w)| sizes + g.abs() * w);
        Ok(Zonotope { along, half, places, size, sizes, balls, ball, ball_error: rolled(a) + rolled(b) })
    }

    /// c
    pub fn center(&self) -> Vector<T, 3> {
        self.places[0] - self.places[1]
    }

    /// The lower one of the heights along n and -n, and 1 or -1 for which it is; without two edges that n is across.
    #[inline(always)]
    pub fn height(&self, n: &Vector<T, 3>, center: &Vector<T, 3>, across: [usize; 2]) -> (T, T) {
        let mut height = T::zero();
        for (k, (g, &w)) in self.along.iter().zip(&self.half).enumerate() {
            if k != across[0] && k != across[1] {
                height += magnitude(g.dot(n)) * w;
            }
        }
        let offset = center.dot(n);
        if offset > T::zero() { (-T::one(), height - offset) } else { (T::one(), height + offset) }
    }

    /// The coordinates of the point that is farthest along a unit vector in two words.
    #[inline(never)]
    pub fn farthest(&self, n: &TwoWords<T, 3>) -> [T; EDGES] {
        let mut coordinates = self.half;
        for (s, g) in coordinates.iter_mut().zip(&self.along) {
            let mut height = g.dot(&n.high);
            if magnitude(height) <= T::count(16) * T::ROUNDOFF {
                height = n.dot(&TwoWords::from(*g)).value();
            }
            *s = signed(*s, height);
        }
        coordinates
    }

    /// The point of M with these coordinates.
    #[inline(never)]
    pub fn place(&self, coordinates: &[T; EDGES]) -> TwoWords<T, 3> {
        TwoWords::of(|i| {
            // (The places first: what they have in common is gone, exactly.)
            let mut sum = Accumulator::new(self.places[0][i]);
            sum.add(-self.places[1][i]);
            for (g, &s) in self.along.iter().zip(coordinates) {
                sum.add_product(g[i], s);
            }
            sum
        })
    }

    /// Its points of both boxes, rounded.
    pub fn points(&self, coordinates: &[T; EDGES]) -> [Vector<T, 3>; 2] {
        [TwoWords::of(|i| self.of_a(coordinates, i)).high, TwoWords::of(|i| self.of_b(coordinates, i)).high]
    }

    fn of_a(&self, coordinates: &[T; EDGES], i: usize) -> Accumulator<T> {
        let mut sum = Accumulator::new(self.places[0][i]);
        for (g, &s) in self.along.iter().zip(coordinates).take(3) {
            sum.add_product(g[i], s);
        }
        sum
    }

    fn of_b(&self, coordinates: &[T; EDGES], i: usize) -> Accumulator<T> {
        let mut sum = Accumulator::new(self.places[1][i]);
        for (g, &s) in self.along.iter().zip(coordinates).skip(3) {
            sum.add_product(-g[i], s);
        }
        sum
    }

    /// Bounds the numbers that a height along a unit vector is made of.
    pub fn size_along(&self, n: &Vector<T, 3>) -> T {
        n.abs().dot(&self.sizes) + self.ball
    }

    /// E: of heights in two words along a unit vector that is off by no more than 2^12 u^2 `blur`.
    pub fn error(&self, n: &Vector<T, 3>, blur: &Vector<T, 3>) -> T {
        self.size_along(&(n.abs() + blur)) * (T::count(1 << 14) * T::ROUNDOFF * T::ROUNDOFF)
            + T::count(1 << 10) * T::TINY
    }

    /// E of all directions.
    pub fn whole_error(&self) -> T {
        self.error(&Vector::repeat(T::one()), &Vector::zeros())
    }

    /// g_i x g_j.
    #[inline(never)]
    pub fn normal_in_two_words(&self, i: usize, j: usize) -> Normal<T> {
        let (Some(x), Some(y)) = (self.along.get(i), self.along.get(j)) else { return Normal::None };
        let dot = x.dot(y);
        let near = if magnitude(dot) > T::of(0.75) { signed(T::one(), dot) } else { T::zero() };
        let e: TwoWords<T, 3> = TwoWords::of(|k| {
            let mut sum = Accumulator::new(y[k]);
            sum.add(-near * x[k]);
            sum
        });
        let n = TwoWords::of(|k| {
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            let mut sum = Accumulator::new(T::zero());
            for word in [&e.high, &e.low] {
                sum.add_product(x[p], word[q]);
                sum.add_product(-x[q], word[p]);
            }
            sum
        });
        let (length, reach) = (norm(&n.high), norm(&e.high));
        if reach.is_zero() {
            return Normal::None;
        }
        if !(length > reach * (T::count(1 << 10) * T::ROUNDOFF * T::ROUNDOFF) && length > T::count(1 << 10) * T::TINY) {
            return Normal::Unknown;
        }
        let (x, e) = (x.abs(), e.high.abs() * (T::of(0.0625) / length));
        let blur = Vector::<T, 3>::new(x[1] * e[2] + x[2] * e[1], x[2] * e[0] + x[0] * e[2], x[0] * e[1] + x[1] * e[0]);
        Normal::Known(n.unit(), blur)
    }

    /// The error of heights in one word along a unit vector, and of that vector.
    pub fn error_in_one_word(&self) -> T {
        self.size * (T::count(64) * T::ROUNDOFF) + T::count(64) * T::TINY
    }

    /// The affine dimension of M. (Only what has no size makes it flat.)
    pub fn dimension(&self) -> usize {
        if self.half.iter().all(|&w| w > T::zero()) {
            return 3;
        }
        let parallel = T::count(64) * T::ROUNDOFF;
        let edges = || self.along.iter().zip(&self.half).filter(|&(_, &w)| w > T::zero()).map(|(g, _)| g);
        let Some(first) = edges().next() else { return 0 };
        let Some(n) = edges().map(|g| first.cross(g)).find(|n| norm(n) > parallel) else { return 1 };
        if edges().any(|g| magnitude(g.dot(&n)) > parallel * norm(&n)) { 3 } else { 2 }
    }
}

/// The length of a vector in two words: rounded, and what that leaves out.
pub(super) fn length<T: Real>(x: &TwoWords<T, 3>) -> (T, T) {
    let largest = largest(&x.high);
    if !(largest > T::count(4) * T::TINY) {
        return (largest + largest, T::zero());
    }
    let unit = largest.power_of_two();
    let scale = T::one() / unit;
    let (root, slip) = TwoWords { high: x.high * scale, low: x.low * scale }.length();
    (root * unit, slip * unit)
}
