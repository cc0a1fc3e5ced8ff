//! Which pieces: the whole solid where it is convex; else polytopes grown from the centres of maximal inscribed balls, largest ball
//! first, wherever no piece covers the ball yet: at first half of it, so that every part of the solid has a piece, then nearly all of it.

use super::cell::Plane;
use super::grow::{Grown, grow, metric_of};
use super::piece::{Piece, prove};
use super::solid::Solid;
use nalgebra::{Matrix3, Vector3};

/// How thoroughly a solid is filled with pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// No new pieces beyond so many. Default 384.
    pub max_pieces: usize,
    /// Surface points to look for inscribed balls from. Default 2000.
    pub samples: usize,
    /// A ball is covered when this share of its radius is in one piece. Default 0.9.
    pub cover: f64,
    /// Times that a piece is grown anew in its own metric. Default 3.
    pub rounds: usize,
}

impl Default for BuildOptions {
    fn default() -> Self {
        BuildOptions { max_pieces: 384, samples: 2000, cover: 0.9, rounds: 3 }
    }
}

/// A triangle's own plane is taken when its distance is at least this share of the point's: pieces with the solid's own faces.
const SNAP: f64 = 0.3;
/// Only where that makes no difference up to rounding: pieces with tangent planes.
const TIES: f64 = 0.999;
/// Corners nearer to one another than this share of the inradius are one.
const NEAR: f64 = 0.1;
/// A piece that sticks out of another by less than this share of its inradius is not kept.
const HAIR: f64 = 0.01;

/// A piece and the planes that bound it, relative to its middle.
struct Bounded {
    piece: Piece,
    planes: Vec<Plane>,
}

impl Bounded {
    fn covers(&self, center: &Vector3<f64>, radius: f64) -> bool {
        let p = center - self.piece.middle;
        self.planes.iter().all(|plane| plane.height(&p) <= -radius)
    }

    /// Is the other piece inside of this one, but for a hair?
    fn holds(&self, other: &Piece) -> bool {
        let hair = HAIR * other.inradius;
        other.corners.iter().all(|&p| self.covers(&Vector3::from(p), -hair))
    }
}

/// The whole solid, when it is convex.
pub(super) fn whole(solid: &Solid) -> Option<Piece> {
    let (vertices, triangles) = (solid.mesh.vertices(), solid.mesh.triangles());
    let count = triangles.len() as f64 * 3.0;
    let middle = solid.corners().flatten().map(|p| p / count).sum::<Vector3<f64>>();
    let mut used = vec![false; vertices.len()];
    triangles.iter().flatten().for_each(|&i| used[i as usize] = true);
    let corners: Vec<_> = vertices.iter().zip(used).filter(|(_, used)| *used).map(|(p, _)| p.coords - middle).collect();
    prove(solid, middle, &corners, &[])
}

/// The pieces of a solid; one if it is convex.
pub(super) fn pieces(solid: &Solid, options: &BuildOptions) -> Vec<Piece> {
    let mut pieces = match whole(solid) {
        Some(piece) => vec![piece],
        None => cover(solid, options),
    };
    pieces.iter_mut().for_each(Piece::fill);
    pieces
}

fn cover(solid: &Solid, options: &BuildOptions) -> Vec<Piece> {
    let mut balls = inscribed_balls(solid, options.samples);
    balls.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut found: Vec<Bounded> = Vec::new();
    for share in [0.5 * options.cover, options.cover] {
        for &(center, radius) in &balls {
            if found.len() >= options.max_pieces {
                break;
            }
            if found.iter().any(|b| b.covers(&center, share * radius)) {
                continue;
            }
            for snap in [SNAP, TIES] {
                for grown in around(solid, center, options.rounds, snap) {
                    if let Some(new) = bounded(solid, &grown)
                        && !found.iter().any(|old| old.holds(&new.piece))
                    {
                        found.retain(|old| !new.holds(&old.piece));
                        found.push(new);
                    }
                }
            }
        }
    }
    found.into_iter().map(|b| b.piece).collect()
}

/// The polytopes around a seed: the first, and the largest of those in its own metric.
fn around(solid: &Solid, center: Vector3<f64>, rounds: usize, snap: f64) -> Vec<Grown> {
    let Some(first) = grow(solid, center, &Matrix3::identity(), snap) else { return Vec::new() };
    let mut best: Option<(f64, Grown)> = None;
    let mut moments = first.cell.moments();
    let mut seed = first.seed;
    for _ in 0..rounds {
        seed += moments.centroid;
        let Some(metric) = metric_of(&moments.covariance) else { break };
        let Some(next) = grow(solid, seed, &metric, snap) else { break };
        moments = next.cell.moments();
        if best.as_ref().is_none_or(|(volume, _)| moments.volume > *volume) {
            best = Some((moments.volume, next));
        }
    }
    [Some(first), best.map(|(_, grown)| grown)].into_iter().flatten().collect()
}

fn bounded(solid: &Solid, grown: &Grown) -> Option<Bounded> {
    let corners = grown.cell.corners(NEAR * grown.inradius());
    let piece = prove(solid, grown.seed, &corners, &grown.planes)?;
    Some(Bounded { piece, planes: grown.planes.clone() })
}

/// Maximal balls that touch the surface in points spread evenly over it.
fn inscribed_balls(solid: &Solid, count: usize) -> Vec<(Vector3<f64>, f64)> {
    let normals: Vec<_> = solid.corners().map(|[a, b, c]| (b - a).cross(&(c - a)) * 0.5).collect();
    let total: f64 = normals.iter().map(|n| n.norm()).sum();
    let mut balls = Vec::new();
    let (mut passed, mut next) = (0.0, 0);
    for ([a, b, c], n) in solid.corners().zip(&normals) {
        let area = n.norm();
        passed += area;
        while next < count && (next as f64 + 0.5) * total <= passed * count as f64 {
            // Points of a Kronecker sequence, folded into the triangle.
            let (s, t) =
                ((next as f64 * 0.754_877_666_246_692_7).fract(), (next as f64 * 0.569_840_290_998_053_2).fract());
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            next += 1;
            let p = a + (b - a) * s + (c - a) * t;
            balls.extend(touching(solid, &p, &(-n / area)));
        }
    }
    balls
}

/// The largest ball inside that touches the surface at `p` from the inward direction (Ma, Bae and Choi 2012): shrunk to the
/// nearest surface point until there is none inside.
fn touching(solid: &Solid, p: &Vector3<f64>, inward: &Vector3<f64>) -> Option<(Vector3<f64>, f64)> {
    let mut radius = solid.radius;
    for _ in 0..32 {
        let center = p + inward * radius;
        let (q, squared) = solid.nearest(&center);
        if squared >= radius * radius * 0.98 {
            return Some((center, squared.sqrt()));
        }
        let chord = q - p;
        let height = 2.0 * chord.dot(inward);
        radius = if height > 0.0 { (chord.norm_squared() / height).min(radius * 0.9) } else { radius * 0.5 };
        if !(radius > 1e-4 * solid.radius) {
            return None;
        }
    }
    None
}
