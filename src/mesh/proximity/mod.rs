//! Two meshes and a relative pose: do they collide, how far are they apart, where do they touch, how far can they move.
//!
//! # What "free" means
//!
//! A pose is called free only when every pair of triangles is proved apart by an axis with a gap larger than rounding, and, for solids, no
//! component of one lies inside the other. So a free pose is free, to the last digit; touching, which
//! rounding cannot tell from overlap, counts as a collision. Rounding is some 1e-14 of the largest coordinate in the frame of B.
//!
//! A polygon soup has no inside. Against a solid it collides when one of its components is in there; two soups collide where their surfaces meet
//! ([`Pair::has_inside`]).
//!
//! # How
//!
//! All queries walk over pairs of boxes (`relative`; the test in `boxes`) and end at pairs of triangles, which are separated by axes
//! (`triangle`) or asked for the features that they own (`candidate`). The solid test adds rays (`inside`). `distance` begins with an upper
//! bound by projecting from surface to surface (`project`), `contact` keeps what lies in both normal cones, and
//! `screw` strings distances together to motions. What decided the last query of a kind is tried first in the next.
//!
//! # Poses
//!
//! A quaternion means the rotation that it is over its length. A pose that is not finite, whose quaternion is not of unit length to 1e-6, or that moves farther than
//! [`MAX_COORDINATE`](super::MAX_COORDINATE) is never free: it collides, has distance 0 and no contacts.

mod boxes;
mod candidate;
mod contact;
mod distance;
mod inside;
mod lanes;
mod pairs;
mod project;
mod relative;
mod screw;

pub use contact::Contact;
pub use distance::Distance;
pub(super) use inside::winds_around;
pub(super) use project::{Stack, descend};
pub use screw::{Impact, Screw, Stop};

use super::Mesh;
use super::pose::is_usable;
use super::triangle;
use inside::is_inside;
use nalgebra::Isometry3;
use pairs::walk;
use relative::Relative;
use std::ops::ControlFlow;

/// How many queries a pair has answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Boolean tests.
    pub collision: u64,
    /// Contact queries.
    pub contact: u64,
    /// Distances and comparisons of distances.
    pub distance: u64,
}

/// Two meshes, with the memory that queries reuse and the pairs of triangles that decided the last ones. A moves, B rests.
#[derive(Clone, Debug)]
pub struct Pair<'m> {
    a: &'m Mesh,
    b: &'m Mesh,
    stack: Vec<(u32, u32)>,
    /// Pairs of boxes with the squares of lower bounds of their distances.
    bounded: Vec<(f64, (u32, u32))>,
    /// The triangles that met last.
    met: (u32, u32),
    /// The triangles that were nearest last.
    nearest: (u32, u32),
    counters: Counters,
}

impl<'m> Pair<'m> {
    /// A pair. O(1).
    pub fn new(a: &'m Mesh, b: &'m Mesh) -> Pair<'m> {
        Pair {
            a,
            b,
            stack: Vec::with_capacity(256),
            bounded: Vec::with_capacity(256),
            met: (0, 0),
            nearest: (0, 0),
            counters: Counters::default(),
        }
    }

    /// The mesh that moves.
    pub fn a(&self) -> &'m Mesh {
        self.a
    }

    /// The mesh that rests.
    pub fn b(&self) -> &'m Mesh {
        self.b
    }

    /// Whether containment can be seen in at least one direction: A or B is a solid. Otherwise only surfaces count.
    pub fn has_inside(&self) -> bool {
        self.a.is_solid() || self.b.is_solid()
    }

    /// The queries answered so far. A query of motion counts those it consists of.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Whether the bodies overlap: the surfaces meet, or a component of one is inside the other. Touching counts.
    pub fn collides(&mut self, pose: &Isometry3<f64>) -> bool {
        self.counters.collision += 1;
        if !is_usable(pose) {
            return true;
        }
        let relative = Relative::new(pose, self.a, self.b);
        self.meet(&relative) || self.contained(&relative)
    }

    /// Whether the surfaces meet or touch, whatever is inside.
    pub fn surfaces_meet(&mut self, pose: &Isometry3<f64>) -> bool {
        self.counters.collision += 1;
        !is_usable(pose) || self.meet(&Relative::new(pose, self.a, self.b))
    }

    fn meet(&mut self, relative: &Relative) -> bool {
        let (a, b) = (self.a, self.b);
        let touch = |s, t| !triangle::apart(&relative.place_all(a.corners(s)), b.corners(t), relative.doubt);
        if touch(self.met.0, self.met.1) {
            return true;
        }
        let found = walk(a, b, relative, 0.0, &mut self.stack, |s, t| {
            if touch(s, t) { ControlFlow::Break((s, t)) } else { ControlFlow::Continue(()) }
        });
        match found {
            ControlFlow::Break(pair) => {
                self.met = pair;
                true
            }
            ControlFlow::Continue(()) => false,
        }
    }

    /// For surfaces that do not meet: whether a component of one is inside the other. Then all of it is, so its extreme vertices are
    /// asked about the bounding box first, and one of them about the solid.
    fn contained(&mut self, relative: &Relative) -> bool {
        let (a, b) = (self.a, self.b);
        let inside = |host: &Mesh, guest: &Mesh, place: &dyn Fn(u32) -> nalgebra::Point3<f64>, stack: &mut Vec<_>| {
            host.is_solid()
                && guest.extremes().iter().any(|six| {
                    six.iter().all(|&v| host.is_in_bounds(&place(v), relative.doubt))
                        && is_inside(host, &place(six[0]), stack)
                })
        };
        inside(b, a, &|v| relative.place(&a.vertices()[v as usize]), &mut self.stack)
            || inside(a, b, &|v| relative.place_back(&b.vertices()[v as usize]), &mut self.stack)
    }
}
