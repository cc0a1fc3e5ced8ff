//! HALF SPACES
//!
//! The ground, a wall, a plane of contact: a body of qdist_depth3 with no end. Its depth against any other body is the height of
//! that body's lowest point: one call of its support function (and six before, where its extent is not stated), no solver memory, and a bracket of a few roundoffs. (Bullet:
//! btStaticPlaneShape, with the same normal and offset; FCL: fcl::Halfspace.) In C it is a body and nothing else: no set of a query,
//! no part of a hull of two bodies (QDIST_ERROR_UNBOUNDED).
//!
//! Two half spaces overlap without end (QDIST_UNBOUNDED), unless their normals are exactly opposite, as those of a floor and a ceiling: then
//! the depth is that between the two planes. Where a pose is turned, and rounding does not tell whether the normals are
//! opposite, upper is DBL_MAX (float: FLT_MAX), and lower holds in both cases.

use super::super::generic::{aligned, put, shared};
use super::super::status::{Check, QDIST_ERROR_UNBOUNDED, from_body, from_shape, overflow, qdist_status, status};
use super::query::{conclude, convert, from_depth, qdist_depth_f64};
use super::sets::{CheckedBody, qdist_body_f64, qdist_set_f64};
use core::ffi::c_void;
use qdist::Body;
use qdist::Vector;
use qdist::internal;
use qdist::support::HalfSpace;
use qdist::{BodyError, Matrix3};

/// The points x with normal . x <= offset. The normal points out of the half space; it need not be of unit length, but not 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_half_space_f64 {
    pub normal: [f64; 3],
    pub offset: f64,
}

impl qdist_half_space_f64 {
    fn set(&self) -> Check<HalfSpace<f64, 3>> {
        HalfSpace::new(Vector::from(self.normal), self.offset).map_err(from_shape)
    }
}

/// Makes a body of a half space, in the identity pose. Numbers are read at every query.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_half_space_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_half_space_f64,
) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        unsafe { shared(shape) }?.set()?;
        let set = qdist_set_f64 {
            support: Some(refuse),
            exhaustive: None,
            mirrored: None,
            user: shape.cast_mut().cast(),
            radius: 0.0,
            extent: 0.0,
            error: 0.0,
            dimension: 3,
            contains_origin: 0,
        };
        // SAFETY: checked.
        unsafe { put(body, qdist_body_f64 { unbounded: Some(answer), ..qdist_body_f64::at_origin(set) }) };
        Ok(())
    };
    status(fill())
}

/// There is no farthest point.
unsafe extern "C" fn refuse(_user: *mut c_void, _direction: *const f64, _point: *mut f64) -> i32 {
    QDIST_ERROR_UNBOUNDED
}

/// A body of either kind.
enum Either<'a> {
    HalfSpace(HalfSpace<f64, 3>, &'a qdist_body_f64),
    Compact(&'a CheckedBody),
}

impl<'a> Either<'a> {
    /// # Safety
    /// As for [`qdist_body_f64::checked`].
    unsafe fn new(body: &'a qdist_body_f64) -> Check<Self> {
        if body.unbounded.is_some() {
            // SAFETY: the caller's promise.
            let shape = unsafe { shared(body.set.user.cast::<qdist_half_space_f64>().cast_const()) }?;
            return Ok(Either::HalfSpace(shape.set()?, body));
        }
        // SAFETY: the caller's promise.
        Ok(Either::Compact(unsafe { body.checked() }?))
    }

    fn place(&self) -> Result<Body<'_, f64>, BodyError> {
        match self {
            Either::Compact(body) => body.place(),
            Either::HalfSpace(shape, body) => {
                Body::new(shape, Matrix3::from_row_slice(&body.rotation), Vector::from(body.translation))
            }
        }
    }
}

/// The query of two bodies, one of which is a half space.
unsafe extern "C" fn answer(
    a: *const c_void,
    b: *const c_void,
    options: *const c_void,
    result: *mut c_void,
) -> qdist_status {
    let solve = || {
        // SAFETY: `qdist_depth3_f64` has checked the pointers.
        let (a, b, (options, _)) = unsafe {
            let (a, b) = (Either::new(&*a.cast())?, Either::new(&*b.cast())?);
            (a, b, convert::<3>(options.cast())?)
        };
        let (a, b) = (a.place().map_err(from_body)?, b.place().map_err(from_body)?);
        let depth = internal::unbounded(&a, &b, &options).ok_or(QDIST_ERROR_UNBOUNDED)?;
        overflow(depth.failure)?;
        // SAFETY: `qdist_depth3_f64` has checked it.
        unsafe { put(result.cast::<qdist_depth_f64>(), from_depth(&depth)) };
        conclude(depth.outcome)
    };
    status(solve())
}
