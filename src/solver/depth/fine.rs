//! The end of a depth query in twice the precision: shallow contact.
//!
//! Bodies of size 1 that overlap by d = 0.001 are asked for d to a share of 1e-4. In `f32` that is 1.7 roundoffs of their size: no height computed from
//! their points in one word is known that well, nor is a normal in one word good enough to say it, since a roundoff of tilt costs as much. What
//! the expansion has found out is right all the same: *which* points of the bodies the answer hangs on. This module takes these from the last
//! polytope and computes the bracket anew, with every length as a sum of two words.
//!
//! # Exact points
//!
//! A vertex v of the polytope is the rounded image of a point a of A minus one b of B, in their frames. For polyhedra these are input numbers, free of
//! error, and so is their image v' = (R_A a + t_A) - (R_B b + t_B), as an expression. The two points are found again by asking both bodies along
//! the direction that brought v; a [`Recorder`] keeps it.
//!
//! # Bounds
//!
//! Both are those of module [`bounds`](crate::bounds) with a smaller margin. Let n be any vector in two words and E bound the error of heights along it.
//!
//! ```text
//! upper:   d <= (h_A(n) + h_B(-n) + n.(t_A - t_B) + E) / |n|
//! lower:   d >= min over F of max( e_F - m(n_F),  (min over v' of n.v' - E) / |n| )
//! ```
//!
//! For the lower one, move each vertex v straight to its v' as under "By direction" there: no facet crosses the origin on the way, since every facet
//! has e_F > m, and afterwards λB misses each of them, by its old plane or by the new one; any n will do for that.
//! For n the plane through the v' of a facet is taken: its normal in one word, corrected once by the heights that this leaves. The upper bound is
//! proved by the direction that is reported, which is n in one word, and is as good as that: within half a roundoff of the bodies' size.
//!
//! # Cores that are apart
//!
//! Shallow contact of bodies with a ball term leaves their cores apart, by D. Then d = r - D, and the point x of the cores' difference that is nearest to the
//! origin is a combination of at most N vertices. Let x' be the same combination of the points behind them, and p the part of it across n:
//!
//! ```text
//! d >= r - |x'|,     |x'| <= |n.x'| / |n| + p^2 |n| / (2 |n.x'|)     -n.x' <= max of -n.v'
//! ```
//!
//! x' is added up in two words: p is then as small as the weights are good, and squared. The upper bound is the one above; to tilt n along the vertices costs a roundoff of their size, but
//! across only the square of one. So n is corrected for equal heights of the vertices, as it is for a facet.
//!
//! # Errors
//!
//! Products are split and sums are compensated (`Accumulator`): k terms of sum S are known to 2 k^2 u^2 S, and a unit roundoff of the result, which
//! here is as small as d. A direction turned into a body's frame is 2 N terms, no sum above 2 |n|; a height 8 N terms more. With L the sum of all
//! extents and offsets, that is below 2^13 u^2 L; what a shape adds of its own is 2^8 u^2 L (`Support::height_in_two_words`).

use core::cell::RefCell;

use super::{Anchor, Body, Pair};
use crate::bounds::Bracket;
use crate::math::{Accumulator, TwoWords, Vector, norm, unit};
use crate::polytope::simplex::{Edges, MAX_CORNERS, Simplex};
use crate::polytope::{Facet, Polytope};
use crate::query::Query;
use crate::query::answer::{Answer, Plan};
use crate::scalar::Real;
use crate::support::{Failure, Support};
use heapless::Vec;

/// Support calls that are remembered. (A query of two hulls makes some fifteen.)
const CALLS: usize = 40;

/// Normals that are tried, where more than one part of the surface is that near.
const ATTEMPTS: usize = 4;

/// Points of A and B, in their frames.
type Behind<T, const N: usize> = [Vector<T, N>; 2];

/// The difference of two bodies that remembers which direction brought which point.
pub(super) struct Recorder<'p, 'b, 'a, T: Real, const N: usize> {
    pair: &'p Pair<'b, 'a, T, N>,
    calls: RefCell<Vec<Call<T, N>, CALLS>>,
}

