//! CONTACT FORCES
//!
//! The smallest contact forces that resist one given wrench: how a controller distributes a load. Some 30 microseconds for four
//! contacts (`make figures`), no solver and no memory but the stack, 16 KB in double (`make stack`). Size is measured in force caps: 1 is the caps
//! themselves.

use super::super::super::generic::{aligned, array, finite, gaps, known_size, length, padded, put, shared};
use super::super::super::grasp::{force_outcome, from_contact, from_force, qdist_force_outcome};
use super::super::super::status::{Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_CALLBACK, qdist_status, status};
use super::contacts::{qdist_contact_f64, qdist_wrench_frame_f64};
use super::wrenches::qdist_wrenches_f64;
use qdist::Vector;
use qdist::grasp::{Contribution, ForceOptions, ForceOutcome, ForceSolver, WrenchSet};
use qdist::internal::check_forces;
use qdist::support::Failure;

/// When a search for contact forces ends. NULL stands for the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_force_options_f64 {
    /// sizeof(qdist_force_options_f64).
    pub struct_size: u32,
    /// The most calls of the support function, beside some 20 at the beginning; 0: 1000. With a memory twice as many at most.
    pub max_iterations: u32,
    /// The gap upper - lower asked for, relative to `upper`; 0: 1e-9 (float: 1e-3).
    pub relative: f64,
    /// Larger forces are of no interest: the search ends when the least size is known to be above; 0: no limit.
    pub limit: f64,
}

/// Where the last forces came from, for the next tick of a loop: it makes the search shorter, and costs no answer: where it does not help, the
/// search begins anew without it. Plain numbers; start with `= {0}`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_force_memory_f64 {
    /// 0 to 6.
    pub count: u32,
    /// Coordinate k of direction i is directions[6 * i + k].
    pub directions: [f64; 36],
}

gaps!(qdist_force_memory_f64, count..directions);

/// What is known about the least size of contact forces that resist a wrench.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_forces_f64 {
    /// sizeof(qdist_forces_f64); set it before the call.
    pub struct_size: u32,
    /// What was concluded.
    pub outcome: qdist_force_outcome,
    /// All forces that resist the wrench have at least this size: `direction` proves it. DBL_MAX (float: FLT_MAX): no forces do.
    pub lower: f64,
    /// The shares have at most this size; DBL_MAX (float: FLT_MAX): none were found, and all shares are 0.
    pub upper: f64,
    /// The unit vector u that proves `lower`: u.w / h_W(u), with w the negative of the external wrench.
    pub direction: [f64; 6],
    /// |sum of the shares + external wrench|: how far the shares are from equilibrium. The bracket is that of what they exert.
    pub residual: f64,
    /// Calls of the support function, those at the beginning not counted.
    pub iterations: u32,
    /// QDIST_CALLBACK_NONFINITE when a primitive is no number, QDIST_CALLBACK_UNSOLVED of fingers; else 0.
    pub callback_code: i32,
}

/// A wrench in the coordinates of the sets: a force on the object, and a moment about the frame's reference point, in units of force and force
/// times position. `force` and `moment` are three numbers, `wrench` six.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_wrench_f64(
    frame: *const qdist_wrench_frame_f64,
    force: *const f64,
    moment: *const f64,
    wrench: *mut f64,
) -> qdist_status {
    let make = || {
        aligned(wrench)?;
        // SAFETY: what the header asks of the caller.
        let (frame, force, moment) =
            unsafe { (shared(frame)?.checked()?, array(force, Some(3))?, array(moment, Some(3))?) };
        finite(force)?;
        finite(moment)?;
        let three = |list: &[f64]| Vector::<f64, 3>::from_iterator(list.iter().copied());
        let made = frame.wrench(&three(force), &three(moment));
        finite(made.as_slice())?;
        // SAFETY: what the header asks of the caller: room for six numbers.
        unsafe { wrench.cast::<[f64; 6]>().write(made.into()) };
        Ok(())
    };
    status(make())
}

/// The smallest contact forces that keep the object in equilibrium with an external wrench.
///
/// memory: NULL, or what the last call left, and where this one leaves its own. external: six numbers, see qdist_wrench.
/// shares: room for 6 * count numbers: share i, shares[6 * i] to shares[6 * i + 5], becomes the wrench that contact i exerts; their sum is the
/// negative of the external wrench. qdist_contact_force makes a force of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_contact_forces_f64(
    wrenches: *const qdist_wrenches_f64,
    memory: *mut qdist_force_memory_f64,
    external: *const f64,
    options: *const qdist_force_options_f64,
    shares: *mut f64,
    result: *mut qdist_forces_f64,
) -> qdist_status {
    let solve = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let set = shared(wrenches)?.checked()?;
            resist(&set, memory, external, options, shares, result, |_| Ok(()))
        }
    };
    status(solve())
}

