//! WRENCH SETS
//!
//! The wrenches that a grasp can exert on the object with contact forces of size up to 1: a set of dimension 6, for qdist_solve6 with
//! any Q. The external wrench that it resists is the negative. qdist_solve6 gives the force efficiency d of the grasp; qdist_solve_in_span6 that
//! in the smallest subspace, for the active wrenches of fingers that cannot move in all directions; a segment as Q asks how large one wrench
//! may be. In the result, `direction` is the weakest one, and the wrench of d * Q that is farthest along it the one that is hardest to exert.

use super::super::super::generic::{aligned, array, lengths, put, shared};
use super::super::super::grasp::{norm, qdist_norm};
use super::super::super::status::{Check, qdist_status, status};
use super::super::sets::{qdist_set_f64, room};
use super::contacts::qdist_primitive_f64;
use core::ffi::c_void;
use qdist::Vector;
use qdist::grasp::WrenchSet;
use qdist::internal::one_by_one;
use qdist::support::{Failure, Support};

/// The wrench set of a list of primitives, 1 or more, with {0} in it. The list must outlive the sets that are made of it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_wrenches_f64 {
    pub primitives: *const qdist_primitive_f64,
    pub count: u32,
    /// QDIST_L1 or QDIST_LINF.
    pub norm: qdist_norm,
}

impl qdist_wrenches_f64 {
    /// # Safety
    /// If not NULL and aligned, the list is valid for reads of `count` primitives for the life of the set.
    pub(super) unsafe fn checked(&self) -> Check<WrenchSet<'_, f64>> {
        let norm = norm(self.norm)?;
        // SAFETY: the caller's promise.
        let list = unsafe { array(self.primitives, Some(self.count as usize)) }?;
        Ok(WrenchSet::new(qdist_primitive_f64::checked(list)?, norm))
    }

    /// The same without what takes a pass over the list.
    ///
    /// # Safety
    /// As for `checked`.
    unsafe fn unchecked(&self) -> Check<WrenchSet<'_, f64>> {
        // SAFETY: the caller's promise.
        let list = unsafe { array(self.primitives, Some(self.count as usize)) }?;
        Ok(WrenchSet::without_size(qdist_primitive_f64::list(list), norm(self.norm)?))
    }
}

/// The list behind a set, if the set is as `qdist_set_wrenches` makes it: the list knows its rounding coordinate by coordinate.
///
/// # Safety
/// What the header asks of the caller for a set that is about to be used.
pub(super) unsafe fn behind(set: &qdist_set_f64) -> Option<WrenchSet<'_, f64>> {
    let own: unsafe extern "C" fn(*mut c_void, *const f64, *mut f64) -> i32 = qdist_wrenches_support_f64;
    if set.exhaustive.is_some() || !set.support.is_some_and(|support| core::ptr::fn_addr_eq(support, own)) {
        return None;
    }
    // SAFETY: the caller's promise: with this function, that is what `user` points to.
    let list = unsafe { shared(set.user.cast::<qdist_wrenches_f64>().cast_const()).ok()?.checked().ok()? };
    (set.error == list.error() && set.extent == list.extent() && set.radius == 0.0).then_some(list)
}

/// Makes a set of a list of primitives. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_wrenches_f64(
    set: *mut qdist_set_f64,
    wrenches: *const qdist_wrenches_f64,
) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller.
        let checked = unsafe { shared(wrenches)?.checked() }?;
        lengths([checked.extent(), checked.error()])?;
        let made = qdist_set_f64 {
            support: Some(qdist_wrenches_support_f64),
            exhaustive: None,
            mirrored: Some(qdist_wrenches_mirrored_f64),
            user: wrenches.cast_mut().cast(),
            radius: 0.0,
            extent: checked.extent(),
            error: checked.error(),
            dimension: 6,
            contains_origin: checked.contains_origin().into(),
        };
        // SAFETY: checked.
        unsafe { put(set, made) };
        Ok(())
    };
    status(fill())
}

/// Support function of a wrench set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_wrenches_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    let ask = || {
        let point = room::<6>(point)?;
        // SAFETY: what the header asks of the caller.
        let (set, u) = unsafe { (shared(user.cast::<qdist_wrenches_f64>().cast_const())?, array(direction, Some(6))?) };
        // SAFETY: what the header asks of the caller.
        let set = unsafe { set.unchecked() }?;
        let found = set.support(&Vector::from_iterator(u.iter().copied())).map_err(|Failure(code)| code)?;
        // SAFETY: checked.
        unsafe { point.write(one_by_one(&found).into()) };
        Ok(())
    };
    status(ask())
}

/// Which mirror images of a wrench set are the set itself, by comparison of all primitives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_wrenches_mirrored_f64(user: *mut c_void, signs: u32) -> i32 {
    let ask = || -> Check<bool> {
        // SAFETY: what the header asks of the caller.
        let set = unsafe { shared(user.cast::<qdist_wrenches_f64>().cast_const())?.unchecked() }?;
        Ok(set.mirrored(signs as u8))
    };
    i32::from(ask().unwrap_or(false))
}
