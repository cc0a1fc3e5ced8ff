//! QUESTIONS ABOUT GRASPS
//!
//! Force closure, and the best of many grasps. The depth itself, contact forces for one wrench (a segment as Q) and "is it at least so
//! much?" (use_threshold of the options) are what qdist_solve6 answers.

use super::*;

/// Is a grasp force-closed?
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_closure_f64 {
    pub struct_size: u32,
    /// QDIST_CLOSURE_OPEN, QDIST_CLOSURE_CLOSED or QDIST_CLOSURE_UNDECIDED.
    pub verdict: qdist_closure,
    /// QDIST_CLOSURE_CLOSED: the wrench set contains the ball of this radius, which proves closure; d can be much larger. Else 0.
    pub radius: f64,
    /// QDIST_CLOSURE_OPEN: a unit vector u such that no contact forces exert a wrench w with u.w above its own rounding; the external wrench -u
    /// is not resisted. QDIST_CLOSURE_UNDECIDED: the weakest direction so far. Else 0.
    pub direction: [f64; 6],
}
gaps!(qdist_closure_f64);
versioned!(qdist_closure_f64);

/// The best of a list of sets.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_best_f64 {
    pub struct_size: u32,
    /// Its place in the list, from 0.
    pub index: u32,
    /// No set of the list has a larger d than this.
    pub ceiling: f64,
    /// Its result; its struct_size, too, is set before the call.
    pub result: qdist_result_f64,
}
gaps!(qdist_best_f64, result.callback_code..);
versioned!(qdist_best_f64);

/// Is the origin in the interior of the set, of dimension 6? Ends at the first proof of either answer, usually after some 10 to 100 calls of the
/// support function; what lies between, d above 0 by little more than rounding, is undecided. The torque scale does not matter for sets of wrenches,
/// whose rounding is known coordinate by coordinate. Tolerances and threshold of the options are not used.
///
/// Status: those of a solver, of a set (set) and of options. (A callback that fails leaves the question undecided.)
#[unsafe(no_mangle)]
pub extern "C" fn qdist_force_closure_f64(
    solver: Out<qdist_solver>,
    set: In<qdist_set_f64>,
    options: In<qdist_options_f64>,
    closure: Out<qdist_closure_f64>,
) -> qdist_status {
    status_of(|| {
        closure.checked()?;
        let set = set.get()?;
        let mut solver = handle::open::<f64, 6>(&solver)?;
        closure.known()?;
        let (options, deadline) = convert::<6>(options)?;
        let (checked, list) = (CheckedSet::new::<6>(set)?, behind(set));
        let set: &dyn Support<f64, 6> = match &list {
            Some(list) => list,
            None => &checked,
        };
        let found = deadline.during(&options, |options| solver.force_closure(set, options));
        let (verdict, radius, direction) = match found {
            Closure::Closed { radius } => (QDIST_CLOSURE_CLOSED, radius, [0.0; 6]),
            Closure::Open { direction } => (QDIST_CLOSURE_OPEN, 0.0, padded(direction.iter().copied())),
            Closure::Undecided { direction } => (QDIST_CLOSURE_UNDECIDED, 0.0, padded(direction.iter().copied())),
        };
        let struct_size = size_of::<qdist_closure_f64>() as u32;
        closure.put_version(qdist_closure_f64 { struct_size, verdict, radius, direction })
    })
}

/// The set with the largest d of `count` sets of dimension 6, 1 or more, in one solver's memory. A set is left as soon as it is certainly not
/// better than the best so far. A threshold in the options is not used; `interrupt` leaves the set at hand and those after it with the bounds
/// that they have.
///
/// Status: those of a solver, of a set (any of sets), of a unit set (q) and of options; ARGUMENT (count is 0), CALLBACK (a set or q), NONFINITE
/// (also: the numbers of a set became too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_best_of6_f64(
    solver: Out<qdist_solver>,
    sets: In<qdist_set_f64>,
    count: u32,
    q: In<qdist_unit_f64>,
    options: In<qdist_options_f64>,
    best: Out<qdist_best_f64>,
) -> qdist_status {
    status_of(|| {
        best.checked()?;
        let sets = sets.array(Some(count as usize))?;
        let mut solver = handle::open::<f64, 6>(&solver)?;
        best.known()?;
        best.part::<qdist_result_f64>(core::mem::offset_of!(qdist_best_f64, result))?.known()?;
        sets.iter().try_for_each(|set| set.check(6))?;
        let (options, deadline) = convert::<6>(options)?;
        let q = CheckedUnit::new::<6>(&q)?;
        let checked = sets.iter().filter_map(|set| CheckedSet::new::<6>(set).ok());
        let found = deadline.during(&options, |options| solver.best_of(checked, q.unit(), options));
        let found = found.ok_or(QDIST_ERROR_ARGUMENT)?;
        overflow(found.answer.failure)?;
        best.put_version(qdist_best_f64 {
            struct_size: size_of::<qdist_best_f64>() as u32,
            index: found.index as u32,
            ceiling: found.ceiling,
            result: from_answer(&found.answer, q.code(found.answer.failure)),
        })?;
        if found.answer.failure.is_some() { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
    })
}
