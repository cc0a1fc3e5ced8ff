/* A gripper holds a box while the arm accelerates: every millisecond, is the grasp still safe, and how hard must each finger press?
 * All memory is static: three soft fingertips, of which one creeps over the surface.
 *
 * A tick asks two questions and stays within its deadline, whatever they cost:
 *
 * 1. How good is the grasp, as a certified bracket? The tracker moves the bracket of the last tick along with the contacts, and only
 *    searches when that is too wide; an interrupt callback looks at the clock.
 * 2. Which are the smallest contact forces that carry the load, and do they stay below the fingers' limits?
 *
 * `make demo` builds and runs it. */
#define _POSIX_C_SOURCE 199309L
#include "qdist_grasp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FINGERS = 3, TICKS = 1000 };

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 128, 2048)]; /* 250 KB; there is no heap */
static qdist_contact_f64 contacts[FINGERS];
static qdist_primitive_f64 primitives[FINGERS], before[FINGERS];
static qdist_tracker_f64 tracker;
static qdist_force_memory_f64 last_forces;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec; /* microseconds */
}

static int32_t is_late(void *user) { return now() > *(const double *)user; }

/* How far a wrench set has moved at most, when every primitive { center + disc x } did: the sum of what each did. */
static double motion(void) {
    double sum = 0;
    int i, k;
    for (i = 0; i < FINGERS; ++i) {
        double square = 0, disc = 0;
        for (k = 0; k < 6; ++k) square += pow(primitives[i].center[k] - before[i].center[k], 2);
        for (k = 0; k < 18; ++k) disc += pow(primitives[i].disc[k] - before[i].disc[k], 2);
        sum += sqrt(square) + sqrt(disc) + 1e-12;
    }
    return sum;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int fail(const char *what, qdist_status status) {
    fprintf(stderr, "%s: %s\n", what, qdist_status_string(status));
    return 1;
}

int main(void) {
    const double angle[FINGERS] = {0, 2.2, 4.1}, radius = 0.04, mass = 0.2;
    const qdist_wrench_frame_f64 frame = {{0, 0, 0}, 0.04}; /* metres; about the centre of mass */
    const qdist_wrenches_f64 wrenches = {primitives, FINGERS, QDIST_LINF};
    static double took[TICKS];
    double deadline = 0, hardest = 0, worst = 1e300;
    int tick, i, warm = 0, missed = 0, unsafe_ticks = 0;
    qdist_options_f64 options;
    qdist_solver *solver;
    qdist_status status;
    qdist_set_f64 set;

    for (i = 0; i < FINGERS; ++i) {
        qdist_contact_f64 *const c = &contacts[i];
        c->friction = QDIST_SOFT, c->mu = 0.6, c->mus = 0.004;
        c->force_cap = 10; /* newtons */
    }
    qdist_solver_init6_f64(memory, sizeof memory, 128, 2048, &solver);
    qdist_tracker_init_f64(&tracker, 6);
    qdist_options_default_f64(&options);

    for (tick = 0; tick < TICKS; ++tick) {
        const double t = 1e-3 * tick, start = now();
        const double sway = 6 * sin(6.283 * t), none[3] = {0, 0, 0}; /* the arm's acceleration, m/s^2 */
        const double load[3] = {-mass * sway, 0, -mass * 9.81};
        double external[6], shares[6 * FINGERS], moved;
        qdist_result_f64 quality;
        qdist_forces_f64 forces;
        uint32_t which;

        for (i = 0; i < FINGERS; ++i) { /* the third fingertip creeps upwards, 5 mm in a second */
            const double a = angle[i], z = i == 2 ? 0.005 * t : 0;
            double *const p = contacts[i].position, *const n = contacts[i].normal;
            p[0] = radius * cos(a), p[1] = radius * sin(a), p[2] = z;
            n[0] = -cos(a), n[1] = -sin(a), n[2] = 0;
        }
        memcpy(before, primitives, sizeof before);
        status = qdist_passive_primitives_f64(contacts, FINGERS, &frame, primitives, &which);
        if (status != QDIST_OK) return fail("contact", status);
        status = qdist_set_wrenches_f64(&set, &wrenches);
        if (status != QDIST_OK) return fail("wrenches", status);

        /* Quality: newtons of any wrench that it resists. The first tick takes its time, for a tight bracket; the others 0.5 ms. */
        moved = tick == 0 ? -1 : motion();
        options.relative = tick == 0 ? 1e-3 : 3e-2;
        options.interrupt = tick == 0 ? NULL : is_late;
        options.interrupt_user = &deadline;
        deadline = start + 500;
        quality.struct_size = sizeof quality;
        status = qdist_solve_warm6_f64(solver, &tracker, &set, NULL, moved, &options, &quality);
        if (status != QDIST_OK) return fail("quality", status);
        warm += quality.plan == QDIST_PLAN_WARM;

        /* Forces: the smallest that carry the load. */
        qdist_wrench_f64(&frame, load, none, external);
        forces.struct_size = sizeof forces;
        status = qdist_contact_forces_f64(&wrenches, &last_forces, external, NULL, shares, &forces);
        if (status != QDIST_OK) return fail("forces", status);
        if (forces.outcome == QDIST_FORCES_NOT_RESISTIBLE || forces.upper > 1) ++unsafe_ticks;
        if (tick % 250 == 0)
            printf("%4d ms: d in [%.4f, %.4f] N (%s, %s); forces %.2f to %.2f %% of the limits\n", tick, quality.lower,
                   quality.upper, qdist_outcome_string(quality.outcome), qdist_plan_string(quality.plan), 100 * forces.lower,
                   100 * forces.upper);
        for (i = 0; i < FINGERS; ++i) {
            double f[4];
            qdist_contact_force_f64(&contacts[i], &frame, shares + 6 * i, f);
            if (f[0] > hardest) hardest = f[0];
            if (tick % 250 == 0)
                printf("         finger %d presses %5.3f N, slides %5.3f N, spins %+6.3f mN m\n", i, f[0],
                       sqrt(f[1] * f[1] + f[2] * f[2]), 1e3 * f[3]);
        }
        if (quality.lower < worst) worst = quality.lower;
        took[tick] = now() - start;
    }
    qsort(took + 1, TICKS - 1, sizeof *took, ascending); /* the first tick is not in the loop's time */
    for (tick = 1; tick < TICKS; ++tick) missed += took[tick] > 1000;
    printf("%d ticks: quality never certified below %.4f N, hardest press %.3f N, %d ticks not held\n", TICKS, worst, hardest,
           unsafe_ticks);
    printf("%d ticks answered by moving the last bracket; microseconds a tick: median %.1f, p99 %.1f, most %.1f; %d missed\n", warm,
           took[TICKS / 2], took[TICKS * 99 / 100], took[TICKS - 1], missed);
    return unsafe_ticks != 0;
}
