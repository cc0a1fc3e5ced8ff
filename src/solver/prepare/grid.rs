//! Points on a grid of integers, where no decision is rounded.
//!
//! A hull is built from one question: is p above the plane of a, b, c? In floating point the answer is rounding where the four
//! points are nearly in a plane, and answers that contradict each other break the hull. So the points are measured from the
//! first one, along each axis in units of 2^-60 of the largest coordinate M along that axis (rounded down to a power of two): integers of
//! 62 bits, whose determinant is exact in 192 bits. Stretching the axes does not change which edges a hull has, and plates and needles along the
//! axes are no thinner than other hulls. The hull is that of points displaced by less than 2^-59 M in each coordinate, which is a
//! sixty-fourth of the roundoff of a coordinate of size M in `f64`, and nothing in `f32` but for the smallest coordinates.

use crate::math::Vector;
use crate::scalar::Real;

/// A point in units of the grid; below 2^61 + 2^10 in size.
pub(super) type Node = [i64; 3];

/// A point's height above a plane, in units that belong to the plane: high * 2^64 + low. Compared like numbers.
pub(super) type Height = (i128, u64);

pub(super) const LEVEL: Height = (0, 0);

/// A height's size.
pub(super) fn distance((high, low): Height) -> Height {
    if high < 0 { (-high - i128::from(low != 0), low.wrapping_neg()) } else { (high, low) }
}

/// Points, and how they are measured.
#[derive(Clone, Copy)]
pub(super) struct Grid<'a, T> {
    points: &'a [[T; 3]],
    first: [T; 3],
    /// 1 / M for each axis.
    scale: [T; 3],
    /// 1 / M of the longest axis.
    whole: T,
}

impl<'a, T: Real> Grid<'a, T> {
    /// `None` without points, and where all are equal in one coordinate up to underflow.
    pub fn new(points: &'a [[T; 3]]) -> Option<Self> {
        let first = *points.first()?;
        let mut scale = [T::zero(); 3];
        let mut whole = T::HUGE;
        for i in 0..3 {
            let largest = points.iter().fold(T::zero(), |m, p| m.at_least((p[i] - first[i]).abs()));
            if !(largest >= T::TINY) {
                return None;
            }
            scale[i] = T::one() / largest.power_of_two();
            whole = whole.at_most(scale[i]);
        }
        Some(Grid { points, first, scale, whole })
    }

    /// A point by its position in the list.
    pub fn node(&self, point: usize) -> Option<Node> {
        let p = self.points.get(point)?;
        let mut node = [0; 3];
        for i in 0..3 {
            node[i] = units(p[i], self.first[i], self.scale[i]);
        }
        Some(node)
    }

    /// A point relative to the first one, in units of M of the longest axis, rounded.
    pub fn offset(&self, point: usize) -> Option<Vector<T, 3>> {
        let (p, first) = (self.points.get(point)?, self.first);
        Some((Vector::from(*p) - Vector::from(first)) * self.whole)
    }
}

/// x - c in units of the grid. The difference is the rounded one and its error (Knuth), each a number of the format and rounded
/// towards 0.
fn units<T: Real>(x: T, c: T, scale: T) -> i64 {
    let difference = x - c;
    let minus_c = difference - x;
    let error = (x - (difference - minus_c)) - (c + minus_c);
    let unit = T::count(1 << 30);
    // The scale brings differences into [-2, 2]; all factors are powers of two.
    let whole = |d: T| ((d * scale) * unit * unit).to_integer();
    whole(difference) + whole(error)
}

/// The plane through three nodes, with a normal that points to where they turn counterclockwise.
pub(super) struct Plane {
    base: Node,
    normal: [i128; 3],
}

impl Plane {
    pub fn through([a, b, c]: [Node; 3]) -> Self {
        let edge = |to: Node| [to[0] - a[0], to[1] - a[1], to[2] - a[2]].map(i128::from);
        let (e, f) = (edge(b), edge(c));
        // Edges are below 2^62 + 2^11 in size, so minors are below 2^125 + 2^75.
        let normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
        Plane { base: a, normal }
    }

