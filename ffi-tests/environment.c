/* Brackets hold in every floating-point environment that the header names: each rounding mode, with and without flushing of subnormal numbers to
 * zero. Against closed forms, and against the depth of random boxes in extended precision. The file includes itself once for each scalar type. */
#ifndef REAL

#include "qdist.h"
#include "test.h"

#include <fenv.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
enum { CAN_FLUSH = 1 };
/* FTZ and DAZ. */
static void flush(int on) { _mm_setcsr((_mm_getcsr() & ~0x8040u) | (on ? 0x8040u : 0)); }
#elif defined(__aarch64__)
enum { CAN_FLUSH = 1 };
static void flush(int on) {
    uint64_t control;
    __asm__ volatile("mrs %0, fpcr" : "=r"(control));
    control = (control & ~(UINT64_C(1) << 24)) | (on ? UINT64_C(1) << 24 : 0);
    __asm__ volatile("msr fpcr, %0" : : "r"(control));
}
#else
enum { CAN_FLUSH = 0 };
static void flush(int on) { (void)on; }
#endif

typedef long double wide;

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)];
static const int MODES[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
/* The environment under test; the test itself computes in the usual one. */
static int mode, flushing;

static void enter(void) {
    fesetround(mode);
    flush(flushing);
}

static void leave(void) {
    fesetround(FE_TONEAREST);
    flush(0);
}

static uint64_t state;
/* In [-1, 1). */
static double dice(void) {
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(int64_t)(state ^ state >> 31) / 9223372036854775808.0;
}

/* A test once in each environment. */
static void everywhere(void (*test)(void)) {
    for (unsigned i = 0; i < sizeof MODES / sizeof *MODES; ++i) {
        for (flushing = 0; flushing <= CAN_FLUSH; ++flushing) {
            mode = MODES[i];
            state = 1;
            test();
        }
    }
}

static void say(const char *what, double lower, wide truth, double upper) {
    printf("%s, mode %d, flushing %d: %.20Lg is not in [%.17g, %.17g]\n", what, mode, flushing, truth, lower, upper);
}

#define REAL double
#define S(name) name##_f64
#include "environment.c"
#undef REAL
#undef S
#define REAL float
#define S(name) name##_f32
#include "environment.c"

int main(void) {
    everywhere(closed_forms_f64);
    everywhere(closed_forms_f32);
    everywhere(units_f64);
    everywhere(units_f32);
    everywhere(random_boxes_f64);
    everywhere(random_boxes_f32);
    return finish("environment");
}

#else

/* The depth is in the bracket, and the bracket is not much wider than `slack` times the size. */
static void S(holds)(const char *what, const S(qdist_body) *a, const S(qdist_body) *b, wide truth, wide size) {
    S(qdist_depth) depth;
    qdist_solver *solver;
    qdist_status status;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    enter();
    status = S(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &solver);
    if (status == QDIST_OK) status = S(qdist_depth3)(solver, a, b, NULL, &depth);
    leave();
    CHECK(status == QDIST_OK);
    CHECK(depth.lower <= truth && truth <= depth.upper);
    CHECK(depth.upper - depth.lower <= (sizeof(REAL) == 8 ? 1e-5L : 1e-2L) * size);
    if (!(depth.lower <= truth && truth <= depth.upper)) say(what, depth.lower, truth, depth.upper);
}

static void S(closed_forms)(void) {
    const REAL scales[] = {1, sizeof(REAL) == 8 ? (REAL)1e-50 : (REAL)1e-17f, sizeof(REAL) == 8 ? (REAL)1e140 : (REAL)1e17f};
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 60; ++i) {
            /* Sizes and the distance between the centres, all exact; overlap and gap alike. */
            const REAL s = scales[k];
            const REAL r1 = (REAL)(0.6 + 0.4 * dice()) * s, r2 = (REAL)(0.6 + 0.4 * dice()) * s;
            const REAL x = (REAL)(1.2 + dice()) * s;
            const wide apart = (wide)r1 + (wide)r2 - (wide)x;
            const S(qdist_sphere) ball1 = {r1}, ball2 = {r2};
            const S(qdist_box) box1 = {{r1, 3 * s, 4 * s}}, box2 = {{r2, 3 * s, 5 * s}};
            const S(qdist_capsule) tube1 = {r1, 2 * s}, tube2 = {r2, 3 * s};
            const S(qdist_ellipsoid) egg1 = {{r1, 2 * r1, 3 * r1}}, egg2 = {{r2, 2 * r2, 3 * r2}};
            S(qdist_body) a, b;
            enter();
            const int made = !S(qdist_body_sphere)(&a, &ball1) && !S(qdist_body_sphere)(&b, &ball2);
            leave();
            CHECK(made);
            b.translation[0] = x;
            S(holds)("spheres", &a, &b, apart, s);
            enter();
            S(qdist_body_box)(&a, &box1), S(qdist_body_box)(&b, &box2);
            leave();
            b.translation[0] = x;
            S(holds)("boxes", &a, &b, apart, s);
            enter();
            S(qdist_body_capsule)(&a, &tube1), S(qdist_body_capsule)(&b, &tube2);
            leave();
            b.translation[0] = x;
            S(holds)("capsules", &a, &b, apart, s);
            enter();
            S(qdist_body_ellipsoid)(&a, &egg1), S(qdist_body_ellipsoid)(&b, &egg2);
            leave();
            b.translation[0] = x;
            S(holds)("ellipsoids", &a, &b, apart, s);
        }
    }
}

