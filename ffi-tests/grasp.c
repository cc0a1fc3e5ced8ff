/* Grasps from C, in both scalar types: Table I (a1)-(a5) of Zheng & Yamane, force closure, the best of several, contact forces, gradients,
 * fingers with torque limits, linearised cones, bad arguments. The file includes itself once for each. */
#ifndef REAL

#include "qdist_grasp.h"
#include "dice.h"
#include "test.h"

#include <float.h>
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
    const Q(qdist_ellipsoid_unit) egg = {{2, 1, 1, 1, 1, 1}, NULL, 6};
    const Q(qdist_cross_unit) cross = {{1, 1, 1, 1, 1, 1}, 6};
    const Q(qdist_box_unit) cube = {{1, 1, 1, 1, 1, 1}, 6};
    const Q(qdist_segment_unit) ray = {{1, 0, 0, 0, 0, 0}, 6};
    const Q(qdist_contact) contacts[2] = {Q(fingertip)(-0.75, 0.2, 0.2), Q(fingertip)(1.3, 0.2, 0.2)};
    Q(qdist_primitive) passive[2], active[2];
    const Q(qdist_wrenches) w = {passive, 2, QDIST_LINF}, wa = {active, 2, QDIST_LINF};
    Q(qdist_options) options;
    Q(qdist_unit) q[5];
    Q(qdist_set) sets[2];
    Q(qdist_result) result;
    Q(qdist_active) fingers;
    uint32_t dimension, which = 7;
    REAL basis[36];
    int i, set;
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, passive, &which) == QDIST_OK && which == 7);
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 1, 0, active, NULL) == QDIST_OK);
    CHECK(Q(qdist_active_forces)(&contacts[0], &Q(frame), 0, &fingers) == QDIST_OK);
    CHECK(fingers.rank == 2 && fingers.can_press == 1 && fingers.dimension == 1 && fabs(fingers.delta - 1) < 1e-6);
    CHECK(Q(qdist_wrench_subspace)(passive, 2, 0, &dimension, basis) == QDIST_OK && dimension == 6);
    CHECK(Q(qdist_wrench_subspace)(active, 2, 0, &dimension, basis) == QDIST_OK && dimension == 3);
    CHECK(basis[0] == 1 && basis[7] == 1 && basis[17] == 1 && basis[18] == 0);
    CHECK(Q(qdist_set_wrenches)(&sets[0], &w) == QDIST_OK && Q(qdist_set_wrenches)(&sets[1], &wa) == QDIST_OK);
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.relative = (REAL)WIDTH;
    CHECK(Q(qdist_unit_ball)(&q[0], 1) == QDIST_OK && Q(qdist_unit_ellipsoid)(&q[1], &egg) == QDIST_OK);
    CHECK(Q(qdist_unit_cross)(&q[2], &cross) == QDIST_OK && Q(qdist_unit_box)(&q[3], &cube) == QDIST_OK);
    CHECK(Q(qdist_unit_segment)(&q[4], &ray) == QDIST_OK);
    for (i = 0; i < 5; ++i) {
        for (set = 0; set < 2; ++set) {
            const double d = expected[i][set];
            result.struct_size = sizeof result;
            CHECK(Q(qdist_solve_in_span)(solver, &sets[set], &q[i], &options, &result) == QDIST_OK);
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
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives[0], NULL) == QDIST_OK);
    contacts[0].friction = contacts[1].friction = QDIST_HARD;
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives[1], NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&sets[0], &w) == QDIST_OK && Q(qdist_set_wrenches)(&sets[1], &pivot) == QDIST_OK);
    CHECK(Q(qdist_force_closure)(solver, &sets[0], NULL, &closure) == QDIST_ERROR_STRUCT_SIZE);
    closure.struct_size = sizeof closure;
    CHECK(Q(qdist_force_closure)(solver, &sets[0], NULL, &closure) == QDIST_OK);
    CHECK(closure.verdict == QDIST_CLOSURE_CLOSED && closure.radius > 0);
    CHECK(Q(qdist_force_closure)(solver, &sets[1], NULL, &closure) == QDIST_OK);
    CHECK(closure.verdict == QDIST_CLOSURE_OPEN && fabs(closure.direction[3]) > 0.9999); /* it spins about the x axis */

    /* Three fingertips with little friction and a small torque scale, which is none of closure's business; undecided after one point. */
    {
        const Q(qdist_wrench_frame) tight = {{0, 0, 0}, (REAL)1e-3};
        Q(qdist_contact) ring[3];
        Q(qdist_primitive) few[3];
        const Q(qdist_wrenches) three = {few, 3, QDIST_L1};
        Q(qdist_options) options;
        Q(qdist_set) set;
        int i;
        for (i = 0; i < 3; ++i) {
            const double x = i == 0 ? 1 : -0.5, y = i == 0 ? 0 : i == 1 ? 0.86602540378443865 : -0.86602540378443865;
            ring[i] = Q(fingertip)(1, 0.01, 0);
            ring[i].friction = QDIST_HARD;
            ring[i].position[0] = (REAL)x;
            ring[i].position[1] = (REAL)y;
            ring[i].position[2] = 0;
            ring[i].normal[0] = (REAL)-x;
            ring[i].normal[1] = (REAL)-y;
            ring[i].normal[2] = 0;
            memset(ring[i].tangents, 0, sizeof ring[i].tangents);
        }
        CHECK(Q(qdist_primitives)(ring, 3, &tight, 0, 0, few, NULL) == QDIST_OK);
        CHECK(Q(qdist_set_wrenches)(&set, &three) == QDIST_OK && Q(qdist_options_default)(&options) == QDIST_OK);
        CHECK(Q(qdist_force_closure)(solver, &set, NULL, &closure) == QDIST_OK);
        CHECK(closure.verdict == QDIST_CLOSURE_CLOSED && closure.radius > 0);
        options.max_iterations = 1;
        CHECK(Q(qdist_force_closure)(solver, &set, &options, &closure) == QDIST_OK);
        CHECK(closure.verdict == QDIST_CLOSURE_UNDECIDED && closure.radius == 0);
    }

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
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
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
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
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
    CHECK(Q(qdist_primitives)(contacts, 3, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
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
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
    CHECK(Q(qdist_solve6)(solver, &set, NULL, &options, &result) == QDIST_OK);
    CHECK(Q(qdist_grasp_gradients)(&w, contacts, 2, &Q(frame), 0, 0, NULL, &result, &refined, gradients, NULL) == QDIST_OK);
    CHECK(refined.kink != QDIST_KINK_NONE && gradients[0].known == 0);
}

/* A link of one joint at the origin about z, that touches at x and presses along y. */
static Q(qdist_contact) Q(on_link)(double x) {
    Q(qdist_contact) c;
    memset(&c, 0, sizeof c);
    c.position[0] = (REAL)x;
    c.normal[1] = 1;
    c.friction = QDIST_FRICTIONLESS;
    c.force_cap = 50;
    c.actuated = 1, c.joints = 1;
    c.jacobian[0] = (REAL)x;
    return c;
}

/* d of a set for the unit ball. */
static Q(qdist_result) Q(depth)(qdist_solver *solver, const Q(qdist_set) *set) {
    Q(qdist_options) options;
    Q(qdist_result) result;
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.relative = (REAL)(10 * WIDTH);
    CHECK(Q(qdist_solve6)(solver, set, NULL, &options, &result) == QDIST_OK && result.lower <= result.upper);
    return result;
}

/* Without limits a finger is its contacts' primitives; limits tighten; a load is held within them. */
static void Q(fingers)(qdist_solver *solver) {
    const Q(qdist_contact) contacts[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    const Q(qdist_contact) link[2] = {Q(on_link)(1), Q(on_link)(2)};
    const REAL limits[4] = {10, 3, 1, (REAL)0.25};
    const REAL torque[1] = {1}, up[6] = {0, 1, 0, 0, 0, 0}, load[6] = {0, (REAL)-0.5, 0, 0, 0, (REAL)-0.75};
    const Q(qdist_wrench_frame) scaled = {{0, 0, 0}, 2};
    Q(qdist_primitive) primitives[2];
    Q(qdist_finger) fingers[2], copy[2];
    const Q(qdist_wrenches) w = {primitives, 2, QDIST_LINF};
    Q(qdist_finger_wrenches) f = {fingers, 2, QDIST_LINF};
    Q(qdist_force_memory) memory;
    Q(qdist_force_options) options;
    Q(qdist_set) set;
    Q(qdist_result) exact, before, now;
    Q(qdist_forces) result;
    uint32_t i, k, step, which = 9;
    REAL forces[32], shares[12];
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
    exact = Q(depth)(solver, &set);
    for (i = 0; i < 2; ++i)
        CHECK(Q(qdist_finger_init)(&fingers[i], &contacts[i], 1, &Q(frame), NULL, QDIST_FORCE_MODEL_PASSIVE, 0, &which)
                  == QDIST_OK
              && which == 9 && fingers[i].contacts == 1);
    CHECK(Q(qdist_set_finger_wrenches)(&set, &f) == QDIST_OK);
    before = Q(depth)(solver, &set);
    CHECK(exact.lower > 0 && before.lower <= exact.upper && exact.lower <= before.upper);
    memcpy(copy, fingers, sizeof copy); /* plain bytes */
    f.fingers = copy;
    CHECK(Q(qdist_set_finger_wrenches)(&set, &f) == QDIST_OK);
    now = Q(depth)(solver, &set);
    CHECK(now.lower == before.lower && now.upper == before.upper);
    f.fingers = fingers;
    for (step = 0; step < 4; ++step) {
        const REAL both[2] = {limits[step], (REAL)INFINITY};
        for (i = 0; i < 2; ++i)
            CHECK(Q(qdist_finger_init)(&fingers[i], &contacts[i], 1, &Q(frame), both, QDIST_FORCE_MODEL_PASSIVE, 0, NULL)
                  == QDIST_OK);
        CHECK(Q(qdist_set_finger_wrenches)(&set, &f) == QDIST_OK);
        now = Q(depth)(solver, &set);
        CHECK(now.lower > 0 && now.lower <= before.upper);
        /* 10 is more than the joint sees, 0.25 is not. */
        CHECK(step != 0 || exact.lower <= now.upper);
        CHECK(step != 3 || now.upper < exact.lower);
        before = now;
    }

    /* 1 N m makes 1 N at the arm 1, or 0.5 N at the arm 2; the joint alone moves both. */
    CHECK(Q(qdist_finger_init)(&fingers[0], link, 2, &scaled, torque, QDIST_FORCE_MODEL_PASSIVE, 0, NULL) == QDIST_OK);
    CHECK(Q(qdist_finger_forces)(&fingers[0], up, forces) == QDIST_OK);
    CHECK(fabs(forces[0] - 1) < WIDTH && fabs(forces[4]) < WIDTH && forces[1] == 0 && forces[7] == 0);
    CHECK(Q(qdist_finger_init)(&fingers[1], link, 2, &scaled, torque, QDIST_FORCE_MODEL_ACTIVE, 0, NULL) == QDIST_OK);
    CHECK(Q(qdist_finger_forces)(&fingers[1], up, forces) == QDIST_OK && fingers[1].contacts == 2);
    CHECK(fabs(forces[0] - 0.2) < WIDTH && fabs(forces[4] - 0.4) < WIDTH);

    /* The load asks for 0.5 N along y and a moment of 2 * 0.75 N m about z, which is more torque than the joint has: a + b = 0.5 and
     * a + 2 b = 1.5 have no a >= 0. Half of the moment: a = 0.25, b = 0.25, a torque of 0.75. */
    memset(&memory, 0, sizeof memory);
    result.struct_size = sizeof result;
    f.count = 1;
    CHECK(Q(qdist_finger_contact_forces)(&f, &memory, load, NULL, shares, forces, &result) == QDIST_OK);
    /* In float the error bound of fingers leaves it at a lower bound that is absurd. */
    CHECK(result.outcome == (sizeof(REAL) == 8 ? QDIST_FORCES_NOT_RESISTIBLE : QDIST_FORCES_PRECISION));
    CHECK(result.lower > 50 && result.upper > 1e38 && forces[0] == 0 && shares[1] == 0);
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.relative = (REAL)(sizeof(REAL) == 8 ? 0 : 1e-2);
    for (k = 0; k < 2; ++k) {
        const REAL half[6] = {0, (REAL)-0.5, 0, 0, 0, (REAL)-0.375};
        CHECK(Q(qdist_finger_contact_forces)(&f, k ? &memory : NULL, half, &options, shares, forces, &result) == QDIST_OK);
        CHECK(result.outcome == QDIST_FORCES_CONVERGED);
        CHECK(result.lower <= 0.75 * (1 + 1e-6) && 0.75 * (1 - 1e-6) <= result.upper);
        CHECK(fabs(forces[0] - 0.25) < 5 * WIDTH && fabs(forces[4] - 0.25) < 5 * WIDTH && forces[8] == 0 && forces[12] == 0);
        CHECK(fabs(shares[1] - 0.5) < 5 * WIDTH && fabs(shares[5] - 0.375) < 5 * WIDTH);
        CHECK(forces[0] + 2 * forces[4] <= result.upper * (1 + WIDTH)); /* the torque limit of 1 */
    }
    CHECK(Q(qdist_finger_contact_forces)(&f, NULL, load, NULL, shares, NULL, &result) == QDIST_OK);

    /* The spin moment is in units of force times position, whatever the torque scale. */
    for (k = 0; k < 2; ++k) {
        const REAL spin[6] = {0, 0, 0, 1, 0, 0};
        CHECK(Q(qdist_finger_init)(&fingers[0], &contacts[0], 1, k ? &scaled : &Q(frame), NULL, QDIST_FORCE_MODEL_PASSIVE, 0, NULL)
              == QDIST_OK);
        CHECK(Q(qdist_finger_forces)(&fingers[0], spin, forces) == QDIST_OK && fabs(forces[3] - 0.1) < 1e-6);
    }
}

static void Q(finger_errors)(void) {
    const Q(qdist_contact) good[2] = {Q(on_link)(1), Q(on_link)(2)};
    const REAL one[1] = {1}, negative[1] = {-1}, none[1] = {(REAL)NAN};
    const REAL up[6] = {0, 1, 0, 0, 0, 0}, bad_direction[6] = {0, (REAL)NAN, 0, 0, 0, 0};
    REAL forces[16], shares[6];
    Q(qdist_contact) bad[5];
    Q(qdist_finger) finger, before;
    Q(qdist_finger_wrenches) w = {&finger, 1, QDIST_LINF};
    Q(qdist_wrench_frame) frame = Q(frame);
    Q(qdist_forces) result;
    Q(qdist_set) set, untouched;
    uint32_t which, k;
    memset(&finger, 0, sizeof finger);
    memset(&set, 0, sizeof set);
    memcpy(&before, &finger, sizeof before);
    memcpy(&untouched, &set, sizeof set);
#define INIT(count, limits, model, tolerance)                                                                             \
    (which = 9, Q(qdist_finger_init)(&finger, bad, count, &frame, limits, model, tolerance, &which))
#define REFUSED(change, call, code, index)                                                                               \
    for (k = 0; k < 5; ++k) bad[k] = good[k % 2];                                                                       \
    change;                                                                                                             \
    CHECK(call == code && which == index && memcmp(&finger, &before, sizeof finger) == 0)
    REFUSED((void)0, INIT(2, negative, 0, 0), QDIST_ERROR_TORQUE_LIMIT, 0);
    REFUSED((void)0, INIT(2, none, 0, 0), QDIST_ERROR_TORQUE_LIMIT, 0);
    REFUSED((void)0, INIT(5, one, 0, 0), QDIST_ERROR_CAPACITY, 4);
    REFUSED((void)0, INIT(0, one, 0, 0), QDIST_ERROR_ARGUMENT, 9);
    REFUSED((void)0, INIT(2, one, 2, 0), QDIST_ERROR_ARGUMENT, 9);
    REFUSED((void)0, INIT(2, one, 1, (REAL)0.6), QDIST_ERROR_TOLERANCE, 0);
    REFUSED(bad[1].joints = 2, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_JACOBIAN, 1);
    REFUSED(bad[1].actuated = 0, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_JACOBIAN, 1);
    REFUSED(bad[1].jacobian[0] = (REAL)NAN, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_JACOBIAN, 1);
    REFUSED(bad[1].position[0] = (REAL)NAN, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_POSITION, 1);
    REFUSED(bad[1].normal[0] = 1, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_NORMAL, 1);
    REFUSED(bad[0].force_cap = -1, INIT(2, one, 0, 0), QDIST_ERROR_CONTACT_CAP, 0);
    REFUSED(frame.torque_scale = 0, INIT(2, one, 0, 0), QDIST_ERROR_FRAME, 9);
    frame.torque_scale = 1;
    {
        /* The second joint's limit is the one that is wrong. */
        const REAL second[2] = {1, -2};
        REFUSED((bad[0].joints = 2), INIT(1, second, 0, 0), QDIST_ERROR_TORQUE_LIMIT, 1);
    }
#undef REFUSED
#undef INIT
    CHECK(Q(qdist_finger_init)(NULL, good, 2, &frame, one, 0, 0, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_finger_init)(&finger, NULL, 2, &frame, one, 0, 0, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_finger_init)(&finger, good, 2, NULL, one, 0, 0, NULL) == QDIST_ERROR_NULL);
    /* What is no finger is refused everywhere. */
    result.struct_size = sizeof result;
    forces[0] = 7;
    CHECK(Q(qdist_set_finger_wrenches)(&set, &w) == QDIST_ERROR_FINGER && memcmp(&set, &untouched, sizeof set) == 0);
    CHECK(Q(qdist_finger_forces)(&finger, up, forces) == QDIST_ERROR_FINGER);
    CHECK(Q(qdist_finger_contact_forces)(&w, NULL, up, NULL, shares, forces, &result) == QDIST_ERROR_FINGER);
    CHECK(forces[0] == 7 && strcmp(qdist_status_string(QDIST_ERROR_FINGER), "not a finger") == 0);
    /* The palm needs no limits; NULL is no limit. */
    bad[0] = good[0], bad[0].actuated = 0;
    CHECK(Q(qdist_finger_init)(&finger, bad, 1, &frame, negative, QDIST_FORCE_MODEL_ACTIVE, 0, NULL) == QDIST_OK);
    CHECK(Q(qdist_finger_forces)(&finger, up, forces) == QDIST_OK && fabs(forces[0] - 50) < 1e-4);
    forces[0] = 7;
    CHECK(Q(qdist_finger_forces)(&finger, bad_direction, forces) == QDIST_ERROR_NONFINITE);
    CHECK(Q(qdist_finger_forces)(&finger, NULL, forces) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_finger_forces)(&finger, up, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_finger_forces)(NULL, up, forces) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_finger_contact_forces)(&w, NULL, bad_direction, NULL, shares, forces, &result) == QDIST_ERROR_NONFINITE);
    CHECK(Q(qdist_finger_contact_forces)(&w, NULL, up, NULL, NULL, forces, &result) == QDIST_ERROR_NULL);
    CHECK(forces[0] == 7);
    w.norm = 2;
    CHECK(Q(qdist_set_finger_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    w.norm = QDIST_L1, w.count = 0;
    CHECK(Q(qdist_set_finger_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    w.count = 1, w.fingers = NULL;
    CHECK(Q(qdist_set_finger_wrenches)(&set, &w) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_set_finger_wrenches)(&set, NULL) == QDIST_ERROR_NULL);
}

/* A grasp that is open contains the origin on its boundary, by definition: so d is 0 and `lower` too, whatever made the set of it; and a segment
 * into the set is as long as contact forces say. */
static void Q(open_grasp)(qdist_solver *solver) {
    static REAL edges[6 * 40];
    const REAL identity[36] = {1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
    const Q(qdist_layout) layout = {QDIST_LAYOUT_INSCRIBED, 8, 0};
    const Q(qdist_segment_unit) ray = {{3, 0, 0, 0, 1, 0}, 6};
    const REAL external[6] = {-3, 0, 0, 0, -1, 0};
    Q(qdist_contact) contacts[3] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(-1, 0.5, 0.1)};
    Q(qdist_primitive) primitives[3];
    Q(qdist_pyramid) pyramids[3];
    Q(qdist_finger) finger;
    uint32_t norm, k;
    contacts[0].position[1] = 1, contacts[1].position[1] = -1, contacts[2].position[2] = 1;
    CHECK(Q(qdist_primitives)(contacts, 3, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_pyramids)(contacts, 3, &Q(frame), &layout, edges, 40, pyramids, NULL) == QDIST_OK);
    CHECK(Q(qdist_finger_init)(&finger, contacts, 3, &Q(frame), NULL, QDIST_FORCE_MODEL_PASSIVE, 0, NULL) == QDIST_OK);
    for (norm = QDIST_L1; norm <= QDIST_LINF; ++norm) {
        const Q(qdist_wrenches) w = {primitives, 3, norm};
        const Q(qdist_pyramid_wrenches) p = {pyramids, 3, norm};
        const Q(qdist_finger_wrenches) f = {&finger, 1, norm};
        Q(qdist_set) sets[6];
        const Q(qdist_pair) twice = {&sets[0], &sets[1], 6};
        const Q(qdist_linear) stays = {&sets[0], identity, {0, 0, 0, 0, 0, 0}, 6, 6}, goes = {&sets[0], identity, {1, 0, 0, 0, 0, 0}, 6, 6};
        Q(qdist_force_options) gap;
        Q(qdist_forces) forces;
        Q(qdist_result) result;
        Q(qdist_set) apart;
        Q(qdist_unit) q;
        REAL shares[18];

        CHECK(Q(qdist_set_wrenches)(&sets[0], &w) == QDIST_OK && Q(qdist_set_pyramid_wrenches)(&sets[1], &p) == QDIST_OK);
        CHECK(Q(qdist_set_finger_wrenches)(&sets[2], &f) == QDIST_OK && Q(qdist_set_sum)(&sets[3], &twice) == QDIST_OK);
        CHECK(Q(qdist_set_join)(&sets[4], &twice) == QDIST_OK && Q(qdist_set_linear)(&sets[5], &stays) == QDIST_OK);
        for (k = 0; k < 6; ++k) {
            CHECK(sets[k].contains_origin == 1);
            result = Q(depth)(solver, &sets[k]);
            CHECK(result.lower == 0 && result.upper >= 0 && result.upper < 20 * WIDTH);
        }
        /* What is not known is not said: of a difference of unlike sets, of a set that has moved; of a join with one, it is. */
        CHECK(Q(qdist_set_linear)(&apart, &goes) == QDIST_OK && apart.contains_origin == 0);
        sets[1] = apart;
        CHECK(Q(qdist_set_sum)(&sets[3], &twice) == QDIST_OK && sets[3].contains_origin == 0);
        CHECK(Q(qdist_set_join)(&sets[4], &twice) == QDIST_OK && sets[4].contains_origin == 1);
        /* Without, the margin of rounding shows. */
        apart = sets[0], apart.contains_origin = 0;
        result = Q(depth)(solver, &apart);
        CHECK(result.lower < 0 && result.upper >= 0);

        /* A segment into the set: the inverse of the size of the forces. */
        memset(&gap, 0, sizeof gap), memset(&forces, 0, sizeof forces), memset(&result, 0, sizeof result);
        gap.struct_size = sizeof gap, gap.relative = (REAL)WIDTH, forces.struct_size = sizeof forces, result.struct_size = sizeof result;
        CHECK(Q(qdist_unit_segment)(&q, &ray) == QDIST_OK);
        CHECK(Q(qdist_contact_forces)(&w, NULL, external, &gap, shares, &forces) == QDIST_OK);
        CHECK(Q(qdist_solve6)(solver, &sets[0], &q, NULL, &result) == QDIST_OK);
        CHECK(result.lower <= 1 / (double)forces.lower && 1 / (double)forces.upper <= result.upper && result.iterations < 1000);
        /* (In float the margin of rounding may be as large as what there is on the way.) */
        CHECK(sizeof(REAL) == sizeof(float) || (result.lower > 0 && result.upper - result.lower <= WIDTH * result.upper));
        sets[0].contains_origin = 2;
        CHECK(Q(qdist_solve6)(solver, &sets[0], &q, NULL, &result) == QDIST_ERROR_ARGUMENT);
        CHECK(Q(qdist_set_sum)(&sets[3], &twice) == QDIST_ERROR_ARGUMENT);
    }
}

/* A contact at p with the normal n. */
static Q(qdist_contact) Q(touch)(const double *p, const double *n, qdist_friction friction, double mu, double mus) {
    Q(qdist_contact) c;
    double length = 0;
    memset(&c, 0, sizeof c);
    for (int i = 0; i < 3; ++i) length += n[i] * n[i];
    for (int i = 0; i < 3; ++i) c.position[i] = (REAL)p[i], c.normal[i] = (REAL)(n[i] / sqrt(length));
    c.friction = friction, c.mu = (REAL)mu, c.mus = (REAL)mus, c.force_cap = 1;
    return c;
}

/* Fingers that all press to one side: d is 0, known in no more than its proof costs, whatever Q is; and a wrench that the grasp resists is known as well as
 * by the least forces that do. */
static void Q(open_grasps)(qdist_solver *solver) {
    const Q(qdist_ellipsoid_unit) egg = {{1, 2, 0.5, 1, 1, 3}, NULL, 6};
    const Q(qdist_cross_unit) cross = {{1, 2, 0.5, 1, 1, 3}, 6};
    const Q(qdist_box_unit) cube = {{1, 2, 0.5, 1, 1, 3}, 6};
    int narrow = 0, met = 0;
    for (int k = 0; k < 60; ++k) {
        const uint32_t count = 2 + below(5);
        Q(qdist_contact) contacts[6];
        Q(qdist_primitive) primitives[6];
        const Q(qdist_wrenches) w = {primitives, count, k % 2 ? QDIST_L1 : QDIST_LINF};
        Q(qdist_segment_unit) ray = {{0}, 6};
        Q(qdist_unit) units[4];
        Q(qdist_result) result;
        Q(qdist_set) set;
        Q(qdist_forces) forces;
        Q(qdist_options) options;
        REAL external[6], shares[36];
        for (uint32_t i = 0; i < count; ++i) {
            const double n[3] = {1, 0.3 * dice(), 0.3 * dice()}, p[3] = {dice(), dice(), dice()};
            contacts[i] = Q(touch)(p, n, below(2) ? QDIST_SOFT : QDIST_HARD, between(0.1, 1), 0);
            if (contacts[i].friction == QDIST_SOFT) contacts[i].mus = (REAL)between(0.01, 0.2);
        }
        CHECK(Q(qdist_primitives)(contacts, count, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
        CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK && Q(qdist_unit_ball)(&units[0], 1) == QDIST_OK);
        CHECK(Q(qdist_unit_ellipsoid)(&units[1], &egg) == QDIST_OK && Q(qdist_unit_cross)(&units[2], &cross) == QDIST_OK);
        CHECK(Q(qdist_unit_box)(&units[3], &cube) == QDIST_OK);
        memset(&result, 0, sizeof result);
        result.struct_size = sizeof result;
        for (int q = 0; q < 4; ++q) {
            CHECK(Q(qdist_solve6)(solver, &set, &units[q], NULL, &result) == QDIST_OK);
            CHECK(result.lower == 0 && result.upper >= 0 && result.upper < 20 * WIDTH && result.support_calls <= 100);
            CHECK(result.outcome == QDIST_TOUCHING || result.outcome == QDIST_DEGENERATE);
        }
        /* Half the sum of some farthest points is in the set; the way to it, a segment. */
        for (int j = 0; j < 6; ++j) {
            double u[6];
            REAL direction[6], point[6];
            random_direction(u, 6);
            for (int i = 0; i < 6; ++i) direction[i] = (REAL)u[i];
            CHECK(set.support(set.user, direction, point) == 0);
            for (int i = 0; i < 6; ++i) ray.end[i] += point[i] / 12;
        }
        for (int i = 0; i < 6; ++i) external[i] = -ray.end[i];
        memset(&forces, 0, sizeof forces);
        forces.struct_size = sizeof forces;
        CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, shares, &forces) == QDIST_OK);
        if (Q(qdist_unit_segment)(&units[0], &ray) != QDIST_OK || forces.outcome != QDIST_FORCES_CONVERGED) continue;
        CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
        options.max_iterations = sizeof(REAL) == 8 ? 5000 : 300;
        CHECK(Q(qdist_solve6)(solver, &set, &units[0], &options, &result) == QDIST_OK);
        /* (Forces may be off by their residual.) */
        const double slack = 1 + (sizeof(REAL) == 8 ? 1e-6 : 2e-2);
        CHECK(result.lower <= slack / (double)forces.lower && 1 / (double)forces.upper <= slack * result.upper);
        CHECK(sizeof(REAL) == 4 || result.outcome != QDIST_ITERATIONS);
        ++met, narrow += result.upper - result.lower <= WIDTH * result.upper;
    }
    CHECK(met >= 40 && (sizeof(REAL) == 4 || narrow >= met * 9 / 10));
}

/* Hard fingertips on a ring are closed by any friction, and open without; so are two soft ones by their torsion. At any torque scale. */
static void Q(rings)(qdist_solver *solver) {
    int undecided = 0;
    for (int k = 0; k < 120; ++k) {
        const int pinch = k % 3 == 2, closes = below(2) != 0;
        const uint32_t count = pinch ? 2 : 3 + below(4);
        const double mu = closes ? k < 4 ? 0.01 : decade(-3, 0) : 0;
        const Q(qdist_wrench_frame) tight = {{0, 0, 0}, (REAL)(k < 4 ? 1e-3 : pinch ? 1 : decade(-6, 6))};
        Q(qdist_contact) contacts[6];
        Q(qdist_primitive) primitives[6];
        const Q(qdist_wrenches) w = {primitives, count, k % 2 ? QDIST_LINF : QDIST_L1};
        Q(qdist_closure) closure;
        Q(qdist_set) set;
        for (uint32_t i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count, p[3] = {cos(angle), pinch ? 0 : sin(angle), 0};
            const double n[3] = {pinch ? i ? 1 : -1 : -p[0], -p[1], 0};
            contacts[i] = pinch ? Q(touch)(p, n, QDIST_SOFT, 0.5, mu) : Q(touch)(p, n, QDIST_HARD, mu, 0);
        }
        memset(&closure, 0, sizeof closure);
        closure.struct_size = sizeof closure;
        CHECK(Q(qdist_primitives)(contacts, count, &tight, 0, 0, primitives, NULL) == QDIST_OK && Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
        CHECK(Q(qdist_force_closure)(solver, &set, NULL, &closure) == QDIST_OK);
        CHECK(closure.verdict != (closes ? QDIST_CLOSURE_OPEN : QDIST_CLOSURE_CLOSED));
        CHECK((closure.radius > 0) == (closure.verdict == QDIST_CLOSURE_CLOSED));
        undecided += closure.verdict == QDIST_CLOSURE_UNDECIDED;
        CHECK(k >= 4 || closure.verdict != QDIST_CLOSURE_UNDECIDED);
    }
    CHECK(undecided <= (sizeof(REAL) == 8 ? 0 : 12));
}

static int Q(quality)(const Q(qdist_forces) *forces, double largest) {
    return forces->outcome == QDIST_FORCES_CONVERGED ? 2 : forces->outcome == QDIST_FORCES_NOT_RESISTIBLE ? 1 : forces->upper < largest;
}

/* Soft fingers on a ring hold a wrench that drifts: memory never costs an answer. */
static void Q(drifting_wrenches)(void) {
    const double largest = sizeof(REAL) == 8 ? DBL_MAX : (double)FLT_MAX;
    uint32_t warm_steps = 0, cold_steps = 0;
    for (int k = 0; k < 15; ++k) {
        const uint32_t count = 2 + below(4);
        const Q(qdist_wrench_frame) tight = {{0, 0, 0}, (REAL)(0.05 * decade(-1, 1.5))};
        const double spin = below(2) ? 0 : 0.2 * 0.05 / tight.torque_scale, rate = decade(-5, 0);
        Q(qdist_contact) contacts[6];
        Q(qdist_primitive) primitives[6];
        const Q(qdist_wrenches) w = {primitives, count, k % 2 ? QDIST_LINF : QDIST_L1};
        Q(qdist_force_memory) memory;
        double start[6], turn[6];
        for (uint32_t i = 0; i < count; ++i) {
            const double angle = 6.283185307179586 * i / count + (k % 3 ? 0.3 * dice() : 0);
            const double n[3] = {-cos(angle), -sin(angle), 0}, p[3] = {-0.05 * n[0], -0.05 * n[1], k % 3 == 2 ? 0.02 * dice() : 0};
            contacts[i] = Q(touch)(p, n, QDIST_SOFT, between(0.2, 1), 0.005);
            contacts[i].force_cap = 10;
        }
        CHECK(Q(qdist_primitives)(contacts, count, &tight, 0, 0, primitives, NULL) == QDIST_OK);
        random_direction(start, 6), random_direction(turn, 6);
        memset(&memory, 0, sizeof memory);
        for (int tick = 0; tick < 40; ++tick) {
            REAL external[6], shares[36];
            Q(qdist_forces) warm, cold;
            for (int i = 0; i < 6; ++i) external[i] = (REAL)((start[i] + turn[i] * rate * tick) * (i < 3 ? 1 : spin));
            memset(&warm, 0, sizeof warm), memset(&cold, 0, sizeof cold);
            warm.struct_size = cold.struct_size = sizeof warm;
            CHECK(Q(qdist_contact_forces)(&w, &memory, external, NULL, shares, &warm) == QDIST_OK);
            CHECK(Q(qdist_contact_forces)(&w, NULL, external, NULL, shares, &cold) == QDIST_OK);
            CHECK(Q(quality)(&warm, largest) >= Q(quality)(&cold, largest));
            CHECK(warm.upper >= (REAL)largest || cold.upper >= (REAL)largest || (warm.lower <= cold.upper * (REAL)1.02 && cold.lower <= warm.upper * (REAL)1.02));
            warm_steps += warm.iterations, cold_steps += cold.iterations;
        }
    }
    CHECK(warm_steps < cold_steps);
}

/* t such that t * end is on the boundary of the pyramids' set. */
static Q(qdist_result) Q(shoot)(qdist_solver *solver, const Q(qdist_set) *set, double y, double z) {
    Q(qdist_segment_unit) segment = {{0, (REAL)y, (REAL)z, 0, 0, 0}, 6};
    Q(qdist_unit) q;
    Q(qdist_result) result;
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_unit_segment)(&q, &segment) == QDIST_OK);
    CHECK(Q(qdist_solve6)(solver, set, &q, NULL, &result) == QDIST_OK);
    return result;
}

#define NEAR(result, x) ((result).lower <= (x) * (1 + 1e-5) && (x) * (1 - 1e-5) <= (result).upper)
#define NARROW(result, x) (NEAR(result, x) && (result).upper - (result).lower < 2e-2 * (x))

static void Q(linearised)(qdist_solver *solver) {
    static REAL edges[6 * 40];
    const double diagonal = 0.7071067811865476;
    const REAL origin[3] = {0, 0, 0};
    Q(qdist_contact) contacts[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    Q(qdist_primitive) primitives[2];
    Q(qdist_pyramid) pyramids[2];
    const Q(qdist_wrenches) w = {primitives, 2, QDIST_L1};
    Q(qdist_pyramid_wrenches) p = {pyramids, 2, QDIST_LINF};
    Q(qdist_layout) layout = {QDIST_LAYOUT_INSCRIBED, 4, 0};
    Q(qdist_segment_unit) mean;
    Q(qdist_preset) preset;
    Q(qdist_result) exact, inside, outside;
    Q(qdist_unit) q;
    Q(qdist_set) set;
    uint32_t count, which = 9, i;

    /* How many edges. */
    CHECK(Q(qdist_pyramid_edges)(&layout, QDIST_HARD, &count) == QDIST_OK && count == 4);
    CHECK(Q(qdist_pyramid_edges)(&layout, QDIST_SOFT, &count) == QDIST_OK && count == 6);
    layout.kind = QDIST_LAYOUT_GRASPIT, layout.length = 1;
    CHECK(Q(qdist_pyramid_edges)(&layout, QDIST_FRICTIONLESS, &count) == QDIST_OK && count == 8);
    CHECK(Q(qdist_pyramid_edges)(&layout, QDIST_SOFT, &count) == QDIST_OK && count == 20);
    layout.kind = QDIST_LAYOUT_DEX_NET;
    CHECK(Q(qdist_pyramid_edges)(&layout, QDIST_SOFT, &count) == QDIST_OK && count == 6);

    /* Two soft contacts: the exact d is between those of the pyramids in the cones and around them. */
    CHECK(Q(qdist_primitives)(contacts, 2, &Q(frame), 0, 0, primitives, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_wrenches)(&set, &w) == QDIST_OK);
    exact = Q(depth)(solver, &set);
    p.norm = QDIST_L1;
    layout.kind = QDIST_LAYOUT_INSCRIBED, layout.sides = 8;
    CHECK(Q(qdist_pyramids)(contacts, 2, &Q(frame), &layout, edges, 20, pyramids, &which) == QDIST_OK && which == 9);
    CHECK(pyramids[0].count == 10 && pyramids[0].edges == edges && pyramids[1].edges == edges + 60);
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &p) == QDIST_OK);
    inside = Q(depth)(solver, &set);
    layout.kind = QDIST_LAYOUT_CIRCUMSCRIBED;
    CHECK(Q(qdist_pyramids)(contacts, 2, &Q(frame), &layout, edges, 40, pyramids, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &p) == QDIST_OK);
    outside = Q(depth)(solver, &set);
    CHECK(inside.lower > 0 && inside.lower <= exact.upper && exact.lower <= outside.upper);
    CHECK(inside.upper < outside.lower);

    /* Four sides with the first edge along y: without spin, a square of friction in the circle, and one around it, which a double pyramid
     * around the sphere has sqrt(3) times as large. */
    p.norm = QDIST_LINF;
    layout.sides = 4;
    layout.kind = QDIST_LAYOUT_INSCRIBED;
    CHECK(Q(qdist_pyramids)(contacts, 2, &Q(frame), &layout, edges, 12, pyramids, NULL) == QDIST_OK);
    CHECK(edges[0] == 1 && edges[1] == (REAL)0.5 && fabs(edges[2]) < 1e-7); /* normal and o */
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &p) == QDIST_OK);
    inside = Q(shoot)(solver, &set, 1, 0), outside = Q(shoot)(solver, &set, diagonal, diagonal);
    CHECK(NARROW(inside, 1) && NARROW(outside, diagonal));
    layout.kind = QDIST_LAYOUT_CIRCUMSCRIBED;
    CHECK(Q(qdist_pyramids)(contacts, 2, &Q(frame), &layout, edges, 12, pyramids, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &p) == QDIST_OK);
    inside = Q(shoot)(solver, &set, 1, 0), outside = Q(shoot)(solver, &set, diagonal, diagonal);
    CHECK(NARROW(inside, sqrt(3)) && NARROW(outside, sqrt(3) * diagonal));

    /* What the tools do. */
    CHECK(Q(qdist_preset_graspit)(&preset, origin, 2, (REAL)0.001, QDIST_LINF) == QDIST_OK);
    CHECK(preset.frame.torque_scale == 2 && preset.norm == QDIST_LINF && preset.layout.kind == QDIST_LAYOUT_GRASPIT);
    CHECK(Q(qdist_preset_contact)(&preset, &contacts[0]) == QDIST_OK && contacts[0].tangents[1] == -1); /* e_x x e_z */
    CHECK(contacts[0].joints == 2 && contacts[0].mu == (REAL)0.5 && contacts[0].force_cap == 1);
    CHECK(Q(qdist_preset_dex_net)(&preset, origin, 3, 8, (REAL)0.005) == QDIST_OK);
    CHECK(preset.frame.torque_scale == 3 && preset.norm == QDIST_L1 && preset.layout.sides == 8);
    contacts[0].normal[0] = 0, contacts[0].normal[2] = 1;
    CHECK(Q(qdist_preset_contact)(&preset, &contacts[0]) == QDIST_OK);
    CHECK(contacts[0].tangents[0] == 1 && contacts[0].tangents[4] == 1);
    CHECK(Q(qdist_preset_frogger)(&preset, 4, 4) == QDIST_OK);
    CHECK(preset.frame.torque_scale == (REAL)0.5 && preset.norm == QDIST_L1 && preset.layout.kind == QDIST_LAYOUT_INSCRIBED);
    CHECK(Q(qdist_preset_contact)(&preset, &contacts[0]) == QDIST_OK);
    CHECK(fabs(contacts[0].force_cap - 1 / sqrt(1.25)) < 1e-6);
    CHECK(fabs(contacts[0].tangents[1] - 2.3 / sqrt(1.2 * 1.2 + 2.3 * 2.3)) < 1e-6);

    /* FRoGGeR's min-weight of two opposed contacts, one twice as strong: weights of 1/3 and 2/3 in all. */
    contacts[0] = Q(fingertip)(-1, 0.5, 0.1), contacts[1] = Q(fingertip)(1, 0.5, 0.1);
    contacts[0].force_cap = 2;
    CHECK(Q(qdist_pyramids)(contacts, 2, &preset.frame, &preset.layout, edges, 12, pyramids, NULL) == QDIST_OK);
    CHECK(Q(qdist_opposed_mean)(&mean, pyramids, 2) == QDIST_OK && mean.dimension == 6 && fabs(mean.end[0] + 0.5) < 1e-6);
    for (i = 1; i < 6; ++i) mean.end[i] = 0; /* but for rounding they are */
    p.norm = preset.norm;
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &p) == QDIST_OK && Q(qdist_unit_segment)(&q, &mean) == QDIST_OK);
    inside.struct_size = sizeof inside;
    CHECK(Q(qdist_solve6)(solver, &set, &q, NULL, &inside) == QDIST_OK);
    CHECK(NARROW(inside, 2) && fabs(inside.upper / (1 + inside.upper) - 2.0 / 3) < 1e-2);
    edges[0] = edges[1] = edges[2] = edges[3] = edges[4] = edges[5] = 0;
    pyramids[0].count = 1;
    CHECK(Q(qdist_opposed_mean)(&mean, pyramids, 1) == QDIST_ERROR_ARGUMENT);
}

