//! STATUS, OUTCOME AND PLAN
//!
//! Three questions, three types. A status says whether the call worked. An outcome says what the run concluded, and whatever
//! it concluded, the bracket holds. A plan says how.

use super::vocabulary::*;
use qdist::support::ShapeError;
use qdist::{GraphError, WorkspaceError};

/// Did the call work? QDIST_OK, or a QDIST_ERROR that says what is wrong; then nothing has been written, except
/// with QDIST_ERROR_CALLBACK.
pub type qdist_status = i32;

/// The call worked.
pub const QDIST_OK: qdist_status = 0;
/// A pointer that must not be NULL is NULL.
pub const QDIST_ERROR_NULL: qdist_status = 1;
/// A number is out of range: a negative size, an empty list, a flag that is neither 0 nor 1.
pub const QDIST_ERROR_ARGUMENT: qdist_status = 2;
/// An argument is NaN or infinite, or a length is above 2e292 (float: 2e31), so that sums could overflow.
pub const QDIST_ERROR_NONFINITE: qdist_status = 3;
/// struct_size is not the size of a struct that this library knows.
pub const QDIST_ERROR_STRUCT_SIZE: qdist_status = 4;
/// The memory is shorter than QDIST_WORKSPACE_BYTES, QDIST_HULL_GRAPH_LEN or QDIST_HULL_LARGE_GRAPH_LEN says.
pub const QDIST_ERROR_WORKSPACE_SIZE: qdist_status = 5;
/// Memory or a struct is not aligned: solver memory to QDIST_WORKSPACE_ALIGN, all else to its type.
pub const QDIST_ERROR_ALIGNMENT: qdist_status = 6;
/// The dimension is not one of 2 to 6, or solver, set, unit set and function are not of the same dimension.
pub const QDIST_ERROR_DIMENSION: qdist_status = 7;
/// The solver was made for the other scalar type.
pub const QDIST_ERROR_SCALAR: qdist_status = 8;
/// max_vertices < dimension + 1, max_facets < 2 * dimension, or one of them above 65535; or a solver that is too small for
/// what it is to do.
pub const QDIST_ERROR_CAPACITY: qdist_status = 9;
/// The memory does not hold a solver.
pub const QDIST_ERROR_SOLVER: qdist_status = 10;
/// The matrix is not a rotation: an entry of R^T R - I is above 1e-4 in size, or det R < 0. Or the quaternion is not of unit length,
/// to 1e-6.
pub const QDIST_ERROR_ROTATION: qdist_status = 11;
/// A callback failed: the result is filled, with outcome QDIST_SUPPORT_FAILED, a true bracket and the callback's code.
pub const QDIST_ERROR_CALLBACK: qdist_status = 12;
/// All points of a hull lie in one plane: use qdist_points.
pub const QDIST_ERROR_FLAT: qdist_status = 13;
/// A contact's position is not finite or too large.
pub const QDIST_ERROR_CONTACT_POSITION: qdist_status = 14;
/// A contact's normal is not a unit vector.
pub const QDIST_ERROR_CONTACT_NORMAL: qdist_status = 15;
/// A contact's tangents are not unit vectors with n = o x t.
pub const QDIST_ERROR_CONTACT_TANGENTS: qdist_status = 16;
/// A contact's friction model is not known, or a coefficient is negative, not finite or too large.
pub const QDIST_ERROR_CONTACT_FRICTION: qdist_status = 17;
/// A contact's force cap is negative, not finite or too large.
pub const QDIST_ERROR_CONTACT_CAP: qdist_status = 18;
/// A contact's Jacobian has more than 8 joints, or a number that is not finite or too large.
pub const QDIST_ERROR_CONTACT_JACOBIAN: qdist_status = 19;
/// A contact's wrench is too large: a position or friction that is huge for the torque scale. Or a primitive's or pyramid's is not finite.
pub const QDIST_ERROR_CONTACT_WRENCH: qdist_status = 20;
/// The reference point is not finite, or the torque scale is not a positive number of usual size.
pub const QDIST_ERROR_FRAME: qdist_status = 21;
/// A rank tolerance below 16 roundoffs or above 1/2.
pub const QDIST_ERROR_TOLERANCE: qdist_status = 22;
/// A finger's torque limits: one is negative or not a number, or there are not as many as joints.
pub const QDIST_ERROR_TORQUE_LIMIT: qdist_status = 23;
/// The memory does not hold a finger of this scalar type.
pub const QDIST_ERROR_FINGER: qdist_status = 24;
/// A mesh has no triangles.
pub const QDIST_ERROR_MESH_EMPTY: qdist_status = 25;
/// A triangle of a mesh refers to a vertex that does not exist.
pub const QDIST_ERROR_MESH_INDEX: qdist_status = 26;
/// A coordinate of a mesh's vertex is NaN, infinite, or above 1e60 in size.
pub const QDIST_ERROR_MESH_VERTEX: qdist_status = 27;
/// All vertices that a mesh's triangles use lie on one line.
pub const QDIST_ERROR_MESH_COLLINEAR: qdist_status = 28;
/// What is asked for needs a solid, and the mesh bounds none: it is open, wound inconsistently or inward, or without volume.
pub const QDIST_ERROR_MESH_NOT_SOLID: qdist_status = 29;
/// The allocator is set already, or memory has been allocated without.
pub const QDIST_ERROR_ALLOCATOR: qdist_status = 30;
/// A defect of the library, which went no further. Please report it.
pub const QDIST_ERROR_INTERNAL: qdist_status = 31;
/// A callback uses the solver, pair or tracker that is calling it.
pub const QDIST_ERROR_BUSY: qdist_status = 32;
/// A half space where only sets with an end serve: in a join, or in a query of one set (as callback_code).
pub const QDIST_ERROR_UNBOUNDED: qdist_status = 33;
/// `interrupt` of qdist_hull_prepare or qdist_hull_large_prepare said so.
pub const QDIST_ERROR_INTERRUPTED: qdist_status = 34;
/// A hull of more points, or with more vertices, than the words of its graph can number: see QDIST_HULL_POINTS.
pub const QDIST_ERROR_HULL_POINTS: qdist_status = 35;