#[derive(Clone, Copy)]
struct Call<T: Real, const N: usize> {
    direction: Vector<T, N>,
    point: Vector<T, N>,
    exhaustive: bool,
}

impl<'p, 'b, 'a, T: Real, const N: usize> Recorder<'p, 'b, 'a, T, N> {
    /// `None` for bodies whose points are not exact.
    pub fn new(pair: &'p Pair<'b, 'a, T, N>) -> Option<Self> {
        let axis = TwoWords::from(Vector::repeat(T::one()));
        // (Errors are told by what a shape says of its extents.)
        let exact = |body: &Body<'_, T, N>, anchor: &Anchor<T, N>| {
            let stated = body.shape.extent() > T::zero() || anchor.extent == T::zero();
            stated && body.inflation == T::zero() && body.shape.height_in_two_words(&axis).is_some()
        };
        (exact(pair.a, &pair.on_a) && exact(pair.b, &pair.on_b))
            .then(|| Recorder { pair, calls: RefCell::new(Vec::new()) })
    }

    fn sample(&self, direction: &Vector<T, N>, exhaustive: bool) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let sample = self.pair.sample(direction, exhaustive)?;
        if let Ok(mut calls) = self.calls.try_borrow_mut() {
            // (What does not fit is not known afterwards.)
            let _ = calls.push(Call { direction: *direction, point: sample.0, exhaustive });
        }
        Ok(sample)
    }

    /// The points of both bodies behind a vertex, in their frames.
    #[inline(never)]
    fn behind(&self, vertex: &Vector<T, N>) -> Option<Behind<T, N>> {
        let calls = self.calls.try_borrow().ok()?;
        let call = calls.iter().find(|call| call.point == *vertex)?;
        let ask = |body: &Body<'_, T, N>, u: &Vector<T, N>| {
            let local = body.rotation.tr_mul(u);
            let exhaustive = || body.shape.exhaustive(&local).map(|(point, _)| point);
            if call.exhaustive { exhaustive() } else { body.shape.support(&local) }.ok()
        };
        let ends = [ask(self.pair.a, &call.direction)?, ask(self.pair.b, &-call.direction)?];
        // Of points that are equally far any one may come: are these the same?
        let image = |body: &Body<'_, T, N>, anchor: &Anchor<T, N>, point: Vector<T, N>| {
            let point = anchor.center.map_or(point, |center| point - center);
            // As `turned` has it; by columns, so that no index can fail.
            let terms = body.rotation.data.0.iter().zip(point.iter());
            terms.map(|(column, &x)| Vector::from(*column) * x).reduce(|sum, term| sum + term)
        };
        let [a, b] = ends;
        let (on_a, on_b) = (image(self.pair.a, &self.pair.on_a, a), image(self.pair.b, &self.pair.on_b, b));
        (on_a? - on_b? + self.pair.offset == *vertex).then_some(ends)
    }
}

impl<T: Real, const N: usize> Support<T, N> for Recorder<'_, '_, '_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.sample(u, false)?.0)
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, false)
    }
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, true)
    }
    fn has_shortcuts(&self) -> bool {
        self.pair.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.pair.radius()
    }
    fn extent(&self) -> T {
        self.pair.extent()
    }
    fn error(&self) -> T {
        self.pair.error()
    }
    fn extents(&self) -> Vector<T, N> {
        self.pair.extents()
    }
    fn errors(&self) -> Vector<T, N> {
        self.pair.errors()
    }
}

/// Heights along a vector in two words.
struct Level<'p, 'b, 'a, T: Real, const N: usize> {
    pair: &'p Pair<'b, 'a, T, N>,
    n: TwoWords<T, N>,
    /// n in the bodies' frames.
    seen: [TwoWords<T, N>; 2],
    /// n.(t_A - t_B)
    apart: Accumulator<T>,
    /// 1 - 1 / |n|
    excess: T,
    /// E
    error: T,
}

