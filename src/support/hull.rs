//! Convex hulls of point lists: by linear scan (any dimension), or by hill climbing on a prepared graph (3-D).

use super::graph::{HullGraph, SEEDS, Word};
use super::range::{above, check_numbers, in_range, length, rescaled};
use super::shapes::ShapeError;
use super::{Failure, Support};
use crate::math::load::one_by_one;
use crate::math::{TwoWords, Vector, norm};
use crate::scalar::Real;

/// A list of points that is not empty, and the search for the farthest one. Heights above a plane are products u.p; with
/// `FAR`, u.(p - first), which is more accurate where all points are far from the origin.
#[derive(Clone, Copy, Debug)]
pub struct List<'a, T, const N: usize> {
    points: &'a [[T; N]],
    first: &'a [T; N],
}

impl<'a, T: Real, const N: usize> List<'a, T, N> {
    /// `None` for an empty list. Coordinates are not looked at.
    #[inline(always)]
    pub fn new(points: &'a [[T; N]]) -> Option<Self> {
        points.first().map(|first| List { points, first })
    }

    /// Relative error N roundoffs of |u| |p|, with `FAR` N + 1 of |u| |p - first|.
    #[inline(always)]
    fn height<const FAR: bool>(&self, u: &Vector<T, N>, p: &[T; N]) -> T {
        // -0 + x is x, so the compiler drops the first addition; 0 + x is not (x = -0). (A fold over iterators is not always inlined.)
        let mut sum = -T::zero();
        for i in 0..N {
            sum += u[i] * if FAR { p[i] - self.first[i] } else { p[i] };
        }
        sum
    }

