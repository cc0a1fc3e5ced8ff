/* qdist: certified generalized penetration distance of convex sets, in fixed memory.
 *
 * The depth of two overlapping bodies, or their distance; the depth of the origin in a convex set of dimension 2 to 6 with
 * respect to a unit set. Every answer is a bracket: lower <= d <= upper, rounding included.
 *
 *     static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, 64, 128)];
 *     qdist_solver *solver;
 *     qdist_box_f64 box = { { 1.0, 2.0, 3.0 } };
 *     qdist_sphere_f64 ball = { 0.5 };
 *     qdist_body_f64 a, b;
 *     qdist_depth_f64 depth;
 *
 *     qdist_solver_init_f64(memory, sizeof memory, 3, 64, 128, &solver);
 *     qdist_body_box_f64(&a, &box);
 *     qdist_body_sphere_f64(&b, &ball);
 *     b.translation[0] = 1.25;
 *     depth.struct_size = sizeof depth;
 *     if (qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_OK)
 *         ... depth.lower <= 0.25 && 0.25 <= depth.upper, depth.normal is (1, 0, 0) ...
 *
 * What holds for every function:
 *
 * Scalars     Everything exists for double, with suffix _f64, and for float, with suffix _f32. The first is documented here, the
 *             second is its copy. What a program does not call is not linked: neither the other scalar type, nor other
 *             dimensions or shapes.
 * Errors      A function returns a status: QDIST_OK, or an error that says what is wrong with the arguments. Then nothing
 *             has been written. (A failing callback is the one exception, see QDIST_ERROR_CALLBACK; after an error of
 *             a qdist_hull_prepare the words of the graph are unspecified.) Poses, options and the numbers of sets and bodies
 *             are checked at every call; shapes and lists when a set, body or unit set is made of them.
 * Statuses    The text of a function ends with the errors that it may return, without QDIST_ERROR_, each with the argument that causes it (a name without
 *             more: it is out of range). Not repeated are those of all functions: NULL and ALIGNMENT, of a pointer among the arguments or in what they
 *             point to; STRUCT_SIZE, of a struct_size; and those of what many functions take:
 *             a solver    SOLVER, SCALAR (it is for the other), DIMENSION (for another), BUSY (its own call is calling you).
 *             a set       NULL (support), DIMENSION, ARGUMENT (radius, extent or error negative; contains_origin), NONFINITE (one of these).
 *             a body      as its set; ROTATION, ARGUMENT (spread, rolling_radius, extents or errors negative; rolling_radius above the set's radius;
 *                         symmetry), NONFINITE (one of these, center, rotation or translation).
 *             a unit set  NULL (value; vertex, with vertex_count), DIMENSION, ARGUMENT (extent, ball_radius or inner_radius negative; inner_radius
 *                         above extent; 1 / ball_radius overflows; value is 0 along all axes), NONFINITE (one of these).
 *             options     ARGUMENT (absolute or relative negative, or both 0; use_threshold; use_guess), NONFINITE (absolute, relative, threshold,
 *                         guess).
 * Arguments   come in one order: what works or is made (a solver, a pair; a body, a set, a hull); memory that it uses (a tracker, a workspace);
 *             what is read; options, and what ends the work; what is written; `which`. Lists are followed by their lengths.
 *             which: NULL; or after an error that is about one of a list, such as a contact, its index is written there.
 * Pointers    NULL is an error unless the text says otherwise. Pointers must be aligned for their type, and valid for what
 *             the text says; the library cannot check the latter.
 * Ownership   Everything is yours: solver memory, shapes, lists, results. The library allocates nothing, frees nothing, keeps
 *             no global state, prints nothing and never exits. A struct that points to another one must not outlive
 *             it. Structs are read during a call only, and may be changed between calls; when a shape, list or graph changes, all
 *             that is made of it must be made anew.
 * Threads     All functions may be called from several threads at the same time. A solver serves one call at a time; shapes,
 *             sets and bodies are only read, and may be shared.
 * Callbacks   must not unwind or longjmp, and must not use the solver that is calling them, neither for a query within the query (which ends with
 *             QDIST_ERROR_BUSY, and does no harm) nor by making a solver in its memory. Another solver is free to be used. Every number that a callback
 *             returns is checked.
 * Arithmetic  Brackets hold in every rounding mode (fesetround), and with subnormal numbers flushed to zero (FTZ, DAZ): `./x test-c` tests all
 *             combinations in double and float. In the usual mode all machines give the same bits; in another one the last digits differ.
 *             Floating-point exceptions must be masked, as they are by default: compilers move divisions before the test that guards them, so that a query may
 *             divide by zero, and throw the result away. Status flags (FE_DIVBYZERO, FE_INVALID, FE_INEXACT, ...) are left set; clear them
 *             with feclearexcept if you look at them.
 * Units       Lengths are in your unit, all in the same one; there is no absolute tolerance anywhere, and results scale with the
 *             unit. A length may be at most 2e292 (float: 2e31). Squares of the sizes of a scene should be normal numbers:
 *             sizes from 1e-140 to 1e140 (float: 1e-17 to 1e17).
 * Frames      Right-handed. A body's pose takes points from its own frame to the world: x -> rotation * x + translation. All
 *             results are in the world frame.
 * Versions    Structs that may grow begin with struct_size. Set it to the sizeof of the struct before the call, of a result, too (a _default function
 *             does it for options): a library of a later version takes the structs of an earlier header, which are shorter. What they lack takes its
 *             default; results are written as far as they go. Numbers of this header never change their meaning; new ones may be added, so that
 *             unknown ones must be expected. */

#ifndef QDIST_H
#define QDIST_H

/* Generated by `./x header` from capi/src/; do not edit. */

#include <stddef.h>
#include <stdint.h>

/* Before every function. Define QDIST_API yourself for an attribute of your own; or QDIST_DLL where you link a DLL that you have made of the
 * library on Windows, and QDIST_DLL_EXPORT while you make it. */
#ifndef QDIST_API
#if defined(_WIN32) && defined(QDIST_DLL_EXPORT)
#define QDIST_API __declspec(dllexport)
#elif defined(_WIN32) && defined(QDIST_DLL)
#define QDIST_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define QDIST_API __attribute__((visibility("default")))
#else
#define QDIST_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header, as qdist_version() gives that of the library. */
#define QDIST_VERSION ((QDIST_VERSION_MAJOR << 16) | (QDIST_VERSION_MINOR << 8) | QDIST_VERSION_PATCH)

/* ============================================================ MEMORY ============================================================
 *
 * A solver: opaque, in memory that you own. */
typedef struct qdist_solver qdist_solver;

/* Alignment of a solver's memory in bytes. An array of uint64_t has it; for bytes, write
 * _Alignas(QDIST_WORKSPACE_ALIGN) (C11) or alignas(QDIST_WORKSPACE_ALIGN) (C++). */
#define QDIST_WORKSPACE_ALIGN 8

/* Bytes of a solver's memory: constant expressions, for static arrays; qdist_workspace_query says the same at run time.
 * dim: 2 to 6; nv: max_vertices, dim + 1 to 65535; nf: max_facets, 2 * dim to 65535. */
#define QDIST_WORKSPACE_BYTES_F64(dim, nv, nf) \
    (UINT32_C(16) + (nv) * UINT32_C(16) * (dim) + \
     (nf) * (UINT32_C(8) * (dim) + UINT32_C(32) + (UINT32_C(4) * (dim) + UINT32_C(10)) / 8 * 8))
#define QDIST_WORKSPACE_BYTES_F32(dim, nv, nf) \
    (UINT32_C(16) + (nv) * UINT32_C(8) * (dim) + (nf) * (UINT32_C(8) * (dim) + UINT32_C(20)))

/* The same in words of 8 bytes, for arrays of uint64_t. */
#define QDIST_WORKSPACE_WORDS_F64(dim, nv, nf) ((QDIST_WORKSPACE_BYTES_F64(dim, nv, nf) + 7) / 8)
#define QDIST_WORKSPACE_WORDS_F32(dim, nv, nf) ((QDIST_WORKSPACE_BYTES_F32(dim, nv, nf) + 7) / 8)

/* The largest number of points, whatever they are, that qdist_hull_prepare takes; that qdist_hull_large_prepare takes. */
#define QDIST_HULL_POINTS UINT32_C(26214)
#define QDIST_HULL_LARGE_POINTS UINT32_C(134217728)

/* A number of uint16_t that suffices for the graph of a hull of `count` points. */
#define QDIST_HULL_GRAPH_LEN(count) (UINT32_C(11) * (count) + UINT32_C(16))

/* Numbers of uint32_t that suffice for the graph of a large hull of `count` points, and as workspace to prepare it. */
#define QDIST_HULL_LARGE_GRAPH_LEN(count) (UINT32_C(8) * (count) + UINT32_C(16))
#define QDIST_HULL_LARGE_WORKSPACE_LEN(count) (UINT32_C(18) * (count))

/* =================================================== STATUS, OUTCOME AND PLAN ===================================================
 *
 * Three questions, three types. A status says whether the call worked. An outcome says what the run concluded, and whatever
 * it concluded, the bracket holds. A plan says how. */

/// callback_code when a callback returned 0 but wrote NaN, infinity or nothing, or when a unit set returned NaN or a negative
/// number. Callbacks must not return it, nor INT32_MIN + 1 to INT32_MIN + 3.
#define QDIST_CALLBACK_NONFINITE (-2147483647 - 1)

/// Did the call work? QDIST_OK, or a QDIST_ERROR that says what is wrong; then nothing has been written, except
/// with QDIST_ERROR_CALLBACK.
typedef int32_t qdist_status;

/// What did the run conclude?
typedef int32_t qdist_outcome;

/// How was the query answered? What A and Q are decides it.
typedef int32_t qdist_plan;

