//! HULLS OF POINTS
//!
//! The convex hull of a list of points, in any dimension, by looking at all of them; and large hulls in space, by
//! climbing from vertex to vertex. The list must outlive the set or body that is made of it.

use super::super::generic::{
    aligned, array, coordinates, dimension, farthest, farthest3, in_range, reach, shared,
};
use super::super::status::{Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, qdist_status, status};
use super::sets::{arguments, qdist_body_f64, qdist_set_f64, qdist_support_f64, room};
use crate::scalar::Real;
use core::ffi::c_void;

/// The convex hull of `count` points, 1 or more. Coordinate k of point i is points[i * dimension + k].
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_points_f64 {
    pub points: *const f64,
    pub count: u32,
    /// 2 to 6.
    pub dimension: u32,
}

impl qdist_points_f64 {
    /// # Safety
    /// If not NULL and aligned, `points` is valid for reads of all coordinates.
    #[inline(always)]
    pub(super) unsafe fn coordinates<'a>(&self) -> Check<&'a [f64]> {
        let length = (self.count as usize).checked_mul(self.dimension as usize);
        // SAFETY: the caller's promise.
        unsafe { array(self.points, length) }
    }

    /// The set, with all coordinates checked.
    ///
    /// # Safety
    /// As for [`coordinates`](Self::coordinates), and `user` is this struct.
    pub(super) unsafe fn set(&self, support: qdist_support_f64, user: *const Self) -> Check<qdist_set_f64> {
        let n = dimension(self.dimension)?;
        // SAFETY: the caller's promise.
        let list = unsafe { self.coordinates() }?;
        coordinates(list)?;
        let extent = reach(list, n);
        Ok(qdist_set_f64 {
            support,
            exhaustive: None,
            user: user.cast_mut().cast(),
            radius: 0.0,
            extent,
            error: f64::count(2 * n + 2) * f64::ROUNDOFF * extent,
            dimension: self.dimension,
        })
    }
}

/// Makes a set of a list of points of any dimension. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_points_f64(set: *mut qdist_set_f64, shape: *const qdist_points_f64) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller; `set` is checked.
        unsafe { set.write(shared(shape)?.set(Some(qdist_points_support_f64), shape)?) };
        Ok(())
    };
    status(fill())
}

/// Makes a body of a list of points of dimension 3. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_points_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_points_f64,
) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let points = unsafe { shared(shape) }?;
        if points.dimension != 3 {
            return Err(QDIST_ERROR_DIMENSION);
        }
        // SAFETY: what the header asks of the caller; `body` is checked.
        unsafe { body.write(qdist_body_f64::at_origin(points.set(Some(qdist_points3_support_f64), shape)?)) };
        Ok(())
    };
    status(fill())
}

/// Support function of a list of points of any dimension.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    let ask = || {
        // SAFETY: what the header asks of the caller.
        let (list, n, u) = unsafe {
            let shape = shared(user.cast::<qdist_points_f64>().cast_const())?;
            let n = dimension(shape.dimension)?;
            (shape.coordinates()?, n, array(direction, Some(n))?)
        };
        room::<1>(point)?;
        let (_, best) = farthest(list, n, in_range(u, &mut [0.0; _])).ok_or(QDIST_ERROR_ARGUMENT)?;
        // SAFETY: `best` and the caller's room have n numbers. Numbers of the caller's list are not the room itself.
        unsafe { best.as_ptr().copy_to(point, n) };
        Ok(())
    };
    status(ask())
}

/// Support function of a list of points of dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points3_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    let ask = || {
        // SAFETY: what the header asks of the caller.
        let (list, u, room) = unsafe {
            let (shape, u, room) = arguments::<qdist_points_f64, 3>(user, direction, point)?;
            if shape.dimension != 3 {
                return Err(QDIST_ERROR_DIMENSION);
            }
            (shape.coordinates()?, u, room)
        };
        let u: [f64; 3] = u.into();
        let mut store = [0.0; _];
        let u = in_range(&u, &mut store).first_chunk::<3>().ok_or(QDIST_ERROR_DIMENSION)?;
        let best = farthest3(list, u).ok_or(QDIST_ERROR_ARGUMENT)?;
        // SAFETY: `arguments` has checked it.
        unsafe { room.write(*best) };
        Ok(())
    };
    status(ask())
}
