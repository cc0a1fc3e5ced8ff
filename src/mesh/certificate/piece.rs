//! A convex piece with the proof that it is inside.
//!
//! A convex set that does not meet the surface and has one point inside is inside altogether. For every triangle a plane is
//! found with all corners of the piece strictly below and the triangle strictly above it, rounding included; the piece is first shrunk
//! about its middle by as little as that takes. A piece that cannot be proved is not used.

use super::cell::Plane;
use super::solid::Solid;
use crate::qset::Ball;
use crate::query::Options;
use crate::scalar::Real;
use crate::solver::workspace::Workspace;
use crate::support::{Points, Support};
use nalgebra::Vector3;

/// A convex polytope inside a solid.
#[derive(Clone, Debug)]
pub struct Piece {
    pub(super) corners: Vec<[f64; 3]>,
    pub(super) middle: Vector3<f64>,
    /// The piece is within this distance of its middle, rounded up.
    pub(super) radius: f64,
    /// The piece holds the ball of this radius about the middle.
    pub(super) inradius: f64,
    /// More balls that the piece holds.
    pub(super) balls: Vec<(Vector3<f64>, f64)>,
}

impl Piece {
    /// The corners, in the mesh's frame.
    #[must_use]
    pub fn corners(&self) -> &[[f64; 3]] {
        &self.corners
    }

    /// Finds balls on the way from the middle to spread corners and to the middles between them (of a box: to corners, edges and
    /// faces).
    pub(super) fn fill(&mut self) {
        let corners: Vec<_> = self.corners.iter().map(|&p| Vector3::from(p)).collect();
        let spread = spread(&corners, &self.middle);
        let between = |(k, p): (usize, &Vector3<f64>)| spread[k..].iter().map(|q| (p + q) * 0.5).collect::<Vec<_>>();
        let mut aims: Vec<Vector3<f64>> = Vec::new();
        for aim in spread.iter().enumerate().flat_map(between) {
            let near = 0.2 * self.inradius;
            if aims.iter().chain([&self.middle]).all(|p| (p - aim).norm() > near) {
                aims.push(aim);
            }
        }
        for (aim, share) in aims.iter().flat_map(|aim| STEPS.map(|share| (aim, share))) {
            let center = self.middle + (aim - self.middle) * share;
            let radius = inradius(&center, &corners);
            if radius > LEAST_BALL * self.inradius {
                self.balls.push((center, radius));
            }
        }
    }

    /// How far it reaches along u, and the corner that does.
    pub(super) fn farthest(&self, u: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let heights = self.corners.iter().map(|&p| u.x * p[0] + u.y * p[1] + u.z * p[2]);
        let best = heights.enumerate().fold((f64::MIN, 0), |best, (k, h)| if h > best.0 { (h, k) } else { best });
        (best.0, self.corners.get(best.1).map_or(self.middle, |&p| p.into()))
    }
}

/// Corners that balls are looked for towards.
const SPREAD: usize = 8;
/// Shares of the way from the middle.
const STEPS: [f64; 3] = [0.3, 0.6, 0.85];
/// Balls smaller than this share of the inradius are not kept.
const LEAST_BALL: f64 = 0.05;

/// What the piece is shrunk by, about its middle: tried in this order.
const SHRINK: [f64; 6] = [1e-13, 1e-11, 1e-9, 1e-7, 1e-5, 1e-3];

/// The hull of `corners` (relative to `middle`), shrunk until it is proved to be inside. `planes` (relative to `middle`) are likely to separate it from
/// the surface.
pub(super) fn prove(solid: &Solid, middle: Vector3<f64>, corners: &[Vector3<f64>], planes: &[Plane]) -> Option<Piece> {
    if corners.len() < 4 || !solid.contains(&middle) || !(solid.nearest(&middle).1.sqrt() > 1e-10 * solid.radius) {
        return None;
    }
    for shrink in SHRINK {
        let placed: Vec<_> = corners.iter().map(|p| middle + p * (1.0 - shrink)).collect();
        if is_apart(solid, &middle, &placed, planes) {
            let radius = placed.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max) * (1.0 + 1e-14);
            // Above 0 this also proves that the middle is inside the piece.
            let inradius = inradius(&middle, &placed);
            if !(inradius > 0.0) {
                return None;
            }
            return Some(Piece {
                corners: placed.iter().map(|&p| p.into()).collect(),
                middle,
                radius,
                inradius,
                balls: Vec::new(),
            });
        }
    }
    None
}

/// Does some plane strictly separate the hull of `corners` from every triangle?
fn is_apart(solid: &Solid, middle: &Vector3<f64>, corners: &[Vector3<f64>], planes: &[Plane]) -> bool {
    // Differences to the middle are exact up to one rounding; a product of them with a normal n loses less than 3 u |n| |x|.
    let relative: Vec<_> = corners.iter().map(|p| p - middle).collect();
    let radius = relative.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let top = |n: &Vector3<f64>| relative.iter().map(|p| n.dot(p)).fold(f64::MIN, f64::max);
    let roundoff = 16.0 * f64::ROUNDOFF;
    let apart = |n: &Vector3<f64>, top: f64, triangle: &[Vector3<f64>; 3]| {
        triangle.iter().all(|p| n.dot(p) - top > roundoff * n.norm() * (radius + p.norm()))
    };
    let tops: Vec<_> = planes.iter().map(|plane| top(&plane.normal)).collect();
    let mut last = 0;
    solid.corners().all(|t| {
        let t = t.map(|p| p - middle);
        let by = |k: usize| planes.get(k).zip(tops.get(k)).is_some_and(|(plane, &top)| apart(&plane.normal, top, &t));
        if by(last) {
            return true;
        }
        if let Some(found) = (0..planes.len()).find(|&k| by(k)) {
            last = found;
            return true;
        }
        let own = (t[1] - t[0]).cross(&(t[2] - t[0]));
        [own, -own].iter().any(|n| apart(n, top(n), &t))
    })
}

/// A few corners: each the farthest from those before it, the first from the middle.
fn spread(corners: &[Vector3<f64>], middle: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let mut distances: Vec<f64> = corners.iter().map(|p| (p - middle).norm()).collect();
    let mut chosen: Vec<Vector3<f64>> = Vec::new();
    while chosen.len() < SPREAD {
        let far = corners.iter().zip(&distances).max_by(|x, y| x.1.total_cmp(y.1));
        let Some((&next, &distance)) = far else { break };
        if !(distance > 0.0) {
            break;
        }
        for (p, d) in corners.iter().zip(&mut distances) {
            *d = if chosen.is_empty() { (p - next).norm() } else { d.min((p - next).norm()) };
        }
        chosen.push(next);
    }
    chosen
}

/// The radius of the largest ball about `middle` in the hull of `corners`, rounded down: d_Q for the unit ball.
fn inradius(middle: &Vector3<f64>, corners: &[Vector3<f64>]) -> f64 {
    let relative: Vec<[f64; 3]> = corners.iter().map(|p| (p - middle).into()).collect();
    let Ok(hull) = Points::new(&relative) else { return 0.0 };
    let mut memory = Box::new(Workspace::<f64, 3, 256, 512>::new());
    let options = Options { relative: 1e-2, ..Options::default() };
    // The differences are rounded once.
    let rounding = 4.0 * f64::ROUNDOFF * hull.extent();
    (memory.solver().solve_by_expansion(&hull, &Ball::unit(), &options).lower - rounding).max(0.0)
}
