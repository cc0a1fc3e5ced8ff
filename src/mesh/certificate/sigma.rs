//! From a pair's depth to a lower bound of the object norm.
//!
//! Let r = x - c be a point of A from the centre of mass, K = inertia / volume, and let a motion be a translation t of the centre and a rotation with
//! quaternion q; w = 2 q_vec. Then sigma = |t|^2 + w.K w, and x moves by
//!
//! ```text
//! t + q_0 w x r + w x (w x r) / 2,      a vector of length <= |t| + |w x r|
//! ```
//!
//! When the motion separates the pieces, some unit u has all of A's piece at the end below all of B's, so every point x of the piece has moved
//! at least m = u.x - min u.B_j against u. With K^-1 = W^T W and s = sqrt(sigma), Cauchy's inequality bounds that movement in two ways:
//!
//! ```text
//! m <= s k(x),                          k(x)^2 = 1 + the largest eigenvalue of W (|r|^2 - r r^T) W^T
//! m <= s k(x, u) + s^2 l(x, u) / 2,     k(x, u)^2 = 1 + |W (r x u)|^2,
//!                                       l = the largest eigenvalue of W ((u.r) - (u r^T + r u^T) / 2) W^T, or 0
//! ```
//!
//! (the second is much stronger where r is along u: turning moves such a point sideways). Each gives a lower bound of s for this u, and any x of the piece may
//! be chosen; for the middle of a ball inside the piece, m grows by its radius. So
//!
//! ```text
//! s >= min over u of max over x of the better bound
//! ```
//!
//! The minimum is taken by branch and bound over spherical triangles. In one with corners u_c every direction is f / |f| with a convex
//! combination f of the u_c. Multiplied by |f| <= 1, m becomes linear in f, k at most the convex (1 + |W (r x f)|^2)^(1/2) and l convex, so that
//! the least m and the largest k and l of the three corners bound all of the triangle.

use super::super::triangle::nearest_to_origin;
use super::piece::Piece;
use crate::scalar::Real;
use nalgebra::{Matrix3, Point3, Vector3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::fmt;

/// The inertia is not finite, not positive definite, or worse conditioned than 1e10.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InertiaError;

impl fmt::Display for InertiaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the inertia is not finite, not positive definite, or worse conditioned than 1e10")
    }
}

impl std::error::Error for InertiaError {}

/// How far unit sigma moves the points of A's pieces.
#[derive(Clone, Debug)]
pub(super) struct Lever {
    center: Vector3<f64>,
    /// W, with K^-1 = W^T W.
    root: Matrix3<f64>,
    /// 1 + a bound of the relative rounding error of k and l.
    slack: f64,
    pieces: Vec<Arms>,
}

/// The balls of a piece.
#[derive(Clone, Debug)]
struct Arms {
    /// From the centre of mass to the ball's centre, its radius, k there.
    arms: Vec<(Vector3<f64>, f64, f64)>,
    /// About the least k.
    least: f64,
    /// The largest k on the piece.
    most: f64,
}

/// Most corners that are looked at: any selection of points of the pieces proves a bound.
const MOST_CORNERS: usize = 128;

/// A selection of corners, evenly.
pub(super) fn selected(corners: &[[f64; 3]]) -> impl Iterator<Item = Vector3<f64>> + '_ {
    corners.iter().step_by(corners.len().div_ceil(MOST_CORNERS).max(1)).map(|&p| Vector3::from(p))
}

/// The largest eigenvalue of a symmetric matrix, rounded up: the closed form, whose arc cosine costs half the digits.
fn largest_eigenvalue(m: &Matrix3<f64>) -> f64 {
    let mean = m.trace() / 3.0;
    let rest = m - Matrix3::from_diagonal_element(mean);
    let size = (rest.norm_squared() / 6.0).sqrt();
    if !(size > 0.0) {
        return mean;
    }
    let cosine = ((rest / size).determinant() / 2.0).clamp(-1.0, 1.0);
    mean + 2.0 * size * (cosine.acos() / 3.0).cos() + 1e-7 * size
}

