/* A ring in the hand and a knot on the table: how hard does the knot push back? A loop of 1 kHz asks a tracker for the depth, with 0.4 ms for
 * queries by its clock, and turns it into a force by a spring from the ring's pose to the nearest free one. Another thread asks the same in full,
 * some milliseconds each, and the loop takes its answers over when they are there. The loop never waits for it.
 *
 * `./x demo-mesh` builds and runs it. */
#define _POSIX_C_SOURCE 200112L
#include "qdist_mesh.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TICKS = 2000, MOST = 4096 };
static const double PI = 3.14159265358979323846;
static const double STIFFNESS = 1000; /* N/m, with lengths in metres */

static void check(qdist_status status, const char *call) {
    if (status == QDIST_OK) return;
    fprintf(stderr, "%s: %s\n", call, qdist_status_string(status));
    exit(1);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec; /* microseconds */
}

static void sleep_until(double time) {
    const double left = time - now();
    struct timespec t;
    if (left <= 0) return;
    t.tv_sec = 0, t.tv_nsec = (long)(1e3 * left);
    nanosleep(&t, NULL);
}

static int32_t is_late(void *user) { return now() > *(const double *)user; }

/* ------------------------------------------------------------------------------------------------------------ meshes */

static void ring(double s, double *p) { p[0] = 0.05 * cos(s), p[1] = 0.04 * sin(s), p[2] = 0.01 * cos(3 * s); }

static void knot(double s, double *p) {
    const double r = 0.1 + 0.04 * cos(3 * s);
    p[0] = r * cos(2 * s), p[1] = r * sin(2 * s), p[2] = 0.06 * sin(3 * s);
}

