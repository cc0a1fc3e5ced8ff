//! CODES
//!
//! Small numbers with names, for both scalars.

use super::vocabulary::*;
pub(crate) use qdist::grasp::{ContactError, ForceError, ForceModel, ForceOutcome, Friction, GraspError, Kink, Norm};

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

/// Who makes the contact forces of a finger?
pub type qdist_force_model = u32;

/// Anyone: the structure bears what the joints do not. Limits hold for the torques that reach the joints.
pub const QDIST_FORCE_MODEL_PASSIVE: qdist_force_model = 0;
/// The joints, at all contacts of the finger together. A finger without joints is passive.
pub const QDIST_FORCE_MODEL_ACTIVE: qdist_force_model = 1;

/// callback_code of a set of fingers when no point was found that is provably as good as the set's `error` says. Known of numbers far from any
/// hand only, such as friction coefficients of 1e9.
pub const QDIST_CALLBACK_UNSOLVED: i32 = -2147483647 + 1;

const _: () = assert!(QDIST_CALLBACK_UNSOLVED == qdist::grasp::UNSOLVED);

/// Where the edges of a friction pyramid are.
pub type qdist_layout = u32;

/// `sides` of them on the edge of the cone, the first along o; a soft contact has two more, which only spin.
pub const QDIST_LAYOUT_INSCRIBED: qdist_layout = 0;
/// The same, so much longer that the pyramid contains the cone.
pub const QDIST_LAYOUT_CIRCUMSCRIBED: qdist_layout = 1;
/// GraspIt!: 8; for a soft contact 20.
pub const QDIST_LAYOUT_GRASPIT: qdist_layout = 2;
/// Dex-Net: `sides`; for a soft contact two moments more, without a normal force. mus does not count.
pub const QDIST_LAYOUT_DEX_NET: qdist_layout = 3;

/// A tool with linearised cones.
pub type qdist_tool = u32;

/// o is n x e_x, or n x e_z where n is along e_x.
pub const QDIST_TOOL_GRASPIT: qdist_tool = 0;
/// o is the projection of e_x.
pub const QDIST_TOOL_DEX_NET: qdist_tool = 1;
/// o is the projection of (1.2, 2.3, 3.4); edges have unit length.
pub const QDIST_TOOL_FROGGER: qdist_tool = 2;

/// Is a grasp force-closed?
pub type qdist_closure = i32;

/// No: along `direction` the set does not reach beyond half of its own rounding, some 20 to 60 roundoffs of the wrenches that the height is made of. d
/// cannot be told from 0.
pub const QDIST_CLOSURE_OPEN: qdist_closure = 0;
/// Yes, for certain: the wrench set contains a ball of `radius` > 0 around the origin.
pub const QDIST_CLOSURE_CLOSED: qdist_closure = 1;
/// Neither is proved: d is above 0 by little more than rounding, if it is; or memory, iterations or `interrupt` ended the query.
pub const QDIST_CLOSURE_UNDECIDED: qdist_closure = 2;

/// Why has d no gradient?
pub type qdist_kink = i32;

/// It has one.
pub const QDIST_KINK_NONE: qdist_kink = 0;
/// Another direction bounds d as tightly: the minimiser is not unique.
pub const QDIST_KINK_RIVAL: qdist_kink = 1;
/// Two or more points of Q touch the boundary of the wrench set.
pub const QDIST_KINK_UNIT: qdist_kink = 2;
/// No regular minimum was found near the result's direction: a contact is just about to carry load, contacts share it in more than one
/// way, d is constant along a curve, or the result was too far from a minimum.
pub const QDIST_KINK_DEGENERATE: qdist_kink = 3;
/// d is not known to be above 0.
pub const QDIST_KINK_NOT_CLOSED: qdist_kink = 4;

pub(super) fn kink(kink: Option<Kink>) -> qdist_kink {
    match kink {
        None => QDIST_KINK_NONE,
        Some(Kink::Rival) => QDIST_KINK_RIVAL,
        Some(Kink::UnitSet) => QDIST_KINK_UNIT,
        Some(Kink::Degenerate) => QDIST_KINK_DEGENERATE,
        Some(Kink::NotClosed) => QDIST_KINK_NOT_CLOSED,
    }
}

/// What did a search for contact forces conclude?
pub type qdist_force_outcome = i32;