impl Lever {
    pub fn new(pieces: &[Piece], center: &Point3<f64>, inertia: &Matrix3<f64>) -> Result<Self, InertiaError> {
        let symmetric = (inertia + inertia.transpose()) * 0.5;
        let scale = symmetric.trace();
        if !(scale > 0.0 && scale.is_finite() && center.iter().all(|x| x.is_finite())) {
            return Err(InertiaError);
        }
        let lower = (symmetric / scale).cholesky().ok_or(InertiaError)?.l();
        let unit = lower.try_inverse().ok_or(InertiaError)?;
        let condition = unit.norm_squared();
        if !(condition < 1e10) {
            return Err(InertiaError);
        }
        let mut lever = Lever {
            center: center.coords,
            root: unit / scale.sqrt(),
            slack: 1.0 + 64.0 * f64::ROUNDOFF * condition,
            pieces: Vec::new(),
        };
        lever.pieces = pieces.iter().map(|piece| lever.arms(piece)).collect();
        Ok(lever)
    }

    fn arms(&self, piece: &Piece) -> Arms {
        let arm = |x: Vector3<f64>, ball: f64| (x - self.center, ball, self.most(&x));
        let mut arms = vec![arm(piece.middle, piece.inradius)];
        arms.extend(piece.balls.iter().map(|&(x, radius)| arm(x, radius)));
        arms.extend(selected(&piece.corners).map(|x| arm(x, 0.0)));
        let least = arms.iter().map(|arm| arm.2).fold(f64::MAX, f64::min);
        let most = piece.corners.iter().map(|&p| self.most(&p.into())).fold(1.0, f64::max);
        Arms { arms, least, most }
    }

    /// k(x).
    fn most(&self, x: &Vector3<f64>) -> f64 {
        let r = x - self.center;
        let m =
            self.root * (Matrix3::from_diagonal_element(r.norm_squared()) - r * r.transpose()) * self.root.transpose();
        (1.0 + largest_eigenvalue(&m).max(0.0)).sqrt() * self.slack
    }

    /// Squared k(x, u) - 1, also for u of another length.
    fn turning(&self, r: &Vector3<f64>, u: &Vector3<f64>) -> f64 {
        (self.root * r.cross(u)).norm_squared()
    }

    /// l(x, u).
    fn curvature(&self, r: &Vector3<f64>, u: &Vector3<f64>) -> f64 {
        let (wu, wr) = (self.root * u, self.root * r);
        let mixed = wu * wr.transpose();
        let m = self.root * self.root.transpose() * u.dot(r) - (mixed + mixed.transpose()) * 0.5;
        // The terms may cancel.
        (largest_eigenvalue(&m) + 1e-12 * (self.root.norm_squared() * r.norm() + wu.norm() * wr.norm())).max(0.0)
    }

    /// About the smallest k on a piece.
    pub fn least(&self, piece: usize) -> f64 {
        self.pieces.get(piece).map_or(1.0, |arms| arms.least)
    }

    /// k of a piece's middle.
    pub fn of_middle(&self, piece: usize) -> f64 {
        self.pieces.get(piece).and_then(|arms| arms.arms.first()).map_or(f64::MAX, |arm| arm.2)
    }

    /// The largest k on a piece.
    pub fn largest(&self, piece: usize) -> f64 {
        self.pieces.get(piece).map_or(f64::MAX, |arms| arms.most)
    }

    /// k(x, u).
    pub fn along(&self, x: &Vector3<f64>, u: &Vector3<f64>) -> f64 {
        (1.0 + self.turning(&(x - self.center), u)).sqrt()
    }
}

/// A spherical triangle and the bound there.
struct Cell {
    lower: f64,
    corners: [Vector3<f64>; 3],
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
/// The lowest bound is the greatest cell.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

/// A pair of pieces in A's frame, measured from A's centre of mass.
pub(super) struct Separation<'q> {
    lever: &'q Lever,
    arms: &'q Arms,
    /// Points of B's piece.
    b: Vec<Vector3<f64>>,
    /// What rounding may have added to m.
    margin: f64,
}

