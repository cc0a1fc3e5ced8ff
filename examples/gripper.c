/* A gripper holds a box while the arm accelerates: every millisecond, how good is the grasp, and how hard must each finger press? One of three
 * soft fingertips creeps over the surface.
 *
 * Two tasks share the work. Each has a solver of its own; all memory is static:
 *
 * 1. The loop, every millisecond. It moves the last certified bracket along with the contacts, which takes microseconds and makes the bracket
 *    a little wider each time, and finds the smallest contact forces that carry the load.
 * 2. The certifier, a thread. It takes the contacts of a tick and searches until their bracket is narrow, however long that takes. The
 *    loop takes that bracket over, moves it to where the contacts are by then, and goes on with it: the bracket closes again.
 *
 * A controller takes a certificate over as soon as it is ready. Here that is always PERIOD ticks after its contacts, so that every run prints
 * the same numbers, times aside. `./x demo` builds and runs it. */
#define _POSIX_C_SOURCE 200112L
#include "qdist_grasp.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { FINGERS = 3, TICKS = 1000, PERIOD = 25, SHOWN = 250 };

/* A grasp at some tick, and what is known of its quality. */
struct known {
    int tick;
    qdist_primitive_f64 primitives[FINGERS];
    qdist_tracker_f64 tracker;
};

static struct {
    uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 128, 2048)]; /* 250 KB; there is no heap */
    qdist_solver *solver;
    struct known known;
    qdist_status status;
    double took;
} certifier;

static struct {
    uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 18, 24)]; /* 5 KB: the loop moves brackets and does not search */
    qdist_solver *solver;
    struct known known;
    qdist_force_memory_f64 forces;
} loop;

static const qdist_wrench_frame_f64 FRAME = {{0, 0, 0}, 0.04}; /* about the centre of mass; metres */

static double microseconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e6 * (double)t.tv_sec + 1e-3 * (double)t.tv_nsec;
}

static void wait_until(double time) {
    const double left = time - microseconds();
    struct timespec t = {0, 0};
    t.tv_nsec = (long)(1e3 * left);
    if (left > 0) nanosleep(&t, NULL);
}

static void must(const char *what, qdist_status status) {
    if (status == QDIST_OK) return;
    fprintf(stderr, "%s: %s\n", what, qdist_status_string(status));
    exit(1);
}

/* The contacts at a tick: the third fingertip creeps upwards, 5 mm in a second. */
static void touch(int tick, qdist_contact_f64 *contacts, qdist_primitive_f64 *primitives) {
    const double angle[FINGERS] = {0, 2.2, 4.1}, radius = 0.04;
    uint32_t which;
    int i;
    memset(contacts, 0, FINGERS * sizeof *contacts);
    for (i = 0; i < FINGERS; ++i) {
        qdist_contact_f64 *const c = &contacts[i];
        c->position[0] = radius * cos(angle[i]), c->position[1] = radius * sin(angle[i]), c->position[2] = i == 2 ? 5e-6 * tick : 0;
        c->normal[0] = -cos(angle[i]), c->normal[1] = -sin(angle[i]);
        c->friction = QDIST_SOFT, c->mu = 0.6, c->mus = 0.004;
        c->force_cap = 10; /* newtons */
    }
    must("contacts", qdist_primitives_f64(contacts, FINGERS, &FRAME, 0, 0, primitives, &which));
}

/* How far a wrench set has moved at most, when every primitive { center + disc x } did: the sum of what each did. */
static double motion(const qdist_primitive_f64 *before, const qdist_primitive_f64 *after) {
    double sum = 0;
    int i, k;
    for (i = 0; i < FINGERS; ++i) {
        double center = 0, disc = 0;
        for (k = 0; k < 6; ++k) center += pow(after[i].center[k] - before[i].center[k], 2);
        for (k = 0; k < 18; ++k) disc += pow(after[i].disc[k] - before[i].disc[k], 2);
        sum += sqrt(center) + sqrt(disc) + 1e-12;
    }
    return sum;
}

/* The loop's question: d of these wrenches, in newtons of any wrench. They have moved by `moved` since the tracker was written. */
static qdist_result_f64 follow(const qdist_wrenches_f64 *wrenches, double moved) {
    qdist_options_f64 options;
    qdist_result_f64 d;
    qdist_set_f64 set;
    must("wrenches", qdist_set_wrenches_f64(&set, wrenches));
    qdist_options_default_f64(&options);
    options.relative = 0.05;
    options.max_iterations = 1;
    d.struct_size = sizeof d;
    must("quality", qdist_solve_warm6_f64(loop.solver, &loop.known.tracker, &set, NULL, moved, &options, &d));
    return d;
}

