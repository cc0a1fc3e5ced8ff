// generated from f64/query.rs by `make header`; do not edit
//! QUERIES
//!
//! Every query returns a bracket: lower <= d <= upper holds whatever the outcome, rounding included. It is as narrow as
//! the options ask for when the outcome is QDIST_CONVERGED, and that or as narrow as rounding allows for QDIST_TOUCHING; with
//! QDIST_SEPARATED it may be wider when an iteration limit ended the search. An end that is not known is
//! -FLT_MAX or FLT_MAX.
//!
//! The result is written when the call works, or when only a callback failed; otherwise it is left as it was.

use super::super::generic::{
    CallbackGauge, MAX_DIMENSION, MAX_POINTS, aligned, finite, first, flag, known_size, length, shared,
};
use super::super::handle::{self, qdist_solver};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_CALLBACK, QDIST_ERROR_DIMENSION, from_body, outcome, qdist_outcome,
    qdist_status, status,
};
use super::gauges::qdist_gauge_f32;
use super::sets::{qdist_body_f32, qdist_set_f32};
use crate::qset::Ball;
use crate::scalar::{Real, Vector};
use crate::support::{alone, one_by_one};
use crate::{Answer, Depth, Options, Outcome};

/// How a query ends, and where it looks first. NULL stands for the defaults. Start with qdist_options_default: absolute and
/// relative must not both be 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_options_f32 {
    /// sizeof(qdist_options_f32).
    pub struct_size: u32,
    /// The most points to add; 0: as many as the solver holds.
    pub max_iterations: u32,
    /// Stop when upper - lower <= max(absolute, relative * |d|). Both >= 0, not both 0. Default 0.
    pub absolute: f32,
    /// See `absolute`. Default: 1e-6 in double, 1e-4 in float.
    pub relative: f32,
    /// With use_threshold: stop as soon as d >= threshold or d < threshold is certain.
    pub threshold: f32,
    /// 0 or 1.
    pub use_threshold: u32,
    /// 0 or 1.
    pub use_guess: u32,
    /// With use_guess: a direction to look in first, of any length: the normal or direction of the last result. The first
    /// numbers count, as many as the dimension.
    pub guess: [f32; 6],
}

/// The depth of two bodies.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_depth_f32 {
    /// sizeof(qdist_depth_f32); set it before the call.
    pub struct_size: u32,
    /// What was concluded.
    pub outcome: qdist_outcome,
    /// Bracket of the signed depth: above 0 the length of the shortest translation that separates the bodies; below 0
    /// minus their distance.
    pub lower: f32,
    pub upper: f32,
    /// Unit vector from A to B that proves `upper`: moved by upper * normal, B no longer overlaps A.
    pub normal: [f32; 3],
    /// Witness points on A and B, in the world. For QDIST_CONVERGED, QDIST_TOUCHING and QDIST_SEPARATED (elsewhere they only
    /// prove `lower`), point_a - point_b is depth * normal up to the tolerance: the points that touch
    /// after B has been moved, or the nearest points of separated bodies.
    pub point_a: [f32; 3],
    pub point_b: [f32; 3],
    /// Affine dimension of A - B, without ball terms, as far as it was found out: 3 unless it is flat.
    pub dimension: u32,
    /// Points added.
    pub iterations: u32,
    /// Calls of each body's support function.
    pub support_calls: u32,
    /// A solver with so many vertices and facets would have done, unless the outcome is QDIST_CAPACITY or QDIST_ITERATIONS.
    pub vertices_used: u32,
    pub facets_used: u32,
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    pub callback_code: i32,
}

