//! QUERIES
//!
//! Every query returns a bracket: lower <= d <= upper holds whatever the outcome, rounding included. It is as narrow as
//! the options ask for when the outcome is QDIST_CONVERGED, and that or as narrow as rounding allows for QDIST_TOUCHING; with
//! QDIST_SEPARATED it may be wider when a limit, `interrupt` or the scalar type ended the search. An end that is not known is
//! -DBL_MAX or DBL_MAX (float: FLT_MAX).
//!
//! The result is written when the call works, or when only a callback failed; otherwise it is left as it was.
//!
//! qdist_solve chooses a plan by what the query is, and tells it in the result. With at least 3 * dimension vertices and
//! 4 * dimension facets it converges in any memory, given the iterations: the less memory, the more (in dimension 6, 64 vertices and 512
//! facets are a sensible least). max_iterations and `interrupt` bound the work.
//!
//! The gradient of d > 0. d = min over u of h_A(u) / h_Q(u); where the minimiser u is unique and A smooth there, the envelope theorem
//! gives the derivative with respect to any parameter p of A or Q from quantities of the result:
//!
//!   dd/dp = (direction . ds/dp - d * dh_Q/dp) / h_Q
//!
//! with ds/dp the velocity of A's point at `support` as p changes, and dh_Q/dp the change of h_Q(direction). Where A has a face
//! there, ds/dp is the mean of the velocities of `points` with `weights`. When A is translated, the gradient is direction / h_Q.
//! It is exact up to about the square root of the bracket's relative width. With has_rival the minimiser is not unique: then d has
//! one-sided derivatives, each the least of those at all minimisers.

use super::super::generic::{
    Deadline, MAX_DIMENSION, MAX_POINTS, aligned, finite, first, flag, gaps, known_size, length, padded, put, shared,
};
use super::super::handle::{self, Opened, qdist_solver};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_CALLBACK, from_body, from_status, outcome, overflow, plan,
    qdist_interrupt, qdist_outcome, qdist_plan, qdist_status, status,
};
use super::sets::{CheckedSet, qdist_body_f64, qdist_set_f64};
use super::unit_sets::{CheckedUnit, qdist_unit_f64};
use core::ffi::c_void;
#[cfg(feature = "grasp")]
use qdist::Plan;
use qdist::internal::{alone, one_by_one};
use qdist::{Answer, Depth, Options, Outcome};
use qdist::{Real, Vector};
#[cfg(feature = "grasp")]
use qdist::{Simplex, Vertex};

/// How a query ends, and where it looks first. NULL stands for the defaults. Start with qdist_options_default: absolute and
/// relative must not both be 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_options_f64 {
    /// sizeof(qdist_options_f64).
    pub struct_size: u32,
    /// The most points to add, over all plans; 0: 50,000, which take a second or two in dimension 6
    /// (`make figures`), and 64 for each vertex of a polytopal Q.
    pub max_iterations: u32,
    /// NULL; or asked before every iteration whether to stop (QDIST_INTERRUPTED).
    pub interrupt: qdist_interrupt,
    /// First argument of `interrupt`.
    pub interrupt_user: *mut c_void,
    /// Stop when upper - lower <= max(absolute, relative * |d|). Both >= 0, not both 0. Default 0.
    pub absolute: f64,
    /// See `absolute`. Default: 1e-6 in double, 1e-4 in float.
    pub relative: f64,
    /// With use_threshold: stop as soon as d >= threshold or d < threshold is certain.
    pub threshold: f64,
    /// 0 or 1.
    pub use_threshold: u32,
    /// 0 or 1.
    pub use_guess: u32,
    /// With use_guess: a direction to look in first, of any length: the normal or direction of the last result. The first
    /// numbers count, as many as the dimension.
    pub guess: [f64; 6],
}

gaps!(qdist_options_f64, guess..);

