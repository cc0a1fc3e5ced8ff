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