/* d of a box in the box, ellipsoid and cross-polytope unit sets, and of a cross-polytope in six dimensions. */
static void S(units)(void) {
    for (int i = 0; i < 40; ++i) {
        S(qdist_box) shape;
        S(qdist_body) body;
        S(qdist_unit) unit;
        S(qdist_box_unit) cube = {{0}, 3};
        S(qdist_ellipsoid_unit) egg = {{0}, NULL, 3};
        S(qdist_cross_unit) cross = {{0}, 3};
        S(qdist_result) result;
        qdist_solver *solver;
        wide truth = 1e30L;
        for (int k = 0; k < 3; ++k) {
            shape.half[k] = (REAL)(2 + dice());
            cube.half[k] = egg.semi_axes[k] = cross.semi_axes[k] = (REAL)(1 + 0.5 * dice());
            if ((wide)shape.half[k] / (wide)cube.half[k] < truth) truth = (wide)shape.half[k] / (wide)cube.half[k];
        }
        for (int kind = 0; kind < 3; ++kind) {
            memset(&result, 0, sizeof result);
            result.struct_size = sizeof result;
            enter();
            qdist_status status = S(qdist_body_box)(&body, &shape);
            status |= kind == 0   ? S(qdist_unit_box)(&unit, &cube)
                      : kind == 1 ? S(qdist_unit_ellipsoid)(&unit, &egg)
                                  : S(qdist_unit_cross)(&unit, &cross);
            status |= S(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &solver);
            status |= S(qdist_solve3)(solver, &body.set, &unit, NULL, &result);
            leave();
            CHECK(status == QDIST_OK);
            CHECK(result.lower <= truth && truth <= result.upper);
            if (!(result.lower <= truth && truth <= result.upper)) say("unit", result.lower, truth, result.upper);
        }

        REAL tips[72] = {0};
        const S(qdist_points) list = {tips, 12, 6};
        S(qdist_set) set;
        wide sum = 0;
        for (int k = 0; k < 6; ++k) {
            const REAL tip = (REAL)(2 + dice());
            tips[12 * k + k] = tip, tips[12 * k + 6 + k] = -tip;
            sum += 1 / ((wide)tip * (wide)tip);
        }
        truth = 1 / sqrtl(sum);
        memset(&result, 0, sizeof result);
        result.struct_size = sizeof result;
        enter();
        qdist_status status = S(qdist_set_points)(&set, &list);
        status |= S(qdist_solver_init)(memory, sizeof memory, 6, 64, 2048, &solver);
        status |= S(qdist_solve6)(solver, &set, NULL, NULL, &result);
        leave();
        CHECK(status == QDIST_OK);
        CHECK(result.lower <= truth && truth <= result.upper);
        if (!(result.lower <= truth && truth <= result.upper)) say("6-D", result.lower, truth, result.upper);
    }
}