/// Asked before every iteration of a query; anything but 0 ends it with QDIST_INTERRUPTED and the best bracket so far. Look at a
/// clock or at a flag that an interrupt handler sets. (While a hull is prepared: asked for every 1,024 points looked at.)
///
/// user: interrupt_user of the options or the call.
typedef int32_t (*qdist_interrupt)(void *user);

/// The call worked.
#define QDIST_OK 0

/// A pointer that must not be NULL is NULL.
#define QDIST_ERROR_NULL 1

/// A number is out of range: a negative size, an empty list, a flag that is neither 0 nor 1.
#define QDIST_ERROR_ARGUMENT 2

/// An argument is NaN or infinite, or a length is above 2e292 (float: 2e31), so that sums could overflow.
#define QDIST_ERROR_NONFINITE 3

/// struct_size is not the size of a struct that this library knows.
#define QDIST_ERROR_STRUCT_SIZE 4

/// The memory is shorter than QDIST_WORKSPACE_BYTES, QDIST_HULL_GRAPH_LEN or QDIST_HULL_LARGE_GRAPH_LEN says.
#define QDIST_ERROR_WORKSPACE_SIZE 5

/// Memory or a struct is not aligned: solver memory to QDIST_WORKSPACE_ALIGN, all else to its type.
#define QDIST_ERROR_ALIGNMENT 6

/// The dimension is not one of 2 to 6, or solver, set, unit set and function are not of the same dimension.
#define QDIST_ERROR_DIMENSION 7

/// The solver was made for the other scalar type.
#define QDIST_ERROR_SCALAR 8

/// max_vertices < dimension + 1, max_facets < 2 * dimension, or one of them above 65535; or a solver that is too small for
/// what it is to do.
#define QDIST_ERROR_CAPACITY 9

/// The memory does not hold a solver.
#define QDIST_ERROR_SOLVER 10

/// The matrix is not a rotation: an entry of R^T R - I is above 1e-4 in size, or det R < 0. Or the quaternion is not of unit length,
/// to 1e-6.
#define QDIST_ERROR_ROTATION 11

/// A callback failed: the result is filled, with outcome QDIST_SUPPORT_FAILED, a true bracket and the callback's code.
#define QDIST_ERROR_CALLBACK 12

/// All points of a hull lie in one plane: use qdist_points.
#define QDIST_ERROR_FLAT 13

/// A contact's position is not finite or too large.
#define QDIST_ERROR_CONTACT_POSITION 14

/// A contact's normal is not a unit vector.
#define QDIST_ERROR_CONTACT_NORMAL 15

/// A contact's tangents are not unit vectors with n = o x t.
#define QDIST_ERROR_CONTACT_TANGENTS 16

/// A contact's friction model is not known, or a coefficient is negative, not finite or too large.
#define QDIST_ERROR_CONTACT_FRICTION 17

/// A contact's force cap is negative, not finite or too large.
#define QDIST_ERROR_CONTACT_CAP 18

/// A contact's Jacobian has more than 8 joints, or a number that is not finite or too large.
#define QDIST_ERROR_CONTACT_JACOBIAN 19

/// A contact's wrench is too large: a position or friction that is huge for the torque scale. Or a primitive's or pyramid's is not finite.
#define QDIST_ERROR_CONTACT_WRENCH 20

/// The reference point is not finite, or the torque scale is not a positive number of usual size.
#define QDIST_ERROR_FRAME 21

/// A rank tolerance below 16 roundoffs or above 1/2.
#define QDIST_ERROR_TOLERANCE 22

/// A finger's torque limits: one is negative or not a number, or there are not as many as joints.
#define QDIST_ERROR_TORQUE_LIMIT 23

/// The memory does not hold a finger of this scalar type.
#define QDIST_ERROR_FINGER 24

/// A mesh has no triangles.
#define QDIST_ERROR_MESH_EMPTY 25

/// A triangle of a mesh refers to a vertex that does not exist.
#define QDIST_ERROR_MESH_INDEX 26

/// A coordinate of a mesh's vertex is NaN, infinite, or above 1e60 in size.
#define QDIST_ERROR_MESH_VERTEX 27

/// All vertices that a mesh's triangles use lie on one line.
#define QDIST_ERROR_MESH_COLLINEAR 28

/// What is asked for needs a solid, and the mesh bounds none: it is open, wound inconsistently or inward, or without volume.
#define QDIST_ERROR_MESH_NOT_SOLID 29

/// The allocator is set already, or memory has been allocated without.
#define QDIST_ERROR_ALLOCATOR 30

/// A defect of the library, which went no further. Please report it.
#define QDIST_ERROR_INTERNAL 31

/// A callback uses the solver, pair or tracker that is calling it.
#define QDIST_ERROR_BUSY 32

/// A half space where only sets with an end serve: in a join, or in a query of one set (as callback_code).
#define QDIST_ERROR_UNBOUNDED 33

/// `interrupt` of qdist_hull_prepare or qdist_hull_large_prepare said so.
#define QDIST_ERROR_INTERRUPTED 34

/// A hull of more points, or with more vertices, than the words of its graph can number: see QDIST_HULL_POINTS.
#define QDIST_ERROR_HULL_POINTS 35

/// The bracket is as narrow as asked for, and the origin is inside: 0 < lower.
#define QDIST_CONVERGED 0

/// Stopped early: lower >= threshold.
#define QDIST_ABOVE 1

/// Stopped early: upper < threshold.
#define QDIST_BELOW 2

/// The origin is outside: upper < 0, and the bracket is that of minus the Euclidean distance.
#define QDIST_SEPARATED 3

/// The bracket is as narrow as asked for, or as arithmetic allows, and contains 0.
#define QDIST_TOUCHING 4

/// The bracket cannot be narrowed in this scalar type; the tolerance asked for more.
#define QDIST_PRECISION 5

/// The solver's memory is full. (qdist_solve goes on cone by cone, QDIST_PLAN_CONES, where there are 3 * dimension vertices and
/// 4 * dimension facets.)
#define QDIST_CAPACITY 6

/// The iteration limit is reached.
#define QDIST_ITERATIONS 7

/// The set is flat, as far as the rounding of its points tells, and the origin lies in it; `dimension` of the result says how flat. (A set that is
/// only thin ends with QDIST_PRECISION.)
#define QDIST_DEGENERATE 8

/// A callback failed; the status is QDIST_ERROR_CALLBACK.
#define QDIST_SUPPORT_FAILED 9

/// `interrupt` of the options said so.
#define QDIST_INTERRUPTED 10

/// Two half spaces overlap without end: no translation separates them. d is infinite; both bounds are DBL_MAX (float: FLT_MAX).
#define QDIST_UNBOUNDED 11

/// Expansion of one polytope, best first.
#define QDIST_PLAN_EXPANSION 0

/// By the distance of the core from the origin: the set has a radius, and the origin is outside of its core.
#define QDIST_PLAN_DISTANCE 1

/// Polytopal Q: one ray per vertex of Q, and no polytope.
#define QDIST_PLAN_RAYS 2

/// The polytope outgrew the memory: expansion cone by cone in the same memory.
#define QDIST_PLAN_CONES 3

/// The bracket of the last call, moved: nothing was expanded.
#define QDIST_PLAN_WARM 4

/// The name of a status, e.g. "null pointer". A static string, never NULL.
QDIST_API const char *qdist_status_string(qdist_status status);

/// The name of an outcome, e.g. "converged". A static string, never NULL.
QDIST_API const char *qdist_outcome_string(qdist_outcome outcome);

/// The name of a plan, e.g. "rays". A static string, never NULL.
QDIST_API const char *qdist_plan_string(qdist_plan plan);

/* =========================================================== VERSION =========================================================== */

/// Major version: changes when a program must be changed.
#define QDIST_VERSION_MAJOR 0

/// Minor version: changes when something is added (before 1.0: when a program must be changed).
#define QDIST_VERSION_MINOR 1

/// Patch version.
#define QDIST_VERSION_PATCH 0

/// The version of the library that is linked, `(major << 16) | (minor << 8) | patch`. Compare it with QDIST_VERSION, which is
/// that of this header.
QDIST_API
uint32_t qdist_version(void);

/* ====================================================== MEMORY AT RUN TIME ====================================================== */

/// The number of bytes that a solver needs, the same number as QDIST_WORKSPACE_BYTES_F64 and QDIST_WORKSPACE_BYTES_F32, for languages that
/// have no macros of C. scalar: sizeof(double) or sizeof(float), else QDIST_ERROR_SCALAR. dimension: 2 to 6.
///
/// Status: SCALAR (scalar), DIMENSION (dimension), CAPACITY (max_vertices or max_facets), WORKSPACE_SIZE (so many bytes have no number of 32
/// bits).
QDIST_API
qdist_status qdist_workspace_query(uint32_t scalar,
                                   uint32_t dimension,
                                   uint32_t max_vertices,
                                   uint32_t max_facets,
                                   uint32_t *bytes);

/* =========================================================== SYMMETRY =========================================================== */

/// Of a body: none that is known.
#define QDIST_SYMMETRY_NONE 0

/// All rotations about the z axis of the body's frame leave the set unchanged.
#define QDIST_SYMMETRY_AXIS 1

/// All rotations about the origin of the body's frame leave the set unchanged.
#define QDIST_SYMMETRY_FULL 2

/// Of a set or unit set: does it not change when the coordinates named by the bits of `signs` (bit 0: the first) change sign? Returns 1
/// when it certainly does not, else 0. A search by cones leaves out what is an image of something else under a change of sign
/// that both A and Q allow.
///
/// user: the pointer from the set or unit set.
typedef int32_t (*qdist_mirrored)(void *user, uint32_t signs);

/// What answers for a body without end. Not for functions of your own.
typedef qdist_status (*qdist_unbounded)(const void *a, const void *b, const void *options, void *result);

/// How depth is found with a body in space: what the functions that make bodies put there. The code of a plan is linked where one of them names it.
typedef void (*qdist_route)(void);

