//! How far an inscribed ball of A must travel to be out of B: a bound that sees all of B at once.
//!
//! Wherever a motion takes A, the centre of a ball of radius r inside A ends where the signed distance s to B (negative inside)
//! is at least r, so
//!
//! ```text
//! DISP >= T = min { |p - c| : s(p) >= r },      sqrt(sigma) >= T / k(c)
//! ```
//!
//! T is found by branch and bound over cubes, nearest to c first: s changes by no more than the way, so a cube with middle m and half
//! diagonal h is empty when s(m) + h < r. The nearest cube that is left bounds T at any moment.

use super::piece::Piece;
use super::solid::{Corners, Solid, nearest_to_origin};
use nalgebra::Vector3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Triangles in a tree of boxes.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    triangles: Vec<Corners>,
    /// Boxes of halves of halves, in order: the children of node k are 2 k + 1 and 2 k + 2.
    boxes: Vec<[Vector3<f64>; 2]>,
    /// Balls that are known to be inside.
    balls: Vec<(Vector3<f64>, f64)>,
    /// Largest norm of a vertex.
    reach: f64,
}

/// Triangles in a leaf.
const LEAF: usize = 4;

impl Surface {
    pub fn new(solid: &Solid, pieces: &[Piece]) -> Self {
        let balls = pieces.iter().map(|piece| (piece.middle, piece.inradius)).collect();
        let mut triangles: Vec<Corners> = solid.corners().collect();
        let reach = triangles.iter().flatten().map(|p| p.norm()).fold(0.0, f64::max);
        let mut boxes = Vec::new();
        build(&mut triangles, 0, &mut boxes);
        Surface { triangles, boxes, balls, reach }
    }

    /// Largest norm of a vertex.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The distance from the surface.
    fn distance(&self, p: &Vector3<f64>) -> f64 {
        let mut best = f64::MAX;
        self.descend(0, &self.triangles, p, &mut best);
        best.sqrt()
    }

    fn descend(&self, node: usize, triangles: &[Corners], p: &Vector3<f64>, best: &mut f64) {
        if triangles.len() <= LEAF {
            for t in triangles {
                *best = best.min(nearest_to_origin(&t.map(|x| x - p)).norm_squared());
            }
            return;
        }
        let (left, right) = triangles.split_at(triangles.len() / 2);
        let away = |node: usize| {
            self.boxes.get(node).map_or(f64::MAX, |[low, high]| (p - p.sup(low).inf(high)).norm_squared())
        };
        let mut children = [(away(2 * node + 1), 2 * node + 1, left), (away(2 * node + 2), 2 * node + 2, right)];
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (squared, child, part) in children {
            if squared < *best {
                self.descend(child, part, p, best);
            }
        }
    }

    /// Is the point, which is not near the surface, inside? The winding number is asked last.
    fn contains(&self, p: &Vector3<f64>) -> bool {
        if self.boxes.first().is_some_and(|[low, high]| p.sup(low).inf(high) != *p) {
            return false;
        }
        if self.balls.iter().any(|(center, radius)| (p - center).norm() < *radius) {
            return true;
        }
        super::solid::contains(self.triangles.iter().copied(), p)
    }

    /// T is not less, for the ball of radius `ball` about `center`; looks at so many cubes within `range` of the centre. Given up, with
    /// 0, where T is not more than `enough`.
    pub fn travel(&self, center: &Vector3<f64>, ball: f64, range: f64, enough: f64, cubes: usize) -> f64 {
        // The distances are off by a few roundoffs of the coordinates.
        let rounding = 1e-14 * (self.reach + center.norm() + range);
        let mut queue = BinaryHeap::from([Cube { away: 0.0, middle: *center, half: range, inside: None }]);
        // What is not in the first cube is farther away than that.
        let result = |away: f64| (away.min(range) * (1.0 - 1e-12) - rounding).max(0.0);
        for _ in 0..cubes {
            let Some(cube) = queue.pop() else { return result(range) };
            let distance = self.distance(&cube.middle);
            let slack = cube.half * 1.733 + rounding;
            if distance + slack < ball {
                continue;
            }
            // A sliver's nearest point may be missed by a little: the surface may be nearer than it seems, not farther.
            let near = distance * (1.0 - 1e-6) - 1e-9 * self.reach;
            let mut inside = cube.inside;
            if slack - near < ball {
                // Decided by the sign.
                let sign = inside.unwrap_or_else(|| self.contains(&cube.middle));
                if sign {
                    continue;
                }
                inside = Some(sign);
                if distance >= ball && (cube.middle - center).norm() <= enough {
                    return 0.0;
                }
            }
            if slack < 0.01 * ball {
                return result(cube.away);
            }
            let half = 0.5 * cube.half;
            for corner in 0..8 {
                let step = Vector3::from_fn(|k, _| if corner >> k & 1 == 1 { half } else { -half });
                let middle = cube.middle + step;
                let outside = (middle - center).abs().map(|x| (x - half).max(0.0));
                // As far as the surface is away, the sign stays.
                let inside = inside.filter(|_| half * 1.733 + rounding < near);
                queue.push(Cube { away: outside.norm(), middle, half, inside });
            }
        }
        result(queue.peek().map_or(range, |cube| cube.away))
    }

    /// A lower bound of T at once: s changes by no more than the way. Negative where the ball is out of B.
    pub fn stuck(&self, center: &Vector3<f64>, ball: f64) -> f64 {
        let distance = self.distance(center);
        if distance < 1e-9 * self.reach || !self.contains(center) { ball - distance } else { ball + distance }
    }
}

/// Sorts the triangles into a tree: halves along the longest side of the box around their corners.
fn build(triangles: &mut [Corners], node: usize, boxes: &mut Vec<[Vector3<f64>; 2]>) {
    let all = || triangles.iter().flatten();
    let low = all().fold(Vector3::repeat(f64::MAX), |low, p| low.inf(p));
    let high = all().fold(Vector3::repeat(f64::MIN), |high, p| high.sup(p));
    if boxes.len() <= node {
        boxes.resize(node + 1, [Vector3::zeros(); 2]);
    }
    boxes[node] = [low, high];
    if triangles.len() <= LEAF {
        return;
    }
    let axis = (high - low).imax();
    let place = |t: &Corners| t[0][axis] + t[1][axis] + t[2][axis];
    let middle = triangles.len() / 2;
    triangles.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)));
    let (left, right) = triangles.split_at_mut(middle);
    build(left, 2 * node + 1, boxes);
    build(right, 2 * node + 2, boxes);
}

/// A cube that may hold an end of the travel.
struct Cube {
    /// Its distance from the start.
    away: f64,
    middle: Vector3<f64>,
    half: f64,
    /// Is the middle inside B, where that is known?
    inside: Option<bool>,
}

impl PartialEq for Cube {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Cube {}
impl PartialOrd for Cube {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
/// The nearest is the greatest; of equally near ones the smallest.
impl Ord for Cube {
    fn cmp(&self, other: &Self) -> Ordering {
        other.away.total_cmp(&self.away).then(other.half.total_cmp(&self.half))
    }
}
