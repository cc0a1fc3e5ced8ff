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

/* Two fingertips hold a weight by friction: each presses with weight / (2 mu). */
static void Q(forces)(void) {
    const double weight = 0.75, size = 0.75 / (2 * 0.5);
    Q(qdist_contact) contacts[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    const REAL down[3] = {0, 0, (REAL)-weight}, none[3] = {0, 0, 0}, aside[3] = {0, (REAL)NAN, 0};
    Q(qdist_primitive) primitives[2];
    const Q(qdist_wrenches) w = {primitives, 2, QDIST_LINF};
    Q(qdist_force_memory) memory;
    Q(qdist_force_options) options;
    Q(qdist_forces) forces;
    REAL external[6], shares[12], force[4];
    uint32_t first, i, k;
    memset(&memory, 0, sizeof memory);
    memset(&options, 0, sizeof options);
    forces.struct_size = sizeof forces;
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_wrench)(&Q(frame), down, none, external) == QDIST_OK);
    CHECK(Q(qdist_contact_forces)(&w, &memory, external, NULL, shares, &forces) == QDIST_OK);
    CHECK(forces.outcome == QDIST_FORCES_CONVERGED && memory.count > 0);
    CHECK(forces.lower <= size * (1 + 1e-6) && size * (1 - 1e-6) <= forces.upper && forces.upper - forces.lower < 2 * WIDTH);
    CHECK(forces.residual < 10 * WIDTH * weight);
    for (k = 0; k < 6; ++k) CHECK(fabs(shares[k] + shares[6 + k] + external[k]) < 10 * WIDTH);
    for (i = 0; i < 2; ++i) {
        CHECK(Q(qdist_contact_force)(&contacts[i], &Q(frame), shares + 6 * i, force) == QDIST_OK);
        CHECK(fabs(force[0] - size) < 2 * WIDTH && force[0] >= 0);
        CHECK(sqrt((force[1] * force[1] + force[2] * force[2]) / 0.25 + force[3] * force[3] / 0.01) <= force[0] * 1.00001);
    }
    first = forces.iterations;
    CHECK(Q(qdist_contact_forces)(&w, &memory, external, NULL, shares, &forces) == QDIST_OK && forces.iterations <= first);

    options.struct_size = sizeof options;
    options.limit = (REAL)(0.5 * size);
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, &options, shares, &forces) == QDIST_OK);
    CHECK(forces.outcome == QDIST_FORCES_ABOVE && forces.lower > 0.5 * size * 0.999);

    contacts[0].friction = contacts[1].friction = QDIST_HARD; /* they cannot hold a torque about their line */
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), primitives, NULL) == QDIST_OK);
    external[3] = 1;
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, shares, &forces) == QDIST_OK);
    CHECK(forces.outcome == QDIST_FORCES_NOT_RESISTIBLE && forces.direction[3] < -0.1 && shares[0] == 0);

    forces.iterations = 77;
    shares[0] = 7;
    external[1] = (REAL)NAN;
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, shares, &forces) == QDIST_ERROR_NONFINITE);
    external[1] = 0;
    memory.count = 7;
    CHECK(Q(qdist_contact_forces)(&w, &memory, external, NULL, shares, &forces) == QDIST_ERROR_ARGUMENT);
    options.relative = -1;
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, &options, shares, &forces) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, NULL, &forces) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_contact_forces)(NULL, NULL, external, NULL, shares, &forces) == QDIST_ERROR_NULL);
    CHECK(forces.iterations == 77 && shares[0] == 7);
    forces.struct_size = 0;
    CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, shares, &forces) == QDIST_ERROR_STRUCT_SIZE);
    CHECK(Q(qdist_wrench)(&Q(frame), aside, none, external) == QDIST_ERROR_NONFINITE);
    CHECK(Q(qdist_contact_force)(&contacts[0], &Q(frame), external, NULL) == QDIST_ERROR_NULL);
}

/* d is proportional to all caps; a symmetric grasp has a rival. */
static void Q(gradients)(qdist_solver *solver) {
    const REAL p[3][3] = {{1, (REAL)0.1, (REAL)0.2}, {(REAL)-0.4, (REAL)0.8, (REAL)0.1}, {(REAL)-0.5, (REAL)-0.9, (REAL)-0.2}};
    Q(qdist_contact) contacts[3];
    Q(qdist_primitive) primitives[3];
    Q(qdist_wrenches) w = {primitives, 3, QDIST_L1};
    Q(qdist_contact_gradient) gradients[3];
    Q(qdist_refined) refined;
    Q(qdist_options) options;
    Q(qdist_result) result;
    Q(qdist_set) set;
    double sum = 0;
    uint32_t i, k, which = 9;
    memset(contacts, 0, sizeof contacts);
    for (i = 0; i < 3; ++i) {
        const double length = sqrt((double)p[i][0] * p[i][0] + (double)p[i][1] * p[i][1] + (double)p[i][2] * p[i][2]);
        for (k = 0; k < 3; ++k) contacts[i].position[k] = p[i][k], contacts[i].normal[k] = (REAL)(-p[i][k] / length);
        contacts[i].friction = QDIST_SOFT, contacts[i].mu = (REAL)0.5, contacts[i].mus = (REAL)0.2;
    }
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.relative = (REAL)1e-2;
    result.struct_size = sizeof result;
    refined.struct_size = sizeof refined;
    CHECK(Q(qdist_passive_primitives)(contacts, 3, &Q(frame), primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
    CHECK(Q(qdist_solve6)(solver, &set, NULL, &options, &result) == QDIST_OK);
    CHECK(Q(qdist_grasp_gradients)(&w, contacts, 3, &Q(frame), 0, 0, NULL, &result, &refined, gradients, &which) == QDIST_OK);
    CHECK(refined.kink == QDIST_KINK_NONE && refined.upper <= result.upper && refined.upper >= result.lower && which == 9);
    for (i = 0; i < 3; ++i) {
        CHECK(gradients[i].known == 1 && gradients[i].mu >= 0 && gradients[i].jacobian_known == 0);
        sum += gradients[i].force_cap;
    }
    CHECK(fabs(sum - refined.upper) < 0.1 * WIDTH);
    CHECK(Q(qdist_grasp_gradients)(&w, contacts, 2, &Q(frame), 0, 0, NULL, &result, &refined, gradients, NULL)
          == QDIST_ERROR_ARGUMENT);
    contacts[2].mu = -1;
    CHECK(Q(qdist_grasp_gradients)(&w, contacts, 3, &Q(frame), 0, 0, NULL, &result, &refined, gradients, &which)
              == QDIST_ERROR_CONTACT_FRICTION
          && which == 2);
    contacts[0] = Q(fingertip)(-1, (REAL)0.5, (REAL)0.1), contacts[1] = Q(fingertip)(1, (REAL)0.5, (REAL)0.1);
    w.count = 2;
    CHECK(Q(qdist_passive_primitives)(contacts, 2, &Q(frame), primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
    CHECK(Q(qdist_solve6)(solver, &set, NULL, &options, &result) == QDIST_OK);
    CHECK(Q(qdist_grasp_gradients)(&w, contacts, 2, &Q(frame), 0, 0, NULL, &result, &refined, gradients, NULL) == QDIST_OK);
    CHECK(refined.kink != QDIST_KINK_NONE && gradients[0].known == 0);
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
    Q(forces)();
    Q(gradients)(solver);
    Q(errors)();
}

#endif