/// The generalized depth of the origin in a set.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_result_f32 {
    /// sizeof(qdist_result_f32); set it before the call.
    pub struct_size: u32,
    /// What was concluded.
    pub outcome: qdist_outcome,
    /// Bracket of d = max { d : d * Q inside A }, in units of Q; below 0 it is minus the Euclidean distance of A from the
    /// origin, for every Q.
    pub lower: f32,
    pub upper: f32,
    /// Unit vector u that proves `upper`: h_A(u) / h_Q(u). The weakest direction of A. Unused numbers are 0.
    pub direction: [f32; 6],
    /// Evidence for `lower`: so many points of A's core, in `points` and `weights`; at most dimension + 1.
    pub point_count: u32,
    /// Affine dimension of A's core, as far as it was found out.
    pub dimension: u32,
    /// Points added.
    pub iterations: u32,
    /// Calls of A's support function.
    pub support_calls: u32,
    /// A solver with so many vertices and facets would have done, unless the outcome is QDIST_CAPACITY or QDIST_ITERATIONS.
    pub vertices_used: u32,
    pub facets_used: u32,
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    pub callback_code: i32,
    /// Weights of the points, >= 0, of sum 1: for a Euclidean Q, of the point of their simplex nearest to the origin.
    pub weights: [f32; 7],
    /// Coordinate k of point i is points[i * (dimension of the solver) + k].
    pub points: [f32; 42],
}

/// Writes the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_options_default_f32(options: *mut qdist_options_f32) -> qdist_status {
    let fill = || {
        aligned(options)?;
        let default = qdist_options_f32 {
            struct_size: size_of::<qdist_options_f32>() as u32,
            max_iterations: 0,
            absolute: 0.0,
            relative: f32::RELATIVE_TOLERANCE,
            threshold: 0.0,
            use_threshold: 0,
            use_guess: 0,
            guess: [0.0; MAX_DIMENSION],
        };
        // SAFETY: checked.
        unsafe { options.write(default) };
        Ok(())
    };
    status(fill())
}

/// Penetration depth or distance of two bodies in space, with witness points. A and B may be the same body. The solver is
/// one of dimension 3. Swapping A and B turns the normal and swaps the points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_depth3_f32(
    solver: *mut qdist_solver,
    a: *const qdist_body_f32,
    b: *const qdist_body_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_depth_f32,
) -> qdist_status {
    let solve = || {
        aligned(result)?;
        // SAFETY: what the header asks of the caller.
        let (mut solver, a, b) = unsafe {
            let (a, b) = (shared(a)?, shared(b)?);
            let solver = handle::open::<f32, 3>(solver)?;
            known_size((&raw const (*result).struct_size).read(), size_of::<qdist_depth_f32>())?;
            (solver, a, b)
        };
        // SAFETY: what the header asks of the caller.
        let (a, b, options) = unsafe { (a.checked()?, b.checked()?, convert::<3>(options)) };
        // Taken by reference out of their `Result`s: to move a large struct that was just written takes long.
        let (a, b) = (a.place(), b.place());
        let depth = match (&a, &b, &options) {
            (Ok(a), Ok(b), Ok(options)) => solver.depth(a, b, options),
            (_, _, Err(status)) => return Err(*status),
            (Err(error), ..) | (_, Err(error), _) => return Err(from_body(*error)),
        };
        // SAFETY: checked.
        unsafe { result.write(from_depth(&depth)) };
        conclude(depth.outcome)
    };
    status(solve())
}

/// The depth d of the origin in the set A with respect to the gauge set Q, in dimension 2, which is also the solver's. Q may be
/// NULL: the unit ball.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve2_f32(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<2>(solver, a, q, options, result) })
}

/// The same in dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve3_f32(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<3>(solver, a, q, options, result) })
}

/// The same in dimension 4.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve4_f32(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<4>(solver, a, q, options, result) })
}

/// The same in dimension 5.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve5_f32(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<5>(solver, a, q, options, result) })
}

/// The same in dimension 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_solve6_f32(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { solve::<6>(solver, a, q, options, result) })
}

/// The options as the solver knows them.
///
/// # Safety
/// If not NULL and aligned, `options` is valid for reads.
unsafe fn convert<const N: usize>(options: *const qdist_options_f32) -> Check<Options<f32, N>> {
    if options.is_null() {
        return Ok(Options::default());
    }
    // SAFETY: the caller's promise.
    let options = unsafe { shared(options) }?;
    known_size(options.struct_size, size_of::<qdist_options_f32>())?;
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
    Ok(Options { absolute, relative, threshold, max_iterations: options.max_iterations, guess })
}

