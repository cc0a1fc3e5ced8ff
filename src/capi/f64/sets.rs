//! CONVEX SETS
//!
//! A convex set is known by its support function: the point of the set that is farthest along a direction. A set is
//! given in two parts, core + radius * ball: the support function gives points of the core, and `radius` is
//! the radius of a ball swept over it. A sphere is a point with a radius, a capsule a segment with a radius, a safety margin
//! is a radius on anything. Write a support function for your own shapes; the built-in shapes are made of the same parts.

use super::super::generic::{CallbackSet, shared};
use super::super::status::{Check, from_body};
use crate::Body;
use crate::depth::Matrix3;
use crate::scalar::Vector;
use core::ffi::c_void;

/// Writes a point of the core that is farthest along `direction` to `point`.
///
/// user: the pointer from the set. direction: as many numbers as the dimension; finite and not all zero, but
/// not necessarily of unit length. point: room for as many.
///
/// Returns 0, or a code of your own, which ends the query and comes back as `callback_code`. Not INT32_MIN or
/// INT32_MIN + 1. The function must not unwind or longjmp, nor use the solver that is calling it. Where several
/// points are equally far, any of them.
pub type qdist_support_f64 =
    Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32>;

/// A convex set, core + radius * ball. Start with `= {0}`: what is zero takes its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_set_f64 {
    /// The support function of the core.
    pub support: qdist_support_f64,
    /// NULL; or, if `support` takes shortcuts and may miss the farthest point, a slower function that does not. It checks
    /// the direction that is about to be reported.
    pub exhaustive: qdist_support_f64,
    /// First argument of both functions.
    pub user: *mut c_void,
    /// Radius of the ball swept over the core, >= 0.
    pub radius: f64,
    /// An upper bound of |x| over the core, for the rounding margin; 0: not known, the largest norm seen is taken.
    pub extent: f64,
    /// An upper bound of the rounding error of the support function, as a length: how far its points are off the core, and
    /// how much farther along a unit direction the farthest point may be. 0: 16 * dimension * roundoff * extent, which covers
    /// a few operations on coordinates of the core's size.
    pub error: f64,
    /// The dimension that the functions work in; 0: not known, and not checked.
    pub dimension: u32,
}

/// A set in space with a pose: x -> rotation * x + translation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_body_f64 {
    /// The set, in the body's frame.
    pub set: qdist_set_f64,
    /// Row-major: rotation[3 * row + column]. A rotation to within 1e-4; used as it is given.
    pub rotation: [f64; 9],
    /// Position of the body's frame in the world.
    pub translation: [f64; 3],
}

impl qdist_set_f64 {
    /// # Safety
    /// The functions may be called with `user` in dimension `N`, as the header states.
    #[inline(always)]
    pub(super) unsafe fn adapt<const N: usize>(&self) -> Check<CallbackSet<f64>> {
        let lengths = [self.radius, self.extent, self.error];
        // SAFETY: the caller's promise.
        unsafe { CallbackSet::new::<N>(self.support, self.exhaustive, self.user, lengths, self.dimension) }
    }
}

impl qdist_body_f64 {
    /// The identity pose.
    pub(super) fn at_origin(set: qdist_set_f64) -> Self {
        Self { set, rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] }
    }

    #[inline(always)]
    pub(super) fn place<'a>(&self, set: &'a CallbackSet<f64>) -> Check<Body<'a, f64>> {
        let [a, b, c, d, e, f, g, h, i] = self.rotation;
        let rotation = Matrix3::new(a, b, c, d, e, f, g, h, i);
        Body::new(set, rotation, Vector::from(self.translation)).map_err(from_body)
    }
}

/// The parts of a support function's arguments, checked: the struct behind `user`, the direction, and room for the
/// point.
///
/// # Safety
/// Each pointer that is neither NULL nor misaligned is valid for a `S`, for `N` numbers, and for writes of `N`
/// numbers.
#[inline(always)]
pub(super) unsafe fn arguments<'a, S, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check<(&'a S, Vector<f64, N>, *mut [f64; N])> {
    // SAFETY: the caller's promise.
    unsafe {
        let shape = shared(user.cast::<S>().cast_const())?;
        let direction = shared(direction.cast::<[f64; N]>())?;
        Ok((shape, Vector::from(*direction), room(point)?))
    }
}

/// Room for a point; the pointer is checked, the memory not yet written.
#[inline(always)]
pub(super) fn room<const N: usize>(point: *mut f64) -> Check<*mut [f64; N]> {
    super::super::generic::aligned(point)?;
    Ok(point.cast())
}