/* =========================================================== SOLVERS ===========================================================
 *
 * A solver lives in memory that you own: a static array, a stack frame, a heap block. It is made once and then used for any
 * number of queries; it keeps nothing between them. There is nothing to free. The memory holds no addresses, so that a solver
 * may be moved with its memory.
 *
 * Capacities: `max_vertices` bounds the points that are stored, `max_facets` the facets at one time. In
 * dimension 3, facets = 2 * vertices suffices; in dimension 6 a hundred facets for a vertex is not
 * rare. When either is full, qdist_solve goes on cone by cone in the same memory, and qdist_depth3 ends with
 * QDIST_CAPACITY and a bracket that is still true; results say how much was used. */

/// Makes a solver of a dimension of 2 to 6 in `bytes` bytes of memory, aligned to QDIST_WORKSPACE_ALIGN, and stores its address,
/// which is that of the memory.
///
/// Status: DIMENSION (dimension), CAPACITY (max_vertices or max_facets), WORKSPACE_SIZE (bytes), ALIGNMENT (memory, to QDIST_WORKSPACE_ALIGN).
QDIST_API
qdist_status qdist_solver_init_f64(void *memory,
                                   uint32_t bytes,
                                   uint32_t dimension,
                                   uint32_t max_vertices,
                                   uint32_t max_facets,
                                   qdist_solver **solver);

/* ========================================================= CONVEX SETS =========================================================
 *
 * A convex set is known by its support function: the point of the set that is farthest along a direction. A set is
 * given in two parts, core + radius * ball: the support function gives points of the core, and `radius` is
 * the radius of a ball swept over it. A sphere is a point with a radius, a capsule a segment with a radius, a safety margin
 * is a radius on anything. Write a support function for your own shapes; the built-in shapes are made of the same parts. */

/// Writes a point of the core that is farthest along `direction` to `point`.
///
/// user: the pointer from the set. direction: as many numbers as the dimension; finite and not all zero, but
/// not necessarily of unit length. point: room for as many.
///
/// Returns 0, or a code of your own, which ends the query and comes back as `callback_code`. (Once there is an answer that rounding has left open, what was to make it
/// better ends, and the answer stands.) Not INT32_MIN to INT32_MIN + 3. The function must not unwind or longjmp, nor use the solver that is calling it. Where several
/// points are equally far, any of them.
typedef int32_t (*qdist_support_f64)(void *user, const double *direction, double *point);

/// A convex set, core + radius * ball. Start with `= {0}`: what is zero takes its default.
typedef struct {
    /// The support function of the core.
    qdist_support_f64 support;
    /// NULL; or, if `support` takes shortcuts and may miss the farthest point, a slower function that does not. It checks
    /// the direction that is about to be reported.
    qdist_support_f64 exhaustive;
    /// NULL: not known. Which mirror images of the core are the core itself.
    qdist_mirrored mirrored;
    /// First argument of all functions.
    void *user;
    /// Radius of the ball swept over the core, >= 0.
    double radius;
    /// An upper bound of |x| over the core, for the rounding margin; 0: not known, the largest norm seen is taken.
    double extent;
    /// An upper bound of the rounding error of the support function, as a length: how far its points are off the core, and
    /// how much farther along a unit direction the farthest point may be. 0: 16 * dimension * roundoff * extent, which covers
    /// a few operations on coordinates of the core's size.
    double error;
    /// The dimension that the functions work in; 0: not known, and not checked.
    uint32_t dimension;
    /// 1: the core contains the origin by its definition, as that of a grasp's wrenches does. Then d >= 0 is known where the origin lies on the boundary,
    /// which no support function can tell, and `lower` is 0 there instead of less by the rounding margin. 0: not known, unless `mirrored` shows
    /// it (what is its own image under a change of all signs contains the origin). What is stated must be true, or the bracket is not.
    uint32_t contains_origin;
} qdist_set_f64;

/// For sets that know themselves in twice the precision: writes a point of the core (with the ball of rolling_radius put on, where there is one) that is farthest
/// along a direction u. Both are exact sums of two vectors: u = direction[0 .. N - 1] + direction[N .. 2 N - 1], near unit length, and the point point[0 .. N - 1] + point[N .. 2 N - 1]. Coordinate i of
/// the point may be off by 2^8 roundoff^2 extents[i], its height by what that makes. Returns 0, or anything else where it has no answer.
typedef int32_t (*qdist_precise_f64)(void *user, const double *direction, double *point);

/// A set in space with a pose: x -> rotation * x + translation.
typedef struct {
    /// The set, in the body's frame.
    qdist_set_f64 set;
    /// Row-major: rotation[3 * row + column]. A rotation to within 1e-4; used as it is given.
    double rotation[9];
    /// Position of the body's frame in the world.
    double translation[3];
    /// For a set far from the origin of its frame: a point near it. Used when `spread` is above 0.
    double center[3];
    /// The part of set.radius that is not a ball by itself but was split off a rounded shape, as the body functions of ellipsoids
    /// do; 0 to set.radius. Where `rotation` is a rotation only roughly, it does not leave this part a ball.
    double rolling_radius;
    /// An upper bound of the core's distance from `center`; `set.error` then says how well the support function works relative
    /// to `center`. 0: measured from the origin.
    double spread;
    /// Upper bounds of |x|, |y| and |z| over the core, in the body's frame: a body that is long and flat along its axes, as a floor, is known better
    /// across. All zero: set.extent along every axis.
    double extents[3];
    /// With `extents`: the rounding error set.error axis by axis; along a unit direction u it is the sum of |u_i| errors[i]. Zero is exact.
    double errors[3];
    /// Exact symmetry of the set in its frame. QDIST_SYMMETRY_NONE (0) is always right; the others make two bodies that turn
    /// about one axis a plane problem.
    uint32_t symmetry;
    /// NULL; what qdist_body_half_space puts here answers in place of the support function. Not for functions of your own.
    qdist_unbounded unbounded;
    /// How depth is found, as the function that has made the body says: boxes by their axes, cylinders and cones by arcs of minimisers around theirs, your
    /// own sets by expansion. (Boxes by what their function wrote: what is changed in their `set` afterwards, but for its radius, counts only beside other shapes.) A program does without the plans of shapes that it does not make.
    qdist_route route;
    /// NULL; or the support function in twice the precision: shallow contact of such bodies is measured to the last digits. The body functions of all
    /// shapes, points and hulls put it here. Called with set.user.
    qdist_precise_f64 precise;
} qdist_body_f64;

/// Makes a body of any set of dimension 3, in the identity pose. Checks and copies the set; what it points to must outlive the
/// body.
///
/// Status: those of a set (set).
QDIST_API
qdist_status qdist_body_set_f64(qdist_body_f64 *body,
                                const qdist_set_f64 *set);

/* ======================================================= SHAPES IN SPACE =======================================================
 *
 * Plain structs that you own. All are centred at the origin of the body's frame, with their axes along its axes. A size
 * may be zero: flat shapes are legal.
 *
 * `qdist_body_..._f64` checks a shape, makes body->set point at it and sets the identity pose; the shape must outlive
 * the body. Sizes are not checked again: make the body anew when they change. (A size that has become NaN or
 * infinite ends the query with QDIST_CALLBACK_NONFINITE; after any other change, the answer means nothing.)
 *
 * body->set.support is the support function of the shape's core (without the ball that body->set.radius sweeps over it: a sphere's core is
 * its centre, an ellipsoid's a smaller ellipsoid-like set); its user is the shape, and the code that it returns is a qdist_status. For a shape
 * in qdist_solve3, take body.set. */

/// All points within `radius` of the origin.
typedef struct {
    double radius;
} qdist_sphere_f64;

/// |x| <= half[0], |y| <= half[1], |z| <= half[2].
typedef struct {
    double half[3];
} qdist_box_f64;

/// The ellipsoid with these semi axes along x, y and z.
typedef struct {
    double semi_axes[3];
} qdist_ellipsoid_f64;

/// x^2 + y^2 <= radius^2, |z| <= half_height.
typedef struct {
    double radius;
    double half_height;
} qdist_cylinder_f64;

/// All points within `radius` of the segment from (0, 0, -half_height) to (0, 0, half_height).
typedef struct {
    double radius;
    double half_height;
} qdist_capsule_f64;

/// The hull of the disk of `radius` at z = -half_height and the apex (0, 0, half_height).
typedef struct {
    double radius;
    double half_height;
} qdist_cone_f64;

/// Makes a body of a sphere, in the identity pose, like all that follow.
///
/// Status: ARGUMENT (the radius negative), NONFINITE (the radius NaN, infinite or too large).
QDIST_API qdist_status qdist_body_sphere_f64(qdist_body_f64 *body, const qdist_sphere_f64 *shape);

/// Makes a body of a box.
///
/// Status: ARGUMENT (a half size negative), NONFINITE (a half size NaN, infinite or too large).
QDIST_API qdist_status qdist_body_box_f64(qdist_body_f64 *body, const qdist_box_f64 *shape);

/// Makes a body of an ellipsoid.
///
/// Status: ARGUMENT (a semi axis negative), NONFINITE (a semi axis NaN, infinite or too large).
QDIST_API qdist_status qdist_body_ellipsoid_f64(qdist_body_f64 *body, const qdist_ellipsoid_f64 *shape);

/// Makes a body of a cylinder.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
QDIST_API qdist_status qdist_body_cylinder_f64(qdist_body_f64 *body, const qdist_cylinder_f64 *shape);

/// Makes a body of a capsule.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
QDIST_API qdist_status qdist_body_capsule_f64(qdist_body_f64 *body, const qdist_capsule_f64 *shape);

/// Makes a body of a cone.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
QDIST_API qdist_status qdist_body_cone_f64(qdist_body_f64 *body, const qdist_cone_f64 *shape);

