/* The times that the headers of the core and of grasps name, in microseconds on this machine: `./x figures`. (Stack: `./x stack`.) */
#define _POSIX_C_SOURCE 199309L
#include "qdist_grasp.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)];
static const qdist_wrench_frame_f64 frame = {{0, 0, 0}, 1};
static int failures;

/* Microseconds of a call: the least of some runs. */
static double least(void (*call)(void), int runs) {
    double best = 1e300;
    for (int i = 0; i < runs; i++) {
        struct timespec from, to;
        clock_gettime(CLOCK_MONOTONIC, &from);
        call();
        clock_gettime(CLOCK_MONOTONIC, &to);
        const double time = (double)(to.tv_sec - from.tv_sec) * 1e6 + (double)(to.tv_nsec - from.tv_nsec) * 1e-3;
        if (time < best) best = time;
    }
    return best;
}

/* An ellipsoid in six dimensions, and a tolerance that it cannot meet in 50,000 steps. */
static int32_t ellipsoid(void *user, const double *u, double *p) {
    double sum = 0;
    (void)user;
    for (int i = 0; i < 6; i++) sum += u[i] * u[i] * (1 + i) * (1 + i);
    for (int i = 0; i < 6; i++) p[i] = u[i] * (1 + i) * (1 + i) / sqrt(sum) + (i == 0 ? 0.3 : 0);
    return 0;
}

static void points_in_six_dimensions(void) {
    qdist_solver *solver;
    qdist_set_f64 set;
    qdist_options_f64 options;
    qdist_result_f64 result;
    memset(&set, 0, sizeof set);
    set.support = ellipsoid, set.extent = 7;
    if (qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver) || qdist_options_default_f64(&options)) failures++;
    options.relative = 1e-9;
    result.struct_size = sizeof result;
    if (qdist_solve6_f64(solver, &set, NULL, &options, &result) || result.iterations != 50000) failures++;
}

enum { TIPS = 4 };
static qdist_contact_f64 tips[TIPS];
static qdist_primitive_f64 primitives[TIPS];
static qdist_wrenches_f64 grasp = {primitives, TIPS, QDIST_LINF};
static qdist_result_f64 answer;

static void make_grasp(void) {
    static const double normals[TIPS][3] = {{0.6, 0.8, 0}, {-0.6, 0.8, 0}, {0, -0.6, 0.8}, {0, -0.6, -0.8}};
    qdist_solver *solver;
    qdist_set_f64 set;
    for (int i = 0; i < TIPS; i++) {
        for (int k = 0; k < 3; k++) tips[i].normal[k] = normals[i][k], tips[i].position[k] = -normals[i][k];
        tips[i].friction = QDIST_SOFT, tips[i].mu = 0.5, tips[i].mus = 0.1;
    }
    answer.struct_size = sizeof answer;
    if (qdist_primitives_f64(tips, TIPS, &frame, 0, 0, primitives, NULL) || qdist_set_wrenches_f64(&set, &grasp) ||
        qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver) || qdist_solve6_f64(solver, &set, NULL, NULL, &answer))
        failures++;
}

static void forces(void) {
    const double load[6] = {0.1, -0.2, 0.3, 0.02, -0.03, 0.01};
    double shares[6 * TIPS];
    qdist_forces_f64 result;
    result.struct_size = sizeof result;
    if (qdist_contact_forces_f64(&grasp, NULL, load, NULL, shares, &result)) failures++;
}

static void gradients(void) {
    static qdist_contact_gradient_f64 all[TIPS];
    qdist_refined_f64 refined;
    refined.struct_size = sizeof refined;
    if (qdist_grasp_gradients_f64(&grasp, tips, TIPS, &frame, 0, 0, NULL, &answer, &refined, all, NULL)) failures++;
}

/* A finger of `count` contacts, with limits that count or without. */
static qdist_finger_f64 finger;
static uint32_t count;
static int limited;

static void make_finger(void) {
    const double limits[8] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
    qdist_contact_f64 contacts[4];
    memset(contacts, 0, sizeof contacts);
    for (int i = 0; i < 4; i++) {
        contacts[i].position[0] = i;
        contacts[i].normal[1] = 1;
        contacts[i].friction = QDIST_SOFT, contacts[i].mu = 0.5, contacts[i].mus = 0.1;
        contacts[i].actuated = 1, contacts[i].joints = 8;
        for (int k = 0; k < 32; k++) contacts[i].jacobian[k] = (k * 7 + i * 5) % 11 * 0.1 + (k < 8);
    }
    if (qdist_finger_init_f64(&finger, contacts, count, &frame, limited ? limits : NULL, QDIST_FORCE_MODEL_PASSIVE, 0, NULL)) failures++;
}

static const qdist_finger_wrenches_f64 hand = {&finger, 1, QDIST_LINF};
static qdist_set_f64 asked;

static void ask_finger(void) {
    const double u[6] = {0.3, 1, -0.2, 0.1, 0.4, 0.5};
    double point[6];
    if (asked.support(asked.user, u, point)) failures++;
}

int main(void) {
    printf("times in microseconds\n");
    printf("50,000 steps in 6-D             %9.0f\n", least(points_in_six_dimensions, 2));
    make_grasp();
    printf("contact forces of 4 contacts    %9.1f\n", least(forces, 200));
    printf("gradients of 4 contacts         %9.1f\n", least(gradients, 200));
    for (limited = 0; limited < 2; limited++) {
        for (count = 1; count <= 4; count += 3) {
            printf("finger of %u contacts %s: made %.1f", count, limited ? "with limits" : "without limits", least(make_finger, 50));
            if (qdist_set_finger_wrenches_f64(&asked, &hand)) failures++;
            printf(", asked %.2f\n", least(ask_finger, 200));
        }
    }
    printf("figures: %d passed, %d failed\n", failures ? 0 : 1, failures);
    return failures != 0;
}
