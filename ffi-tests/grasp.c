/* Grasps from C, in both scalar types: Table I (a1)-(a5) of Zheng & Yamane, force closure, the best of several, bad arguments. The
 * file includes itself once for each. */
#ifndef REAL

#include "qdist_grasp.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define JOIN_(name, suffix) name##suffix
#define JOIN(name, suffix) JOIN_(name, suffix)
#define Q(name) JOIN(name, SUFFIX)

#define REAL double
#define SUFFIX _f64
#define BYTES QDIST_WORKSPACE_BYTES_F64
#define WIDTH 1e-4
#include "grasp.c"
#undef REAL
#undef SUFFIX
#undef BYTES
#undef WIDTH

#define REAL float
#define SUFFIX _f32
#define BYTES QDIST_WORKSPACE_BYTES_F32
#define WIDTH 1e-3
#include "grasp.c"

int main(void) {
    grasp_f64();
    grasp_f32();
    return finish("grasp");
}

#else

/* A soft fingertip at x on the x axis, with two joints that move it along n and o only. */
static Q(qdist_contact) Q(fingertip)(double x, double mu, double mus) {
    Q(qdist_contact) c;
    memset(&c, 0, sizeof c);
    c.position[0] = (REAL)x;
    c.normal[0] = (REAL)(x < 0 ? 1 : -1);
    c.tangents[1] = 1;            /* o = y */
    c.tangents[5] = c.normal[0];  /* t = n x o */
    c.friction = QDIST_SOFT;
    c.mu = (REAL)mu, c.mus = (REAL)mus;
    c.actuated = 1;
    c.joints = 2;
    c.jacobian[0] = 1, c.jacobian[1] = (REAL)0.4;
    c.jacobian[8] = (REAL)0.3, c.jacobian[9] = (REAL)0.9;
    return c;
}

static const Q(qdist_wrench_frame) Q(frame) = {{0, 0, 0}, 1};

static void Q(table)(qdist_solver *solver) {
    /* d_Q(W), d_Q(W^a). */
    const double expected[5][2] = {
        {0.2425187, 0.2425187}, {0.2235935, 0.2235935}, {0.3153846, 0.3153846}, {0.1119395, 0.1512915}, {1, 1}};
    const Q(qdist_ellipsoid_gauge) egg = {{2, 1, 1, 1, 1, 1}, NULL, 6};
    const Q(qdist_cross_gauge) cross = {{1, 1, 1, 1, 1, 1}, 6};
    const Q(qdist_box_gauge) cube = {{1, 1, 1, 1, 1, 1}, 6};
    const Q(qdist_segment_gauge) ray = {{1, 0, 0, 0, 0, 0}, 6};
    const Q(qdist_contact) contacts[2] = {Q(fingertip)(-0.75, 0.2, 0.2), Q(fingertip)(1.3, 0.2, 0.2)};
    Q(qdist_primitive) passive[2], active[2];
    const Q(qdist_wrenches) w = {passive, 2, QDIST_LINF}, wa = {active, 2, QDIST_LINF};
    Q(qdist_options) options;
    Q(qdist_gauge) q[5];
    Q(qdist_set) sets[2];
    Q(qdist_result) result;
    Q(qdist_active) fingers;
    uint32_t dimension, which = 7;
    REAL basis[36];
    int i, set;
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), passive, &which) == QDIST_OK && which == 7);
    CHECK(Q(qdist_active_primitives)(contacts, 2, &Q(frame), 0, active, NULL) == QDIST_OK);
    CHECK(Q(qdist_active_forces)(&contacts[0], &Q(frame), 0, &fingers) == QDIST_OK);
    CHECK(fingers.rank == 2 && fingers.can_press == 1 && fingers.dimension == 1 && fabs(fingers.delta - 1) < 1e-6);
    CHECK(Q(qdist_wrench_subspace)(passive, 2, 0, &dimension, basis) == QDIST_OK && dimension == 6);
    CHECK(Q(qdist_wrench_subspace)(active, 2, 0, &dimension, basis) == QDIST_OK && dimension == 3);
    CHECK(basis[0] == 1 && basis[7] == 1 && basis[17] == 1 && basis[18] == 0);
    CHECK(Q(qdist_set_wrenches)(&sets[0], &w) == QDIST_OK && Q(qdist_set_wrenches)(&sets[1], &wa) == QDIST_OK);
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.relative = (REAL)WIDTH;
    CHECK(Q(qdist_gauge_ball)(&q[0], 1) == QDIST_OK && Q(qdist_gauge_ellipsoid)(&q[1], &egg) == QDIST_OK);
    CHECK(Q(qdist_gauge_cross)(&q[2], &cross) == QDIST_OK && Q(qdist_gauge_box)(&q[3], &cube) == QDIST_OK);
    CHECK(Q(qdist_gauge_segment)(&q[4], &ray) == QDIST_OK);
    for (i = 0; i < 5; ++i) {
        for (set = 0; set < 2; ++set) {
            const double d = expected[i][set];
            result.struct_size = sizeof result;
            CHECK(Q(qdist_solve_in_span6)(solver, &sets[set], &q[i], &options, &result) == QDIST_OK);
            CHECK(result.outcome == QDIST_CONVERGED && result.dimension == (set ? 3u : 6u));
            CHECK(result.lower <= d + 1e-6 && d - 1e-6 <= result.upper);
            CHECK(result.upper - result.lower <= 1.01 * WIDTH * d);
        }
    }
}

