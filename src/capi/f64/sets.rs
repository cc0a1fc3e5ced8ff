//! CONVEX SETS
//!
//! A convex set is known by its support function: the point of the set that is farthest along a direction. A set is
//! given in two parts, core + radius * ball: the support function gives points of the core, and `radius` is
//! the radius of a ball swept over it. A sphere is a point with a radius, a capsule a segment with a radius, a safety margin
//! is a radius on anything. Write a support function for your own shapes; the built-in shapes are made of the same parts.

use super::super::generic::{CallbackSet, CallbackShape, aligned, coordinates, length, shared};
use super::super::status::{Check, QDIST_ERROR_ARGUMENT, from_body, qdist_status, status};
use super::super::symmetry::{QDIST_SYMMETRY_AXIS, QDIST_SYMMETRY_FULL, QDIST_SYMMETRY_NONE};
use crate::Body;
use crate::depth::Matrix3;
use crate::scalar::Vector;
use crate::support::Symmetry;
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
    /// For a set far from the origin of its frame: a point near it. Used when `spread` is above 0.
    pub center: [f64; 3],
    /// An upper bound of the core's distance from `center`; `set.error` then says how well the support function works relative
    /// to `center`. 0: measured from the origin.
    pub spread: f64,
    /// Exact symmetry of the set in its frame. QDIST_SYMMETRY_NONE (0) is always right; the others make two bodies that turn
    /// about one axis a plane problem.
    pub symmetry: u32,
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
        let rotation = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        Self { set, rotation, translation: [0.0; 3], center: [0.0; 3], spread: 0.0, symmetry: QDIST_SYMMETRY_NONE }
    }

    /// # Safety
    /// As for [`qdist_set_f64::adapt`], in dimension 3.
    #[inline(always)]
    pub(super) unsafe fn adapt(&self) -> Check<CallbackShape<f64>> {
        // SAFETY: the caller's promise.
        let set = unsafe { self.set.adapt::<3>() }?;
        let spread = length(self.spread)?;
        let center = if spread > 0.0 {
            coordinates(&self.center)?;
            Some((Vector::from(self.center), spread))
        } else {
            None
        };
        let symmetry = match self.symmetry {
            QDIST_SYMMETRY_NONE => Symmetry::None,
            QDIST_SYMMETRY_AXIS => Symmetry::Axis,
            QDIST_SYMMETRY_FULL => Symmetry::Full,
            _ => return Err(QDIST_ERROR_ARGUMENT),
        };
        Ok(CallbackShape { set, center, symmetry })
    }

    #[inline(always)]
    pub(super) fn place<'a>(&self, shape: &'a CallbackShape<f64>) -> Check<Body<'a, f64>> {
        let [a, b, c, d, e, f, g, h, i] = self.rotation;
        let rotation = Matrix3::new(a, b, c, d, e, f, g, h, i);
        Body::new(shape, rotation, Vector::from(self.translation)).map_err(from_body)
    }
}

/// Makes a body of any set of dimension 3, in the identity pose. Checks and copies the set; what it points to must outlive the
/// body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_set_f64(body: *mut qdist_body_f64, set: *const qdist_set_f64) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let set = unsafe { shared(set) }?;
        // SAFETY: what the header asks of the caller; the functions are not called here.
        unsafe { set.adapt::<3>() }?;
        // SAFETY: checked.
        unsafe { body.write(qdist_body_f64::at_origin(*set)) };
        Ok(())
    };
    status(fill())
}

/// The parts of a support function's arguments, checked: the struct behind `user`, the direction, and room for the
/// point. References only: a vector inside of the `Result` would be copied in pieces, which is slow.
///
/// # Safety
/// Each pointer that is neither NULL nor misaligned is valid for a `S`, for three numbers, and for writes of three numbers.
#[inline(always)]
pub(super) unsafe fn arguments<'a, S>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check<(&'a S, &'a [f64; 3], *mut [f64; 3])> {
    // SAFETY: the caller's promise.
    unsafe { Ok((shared(user.cast::<S>().cast_const())?, shared(direction.cast())?, room(point)?)) }
}

/// Room for a point; the pointer is checked, the memory not yet written.
#[inline(always)]
pub(super) fn room<const N: usize>(point: *mut f64) -> Check<*mut [f64; N]> {
    aligned(point)?;
    Ok(point.cast())
}