/* The certifier's: the same for certifier.known, without a limit and to 0.1 %. */
static void *certify(void *unused) {
    const qdist_wrenches_f64 wrenches = {certifier.known.primitives, FINGERS, QDIST_LINF};
    const double start = microseconds();
    qdist_options_f64 options;
    qdist_result_f64 d;
    qdist_set_f64 set;
    qdist_options_default_f64(&options);
    options.relative = 1e-3;
    d.struct_size = sizeof d;
    certifier.status = qdist_tracker_init_f64(&certifier.known.tracker, 6);
    if (certifier.status == QDIST_OK) certifier.status = qdist_set_wrenches_f64(&set, &wrenches);
    if (certifier.status == QDIST_OK)
        certifier.status = qdist_solve_warm6_f64(certifier.solver, &certifier.known.tracker, &set, NULL, -1, &options, &d);
    certifier.took = microseconds() - start;
    return unused;
}

static pthread_t start_certifier(int tick, const qdist_primitive_f64 *primitives) {
    pthread_t thread;
    certifier.known.tick = tick;
    memcpy(certifier.known.primitives, primitives, sizeof certifier.known.primitives);
    if (pthread_create(&thread, NULL, certify, NULL) != 0) must("thread", QDIST_ERROR_ARGUMENT);
    return thread;
}

/* Waits for the certificate and takes it over; how long the search took. */
static double take_over(pthread_t thread) {
    pthread_join(thread, NULL);
    must("certificate", certifier.status);
    loop.known = certifier.known;
    return certifier.took;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(void) {
    static double took[TICKS], searched[TICKS / PERIOD];
    const double mass = 0.2, none[3] = {0, 0, 0};
    double worst = 1e300, widest = 0, hardest = 0, due = microseconds();
    int tick, i, searches = 0, missed = 0, unsafe_ticks = 0;
    pthread_t thread;

    must("memory", qdist_solver_init_f64(loop.memory, sizeof loop.memory, 6, 18, 24, &loop.solver));
    must("memory", qdist_solver_init_f64(certifier.memory, sizeof certifier.memory, 6, 128, 2048, &certifier.solver));
    printf("three soft fingertips, d_Q of their wrenches in N; forces in N\n");
    printf("%4s %11s %9s %9s %7s  %-20s %s\n", "tick", "certificate", "d from", "to", "wide", "fingers press", "of their limits");
    for (tick = 0; tick < TICKS; ++tick) {
        const double sway = 6 * sin(6.283e-3 * tick), load[3] = {-mass * sway, 0, -mass * 9.81}; /* the arm accelerates */
        qdist_primitive_f64 primitives[FINGERS];
        const qdist_wrenches_f64 wrenches = {primitives, FINGERS, QDIST_LINF};
        double external[6], shares[6 * FINGERS], press[FINGERS], start, moved, wide;
        qdist_contact_f64 contacts[FINGERS];
        qdist_forces_f64 forces;
        qdist_result_f64 d;

        touch(tick, contacts, primitives);
        if (tick == 0) thread = start_certifier(tick, primitives); /* the first is waited for */
        if (tick % PERIOD == 0) searched[searches++] = take_over(thread);
        if (tick % PERIOD == 0) thread = start_certifier(tick, primitives);
        wait_until(due += 1000);

        start = microseconds();
        moved = motion(loop.known.primitives, primitives);
        memcpy(loop.known.primitives, primitives, sizeof primitives);
        d = follow(&wrenches, moved);
        qdist_wrench_f64(&FRAME, load, none, external);
        forces.struct_size = sizeof forces;
        must("forces", qdist_contact_forces_f64(&wrenches, &loop.forces, external, NULL, shares, &forces));
        for (i = 0; i < FINGERS; ++i) {
            double f[4]; /* along the normal and the tangents, and the moment */
            qdist_contact_force_f64(&contacts[i], &FRAME, shares + 6 * i, f);
            press[i] = f[0];
            hardest = fmax(hardest, f[0]);
        }
        took[tick] = microseconds() - start;
        missed += took[tick] > 1000;
        unsafe_ticks += forces.outcome == QDIST_FORCES_NOT_RESISTIBLE || forces.upper > 1;
        wide = 100 * (d.upper - d.lower) / d.upper;
        worst = fmin(worst, d.lower);
        widest = fmax(widest, wide);
        if (tick % SHOWN == 0 || tick % SHOWN == SHOWN - 1)
            printf("%4d %11d %9.4f %9.4f %5.2f %%  %5.3f  %5.3f  %5.3f  %6.2f %%\n", tick, loop.known.tick, d.lower, d.upper, wide, press[0],
                   press[1], press[2], 100 * forces.upper);
    }
    take_over(thread);
    qsort(took, TICKS, sizeof *took, ascending);
    qsort(searched, (size_t)searches, sizeof *searched, ascending);
    printf("%d ticks: d certified at %.4f N and above, no bracket wider than %.2f %%; hardest press %.3f N, %d ticks not held\n", TICKS, worst,
           widest, hardest, unsafe_ticks);
    printf("microseconds a tick: median %.1f, p99 %.1f, most %.1f (%d above 1000); a certificate in the background: median %.0f, most %.0f\n",
           took[TICKS / 2], took[TICKS * 99 / 100], took[TICKS - 1], missed, searched[searches / 2], searched[searches - 1]);
    return unsafe_ticks != 0;
}
