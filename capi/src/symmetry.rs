//! SYMMETRY

use super::vocabulary::*;

/// Of a body: none that is known.
pub const QDIST_SYMMETRY_NONE: u32 = 0;
/// All rotations about the z axis of the body's frame leave the set unchanged.
pub const QDIST_SYMMETRY_AXIS: u32 = 1;
/// All rotations about the origin of the body's frame leave the set unchanged.
pub const QDIST_SYMMETRY_FULL: u32 = 2;

/// Of a set or unit set: does it not change when the coordinates named by the bits of `signs` (bit 0: the first) change sign? Returns 1
/// when it certainly does not, else 0. A search by cones leaves out what is an image of something else under a change of sign
/// that both A and Q allow.
///
/// user: the pointer from the set or unit set.
pub type qdist_mirrored = Option<unsafe extern "C" fn(user: *mut c_void, signs: u32) -> i32>;

/// What answers for a body without end. Not for functions of your own.
pub type qdist_unbounded = Option<
    unsafe extern "C" fn(
        a: *const c_void,
        b: *const c_void,
        options: *const c_void,
        result: *mut c_void,
    ) -> qdist_status,
>;

/// How depth is found with a body in space: what the functions that make bodies put there. The code of a plan is linked where one of them names it.
pub type qdist_route = Option<unsafe extern "C" fn()>;

/// The mirror function of sets that are symmetric in every coordinate.
pub(super) unsafe extern "C" fn mirrored_always(_user: *mut c_void, _signs: u32) -> i32 {
    1
}

/// The mirror function of solids of revolution.
pub(super) unsafe extern "C" fn mirrored_sideways(_user: *mut c_void, signs: u32) -> i32 {
    i32::from(signs & 4 == 0)
}