static void cross(const double *a, const double *b, double *c) {
    c[0] = a[1] * b[2] - a[2] * b[1], c[1] = a[2] * b[0] - a[0] * b[2], c[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(double *a) {
    const double norm = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    a[0] /= norm, a[1] /= norm, a[2] /= norm;
}

/* A tube around a closed curve, with convex pieces inside, for lower bounds. */
static qdist_mesh *tube(uint32_t around, uint32_t across, double radius, void (*curve)(double, double *)) {
    static double xyz[MOST][3];
    static uint32_t triangles[2 * MOST][3];
    static const double aside[3] = {0.3, 0.2, 0.93};
    uint32_t i, j, k, count = 0, which = QDIST_MESH_NONE;
    qdist_mesh *mesh, *certified;
    for (i = 0; i < around; ++i) {
        const double s = 2 * PI * i / around;
        double centre[3], ahead[3], behind[3], side[3], up[3];
        curve(s, centre), curve(s + 1e-4, ahead), curve(s - 1e-4, behind);
        for (k = 0; k < 3; ++k) ahead[k] -= behind[k];
        normalise(ahead);
        cross(ahead, aside, side), normalise(side);
        cross(ahead, side, up);
        for (j = 0; j < across; ++j) {
            const double t = 2 * PI * j / across;
            const uint32_t next_i = (i + 1) % around * across, next_j = (j + 1) % across, here = i * across;
            const uint32_t quad[2][3] = {{here + j, here + next_j, next_i + next_j}, {here + j, next_i + next_j, next_i + j}};
            for (k = 0; k < 3; ++k) xyz[here + j][k] = centre[k] + radius * (cos(t) * side[k] + sin(t) * up[k]);
            memcpy(triangles[count], quad, sizeof quad);
            count += 2;
        }
    }
    check(qdist_mesh_create(xyz[0], around * across, triangles[0], count, &mesh, &which), "qdist_mesh_create");
    check(qdist_mesh_certify(mesh, &certified), "qdist_mesh_certify");
    qdist_mesh_free(mesh);
    return certified;
}

/* -------------------------------------------------------------------------------------------------- the other thread */

/* What both threads see, under the mutex. */
static struct {
    pthread_mutex_t mutex;
    pthread_cond_t asked;
    qdist_mesh_pose pose;
    qdist_mesh_depth answer;
    int has_pose, has_answer, over;
} shared = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, {{1, 0, 0, 0}, {0, 0, 0}}, {0}, 0, 0, 0};

/* A query in full is given up when the loop has ended. */
static int32_t is_over(void *user, const qdist_mesh_progress *progress) {
    int over;
    (void)user, (void)progress;
    pthread_mutex_lock(&shared.mutex);
    over = shared.over;
    pthread_mutex_unlock(&shared.mutex);
    return over;
}

/* user: a pair of its own. */
static void *background(void *user) {
    qdist_mesh_pair *pair = user;
    qdist_mesh_options options;
    qdist_mesh_depth depth;
    check(qdist_mesh_options_default(&options), "qdist_mesh_options_default");
    options.watch = is_over;
    depth.struct_size = sizeof depth;
    for (;;) {
        qdist_mesh_pose pose;
        pthread_mutex_lock(&shared.mutex);
        while (!shared.has_pose && !shared.over) pthread_cond_wait(&shared.asked, &shared.mutex);
        pose = shared.pose, shared.has_pose = 0;
        if (shared.over) break;
        pthread_mutex_unlock(&shared.mutex);
        check(qdist_mesh_pair_depth(pair, &pose, &options, &depth), "qdist_mesh_pair_depth");
        pthread_mutex_lock(&shared.mutex);
        shared.answer = depth, shared.has_answer = 1;
        pthread_mutex_unlock(&shared.mutex);
    }
    pthread_mutex_unlock(&shared.mutex);
    return NULL;
}

/* Gives the newest pose, and takes an answer if there is one. Where the mutex is held, the next tick will do. */
static int exchange(const qdist_mesh_pose *pose, qdist_mesh_depth *answer) {
    int answered;
    if (pthread_mutex_trylock(&shared.mutex) != 0) return 0;
    shared.pose = *pose, shared.has_pose = 1;
    answered = shared.has_answer, shared.has_answer = 0;
    if (answered) *answer = shared.answer;
    pthread_mutex_unlock(&shared.mutex);
    pthread_cond_signal(&shared.asked);
    return answered;
}

/* ---------------------------------------------------------------------------------------------------------- the loop */

/* Once around through the knot, in and out, turning about z. s: 0 to 1. */
static qdist_mesh_pose path(double s) {
    const double a = 2 * PI * s, half = 0.4 * sin(a);
    qdist_mesh_pose pose = {{cos(half), 0, 0, sin(half)}, {0.16 * cos(a), 0.13 * sin(a), 0.05 * sin(2 * a)}};
    return pose;
}

static void rotate(const double *q, const double *p, double *r) {
    double t[3], u[3];
    int k;
    cross(q + 1, p, t), cross(q + 1, t, u);
    for (k = 0; k < 3; ++k) r[k] = p[k] + 2 * (q[0] * t[k] + u[k]);
}

/* On the ring, about its centre of mass: k times the way to the free pose, and k r^2 times the rotation vector. */
static void spring(const qdist_mesh_pose *pose, const qdist_mesh_pose *free_pose, const qdist_mesh_mass *mass, double *force, double *torque) {
    const double *a = free_pose->rotation, *b = pose->rotation;
    const double r2 = (mass->inertia[0] + mass->inertia[4] + mass->inertia[8]) / (3 * mass->volume);
    double there[3], here[3], q[3], s = 0, norm;
    int k;
    rotate(a, mass->centre, there), rotate(b, mass->centre, here);
    for (k = 0; k < 3; ++k) force[k] = STIFFNESS * (there[k] + free_pose->translation[k] - here[k] - pose->translation[k]);
    for (k = 0; k < 4; ++k) s += a[k] * b[k];
    cross(b + 1, a + 1, q);
    for (k = 0; k < 3; ++k) q[k] += b[0] * a[k + 1] - a[0] * b[k + 1];
    norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    for (k = 0; k < 3; ++k) torque[k] = STIFFNESS * r2 * (norm > 0 ? 2 * atan2(norm, fabs(s)) * (s < 0 ? -q[k] : q[k]) / norm : 0);
}

static int ascending(const void *x, const void *y) {
    const double a = *(const double *)x, b = *(const double *)y;
    return (a > b) - (a < b);
}

int main(void) {
    static double took[TICKS];
    qdist_mesh *tool = tube(48, 10, 0.012, ring), *part = tube(96, 12, 0.025, knot);
    qdist_mesh_tracker *tracker;
    qdist_mesh_pair *pair;
    qdist_mesh_mass mass;
    qdist_mesh_budget budget;
    qdist_mesh_depth depth, cold;
    pthread_t thread;
    double deadline, start, strongest = 0;
    int tick, inside = 0, merged = 0, missed = 0, wrong = 0;
    uint32_t taken;

    check(qdist_mesh_integrate(tool, &mass), "qdist_mesh_integrate");
    check(qdist_mesh_tracker_create(tool, part, &tracker), "qdist_mesh_tracker_create");
    check(qdist_mesh_pair_create(tool, part, &pair), "qdist_mesh_pair_create");
    check(qdist_mesh_budget_default(&budget), "qdist_mesh_budget_default");
    budget.late = is_late, budget.late_user = &deadline;
    depth.struct_size = cold.struct_size = sizeof depth;
    if (pthread_create(&thread, NULL, background, pair) != 0) return 1;

    start = now();
    for (tick = 0; tick < TICKS; ++tick) {
        const qdist_mesh_pose pose = path((double)tick / TICKS);
        const double begin = now();
        double force[3], torque[3], size;
        deadline = begin + 400;
        if (exchange(&pose, &cold)) {
            check(qdist_mesh_tracker_merge(tracker, &cold, &taken), "qdist_mesh_tracker_merge");
            merged += (int)taken;
        }
        check(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth), "qdist_mesh_tracker_update");
        spring(&pose, &depth.pose, &mass, force, torque);
        took[tick] = now() - begin;
        inside += depth.outcome != QDIST_MESH_SEPARATED;
        wrong += !(depth.lower <= depth.upper) || depth.outcome == QDIST_MESH_STUCK;
        size = sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
        if (size > strongest) strongest = size;
        if (tick % 250 == 125)
            printf("%4d ms: depth %5.2f to %5.2f mm (%s), force %6.2f %6.2f %6.2f N, torque %6.1f %6.1f %6.1f mN m\n", tick, 1e3 * depth.lower,
                   1e3 * depth.upper, qdist_mesh_outcome_string(depth.outcome), force[0], force[1], force[2], 1e3 * torque[0], 1e3 * torque[1],
                   1e3 * torque[2]);
        sleep_until(start + 1e3 * (tick + 1));
    }
    pthread_mutex_lock(&shared.mutex);
    shared.over = 1;
    pthread_mutex_unlock(&shared.mutex);
    pthread_cond_signal(&shared.asked);
    pthread_join(thread, NULL);

    qsort(took, TICKS, sizeof *took, ascending);
    for (tick = 0; tick < TICKS; ++tick) missed += took[tick] > 1000;
    printf("%d ticks, %d in contact: strongest force %.2f N, %d answers of the other thread taken over\n", TICKS, inside, strongest, merged);
    printf("microseconds a tick: median %.1f, p99 %.1f, most %.1f; %d missed\n", took[TICKS / 2], took[TICKS * 99 / 100], took[TICKS - 1], missed);
    qdist_mesh_tracker_free(tracker);
    qdist_mesh_pair_free(pair);
    qdist_mesh_free(tool);
    qdist_mesh_free(part);
    return wrong != 0;
}
