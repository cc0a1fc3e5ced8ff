//! HULLS OF TWO BODIES
//!
//! The convex hull of two bodies, each in its pose: a tapered capsule is that of two spheres, a frustum of two cylinders of half height
//! 0, a swept shape of one shape in two poses. (Bullet: btConvexHullShape of both, or btMultiSphereShape; geometry: a join.) The
//! smaller of the two radii stays a ball, and is exact. Joins may be joined again. Where both bodies turn about the z axis of the join's frame (identity rotations and
//! translations along z), so does the join, and two bodies on one axis are a plane problem.

use super::*;

/// The convex hull of two bodies, in a common frame: that of the body which is made of it. They must outlive it; that which
/// has changed must be made anew.
#[repr(C)]
pub struct qdist_join_f64 {
    pub a: In<qdist_body_f64>,
    pub b: In<qdist_body_f64>,
}

impl Joined<3> for qdist_join_f64 {
    type Body = qdist_body_f64;
    fn bodies(&self) -> [&In<qdist_body_f64>; 2] {
        [&self.a, &self.b]
    }
}

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
///
/// Status: those of a body (join->a, join->b), and NONFINITE (their extent is not finite, as found out by asking); UNBOUNDED (one is a half
/// space).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_join_f64(body: Out<qdist_body_f64>, join: In<qdist_join_f64>) -> qdist_status {
    status(Joined::fill(body, join))
}