static void Q(closures)(qdist_solver *solver) {
    Q(qdist_contact) contacts[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    Q(qdist_primitive) primitives[2][2];
    const Q(qdist_wrenches) w = {primitives[0], 2, QDIST_L1}, pivot = {primitives[1], 2, QDIST_LINF};
    Q(qdist_set) sets[2];
    Q(qdist_closure) closure;
    Q(qdist_best) best;
    Q(qdist_result) result;
    memset(&closure, 0, sizeof closure);
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), primitives[0], NULL) == QDIST_OK);
    contacts[0].friction = contacts[1].friction = QDIST_HARD;
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), primitives[1], NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&sets[0], &w) == QDIST_OK && Q(qdist_set_wrenches)(&sets[1], &pivot) == QDIST_OK);
    CHECK(Q(qdist_force_closure)(solver, &sets[0], NULL, &closure) == QDIST_ERROR_STRUCT_SIZE);
    closure.struct_size = sizeof closure;
    CHECK(Q(qdist_force_closure)(solver, &sets[0], NULL, &closure) == QDIST_OK);
    CHECK(closure.verdict == QDIST_CLOSURE_CLOSED && closure.radius > 0);
    CHECK(Q(qdist_force_closure)(solver, &sets[1], NULL, &closure) == QDIST_OK);
    CHECK(closure.verdict == QDIST_CLOSURE_OPEN && fabs(closure.direction[3]) > 0.9999); /* it spins about the x axis */

    /* The best of the two is the one that holds. */
    best.struct_size = sizeof best;
    best.result.struct_size = sizeof result;
    CHECK(Q(qdist_best_of6)(solver, sets, 2, NULL, NULL, &best) == QDIST_OK);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_solve6)(solver, &sets[0], NULL, NULL, &result) == QDIST_OK);
    CHECK(best.index == 0 && best.ceiling >= best.result.upper && best.result.lower == result.lower);
    CHECK(Q(qdist_best_of6)(solver, sets, 0, NULL, NULL, &best) == QDIST_ERROR_ARGUMENT);
    best.result.struct_size = 1;
    CHECK(Q(qdist_best_of6)(solver, sets, 2, NULL, NULL, &best) == QDIST_ERROR_STRUCT_SIZE);
}