impl<'p, 'b, 'a, T: Real, const N: usize> Level<'p, 'b, 'a, T, N> {
    /// For a vector that is a unit vector but for rounding.
    #[inline(never)]
    fn new(pair: &'p Pair<'b, 'a, T, N>, n: TwoWords<T, N>, error: T) -> Self {
        let mut squared = Accumulator::new(-T::one());
        let mut apart = Accumulator::new(T::zero());
        for i in 0..N {
            squared.add_product(n.high[i], n.high[i]);
            squared.add_product(n.high[i], n.low[i] + n.low[i]);
            squared.add_product(n.low[i], n.low[i]);
            for word in [n.high[i], n.low[i]] {
                apart.add_product(word, pair.a.translation[i]);
                apart.add_product(word, -pair.b.translation[i]);
            }
        }
        let squared = squared.value();
        let length = (T::one() + squared).root();
        let excess = squared / ((T::one() + length) * length);
        let seen = [pair.a, pair.b].map(|body| n.turned_back(&body.rotation));
        Level { pair, n, seen, apart, excess, error }
    }

    /// The distance that a height stands for, with the ball terms, and its error, in the bodies' unit.
    #[inline(never)]
    fn distance(&self, mut height: Accumulator<T>) -> (T, T) {
        let shrink = height.value() * self.excess;
        height.add(-shrink);
        height.add(self.pair.a.ball);
        height.add(self.pair.b.ball);
        let distance = height.value();
        (distance, self.error + (shrink.abs() + distance.abs()) * (T::count(16) * T::ROUNDOFF))
    }

    /// n.v' of the point behind a vertex.
    #[inline(never)]
    fn height(&self, [a, b]: &Behind<T, N>) -> Accumulator<T> {
        let mut sum = self.apart;
        for i in 0..N {
            for (word, other) in
                [(self.seen[0].high[i], self.seen[1].high[i]), (self.seen[0].low[i], self.seen[1].low[i])]
            {
                sum.add_product(word, a[i]);
                sum.add_product(-other, b[i]);
            }
        }
        sum
    }

    /// The least distance that the heights of these points stand for.
    fn lower(&self, points: &[Behind<T, N>]) -> T {
        points.iter().fold(T::HUGE, |least, point| {
            let (distance, error) = self.distance(self.height(point));
            least.at_most(distance - error)
        })
    }

    /// d is not more than this.
    fn upper(&self) -> Option<T> {
        let mut sum = self.apart;
        for (body, n) in [(self.pair.a, self.seen[0]), (self.pair.b, -self.seen[1])] {
            for word in body.shape.height_in_two_words(&n)? {
                sum.add(word);
            }
        }
        let (distance, error) = self.distance(sum);
        Some(distance + error)
    }
}

/// The last polytope of a query, with what is known of the points behind its vertices.
pub(super) struct Fine<'f, 'p, 'b, 'a, T: Real, const N: usize> {
    polytope: &'f Polytope<'f, T, N>,
    query: &'f Query<'f, T, N>,
    recorder: &'f Recorder<'p, 'b, 'a, T, N>,
    error: T,
}

impl<'f, 'p, 'b, 'a, T: Real, const N: usize> Fine<'f, 'p, 'b, 'a, T, N> {
    pub fn new(
        polytope: &'f Polytope<'f, T, N>,
        query: &'f Query<'f, T, N>,
        recorder: &'f Recorder<'p, 'b, 'a, T, N>,
    ) -> Self {
        let size = |body: &Body<'_, T, N>| body.shape.extents().sum() + body.translation.abs().sum() + body.ball;
        let all = size(recorder.pair.a) + size(recorder.pair.b);
        let error = all * (T::count(1 << 14) * T::ROUNDOFF * T::ROUNDOFF) + T::count(1 << 10) * T::TINY;
        Fine { polytope, query, recorder, error }
    }