/// The depth of two bodies.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_depth_f64 {
    /// sizeof(qdist_depth_f64); set it before the call.
    pub struct_size: u32,
    /// What was concluded.
    pub outcome: qdist_outcome,
    /// Bracket of the signed depth: above 0 the length of the shortest translation that separates the bodies; below 0
    /// minus their distance.
    pub lower: f64,
    pub upper: f64,
    /// Unit vector from A to B that proves `upper`: moved by upper * normal, B no longer overlaps A. (Of vectors in the plane, the third
    /// number is 0.)
    pub normal: [f64; 3],
    /// Witness points on A and B, in the world. Where the bracket is as narrow as asked for (elsewhere they only prove `lower`), point_a - point_b is depth * normal up to the tolerance: the points that touch
    /// after B has been moved, or the nearest points of separated bodies.
    pub point_a: [f64; 3],
    pub point_b: [f64; 3],
    /// Affine dimension of A - B, without ball terms, as far as it was found out: 3 unless it is flat.
    pub dimension: u32,
    /// Points added.
    pub iterations: u32,
    /// Calls of the support function of the body that was asked more often: of both, unless one alone had to be measured because it does not
    /// state its extent.
    pub support_calls: u32,
    /// A solver with so many vertices and facets would have done, unless the run was cut short (QDIST_CAPACITY, QDIST_ITERATIONS,
    /// QDIST_INTERRUPTED).
    pub vertices_used: u32,
    pub facets_used: u32,
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    pub callback_code: i32,
}

gaps!(qdist_depth_f64, callback_code..);

/// The generalized depth of the origin in a set.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_result_f64 {
    /// sizeof(qdist_result_f64); set it before the call.
    pub struct_size: u32,
    /// What was concluded.
    pub outcome: qdist_outcome,
    /// How.
    pub plan: qdist_plan,
    /// 1: the minimiser is not unique, to the tolerance; see `rival`. 0: no second one was met.
    pub has_rival: u32,
    /// Bracket of d = max { d : d * Q inside A }, in units of Q; below 0 it is minus the Euclidean distance of A from the
    /// origin, in units of the radius where Q is a ball.
    pub lower: f64,
    pub upper: f64,
    /// Unit vector u that proves `upper`: h_A(u) / h_Q(u). The weakest direction of A. Unused numbers are 0.
    pub direction: [f64; 6],
    /// The point of A (its ball included) that is farthest along `direction`.
    pub support: [f64; 6],
    /// h_Q(direction).
    pub unit: f64,
    /// With has_rival: another unit vector, more than 8 degrees away, that bounds d as tightly.
    pub rival: [f64; 6],
    /// Weights of the points, >= 0, of sum 1: for a Euclidean Q, of the point of their simplex nearest to the origin.
    pub weights: [f64; 7],
    /// Coordinate k of point i is points[i * (dimension of the solver) + k].
    pub points: [f64; 42],
    /// Evidence for `lower`: so many points of A's core, in `points` and `weights`; at most dimension + 1.
    pub point_count: u32,
    /// Affine dimension of A's core, as far as it was found out.
    pub dimension: u32,
    /// Points added.
    pub iterations: u32,
    /// Calls of A's support function.
    pub support_calls: u32,
    /// A solver with so many vertices and facets would have done, unless the run was cut short (QDIST_CAPACITY, QDIST_ITERATIONS,
    /// QDIST_INTERRUPTED).
    pub vertices_used: u32,
    pub facets_used: u32,
    /// With QDIST_PLAN_CONES: cones in the last completed pass, and the most halvings of an orthant, of at most 192.
    pub cones: u32,
    pub splits: u32,
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    pub callback_code: i32,
}

gaps!(qdist_result_f64, callback_code..);

/// Writes the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_options_default_f64(options: *mut qdist_options_f64) -> qdist_status {
    let fill = || {
        aligned(options)?;
        let default = qdist_options_f64 {
            struct_size: size_of::<qdist_options_f64>() as u32,
            max_iterations: 0,
            interrupt: None,
            interrupt_user: core::ptr::null_mut(),
            absolute: 0.0,
            relative: f64::RELATIVE_TOLERANCE,
            threshold: 0.0,
            use_threshold: 0,
            use_guess: 0,
            guess: [0.0; MAX_DIMENSION],
        };
        // SAFETY: checked.
        unsafe { put(options, default) };
        Ok(())
    };
    status(fill())
}