/* ======================================================= HULLS OF POINTS =======================================================
 *
 * The convex hull of a list of points, in any dimension, by looking at all of them; and large hulls in space, by
 * climbing from vertex to vertex. The lists must outlive the set or body that is made of them, which is when their
 * coordinates are read and checked: make it anew when they change. */

/// The convex hull of `count` points, 1 or more. Coordinate k of point i is points[i * dimension + k].
typedef struct {
    const double *points;
    uint32_t count;
    /// 2 to 6.
    uint32_t dimension;
} qdist_points_f64;

/// A convex hull in space of up to QDIST_HULL_POINTS points, and the graph of its edges. Made by qdist_hull_prepare_f64. The
/// graph is plain numbers without addresses: it may be kept in a file or in flash. Any content is safe to use, and the time of a
/// support call is bounded by the number of points.
typedef struct {
    /// Of dimension 3.
    qdist_points_f64 points;
    const uint16_t *graph;
    /// Length of `graph`.
    uint32_t graph_len;
} qdist_hull_f64;

/// The same of any number of points. Made by qdist_hull_large_prepare_f64.
typedef struct {
    /// Of dimension 3.
    qdist_points_f64 points;
    const uint32_t *graph;
    /// Length of `graph`.
    uint32_t graph_len;
} qdist_hull_large_f64;

/// Makes a set of a list of points of any dimension. Reads all of them.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
QDIST_API qdist_status qdist_set_points_f64(qdist_set_f64 *set, const qdist_points_f64 *shape);

/// Makes a body of a list of points of dimension 3. Reads all of them.
///
/// Status: DIMENSION (shape->dimension is not 3), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
QDIST_API qdist_status qdist_body_points_f64(qdist_body_f64 *body, const qdist_points_f64 *shape);

/// Computes the graph of a hull: the words go to `graph`, and `hull` is filled with points and graph. The solver is one of
/// dimension 3, as workspace: max_facets >= 2 * count always suffices, whatever max_vertices is. QDIST_HULL_GRAPH_LEN(count) words
/// are needed. Points inside the hull are legal, and so are equal points. With `interrupt`, which may be NULL, the status may be
/// QDIST_ERROR_INTERRUPTED.
///
/// `count` is at most QDIST_HULL_POINTS. Up to 65534 points (with max_facets = 65535) are tried, too: they can be prepared when few
/// enough of them are vertices of the hull; otherwise the status is QDIST_ERROR_HULL_POINTS, and qdist_hull_large_prepare_f64 is
/// the function to call.
///
/// Status: those of a solver; ARGUMENT (count is 0), WORKSPACE_SIZE (graph_capacity), NONFINITE (a coordinate), FLAT (the points), CAPACITY
/// (max_facets of the solver), HULL_POINTS (count, or so many points are vertices), INTERRUPTED (interrupt).
QDIST_API
qdist_status qdist_hull_prepare_f64(qdist_hull_f64 *hull,
                                    qdist_solver *solver,
                                    const double *points,
                                    uint32_t count,
                                    qdist_interrupt interrupt,
                                    void *interrupt_user,
                                    uint16_t *graph,
                                    uint32_t graph_capacity);

/// Computes the graph of a hull of any number of points, at most QDIST_HULL_LARGE_POINTS. QDIST_HULL_LARGE_GRAPH_LEN(count) words of
/// `graph` and QDIST_HULL_LARGE_WORKSPACE_LEN(count) words of `workspace` are needed; the latter may be used otherwise
/// afterwards. With `interrupt`, which may be NULL, the status may be QDIST_ERROR_INTERRUPTED.
///
/// Status: ARGUMENT (count is 0), HULL_POINTS (count), WORKSPACE_SIZE (workspace_capacity or graph_capacity), NONFINITE (a coordinate), FLAT (the
/// points), INTERRUPTED (interrupt).
QDIST_API
qdist_status qdist_hull_large_prepare_f64(qdist_hull_large_f64 *hull,
                                          uint32_t *workspace,
                                          uint32_t workspace_capacity,
                                          const double *points,
                                          uint32_t count,
                                          qdist_interrupt interrupt,
                                          void *interrupt_user,
                                          uint32_t *graph,
                                          uint32_t graph_capacity);

/// Makes a body of a prepared hull. Reads all points.
///
/// Status: ARGUMENT (shape->graph or graph_len is not that of a prepared hull, or count is 0), DIMENSION (shape->points.dimension is not 3),
/// NONFINITE (a coordinate).
QDIST_API
qdist_status qdist_body_hull_f64(qdist_body_f64 *body,
                                 const qdist_hull_f64 *shape);

/// Makes a body of a large hull. Reads all points.
///
/// Status: as of qdist_body_hull.
QDIST_API qdist_status qdist_body_hull_large_f64(qdist_body_f64 *body, const qdist_hull_large_f64 *shape);

/* ===================================================== HULLS OF TWO BODIES =====================================================
 *
 * The convex hull of two bodies, each in its pose: a tapered capsule is that of two spheres, a frustum of two cylinders of half height
 * 0, a swept shape of one shape in two poses. (Bullet: btConvexHullShape of both, or btMultiSphereShape; geometry: a join.) The
 * smaller of the two radii stays a ball, and is exact. Joins may be joined again. Where both bodies turn about the z axis of the join's frame (identity rotations and
 * translations along z), so does the join, and two bodies on one axis are a plane problem. */

/// The convex hull of two bodies, in a common frame: that of the body which is made of it. They must outlive it; that which
/// has changed must be made anew.
typedef struct {
    const qdist_body_f64 *a;
    const qdist_body_f64 *b;
} qdist_join_f64;

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
///
/// Status: those of a body (join->a, join->b), and NONFINITE (their extent is not finite, as found out by asking); UNBOUNDED (one is a half
/// space).
QDIST_API
qdist_status qdist_body_join_f64(qdist_body_f64 *body,
                                 const qdist_join_f64 *join);

/* ========================================================= HALF SPACES =========================================================
 *
 * The ground, a wall, a plane of contact: a body of qdist_depth3 with no end. Its depth against any other body is the height of
 * that body's lowest point: one call of its support function (and six before, where its extent is not stated; one more in two words, where the tolerance takes that
 * and the body has `precise`), no solver memory, and a bracket of a few roundoffs. (Bullet: btStaticPlaneShape, with the same normal and offset; FCL: fcl::Halfspace.) In C it is a body and nothing else: no set of a query,
 * no part of a hull of two bodies (QDIST_ERROR_UNBOUNDED).
 *
 * Two half spaces overlap without end (QDIST_UNBOUNDED), unless their normals are exactly opposite, as those of a floor and a ceiling: then
 * the depth is that between the two planes. Where a pose is turned, and rounding does not tell whether the normals are
 * opposite, upper is DBL_MAX (float: FLT_MAX), and lower holds in both cases. */

/// The points x with normal . x <= offset. The normal points out of the half space; it need not be of unit length, but not 0.
typedef struct {
    double normal[3];
    double offset;
} qdist_half_space_f64;

/// Makes a body of a half space, in the identity pose. Numbers are read at every query.
///
/// Status: ARGUMENT (the normal is 0), NONFINITE (normal or offset).
QDIST_API qdist_status qdist_body_half_space_f64(qdist_body_f64 *body, const qdist_half_space_f64 *shape);

/* ====================================================== SETS MADE OF SETS ======================================================
 *
 * Sum, difference, convex hull of the union, and linear image of sets of any dimension. The structs and the sets that they point to must outlive the
 * set that is made of them. */

/// Two sets of the same dimension.
typedef struct {
    const qdist_set_f64 *a;
    const qdist_set_f64 *b;
    /// 2 to 6.
    uint32_t dimension;
} qdist_pair_f64;

/// The image of a set under x -> matrix * x + translation.
/// The set must state its extent, or QDIST_ERROR_ARGUMENT: without, the rounding of the map cannot be bounded.
typedef struct {
    const qdist_set_f64 *set;
    /// Row-major, `rows` x `columns`; any matrix.
    const double *matrix;
    /// The first `rows` numbers count.
    double translation[6];
    /// Dimension of the image, 2 to 6.
    uint32_t rows;
    /// Dimension of the set, 2 to 6.
    uint32_t columns;
} qdist_linear_f64;

/// Makes the Minkowski sum { x + y : x in a, y in b }.
///
/// Status: DIMENSION (pair->dimension), those of a set (pair->a, pair->b), NONFINITE (the sum of their sizes is too large).
QDIST_API
qdist_status qdist_set_sum_f64(qdist_set_f64 *set,
                               const qdist_pair_f64 *pair);

/// Makes the Minkowski difference { x - y : x in a, y in b }: it contains the origin exactly where a and b overlap.
///
/// Status: as of qdist_set_sum.
QDIST_API qdist_status qdist_set_difference_f64(qdist_set_f64 *set, const qdist_pair_f64 *pair);

/// Makes the join: the convex hull of the union of a and b. The smaller of the two radii is that of the set, the rest of the larger one becomes part
/// of the core. Both sets must state their extents, or QDIST_ERROR_ARGUMENT. (For bodies in poses see qdist_body_join.)
///
/// Status: DIMENSION (pair->dimension), those of a set (pair->a, pair->b), ARGUMENT (one does not state its extent).
QDIST_API
qdist_status qdist_set_join_f64(qdist_set_f64 *set,
                                const qdist_pair_f64 *pair);

/// Makes the image of a set. A ball does not stay a ball: it becomes part of the core.
///
/// Status: DIMENSION (map->rows or columns), those of a set (map->set), ARGUMENT (it does not state its extent), NONFINITE (a number of matrix or
/// translation, or the image is too large).
QDIST_API
qdist_status qdist_set_linear_f64(qdist_set_f64 *set,
                                  const qdist_linear_f64 *map);

/* ========================================================== UNIT SETS ==========================================================
 *
 * What one unit of depth means in each direction: a convex set Q that contains the origin, known by its support function
 * h_Q. The depth of the origin in A is the largest number d with d * Q inside A. Pass NULL for the unit ball, the
 * ordinary Euclidean depth. The structs and lists must outlive the unit set that is made of them. A struct's `dimension` is 2 to 6; of its
 * six numbers the first `dimension` count. */