/* The columns of the matrices as given, times the half extents: edges of a parallelepiped. */
static void S(edges)(const S(qdist_body) *body, const S(qdist_box) *box, wide (*edges)[3]) {
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) edges[k][i] = (wide)body->rotation[3 * i + k] * (wide)box->half[k];
}

static void S(cross)(const wide *u, const wide *v, wide *n) {
    for (int i = 0; i < 3; ++i) n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

/* The signed depth by the separating axes: exact where it is positive, else not above minus the distance. */
static wide S(by_axes)(const S(qdist_body) *a, const S(qdist_box) *box_a, const S(qdist_body) *b, const S(qdist_box) *box_b) {
    wide e[2][3][3], least = 1e30L;
    S(edges)(a, box_a, e[0]);
    S(edges)(b, box_b, e[1]);
    for (int axis = 0; axis < 15; ++axis) {
        wide n[3], length = 0, along = 0, height = 0;
        if (axis < 6) {
            S(cross)(e[axis / 3][axis % 3], e[axis / 3][(axis + 1) % 3], n);
        } else {
            S(cross)(e[0][(axis - 6) / 3], e[1][(axis - 6) % 3], n);
        }
        for (int i = 0; i < 3; ++i) length += n[i] * n[i];
        if (!(length > 1e-20L)) continue;
        length = sqrtl(length);
        for (int i = 0; i < 3; ++i) along += n[i] * ((wide)b->translation[i] - (wide)a->translation[i]) / length;
        for (int body = 0; body < 2; ++body) {
            for (int k = 0; k < 3; ++k) {
                wide product = 0;
                for (int i = 0; i < 3; ++i) product += n[i] * e[body][k][i];
                height += fabsl(product) / length;
            }
        }
        if (height - fabsl(along) < least) least = height - fabsl(along);
    }
    return least;
}

/* A random rotation, rounded to the scalar type. */
static void S(turn)(REAL *matrix) {
    double w = dice(), x = dice(), y = dice(), z = dice();
    const double length = sqrt(w * w + x * x + y * y + z * z) + 1e-9;
    w /= length, x /= length, y /= length, z /= length;
    const double exact[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                             2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                             2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    for (int i = 0; i < 9; ++i) matrix[i] = (REAL)exact[i];
}

static void S(random_boxes)(void) {
    for (int i = 0; i < 400; ++i) {
        S(qdist_box) box_a, box_b;
        S(qdist_body) a, b;
        S(qdist_depth) depth;
        qdist_solver *solver;
        for (int k = 0; k < 3; ++k) {
            box_a.half[k] = (REAL)pow(10, 0.7 * dice());
            box_b.half[k] = (REAL)pow(10, 0.7 * dice());
        }
        enter();
        qdist_status status = S(qdist_body_box)(&a, &box_a) | S(qdist_body_box)(&b, &box_b);
        leave();
        CHECK(status == QDIST_OK);
        if (i % 4) S(turn)(a.rotation);
        if (i % 3) S(turn)(b.rotation);
        for (int k = 0; k < 3; ++k) a.translation[k] = (REAL)dice(), b.translation[k] = (REAL)(3 * dice());
        memset(&depth, 0, sizeof depth);
        depth.struct_size = sizeof depth;
        enter();
        status = S(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &solver);
        if (status == QDIST_OK) status = S(qdist_depth3)(solver, &a, &b, NULL, &depth);
        leave();
        CHECK(status == QDIST_OK);
        const wide truth = S(by_axes)(&a, &box_a, &b, &box_b);
        CHECK(depth.lower <= truth);
        CHECK(depth.upper >= truth || truth < 0);
        if (depth.lower > truth || (depth.upper < truth && truth >= 0)) say("boxes", depth.lower, truth, depth.upper);
    }
}
#endif
