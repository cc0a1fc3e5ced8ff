//! WARM START
//!
//! For control loops. A tracker remembers the minimisers and the certified lower bound of the last tick. Where the caller knows how
//! far the set has moved since, the old lower bound less that distance is a new one, and the old minimisers give upper bounds
//! for one support call each. If that bracket is as narrow as the options ask for, it is the answer (QDIST_PLAN_WARM); else the solver
//! goes on from there, within max_iterations and `interrupt`, and the result is never worse. Let the first tick converge, without a
//! limit and to a tighter tolerance than the others: ticks are answered at once while what the moves have cost fits between the two.
//!
//!   qdist_tracker_init_f64(&tracker, 6);
//!   moved = -1;
//!   for (;;) {
//!       ... A moves; `moved` bounds how far any of its points did ...
//!       qdist_solve_warm6_f64(solver, &tracker, &a, &q, moved, &options, &result);
//!   }

use super::*;
use qdist::Tracker;
use qdist::internal::REMEMBERED;

const _: () = assert!(REMEMBERED == 4);

/// What a loop remembers: plain data without addresses, for one set, one unit set and one dimension. Made by
/// qdist_tracker_init_f64.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_tracker_f64 {
    pub struct_size: u32,
    pub dimension: u32,
    /// d of the last set is not less; -DBL_MAX (float: FLT_MAX): not known.
    pub lower: f64,
    /// Unit vectors, the last minimiser first; unused ones are 0.
    pub directions: [[f64; 6]; 4],
}
gaps!(qdist_tracker_f64);

/// Makes a tracker that remembers nothing, for a dimension of 2 to 6. Do it again when Q changes.
///
/// Status: DIMENSION (dimension).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_tracker_init_f64(tracker: Out<qdist_tracker_f64>, dimension: u32) -> qdist_status {
    status(tracker.checked().and_then(|()| {
        super::super::numbers::dimension(dimension)?;
        tracker.put(qdist_tracker_f64::new(dimension))
    }))
}

/// The certified lower bound of d after A has moved by at most `moved`, without a query; -DBL_MAX (float: FLT_MAX) where nothing is
/// remembered, or where Q has no known inner_radius. Arguments as of qdist_solve_warm; Q may be NULL.
///
/// Status: DIMENSION (tracker->dimension), ARGUMENT (a direction of the tracker is neither of unit length nor 0), NONFINITE (moved, or a number
/// of the tracker); those of a unit set (q).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_tracker_lower_after_f64(
    tracker: In<qdist_tracker_f64>,
    q: In<qdist_unit_f64>,
    moved: f64,
    lower: Out<f64>,
) -> qdist_status {
    status_of(|| {
        lower.checked()?;
        finite(&[moved])?;
        let tracker = tracker.get()?;
        lower.put(in_dimension!(tracker.dimension, tracker.lower_after::<N>(q, moved))?)
    })
}

/// The depth d of the origin in the set A with respect to the unit set Q, in dimension 2, for the next tick of a loop, and
/// takes note of it in the tracker. Arguments as of qdist_solve2; besides:
///
/// moved: A is the set of the last call with this tracker, moved or deformed so that no point of either is farther than this from the
/// other (Hausdorff distance), in your unit; a negative number: not known, and only the directions are used.
///
/// Status: as of qdist_solve2, and of the tracker as of qdist_tracker_lower_after; NONFINITE (moved).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_solve_warm2_f64(
    solver: Out<qdist_solver>,
    tracker: Out<qdist_tracker_f64>,
    a: In<qdist_set_f64>,
    q: In<qdist_unit_f64>,
    moved: f64,
    options: In<qdist_options_f64>,
    result: Out<qdist_result_f64>,
) -> qdist_status {
    status(solve_warm::<2>(&Question { solver, a, q, options, result }, tracker, moved))
}

// Likewise in dimensions 3 to 6.

impl qdist_tracker_f64 {
    fn new(dimension: u32) -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            dimension,
            lower: -f64::HUGE,
            directions: [[0.0; MAX_DIMENSION]; REMEMBERED],
        }
    }

    /// As the solver knows it. Directions are brought to unit length, which bounds rely on.
    fn checked<const N: usize>(&self) -> Check<Tracker<f64, N>> {
        if self.struct_size as usize != size_of::<Self>() {
            return Err(QDIST_ERROR_STRUCT_SIZE);
        }
        if dimension(self.dimension)? != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        finite(&[self.lower])?;
        let lower = Some(self.lower).filter(|&lower| lower > -f64::HUGE);
        let mut tracker = Tracker { lower, ..Tracker::new() };
        for (to, from) in tracker.directions.iter_mut().zip(&self.directions) {
            let from = first(from, N)?;
            finite(from)?;
            let squared = dot(from, from);
            if squared > 0.98 && squared < 1.02 {
                *to = Some(Vector::from_iterator(from.iter().copied()) / squared.root());
            } else if !from.iter().all(|&x| x == 0.0) {
                return Err(QDIST_ERROR_ARGUMENT);
            }
        }
        Ok(tracker)
    }

    fn lower_after<const N: usize>(&self, q: In<qdist_unit_f64>, moved: f64) -> Check<f64> {
        let tracker = self.checked::<N>()?;
        Ok(tracker.lower_after(moved, CheckedUnit::new::<N>(&q)?.unit()).unwrap_or(-f64::HUGE))
    }
}

pub(super) fn solve_warm<const N: usize>(question: &Question, tracker: Out<qdist_tracker_f64>, moved: f64) -> Check {
    finite(&[moved])?;
    let mut memory = tracker.get()?.checked::<N>()?;
    let moved = (moved >= 0.0).then_some(moved);
    let answered = question.ask::<N>(|solver, a, q, options| solver.solve_warm(&mut memory, a, q, moved, options))?;
    let mut noted = qdist_tracker_f64::new(N as u32);
    noted.lower = memory.lower.unwrap_or(-f64::HUGE);
    for (to, from) in noted.directions.iter_mut().zip(memory.directions.iter().flatten()) {
        *to = padded(from.iter().copied());
    }
    tracker.put(noted)?;
    question.conclude(answered)
}
