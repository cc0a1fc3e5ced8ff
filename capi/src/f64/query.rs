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

use super::*;
use qdist::internal::depth_by_routes;

/// How a query ends, and where it looks first. NULL stands for the defaults. Start with qdist_options_default: absolute and
/// relative must not both be 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_options_f64 {
    pub struct_size: u32,
    /// The most steps (see `iterations` of qdist_result), over all plans; 0: 50,000, which take half a second to two seconds in
    /// dimension 6 (`./x figures`; `cargo run --release --features std --example worst_case`), and 64 for each vertex of a polytopal Q.
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
versioned!(qdist_options_f64);

/// The depth of two bodies.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_depth_f64 {
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
    /// Steps of all plans, as in qdist_result: points of A - B that were asked for to go on with.
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
versioned!(qdist_depth_f64);

/// The generalized depth of the origin in a set.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_result_f64 {
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
    /// Steps of all plans, which max_iterations limits: points of A that a plan asked for to go on with. No steps, and counted by support_calls
    /// alone, are the first points, the point with which a ray or a walk ends, what looks for a rival or for the ends of an arc, what is asked
    /// again (without shortcuts, in two words), and what pushes facets out that rounding would swallow. A pass of rays that ends without an
    /// answer counts a step that asks nothing.
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
versioned!(qdist_result_f64);

impl Defaults for qdist_options_f64 {
    fn defaults() -> Self {
        Self { struct_size: size_of::<Self>() as u32, relative: f64::RELATIVE_TOLERANCE, ..Self::ZERO }
    }
}

/// Writes the defaults.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_options_default_f64(options: Out<qdist_options_f64>) -> qdist_status {
    status(options.put(qdist_options_f64::defaults()))
}

/// Penetration depth or distance of two bodies in space, with witness points. A and B may be the same body. The solver is
/// one of dimension 3. Swapping A and B turns the normal and swaps the points.
///
/// Status: those of a solver, of a body (a, b), which a half space has as qdist_body_half_space, and of options; ARGUMENT (a or b: `route` is NULL, so that no
/// function has made the body); CALLBACK (a or b); NONFINITE (also: the difference of the bodies is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_depth3_f64(
    solver: Out<qdist_solver>,
    a: In<qdist_body_f64>,
    b: In<qdist_body_f64>,
    options: In<qdist_options_f64>,
    result: Out<qdist_depth_f64>,
) -> qdist_status {
    status(depth(solver, a, b, options, result, |solver, [a, b], options| depth_by_routes(solver, a, b, options)))
}

/// The depth d of the origin in the set A with respect to the unit set Q, in dimension 2, which is also the solver's. Q may be
/// NULL: the unit ball.
///
/// Status: those of a solver, of a set (a), of a unit set (q) and of options; CALLBACK (a or q); NONFINITE (also: the numbers of a became too
/// large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_solve2_f64(
    solver: Out<qdist_solver>,
    a: In<qdist_set_f64>,
    q: In<qdist_unit_f64>,
    options: In<qdist_options_f64>,
    result: Out<qdist_result_f64>,
) -> qdist_status {
    status(Question { solver, a, q, options, result }.solve::<2>())
}

// Likewise in dimensions 3 to 6.
