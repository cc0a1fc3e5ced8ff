/* How much stack a query takes: runs it on a painted stack of its own and looks how far the paint is gone. */
#include "fingertips.h"
#include <stdio.h>
#include <string.h>
#include <ucontext.h>

enum { STACK = 128 * 1024 };
static union {
    uint64_t align;
    unsigned char bytes[STACK];
} stack;
static ucontext_t back, there;
static void (*task)(void);

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)];
static int failures;

static void trampoline(void) { task(); }

static long used(void (*run)(void)) {
    memset(stack.bytes, 0xA5, STACK);
    task = run;
    getcontext(&there);
    there.uc_stack.ss_sp = stack.bytes;
    there.uc_stack.ss_size = STACK;
    there.uc_link = &back;
    makecontext(&there, trampoline, 0);
    swapcontext(&back, &there);
    long untouched = 0;
    while (untouched < STACK && stack.bytes[untouched] == 0xA5) untouched++;
    return STACK - untouched;
}

static void nothing(void) {}

#define DEPTH_OF_BOXES(scalar, real)                                                             \
    static void boxes_##scalar(void) {                                                           \
        qdist_solver *solver;                                                                    \
        qdist_box_##scalar box = {{(real)1, (real)2, (real)3}};                                  \
        qdist_body_##scalar a, b;                                                                \
        qdist_depth_##scalar depth;                                                              \
        if (qdist_solver_init_##scalar(memory, sizeof memory, 3, 64, 128, &solver)) failures++;    \
        if (qdist_body_box_##scalar(&a, &box) || qdist_body_box_##scalar(&b, &box)) failures++;  \
        for (int i = 0; i < 40; i++) { /* overlapping, touching, apart; edges against faces */   \
            real c = (real)0.8, s = (real)0.6;                                                   \
            real turned[9] = {c, -s, 0, s, c, 0, 0, 0, 1};                                       \
            memcpy(b.rotation, turned, sizeof turned);                                           \
            b.translation[0] = (real)i / 10;                                                     \
            b.translation[2] = (real)i / 7;                                                      \
            depth.struct_size = sizeof depth;                                                    \
            if (qdist_depth3_##scalar(solver, &a, &b, NULL, &depth)) failures++;                 \
        }                                                                                        \
    }
DEPTH_OF_BOXES(f32, float)
DEPTH_OF_BOXES(f64, double)

/* The unit ball's worst case in 6-D: a set that expansion has to work on. */
static int32_t rounded(void *user, const double *u, double *p) {
    (void)user;
    double sum = 0;
    for (int i = 0; i < 6; i++) sum += u[i] * u[i] * (1 + i);
    if (sum <= 0) return 1;
    double scale = 1;
    for (int k = 0; k < 60; k++) scale = 0.5 * (scale + sum / scale);
    for (int i = 0; i < 6; i++) p[i] = u[i] * (1 + i) / scale;
    return 0;
}

static void six(int plan) {
    qdist_solver *solver;
    qdist_set_f64 set;
    qdist_unit_f64 unit;
    qdist_box_unit_f64 cube = {{1, 1, 1, 1, 1, 1}, 6};
    qdist_options_f64 options;
    qdist_tracker_f64 tracker;
    qdist_result_f64 result;
    memset(&set, 0, sizeof set);
    set.support = rounded;
    if (qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver)) failures++;
    if (qdist_unit_box_f64(&unit, &cube) || qdist_options_default_f64(&options)) failures++;
    if (qdist_tracker_init_f64(&tracker, 6)) failures++;
    options.relative = 1e-2;
    result.struct_size = sizeof result;
    if (plan == 2 && qdist_solve_in_span_f64(solver, &set, NULL, &options, &result)) failures++;
    for (int tick = 0; plan == 3 && tick < 2; tick++)
        if (qdist_solve_warm6_f64(solver, &tracker, &set, NULL, 0, &options, &result)) failures++;
    if (plan < 2 && qdist_solve6_f64(solver, &set, plan ? &unit : NULL, &options, &result)) failures++;
    const int expected[] = {QDIST_PLAN_CONES, QDIST_PLAN_RAYS, QDIST_PLAN_CONES, QDIST_PLAN_WARM};
    if (result.plan != expected[plan]) failures++;
}

static void cones(void) { six(0); }
static void rays(void) { six(1); }
static void span(void) { six(2); }
static void warm(void) { six(3); }

/* A finger of four contacts whose joints make all forces, with limits that count. */
static qdist_finger_f64 finger;

static void make_finger(void) {
    const qdist_wrench_frame_f64 frame = {{0, 0, 0}, 1};
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
    if (qdist_finger_init_f64(&finger, contacts, 4, &frame, limits, QDIST_FORCE_MODEL_ACTIVE, 0, NULL)) failures++;
}

static void ask_finger(void) {
    const qdist_finger_wrenches_f64 wrenches = {&finger, 1, QDIST_LINF};
    double u[6] = {0.3, 1, -0.2, 0.1, 0.4, 0.5}, point[6], forces[16];
    qdist_set_f64 set;
    if (qdist_set_finger_wrenches_f64(&set, &wrenches) || set.support(set.user, u, point) || qdist_finger_forces_f64(&finger, u, forces)) failures++;
}

static void distribute(void) {
    const qdist_finger_wrenches_f64 wrenches = {&finger, 1, QDIST_LINF};
    double load[6] = {0, -0.1, 0, 0, 0, 0}, shares[6], forces[16];
    qdist_forces_f64 result;
    result.struct_size = sizeof result;
    if (qdist_finger_contact_forces_f64(&wrenches, NULL, load, NULL, shares, forces, &result)) failures++;
}

/* A grasp of four soft fingertips, and what is asked of it. */
static qdist_contact_f64 tips[TIPS];
static const qdist_wrench_frame_f64 grasp_frame = {{0, 0, 0}, 1};
static qdist_primitive_f64 primitives[TIPS];
static qdist_wrenches_f64 grasp = {primitives, TIPS, QDIST_LINF};
static qdist_result_f64 grasp_result;

static void primitives_of_tips(void) {
    four_fingertips(tips);
    if (qdist_primitives_f64(tips, TIPS, &grasp_frame, 0, 0, primitives, NULL)) failures++;
}

static void efficiency(void) {
    qdist_solver *solver;
    qdist_set_f64 set;
    if (qdist_set_wrenches_f64(&set, &grasp) || qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver)) failures++;
    grasp_result.struct_size = sizeof grasp_result;
    if (qdist_solve6_f64(solver, &set, NULL, NULL, &grasp_result)) failures++;
}