/// Penetration depth or distance of two bodies in space, with witness points. A and B may be the same body. The solver is
/// one of dimension 3. Swapping A and B turns the normal and swaps the points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_depth3_f64(
    solver: *mut qdist_solver,
    a: *const qdist_body_f64,
    b: *const qdist_body_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_depth_f64,
) -> qdist_status {
    let solve = || {
        aligned(result)?;
        // SAFETY: what the header asks of the caller.
        let (mut solver, a, b) = unsafe {
            let (a, b) = (shared(a)?, shared(b)?);
            let solver = handle::open::<f64, 3>(solver)?;
            known_size((&raw const (*result).struct_size).read(), size_of::<qdist_depth_f64>())?;
            (solver, a, b)
        };
        if let Some(answer) = a.unbounded.or(b.unbounded) {
            let (a, b): (*const qdist_body_f64, *const qdist_body_f64) = (a, b);
            // SAFETY: a function of this library for these arguments, which are checked.
            return from_status(unsafe { answer(a.cast(), b.cast(), options.cast(), result.cast()) });
        }
        // SAFETY: what the header asks of the caller.
        let (a, b, options) = unsafe { (a.checked()?, b.checked()?, convert::<3>(options)) };
        // Taken by reference out of their `Result`s: to move a large struct that was just written takes long.
        let (a, b) = (a.place(), b.place());
        let depth = match (&a, &b, &options) {
            (Ok(a), Ok(b), Ok((options, deadline))) => {
                deadline.during(|interrupt| solver.depth_until(a, b, options, interrupt))
            }
            (_, _, Err(status)) => return Err(*status),
            (Err(error), ..) | (_, Err(error), _) => return Err(from_body(*error)),
        };
        overflow(depth.failure)?;
        // SAFETY: checked.
        unsafe { put(result, from_depth(&depth)) };
        conclude(depth.outcome)
    };
    status(solve())
}

/// The depth d of the origin in the set A with respect to the unit set Q, in dimension 2, which is also the solver's. Q may be
/// NULL: the unit ball.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve2_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<2>(solver, a, q, options, result) })
}

/// The same in dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve3_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<3>(solver, a, q, options, result) })
}

/// The same in dimension 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve4_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<4>(solver, a, q, options, result) })
}

/// The same in dimension 5.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve5_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<5>(solver, a, q, options, result) })
}

/// The same in dimension 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve6_f64(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<6>(solver, a, q, options, result) })
}

/// The options as the solver knows them, and the deadline.
///
/// # Safety
/// If not NULL and aligned, `options` is valid for reads; during the query `interrupt` may be called.
pub(super) unsafe fn convert<const N: usize>(options: *const qdist_options_f64) -> Check<(Options<f64, N>, Deadline)> {
    if options.is_null() {
        return Ok((Options::default(), Deadline::NEVER));
    }
    // SAFETY: the caller's promise.
    let options = unsafe { shared(options) }?;
    known_size(options.struct_size, size_of::<qdist_options_f64>())?;
    let (absolute, relative) = (length(options.absolute)?, length(options.relative)?);
    if !(absolute > 0.0 || relative > 0.0) {
        return Err(QDIST_ERROR_ARGUMENT);
    }
    let threshold = if flag(options.use_threshold)? {
        finite(&[options.threshold])?;
        Some(options.threshold)
    } else {
        None
    };
    let guess = if flag(options.use_guess)? {
        let guess = first(&options.guess, N)?;
        finite(guess)?;
        Some(Vector::from_iterator(guess.iter().copied()))
    } else {
        None
    };
    // SAFETY: the caller's promise.
    let deadline = unsafe { Deadline::new(options.interrupt, options.interrupt_user) };
    Ok((Options { absolute, relative, threshold, max_iterations: options.max_iterations, guess }, deadline))
}

