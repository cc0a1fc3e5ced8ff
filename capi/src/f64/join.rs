//! HULLS OF TWO BODIES
//!
//! The convex hull of two bodies, each in its pose: a tapered capsule is that of two spheres, a frustum of two cylinders of half height
//! 0, a swept shape of one shape in two poses. (Bullet: btConvexHullShape of both, or btMultiSphereShape; geometry: a join.) The
//! smaller of the two radii stays a ball, and is exact. Joins may be joined again. Where both bodies turn about the z axis of the join's frame (identity rotations and
//! translations along z), so does the join, and two bodies on one axis are a plane problem.

use super::super::generic::{aligned, put, shared, tiny};
use super::super::status::{Check, QDIST_ERROR_UNBOUNDED, from_body, from_shape, qdist_status, status};
use super::sets::{CheckedBody, arguments, qdist_body_f64, qdist_set_f64};
use super::shapes::from_symmetry;
use core::ffi::c_void;
use qdist::Matrix3;
use qdist::support::{Join, Rigid, Support};
use qdist::{Real, Vector};

/// The convex hull of two bodies, in a common frame: that of the body which is made of it. They must outlive it; that which
/// has changed must be made anew.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_join_f64 {
    pub a: *const qdist_body_f64,
    pub b: *const qdist_body_f64,
}

/// cbindgen:ignore
type Part<'a> = Rigid<&'a CheckedBody, f64, 3>;

impl qdist_join_f64 {
    /// # Safety
    /// If not NULL and aligned, the bodies are valid for reads, and as [`qdist_body_f64::checked`] asks.
    unsafe fn set<'a>(&self) -> Check<Join<Part<'a>, Part<'a>>> {
        // SAFETY: the caller's promise.
        unsafe { Ok(Join::new(part(self.a)?, part(self.b)?)) }
    }
}

/// # Safety
/// As for [`qdist_join_f64::set`].
#[inline(always)]
unsafe fn part<'a>(body: *const qdist_body_f64) -> Check<Part<'a>> {
    // SAFETY: the caller's promise.
    let body = unsafe { shared(body) }?;
    if body.unbounded.is_some() {
        return Err(QDIST_ERROR_UNBOUNDED);
    }
    // SAFETY: the caller's promise.
    let set = unsafe { body.checked() }?;
    let rotation = Matrix3::from_row_slice(&body.rotation);
    Rigid::new(set, rotation, Vector::from(body.translation)).map_err(from_shape)
}

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_join_f64(body: *mut qdist_body_f64, join: *const qdist_join_f64) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let set = unsafe {
            let parts = shared(join)?;
            let set = parts.set()?;
            for part in [parts.a, parts.b] {
                // The pose as queries check it.
                shared(part)?.checked()?.place().map_err(from_body)?;
            }
            set
        };
        let made = qdist_set_f64 {
            support: Some(qdist_join_support_f64),
            exhaustive: if set.has_shortcuts() { Some(qdist_join_exhaustive_f64) } else { None },
            mirrored: None,
            user: join.cast_mut().cast(),
            radius: set.radius(),
            extent: set.extent().at_least(tiny()),
            error: set.error().at_least(tiny()),
            dimension: 3,
            contains_origin: set.contains_origin().into(),
        };
        let (symmetry, rolling_radius) = (from_symmetry(set.symmetry()), set.rolling_radius());
        let made = qdist_body_f64 { symmetry, rolling_radius, ..qdist_body_f64::at_origin(made) };
        // SAFETY: what the header asks of the caller; a measured extent may be infinite.
        unsafe {
            made.checked()?;
            put(body, made);
        }
        Ok(())
    };
    status(fill())
}

/// Support function of the core of a hull of two bodies: without the smaller of the two radii.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_join_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask(user, direction, point, false) })
}

/// The same, where a part has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_join_exhaustive_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask(user, direction, point, true) })
}

/// # Safety
/// Those of a support function.
unsafe fn ask(user: *mut c_void, direction: *const f64, point: *mut f64, exhaustive: bool) -> Check {
    // SAFETY: what the header asks of the caller.
    let (set, u, room) = unsafe {
        let (join, u, room) = arguments::<qdist_join_f64, 3>(user, direction, point)?;
        (join.set()?, u, room)
    };
    let farthest = if exhaustive { set.exhaustive(u).map(|(point, _)| point) } else { set.support(u) };
    // SAFETY: `arguments` has checked it.
    unsafe { room.write(farthest.map_err(|failure| failure.0)?.into()) };
    Ok(())
}
