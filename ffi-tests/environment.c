/* Brackets hold in every floating-point environment that the header names: each rounding mode, with and without flushing of subnormal numbers to
 * zero. Against closed forms, and against the depth of random boxes in extended precision. The file includes itself once for each scalar type. */
#ifndef REAL

#include "qdist_grasp.h"
#include "dice.h"
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

/* A test once in each environment. */
static void everywhere(void (*test)(void)) {
    for (unsigned i = 0; i < sizeof MODES / sizeof *MODES; ++i) {
        for (flushing = 0; flushing <= CAN_FLUSH; ++flushing) {
            mode = MODES[i];
            dice_state = 1;
            test();
        }
    }
}

enum { CORNERS = 10 };

/* A random rotation, from a unit quaternion, and directions. */
static void turn(wide m[9]) {
    wide q[4], squared;
    do {
        squared = 0;
        for (int i = 0; i < 4; ++i) q[i] = (wide)dice(), squared += q[i] * q[i];
    } while (squared > 1 || squared < 0.1L);
    for (int i = 0; i < 4; ++i) q[i] /= sqrtl(squared);
    const wide w = q[0], x = q[1], y = q[2], z = q[3];
    const wide rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
                          2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
    memcpy(m, rows, sizeof rows);
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
    everywhere(hulls_and_half_spaces_f64);
    everywhere(hulls_and_half_spaces_f32);
    everywhere(placed_bodies_f64);
    everywhere(placed_bodies_f32);
    everywhere(in_the_plane_f64);
    everywhere(in_the_plane_f32);
    everywhere(subnormal_f64);
    everywhere(subnormal_f32);
    everywhere(grasps_f64);
    everywhere(grasps_f32);
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

/* Boxes by a prepared hull of their corners and points inside, beside each other or over a half space; capsules as hulls of two balls. */
static void S(hulls_and_half_spaces)(void) {
    for (int i = 0; i < 60; ++i) {
        enum { COUNT = 20 };
        REAL points[3 * COUNT], half[2][3];
        uint16_t graph[QDIST_HULL_GRAPH_LEN(COUNT)];
        const REAL ground = (REAL)dice();
        const S(qdist_half_space) floor = {{0, 0, 1}, ground};
        const S(qdist_sphere) ball = {(REAL)(1 + 0.5 * dice())};
        S(qdist_hull) hull;
        S(qdist_box) box;
        S(qdist_join) join;
        S(qdist_body) a, b, c, tip, tube;
        qdist_solver *solver;
        wide truth;
        for (int k = 0; k < 3; ++k) half[0][k] = (REAL)(1 + 0.5 * dice()), box.half[k] = half[1][k] = (REAL)(1 + 0.5 * dice());
        for (int k = 0; k < 3 * COUNT; ++k) points[k] = half[0][k % 3] * (k < 24 ? k / 3 >> k % 3 & 1 ? 1 : -1 : (REAL)(0.9 * dice()));
        enter();
        qdist_status status = S(qdist_solver_init)(memory, sizeof memory, 3, 4, 2 * COUNT, &solver);
        status |= S(qdist_hull_prepare)(&hull, solver, points, COUNT, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(COUNT));
        status |= S(qdist_body_hull)(&a, &hull) | S(qdist_body_box)(&b, &box) | S(qdist_body_half_space)(&c, &floor);
        leave();
        CHECK(status == QDIST_OK);
        b.translation[0] = (REAL)(2 + 0.5 * dice());
        truth = (wide)half[0][0] + (wide)half[1][0] - (wide)b.translation[0];
        /* (The others are at least 1.) */
        if (truth < 1) S(holds)("hull", &a, &b, truth, 2);
        a.translation[2] = (REAL)(2 * dice());
        S(holds)("half space", &a, &c, (wide)ground + (wide)half[0][2] - (wide)a.translation[2], 3);
        enter();
        status = S(qdist_body_sphere)(&tip, &ball) | S(qdist_body_sphere)(&b, &ball);
        leave();
        tip.translation[1] = 4;
        join.a = &tip, join.b = &b;
        enter();
        status |= S(qdist_body_join)(&tube, &join) | S(qdist_body_sphere)(&c, &ball);
        leave();
        CHECK(status == QDIST_OK);
        c.translation[1] = (REAL)(2 + dice()), c.translation[0] = (REAL)(2 + dice());
        S(holds)("join", &tube, &c, 2 * (wide)ball.radius - (wide)c.translation[0], 2);
    }
}

/* A body of each kind, its numbers in `n`. */
typedef struct {
    REAL n[3 * CORNERS];
    S(qdist_sphere) sphere;
    S(qdist_box) box;
    S(qdist_capsule) capsule;
    S(qdist_cylinder) cylinder;
    S(qdist_cone) cone;
    S(qdist_ellipsoid) ellipsoid;
    S(qdist_points) points;
    int kind;
    S(qdist_body) body;
} S(placed);

static void S(place)(S(placed) *p, int kind) {
    wide m[9];
    qdist_status status = QDIST_OK;
    memset(p, 0, sizeof *p);
    p->kind = kind;
    for (int i = 0; i < 3 * CORNERS; ++i) p->n[i] = (REAL)(kind == 6 ? dice() : 0.65 + 0.35 * dice());
    const REAL *n = p->n;
    switch (kind) {
        case 0: p->sphere.radius = n[0], status = S(qdist_body_sphere)(&p->body, &p->sphere); break;
        case 1: memcpy(p->box.half, n, sizeof p->box.half), status = S(qdist_body_box)(&p->body, &p->box); break;
        case 2: p->capsule.radius = n[0], p->capsule.half_height = n[1], status = S(qdist_body_capsule)(&p->body, &p->capsule); break;
        case 3: p->cylinder.radius = n[0], p->cylinder.half_height = n[1], status = S(qdist_body_cylinder)(&p->body, &p->cylinder); break;
        case 4: p->cone.radius = n[0], p->cone.half_height = n[1], status = S(qdist_body_cone)(&p->body, &p->cone); break;
        case 5: memcpy(p->ellipsoid.semi_axes, n, sizeof p->ellipsoid.semi_axes), status = S(qdist_body_ellipsoid)(&p->body, &p->ellipsoid); break;
        default: p->points.points = n, p->points.count = CORNERS, p->points.dimension = 3, status = S(qdist_body_points)(&p->body, &p->points);
    }
    CHECK(status == QDIST_OK);
    turn(m);
    for (int i = 0; i < 9; ++i) p->body.rotation[i] = (REAL)m[i];
}

/* The support function. */
static wide S(height)(const S(placed) *p, const wide *u) {
    const REAL *n = p->n;
    wide w[3], moved = 0;
    for (int j = 0; j < 3; ++j) {
        w[j] = 0;
        for (int i = 0; i < 3; ++i) w[j] += (wide)p->body.rotation[3 * i + j] * u[i];
        moved += u[j] * (wide)p->body.translation[j];
    }
    const wide across = hypotl(w[0], w[1]), length = sqrtl(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    switch (p->kind) {
        case 0: return n[0] * length + moved;
        case 1: return n[0] * fabsl(w[0]) + n[1] * fabsl(w[1]) + n[2] * fabsl(w[2]) + moved;
        case 2: return n[0] * length + n[1] * fabsl(w[2]) + moved;
        case 3: return n[0] * across + n[1] * fabsl(w[2]) + moved;
        case 4: return fmaxl(n[1] * w[2], n[0] * across - n[1] * w[2]) + moved;
        case 5: return sqrtl(n[0] * w[0] * (n[0] * w[0]) + n[1] * w[1] * (n[1] * w[1]) + n[2] * w[2] * (n[2] * w[2])) + moved;
        default: break;
    }
    wide most = -100;
    for (int k = 0; k < CORNERS; ++k) most = fmaxl(most, n[3 * k] * w[0] + n[3 * k + 1] * w[1] + n[3 * k + 2] * w[2]);
    return most + moved;
}

/* Bodies that were made in the usual environment, deep and shallow: what the reported direction proves is no more than `upper`, and `lower` no more than that; on the
 * ground the depth is in the bracket. */
static void S(placed_bodies)(void) {
    for (int i = 0; i < 400; ++i) {
        S(placed) a, b;
        S(qdist_body) ground;
        S(qdist_depth) depth;
        qdist_solver *solver;
        wide u[3], back[3], proved, squared = 0;
        const int on_ground = i % 2;
        const wide overlap = i % 3 ? 1e-3L + 0.3L * (wide)dice() * dice() : 1e-3L;
        S(place)(&a, i / 2 % 7);
        S(place)(&b, i / 14 % 7);
        for (int k = 0; k < 3; ++k) u[k] = (REAL)dice(), back[k] = -u[k], squared += u[k] * u[k];
        const S(qdist_half_space) floor = {{(REAL)u[0], (REAL)u[1], (REAL)u[2]}, (REAL)(overlap * sqrtl(squared) - S(height)(&a, back))};
        for (int k = 0; k < 3; ++k) b.body.translation[k] = (REAL)(u[k] / squared * (S(height)(&a, u) + S(height)(&b, back) - overlap * sqrtl(squared)));
        if (on_ground) CHECK(S(qdist_body_half_space)(&ground, &floor) == QDIST_OK);
        memset(&depth, 0, sizeof depth);
        depth.struct_size = sizeof depth;
        enter();
        qdist_status status = S(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &solver);
        status |= S(qdist_depth3)(solver, &a.body, on_ground ? &ground : &b.body, NULL, &depth);
        leave();
        CHECK(status == QDIST_OK);
        if (on_ground) {
            proved = (S(height)(&a, back) + floor.offset) / sqrtl(squared);
        } else {
            squared = 0;
            for (int k = 0; k < 3; ++k) u[k] = depth.normal[k], back[k] = -u[k], squared += u[k] * u[k];
            proved = (S(height)(&a, u) + S(height)(&b, back)) / sqrtl(squared);
        }
        const wide blur = 1e-18L;
        CHECK(depth.lower <= proved + blur && proved <= depth.upper + blur);
        if (!(depth.lower <= proved + blur && proved <= depth.upper + blur)) say(on_ground ? "ground" : "direction", depth.lower, proved, depth.upper);
    }
}

/* Discs, boxes, capsules and half planes. */
static void S(in_the_plane)(void) {
    for (int i = 0; i < 60; ++i) {
        const REAL p = (REAL)(1 + 0.5 * dice()), q = (REAL)(1 + 0.5 * dice()), at = (REAL)(2 + dice());
        const S(qdist_disc) disc1 = {p}, disc2 = {q};
        const S(qdist_box2) box1 = {{p, 3}}, box2 = {{q, 3}};
        const S(qdist_capsule2) tube1 = {p, 3}, tube2 = {q, 3};
        const S(qdist_half_plane) side = {{-2, 0}, -2 * at};
        for (int kind = 0; kind < 4; ++kind) {
            S(qdist_body2) a, b;
            S(qdist_depth) depth;
            qdist_solver *solver;
            const wide truth = (wide)p + (kind == 3 ? 0 : (wide)q) - (wide)at;
            memset(&depth, 0, sizeof depth);
            depth.struct_size = sizeof depth;
            enter();
            qdist_status status = S(qdist_solver_init)(memory, sizeof memory, 2, 32, 32, &solver);
            status |= kind == 0   ? S(qdist_body2_disc)(&a, &disc1) | S(qdist_body2_disc)(&b, &disc2)
                      : kind == 1 ? S(qdist_body2_box)(&a, &box1) | S(qdist_body2_box)(&b, &box2)
                      : kind == 2 ? S(qdist_body2_capsule)(&a, &tube1) | S(qdist_body2_capsule)(&b, &tube2)
                                  : S(qdist_body2_disc)(&a, &disc1) | S(qdist_body2_half_plane)(&b, &side);
            leave();
            if (kind < 3) b.translation[0] = at;
            enter();
            status |= S(qdist_depth2)(solver, &a, &b, NULL, &depth);
            leave();
            CHECK(status == QDIST_OK && depth.upper - depth.lower <= (sizeof(REAL) == 8 ? 1e-5L : 1e-3L));
            CHECK(depth.lower <= truth && truth <= depth.upper);
            if (!(depth.lower <= truth && truth <= depth.upper)) say("plane", depth.lower, truth, depth.upper);
        }
    }
}

/* Sizes and overlaps down to the smallest numbers, which may be flushed to zero: no false bracket. (Sizes of a few dozen of the smallest number are left out:
 * squares of what they become in the library's own unit are zero.) */
static void S(subnormal)(void) {
    const double most = sizeof(REAL) == 8 ? -140 : -17, least = sizeof(REAL) == 8 ? -321 : -43;
    for (int i = 0; i < 150; ++i) {
        const double size = pow(10, least + (most - least) * 0.5 * (1 + dice())), apart = pow(10, least + (most - least) * 0.5 * (1 + dice()));
        const REAL p = (REAL)size, q = (REAL)(size * (1 + 0.5 * dice())), at = (REAL)(i % 2 ? (double)p + (double)q + (i % 4 < 2 ? apart : -apart) : apart);
        const S(qdist_sphere) ball1 = {p}, ball2 = {q};
        const S(qdist_box) box1 = {{p, 3 * p, 3 * p}}, box2 = {{q, 3 * p, 3 * p}};
        for (int kind = 0; kind < 2; ++kind) {
            S(qdist_body) a, b;
            S(qdist_depth) depth;
            qdist_solver *solver;
            memset(&depth, 0, sizeof depth);
            depth.struct_size = sizeof depth;
            enter();
            qdist_status status = S(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &solver);
            status |= kind ? S(qdist_body_box)(&a, &box1) | S(qdist_body_box)(&b, &box2) : S(qdist_body_sphere)(&a, &ball1) | S(qdist_body_sphere)(&b, &ball2);
            leave();
            b.translation[0] = at;
            enter();
            if (status == QDIST_OK) status = S(qdist_depth3)(solver, &a, &b, NULL, &depth);
            leave();
            CHECK(status == QDIST_OK);
            /* Where numbers are flushed, those of the arguments may be, too: each by as much as the smallest normal one. */
            const wide truth = (wide)p + (wide)q - (wide)(at < 0 ? -at : at), flushed = flushing ? 16 * (wide)(sizeof(REAL) == 8 ? 2.3e-308 : 1.2e-38) : 0;
            const int deep = kind && truth > 3 * (wide)p; /* then another way out is shorter */
            CHECK(deep || (depth.lower <= truth + flushed && truth - flushed <= depth.upper));
            if (!deep && !(depth.lower <= truth + flushed && truth - flushed <= depth.upper)) say("small", depth.lower, truth, depth.upper);
        }
    }
}

/* Two soft fingers pinch a load: the share of their caps in closed form; closed, or open without torsion; d is 0 of fingers that press to one side. */
static void S(grasps)(void) {
    for (int i = 0; i < 40; ++i) {
        const S(qdist_wrench_frame) frame = {{0, 0, 0}, 1};
        const REAL mu = (REAL)(0.6 + 0.4 * dice()), cap = (REAL)(5 + 4 * dice()), weight = (REAL)(1 + 0.9 * dice());
        const REAL external[6] = {0, 0, -weight, 0, 0, 0};
        S(qdist_contact) contacts[2];
        S(qdist_primitive) primitives[2];
        const S(qdist_wrenches) wrenches = {primitives, 2, QDIST_LINF};
        S(qdist_forces) forces;
        S(qdist_closure) closure;
        S(qdist_result) result;
        S(qdist_set) set;
        qdist_solver *solver;
        REAL shares[12];
        for (int kind = 0; kind < 3; ++kind) { /* closed, without torsion, to one side */
            memset(contacts, 0, sizeof contacts), memset(&forces, 0, sizeof forces), memset(&closure, 0, sizeof closure);
            memset(&result, 0, sizeof result);
            forces.struct_size = sizeof forces, closure.struct_size = sizeof closure, result.struct_size = sizeof result;
            for (int k = 0; k < 2; ++k) {
                contacts[k].position[0] = k ? 1 : -1, contacts[k].normal[0] = k && kind < 2 ? -1 : 1;
                contacts[k].friction = kind == 1 ? QDIST_HARD : QDIST_SOFT, contacts[k].mu = mu, contacts[k].force_cap = cap;
                contacts[k].mus = (REAL)(kind == 1 ? 0 : 0.1);
            }
            enter();
            qdist_status status = S(qdist_primitives)(contacts, 2, &frame, 0, 0, primitives, NULL) | S(qdist_set_wrenches)(&set, &wrenches);
            status |= S(qdist_solver_init)(memory, sizeof memory, 6, 64, 2048, &solver);
            status |= S(qdist_force_closure)(solver, &set, NULL, &closure);
            status |= S(qdist_contact_forces)(&wrenches, NULL, external, NULL, shares, &forces);
            if (kind == 2) status |= S(qdist_solve6)(solver, &set, NULL, NULL, &result);
            leave();
            CHECK(status == QDIST_OK);
            CHECK(closure.verdict == (kind ? QDIST_CLOSURE_OPEN : QDIST_CLOSURE_CLOSED));
            if (kind < 2) {
                const wide share = (wide)weight / (2 * (wide)mu * (wide)cap), slack = sizeof(REAL) == 8 ? 1e-8L : 1e-3L;
                CHECK(forces.lower <= share * (1 + slack) && share * (1 - slack) <= forces.upper && forces.upper <= share * (sizeof(REAL) == 8 ? 1.0001L : 1.02L));
            } else {
                CHECK(result.lower == 0 && result.upper >= 0 && result.upper <= 1e-3);
            }
        }
    }
}
#endif
