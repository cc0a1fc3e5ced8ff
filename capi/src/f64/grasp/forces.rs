//! CONTACT FORCES
//!
//! The smallest contact forces that resist one given wrench: how a controller distributes a load. Some 30 microseconds for four
//! contacts (`./x figures`), no solver and no memory but the stack, 16 KB in double (`./x stack`). Size is measured in force caps: 1 is the caps
//! themselves.

use super::*;
use qdist::internal::check_forces;

/// When a search for contact forces ends. NULL stands for the defaults.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_force_options_f64 {
    pub struct_size: u32,
    /// The most steps (see `iterations` of qdist_forces); 0: 1000. With a memory twice as many at most.
    pub max_iterations: u32,
    /// The gap upper - lower asked for, relative to `upper`; 0: 1e-9 (float: 1e-3).
    pub relative: f64,
    /// Larger forces are of no interest: the search ends when the least size is known to be above; 0: no limit.
    pub limit: f64,
}
gaps!(qdist_force_options_f64);
versioned!(qdist_force_options_f64);

impl Defaults for qdist_force_options_f64 {
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as u32, ..Self::ZERO }
    }
}

/// Where the last forces came from, for the next tick of a loop: it makes the search shorter, and costs no answer: where it does not help, the
/// search begins anew without it. Plain numbers; start with `= {0}`.
#[repr(C)]
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
    /// Steps of the search: calls of the wrench set's support function, but for those at the beginning and those that prove the bracket.
    pub iterations: u32,
    /// QDIST_CALLBACK_NONFINITE when a primitive is no number, QDIST_CALLBACK_UNSOLVED of fingers; else 0.
    pub callback_code: i32,
}
gaps!(qdist_forces_f64);
versioned!(qdist_forces_f64);

/// A wrench in the coordinates of the sets: a force on the object, and a moment about the frame's reference point, in units of force and force
/// times position. `force` and `moment` are three numbers, `wrench` six.
///
/// Status: FRAME (frame), NONFINITE (force or moment, or the wrench is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_wrench_f64(
    frame: In<qdist_wrench_frame_f64>,
    force: In<f64>,
    moment: In<f64>,
    wrench: Out<f64>,
) -> qdist_status {
    status_of(|| {
        wrench.checked()?;
        let (frame, force, moment) = (frame.get()?.checked()?, force.numbers::<3>()?, moment.numbers::<3>()?);
        finite(&force)?;
        finite(&moment)?;
        let made: [f64; 6] = frame.wrench(&Vector::from(force), &Vector::from(moment)).into();
        finite(&made)?;
        wrench.rows().put(made)
    })
}

/// The smallest contact forces that keep the object in equilibrium with an external wrench.
///
/// memory: NULL, or what the last call left, and where this one leaves its own. external: six numbers, see qdist_wrench.
/// shares: room for 6 * count numbers: share i, shares[6 * i] to shares[6 * i + 5], becomes the wrench that contact i exerts; their sum is the
/// negative of the external wrench. qdist_contact_force makes a force of it.
///
/// Status: those of qdist_set_wrenches (wrenches); ARGUMENT (memory->count, or options->relative or limit is negative), NONFINITE (a number of
/// memory, external or options), CALLBACK (wrenches: see callback_code).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_contact_forces_f64(
    wrenches: In<qdist_wrenches_f64>,
    memory: Out<qdist_force_memory_f64>,
    external: In<f64>,
    options: In<qdist_force_options_f64>,
    shares: Out<f64>,
    result: Out<qdist_forces_f64>,
) -> qdist_status {
    status_of(|| resist(&wrenches.get()?.checked()?, memory, external, options, shares, result, |_| Ok(())))
}

/// `also` is called with the solver after the search.
pub(super) fn resist<C: Contribution<f64>>(
    set: &WrenchSet<'_, f64, C>,
    memory: Out<qdist_force_memory_f64>,
    external: In<f64>,
    options: In<qdist_force_options_f64>,
    shares: Out<f64>,
    result: Out<qdist_forces_f64>,
    also: impl FnOnce(&ForceSolver<f64>) -> Result<(), Failure>,
) -> Check {
    shares.checked()?;
    result.known()?;
    let (external, options) = (Vector::from(external.numbers::<6>()?), convert(options)?);
    let mut solver = if memory.is_null() { ForceSolver::new() } else { recall(memory.get()?)? };
    // Refused before the shares are touched.
    check_forces(&external, &options).map_err(from_force)?;
    let rows = shares.rows::<Vector<f64, 6>>();
    let list = rows.zeroed(set.contributions().len())?;
    let mut found = solver.resist(set, &external, &options, list).map_err(from_force)?;
    if let Err(failure) = also(&solver) {
        (found.outcome, found.failure) = (ForceOutcome::SupportFailed, Some(failure));
    }
    if !memory.is_null() {
        let mut kept = qdist_force_memory_f64::ZERO;
        let (slots, _) = kept.directions.as_chunks_mut::<6>();
        for (slot, direction) in slots.iter_mut().zip(solver.known()) {
            *slot = (*direction).into();
            kept.count += 1;
        }
        memory.put(kept)?;
    }
    result.put_version(qdist_forces_f64 {
        struct_size: size_of::<qdist_forces_f64>() as u32,
        outcome: force_outcome(found.outcome),
        lower: found.lower,
        upper: found.upper,
        direction: padded(found.direction.iter().copied()),
        residual: found.residual,
        iterations: found.iterations,
        callback_code: code(found.failure),
    })?;
    if found.outcome == ForceOutcome::SupportFailed { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
}

/// A solver that knows what a memory keeps.
fn recall(memory: &qdist_force_memory_f64) -> Check<ForceSolver<f64>> {
    let (known, _) = memory.directions.as_chunks::<6>();
    finite(&memory.directions)?;
    let known = known.get(..memory.count as usize).ok_or(QDIST_ERROR_ARGUMENT)?;
    Ok(ForceSolver::knowing(known.iter().map(|&u| Vector::from(u))))
}

fn convert(options: In<qdist_force_options_f64>) -> Check<ForceOptions<f64>> {
    let (mut made, options) = (ForceOptions::default(), options.or_default()?);
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
///
/// Status: FRAME (frame), NONFINITE (share, or the force is too large); of the contact: CONTACT_POSITION, CONTACT_NORMAL, CONTACT_TANGENTS,
/// CONTACT_FRICTION, CONTACT_CAP.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_contact_force_f64(
    contact: In<qdist_contact_f64>,
    frame: In<qdist_wrench_frame_f64>,
    share: In<f64>,
    force: Out<f64>,
) -> qdist_status {
    status_of(|| {
        force.checked()?;
        let (contact, frame, share) = (contact.get()?.checked(), frame.get()?.checked()?, share.numbers::<6>()?);
        finite(&share)?;
        let made: [f64; 4] = frame.contact_force(&contact.map_err(from_contact)?, &Vector::from(share)).into();
        finite(&made)?;
        force.rows().put(made)
    })
}
