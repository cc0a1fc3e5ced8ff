//! FLAT SETS
//!
//! A set in a line, plane or other subspace has depth 0 in the whole space, but a depth of its own in its subspace. These functions
//! measure a flat set that contains the origin there, with the projection of Q on it; `dimension` of the result tells the
//! subspace's dimension, and directions and points are those of the whole space. Any other set is answered as by
//! qdist_solve. Flat means: no wider than the rounding of A's support function. Costs dimension + 1 to 2 * dimension + 2 more support
//! calls. A program that calls one of them contains the solvers of all lower dimensions too.

use super::super::handle::qdist_solver;
use super::super::status::{Check, qdist_status, status};
use super::query::{Asked, qdist_options_f64, qdist_result_f64};
use super::sets::qdist_set_f64;
use super::unit_sets::qdist_unit_f64;

/// The depth d of the origin in the set A with respect to the unit set Q, in the linear span of A, in dimension 2. Arguments as of
/// qdist_solve2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve_in_span2_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve_in_span::<2>(solver, a, q, options, result) })
}

/// The same in dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve_in_span3_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve_in_span::<3>(solver, a, q, options, result) })
}

/// The same in dimension 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve_in_span4_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve_in_span::<4>(solver, a, q, options, result) })
}

/// The same in dimension 5.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve_in_span5_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve_in_span::<5>(solver, a, q, options, result) })
}

/// The same in dimension 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve_in_span6_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve_in_span::<6>(solver, a, q, options, result) })
}

/// # Safety
/// What the header asks of the caller of `qdist_solve`.
unsafe fn solve_in_span<const N: usize>(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> Check {
    // SAFETY: the caller's promise.
    let mut asked = unsafe { Asked::<N>::new(solver, a, q, options, result) }?;
    let Asked { solver, a, q, options, deadline, .. } = &mut asked;
    let answer = deadline.during(|interrupt| solver.solve_in_span_until(*a, q.unit(), options, interrupt));
    asked.conclude(&answer)
}