static void closure(void) {
    qdist_solver *solver;
    qdist_set_f64 set;
    qdist_closure_f64 closed;
    closed.struct_size = sizeof closed;
    if (qdist_set_wrenches_f64(&set, &grasp) || qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver)) failures++;
    if (qdist_force_closure_f64(solver, &set, NULL, &closed) || closed.verdict != QDIST_CLOSURE_CLOSED) failures++;
}

static void gradients(void) {
    static qdist_contact_gradient_f64 all[TIPS];
    qdist_refined_f64 refined;
    refined.struct_size = sizeof refined;
    if (qdist_grasp_gradients_f64(&grasp, tips, TIPS, &grasp_frame, 0, 0, NULL, &grasp_result, &refined, all, NULL)) failures++;
}

static void forces(void) {
    const double load[6] = {0.1, -0.2, 0.3, 0.02, -0.03, 0.01};
    double shares[6 * TIPS];
    qdist_force_memory_f64 known;
    qdist_forces_f64 result;
    result.struct_size = sizeof result;
    memset(&known, 0, sizeof known);
    for (int tick = 0; tick < 2; tick++)
        if (qdist_contact_forces_f64(&grasp, &known, load, NULL, shares, &result) || result.outcome != QDIST_FORCES_CONVERGED) failures++;
}

/* Not golden numbers: what headers and README say, with a sixth to spare; a guard against an array that slips onto the stack. */
static void at_most(const char *what, long bytes, double kilobytes) {
    printf("%-28s %6ld bytes\n", what, bytes);
    if (bytes > kilobytes * 1024 * 7 / 6) failures++, printf("  more than %.0f KB\n", kilobytes);
}

int main(void) {
    const long base = used(nothing);
    puts("stack of a query:");
    at_most("depth of boxes, float", used(boxes_f32) - base, 9);
    at_most("depth of boxes", used(boxes_f64) - base, 10);
    at_most("d_Q in 6-D, by cones", used(cones) - base, 25);
    at_most("d_Q in 6-D, by rays", used(rays) - base, 25);
    at_most("d_Q in 6-D, in its span", used(span) - base, 25);
    at_most("d_Q in 6-D, warm", used(warm) - base, 25);
    primitives_of_tips();
    at_most("d_Q of a grasp", used(efficiency) - base, 25);
    at_most("force closure", used(closure) - base, 25);
    at_most("contact forces", used(forces) - base, 16);
    at_most("gradients", used(gradients) - base, 20);
    at_most("finger with limits, made", used(make_finger) - base, 69);
    at_most("finger with limits, asked", used(ask_finger) - base, 27);
    at_most("finger with limits, forces", used(distribute) - base, 40);
    printf("stack: %d passed, %d failed\n", failures ? 0 : 1, failures ? 1 : 0);
    return failures != 0;
}