/// `also` is called with the solver after the search.
///
/// # Safety
/// What the header asks of the caller of `qdist_contact_forces`.
pub(super) unsafe fn resist<C: Contribution<f64>>(
    set: &WrenchSet<'_, f64, C>,
    memory: *mut qdist_force_memory_f64,
    external: *const f64,
    options: *const qdist_force_options_f64,
    shares: *mut f64,
    result: *mut qdist_forces_f64,
    also: impl FnOnce(&ForceSolver<f64>) -> Result<(), Failure>,
) -> Check {
    let count = set.contributions().len();
    aligned(shares)?;
    aligned(result)?;
    // SAFETY: the caller's promise.
    let (external, options) = unsafe {
        known_size((&raw const (*result).struct_size).read(), size_of::<qdist_forces_f64>())?;
        (array(external, Some(6))?, convert(options)?)
    };
    let mut solver = if memory.is_null() {
        ForceSolver::new()
    } else {
        // SAFETY: the caller's promise.
        let memory = unsafe { shared(memory.cast_const()) }?;
        let (known, _) = memory.directions.as_chunks::<6>();
        finite(&memory.directions)?;
        let known = known.get(..memory.count as usize).ok_or(QDIST_ERROR_ARGUMENT)?;
        ForceSolver::knowing(known.iter().map(|&u| Vector::from(u)))
    };
    let external = Vector::<f64, 6>::from_iterator(external.iter().copied());
    // Refused before the shares are touched.
    check_forces(&external, &options).map_err(from_force)?;
    // SAFETY: the caller's promise: room for six numbers each, which nothing else refers to. They need no initial value, but
    // a reference does.
    let list = unsafe {
        shares.write_bytes(0, 6 * count);
        core::slice::from_raw_parts_mut(shares.cast::<Vector<f64, 6>>(), count)
    };
    let mut found = solver.resist(set, &external, &options, list).map_err(from_force)?;
    if let Err(Failure(code)) = also(&solver) {
        (found.outcome, found.failure) = (ForceOutcome::SupportFailed, code);
    }
    if !memory.is_null() {
        let mut kept = qdist_force_memory_f64 { count: 0, directions: [0.0; 36] };
        let (slots, _) = kept.directions.as_chunks_mut::<6>();
        for (slot, direction) in slots.iter_mut().zip(solver.known()) {
            *slot = (*direction).into();
            kept.count += 1;
        }
        // SAFETY: checked.
        unsafe { put(memory, kept) };
    }
    let made = qdist_forces_f64 {
        struct_size: size_of::<qdist_forces_f64>() as u32,
        outcome: force_outcome(found.outcome),
        lower: found.lower,
        upper: found.upper,
        direction: padded(found.direction.iter().copied()),
        residual: found.residual,
        iterations: found.iterations,
        callback_code: found.failure,
    };
    // SAFETY: checked.
    unsafe { result.write(made) };
    if found.outcome == ForceOutcome::SupportFailed { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
}

/// # Safety
/// If not NULL and aligned, `options` is valid for reads.
unsafe fn convert(options: *const qdist_force_options_f64) -> Result<ForceOptions<f64>, qdist_status> {
    let mut made = ForceOptions::default();
    if options.is_null() {
        return Ok(made);
    }
    // SAFETY: the caller's promise.
    let options = unsafe { shared(options) }?;
    known_size(options.struct_size, size_of::<qdist_force_options_f64>())?;
    let (relative, limit) = (length(options.relative)?, length(options.limit)?);
    if relative > 0.0 {
        made.relative = relative;
    }
    if limit > 0.0 {
        made.limit = limit;
    }
    if options.max_iterations > 0 {
        made.iterations = options.max_iterations;
    }
    Ok(made)
}

/// The contact force that exerts a wrench: four numbers, along n, o, t, and the spin moment about n, in units of force and force times position.
/// What friction does not allow at all is 0; a force outside of the cone by rounding is moved onto it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_contact_force_f64(
    contact: *const qdist_contact_f64,
    frame: *const qdist_wrench_frame_f64,
    share: *const f64,
    force: *mut f64,
) -> qdist_status {
    let make = || {
        aligned(force)?;
        // SAFETY: what the header asks of the caller.
        let (contact, frame, share) =
            unsafe { (shared(contact)?.checked(), shared(frame)?.checked()?, array(share, Some(6))?) };
        finite(share)?;
        let share = Vector::<f64, 6>::from_iterator(share.iter().copied());
        let made = frame.contact_force(&contact.map_err(from_contact)?, &share);
        finite(made.as_slice())?;
        // SAFETY: what the header asks of the caller: room for four numbers.
        unsafe { force.cast::<[f64; 4]>().write(made.into()) };
        Ok(())
    };
    status(make())
}
