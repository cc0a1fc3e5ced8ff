//! BODIES IN THE PLANE
//!
//! All that qdist_depth3 does in space, in the plane: discs, boxes, ellipses, capsules, polygons, half planes, hulls of two bodies, and support
//! functions of your own. The solver is one of dimension 2; for polygons of m and n vertices, m + n vertices and as many facets
//! suffice; for two ellipses and the default tolerance 64 and 64 nearly always, 128 and 128 in all of 60,000 random pairs
//! (`cargo run --release --example memory --features std`). Results are those of space, with 0 as the third numbers.
//!
//! A pose has a 2 x 2 matrix, as one in space has a 3 x 3 matrix, and not an angle, whose sine and cosine would be rounded here, each in its own
//! way: write { c, -s, s, c } for the cosine and sine that you have.

use super::*;
use qdist::support::{BoxShape, Capsule, Ellipsoid, HalfSpace, ShapeError, Sphere};

/// A set in the plane with a pose: x -> rotation * x + translation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_body2_f64 {
    /// The set, in the body's frame.
    pub set: qdist_set_f64,
    /// Row-major: { c, -s, s, c } for cosine c and sine s. A rotation to within 1e-4; used as it is given.
    pub rotation: [f64; 4],
    /// Position of the body's frame in the world.
    pub translation: [f64; 2],
    /// As in qdist_body_f64.
    pub center: [f64; 2],
    pub rolling_radius: f64,
    pub spread: f64,
    pub extents: [f64; 2],
    pub errors: [f64; 2],
    /// NULL; what qdist_body2_half_plane puts here answers in place of the support function. Not for functions of your own.
    pub unbounded: qdist_unbounded,
    /// As in qdist_body_f64.
    pub precise: qdist_precise_f64,
}
gaps!(qdist_body2_f64, set.contains_origin..rotation, errors..unbounded, precise..);

/// All points within `radius` of the origin.
#[repr(C)]
pub struct qdist_disc_f64 {
    pub radius: f64,
}

/// |x| <= half[0], |y| <= half[1].
#[repr(C)]
pub struct qdist_box2_f64 {
    pub half: [f64; 2],
}

/// The ellipse with these semi axes along x and y.
#[repr(C)]
pub struct qdist_ellipse_f64 {
    pub semi_axes: [f64; 2],
}

/// All points within `radius` of the segment from (0, -half_height) to (0, half_height).
#[repr(C)]
pub struct qdist_capsule2_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// The points x with normal . x <= offset. The normal points out of the half plane; it need not be of unit length, but not 0.
#[repr(C)]
pub struct qdist_half_plane_f64 {
    pub normal: [f64; 2],
    pub offset: f64,
}

/// The convex hull of two bodies, as qdist_join_f64.
#[repr(C)]
pub struct qdist_join2_f64 {
    pub a: In<qdist_body2_f64>,
    pub b: In<qdist_body2_f64>,
}

shape!(qdist_disc_f64, 2, Sphere<f64, 2>, |s| s.radius);
shape!(qdist_box2_f64, 2, BoxShape<f64, 2>, |s| Vector::from(s.half));
shape!(qdist_ellipse_f64, 2, Ellipsoid<f64, 2>, |s| Vector::from(s.semi_axes));
shape!(qdist_capsule2_f64, 2, Capsule<f64, 2>, |s| s.radius, s.half_height);

placed!(qdist_body2_f64, 2, [1.0, 0.0, 0.0, 1.0]);

impl Joined<2> for qdist_join2_f64 {
    type Body = qdist_body2_f64;
    fn bodies(&self) -> [&In<qdist_body2_f64>; 2] {
        [&self.a, &self.b]
    }
}

impl Half<2> for qdist_half_plane_f64 {
    type Body = qdist_body2_f64;
    fn set(&self) -> Check<HalfSpace<f64, 2>> {
        HalfSpace::new(Vector::from(self.normal), self.offset).map_err(from_shape)
    }
}

/// Makes a body of a disc, in the identity pose, like all that follow.
///
/// Status: ARGUMENT (the radius negative), NONFINITE (the radius NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_disc_f64(body: Out<qdist_body2_f64>, shape: In<qdist_disc_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a box.
///
/// Status: ARGUMENT (a half size negative), NONFINITE (a half size NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_box_f64(body: Out<qdist_body2_f64>, shape: In<qdist_box2_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of an ellipse.
///
/// Status: ARGUMENT (a semi axis negative), NONFINITE (a semi axis NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_ellipse_f64(body: Out<qdist_body2_f64>, shape: In<qdist_ellipse_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a capsule.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_capsule_f64(body: Out<qdist_body2_f64>, shape: In<qdist_capsule2_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of the convex hull of a list of points of dimension 2, in any order: a convex polygon. Reads all of them.
///
/// Status: DIMENSION (shape->dimension is not 2), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_points_f64(body: Out<qdist_body2_f64>, shape: In<qdist_points_f64>) -> qdist_status {
    status(fill_points(body, shape))
}

/// Makes a body of any set of dimension 2. Checks and copies the set; what it points to must outlive the body.
///
/// Status: those of a set (set).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_set_f64(body: Out<qdist_body2_f64>, set: In<qdist_set_f64>) -> qdist_status {
    status(Placed::of_set(body, set))
}

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
///
/// Status: as of qdist_body_join.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_join_f64(body: Out<qdist_body2_f64>, join: In<qdist_join2_f64>) -> qdist_status {
    status(Joined::fill(body, join))
}

/// Makes a body of a half plane, as qdist_body_half_space in space. Numbers are read at every query.
///
/// Status: ARGUMENT (the normal is 0), NONFINITE (normal or offset).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body2_half_plane_f64(
    body: Out<qdist_body2_f64>,
    shape: In<qdist_half_plane_f64>,
) -> qdist_status {
    status(Half::fill(body, shape))
}

/// Penetration depth or distance of two bodies in the plane, with witness points. A and B may be the same body. The solver is
/// one of dimension 2. Swapping A and B turns the normal and swaps the points.
///
/// Status: as of qdist_depth3.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_depth2_f64(
    solver: Out<qdist_solver>,
    a: In<qdist_body2_f64>,
    b: In<qdist_body2_f64>,
    options: In<qdist_options_f64>,
    result: Out<qdist_depth_f64>,
) -> qdist_status {
    status(depth(solver, a, b, options, result, |solver, [a, b], options| Some(solver.depth(a, b, options))))
}