    /// The bracket in the query's unit, and the direction that proves its upper end, if that is new. `None` where nothing is known better.
    pub fn bracket(&self, answer: &Answer<T, N>) -> Option<(Bracket<T>, Option<Vector<T, N>>)> {
        let before = Bracket { lower: answer.lower, upper: answer.upper }.scaled(self.query.scale());
        let found = match answer.plan {
            Plan::Distance => self.by_nearest(&before, answer),
            Plan::Expansion => self.by_facets(&before),
            _ => None,
        };
        found.filter(|(bracket, _)| bracket.lower <= bracket.upper)
    }

    /// For cores that are apart: see "Cores that are apart".
    fn by_nearest(&self, before: &Bracket<T>, answer: &Answer<T, N>) -> Option<(Bracket<T>, Option<Vector<T, N>>)> {
        let scale = self.query.scale();
        let points = self.ends(&answer.witness)?;
        let level = self.level(&answer.direction, &answer.witness, &points)?;
        let nearest = self.combination(&answer.witness, &points);
        let n = level.n.high + level.n.low; // What x' is measured along is what the heights are.
        let distance = -n.dot(&nearest);
        let blur = self.error * T::count(4) + norm(&nearest) * (T::count(16) * T::ROUNDOFF);
        let aside = norm(&(nearest + n * distance)) * T::of(1.01) + blur;
        let least = distance - aside;
        if !(least > T::zero()) {
            return None;
        }
        let lower = (level.lower(&points) - aside * (aside / least)) * scale;
        let (normal, upper) = self.upper(&level)?;
        let direction = (upper < before.upper).then_some(normal);
        Some((Bracket { lower: before.lower.at_least(lower), upper: before.upper.at_most(upper) }, direction))
    }

    fn by_facets(&self, before: &Bracket<T>) -> Option<(Bracket<T>, Option<Vector<T, N>>)> {
        let mut best = (*before, None);
        if !self.polytope.is_sound() {
            return None;
        }
        let mut start = self.widest(before.upper)?;
        for _ in 0..ATTEMPTS {
            let corners = self.corners(start);
            let Some(level) = self.ends(&corners).and_then(|ends| self.level(&start.normal, &corners, &ends)) else {
                break;
            };
            let (normal, upper) = self.upper(&level)?;
            if upper < best.0.upper {
                best = (Bracket { upper, ..best.0 }, Some(normal));
            }
            let (lower, lowest) = self.lower(&level, best.0.upper)?;
            best.0.lower = best.0.lower.at_least(lower);
            match lowest {
                Some(facet) if !self.query.is_met(&best.0) => start = facet,
                _ => break,
            }
        }
        Some(best)
    }

    /// The upper bound that is proved by the normal as it will be reported, in one word.
    #[inline(never)]
    fn upper(&self, level: &Level<'p, 'b, 'a, T, N>) -> Option<(Vector<T, N>, T)> {
        let normal = unit(&(level.n.high + level.n.low));
        let upper = Level::new(self.recorder.pair, TwoWords::from(normal), self.error).upper()?;
        Some((normal, upper * self.query.scale()))
    }

    /// What one word says of a facet; `None` where it may be at the origin.
    fn rough(&self, facet: &Facet<T, N>) -> Option<T> {
        let margin = self.query.margin_along(&facet.normal);
        (facet.offset > margin).then(|| self.query.lower_of_plane(facet.offset, margin))
    }