/// The bracket is as narrow as asked for, and so is the equilibrium.
pub const QDIST_FORCES_CONVERGED: qdist_force_outcome = 0;
/// Stopped early: the least size is above the limit.
pub const QDIST_FORCES_ABOVE: qdist_force_outcome = 1;
/// No contact forces resist the wrench, up to rounding: `direction` separates.
pub const QDIST_FORCES_NOT_RESISTIBLE: qdist_force_outcome = 2;
/// Arithmetic does not allow a narrower bracket, or a better equilibrium. So ends a wrench on the very boundary of what can be resisted.
pub const QDIST_FORCES_PRECISION: qdist_force_outcome = 3;
/// The iteration limit is reached.
pub const QDIST_FORCES_ITERATIONS: qdist_force_outcome = 4;
/// A primitive is no number; the status is QDIST_ERROR_CALLBACK.
pub const QDIST_FORCES_FAILED: qdist_force_outcome = 5;

// (What is not known one day: the bracket would be true.)
outcomes! {
    force_outcome(ForceOutcome) -> qdist_force_outcome, or QDIST_FORCES_PRECISION; force_outcome_name, or c"unknown outcome";
    Converged = QDIST_FORCES_CONVERGED, c"converged";
    Above = QDIST_FORCES_ABOVE, c"above";
    NotResistible = QDIST_FORCES_NOT_RESISTIBLE, c"not resistible";
    Precision = QDIST_FORCES_PRECISION, c"precision";
    Iterations = QDIST_FORCES_ITERATIONS, c"iterations";
    SupportFailed = QDIST_FORCES_FAILED, c"failed";
}

/// The name of an outcome, e.g. "not resistible". A static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_force_outcome_string(outcome: qdist_force_outcome) -> *const c_char {
    force_outcome_name(outcome)
}

pub(super) fn from_force(error: ForceError) -> qdist_status {
    match error {
        ForceError::Wrench => QDIST_ERROR_NONFINITE,
        ForceError::Room => QDIST_ERROR_CAPACITY,
        _ => QDIST_ERROR_ARGUMENT,
    }
}

pub(super) fn force_model(model: qdist_force_model) -> Check<ForceModel> {
    match model {
        QDIST_FORCE_MODEL_PASSIVE => Ok(ForceModel::Passive),
        QDIST_FORCE_MODEL_ACTIVE => Ok(ForceModel::Active),
        _ => Err(QDIST_ERROR_ARGUMENT),
    }
}

pub(super) fn checked_norm(norm: qdist_norm) -> Check<Norm> {
    match norm {
        QDIST_L1 => Ok(Norm::L1),
        QDIST_LINF => Ok(Norm::LInf),
        _ => Err(QDIST_ERROR_ARGUMENT),
    }
}

pub(super) fn from_norm(norm: Norm) -> qdist_norm {
    match norm {
        Norm::L1 => QDIST_L1,
        Norm::LInf => QDIST_LINF,
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
        ContactError::TorqueLimit { .. } => QDIST_ERROR_TORQUE_LIMIT,
        ContactError::Tolerance => QDIST_ERROR_TOLERANCE,
        ContactError::Room => QDIST_ERROR_CAPACITY,
        _ => QDIST_ERROR_ARGUMENT,
    }
}

/// The status of an error in a list, after telling which contact it was.
pub(super) fn from_grasp(error: GraspError, which: &Out<u32>) -> qdist_status {
    if !which.is_null() {
        // (Aligned: looked at before.)
        which.put(error.contact as u32).ok();
    }
    from_contact(error.error)
}

/// Makes something of each contact of a list, and writes it. All are made once before the first is written.
pub(super) fn all_of<C, M>(
    contacts: &[C],
    which: &Out<u32>,
    make: impl Fn(usize, &C) -> Result<M, ContactError>,
    write: impl Fn(usize, M) -> Check,
) -> Check {
    let refuse = |contact: usize, error| from_grasp(GraspError { contact, error }, which);
    for (index, contact) in contacts.iter().enumerate() {
        make(index, contact).map_err(|error| refuse(index, error))?;
    }
    for (index, contact) in contacts.iter().enumerate() {
        write(index, make(index, contact).map_err(|error| refuse(index, error))?)?;
    }
    Ok(())
}