impl<'q> Separation<'q> {
    /// `b`: points of B's piece in A's frame. `margin` bounds their error and that of a difference of points.
    pub fn new(lever: &'q Lever, piece: usize, b: impl Iterator<Item = Vector3<f64>>, margin: f64) -> Option<Self> {
        let arms = lever.pieces.get(piece)?;
        let margin = margin + 16.0 * f64::ROUNDOFF * lever.center.norm();
        Some(Separation { lever, arms, b: b.map(|p| p - lever.center).collect(), margin })
    }

    /// sqrt(sigma) is not less, as far as `cells` triangles tell; given up where it will not be above `enough`.
    pub fn bound(&self, cells: usize, enough: f64) -> f64 {
        let mut queue = BinaryHeap::new();
        // No bound of this pair will be above.
        let mut ceiling = f64::MAX;
        for signs in 0..8 {
            let corner = |k: usize| Vector3::ith(k, if signs >> k & 1 == 1 { 1.0 } else { -1.0 });
            queue.push(self.cell([corner(0), corner(1), corner(2)], 0.0, &mut ceiling));
        }
        for _ in 0..cells / 4 {
            let Some(Cell { lower, corners: [a, b, c] }) = queue.pop() else { break };
            if lower >= 0.995 * ceiling || ceiling <= enough {
                return lower * (1.0 - 1e-12);
            }
            let [ab, bc, ca] = [a + b, b + c, c + a].map(|v| v.normalize());
            for corners in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
                queue.push(self.cell(corners, lower, &mut ceiling));
            }
        }
        queue.peek().map_or(0.0, |cell| cell.lower * (1.0 - 1e-12))
    }

    /// The bound in a triangle by the balls of A that are best in its middle; not less than `known`.
    fn cell(&self, corners: [Vector3<f64>; 3], known: f64, ceiling: &mut f64) -> Cell {
        let u = (corners[0] + corners[1] + corners[2]).normalize();
        let lowest = self.b.iter().map(|p| (u.dot(p), p)).min_by(|x, y| x.0.total_cmp(&y.0));
        let Some((floor, y)) = lowest else { return Cell { lower: known, corners } };
        // The best by k(x), and by k(x, u).
        let (mut round, mut straight) = ((f64::MIN, 0), (f64::MIN, 0));
        for (index, (r, ball, k)) in self.arms.arms.iter().enumerate() {
            let m = u.dot(r) - floor + ball;
            if m / k > round.0 {
                round = (m / k, index);
            }
            // Not worth a root where k(x, u) = 1 would not do.
            if m > straight.0 {
                let value = m / (1.0 + self.lever.turning(r, &u)).sqrt();
                if value > straight.0 {
                    straight = (value, index);
                }
            }
        }
        let shrink = nearest_to_origin(&corners).norm() * (1.0 - 1e-12);
        let (mut lower, mut here) = (known, 0.0);
        for (_, index) in [round, straight] {
            lower = self.by_ball(index, y, &corners, shrink, lower);
            here = self.by_ball(index, y, &[u], 1.0, here);
        }
        *ceiling = ceiling.min(here);
        Cell { lower, corners }
    }

    /// The better of `known` and both bounds from a ball of A, for all directions in the cone of `corners`. `shrink`: the
    /// least norm of a convex combination of them.
    fn by_ball(&self, index: usize, y: &Vector3<f64>, corners: &[Vector3<f64>], shrink: f64, known: f64) -> f64 {
        let Some((r, ball, k)) = self.arms.arms.get(index) else { return known };
        let apart = r - y;
        let height = corners.iter().map(|u| u.dot(&apart)).fold(f64::MAX, f64::min);
        let m = height + ball * shrink - self.margin;
        if !(m > 0.0) {
            return known;
        }
        let known = known.max(m / k);
        let turning = corners.iter().map(|u| self.lever.turning(r, u)).fold(0.0, f64::max);
        let linear = (1.0 + turning).sqrt() * self.lever.slack;
        if m <= known * linear {
            return known;
        }
        let curvature = corners.iter().map(|u| self.lever.curvature(r, u)).fold(0.0, f64::max) * self.lever.slack;
        known.max(2.0 * m / (linear + (linear * linear + 2.0 * curvature * m).sqrt()))
    }
}
