//! HALF SPACES
//!
//! The ground, a wall, a plane of contact: a body of qdist_depth3 with no end. Its depth against any other body is the height of
//! that body's lowest point: one call of its support function (and six before, where its extent is not stated; one more in two words, where the tolerance takes that
//! and the body has `precise`), no solver memory, and a bracket of a few roundoffs. (Bullet: btStaticPlaneShape, with the same normal and offset; FCL: fcl::Halfspace.) In C it is a body and nothing else: no set of a query,
//! no part of a hull of two bodies (QDIST_ERROR_UNBOUNDED).
//!
//! Two half spaces overlap without end (QDIST_UNBOUNDED), unless their normals are exactly opposite, as those of a floor and a ceiling: then
//! the depth is that between the two planes. Where a pose is turned, and rounding does not tell whether the normals are
//! opposite, upper is DBL_MAX (float: FLT_MAX), and lower holds in both cases.

use super::*;
use qdist::support::HalfSpace;

/// The points x with normal . x <= offset. The normal points out of the half space; it need not be of unit length, but not 0.
#[repr(C)]
pub struct qdist_half_space_f64 {
    pub normal: [f64; 3],
    pub offset: f64,
}

impl Half<3> for qdist_half_space_f64 {
    type Body = qdist_body_f64;
    fn set(&self) -> Check<HalfSpace<f64, 3>> {
        HalfSpace::new(Vector::from(self.normal), self.offset).map_err(from_shape)
    }
}

/// Makes a body of a half space, in the identity pose. Numbers are read at every query.
///
/// Status: ARGUMENT (the normal is 0), NONFINITE (normal or offset).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_half_space_f64(
    body: Out<qdist_body_f64>,
    shape: In<qdist_half_space_f64>,
) -> qdist_status {
    status(Half::fill(body, shape))
}