pub(super) fn conclude(outcome: Outcome) -> Check {
    if outcome == Outcome::SupportFailed { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
}

/// The result for C; the third numbers of vectors in the plane are 0.
pub(super) fn from_depth<const N: usize>(depth: &Depth<f64, N>) -> qdist_depth_f64 {
    let vector = |v: &Vector<f64, N>| {
        let mut all = [0.0; 3];
        for (to, &x) in all.iter_mut().zip(&one_by_one(v)) {
            *to = x;
        }
        all
    };
    qdist_depth_f64 {
        struct_size: size_of::<qdist_depth_f64>() as u32,
        outcome: outcome(depth.outcome),
        lower: depth.lower,
        upper: depth.upper,
        normal: vector(&depth.normal),
        point_a: vector(&depth.point_a),
        point_b: vector(&depth.point_b),
        dimension: depth.dimension as u32,
        iterations: depth.iterations,
        support_calls: depth.support_calls,
        vertices_used: alone(&depth.vertices) as u32,
        facets_used: alone(&depth.facets) as u32,
        callback_code: depth.failure,
    }
}

pub(super) fn from_answer<const N: usize>(answer: &Answer<f64, N>, code: i32) -> qdist_result_f64 {
    let vector = |v: &Vector<f64, N>| padded(v.iter().copied());
    let mut result = qdist_result_f64 {
        struct_size: size_of::<qdist_result_f64>() as u32,
        outcome: outcome(answer.outcome),
        plan: plan(answer.plan),
        has_rival: u32::from(answer.rival.is_some()),
        lower: answer.lower,
        upper: answer.upper,
        direction: vector(&answer.direction),
        support: vector(&answer.support),
        unit: answer.unit,
        rival: answer.rival.as_ref().map_or([0.0; MAX_DIMENSION], vector),
        weights: [0.0; MAX_POINTS],
        points: [0.0; MAX_POINTS * MAX_DIMENSION],
        point_count: answer.witness.corners.len() as u32,
        dimension: answer.dimension as u32,
        iterations: answer.iterations,
        support_calls: answer.support_calls,
        vertices_used: answer.vertices as u32,
        facets_used: answer.facets as u32,
        cones: answer.cones,
        splits: answer.splits,
        callback_code: code,
    };
    for (to, corner) in result.weights.iter_mut().zip(&answer.witness.corners) {
        *to = corner.weight;
    }
    let coordinates = answer.witness.corners.iter().flat_map(|corner| corner.vertex.point.iter());
    for (to, &x) in result.points.iter_mut().zip(coordinates) {
        *to = x;
    }
    result
}

/// The answer of a result in dimension 6, without the evidence for `lower`: what there is to know about the minimiser.
#[cfg(feature = "grasp")]
pub(super) fn to_answer(result: &qdist_result_f64) -> Check<Answer<f64, 6>> {
    finite(&[result.lower, result.upper, result.unit])?;
    finite(&result.direction).and(finite(&result.support)).and(finite(&result.rival))?;
    let rival = flag(result.has_rival)?.then(|| Vector::from(result.rival));
    Ok(Answer {
        outcome: Outcome::Converged,
        lower: result.lower,
        upper: result.upper,
        direction: Vector::from(result.direction),
        support: Vector::from(result.support),
        unit: result.unit,
        rival,
        plan: Plan::Expansion,
        witness: Simplex::new(Vertex::empty()),
        dimension: result.dimension as usize,
        iterations: result.iterations,
        support_calls: result.support_calls,
        vertices: 0,
        facets: 0,
        cones: 0,
        splits: 0,
        failure: 0,
    })
}

/// A query in dimension `N` whose arguments have passed the checks.
pub(super) struct Asked<'w, const N: usize> {
    pub solver: Opened<'w, f64, N>,
    pub a: &'w CheckedSet,
    pub q: CheckedUnit,
    pub options: Options<f64, N>,
    pub deadline: Deadline,
    result: *mut qdist_result_f64,
}

impl<const N: usize> Asked<'_, N> {
    /// Checks the arguments of a query.
    ///
    /// # Safety
    /// What the header asks of the caller of `qdist_solve`, for the life of the value.
    #[inline(always)]
    pub unsafe fn new(
        solver: *mut qdist_solver,
        a: *const qdist_set_f64,
        q: *const qdist_unit_f64,
        options: *const qdist_options_f64,
        result: *mut qdist_result_f64,
    ) -> Check<Self> {
        aligned(result)?;
        // SAFETY: the caller's promise.
        unsafe {
            let a = shared(a)?;
            let solver = handle::open::<f64, N>(solver)?;
            known_size((&raw const (*result).struct_size).read(), size_of::<qdist_result_f64>())?;
            let a = a.checked::<N>()?;
            let (options, deadline) = convert::<N>(options)?;
            Ok(Self { solver, a, q: CheckedUnit::new::<N>(q)?, options, deadline, result })
        }
    }

    /// Writes the result.
    #[inline(always)]
    pub fn conclude(&self, answer: &Answer<f64, N>) -> Check {
        overflow(answer.failure)?;
        // SAFETY: `new` has checked it.
        unsafe { put(self.result, from_answer(answer, self.q.code(answer.failure))) };
        conclude(answer.outcome)
    }
}

/// # Safety
/// What the header asks of the caller of `qdist_solve`.
unsafe fn solve<const N: usize>(
    solver: *mut qdist_solver,
    a: *const qdist_set_f64,
    q: *const qdist_unit_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_result_f64,
) -> Check {
    // SAFETY: the caller's promise.
    let mut asked = unsafe { Asked::<N>::new(solver, a, q, options, result) }?;
    let Asked { solver, a, q, options, deadline, .. } = &mut asked;
    let answer = deadline.during(|interrupt| solver.solve_until(*a, q.unit(), options, interrupt));
    asked.conclude(&answer)
}