    /// > [`LEVEL`] above the plane, and 0 exactly in it.
    pub fn height(&self, node: &Node) -> Height {
        let (mut high, mut low) = (0i128, 0u64);
        for i in 0..3 {
            let along = i128::from(node[i] - self.base[i]);
            let (upper, lower) = ((self.normal[i] >> 64) as i64, self.normal[i] as u64);
            // |along| < 2^63, so neither product is above 2^127.
            let small = along * i128::from(lower);
            let (sum, carry) = low.overflowing_add(small as u64);
            high += along * i128::from(upper) + (small >> 64) + i128::from(carry);
            low = sum;
        }
        (high, low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dice(seed: u64) -> impl FnMut() -> f64 {
        let mut s = seed;
        move || {
            s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (s >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn nodes_are_the_points() {
        let mut next = dice(1);
        for size in [1.0, 1e-100, 1e250, 3.0] {
            for offset in [0.0, 1e3, 1e12] {
                let points: Vec<[f64; 3]> = (0..20).map(|_| [0; 3].map(|_| (next() + offset) * size)).collect();
                let grid = Grid::new(&points).unwrap();
                for (i, p) in points.iter().enumerate() {
                    for (k, x) in grid.node(i).unwrap().iter().enumerate() {
                        // Differences of neighbours in size are exact in f64.
                        let exact = (p[k] - points[0][k]) * grid.scale[k] * 2f64.powi(60);
                        assert!((*x as f64 - exact).abs() <= 2f64.powi(9), "{x} {exact}");
                        assert!(x.abs() < (1 << 61) + (1 << 10));
                    }
                }
            }
        }
        assert!(Grid::<f64>::new(&[]).is_none() && Grid::new(&[[1.0f32; 3]; 4]).is_none());
    }

    #[test]
    fn heights_are_exact() {
        // Integers small enough for 128 bits, times a factor that the determinant takes to the third power.
        let mut next = dice(2);
        for shift in [0, 20] {
            for k in 0..3000 {
                let mut node = || [0; 3].map(|_| (next() * 2f64.powi(if k % 3 == 0 { 2 } else { 40 })) as i64);
                let [a, b, c, d] = [0; 4].map(|_| node());
                let v = |p: Node| [p[0] - a[0], p[1] - a[1], p[2] - a[2]].map(i128::from);
                let (e, f, g) = (v(b), v(c), v(d));
                let exact = g[0] * (e[1] * f[2] - e[2] * f[1])
                    + g[1] * (e[2] * f[0] - e[0] * f[2])
                    + g[2] * (e[0] * f[1] - e[1] * f[0]);
                let plane = Plane::through([a, b, c].map(|p| p.map(|x| x << shift)));
                let height = plane.height(&d.map(|x| x << shift));
                if shift == 0 {
                    assert_eq!(height, (exact >> 64, exact as u64));
                } else {
                    assert_eq!(height, (exact >> 4, (exact << 60) as u64));
                }
                assert_eq!(height > LEVEL, exact > 0);
                let mirrored = Plane::through([a, c, b].map(|p| p.map(|x| x << shift))).height(&d.map(|x| x << shift));
                assert_eq!(distance(height), distance(mirrored));
                assert!(distance(height) == height || distance(height) == mirrored);
            }
        }
        // The largest that there are.
        let m = (1 << 61) + (1 << 10);
        let plane = Plane::through([[-m, -m, -m], [m, m, -m], [-m, m, m]]);
        assert_eq!(plane.height(&[m, -m, m]) > LEVEL, plane.height(&[-m, m, -m]) < LEVEL);
        let extremes = (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 0 { -m } else { m })).collect::<Vec<_>>();
        for (k, p) in extremes.iter().enumerate() {
            for q in &extremes {
                for r in &extremes {
                    let plane = Plane::through([*p, *q, *r]);
                    for s in &extremes {
                        // The same with a cube of half width 1: 8 m^3 is 2^3 (2^183 + ...).
                        let unit = |n: &Node| n.map(i64::signum);
                        let small = Plane::through([p, q, r].map(unit)).height(&unit(s));
                        assert_eq!(plane.height(s).cmp(&LEVEL), small.cmp(&LEVEL), "{k}");
                    }
                }
            }
        }
    }
}