/// h_Q(direction) = max { direction . q : q in Q } >= 0, for a finite direction that is not zero. A NaN or a negative number ends
/// the query with QDIST_CALLBACK_NONFINITE.
typedef double (*qdist_unit_value_f64)(void *user, const double *direction);

/// Writes a point q of Q with direction . q = h_Q(direction) to `point`: where the plane touches Q. Returns 0, or anything else where
/// that is not known.
typedef int32_t (*qdist_unit_point_f64)(void *user, const double *direction, double *point);

/// Writes point number `index` < vertex_count to `point`. Returns 0, or a code that ends the query, as that of a support function
/// does. Coordinates that are not finite end it too.
typedef int32_t (*qdist_unit_vertex_f64)(void *user, uint32_t index, double *point);

/// A unit set. Start with `= {0}`: what is zero is not known, and only `value` or `ball_radius` must be. What is stated must be
/// true, or the bracket is not.
typedef struct {
    qdist_unit_value_f64 value;
    /// Helps to find the minimum: in a search by cones, and in qdist_solve_warm.
    qdist_unit_point_f64 point;
    /// With vertex_count: the points of which, and of the origin, Q is the hull. `value` must be theirs. d is then found by shooting
    /// a ray at each (QDIST_PLAN_RAYS), unless expansion is cheaper.
    qdist_unit_vertex_f64 vertex;
    /// Which mirror images of Q are Q itself.
    qdist_mirrored mirrored;
    /// First argument of all functions.
    void *user;
    /// An upper bound of |q| over Q, for the rounding margin; 0: found by asking along the axes.
    double extent;
    /// Above 0: Q is the ball of this radius around the origin, and no function is used. Balls swept over A are then exact.
    double ball_radius;
    /// Radius of a ball around the origin that Q contains. Without, qdist_solve_warm knows no lower bound once A has moved.
    double inner_radius;
    /// How many points `vertex` knows.
    uint32_t vertex_count;
    /// The dimension that the functions work in; 0: not checked.
    uint32_t dimension;
} qdist_unit_f64;

/// The ellipsoid with these semi axes >= 0, not all zero, along the columns of `rotation`.
typedef struct {
    double semi_axes[6];
    /// Row-major, `dimension` x `dimension`; NULL: identity.
    const double *rotation;
    uint32_t dimension;
} qdist_ellipsoid_unit_f64;

/// The box |x_i| <= half[i]; sizes >= 0, not all zero.
typedef struct {
    double half[6];
    uint32_t dimension;
} qdist_box_unit_f64;

/// The hull of the points +- semi_axes[i] on axis i; sizes >= 0, not all zero.
typedef struct {
    double semi_axes[6];
    uint32_t dimension;
} qdist_cross_unit_f64;

/// The segment from the origin to `end`, which is not zero: the depth is how many times `end` fits into A from the origin, as
/// for a ray.
typedef struct {
    double end[6];
    uint32_t dimension;
} qdist_segment_unit_f64;

/// Makes the ball of this radius > 0 around the origin, of any dimension.
///
/// Status: ARGUMENT (radius is not above 0), NONFINITE (radius).
QDIST_API qdist_status qdist_unit_ball_f64(qdist_unit_f64 *unit, double radius);

/// Makes an ellipsoid.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a semi axis is negative, or all are 0), NONFINITE (semi axes or rotation), ROTATION (rotation:
/// its columns are not orthonormal, to 1e-4).
QDIST_API
qdist_status qdist_unit_ellipsoid_f64(qdist_unit_f64 *unit,
                                      const qdist_ellipsoid_unit_f64 *shape);

/// Makes a box.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a half size is negative, or all are 0), NONFINITE (a half size, or the diagonal is too large).
QDIST_API
qdist_status qdist_unit_box_f64(qdist_unit_f64 *unit,
                                const qdist_box_unit_f64 *shape);

/// Makes a cross-polytope.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a semi axis is negative, or all are 0), NONFINITE (a semi axis).
QDIST_API qdist_status qdist_unit_cross_f64(qdist_unit_f64 *unit, const qdist_cross_unit_f64 *shape);

/// Makes a segment.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (end is 0), NONFINITE (end).
QDIST_API qdist_status qdist_unit_segment_f64(qdist_unit_f64 *unit, const qdist_segment_unit_f64 *shape);

/// Makes the hull of the origin and a list of points, not all zero. Reads all of them.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (shape->count is 0, or all points are), NONFINITE (a coordinate).
QDIST_API qdist_status qdist_unit_vertices_f64(qdist_unit_f64 *unit, const qdist_points_f64 *shape);

/* =========================================================== QUERIES ===========================================================
 *
 * Every query returns a bracket: lower <= d <= upper holds whatever the outcome, rounding included. It is as narrow as
 * the options ask for when the outcome is QDIST_CONVERGED, and that or as narrow as rounding allows for QDIST_TOUCHING; with
 * QDIST_SEPARATED it may be wider when a limit, `interrupt` or the scalar type ended the search. An end that is not known is
 * -DBL_MAX or DBL_MAX (float: FLT_MAX).
 *
 * The result is written when the call works, or when only a callback failed; otherwise it is left as it was.
 *
 * qdist_solve chooses a plan by what the query is, and tells it in the result. With at least 3 * dimension vertices and
 * 4 * dimension facets it converges in any memory, given the iterations: the less memory, the more (in dimension 6, 64 vertices and 512
 * facets are a sensible least). max_iterations and `interrupt` bound the work.
 *
 * The gradient of d > 0. d = min over u of h_A(u) / h_Q(u); where the minimiser u is unique and A smooth there, the envelope theorem
 * gives the derivative with respect to any parameter p of A or Q from quantities of the result:
 *
 *   dd/dp = (direction . ds/dp - d * dh_Q/dp) / h_Q
 *
 * with ds/dp the velocity of A's point at `support` as p changes, and dh_Q/dp the change of h_Q(direction). Where A has a face
 * there, ds/dp is the mean of the velocities of `points` with `weights`. When A is translated, the gradient is direction / h_Q.
 * It is exact up to about the square root of the bracket's relative width. With has_rival the minimiser is not unique: then d has
 * one-sided derivatives, each the least of those at all minimisers. */

/// How a query ends, and where it looks first. NULL stands for the defaults. Start with qdist_options_default: absolute and
/// relative must not both be 0.
typedef struct {
    uint32_t struct_size;
    /// The most steps (see `iterations` of qdist_result), over all plans; 0: 50,000, which take half a second to two seconds in
    /// dimension 6 (`./x figures`; `cargo run --release --features std --example worst_case`), and 64 for each vertex of a polytopal Q.
    uint32_t max_iterations;
    /// NULL; or asked before every iteration whether to stop (QDIST_INTERRUPTED).
    qdist_interrupt interrupt;
    /// First argument of `interrupt`.
    void *interrupt_user;
    /// Stop when upper - lower <= max(absolute, relative * |d|). Both >= 0, not both 0. Default 0.
    double absolute;
    /// See `absolute`. Default: 1e-6 in double, 1e-4 in float.
    double relative;
    /// With use_threshold: stop as soon as d >= threshold or d < threshold is certain.
    double threshold;
    /// 0 or 1.
    uint32_t use_threshold;
    /// 0 or 1.
    uint32_t use_guess;
    /// With use_guess: a direction to look in first, of any length: the normal or direction of the last result. The first
    /// numbers count, as many as the dimension.
    double guess[6];
} qdist_options_f64;

/// The depth of two bodies.
typedef struct {
    uint32_t struct_size;
    /// What was concluded.
    qdist_outcome outcome;
    /// Bracket of the signed depth: above 0 the length of the shortest translation that separates the bodies; below 0
    /// minus their distance.
    double lower;
    double upper;
    /// Unit vector from A to B that proves `upper`: moved by upper * normal, B no longer overlaps A. (Of vectors in the plane, the third
    /// number is 0.)
    double normal[3];
    /// Witness points on A and B, in the world. Where the bracket is as narrow as asked for (elsewhere they only prove `lower`), point_a - point_b is depth * normal up to the tolerance: the points that touch
    /// after B has been moved, or the nearest points of separated bodies.
    double point_a[3];
    double point_b[3];
    /// Affine dimension of A - B, without ball terms, as far as it was found out: 3 unless it is flat.
    uint32_t dimension;
    /// Steps of all plans, as in qdist_result: points of A - B that were asked for to go on with.
    uint32_t iterations;
    /// Calls of the support function of the body that was asked more often: of both, unless one alone had to be measured because it does not
    /// state its extent.
    uint32_t support_calls;
    /// A solver with so many vertices and facets would have done, unless the run was cut short (QDIST_CAPACITY, QDIST_ITERATIONS,
    /// QDIST_INTERRUPTED).
    uint32_t vertices_used;
    uint32_t facets_used;
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    int32_t callback_code;
} qdist_depth_f64;

