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

use super::super::Mesh;
use super::super::proximity::{Stack, winds_around};
use super::piece::Piece;
use super::solid::{corners, look_around};
use nalgebra::{Point3, Vector3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// A surface, and balls inside.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    mesh: Arc<Mesh>,
    /// Balls that are known to be inside.
    balls: Vec<(Vector3<f64>, f64)>,
    /// Largest norm of a vertex.
    reach: f64,
}

/// Memory of the questions about one point after the other.
#[derive(Default)]
struct Stacks {
    near: Stack,
    inside: Vec<(u32, u32)>,
}

impl Surface {
    pub fn new(mesh: Arc<Mesh>, pieces: &[Piece]) -> Self {
        let balls = pieces.iter().map(|piece| (piece.middle, piece.inradius)).collect();
        let reach = corners(&mesh).flatten().map(|p| p.norm()).fold(0.0, f64::max);
        Surface { mesh, balls, reach }
    }

    /// Largest norm of a vertex.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The distance from the surface.
    fn distance(&self, p: &Vector3<f64>, stacks: &mut Stacks) -> f64 {
        let mut best = f64::MAX;
        look_around(&self.mesh, p, &mut stacks.near, |_, q| {
            best = best.min(q.norm_squared());
            best
        });
        best.sqrt()
    }

    /// Is the point, which is not near the surface, inside? The winding number is asked last.
    fn contains(&self, p: &Vector3<f64>, stacks: &mut Stacks) -> bool {
        self.balls.iter().any(|(center, radius)| (p - center).norm() < *radius)
            || winds_around(&self.mesh, &Point3::from(*p), &mut stacks.inside)
    }

    /// T is not less, for the ball of radius `ball` about `center`; looks at so many cubes within `range` of the centre. Given up, with
    /// 0, where T is not more than `enough`.
    pub fn travel(&self, center: &Vector3<f64>, ball: f64, range: f64, enough: f64, cubes: usize) -> f64 {
        // The distances are off by a few roundoffs of the coordinates.
        let rounding = 1e-14 * (self.reach + center.norm() + range);
        let mut stacks = Stacks::default();
        let mut queue = BinaryHeap::from([Cube { away: 0.0, middle: *center, half: range, inside: None }]);
        // What is not in the first cube is farther away than that.
        let result = |away: f64| (away.min(range) * (1.0 - 1e-12) - rounding).max(0.0);
        for _ in 0..cubes {
            let Some(cube) = queue.pop() else { return result(range) };
            let distance = self.distance(&cube.middle, &mut stacks);
            let slack = cube.half * 1.733 + rounding;
            if distance + slack < ball {
                continue;
            }
            // A sliver's nearest point may be missed by a little: the surface may be nearer than it seems, not farther.
            let near = distance * (1.0 - 1e-6) - 1e-9 * self.reach;
            let mut inside = cube.inside;
            if slack - near < ball {
                // Decided by the sign.
                let sign = inside.unwrap_or_else(|| self.contains(&cube.middle, &mut stacks));
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
        let mut stacks = Stacks::default();
        let distance = self.distance(center, &mut stacks);
        if distance < 1e-9 * self.reach || !self.contains(center, &mut stacks) {
            ball - distance
        } else {
            ball + distance
        }
    }
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