/// What did the run conclude?
pub type qdist_outcome = i32;

/// The bracket is as narrow as asked for, and the origin is inside: 0 < lower.
pub const QDIST_CONVERGED: qdist_outcome = 0;
/// Stopped early: lower >= threshold.
pub const QDIST_ABOVE: qdist_outcome = 1;
/// Stopped early: upper < threshold.
pub const QDIST_BELOW: qdist_outcome = 2;
/// The origin is outside: upper < 0, and the bracket is that of minus the Euclidean distance.
pub const QDIST_SEPARATED: qdist_outcome = 3;
/// The bracket is as narrow as asked for, or as arithmetic allows, and contains 0.
pub const QDIST_TOUCHING: qdist_outcome = 4;
/// The bracket cannot be narrowed in this scalar type; the tolerance asked for more.
pub const QDIST_PRECISION: qdist_outcome = 5;
/// The solver's memory is full. (qdist_solve goes on cone by cone, QDIST_PLAN_CONES, where there are 3 * dimension vertices and
/// 4 * dimension facets.)
pub const QDIST_CAPACITY: qdist_outcome = 6;
/// The iteration limit is reached.
pub const QDIST_ITERATIONS: qdist_outcome = 7;
/// The set is flat, as far as the rounding of its points tells, and the origin lies in it; `dimension` of the result says how flat. (A set that is
/// only thin ends with QDIST_PRECISION.)
pub const QDIST_DEGENERATE: qdist_outcome = 8;
/// A callback failed; the status is QDIST_ERROR_CALLBACK.
pub const QDIST_SUPPORT_FAILED: qdist_outcome = 9;
/// `interrupt` of the options said so.
pub const QDIST_INTERRUPTED: qdist_outcome = 10;
/// Two half spaces overlap without end: no translation separates them. d is infinite; both bounds are DBL_MAX (float: FLT_MAX).
pub const QDIST_UNBOUNDED: qdist_outcome = 11;

/// How was the query answered? What A and Q are decides it.
pub type qdist_plan = i32;

/// Expansion of one polytope, best first.
pub const QDIST_PLAN_EXPANSION: qdist_plan = 0;
/// By the distance of the core from the origin: the set has a radius, and the origin is outside of its core.
pub const QDIST_PLAN_DISTANCE: qdist_plan = 1;
/// Polytopal Q: one ray per vertex of Q, and no polytope.
pub const QDIST_PLAN_RAYS: qdist_plan = 2;
/// The polytope outgrew the memory: expansion cone by cone in the same memory.
pub const QDIST_PLAN_CONES: qdist_plan = 3;
/// The bracket of the last call, moved: nothing was expanded.
pub const QDIST_PLAN_WARM: qdist_plan = 4;