/// The generalized depth of the origin in a set.
typedef struct {
    uint32_t struct_size;
    /// What was concluded.
    qdist_outcome outcome;
    /// How.
    qdist_plan plan;
    /// 1: the minimiser is not unique, to the tolerance; see `rival`. 0: no second one was met.
    uint32_t has_rival;
    /// Bracket of d = max { d : d * Q inside A }, in units of Q; below 0 it is minus the Euclidean distance of A from the
    /// origin, in units of the radius where Q is a ball.
    double lower;
    double upper;
    /// Unit vector u that proves `upper`: h_A(u) / h_Q(u). The weakest direction of A. Unused numbers are 0.
    double direction[6];
    /// The point of A (its ball included) that is farthest along `direction`.
    double support[6];
    /// h_Q(direction).
    double unit;
    /// With has_rival: another unit vector, more than 8 degrees away, that bounds d as tightly.
    double rival[6];
    /// Weights of the points, >= 0, of sum 1: for a Euclidean Q, of the point of their simplex nearest to the origin.
    double weights[7];
    /// Coordinate k of point i is points[i * (dimension of the solver) + k].
    double points[42];
    /// Evidence for `lower`: so many points of A's core, in `points` and `weights`; at most dimension + 1.
    uint32_t point_count;
    /// Affine dimension of A's core, as far as it was found out.
    uint32_t dimension;
    /// Steps of all plans, which max_iterations limits: points of A that a plan asked for to go on with. No steps, and counted by support_calls
    /// alone, are the first points, the point with which a ray or a walk ends, what looks for a rival or for the ends of an arc, what is asked
    /// again (without shortcuts, in two words), and what pushes facets out that rounding would swallow. A pass of rays that ends without an
    /// answer counts a step that asks nothing.
    uint32_t iterations;
    /// Calls of A's support function.
    uint32_t support_calls;
    /// A solver with so many vertices and facets would have done, unless the run was cut short (QDIST_CAPACITY, QDIST_ITERATIONS,
    /// QDIST_INTERRUPTED).
    uint32_t vertices_used;
    uint32_t facets_used;
    /// With QDIST_PLAN_CONES: cones in the last completed pass, and the most halvings of an orthant, of at most 192.
    uint32_t cones;
    uint32_t splits;
    /// What the failed callback returned, or QDIST_CALLBACK_NONFINITE; else 0.
    int32_t callback_code;
} qdist_result_f64;

/// Writes the defaults.
///
/// Status: none but those of all functions.
QDIST_API qdist_status qdist_options_default_f64(qdist_options_f64 *options);

/// Penetration depth or distance of two bodies in space, with witness points. A and B may be the same body. The solver is
/// one of dimension 3. Swapping A and B turns the normal and swaps the points.
///
/// Status: those of a solver, of a body (a, b), which a half space has as qdist_body_half_space, and of options; ARGUMENT (a or b: `route` is NULL, so that no
/// function has made the body); CALLBACK (a or b); NONFINITE (also: the difference of the bodies is too large).
QDIST_API
qdist_status qdist_depth3_f64(qdist_solver *solver,
                              const qdist_body_f64 *a,
                              const qdist_body_f64 *b,
                              const qdist_options_f64 *options,
                              qdist_depth_f64 *result);

/// The depth d of the origin in the set A with respect to the unit set Q, in dimension 2, which is also the solver's. Q may be
/// NULL: the unit ball.
///
/// Status: those of a solver, of a set (a), of a unit set (q) and of options; CALLBACK (a or q); NONFINITE (also: the numbers of a became too
/// large).
QDIST_API
qdist_status qdist_solve2_f64(qdist_solver *solver,
                              const qdist_set_f64 *a,
                              const qdist_unit_f64 *q,
                              const qdist_options_f64 *options,
                              qdist_result_f64 *result);

/// The same in dimension 3.
///
/// Status: as of qdist_solve2.
QDIST_API
qdist_status qdist_solve3_f64(qdist_solver *solver,
                              const qdist_set_f64 *a,
                              const qdist_unit_f64 *q,
                              const qdist_options_f64 *options,
                              qdist_result_f64 *result);

/// The same in dimension 4.
///
/// Status: as of qdist_solve2.
QDIST_API
qdist_status qdist_solve4_f64(qdist_solver *solver,
                              const qdist_set_f64 *a,
                              const qdist_unit_f64 *q,
                              const qdist_options_f64 *options,
                              qdist_result_f64 *result);

/// The same in dimension 5.
///
/// Status: as of qdist_solve2.
QDIST_API
qdist_status qdist_solve5_f64(qdist_solver *solver,
                              const qdist_set_f64 *a,
                              const qdist_unit_f64 *q,
                              const qdist_options_f64 *options,
                              qdist_result_f64 *result);

/// The same in dimension 6.
///
/// Status: as of qdist_solve2.
QDIST_API
qdist_status qdist_solve6_f64(qdist_solver *solver,
                              const qdist_set_f64 *a,
                              const qdist_unit_f64 *q,
                              const qdist_options_f64 *options,
                              qdist_result_f64 *result);

/* ===================================================== BODIES IN THE PLANE =====================================================
 *
 * All that qdist_depth3 does in space, in the plane: discs, boxes, ellipses, capsules, polygons, half planes, hulls of two bodies, and support
 * functions of your own. The solver is one of dimension 2; for polygons of m and n vertices, m + n vertices and as many facets
 * suffice; for two ellipses and the default tolerance 64 and 64 nearly always, 128 and 128 in all of 60,000 random pairs
 * (`cargo run --release --example memory --features std`). Results are those of space, with 0 as the third numbers.
 *
 * A pose has a 2 x 2 matrix, as one in space has a 3 x 3 matrix, and not an angle, whose sine and cosine would be rounded here, each in its own
 * way: write { c, -s, s, c } for the cosine and sine that you have. */

/// A set in the plane with a pose: x -> rotation * x + translation.
typedef struct {
    /// The set, in the body's frame.
    qdist_set_f64 set;
    /// Row-major: { c, -s, s, c } for cosine c and sine s. A rotation to within 1e-4; used as it is given.
    double rotation[4];
    /// Position of the body's frame in the world.
    double translation[2];
    /// As in qdist_body_f64.
    double center[2];
    double rolling_radius;
    double spread;
    double extents[2];
    double errors[2];
    /// NULL; what qdist_body2_half_plane puts here answers in place of the support function. Not for functions of your own.
    qdist_unbounded unbounded;
    /// As in qdist_body_f64.
    qdist_precise_f64 precise;
} qdist_body2_f64;

/// All points within `radius` of the origin.
typedef struct {
    double radius;
} qdist_disc_f64;

/// |x| <= half[0], |y| <= half[1].
typedef struct {
    double half[2];
} qdist_box2_f64;

/// The ellipse with these semi axes along x and y.
typedef struct {
    double semi_axes[2];
} qdist_ellipse_f64;

/// All points within `radius` of the segment from (0, -half_height) to (0, half_height).
typedef struct {
    double radius;
    double half_height;
} qdist_capsule2_f64;

/// The convex hull of two bodies, as qdist_join_f64.
typedef struct {
    const qdist_body2_f64 *a;
    const qdist_body2_f64 *b;
} qdist_join2_f64;

/// The points x with normal . x <= offset. The normal points out of the half plane; it need not be of unit length, but not 0.
typedef struct {
    double normal[2];
    double offset;
} qdist_half_plane_f64;

/// Makes a body of a disc, in the identity pose, like all that follow.
///
/// Status: ARGUMENT (the radius negative), NONFINITE (the radius NaN, infinite or too large).
QDIST_API qdist_status qdist_body2_disc_f64(qdist_body2_f64 *body, const qdist_disc_f64 *shape);

/// Makes a body of a box.
///
/// Status: ARGUMENT (a half size negative), NONFINITE (a half size NaN, infinite or too large).
QDIST_API qdist_status qdist_body2_box_f64(qdist_body2_f64 *body, const qdist_box2_f64 *shape);

/// Makes a body of an ellipse.
///
/// Status: ARGUMENT (a semi axis negative), NONFINITE (a semi axis NaN, infinite or too large).
QDIST_API qdist_status qdist_body2_ellipse_f64(qdist_body2_f64 *body, const qdist_ellipse_f64 *shape);

/// Makes a body of a capsule.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
QDIST_API qdist_status qdist_body2_capsule_f64(qdist_body2_f64 *body, const qdist_capsule2_f64 *shape);

/// Makes a body of the convex hull of a list of points of dimension 2, in any order: a convex polygon. Reads all of them.
///
/// Status: DIMENSION (shape->dimension is not 2), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
QDIST_API
qdist_status qdist_body2_points_f64(qdist_body2_f64 *body,
                                    const qdist_points_f64 *shape);

/// Makes a body of any set of dimension 2. Checks and copies the set; what it points to must outlive the body.
///
/// Status: those of a set (set).
QDIST_API qdist_status qdist_body2_set_f64(qdist_body2_f64 *body, const qdist_set_f64 *set);

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
///
/// Status: as of qdist_body_join.
QDIST_API qdist_status qdist_body2_join_f64(qdist_body2_f64 *body, const qdist_join2_f64 *join);

/// Makes a body of a half plane, as qdist_body_half_space in space. Numbers are read at every query.
///
/// Status: ARGUMENT (the normal is 0), NONFINITE (normal or offset).
QDIST_API qdist_status qdist_body2_half_plane_f64(qdist_body2_f64 *body, const qdist_half_plane_f64 *shape);

/// Penetration depth or distance of two bodies in the plane, with witness points. A and B may be the same body. The solver is
/// one of dimension 2. Swapping A and B turns the normal and swaps the points.
///
/// Status: as of qdist_depth3.
QDIST_API
qdist_status qdist_depth2_f64(qdist_solver *solver,
                              const qdist_body2_f64 *a,
                              const qdist_body2_f64 *b,
                              const qdist_options_f64 *options,
                              qdist_depth_f64 *result);

/* ========================================================== FLAT SETS ==========================================================
 *
 * A set in a line, plane or other subspace has depth 0 in the whole space, but a depth of its own in its subspace. This function
 * measures a flat set that contains the origin there, with the projection of Q on it; `dimension` of the result tells the
 * subspace's dimension, and directions and points are those of the whole space. Any other set is answered as by
 * qdist_solve. Flat means: no wider than the rounding of A's support function. Costs dimension + 1 to 2 * dimension + 2 more support
 * calls. A program that calls this function contains the solvers of all dimensions. */

/// The depth d of the origin in the set A with respect to the unit set Q, in the linear span of A, in the dimension of the solver. Arguments as of
/// qdist_solve2 to qdist_solve6.
///
/// Status: as of qdist_solve2.
QDIST_API
qdist_status qdist_solve_in_span_f64(qdist_solver *solver,
                                     const qdist_set_f64 *a,
                                     const qdist_unit_f64 *q,
                                     const qdist_options_f64 *options,
                                     qdist_result_f64 *result);