static void Q(linearised_errors)(void) {
    const Q(qdist_contact) good[2] = {Q(fingertip)(-1, 0.5, 0.1), Q(fingertip)(1, 0.5, 0.1)};
    const REAL none = (REAL)NAN, origin[3] = {0, 0, 0}, nowhere[3] = {0, (REAL)NAN, 0};
    REAL edges[6 * 20], point[6], u[6] = {1, 0, 0, 0, 0, 0};
    Q(qdist_contact) bad[2];
    Q(qdist_pyramid) pyramids[2], before[2];
    Q(qdist_pyramid_wrenches) w = {pyramids, 2, QDIST_L1};
    Q(qdist_layout) layout;
    Q(qdist_wrench_frame) frame = Q(frame);
    Q(qdist_preset) preset, kept;
    Q(qdist_segment_unit) mean;
    Q(qdist_set) set;
    uint32_t which, count = 77;
    memset(pyramids, 0, sizeof pyramids);
    memcpy(before, pyramids, sizeof before);
    memset(&preset, 0, sizeof preset);
    memcpy(&kept, &preset, sizeof kept);
    edges[0] = 7;
#define REFUSED(change, capacity, code, index)                                                                          \
    memcpy(bad, good, sizeof bad);                                                                                      \
    layout.kind = QDIST_LAYOUT_INSCRIBED, layout.sides = 8, layout.length = 0;                                          \
    frame.torque_scale = 1;                                                                                             \
    which = 9;                                                                                                          \
    change;                                                                                                             \
    CHECK(Q(qdist_pyramids)(bad, 2, &frame, &layout, edges, capacity, pyramids, &which) == code && which == index);     \
    CHECK(memcmp(pyramids, before, sizeof before) == 0 && edges[0] == 7)
    REFUSED(layout.kind = 4, 20, QDIST_ERROR_ARGUMENT, 9);
    REFUSED(layout.sides = 2, 20, QDIST_ERROR_ARGUMENT, 9);
    REFUSED(layout.kind = QDIST_LAYOUT_GRASPIT, 20, QDIST_ERROR_FRAME, 9);
    REFUSED((layout.kind = QDIST_LAYOUT_DEX_NET, layout.length = -1), 20, QDIST_ERROR_ARGUMENT, 9);
    REFUSED((layout.kind = QDIST_LAYOUT_DEX_NET, layout.length = none), 20, QDIST_ERROR_NONFINITE, 9);
    REFUSED((void)0, 19, QDIST_ERROR_CAPACITY, 1);
    REFUSED((void)0, 0, QDIST_ERROR_CAPACITY, 0);
    REFUSED(layout.sides = UINT32_MAX, 20, QDIST_ERROR_CAPACITY, 0);
    REFUSED(frame.torque_scale = -1, 20, QDIST_ERROR_FRAME, 9);
    REFUSED(bad[1].position[0] = none, 20, QDIST_ERROR_CONTACT_POSITION, 1);
    REFUSED(bad[1].normal[1] = 1, 20, QDIST_ERROR_CONTACT_NORMAL, 1);
    REFUSED(bad[1].tangents[0] = 1, 20, QDIST_ERROR_CONTACT_TANGENTS, 1);
    REFUSED(bad[0].mu = -1, 20, QDIST_ERROR_CONTACT_FRICTION, 0);
    REFUSED(bad[1].force_cap = none, 20, QDIST_ERROR_CONTACT_CAP, 1);
#undef REFUSED
    CHECK(Q(qdist_pyramids)(good, 2, &frame, &layout, NULL, 20, pyramids, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_pyramids)(good, 2, &frame, &layout, edges, 20, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_pyramids)(good, 2, &frame, NULL, edges, 20, pyramids, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_pyramids)(good, 0, &frame, &layout, edges, 20, pyramids, NULL) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_pyramid_edges)(&layout, 3, &count) == QDIST_ERROR_CONTACT_FRICTION && count == 77);
    CHECK(Q(qdist_pyramid_edges)(NULL, 1, &count) == QDIST_ERROR_NULL && Q(qdist_pyramid_edges)(&layout, 1, NULL) == QDIST_ERROR_NULL);

    CHECK(Q(qdist_preset_graspit)(&preset, origin, 0, 1, QDIST_L1) == QDIST_ERROR_FRAME);
    CHECK(Q(qdist_preset_graspit)(&preset, origin, 1, 0, QDIST_L1) == QDIST_ERROR_FRAME);
    CHECK(Q(qdist_preset_graspit)(&preset, nowhere, 1, 1, QDIST_L1) == QDIST_ERROR_FRAME);
    CHECK(Q(qdist_preset_graspit)(&preset, origin, 1, 1, 2) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_preset_graspit)(&preset, NULL, 1, 1, QDIST_L1) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_preset_graspit)(NULL, origin, 1, 1, QDIST_L1) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_preset_dex_net)(&preset, origin, 1, 2, 0) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_preset_dex_net)(&preset, origin, 0, 8, 0) == QDIST_ERROR_FRAME);
    CHECK(Q(qdist_preset_dex_net)(&preset, origin, 1, 8, -1) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_preset_frogger)(&preset, 2, 1) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_preset_frogger)(&preset, 4, 0) == QDIST_ERROR_FRAME);
    CHECK(memcmp(&preset, &kept, sizeof preset) == 0);
    preset.tool = 3;
    memcpy(bad, good, sizeof bad);
    CHECK(Q(qdist_preset_contact)(&preset, &bad[0]) == QDIST_ERROR_ARGUMENT);
    preset.tool = QDIST_TOOL_FROGGER;
    bad[0].mu = -1;
    CHECK(Q(qdist_preset_contact)(&preset, &bad[0]) == QDIST_ERROR_CONTACT_FRICTION && bad[0].force_cap == 0);
    CHECK(Q(qdist_preset_contact)(&preset, NULL) == QDIST_ERROR_NULL && Q(qdist_preset_contact)(NULL, &bad[0]) == QDIST_ERROR_NULL);

    /* Lists that were not made, or were changed. */
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &w) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_pyramids)(good, 2, &frame, &layout, edges, 20, pyramids, NULL) == QDIST_OK);
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &w) == QDIST_OK);
    CHECK(set.support(&w, u, point) == 0 && fabs(point[0] - 1) < 1e-6);
    w.norm = 2;
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    CHECK(set.support(&w, u, point) == QDIST_ERROR_ARGUMENT);
    w.norm = QDIST_L1;
    pyramids[1].error = -1;
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &w) == QDIST_ERROR_ARGUMENT);
    pyramids[1].error = 0;
    edges[100] = none;
    CHECK(Q(qdist_set_pyramid_wrenches)(&set, &w) == QDIST_ERROR_CONTACT_WRENCH);
    CHECK(Q(qdist_opposed_mean)(&mean, pyramids, 2) == QDIST_ERROR_CONTACT_WRENCH);
    CHECK(Q(qdist_opposed_mean)(&mean, NULL, 2) == QDIST_ERROR_NULL && Q(qdist_opposed_mean)(NULL, pyramids, 2) == QDIST_ERROR_NULL);
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
    CHECK(Q(qdist_primitives)(bad, 2, &frame, 1, 0, primitives, &which) == code && which == 1);                     \
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
    CHECK(Q(qdist_primitives)(good, 2, &frame, 1, (REAL)0.6, primitives, &which) == QDIST_ERROR_TOLERANCE && which == 0);
    CHECK(Q(qdist_primitives)(good, 2, &frame, 1, none, primitives, NULL) == QDIST_ERROR_TOLERANCE);
    CHECK(Q(qdist_primitives)(NULL, 2, &frame, 0, 0, primitives, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_primitives)(good, 0, &frame, 0, 0, primitives, NULL) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_primitives)(good, 2, NULL, 0, 0, primitives, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_primitives)(good, 2, &frame, 0, 0, NULL, NULL) == QDIST_ERROR_NULL);
    frame.torque_scale = 0;
    CHECK(Q(qdist_primitives)(good, 2, &frame, 0, 0, primitives, NULL) == QDIST_ERROR_FRAME);
    frame.torque_scale = 1;
    CHECK(Q(qdist_active_forces)(&good[0], &frame, 0, NULL) == QDIST_ERROR_NULL);
    bad[0] = good[0], bad[0].actuated = 0;
    CHECK(Q(qdist_active_forces)(&bad[0], &frame, 0, &active) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_primitives)(good, 2, &frame, 0, 0, primitives, NULL) == QDIST_OK);
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

#undef NEAR
#undef NARROW

static void Q(grasp)(void) {
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 128, 2048)];
    qdist_solver *solver = NULL;
    CHECK(Q(qdist_solver_init)(memory, BYTES(6, 128, 2048), 6, 128, 2048, &solver) == QDIST_OK);
    if (solver == NULL) return;
    Q(table)(solver);
    Q(closures)(solver);
    Q(forces)();
    Q(gradients)(solver);
    Q(fingers)(solver);
    Q(finger_errors)();
    Q(open_grasp)(solver);
    Q(open_grasps)(solver);
    Q(rings)(solver);
    Q(drifting_wrenches)();
    Q(linearised)(solver);
    Q(linearised_errors)();
    Q(errors)();
}

#endif