fn conclude(outcome: Outcome) -> Check {
    if outcome == Outcome::SupportFailed { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
}

fn from_depth(depth: &Depth<f32>) -> qdist_depth_f32 {
    qdist_depth_f32 {
        struct_size: size_of::<qdist_depth_f32>() as u32,
        outcome: outcome(depth.outcome),
        lower: depth.lower,
        upper: depth.upper,
        normal: one_by_one(&depth.normal).into(),
        point_a: one_by_one(&depth.point_a).into(),
        point_b: one_by_one(&depth.point_b).into(),
        dimension: depth.dimension as u32,
        iterations: depth.iterations,
        support_calls: depth.support_calls,
        vertices_used: alone(&depth.vertices) as u32,
        facets_used: alone(&depth.facets) as u32,
        callback_code: depth.failure,
    }
}

fn from_answer<const N: usize>(answer: &Answer<f32, N>) -> qdist_result_f32 {
    let mut result = qdist_result_f32 {
        struct_size: size_of::<qdist_result_f32>() as u32,
        outcome: outcome(answer.outcome),
        lower: answer.lower,
        upper: answer.upper,
        direction: [0.0; MAX_DIMENSION],
        point_count: answer.witness.corners.len() as u32,
        dimension: answer.dimension as u32,
        iterations: answer.iterations,
        support_calls: answer.support_calls,
        vertices_used: answer.vertices as u32,
        facets_used: answer.facets as u32,
        callback_code: answer.failure,
        weights: [0.0; MAX_POINTS],
        points: [0.0; MAX_POINTS * MAX_DIMENSION],
    };
    for (to, &x) in result.direction.iter_mut().zip(&answer.direction) {
        *to = x;
    }
    for (to, corner) in result.weights.iter_mut().zip(&answer.witness.corners) {
        *to = corner.weight;
    }
    let coordinates = answer.witness.corners.iter().flat_map(|corner| corner.vertex.point.iter());
    for (to, &x) in result.points.iter_mut().zip(coordinates) {
        *to = x;
    }
    result
}

/// # Safety
/// What the header asks of the caller of `qdist_solve`.
unsafe fn solve<const N: usize>(
    solver: *mut qdist_solver,
    a: *const qdist_set_f32,
    q: *const qdist_gauge_f32,
    options: *const qdist_options_f32,
    result: *mut qdist_result_f32,
) -> Check {
    aligned(result)?;
    // SAFETY: the caller's promise.
    let (mut solver, a, options) = unsafe {
        let a = shared(a)?;
        let solver = handle::open::<f32, N>(solver)?;
        known_size((&raw const (*result).struct_size).read(), size_of::<qdist_result_f32>())?;
        (solver, a.checked::<N>()?, convert::<N>(options)?)
    };
    // SAFETY: the caller's promise.
    let answer = match unsafe { gauge::<N>(q) }? {
        Either::Ball(ball) => solver.solve(a, &ball, &options),
        Either::Other(gauge) => solver.solve(a, &gauge, &options),
    };
    // SAFETY: checked.
    unsafe { result.write(from_answer(&answer)) };
    conclude(answer.outcome)
}

enum Either {
    Ball(Ball<f32>),
    Other(CallbackGauge<f32>),
}

/// # Safety
/// What the header asks of the caller of `qdist_solve`.
unsafe fn gauge<const N: usize>(q: *const qdist_gauge_f32) -> Check<Either> {
    if q.is_null() {
        return Ok(Either::Ball(Ball::unit()));
    }
    // SAFETY: the caller's promise.
    let q = unsafe { shared(q) }?;
    if q.dimension != 0 && q.dimension as usize != N {
        return Err(QDIST_ERROR_DIMENSION);
    }
    let radius = length(q.ball_radius)?;
    if radius > 0.0 {
        return Ball::new(radius).map(Either::Ball).map_err(super::super::status::from_shape);
    }
    // SAFETY: the caller's promise.
    unsafe { CallbackGauge::new::<N>(q.value, q.user, q.extent) }.map(Either::Other)
}