    /// The farthest point for a direction in range, the first one of equals. Four at a time, as a tournament of values and small
    /// indices: a running maximum would make every point wait for the one before it, and selecting points instead of
    /// indices is a fifth slower.
    #[inline(always)]
    pub fn scan<const FAR: bool>(&self, u: &Vector<T, N>) -> &'a [T; N] {
        let mut best = (-T::HUGE, self.first);
        let better = |a: (T, &'a [T; N]), b: (T, &'a [T; N])| if b.0 > a.0 { b } else { a };
        let (fours, rest) = self.points.as_chunks::<4>();
        for four in fours {
            let [a, b, c, d] = four.each_ref().map(|p| self.height::<FAR>(u, p));
            let (left, i) = (a.at_least(b), usize::from(b > a));
            let (right, j) = (c.at_least(d), 2 + usize::from(d > c));
            let (most, k) = (left.at_least(right), if right > left { j } else { i });
            // Always there: k < 4.
            if let Some(p) = four.get(k) {
                best = better(best, (most, p));
            }
        }
        for p in rest {
            best = better(best, (self.height::<FAR>(u, p), p));
        }
        best.1
    }

    /// The farthest point along a direction in two words. Only points that one word cannot tell from the highest are looked at twice: the products with the high
    /// word are off by N + 1 roundoffs of |u| times the extent, and the low word is one more.
    pub fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        let size = self.points.iter().flatten().fold(T::zero(), |most, &x| most.at_least(x).at_least(-x));
        let blur = size * T::count(N) * norm(&u.high) * (T::count(4 * N + 8) * T::ROUNDOFF);
        let least = self.height::<false>(&u.high, self.scan::<false>(&u.high)) - blur;
        let high = self.points.iter().filter(|p| self.height::<false>(&u.high, p) >= least);
        let sums = high.map(|p| TwoWords::from(Vector::from(*p))).map(|p| (u.dot(&p).parts(), p));
        sums.reduce(|most, sum| if sum.0 > most.0 { sum } else { most }).map(|(_, point)| point)
    }

    /// The best of the listed vertices, the first one of equals.
    #[inline(always)]
    fn best_of<const FAR: bool, W: Word>(&self, u: &Vector<T, N>, list: &[W]) -> Option<(T, W)> {
        let mut best = (-T::HUGE, W::EMPTY);
        for &vertex in list {
            if let Some(p) = self.points.get(vertex.position()) {
                let height = self.height::<FAR>(u, p);
                if height > best.0 {
                    best = (height, vertex);
                }
            }
        }
        (best.1 != W::EMPTY).then_some(best)
    }

    /// Where climbing the graph ends, for a direction in range: see [`Hull`].
    #[inline(always)]
    pub fn climb<const FAR: bool, W: Word>(&self, graph: &HullGraph<'_, W>, u: &Vector<T, N>) -> &'a [T; N] {
        self.walk::<FAR, W>(graph, u).unwrap_or_else(|| self.scan::<FAR>(u))
    }

    /// `None` where the graph has no usable seed, or is not that of a hull: it makes the walk longer than a hull's edges do.
    #[inline(always)]
    fn walk<const FAR: bool, W: Word>(&self, graph: &HullGraph<'_, W>, u: &Vector<T, N>) -> Option<&'a [T; N]> {
        // Each step is strictly better than the one before, so a hull's lists are read once at most: n points have fewer
        // than 3 n edges, from two ends each.
        let most = 6 * self.points.len() + SEEDS;
        let mut left = most.checked_sub(graph.seeds().len())?;
        let (mut height, mut vertex) = self.best_of::<FAR, W>(u, graph.seeds())?;
        loop {
            let list = graph.neighbors(vertex);
            left = left.checked_sub(list.len())?;
            let here = self.points.get(vertex.position())?;
            match self.best_of::<FAR, W>(u, list) {
                Some(better) if better.0 > height => (height, vertex) = better,
                // Rounding may hide the way up among neighbours that are as high.
                Some((next, at)) if height - next <= self.blur::<FAR>(u, here, self.points.get(at.position())?) => {
                    return self.creep(graph, u, vertex, most);
                }
                _ => return Some(here),
            }
        }
    }

    /// Heights of two points that differ by less cannot be told apart: N + 1 roundoffs of sum |u_i| (|p_i| + |q_i|).
    #[inline(always)]
    fn blur<const FAR: bool>(&self, u: &Vector<T, N>, p: &[T; N], q: &[T; N]) -> T {
        let mut size = T::zero();
        for i in 0..N {
            let (p, q) = if FAR { (p[i] - self.first[i], q[i] - self.first[i]) } else { (p[i], q[i]) };
            size += u[i].abs() * (p.abs() + q.abs());
        }
        size * (T::count(N + 1) * T::ROUNDOFF)
    }

    /// Climbs on by heights above the vertex itself, whose error is that of the edge's length. `None` where these are level and
    /// cannot tell either.
    #[cold]
    #[inline(never)]
    fn creep<W: Word>(&self, graph: &HullGraph<'_, W>, u: &Vector<T, N>, from: W, most: usize) -> Option<&'a [T; N]> {
        let (mut vertex, mut left) = (from, most);
        loop {
            let (here, list) = (self.points.get(vertex.position())?, graph.neighbors(vertex));
            left = left.checked_sub(list.len())?;
            let mut best = (T::zero(), vertex);
            let mut level = heapless::Vec::<Vector<T, N>, 8>::new();
            let mut room = true;
            for &next in list {
                let Some(p) = self.points.get(next.position()) else { continue };
                let (mut edge, mut height, mut size) = (Vector::<T, N>::zeros(), T::zero(), T::zero());
                for i in 0..N {
                    edge[i] = p[i] - here[i];
                    let rise = u[i] * edge[i];
                    height += rise;
                    size += rise.abs();
                }
                if height > best.0 {
                    best = (height, next);
                }
                if height >= -(size * (T::count(N + 1) * T::ROUNDOFF)) {
                    room &= level.push(edge).is_ok();
                }
            }
            if best.1 == vertex {
                return (room && are_apart(&level)).then_some(here);
            }
            vertex = best.1;
        }
    }
}

/// Are level edges of a vertex enough to say that it is a top? What is up is a sum of edges, and edges that go up no more than
/// rounding can only hide it where that sum is much longer than what it leads to: two of them are nearly on one line, as around a
/// point that rounding has put beside an edge.
fn are_apart<T: Real, const N: usize>(edges: &[Vector<T, N>]) -> bool {
    let share = T::count(255) / T::count(256);
    let mut rest = edges;
    while let Some((e, others)) = rest.split_first() {
        // Not a number, an overflow, and nothing count as on one line.
        let apart = |f: &Vector<T, N>| e.dot(f) * e.dot(f) < share * e.dot(e) * f.dot(f);
        if !others.iter().all(apart) {
            return false;
        }
        rest = others;
    }
    true
}

/// The convex hull of a list of points, in any dimension, by linear scan: N products per point. Among equals
/// the first point wins, so that the answer does not depend on rounding in other points.
///
/// `error`: the point is exact. Each product has error at most `N u |u| |p|`, and a choice compares two of them:
/// `2 (N + 1) u extent`. Points far from the origin compared with their spread are measured from the first of them (which costs N
/// subtractions a point): then `2 (N + 2) u spread`.
///
/// ```
/// use qdist::{Vector, support::{Points, Support}};
/// let corners = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]];
/// let triangle = Points::new(&corners).unwrap();
/// assert_eq!(triangle.support(&Vector::from([1.0, 1.0])).unwrap(), Vector::from([2.0, 0.0]));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Points<'a, T, const N: usize> {
    list: List<'a, T, N>,
    extent: T,
    /// Largest |x_i|, or |x_i - first_i| where products are measured from the first point.
    extents: Vector<T, N>,
    /// Largest distance from the first point, where that is what products are measured by.
    spread: Option<T>,
}

impl<'a, T: Real, const N: usize> Points<'a, T, N> {
    /// The hull of `points`. Reads all of them once.
    ///
    /// # Errors
    /// [`ShapeError::Empty`], [`ShapeError::NonFinite`].
    pub fn new(points: &'a [[T; N]]) -> Result<Self, ShapeError> {
        let list = List::new(points).ok_or(ShapeError::Empty)?;
        check_numbers(points.iter().flatten())?;
        // The norms of points scaled by the largest coordinate: no square overflows, none that counts underflows.
        let size = points.iter().flatten().fold(T::zero(), |m, &x| m.at_least(x).at_least(-x));
        let reach = |from: Vector<T, N>| {
            let scale = |p: &[T; N]| length(&(Vector::from(*p) - from).map(|x| x / size));
            above(size * points.iter().fold(T::zero(), |m, p| m.at_least(scale(p))), 2)
        };
        let extent = if size > T::zero() { reach(Vector::zeros()) } else { T::zero() };
        let spread = if size > T::zero() { reach(Vector::from(*list.first)) } else { T::zero() };
        let spread = (spread * T::count(4) < extent).then_some(spread);
        let base = if spread.is_some() { Vector::from(*list.first) } else { Vector::zeros() };
        let extents = points.iter().fold(Vector::zeros(), |most: Vector<T, N>, p| {
            most.zip_map(&(Vector::from(*p) - base), |m, x| m.at_least(x).at_least(-x))
        });
        Ok(Self { list, extent, extents: extents.map(|x| above(x, 0)), spread })
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &'a [[T; N]] {
        self.list.points
    }

    /// `u` itself, or a multiple whose products with the points are in range.
    #[inline(always)]
    fn in_range(&self, u: &Vector<T, N>) -> Vector<T, N> {
        let u = one_by_one(u);
        if in_range(&u, self.extent) { u } else { rescaled(u, self.extent) }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Points<'_, T, N> {
    #[inline]
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let u = self.in_range(u);
        // Two copies of the loop, each with one way to measure.
        let p = if self.spread.is_none() { self.list.scan::<false>(&u) } else { self.list.scan::<true>(&u) };
        Ok(Vector::from(*p))
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        match self.spread {
            Some(spread) => T::count(2 * N + 4) * T::ROUNDOFF * spread,
            None => T::count(2 * N + 2) * T::ROUNDOFF * self.extent,
        }
    }
    fn errors(&self) -> Vector<T, N> {
        self.extents * (T::count(if self.spread.is_some() { 2 * N + 4 } else { 2 * N + 2 }) * T::ROUNDOFF)
    }
    fn extents(&self) -> Vector<T, N> {
        let first = if self.spread.is_some() { Vector::from(*self.list.first).abs() } else { Vector::zeros() };
        self.extents + first
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        self.list.support_in_two_words(u)
    }
    fn center(&self) -> Option<(Vector<T, N>, T)> {
        self.spread.map(|spread| (Vector::from(*self.list.first), spread))
    }
}

/// A large convex hull in three dimensions: its vertices and their graph, climbed from the best of a few seeds: a
/// small part of the products of a scan (480 vertices on a sphere: a sixth of the time).
///
/// The climb goes to the best neighbour while that is strictly better, so it ends. In exact arithmetic it ends at a
/// farthest vertex. Among neighbours that rounding makes equally high it goes on by the heights of the edges themselves, which are
/// accurate for short ones, and where these are level and cannot tell, it scans. So
/// [`support`](Support::support) returns a point of the core always, but keeps the second promise only as far as the
/// graph is that of the hull. [`exhaustive`](Support::exhaustive) is the linear scan
/// of [`Points`], and keeps it with the same `error`. Entries of the graph that are out of range are ignored; a graph
/// without a usable seed is the linear scan, and so is one whose lists turn out to be longer than those of a hull: n points never cost
/// more than 25 n products.
#[derive(Clone, Copy, Debug)]
pub struct Hull<'a, T, W = u16> {
    all: Points<'a, T, 3>,
    graph: HullGraph<'a, W>,
}