/* ========================================================== WARM START ==========================================================
 *
 * For control loops. A tracker remembers the minimisers and the certified lower bound of the last tick. Where the caller knows how
 * far the set has moved since, the old lower bound less that distance is a new one, and the old minimisers give upper bounds
 * for one support call each. If that bracket is as narrow as the options ask for, it is the answer (QDIST_PLAN_WARM); else the solver
 * goes on from there, within max_iterations and `interrupt`, and the result is never worse. Let the first tick converge, without a
 * limit and to a tighter tolerance than the others: ticks are answered at once while what the moves have cost fits between the two.
 *
 *   qdist_tracker_init_f64(&tracker, 6);
 *   moved = -1;
 *   for (;;) {
 *       ... A moves; `moved` bounds how far any of its points did ...
 *       qdist_solve_warm6_f64(solver, &tracker, &a, &q, moved, &options, &result);
 *   } */

/// What a loop remembers: plain data without addresses, for one set, one unit set and one dimension. Made by
/// qdist_tracker_init_f64.
typedef struct {
    uint32_t struct_size;
    uint32_t dimension;
    /// d of the last set is not less; -DBL_MAX (float: FLT_MAX): not known.
    double lower;
    /// Unit vectors, the last minimiser first; unused ones are 0.
    double directions[4][6];
} qdist_tracker_f64;

/// Makes a tracker that remembers nothing, for a dimension of 2 to 6. Do it again when Q changes.
///
/// Status: DIMENSION (dimension).
QDIST_API qdist_status qdist_tracker_init_f64(qdist_tracker_f64 *tracker, uint32_t dimension);

/// The certified lower bound of d after A has moved by at most `moved`, without a query; -DBL_MAX (float: FLT_MAX) where nothing is
/// remembered, or where Q has no known inner_radius. Arguments as of qdist_solve_warm; Q may be NULL.
///
/// Status: DIMENSION (tracker->dimension), ARGUMENT (a direction of the tracker is neither of unit length nor 0), NONFINITE (moved, or a number
/// of the tracker); those of a unit set (q).
QDIST_API
qdist_status qdist_tracker_lower_after_f64(const qdist_tracker_f64 *tracker,
                                           const qdist_unit_f64 *q,
                                           double moved,
                                           double *lower);

/// The depth d of the origin in the set A with respect to the unit set Q, in dimension 2, for the next tick of a loop, and
/// takes note of it in the tracker. Arguments as of qdist_solve2; besides:
///
/// moved: A is the set of the last call with this tracker, moved or deformed so that no point of either is farther than this from the
/// other (Hausdorff distance), in your unit; a negative number: not known, and only the directions are used.
///
/// Status: as of qdist_solve2, and of the tracker as of qdist_tracker_lower_after; NONFINITE (moved).
QDIST_API
qdist_status qdist_solve_warm2_f64(qdist_solver *solver,
                                   qdist_tracker_f64 *tracker,
                                   const qdist_set_f64 *a,
                                   const qdist_unit_f64 *q,
                                   double moved,
                                   const qdist_options_f64 *options,
                                   qdist_result_f64 *result);

/// The same in dimension 3.
///
/// Status: as of qdist_solve_warm2.
QDIST_API
qdist_status qdist_solve_warm3_f64(qdist_solver *solver,
                                   qdist_tracker_f64 *tracker,
                                   const qdist_set_f64 *a,
                                   const qdist_unit_f64 *q,
                                   double moved,
                                   const qdist_options_f64 *options,
                                   qdist_result_f64 *result);

/// The same in dimension 4.
///
/// Status: as of qdist_solve_warm2.
QDIST_API
qdist_status qdist_solve_warm4_f64(qdist_solver *solver,
                                   qdist_tracker_f64 *tracker,
                                   const qdist_set_f64 *a,
                                   const qdist_unit_f64 *q,
                                   double moved,
                                   const qdist_options_f64 *options,
                                   qdist_result_f64 *result);

/// The same in dimension 5.
///
/// Status: as of qdist_solve_warm2.
QDIST_API
qdist_status qdist_solve_warm5_f64(qdist_solver *solver,
                                   qdist_tracker_f64 *tracker,
                                   const qdist_set_f64 *a,
                                   const qdist_unit_f64 *q,
                                   double moved,
                                   const qdist_options_f64 *options,
                                   qdist_result_f64 *result);

/// The same in dimension 6.
///
/// Status: as of qdist_solve_warm2.
QDIST_API
qdist_status qdist_solve_warm6_f64(qdist_solver *solver,
                                   qdist_tracker_f64 *tracker,
                                   const qdist_set_f64 *a,
                                   const qdist_unit_f64 *q,
                                   double moved,
                                   const qdist_options_f64 *options,
                                   qdist_result_f64 *result);

/* ======================================================== SOLVERS, FLOAT ======================================================== */

QDIST_API
qdist_status qdist_solver_init_f32(void *memory,
                                   uint32_t bytes,
                                   uint32_t dimension,
                                   uint32_t max_vertices,
                                   uint32_t max_facets,
                                   qdist_solver **solver);

/* ====================================================== CONVEX SETS, FLOAT ====================================================== */

typedef int32_t (*qdist_support_f32)(void *user, const float *direction, float *point);

typedef struct {
    qdist_support_f32 support;
    qdist_support_f32 exhaustive;
    qdist_mirrored mirrored;
    void *user;
    float radius;
    float extent;
    float error;
    uint32_t dimension;
    uint32_t contains_origin;
} qdist_set_f32;

typedef int32_t (*qdist_precise_f32)(void *user, const float *direction, float *point);

typedef struct {
    qdist_set_f32 set;
    float rotation[9];
    float translation[3];
    float center[3];
    float rolling_radius;
    float spread;
    float extents[3];
    float errors[3];
    uint32_t symmetry;
    qdist_unbounded unbounded;
    qdist_route route;
    qdist_precise_f32 precise;
} qdist_body_f32;

QDIST_API qdist_status qdist_body_set_f32(qdist_body_f32 *body, const qdist_set_f32 *set);

/* ==================================================== SHAPES IN SPACE, FLOAT ==================================================== */

typedef struct {
    float radius;
} qdist_sphere_f32;

typedef struct {
    float half[3];
} qdist_box_f32;

typedef struct {
    float semi_axes[3];
} qdist_ellipsoid_f32;

typedef struct {
    float radius;
    float half_height;
} qdist_cylinder_f32;

typedef struct {
    float radius;
    float half_height;
} qdist_capsule_f32;

typedef struct {
    float radius;
    float half_height;
} qdist_cone_f32;

QDIST_API qdist_status qdist_body_sphere_f32(qdist_body_f32 *body, const qdist_sphere_f32 *shape);

QDIST_API qdist_status qdist_body_box_f32(qdist_body_f32 *body, const qdist_box_f32 *shape);

QDIST_API qdist_status qdist_body_ellipsoid_f32(qdist_body_f32 *body, const qdist_ellipsoid_f32 *shape);

QDIST_API qdist_status qdist_body_cylinder_f32(qdist_body_f32 *body, const qdist_cylinder_f32 *shape);

QDIST_API qdist_status qdist_body_capsule_f32(qdist_body_f32 *body, const qdist_capsule_f32 *shape);

QDIST_API qdist_status qdist_body_cone_f32(qdist_body_f32 *body, const qdist_cone_f32 *shape);

/* ==================================================== HULLS OF POINTS, FLOAT ==================================================== */

typedef struct {
    const float *points;
    uint32_t count;
    uint32_t dimension;
} qdist_points_f32;

typedef struct {
    qdist_points_f32 points;
    const uint16_t *graph;
    uint32_t graph_len;
} qdist_hull_f32;

typedef struct {
    qdist_points_f32 points;
    const uint32_t *graph;
    uint32_t graph_len;
} qdist_hull_large_f32;

QDIST_API qdist_status qdist_set_points_f32(qdist_set_f32 *set, const qdist_points_f32 *shape);

QDIST_API qdist_status qdist_body_points_f32(qdist_body_f32 *body, const qdist_points_f32 *shape);

QDIST_API
qdist_status qdist_hull_prepare_f32(qdist_hull_f32 *hull,
                                    qdist_solver *solver,
                                    const float *points,
                                    uint32_t count,
                                    qdist_interrupt interrupt,
                                    void *interrupt_user,
                                    uint16_t *graph,
                                    uint32_t graph_capacity);

QDIST_API
qdist_status qdist_hull_large_prepare_f32(qdist_hull_large_f32 *hull,
                                          uint32_t *workspace,
                                          uint32_t workspace_capacity,
                                          const float *points,
                                          uint32_t count,
                                          qdist_interrupt interrupt,
                                          void *interrupt_user,
                                          uint32_t *graph,
                                          uint32_t graph_capacity);

QDIST_API qdist_status qdist_body_hull_f32(qdist_body_f32 *body, const qdist_hull_f32 *shape);

QDIST_API qdist_status qdist_body_hull_large_f32(qdist_body_f32 *body, const qdist_hull_large_f32 *shape);

/* ================================================== HULLS OF TWO BODIES, FLOAT ================================================== */

typedef struct {
    const qdist_body_f32 *a;
    const qdist_body_f32 *b;
} qdist_join_f32;

QDIST_API qdist_status qdist_body_join_f32(qdist_body_f32 *body, const qdist_join_f32 *join);

/* ====================================================== HALF SPACES, FLOAT ====================================================== */

typedef struct {
    float normal[3];
    float offset;
} qdist_half_space_f32;

QDIST_API qdist_status qdist_body_half_space_f32(qdist_body_f32 *body, const qdist_half_space_f32 *shape);

/* =================================================== SETS MADE OF SETS, FLOAT =================================================== */

