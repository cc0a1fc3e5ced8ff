//! CODES
//!
//! Small numbers with names, for both scalars.

use super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_CAPACITY, QDIST_ERROR_CONTACT_CAP, QDIST_ERROR_CONTACT_FRICTION,
    QDIST_ERROR_CONTACT_JACOBIAN, QDIST_ERROR_CONTACT_NORMAL, QDIST_ERROR_CONTACT_POSITION,
    QDIST_ERROR_CONTACT_TANGENTS, QDIST_ERROR_CONTACT_WRENCH, QDIST_ERROR_FRAME, QDIST_ERROR_TOLERANCE, qdist_status,
};
use crate::grasp::{ContactError, GraspError, Norm};

/// The friction of a contact.
pub type qdist_friction = u32;

/// A normal force only. mu and mus are not read.
pub const QDIST_FRICTIONLESS: qdist_friction = 0;
/// A point with Coulomb friction: sqrt(f2^2 + f3^2) <= mu f1, f4 = 0. mus is not read.
pub const QDIST_HARD: qdist_friction = 1;
/// A soft finger: sqrt((f2^2 + f3^2) / mu^2 + f4^2 / mus^2) <= f1.
pub const QDIST_SOFT: qdist_friction = 2;

/// The size of all contact forces together.
pub type qdist_norm = u32;

/// The sum of the normal forces, each divided by its cap, is at most 1: the contacts share one supply.
pub const QDIST_L1: qdist_norm = 0;
/// Each normal force is at most its cap: every contact has a supply of its own.
pub const QDIST_LINF: qdist_norm = 1;

/// Is a grasp force-closed?
pub type qdist_closure = i32;

/// No, or by no more than rounding can tell: `direction` separates.
pub const QDIST_CLOSURE_OPEN: qdist_closure = 0;
/// Yes: the wrench set contains a ball of `radius` > 0 around the origin.
pub const QDIST_CLOSURE_CLOSED: qdist_closure = 1;
/// Memory, iterations or `interrupt` ended the query before either was certain.
pub const QDIST_CLOSURE_UNDECIDED: qdist_closure = 2;

pub(super) fn norm(norm: qdist_norm) -> Check<Norm> {
    match norm {
        QDIST_L1 => Ok(Norm::L1),
        QDIST_LINF => Ok(Norm::LInf),
        _ => Err(QDIST_ERROR_ARGUMENT),
    }
}

pub(super) fn from_contact(error: ContactError) -> qdist_status {
    match error {
        ContactError::Position => QDIST_ERROR_CONTACT_POSITION,
        ContactError::Normal => QDIST_ERROR_CONTACT_NORMAL,
        ContactError::Tangents => QDIST_ERROR_CONTACT_TANGENTS,
        ContactError::Friction => QDIST_ERROR_CONTACT_FRICTION,
        ContactError::ForceCap => QDIST_ERROR_CONTACT_CAP,
        ContactError::Frame => QDIST_ERROR_FRAME,
        ContactError::Wrench => QDIST_ERROR_CONTACT_WRENCH,
        ContactError::Jacobian | ContactError::Coupling => QDIST_ERROR_CONTACT_JACOBIAN,
        ContactError::Tolerance => QDIST_ERROR_TOLERANCE,
        ContactError::Room => QDIST_ERROR_CAPACITY,
    }
}

/// The status of an error in a list, after telling which contact it was.
///
/// # Safety
/// `which` is NULL, or aligned and valid for writes.
pub(super) unsafe fn from_grasp(error: GraspError, which: *mut u32) -> qdist_status {
    if !which.is_null() {
        // SAFETY: the caller's promise.
        unsafe { which.write(error.contact as u32) };
    }
    from_contact(error.error)
}