impl<'a, T: Real, W: Word> Hull<'a, T, W> {
    /// The hull of `points`, with the graph prepared for these points. Reads all points once.
    ///
    /// # Errors
    /// [`ShapeError::Empty`], [`ShapeError::NonFinite`].
    pub fn new(points: &'a [[T; 3]], graph: HullGraph<'a, W>) -> Result<Self, ShapeError> {
        Ok(Self { all: Points::new(points)?, graph })
    }
}

impl<T: Real, W: Word> Support<T, 3> for Hull<'_, T, W> {
    #[inline]
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        let (list, u) = (&self.all.list, self.all.in_range(u));
        let near = self.all.spread.is_none();
        let p = if near { list.climb::<false, W>(&self.graph, &u) } else { list.climb::<true, W>(&self.graph, &u) };
        Ok(Vector::from(*p))
    }
    #[inline]
    fn exhaustive(&self, u: &Vector<T, 3>) -> Result<(Vector<T, 3>, Vector<T, 3>), Failure> {
        self.all.support_with_witness(u)
    }
    #[inline]
    fn has_shortcuts(&self) -> bool {
        true
    }
    fn extent(&self) -> T {
        self.all.extent
    }
    fn error(&self) -> T {
        self.all.error()
    }
    fn errors(&self) -> Vector<T, 3> {
        self.all.errors()
    }
    fn extents(&self) -> Vector<T, 3> {
        self.all.extents()
    }
    fn support_in_two_words(&self, u: &TwoWords<T, 3>) -> Option<TwoWords<T, 3>> {
        self.all.support_in_two_words(u)
    }
    fn center(&self) -> Option<(Vector<T, 3>, T)> {
        self.all.center()
    }
}