/// Asked before every iteration of a query; anything but 0 ends it with QDIST_INTERRUPTED and the best bracket so far. Look at a
/// clock or at a flag that an interrupt handler sets. (While a hull is prepared: asked for every 1,024 points looked at.)
///
/// user: interrupt_user of the options or the call.
pub type qdist_interrupt = Option<unsafe extern "C" fn(user: *mut c_void) -> i32>;

/// callback_code when a callback returned 0 but wrote NaN, infinity or nothing, or when a unit set returned NaN or a negative
/// number. Callbacks must not return it, nor INT32_MIN + 1 to INT32_MIN + 3.
pub const QDIST_CALLBACK_NONFINITE: i32 = -2147483647 - 1;

const _: () = assert!(QDIST_CALLBACK_NONFINITE == qdist::NOT_FINITE);

/// The name of a status, e.g. "null pointer". A static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_status_string(status: qdist_status) -> *const c_char {
    match status {
        QDIST_OK => c"ok",
        QDIST_ERROR_NULL => c"null pointer",
        QDIST_ERROR_ARGUMENT => c"argument out of range",
        QDIST_ERROR_NONFINITE => c"argument not finite or too large",
        QDIST_ERROR_STRUCT_SIZE => c"unknown struct size",
        QDIST_ERROR_WORKSPACE_SIZE => c"memory too short",
        QDIST_ERROR_ALIGNMENT => c"memory misaligned",
        QDIST_ERROR_DIMENSION => c"wrong dimension",
        QDIST_ERROR_SCALAR => c"solver of the other scalar type",
        QDIST_ERROR_CAPACITY => c"capacity out of range",
        QDIST_ERROR_SOLVER => c"not a solver",
        QDIST_ERROR_ROTATION => c"not a rotation",
        QDIST_ERROR_CALLBACK => c"callback failed",
        QDIST_ERROR_FLAT => c"points lie in a plane",
        QDIST_ERROR_CONTACT_POSITION => c"contact position not finite or too large",
        QDIST_ERROR_CONTACT_NORMAL => c"contact normal not of unit length",
        QDIST_ERROR_CONTACT_TANGENTS => c"contact tangents not orthonormal",
        QDIST_ERROR_CONTACT_FRICTION => c"contact friction out of range",
        QDIST_ERROR_CONTACT_CAP => c"contact force cap out of range",
        QDIST_ERROR_CONTACT_JACOBIAN => c"contact Jacobian out of range",
        QDIST_ERROR_CONTACT_WRENCH => c"contact wrench too large",
        QDIST_ERROR_FRAME => c"wrench frame out of range",
        QDIST_ERROR_TOLERANCE => c"rank tolerance out of range",
        QDIST_ERROR_TORQUE_LIMIT => c"torque limits out of range",
        QDIST_ERROR_FINGER => c"not a finger",
        QDIST_ERROR_MESH_EMPTY => c"mesh without triangles",
        QDIST_ERROR_MESH_INDEX => c"mesh triangle refers to no vertex",
        QDIST_ERROR_MESH_VERTEX => c"mesh vertex not finite or too large",
        QDIST_ERROR_MESH_COLLINEAR => c"mesh vertices lie on a line",
        QDIST_ERROR_MESH_NOT_SOLID => c"mesh bounds no solid",
        QDIST_ERROR_ALLOCATOR => c"allocator set or in use",
        QDIST_ERROR_INTERNAL => c"defect of the library",
        QDIST_ERROR_BUSY => c"solver in use by the caller of the callback",
        QDIST_ERROR_UNBOUNDED => c"half space where it cannot serve",
        QDIST_ERROR_INTERRUPTED => c"interrupted",
        QDIST_ERROR_HULL_POINTS => c"too many points for the words of a hull",
        _ => c"unknown status",
    }
    .as_ptr()
}

/// The name of an outcome, e.g. "converged". A static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_outcome_string(outcome: qdist_outcome) -> *const c_char {
    outcome_name(outcome)
}

/// The name of a plan, e.g. "rays". A static string, never NULL.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_plan_string(plan: qdist_plan) -> *const c_char {
    plan_name(plan)
}

/// A table of outcomes: of the library, in C, and by name. Makes `fn outcome(Outcome) -> qdist_outcome`, which takes what the library may know one day for
/// `other`, and a function that names them.
macro_rules! outcomes {
    (
        $of:ident($enum:ident) -> $code:ty, or $other:ident; $name:ident, or $unknown:literal;
        $($variant:ident = $value:ident, $words:literal;)*
    ) => {
        pub(crate) fn $of(outcome: $enum) -> $code {
            match outcome {
                $($enum::$variant => $value,)*
                _ => $other,
            }
        }

        fn $name(code: $code) -> *const c_char {
            match code {
                $($value => $words,)*
                _ => $unknown,
            }
            .as_ptr()
        }
    };
}
#[cfg(feature = "grasp")]
pub(crate) use outcomes;