    /// The widest of the facets that may be the lowest.
    fn widest(&self, upper: T) -> Option<&'f Facet<T, N>> {
        let width = |facet: &Facet<T, N>| {
            let corners = self.polytope.corners(facet).corners;
            let base = corners.first().map_or(Vector::zeros(), |corner| corner.vertex.point);
            let mut edges = Edges::<T, N>::new();
            corners.iter().skip(1).map(|corner| corner.vertex.point - base).fold(T::one(), |size, edge| {
                edges.push(&edge, T::zero());
                size * norm(edges.q.get(edges.count.saturating_sub(1)).unwrap_or(&edge))
            })
        };
        let near = self.polytope.facets().filter(|facet| self.rough(facet).is_none_or(|lower| lower < upper));
        near.map(|facet| (facet, width(facet))).reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(facet, _)| facet)
    }

    /// The points behind a simplex's corners, which are in the bodies' unit.
    #[inline(never)]
    fn ends(&self, simplex: &Simplex<T, N>) -> Option<Vec<Behind<T, N>, MAX_CORNERS>> {
        let mut points = Vec::new();
        for corner in &simplex.corners {
            points.push(self.recorder.behind(&corner.vertex.point)?).ok()?;
        }
        Some(points)
    }

    /// Their combination with the corners' weights.
    fn combination(&self, simplex: &Simplex<T, N>, points: &[Behind<T, N>]) -> Vector<T, N> {
        Vector::from_fn(|i, _| {
            let mut axis = Vector::<T, N>::zeros();
            axis[i] = T::one();
            let along = Level::new(self.recorder.pair, TwoWords::from(axis), self.error);
            let mut sum = Accumulator::new(T::zero());
            for (corner, point) in simplex.corners.iter().zip(points) {
                let (high, low) = along.height(point).parts();
                sum.add_product(corner.weight, high);
                sum.add_product(corner.weight, low);
            }
            sum.value()
        })
    }

    /// The corners of a facet, in the bodies' unit.
    #[inline(never)]
    fn corners(&self, facet: &Facet<T, N>) -> Simplex<T, N> {
        let mut corners = self.polytope.corners(facet);
        corners.rescale(T::one() / self.query.scale());
        corners
    }

    /// Heights along the vector next to `normal` along which the points behind these corners are equally high.
    #[inline(never)]
    fn level(
        &self,
        normal: &Vector<T, N>,
        corners: &Simplex<T, N>,
        points: &[Behind<T, N>],
    ) -> Option<Level<'p, 'b, 'a, T, N>> {
        let rough = Level::new(self.recorder.pair, TwoWords::from(*normal), self.error);
        // x.(v_k - v_0) = -n.(v_k - v_0) for all k makes n + x level: x in the span of the edges, one after the other.
        let (first, base) = (rough.height(points.first()?), corners.corners.first()?.vertex.point);
        let mut edges = Edges::<T, N>::new();
        let mut low = Vector::zeros();
        for (point, corner) in points.iter().zip(&corners.corners).skip(1) {
            let edge = corner.vertex.point - base;
            let rise = rough.height(point).minus(&first);
            if edges.push(&edge, T::zero())
                && let Some(index) = edges.count.checked_sub(1)
                && let (Some(q), Some(inverse)) = (edges.q.get(index), edges.inverse.get(index))
            {
                low += q * ((-rise - edge.dot(&low)) * *inverse);
            }
        }
        let small = low.dot(&low) <= T::of(1e-4);
        Some(if small { Level::new(self.recorder.pair, TwoWords { high: *normal, low }, self.error) } else { rough })
    }

    /// The lower bound, with this level for all facets that it suffices for and their own for the others; and the facet that is lowest, if
    /// that does not meet the tolerance. `None` where the origin may be outside.
    fn lower(&self, level: &Level<'p, 'b, 'a, T, N>, upper: T) -> Option<(T, Option<&'f Facet<T, N>>)> {
        let (mut least, mut lowest) = (T::HUGE, None);
        for facet in self.polytope.facets() {
            let mut bound = self.rough(facet)?;
            let is_enough = |lower: T| self.query.is_met(&Bracket { lower, upper });
            if !is_enough(bound) {
                let corners = self.corners(facet);
                if let Some(points) = self.ends(&corners) {
                    bound = bound.at_least(level.lower(&points) * self.query.scale());
                    if !is_enough(bound)
                        && let Some(own) = self.level(&facet.normal, &corners, &points)
                    {
                        bound = bound.at_least(own.lower(&points) * self.query.scale());
                    }
                }
            }
            if bound < least {
                (least, lowest) = (bound, (!is_enough(bound)).then_some(facet));
            }
        }
        (least < T::HUGE).then_some((least, lowest))
    }
}