#[cfg(test)]
mod tests {
    use super::super::graph::graph_len;
    use super::*;

    fn noise(n: usize, seed: u64) -> Vec<[f32; 3]> {
        let mut s = seed;
        let mut next = || {
            s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((s >> 33) as f64 / f64::from(1u32 << 30) - 1.0) as f32
        };
        (0..n).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn scan_keeps_its_promise_at_every_scale() {
        for (k, size) in [1.0f32, 1e-9, 1e9, 1e-20].into_iter().enumerate() {
            for n in [1, 2, 3, 4, 5, 8, 11, 31] {
                let points: Vec<[f32; 3]> = noise(n, 7 + k as u64).iter().map(|p| p.map(|x| x * size)).collect();
                let hull = Points::new(&points).unwrap();
                let e = f64::from(hull.error());
                for u in noise(300, 99) {
                    for scale in [1.0f32, 1e-15, 1e-22, 1e30] {
                        let u = u.map(|x| x * scale);
                        let p = hull.support(&Vector::from(u)).unwrap();
                        let dot = |p: &[f32; 3]| (0..3).map(|i| f64::from(u[i]) * f64::from(p[i])).sum::<f64>();
                        let best = points.iter().map(dot).fold(f64::NEG_INFINITY, f64::max);
                        let norm = u.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
                        assert!(dot(&[p.x, p.y, p.z]) >= best - e * norm, "{n} {size} {scale}");
                        assert!(points.iter().any(|q| Vector::from(*q) == p));
                    }
                }
                let far = points
                    .iter()
                    .map(|p| p.iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt())
                    .fold(0.0, f64::max);
                assert!(f64::from(hull.extent()) >= far && f64::from(hull.extent()) <= far * 1.0001);
            }
        }
    }

    #[test]
    fn the_first_of_equals_wins() {
        // The second coordinate tells the points apart; the direction does not see it.
        for n in 1..14 {
            for first in 0..n {
                let points: Vec<[f64; 2]> = (0..n).map(|k| [if k >= first { 1.0 } else { 0.0 }, k as f64]).collect();
                let p = Points::new(&points).unwrap().support(&Vector::from([1.0, 0.0])).unwrap();
                assert_eq!(p, Vector::from([1.0, first as f64]), "{n} {first}");
            }
        }
    }

    /// Climbing finds a point as high as scanning does, from either end of the range of directions.
    /// `corners` have edges; of points in one plane with them, a few may.
    fn climbs_as_high_as_it_scans(points: &[[f32; 3]], corners: usize, level: usize) {
        let mut memory = Box::new(crate::Workspace::<f32, 3, 400, 816>::new());
        let mut words = vec![0; graph_len(points.len())];
        let graph = memory.solver().prepare_hull(points, &mut words, None).unwrap();
        let with_edges = (0..points.len()).filter(|&i| !graph.neighbors(i as u16).is_empty()).count();
        assert!((corners..=corners + level).contains(&with_edges), "{with_edges}");
        let hull = Hull::new(points, graph).unwrap();
        assert!(hull.has_shortcuts());
        for u in noise(2000, 5) {
            for scale in [1.0f32, 1e-22, 1e30] {
                let u = Vector::from(u.map(|x| x * scale));
                let (climbed, scanned) = (hull.support(&u).unwrap(), hull.exhaustive(&u).unwrap().0);
                let height = |p: &Vector<f32, 3>| u.map(f64::from).dot(&p.map(f64::from));
                let slack = f64::from(hull.error()) * u.map(f64::from).norm();
                assert!(height(&climbed) >= height(&scanned) - slack, "{u} {climbed} {scanned}");
            }
        }
    }

    #[test]
    fn climbing_a_round_hull_equals_scanning() {
        for offset in [0.0f32, 100.0] {
            let round = |p: &[f32; 3]| {
                let p = Vector::from(*p).normalize();
                [p.x + offset, p.y, p.z]
            };
            let points: Vec<_> = noise(400, 3).iter().map(round).collect();
            assert_eq!(Points::new(&points).unwrap().center().is_some(), offset > 0.0);
            climbs_as_high_as_it_scans(&points, 400, 0);
        }
    }

    #[test]
    fn climbing_a_box_with_points_on_its_faces_and_inside_equals_scanning() {
        // A grid of 5 x 5 x 5 points, corners first: nothing else is outside of what they span.
        let grid = (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(|k| (k - 2) as f32));
        let mut points: Vec<[f32; 3]> = grid.collect();
        points.sort_by_key(|p| p.iter().filter(|x| x.abs() < 2.0).count());
        climbs_as_high_as_it_scans(&points, 8, 4);
    }

    #[test]
    fn a_graph_of_nonsense_still_gives_points() {
        let points = noise(9, 4);
        let all = Points::new(&points).unwrap();
        let nonsense: [&[u16]; 3] = [&[0, 0], &[1, 0, 99], &[2, 9, 1, 8, 0, 0, 7, 9, 9, 2, 0, 1, 5, 3, 3, 90, 2, 1]];
        for words in nonsense {
            let hull = Hull::new(&points, HullGraph::from_words(words).unwrap()).unwrap();
            for u in noise(100, 6) {
                let p = hull.support(&Vector::from(u)).unwrap();
                assert!(points.iter().any(|q| Vector::from(*q) == p));
                assert_eq!(hull.exhaustive(&Vector::from(u)), all.support_with_witness(&Vector::from(u)));
                // Without a usable seed, it is the scan.
                assert!(words.len() > 3 || p == all.support(&Vector::from(u)).unwrap());
            }
        }
    }

    #[test]
    fn degenerate_lists() {
        assert_eq!(Points::<f64, 3>::new(&[]).err(), Some(ShapeError::Empty));
        assert_eq!(Points::new(&[[f32::NAN, 0.0]]).err(), Some(ShapeError::NonFinite));
        assert_eq!(Points::new(&[[f32::MAX, 0.0]]).err(), Some(ShapeError::NonFinite));
        let origin = [[0.0f64; 3]; 5];
        let p = Points::new(&origin).unwrap();
        assert_eq!(
            (p.extent(), p.support(&Vector::from([1.0, 0.0, 0.0])).unwrap()),
            (0.0, Vector::from([0.0, 0.0, 0.0]))
        );
    }
}
