//! The distance of the surfaces, by depth-first descent into the nearer pair of boxes, with what was nearest last time as the first upper
//! bound; and whether it exceeds a number, which is cheaper.

use super::super::Feature;
use super::Pair;
use super::candidate::{Candidate, any, nearest};
use super::pairs::{open, walk};
use super::project::project;
use super::relative::Relative;
use crate::mesh::pose::is_usable;
use crate::mesh::triangle::{apart, plane_gap_squared};
use nalgebra::{Isometry3, Point3};
use std::ops::ControlFlow;

/// Nearest points of two surfaces, in the frame of B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// 0 where the surfaces meet; to rounding of the coordinates otherwise.
    pub distance: f64,
    /// On A. Where the surfaces meet, a point of a triangle that does.
    pub on_a: Point3<f64>,
    /// On B.
    pub on_b: Point3<f64>,
    /// The feature of A.
    pub feature_a: Feature,
    /// The feature of B.
    pub feature_b: Feature,
}

impl Pair<'_> {
    /// The distance of the surfaces. A body inside another has a positive one: [`Pair::collides`] knows what is inside. Then it is only an
    /// upper bound, between points of both surfaces: a solid's reentrant edges are not looked at, which from inside may be the nearest.
    pub fn distance(&mut self, pose: &Isometry3<f64>) -> Distance {
        self.counters.distance += 1;
        let origin = Point3::origin();
        let (feature_a, feature_b) = (Feature::Face(self.nearest.0), Feature::Face(self.nearest.1));
        let nothing = Distance { distance: 0.0, on_a: origin, on_b: origin, feature_a, feature_b };
        if !is_usable(pose) {
            return nothing;
        }
        let (a, b) = (self.a, self.b);
        let relative = Relative::new(pose, a, b);
        let mut best = self.first_guess(&relative);
        let stack = &mut self.bounded;
        stack.clear();
        stack.push((relative.bound(a.bvh().root(), b.bvh().root(), f64::MAX), (0, 0)));
        while let Some((bound, pair)) = stack.pop() {
            // Squared bounds below the rounding error say nothing: the triangles are looked at.
            if bound >= best.squared && bound > 0.0 {
                continue;
            }
            match open(a, b, pair) {
                Ok(both) => {
                    let [x, y] =
                        both.map(|(i, j)| (relative.bound(a.bvh().node(i), b.bvh().node(j), best.squared), (i, j)));
                    stack.extend(if x.0 < y.0 { [y, x] } else { [x, y] });
                }
                Err((s, t)) => {
                    let (on_s, on_t) = (relative.place_all(a.corners(s)), b.corners(t));
                    let gap = plane_gap_squared(&on_s, on_t);
                    if gap > best.squared {
                        continue;
                    }
                    if bound == 0.0 && !apart(&on_s, on_t, relative.doubt) {
                        self.nearest = (s, t);
                        let Candidate { on_a, on_b, .. } = any(a, b, &relative, s, t);
                        let (feature_a, feature_b) = (Feature::Face(s), Feature::Face(t));
                        return Distance { on_a, on_b, feature_a, feature_b, ..nothing };
                    }
                    let before = best.squared;
                    best = nearest(a, b, &relative, s, t, best);
                    if best.squared < before {
                        self.nearest = (s, t);
                    }
                }
            }
        }
        let Candidate { feature_a, feature_b, on_a, on_b, squared } = best;
        Distance { distance: squared.sqrt(), on_a, on_b, feature_a, feature_b }
    }

    /// An upper bound to begin with: the triangles that were nearest last, and from there projections from surface to surface to and
    /// fro as long as they get nearer.
    fn first_guess(&mut self, relative: &Relative) -> Candidate {
        let (a, b) = (self.a, self.b);
        let (s, t) = self.nearest;
        let mut best = nearest(a, b, relative, s, t, any(a, b, relative, s, t));
        for _ in 0..8 {
            let before = best.squared;
            if let Some(q) = project(b, &best.on_a, best.squared, &mut self.bounded) {
                self.nearest.1 = q.triangle;
                best = Candidate { on_b: q.point, feature_b: q.feature, squared: q.squared, ..best };
            }
            let from = relative.place_back(&best.on_b);
            if let Some(p) = project(a, &from, best.squared, &mut self.bounded) {
                self.nearest.0 = p.triangle;
                let on_a = relative.place(&p.point);
                best = Candidate { on_a, feature_a: p.feature, squared: (on_a - best.on_b).norm_squared(), ..best };
            }
            if !(best.squared < 0.99 * before) {
                break;
            }
        }
        best
    }

    /// Whether the surfaces are proved to be farther apart than `distance`, at least 0. In doubt they are not, nor where a body is inside another.
    pub fn distance_greater_than(&mut self, pose: &Isometry3<f64>, distance: f64) -> bool {
        self.counters.distance += 1;
        if !is_usable(pose) || !(distance >= 0.0) {
            return false;
        }
        let (a, b) = (self.a, self.b);
        let relative = Relative::new(pose, a, b);
        let margin = distance + 4.0 * relative.doubt;
        let near = |s, t| {
            let (on_s, on_t) = (relative.place_all(a.corners(s)), b.corners(t));
            let gap = plane_gap_squared(&on_s, on_t);
            let close = gap <= margin * margin
                && (nearest(a, b, &relative, s, t, any(a, b, &relative, s, t)).squared <= margin * margin
                    || (gap == 0.0 && !apart(&on_s, on_t, relative.doubt)));
            if close { ControlFlow::Break((s, t)) } else { ControlFlow::Continue(()) }
        };
        let (s, t) = self.nearest;
        if near(s, t).is_break() {
            return false;
        }
        if let ControlFlow::Break(pair) = walk(a, b, &relative, margin, &mut self.stack, near) {
            self.nearest = pair;
            return false;
        }
        // From inside, reentrant edges may be the nearest, which nothing has looked at.
        !self.contained(&relative)
    }
}