typedef struct {
    const qdist_set_f32 *a;
    const qdist_set_f32 *b;
    uint32_t dimension;
} qdist_pair_f32;

typedef struct {
    const qdist_set_f32 *set;
    const float *matrix;
    float translation[6];
    uint32_t rows;
    uint32_t columns;
} qdist_linear_f32;

QDIST_API qdist_status qdist_set_sum_f32(qdist_set_f32 *set, const qdist_pair_f32 *pair);

QDIST_API qdist_status qdist_set_difference_f32(qdist_set_f32 *set, const qdist_pair_f32 *pair);

QDIST_API qdist_status qdist_set_join_f32(qdist_set_f32 *set, const qdist_pair_f32 *pair);

QDIST_API qdist_status qdist_set_linear_f32(qdist_set_f32 *set, const qdist_linear_f32 *map);

/* ======================================================= UNIT SETS, FLOAT ======================================================= */

typedef float (*qdist_unit_value_f32)(void *user, const float *direction);

typedef int32_t (*qdist_unit_point_f32)(void *user, const float *direction, float *point);

typedef int32_t (*qdist_unit_vertex_f32)(void *user, uint32_t index, float *point);

typedef struct {
    qdist_unit_value_f32 value;
    qdist_unit_point_f32 point;
    qdist_unit_vertex_f32 vertex;
    qdist_mirrored mirrored;
    void *user;
    float extent;
    float ball_radius;
    float inner_radius;
    uint32_t vertex_count;
    uint32_t dimension;
} qdist_unit_f32;

typedef struct {
    float semi_axes[6];
    const float *rotation;
    uint32_t dimension;
} qdist_ellipsoid_unit_f32;

typedef struct {
    float half[6];
    uint32_t dimension;
} qdist_box_unit_f32;

typedef struct {
    float semi_axes[6];
    uint32_t dimension;
} qdist_cross_unit_f32;

typedef struct {
    float end[6];
    uint32_t dimension;
} qdist_segment_unit_f32;

QDIST_API qdist_status qdist_unit_ball_f32(qdist_unit_f32 *unit, float radius);

QDIST_API qdist_status qdist_unit_ellipsoid_f32(qdist_unit_f32 *unit, const qdist_ellipsoid_unit_f32 *shape);

QDIST_API qdist_status qdist_unit_box_f32(qdist_unit_f32 *unit, const qdist_box_unit_f32 *shape);

QDIST_API qdist_status qdist_unit_cross_f32(qdist_unit_f32 *unit, const qdist_cross_unit_f32 *shape);

QDIST_API qdist_status qdist_unit_segment_f32(qdist_unit_f32 *unit, const qdist_segment_unit_f32 *shape);

QDIST_API qdist_status qdist_unit_vertices_f32(qdist_unit_f32 *unit, const qdist_points_f32 *shape);

/* ======================================================== QUERIES, FLOAT ======================================================== */

typedef struct {
    uint32_t struct_size;
    uint32_t max_iterations;
    qdist_interrupt interrupt;
    void *interrupt_user;
    float absolute;
    float relative;
    float threshold;
    uint32_t use_threshold;
    uint32_t use_guess;
    float guess[6];
} qdist_options_f32;

typedef struct {
    uint32_t struct_size;
    qdist_outcome outcome;
    float lower;
    float upper;
    float normal[3];
    float point_a[3];
    float point_b[3];
    uint32_t dimension;
    uint32_t iterations;
    uint32_t support_calls;
    uint32_t vertices_used;
    uint32_t facets_used;
    int32_t callback_code;
} qdist_depth_f32;

typedef struct {
    uint32_t struct_size;
    qdist_outcome outcome;
    qdist_plan plan;
    uint32_t has_rival;
    float lower;
    float upper;
    float direction[6];
    float support[6];
    float unit;
    float rival[6];
    float weights[7];
    float points[42];
    uint32_t point_count;
    uint32_t dimension;
    uint32_t iterations;
    uint32_t support_calls;
    uint32_t vertices_used;
    uint32_t facets_used;
    uint32_t cones;
    uint32_t splits;
    int32_t callback_code;
} qdist_result_f32;

QDIST_API qdist_status qdist_options_default_f32(qdist_options_f32 *options);

QDIST_API
qdist_status qdist_depth3_f32(qdist_solver *solver,
                              const qdist_body_f32 *a,
                              const qdist_body_f32 *b,
                              const qdist_options_f32 *options,
                              qdist_depth_f32 *result);

QDIST_API
qdist_status qdist_solve2_f32(qdist_solver *solver,
                              const qdist_set_f32 *a,
                              const qdist_unit_f32 *q,
                              const qdist_options_f32 *options,
                              qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve3_f32(qdist_solver *solver,
                              const qdist_set_f32 *a,
                              const qdist_unit_f32 *q,
                              const qdist_options_f32 *options,
                              qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve4_f32(qdist_solver *solver,
                              const qdist_set_f32 *a,
                              const qdist_unit_f32 *q,
                              const qdist_options_f32 *options,
                              qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve5_f32(qdist_solver *solver,
                              const qdist_set_f32 *a,
                              const qdist_unit_f32 *q,
                              const qdist_options_f32 *options,
                              qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve6_f32(qdist_solver *solver,
                              const qdist_set_f32 *a,
                              const qdist_unit_f32 *q,
                              const qdist_options_f32 *options,
                              qdist_result_f32 *result);

/* ================================================== BODIES IN THE PLANE, FLOAT ================================================== */

typedef struct {
    qdist_set_f32 set;
    float rotation[4];
    float translation[2];
    float center[2];
    float rolling_radius;
    float spread;
    float extents[2];
    float errors[2];
    qdist_unbounded unbounded;
    qdist_precise_f32 precise;
} qdist_body2_f32;

typedef struct {
    float radius;
} qdist_disc_f32;

typedef struct {
    float half[2];
} qdist_box2_f32;

typedef struct {
    float semi_axes[2];
} qdist_ellipse_f32;

typedef struct {
    float radius;
    float half_height;
} qdist_capsule2_f32;

typedef struct {
    const qdist_body2_f32 *a;
    const qdist_body2_f32 *b;
} qdist_join2_f32;

typedef struct {
    float normal[2];
    float offset;
} qdist_half_plane_f32;

QDIST_API qdist_status qdist_body2_disc_f32(qdist_body2_f32 *body, const qdist_disc_f32 *shape);

QDIST_API qdist_status qdist_body2_box_f32(qdist_body2_f32 *body, const qdist_box2_f32 *shape);

QDIST_API qdist_status qdist_body2_ellipse_f32(qdist_body2_f32 *body, const qdist_ellipse_f32 *shape);

QDIST_API qdist_status qdist_body2_capsule_f32(qdist_body2_f32 *body, const qdist_capsule2_f32 *shape);

QDIST_API qdist_status qdist_body2_points_f32(qdist_body2_f32 *body, const qdist_points_f32 *shape);

QDIST_API qdist_status qdist_body2_set_f32(qdist_body2_f32 *body, const qdist_set_f32 *set);

QDIST_API qdist_status qdist_body2_join_f32(qdist_body2_f32 *body, const qdist_join2_f32 *join);

QDIST_API qdist_status qdist_body2_half_plane_f32(qdist_body2_f32 *body, const qdist_half_plane_f32 *shape);

QDIST_API
qdist_status qdist_depth2_f32(qdist_solver *solver,
                              const qdist_body2_f32 *a,
                              const qdist_body2_f32 *b,
                              const qdist_options_f32 *options,
                              qdist_depth_f32 *result);

/* ======================================================= FLAT SETS, FLOAT ======================================================= */

QDIST_API
qdist_status qdist_solve_in_span_f32(qdist_solver *solver,
                                     const qdist_set_f32 *a,
                                     const qdist_unit_f32 *q,
                                     const qdist_options_f32 *options,
                                     qdist_result_f32 *result);

/* ====================================================== WARM START, FLOAT ====================================================== */

typedef struct {
    uint32_t struct_size;
    uint32_t dimension;
    float lower;
    float directions[4][6];
} qdist_tracker_f32;

QDIST_API qdist_status qdist_tracker_init_f32(qdist_tracker_f32 *tracker, uint32_t dimension);

QDIST_API
qdist_status qdist_tracker_lower_after_f32(const qdist_tracker_f32 *tracker,
                                           const qdist_unit_f32 *q,
                                           float moved,
                                           float *lower);

QDIST_API
qdist_status qdist_solve_warm2_f32(qdist_solver *solver,
                                   qdist_tracker_f32 *tracker,
                                   const qdist_set_f32 *a,
                                   const qdist_unit_f32 *q,
                                   float moved,
                                   const qdist_options_f32 *options,
                                   qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve_warm3_f32(qdist_solver *solver,
                                   qdist_tracker_f32 *tracker,
                                   const qdist_set_f32 *a,
                                   const qdist_unit_f32 *q,
                                   float moved,
                                   const qdist_options_f32 *options,
                                   qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve_warm4_f32(qdist_solver *solver,
                                   qdist_tracker_f32 *tracker,
                                   const qdist_set_f32 *a,
                                   const qdist_unit_f32 *q,
                                   float moved,
                                   const qdist_options_f32 *options,
                                   qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve_warm5_f32(qdist_solver *solver,
                                   qdist_tracker_f32 *tracker,
                                   const qdist_set_f32 *a,
                                   const qdist_unit_f32 *q,
                                   float moved,
                                   const qdist_options_f32 *options,
                                   qdist_result_f32 *result);

QDIST_API
qdist_status qdist_solve_warm6_f32(qdist_solver *solver,
                                   qdist_tracker_f32 *tracker,
                                   const qdist_set_f32 *a,
                                   const qdist_unit_f32 *q,
                                   float moved,
                                   const qdist_options_f32 *options,
                                   qdist_result_f32 *result);

#ifdef __cplusplus
}
#endif

#endif
