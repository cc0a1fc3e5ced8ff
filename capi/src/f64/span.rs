//! FLAT SETS
//!
//! A set in a line, plane or other subspace has depth 0 in the whole space, but a depth of its own in its subspace. This function
//! measures a flat set that contains the origin there, with the projection of Q on it; `dimension` of the result tells the
//! subspace's dimension, and directions and points are those of the whole space. Any other set is answered as by
//! qdist_solve. Flat means: no wider than the rounding of A's support function. Costs dimension + 1 to 2 * dimension + 2 more support
//! calls. A program that calls this function contains the solvers of all dimensions.

use super::*;

/// The depth d of the origin in the set A with respect to the unit set Q, in the linear span of A, in the dimension of the solver. Arguments as of
/// qdist_solve2 to qdist_solve6.
///
/// Status: as of qdist_solve2.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_solve_in_span_f64(
    solver: Out<qdist_solver>,
    a: In<qdist_set_f64>,
    q: In<qdist_unit_f64>,
    options: In<qdist_options_f64>,
    result: Out<qdist_result_f64>,
) -> qdist_status {
    let question = Question { solver, a, q, options, result };
    status(handle::dimension(&question.solver).and_then(|n| in_dimension!(n, solve_in_span::<N>(&question))))
}

fn solve_in_span<const N: usize>(question: &Question) -> Check {
    question.conclude(question.ask::<N>(|solver, a, q, options| solver.solve_in_span(a, q, options))?)
}