// (What is not known one day: the bracket would be true.)
outcomes! {
    outcome(Outcome) -> qdist_outcome, or QDIST_PRECISION; outcome_name, or c"unknown outcome";
    Converged = QDIST_CONVERGED, c"converged";
    Above = QDIST_ABOVE, c"above";
    Below = QDIST_BELOW, c"below";
    Separated = QDIST_SEPARATED, c"separated";
    Touching = QDIST_TOUCHING, c"touching";
    Precision = QDIST_PRECISION, c"precision";
    Capacity = QDIST_CAPACITY, c"capacity";
    Iterations = QDIST_ITERATIONS, c"iterations";
    Degenerate = QDIST_DEGENERATE, c"degenerate";
    SupportFailed = QDIST_SUPPORT_FAILED, c"support failed";
    Interrupted = QDIST_INTERRUPTED, c"interrupted";
    Unbounded = QDIST_UNBOUNDED, c"unbounded";
}

// (Two bodies on one axis are measured by qdist_depth3 only, which does not tell.)
outcomes! {
    plan(Plan) -> qdist_plan, or QDIST_PLAN_EXPANSION; plan_name, or c"unknown plan";
    Expansion = QDIST_PLAN_EXPANSION, c"expansion";
    Distance = QDIST_PLAN_DISTANCE, c"distance";
    Rays = QDIST_PLAN_RAYS, c"rays";
    Cones = QDIST_PLAN_CONES, c"cones";
    Warm = QDIST_PLAN_WARM, c"warm";
}

/// `Ok`, or the status that says what is wrong.
pub(super) type Check<T = ()> = Result<T, qdist_status>;

/// And back.
pub(super) fn from_status(status: qdist_status) -> Check {
    if status == QDIST_OK { Ok(()) } else { Err(status) }
}

/// A check as the C caller sees it.
pub(super) fn status(check: Check) -> qdist_status {
    check.err().unwrap_or(QDIST_OK)
}

/// What a function of C does, as its caller sees it.
#[inline(always)]
pub(super) fn status_of(call: impl FnOnce() -> Check) -> qdist_status {
    status(call())
}

/// Did arithmetic overflow, though no callback is to blame? Then nothing is written.
pub(super) fn overflow(failure: Option<Failure>) -> Check {
    if failure == Some(Failure(qdist::TOO_LARGE)) { Err(QDIST_ERROR_NONFINITE) } else { Ok(()) }
}

/// The code of a failure; 0 for none.
pub(super) fn code(failure: Option<Failure>) -> i32 {
    failure.map_or(0, |Failure(code)| code)
}

pub(super) fn from_shape(error: ShapeError) -> qdist_status {
    match error {
        ShapeError::NonFinite => QDIST_ERROR_NONFINITE,
        ShapeError::NotOrthonormal => QDIST_ERROR_ROTATION,
        _ => QDIST_ERROR_ARGUMENT,
    }
}

pub(super) fn from_graph(error: GraphError) -> qdist_status {
    match error {
        GraphError::Shape(error) => from_shape(error),
        GraphError::Flat => QDIST_ERROR_FLAT,
        GraphError::Points => QDIST_ERROR_HULL_POINTS,
        GraphError::Interrupted => QDIST_ERROR_INTERRUPTED,
        GraphError::Capacity => QDIST_ERROR_CAPACITY,
        GraphError::Words => QDIST_ERROR_WORKSPACE_SIZE,
        _ => QDIST_ERROR_ARGUMENT,
    }
}

pub(super) fn from_body(error: BodyError) -> qdist_status {
    match error {
        BodyError::NonFinite => QDIST_ERROR_NONFINITE,
        BodyError::Rotation => QDIST_ERROR_ROTATION,
        _ => QDIST_ERROR_ARGUMENT,
    }
}

pub(super) fn from_workspace(error: WorkspaceError) -> qdist_status {
    match error {
        WorkspaceError::Capacity => QDIST_ERROR_CAPACITY,
        WorkspaceError::Size => QDIST_ERROR_WORKSPACE_SIZE,
        WorkspaceError::Alignment => QDIST_ERROR_ALIGNMENT,
        _ => QDIST_ERROR_ARGUMENT,
    }
}