/* An error says what is wrong and with which contact, and nothing is written. */
static void Q(errors)(void) {
    const Q(qdist_contact) good[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    const REAL none = (REAL)NAN;
    Q(qdist_contact) bad[2];
    Q(qdist_primitive) primitives[2], before[2];
    Q(qdist_wrenches) w = {primitives, 2, QDIST_LINF};
    Q(qdist_wrench_frame) frame = Q(frame);
    Q(qdist_active) active;
    Q(qdist_set) set;
    uint32_t which;
    REAL basis[36];
    memset(primitives, 0, sizeof primitives);
    memcpy(before, primitives, sizeof before);
#define REFUSED(change, code)                                                                                           \
    memcpy(bad, good, sizeof bad);                                                                                      \
    change;                                                                                                             \
    which = 9;                                                                                                          \
    CHECK(Q(qdist_active_primitives)(bad, 2, &frame, 0, primitives, &which) == code && which == 1);                     \
    CHECK(memcmp(primitives, before, sizeof before) == 0)
    REFUSED(bad[1].position[2] = none, QDIST_ERROR_CONTACT_POSITION);
    REFUSED(bad[1].normal[0] = (REAL)0.9, QDIST_ERROR_CONTACT_NORMAL);
    REFUSED(bad[1].normal[1] = none, QDIST_ERROR_CONTACT_NORMAL);
    REFUSED(bad[1].tangents[0] = 1, QDIST_ERROR_CONTACT_TANGENTS);
    REFUSED(bad[1].mu = (REAL)-0.1, QDIST_ERROR_CONTACT_FRICTION);
    REFUSED(bad[1].mus = none, QDIST_ERROR_CONTACT_FRICTION);
    REFUSED(bad[1].friction = 3, QDIST_ERROR_CONTACT_FRICTION);
    REFUSED(bad[1].force_cap = -1, QDIST_ERROR_CONTACT_CAP);
    REFUSED(bad[1].joints = 9, QDIST_ERROR_CONTACT_JACOBIAN);
    REFUSED(bad[1].jacobian[9] = none, QDIST_ERROR_CONTACT_JACOBIAN);
    REFUSED(bad[1].actuated = 2, QDIST_ERROR_CONTACT_JACOBIAN);
#undef REFUSED
    which = 9;
    CHECK(Q(qdist_active_primitives)(good, 2, &frame, (REAL)0.6, primitives, &which) == QDIST_ERROR_TOLERANCE && which == 0);
    CHECK(Q(qdist_active_primitives)(good, 2, &frame, none, primitives, NULL) == QDIST_ERROR_TOLERANCE);
    CHECK(Q(qdist_passive_primitives)(NULL, 2, &frame, primitives, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_passive_primitives)(good, 0, &frame, primitives, NULL) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_passive_primitives)(good, 2, NULL, primitives, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_passive_primitives)(good, 2, &frame, NULL, NULL) == QDIST_ERROR_NULL);
    frame.torque_scale = 0;
    CHECK(Q(qdist_passive_primitives)(good, 2, &frame, primitives, NULL) == QDIST_ERROR_FRAME);
    frame.torque_scale = 1;
    CHECK(Q(qdist_active_forces)(&good[0], &frame, 0, NULL) == QDIST_ERROR_NULL);
    bad[0] = good[0], bad[0].actuated = 0;
    CHECK(Q(qdist_active_forces)(&bad[0], &frame, 0, &active) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_passive_primitives)(good, 2, &frame, primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_wrench_subspace)(primitives, 2, 1, &which, basis) == QDIST_ERROR_TOLERANCE);
    CHECK(Q(qdist_wrench_subspace)(primitives, 2, 0, NULL, basis) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_set_wrenches)(&set, NULL) == QDIST_ERROR_NULL);
    w.norm = 2;
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    w.norm = QDIST_L1;
    primitives[1].center[3] = none;
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_ERROR_CONTACT_WRENCH);
    primitives[1].center[3] = 0;
    primitives[1].empty = 2;
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    primitives[1].empty = 1;
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
}

static void Q(grasp)(void) {
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 128, 2048)];
    qdist_solver *solver = NULL;
    CHECK(Q(qdist_solver_init6)(memory, BYTES(6, 128, 2048), 128, 2048, &solver) == QDIST_OK);
    if (solver == NULL) return;
    Q(table)(solver);
    Q(closures)(solver);
    Q(errors)();
}

#endif
