/* Real answers through the C interface: brackets contain closed forms, in both scalar types. The file includes itself
 * once for each. */
#ifndef REAL

#include "qdist.h"
#include "dice.h"
#include "test.h"

#include <math.h>
#include <string.h>
#include <time.h>

#define JOIN_(name, suffix) name##suffix
#define JOIN(name, suffix) JOIN_(name, suffix)
#define Q(name) JOIN(name, SUFFIX)

#define REAL double
#define SUFFIX _f64
#define BYTES QDIST_WORKSPACE_BYTES_F64
#define WIDTH 1e-6
#include "smoke.c"
#undef REAL
#undef SUFFIX
#undef BYTES
#undef WIDTH

#define REAL float
#define SUFFIX _f32
#define BYTES QDIST_WORKSPACE_BYTES_F32
#define WIDTH 1e-4
#include "smoke.c"

int main(void) {
    smoke_f64();
    smoke_f32();
    CHECK(strcmp(qdist_status_string(QDIST_OK), "ok") == 0);
    CHECK(strcmp(qdist_outcome_string(QDIST_CONVERGED), "converged") == 0);
    return finish("smoke");
}

#else

typedef Q(qdist_body) Q(body);
typedef Q(qdist_depth) Q(depth);
typedef Q(qdist_result) Q(result);

static Q(depth) Q(ask)(qdist_solver *solver, const Q(body) *a, const Q(body) *b, const Q(qdist_options) *options) {
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_depth3)(solver, a, b, options, &depth) == QDIST_OK);
    return depth;
}

/* Does the bracket contain d, and is it narrow? Near 0, rounding decides. */
static int Q(brackets)(double lower, double upper, double d) {
    return lower <= d && d <= upper && upper - lower <= WIDTH * fabs(d) + 0.05 * WIDTH;
}

/* Are the witness points depth * normal apart, sideways to the square root of the tolerance, and is the normal of unit
 * length? */
static int Q(consistent)(const Q(depth) *depth, double scale) {
    double length = 0, miss = 0;
    int i;
    for (i = 0; i < 3; ++i) {
        const double gap = depth->point_a[i] - depth->point_b[i] - depth->upper * depth->normal[i];
        length += (double)depth->normal[i] * depth->normal[i];
        miss += gap * gap;
    }
    return fabs(length - 1) < 1e-5 && sqrt(miss) < sqrt(WIDTH) * scale;
}

static void Q(pairs)(qdist_solver *solver) {
    const Q(qdist_sphere) ball = {0.5};
    const Q(qdist_box) cube = {{1.0, 2.0, 3.0}}, brick = {{0.5, 0.5, 0.5}}, plate = {{1.0, 1.0, 0.0}};
    const Q(qdist_capsule) rod = {0.25, 1.0};
    const Q(qdist_cylinder) can = {1.0, 2.0};
    const Q(qdist_cone) cone = {1.0, 1.0};
    const Q(qdist_ellipsoid) egg = {{1.0, 2.0, 4.0}};
    Q(body) a, b;
    Q(depth) depth;

    /* Two spheres: sum of radii minus distance of centres (0.3, 0.4, 0 are 0.5 apart). */
    CHECK(Q(qdist_body_sphere)(&a, &ball) == QDIST_OK && Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    b.translation[0] = 0.75;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 0.25) && depth.outcome == QDIST_CONVERGED);
    CHECK(fabs(depth.normal[0] - 1) < 1e-5 && fabs(depth.point_a[0] - 0.5) < 1e-5 && fabs(depth.point_b[0] - 0.25) < 1e-5);
    b.translation[0] = 2.0;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, -1.0) && depth.outcome == QDIST_SEPARATED);
    CHECK(fabs(depth.point_a[0] - 0.5) < 1e-5 && fabs(depth.point_b[0] - 1.5) < 1e-5);
    b.translation[0] = 1.0;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(depth.outcome == QDIST_TOUCHING && Q(brackets)(depth.lower, depth.upper, 0.0));
    CHECK(Q(brackets)(Q(ask)(solver, &a, &a, NULL).lower, Q(ask)(solver, &a, &a, NULL).upper, 1.0));

    /* Boxes along the axes: the smallest overlap. */
    CHECK(Q(qdist_body_box)(&a, &cube) == QDIST_OK && Q(qdist_body_box)(&b, &brick) == QDIST_OK);
    b.translation[1] = 2.25;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 0.25) && fabs(depth.normal[1] - 1) < 1e-5);
    CHECK(Q(consistent)(&depth, 0.25) && depth.dimension == 3 && depth.facets_used == 0 && depth.support_calls > 0);
    /* Two margins, whose sum is not a number of the scalar: each counts by itself. */
    {
        const Q(qdist_box) unit_cube = {{1, 1, 1}};
        Q(body) rounded[2];
        int i;
        for (i = 0; i < 2; ++i) {
            CHECK(Q(qdist_body_box)(&rounded[i], &unit_cube) == QDIST_OK);
            rounded[i].set.radius = i ? (REAL)0.2 : (REAL)0.1, rounded[i].translation[0] = i ? (REAL)2.3 : 0;
        }
        const double truth = sizeof(REAL) == 8 ? 0x1.cp-53 : 2 + (double)(REAL)0.1 + (double)(REAL)0.2 - (double)(REAL)2.3;
        const Q(depth) near = Q(ask)(solver, &rounded[0], &rounded[1], NULL);
        CHECK(near.lower <= truth && truth <= near.upper && fabs(near.normal[0] - 1) < 1e-5);
    }
    /* An eighth of a turn about z: half a diagonal, sqrt(1/2), sticks out. */
    b.rotation[0] = b.rotation[4] = (REAL)sqrt(0.5);
    b.rotation[1] = -(REAL)sqrt(0.5);
    b.rotation[3] = (REAL)sqrt(0.5);
    b.translation[1] = 2.5;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(fabs(depth.upper - (sqrt(0.5) - 0.5)) < WIDTH && fabs(depth.lower - (sqrt(0.5) - 0.5)) < WIDTH);
    /* Corner against corner, apart: (1, 1, 1) from (1, 2, 3) to (2, 3, 4). */
    CHECK(Q(qdist_body_box)(&b, &brick) == QDIST_OK);
    b.translation[0] = 2.5, b.translation[1] = 3.5, b.translation[2] = 4.5;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(depth.outcome == QDIST_SEPARATED && fabs(depth.lower + sqrt(3.0)) < 1e-5 && fabs(depth.upper + sqrt(3.0)) < 1e-5);
    CHECK(fabs(depth.point_a[2] - 3) < 1e-4 && fabs(depth.point_b[2] - 4) < 1e-4 && Q(consistent)(&depth, 1));

    /* A sphere in a box. */
    CHECK(Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    b.translation[0] = 0.5;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 1.0) && Q(consistent)(&depth, 1));

    /* Crossed capsules: radii minus the distance of the axes. */
    CHECK(Q(qdist_body_capsule)(&a, &rod) == QDIST_OK && Q(qdist_body_capsule)(&b, &rod) == QDIST_OK);
    b.rotation[0] = b.rotation[8] = 0, b.rotation[2] = 1, b.rotation[6] = -1; /* z to x, x to -z */
    b.translation[1] = 0.375;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 0.125) && fabs(depth.normal[1] - 1) < 1e-4);
    b.translation[1] = 1.5;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, -1.0) && depth.outcome == QDIST_SEPARATED);

    /* Solids of revolution on one axis: the cone's base in the can's lid, 0.5 deep. */
    CHECK(Q(qdist_body_cylinder)(&a, &can) == QDIST_OK && Q(qdist_body_cone)(&b, &cone) == QDIST_OK);
    b.translation[2] = 2.5;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 0.5) && fabs(depth.normal[2] - 1) < 1e-4);
    CHECK(Q(qdist_body_ellipsoid)(&a, &egg) == QDIST_OK && Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    b.translation[2] = 4.25;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(Q(brackets)(depth.lower, depth.upper, 0.25) && depth.outcome == QDIST_CONVERGED);

    /* Two plates in one plane: a flat difference. */
    CHECK(Q(qdist_body_box)(&a, &plate) == QDIST_OK && Q(qdist_body_box)(&b, &plate) == QDIST_OK);
    b.translation[0] = 1.0;
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(depth.outcome == QDIST_DEGENERATE && depth.dimension == 2 && depth.lower <= 0 && depth.upper >= 0);
}

static void Q(limits)(qdist_solver *solver) {
    const Q(qdist_box) cube = {{1.0, 1.0, 1.0}};
    const Q(qdist_ellipsoid) egg = {{1.0, 2.0, 4.0}};
    Q(qdist_options) options;
    Q(body) a, b;
    Q(depth) depth;

    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    CHECK(Q(qdist_body_box)(&a, &cube) == QDIST_OK && Q(qdist_body_ellipsoid)(&b, &egg) == QDIST_OK);
    b.translation[0] = 1.0; /* depth 1, along x */
    options.use_threshold = 1;
    options.threshold = 0.5;
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.outcome == QDIST_ABOVE && depth.lower >= 0.5 && depth.lower <= 1 && depth.upper >= 1);
    options.threshold = 2.5;
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.outcome == QDIST_BELOW && depth.upper < 2.5 && depth.upper >= 1);
    options.use_threshold = 0;
    options.max_iterations = 1;
    b.rotation[0] = b.rotation[4] = 0.6f, b.rotation[1] = -0.8f, b.rotation[3] = 0.8f;
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.outcome == QDIST_ITERATIONS && depth.lower < depth.upper && depth.iterations <= 1);
    options.max_iterations = 0;
    options.absolute = (REAL)0.25;
    options.relative = 0;
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.outcome == QDIST_CONVERGED && depth.upper - depth.lower <= 0.25);
    options.use_guess = 1;
    options.absolute = 0;
    options.relative = (REAL)WIDTH;
    memcpy(options.guess, depth.normal, sizeof depth.normal);
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.outcome == QDIST_CONVERGED && depth.upper >= 1 && depth.upper - depth.lower <= WIDTH * depth.upper);
    CHECK(Q(consistent)(&depth, 1));
}

/* h(u) = |D M^T u| + r of an ellipsoid with a matrix and a ball, for a direction of any length. */
static double Q(swollen)(const Q(body) *egg, const double *semi, double r, const double *u) {
    double squares = 0, length = 0;
    int i, k;
    for (i = 0; i < 3; ++i) {
        double along = 0;
        for (k = 0; k < 3; ++k) along += (double)egg->rotation[3 * k + i] * u[k];
        squares += semi[i] * semi[i] * along * along;
        length += u[i] * u[i];
    }
    return sqrt(squares / length) + r;
}

/* Matrices that are rotations only roughly: the ball that rolls inside an ellipsoid does not stay a ball under them, so that the
 * bracket must be that of the image. */
static void Q(skewed)(qdist_solver *solver) {
    const double semi[3] = {1.0, 1.25, 1.5};
    const double off[] = {0, 1e-6, -1e-6, 4e-5, -4e-5};
    const Q(qdist_ellipsoid) egg = {{1.0, 1.25, 1.5}};
    const Q(qdist_sphere) ball = {0.5};
    Q(qdist_options) options;
    Q(body) a, b;
    Q(depth) depth;
    unsigned k;
    int i, j;

    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.relative = (REAL)(WIDTH * 1e-2);
    CHECK(Q(qdist_body_ellipsoid)(&a, &egg) == QDIST_OK && Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    CHECK(a.rolling_radius > 0 && a.rolling_radius == a.set.radius && b.rolling_radius == 0);
    for (k = 0; k < sizeof off / sizeof *off; ++k) {
        double u[3], least = 1e9;
        /* Larger in all directions: the shortest axis decides. */
        memset(a.rotation, 0, sizeof a.rotation);
        a.rotation[0] = a.rotation[4] = a.rotation[8] = (REAL)(1 + off[k]);
        depth = Q(ask)(solver, &a, &b, &options);
        CHECK(depth.lower <= a.rotation[0] + 0.5 && depth.upper >= a.rotation[0] + 0.5);
        CHECK(depth.upper - depth.lower < 3e-5);
        /* Sheared and turned: no direction may be below the bracket, and the one that is reported is the bracket's upper end. */
        a.rotation[0] = a.rotation[4] = (REAL)0.6, a.rotation[1] = (REAL)(-0.8 + off[k]), a.rotation[3] = (REAL)0.8;
        depth = Q(ask)(solver, &a, &b, &options);
        for (i = 0; i < 200; ++i) {
            for (j = 0; j < 200; ++j) {
                const double h = (u[0] = cos(i * 0.0157), u[1] = sin(i * 0.0157), u[2] = (j - 100) * 1e-3,
                                  Q(swollen)(&a, semi, 0.5, u));
                if (h < least) least = h;
            }
        }
        for (i = 0; i < 3; ++i) u[i] = depth.normal[i];
        CHECK(depth.lower <= least && Q(swollen)(&a, semi, 0.5, u) <= depth.upper && depth.upper - least < 1e-4);
    }
    /* A margin is a ball by itself, whatever the matrix. */
    memset(a.rotation, 0, sizeof a.rotation);
    a.rotation[0] = a.rotation[4] = a.rotation[8] = (REAL)(1 + 4e-5);
    a.set.radius += (REAL)0.25;
    depth = Q(ask)(solver, &a, &b, &options);
    CHECK(depth.lower <= a.rotation[0] + 0.75 && depth.upper >= a.rotation[0] + 0.75 && depth.upper - depth.lower < 3e-5);
}

/* A regular hexagonal prism of radius 1 and height 2: a shape that the library does not know. Counts its calls. */
static int32_t Q(prism)(void *user, const REAL *direction, REAL *point) {
    int *calls = user;
    double best = -1e30;
    int i;
    ++*calls;
    for (i = 0; i < 6; ++i) {
        const double x = cos(i * 1.0471975511965976), y = sin(i * 1.0471975511965976);
        if (x * direction[0] + y * direction[1] > best) {
            best = x * direction[0] + y * direction[1];
            point[0] = (REAL)x;
            point[1] = (REAL)y;
        }
    }
    point[2] = direction[2] < 0 ? -1 : 1;
    return 0;
}

static int32_t Q(failing)(void *user, const REAL *direction, REAL *point) {
    int *left = user;
    point[0] = direction[0] < 0 ? -1 : 1, point[1] = direction[1] < 0 ? -1 : 1, point[2] = direction[2] < 0 ? -1 : 1;
    return (*left)-- > 0 ? 0 : 77;
}

/* Writes less than it should. */
static int32_t Q(lazy)(void *user, const REAL *direction, REAL *point) {
    (void)user;
    point[0] = direction[0];
    return 0;
}

static REAL Q(negative)(void *user, const REAL *direction) {
    (void)user;
    return direction[0];
}

static void Q(callbacks)(qdist_solver *solver) {
    const Q(qdist_sphere) ball = {0.5};
    int calls = 0, left;
    Q(qdist_set) set;
    Q(qdist_unit) unit;
    Q(body) a, b;
    Q(depth) depth;
    Q(result) result;

    memset(&set, 0, sizeof set);
    set.support = Q(prism);
    set.user = &calls;
    CHECK(Q(qdist_body_set)(&a, &set) == QDIST_OK && Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(fabs(depth.upper - (sqrt(0.75) + 0.5)) < 2 * WIDTH && fabs(depth.lower - (sqrt(0.75) + 0.5)) < 2 * WIDTH);
    CHECK(calls > 0 && depth.outcome == QDIST_CONVERGED);
    a.set.radius = (REAL)0.125; /* a margin */
    depth = Q(ask)(solver, &a, &b, NULL);
    CHECK(fabs(depth.upper - (sqrt(0.75) + 0.625)) < 2 * WIDTH);

    set.support = Q(failing);
    set.user = &left;
    set.extent = 2;
    CHECK(Q(qdist_body_set)(&a, &set) == QDIST_OK);
    for (left = 0; left < 8; ++left) {
        int before = left, after;
        memset(&depth, 0, sizeof depth);
        depth.struct_size = sizeof depth;
        after = Q(qdist_depth3)(solver, &a, &b, NULL, &depth);
        if (after == QDIST_OK) break; /* solved before the failure */
        CHECK(after == QDIST_ERROR_CALLBACK && depth.outcome == QDIST_SUPPORT_FAILED && depth.callback_code == 77);
        CHECK(depth.lower <= 1.5 && depth.upper >= 1.5);
        left = before;
    }
    CHECK(left > 0);

    set.support = Q(lazy);
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_solve3)(solver, &set, NULL, NULL, &result) == QDIST_ERROR_CALLBACK);
    CHECK(result.callback_code == QDIST_CALLBACK_NONFINITE && result.outcome == QDIST_SUPPORT_FAILED);
    left = 1000000;
    set.support = Q(failing);
    memset(&unit, 0, sizeof unit);
    unit.value = Q(negative);
    unit.extent = 1;
    CHECK(Q(qdist_solve3)(solver, &set, &unit, NULL, &result) == QDIST_ERROR_CALLBACK);
    CHECK(result.callback_code == QDIST_CALLBACK_NONFINITE);
}

static void Q(units)(qdist_solver *solver) {
    const Q(qdist_box) cube = {{1.0, 2.0, 4.0}};
    const REAL turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1}; /* x to y */
    const REAL corners[6] = {2, 0, 0, 0, 0, 2};
    const Q(qdist_points) list = {corners, 2, 3};
    const Q(qdist_segment_unit) ray = {{1.0, 1.0, 1.0, 0, 0, 0}, 3}, across = {{0, 0, 0.5, 0, 0, 0}, 3};
    const Q(qdist_box_unit) box = {{0.5, 0.5, 4.0, 0, 0, 0}, 3};
    const Q(qdist_cross_unit) cross = {{0.5, 0.5, 8.0, 0, 0, 0}, 3};
    const Q(qdist_ellipsoid_unit) egg = {{1.0, 4.0, 1.0, 0, 0, 0}, turn, 3}, plain = {{0.5, 1.0, 8.0, 0, 0, 0}, NULL, 3};
    Q(qdist_unit) unit;
    Q(body) body;
    Q(result) result;
    Q(qdist_set) set;

    CHECK(Q(qdist_body_box)(&body, &cube) == QDIST_OK);
    set = body.set;
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
#define SOLVE(expected)                                                          \
    CHECK(Q(qdist_solve3)(solver, &set, &unit, NULL, &result) == QDIST_OK);     \
    CHECK(Q(brackets)(result.lower, result.upper, expected) && result.outcome == QDIST_CONVERGED)
    CHECK(Q(qdist_unit_ball)(&unit, (REAL)0.5) == QDIST_OK);
    SOLVE(2.0);
    CHECK(result.point_count >= 1 && result.point_count <= 4 && fabs(fabs(result.direction[0]) - 1) < 1e-4);
    CHECK(Q(qdist_unit_segment)(&unit, &ray) == QDIST_OK); /* leaves the box at (1, 1, 1) */
    SOLVE(1.0);
    CHECK(Q(qdist_unit_segment)(&unit, &across) == QDIST_OK);
    SOLVE(8.0);
    CHECK(Q(qdist_unit_box)(&unit, &box) == QDIST_OK); /* 1/0.5, 2/0.5, 4/4 */
    SOLVE(1.0);
    CHECK(Q(qdist_unit_cross)(&unit, &cross) == QDIST_OK); /* 4/8 */
    SOLVE(0.5);
    CHECK(Q(qdist_unit_ellipsoid)(&unit, &egg) == QDIST_OK); /* semi axis 4 along -x */
    SOLVE(0.25);
    CHECK(Q(qdist_unit_ellipsoid)(&unit, &plain) == QDIST_OK); /* 1/0.5, 2/1, 4/8 */
    SOLVE(0.5);
    unit.extent = 0; /* unknown: the library asks */
    SOLVE(0.5);
    CHECK(Q(qdist_unit_vertices)(&unit, &list) == QDIST_OK); /* 1/2 along x, 4/2 along z */
    SOLVE(0.5);
#undef SOLVE
}

/* Any dimension: a cube of half size 1 around (0.25, 0, ...) by its corners, and a box made as a sum of segments. */
static void Q(dimensions)(void) {
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 256, 40000)];
    typedef qdist_status (*solve)(qdist_solver *, const Q(qdist_set) *, const Q(qdist_unit) *, const Q(qdist_options) *,
                                  Q(result) *);
    const solve solves[] = {Q(qdist_solve2), Q(qdist_solve3), Q(qdist_solve4), Q(qdist_solve5), Q(qdist_solve6)};
    REAL corners[64 * 6];
    uint32_t n, i, k;

    for (n = 2; n <= 6; ++n) {
        Q(qdist_points) list = {NULL, 0, 0};
        Q(qdist_set) cube, shifted, difference;
        Q(qdist_pair) pair;
        Q(qdist_linear) map;
        Q(qdist_segment_unit) ray;
        Q(qdist_unit) unit;
        Q(result) result;
        REAL matrix[36];
        qdist_solver *solver = NULL;

        CHECK(Q(qdist_solver_init)(memory, sizeof memory, n, 256, n < 5 ? 4000 : 40000, &solver) == QDIST_OK && solver != NULL);
        for (i = 0; i < 1u << n; ++i)
            for (k = 0; k < n; ++k) corners[i * n + k] = (REAL)((i >> k & 1 ? 1 : -1) + (k == 0 ? 0.25 : 0));
        list.points = corners, list.count = 1u << n, list.dimension = n;
        CHECK(Q(qdist_set_points)(&cube, &list) == QDIST_OK);
        memset(&result, 0, sizeof result);
        result.struct_size = sizeof result;
        CHECK(solves[n - 2](solver, &cube, NULL, NULL, &result) == QDIST_OK);
        CHECK(Q(brackets)(result.lower, result.upper, 0.75) && fabs(result.direction[0] + 1) < 1e-4);

        memset(&ray, 0, sizeof ray);
        ray.end[0] = (REAL)0.5, ray.dimension = n;
        CHECK(Q(qdist_unit_segment)(&unit, &ray) == QDIST_OK);
        CHECK(solves[n - 2](solver, &cube, &unit, NULL, &result) == QDIST_OK);
        CHECK(Q(brackets)(result.lower, result.upper, 2.5));

        /* cube - (cube mapped by 1/2, and moved by -1 along the last axis): half sizes 1.5 around (0.125, ..., 1). */
        memset(matrix, 0, sizeof matrix);
        for (k = 0; k < n; ++k) matrix[k * n + k] = (REAL)0.5;
        memset(&map, 0, sizeof map);
        map.set = &cube, map.matrix = matrix, map.rows = map.columns = n;
        map.translation[n - 1] = -1;
        CHECK(Q(qdist_set_linear)(&shifted, &map) == QDIST_OK);
        pair.a = &cube, pair.b = &shifted, pair.dimension = n;
        CHECK(Q(qdist_set_difference)(&difference, &pair) == QDIST_OK);
        CHECK(solves[n - 2](solver, &difference, NULL, NULL, &result) == QDIST_OK);
        CHECK(Q(brackets)(result.lower, result.upper, 0.5) && fabs(result.direction[n - 1] + 1) < 1e-4);
        CHECK(Q(qdist_set_sum)(&difference, &pair) == QDIST_OK); /* around (0.375, ..., -1) */
        CHECK(solves[n - 2](solver, &difference, NULL, NULL, &result) == QDIST_OK);
        CHECK(Q(brackets)(result.lower, result.upper, 0.5) && fabs(result.direction[n - 1] - 1) < 1e-4);
    }
}

/* An ellipsoid with the semi axes sqrt(1), sqrt(2), .. in as many dimensions as `size`, moved by `at`: sets, unit sets and clocks of the
 * caller. */
typedef struct {
    uint32_t size;
    double at[6];
    int bad; /* 1: a vertex function that fails, 2: one that writes NaN */
    int calls, left;
} Q(world);

static int32_t Q(egg)(void *user, const REAL *direction, REAL *point) {
    Q(world) *w = user;
    double sum = 0;
    uint32_t i;
    ++w->calls;
    for (i = 0; i < w->size; ++i) sum += (double)direction[i] * direction[i] * (1 + i);
    for (i = 0; i < w->size; ++i) point[i] = (REAL)(direction[i] * (REAL)(1 + i) / sqrt(sum) + w->at[i]);
    return 0;
}

static int32_t Q(egg_mirrored)(void *user, uint32_t signs) {
    const Q(world) *w = user;
    uint32_t i;
    for (i = 0; i < w->size; ++i)
        if ((signs >> i & 1) && w->at[i] != 0) return 0;
    return 1;
}

/* The unit cube as a unit set of the caller. */
static REAL Q(cube_value)(void *user, const REAL *direction) {
    const Q(world) *w = user;
    double sum = 0;
    uint32_t i;
    for (i = 0; i < w->size; ++i) sum += fabs(direction[i]);
    return (REAL)sum;
}

static int32_t Q(cube_point)(void *user, const REAL *direction, REAL *point) {
    const Q(world) *w = user;
    uint32_t i;
    if (w->bad == 3) return 1;
    for (i = 0; i < w->size; ++i) point[i] = w->bad == 4 ? (REAL)NAN : direction[i] < 0 ? -1 : 1;
    return 0;
}

static int32_t Q(cube_vertex)(void *user, uint32_t index, REAL *point) {
    const Q(world) *w = user;
    uint32_t i;
    for (i = 0; i < w->size; ++i) point[i] = index >> i & 1 ? -1 : 1;
    if (w->bad == 2 && index == 5) point[1] = (REAL)NAN;
    return w->bad == 1 && index == 5 ? 99 : 0;
}

static int32_t Q(clock)(void *user) {
    Q(world) *w = user;
    return w->left-- <= 0;
}

/* A 6-D query in 64 KB: what it is decides the plan. */
static void Q(plans)(void) {
    static uint64_t memory[8192];
    const Q(qdist_box_unit) cuboid = {{1, 1, 1, 1, 1, 0.5}, 6};
    const Q(qdist_cross_unit) cross = {{2, 1, 1, 1, 1, 1}, 6};
    const Q(qdist_segment_unit) ray = {{0, 0, 0, 2, 0, 0}, 6};
    const REAL sparse[18] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -2, 0, 0};
    const Q(qdist_points) list = {sparse, 3, 6}; /* with the origin among them */
    Q(qdist_ellipsoid_unit) round = {{1, 1, 1, 1, 1, 1}, NULL, 6};
    Q(world) w;
    Q(qdist_set) set;
    Q(qdist_unit) unit, own;
    Q(qdist_options) options;
    Q(qdist_tracker) tracker;
    Q(result) result, before;
    qdist_solver *solver = NULL;
    const double whole = 1 / sqrt(1.0 + 1 / 2. + 1 / 3. + 1 / 4. + 1 / 5. + 0.25 / 6.);
    double least, step;
    REAL lower;
    int i, tick;

    CHECK(BYTES(6, 80, 512) <= sizeof memory);
    CHECK(Q(qdist_solver_init)(memory, sizeof memory, 6, 80, 512, &solver) == QDIST_OK);
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    memset(&w, 0, sizeof w);
    memset(&set, 0, sizeof set);
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    w.size = 6;
    set.support = Q(egg), set.user = &w, set.extent = (REAL)2.5;
#define SOLVE(q) Q(qdist_solve6)(solver, &set, q, &options, &result)
#define IS(d) (result.outcome == QDIST_CONVERGED && result.lower <= (d) && (d) <= result.upper && \
               result.upper - result.lower <= 10.001 * WIDTH * (d))
    options.relative = (REAL)(10 * WIDTH);

    /* Polytopal unit sets: a corner of t * box is on the ellipsoid where the sum of its squares over the axes' is 1. */
    CHECK(Q(qdist_unit_box)(&unit, &cuboid) == QDIST_OK && unit.vertex_count == 64);
    CHECK(SOLVE(&unit) == QDIST_OK && IS(whole) && result.plan == QDIST_PLAN_RAYS);
    CHECK(result.has_rival == 1);
    CHECK(Q(qdist_unit_cross)(&unit, &cross) == QDIST_OK && unit.vertex_count == 12);
    CHECK(SOLVE(&unit) == QDIST_OK && IS(0.5) && result.plan != QDIST_PLAN_CONES);
    CHECK(Q(qdist_unit_segment)(&unit, &ray) == QDIST_OK && unit.vertex_count == 1);
    CHECK(SOLVE(&unit) == QDIST_OK && IS(1) && result.plan == QDIST_PLAN_RAYS);
    CHECK(Q(qdist_unit_vertices)(&unit, &list) == QDIST_OK && unit.vertex_count == 3);
    CHECK(SOLVE(&unit) == QDIST_OK && IS(1) && result.plan != QDIST_PLAN_CONES);

    /* The same cube by callbacks; what fails is said. */
    memset(&own, 0, sizeof own);
    own.value = Q(cube_value), own.user = &w, own.inner_radius = 1;
    own.vertex = Q(cube_vertex), own.vertex_count = 64, own.point = Q(cube_point);
    CHECK(SOLVE(&own) == QDIST_OK && IS(1 / sqrt(2.45)) && result.plan == QDIST_PLAN_RAYS);
    own.inner_radius = 0, set.extent = 0, own.extent = 0; /* nothing is known of the sizes */
    CHECK(SOLVE(&own) == QDIST_OK && IS(1 / sqrt(2.45)) && result.plan == QDIST_PLAN_RAYS);
    set.extent = (REAL)2.5;
    for (w.bad = 1; w.bad <= 2; ++w.bad) {
        CHECK(SOLVE(&own) == QDIST_ERROR_CALLBACK && result.outcome == QDIST_SUPPORT_FAILED);
        CHECK(result.callback_code == (w.bad == 1 ? 99 : QDIST_CALLBACK_NONFINITE));
        CHECK(result.lower <= 1 / sqrt(2.45) && 1 / sqrt(2.45) <= result.upper);
    }
    /* Without vertices it is a unit set like any other; a `point` that fails or lies only slows the search down. */
    own.vertex_count = 0;
    options.relative = (REAL)0.05;
    for (w.bad = 3; w.bad <= 5; ++w.bad) {
        set.mirrored = Q(egg_mirrored), own.mirrored = Q(egg_mirrored);
        CHECK(SOLVE(&own) == QDIST_OK && result.outcome == QDIST_CONVERGED && result.plan != QDIST_PLAN_RAYS);
        CHECK(result.lower <= 1 / sqrt(2.45) && 1 / sqrt(2.45) <= result.upper);
    }
    w.bad = 0;

    /* Smooth against smooth: cones, of which the mirrors leave one orthant. */
    options.relative = (REAL)0.02;
    CHECK(SOLVE(NULL) == QDIST_OK && result.outcome == QDIST_CONVERGED && result.plan == QDIST_PLAN_CONES);
    CHECK(result.lower <= 1 && 1 <= result.upper && result.upper - result.lower <= 0.02 * result.lower * 1.0001);
    CHECK(result.cones >= 1 && result.facets_used <= 512);
    before = result;
    set.mirrored = NULL;
    CHECK(SOLVE(NULL) == QDIST_OK && result.outcome == QDIST_CONVERGED && result.plan == QDIST_PLAN_CONES);
    CHECK(result.cones >= 64 && result.cones > before.cones && result.lower <= 1 && 1 <= result.upper);
    CHECK(strcmp(qdist_plan_string(result.plan), "cones") == 0);

    /* Deadlines: after any number of iterations there is a true bracket. */
    options.interrupt = Q(clock), options.interrupt_user = &w;
    for (i = 0; i < 2000; i = 2 * i + 1) {
        w.left = i;
        CHECK(SOLVE(NULL) == QDIST_OK && result.outcome == QDIST_INTERRUPTED);
        CHECK(result.lower <= 1 && 1 <= result.upper && result.iterations <= (uint32_t)i);
    }
    options.interrupt = NULL;

    /* The gradient: the sphere of radius 1 in a half space of directions, moved by `at`, loses what it is moved along u. */
    w.at[0] = 0.25;
    CHECK(SOLVE(NULL) == QDIST_OK && result.lower <= 0.75 && 0.75 <= result.upper && result.unit == 1);
    CHECK(fabs(result.direction[0] + 1) < 0.05 && fabs(result.support[0] + 0.75) < 0.05 && result.has_rival == 0);
    before = result;
    w.at[0] = 0.26;
    options.relative = (REAL)0.01;
    CHECK(SOLVE(NULL) == QDIST_OK && fabs(0.75 + before.direction[0] / before.unit * 0.01 - 0.74) < 0.001);
    w.at[0] = 0;

    /* A loop: the set moves by a little, and the bracket moves along. */
    CHECK(Q(qdist_tracker_init)(&tracker, 6) == QDIST_OK && tracker.dimension == 6);
    CHECK(Q(qdist_tracker_lower_after)(&tracker, NULL, 0, &lower) == QDIST_OK && lower < -1e30);
    CHECK(Q(qdist_unit_ellipsoid)(&unit, &round) == QDIST_OK && unit.inner_radius == 1);
    set.mirrored = Q(egg_mirrored);
    options.relative = (REAL)0.02;
    for (tick = 0, least = 1, step = -1; tick < 40; ++tick) {
        uint32_t calls;
        if (tick > 0) {
            step = 1e-4;
            w.at[0] += 1e-4;
            least -= 1e-4;
            CHECK(Q(qdist_tracker_lower_after)(&tracker, &unit, (REAL)step * (REAL)1.0001, &lower) == QDIST_OK);
            CHECK(lower <= least && lower > least * 0.96);
        }
        options.max_iterations = tick > 0 ? 20 : 0;
        options.relative = (REAL)(tick > 0 ? 0.03 : 0.02);
        result.support_calls = 0;
        CHECK(Q(qdist_solve_warm6)(solver, &tracker, &set, &unit, (REAL)step * (REAL)1.0001, &options, &result) == QDIST_OK);
        CHECK(result.lower <= least * (1 + 1e-6) && least * (1 - 1e-6) <= result.upper && tracker.lower == result.lower);
        calls = result.support_calls;
        if (tick > 0 && tick < 20) CHECK(result.plan == QDIST_PLAN_WARM && calls < 30 && result.outcome == QDIST_CONVERGED);
    }
    options.max_iterations = 0;
#undef SOLVE
#undef IS
}

/* Flat sets in their span, and interrupted depths. */
static void Q(flat)(qdist_solver *solver) {
    const Q(qdist_box) plate = {{1.0, 0.5, 0.0}}, needle = {{0.0, 0.0, 2.0}}, cube = {{1, 1, 1}};
    Q(qdist_options) options;
    Q(world) w;
    Q(body) body, turned;
    Q(depth) depth;
    Q(result) result;

    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_body_box)(&body, &plate) == QDIST_OK && body.set.mirrored != NULL && body.set.mirrored(NULL, 7) == 1);
    CHECK(Q(qdist_solve3)(solver, &body.set, NULL, NULL, &result) == QDIST_OK && result.outcome == QDIST_DEGENERATE);
    CHECK(Q(qdist_solve_in_span)(solver, &body.set, NULL, NULL, &result) == QDIST_OK && result.outcome == QDIST_CONVERGED);
    CHECK(result.dimension == 2 && Q(brackets)(result.lower, result.upper, 0.5) && fabs(fabs(result.direction[1]) - 1) < 1e-3);
    CHECK(Q(qdist_body_box)(&body, &needle) == QDIST_OK);
    CHECK(Q(qdist_solve_in_span)(solver, &body.set, NULL, NULL, &result) == QDIST_OK && result.outcome == QDIST_CONVERGED);
    CHECK(result.dimension == 1 && Q(brackets)(result.lower, result.upper, 2.0) && result.has_rival == 1);
    CHECK(Q(qdist_body_box)(&body, &cube) == QDIST_OK);
    CHECK(Q(qdist_solve_in_span)(solver, &body.set, NULL, NULL, &result) == QDIST_OK && result.dimension == 3);
    CHECK(Q(brackets)(result.lower, result.upper, 1.0) && strcmp(qdist_plan_string(result.plan), "expansion") == 0);

    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    memset(&w, 0, sizeof w);
    options.interrupt = Q(clock), options.interrupt_user = &w;
    turned = body;
    turned.rotation[0] = turned.rotation[4] = (REAL)0.6, turned.rotation[1] = (REAL)-0.8, turned.rotation[3] = (REAL)0.8;
    turned.translation[0] = (REAL)0.5;
    depth = Q(ask)(solver, &body, &turned, &options);
    CHECK(depth.outcome == QDIST_INTERRUPTED && depth.iterations == 0 && depth.lower <= depth.upper);
    w.left = 1000;
    depth = Q(ask)(solver, &body, &turned, &options);
    CHECK(depth.outcome == QDIST_CONVERGED && w.left < 1000);
}

/* A ball of 400 points by its graph, against the list. */
static void Q(hulls)(qdist_solver *solver) {
    enum { COUNT = 400 };
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, COUNT, 2 * COUNT + 16)];
    static REAL points[3 * COUNT];
    static uint16_t graph[QDIST_HULL_GRAPH_LEN(COUNT)];
    static uint32_t large_graph[QDIST_HULL_LARGE_GRAPH_LEN(COUNT)], scratch[QDIST_HULL_LARGE_WORKSPACE_LEN(COUNT)];
    const uint32_t room = QDIST_HULL_LARGE_GRAPH_LEN(COUNT), work = QDIST_HULL_LARGE_WORKSPACE_LEN(COUNT);
    Q(qdist_points) list;
    Q(qdist_hull) hull;
    Q(qdist_hull_large) large;
    Q(body) a, b, c, d;
    Q(depth) one, two;
    Q(world) w;
    qdist_solver *workspace;
    int i, far;

    for (far = 0; far < 2; ++far) {
        for (i = 0; i < COUNT; ++i) {
            const double z = 1 - (2 * i + 1.0) / COUNT, r = sqrt(1 - z * z), t = 2.399963229728653 * i;
            points[3 * i] = (REAL)(r * cos(t) + far * 64);
            points[3 * i + 1] = (REAL)(r * sin(t));
            points[3 * i + 2] = (REAL)z;
        }
        CHECK(Q(qdist_solver_init)(memory, sizeof memory, 3, 4, 2 * COUNT, &workspace) == QDIST_OK);
        CHECK(Q(qdist_hull_prepare)(&hull, workspace, points, COUNT, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(COUNT)) == QDIST_OK);
        list.points = points, list.count = COUNT, list.dimension = 3;
        CHECK(Q(qdist_body_hull)(&a, &hull) == QDIST_OK && Q(qdist_body_points)(&b, &list) == QDIST_OK);
        CHECK((a.spread > 0) == far && (b.spread > 0) == far);
        c = b;
        c.translation[0] = (REAL)0.5, c.translation[1] = (REAL)0.75;
        one = Q(ask)(solver, &a, &c, NULL);
        two = Q(ask)(solver, &b, &c, NULL);
        CHECK(one.lower <= two.upper && two.lower <= one.upper && one.upper - one.lower < 1e-3);
        CHECK(fabs(one.upper - (2 - sqrt(0.25 + 0.5625))) < 0.05 && Q(consistent)(&one, 1));
        CHECK(Q(qdist_hull_large_prepare)(&large, scratch, work, points, COUNT, NULL, NULL, large_graph, room) == QDIST_OK);
        CHECK(Q(qdist_body_hull_large)(&d, &large) == QDIST_OK && (d.spread > 0) == far);
        two = Q(ask)(solver, &d, &c, NULL);
        CHECK(one.lower == two.lower && one.upper == two.upper && one.iterations == two.iterations);
    }
    memset(&w, 0, sizeof w);
    CHECK(Q(qdist_hull_prepare)(&hull, workspace, points, COUNT, Q(clock), &w, graph, QDIST_HULL_GRAPH_LEN(COUNT)) ==
          QDIST_ERROR_INTERRUPTED);
    CHECK(Q(qdist_hull_large_prepare)(&large, scratch, work, points, COUNT, Q(clock), &w, large_graph, room) ==
          QDIST_ERROR_INTERRUPTED);
    points[3] = points[0], points[4] = points[1], points[5] = points[2];
    CHECK(Q(qdist_hull_prepare)(&hull, workspace, points, 3, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(COUNT)) == QDIST_ERROR_FLAT);
}

/* An octahedron of these half axes, which counts directions that are none. */
typedef struct {
    double axes[3];
    unsigned calls, none;
} Q(tips);

static int32_t Q(octahedron)(void *user, const REAL *direction, REAL *point) {
    Q(tips) *tips = user;
    double best = -1, square = 0;
    int far = 0;
    for (int k = 0; k < 3; ++k) {
        const double height = fabs(direction[k]) * tips->axes[k];
        square += (double)direction[k] * direction[k];
        if (height > best) best = height, far = k;
    }
    ++tips->calls, tips->none += !(square > 0.25 && square < 4);
    for (int k = 0; k < 3; ++k) point[k] = (REAL)(k != far ? 0 : direction[k] < 0 ? -tips->axes[k] : tips->axes[k]);
    return 0;
}

/* An extent may be stated as loosely as you like: the answer is the same, of numbers, and nothing is asked along 0. */
static void Q(loose_extents)(qdist_solver *solver) {
    for (int k = 0; k < 150; ++k) {
        Q(tips) tips = {{1, 1, 1}, 0, 0};
        Q(qdist_box_unit) gauge = {{1, 2, 3, 0, 0, 0}, 3};
        Q(qdist_set) set;
        Q(qdist_unit) unit;
        Q(result) result;
        double sum = 0, numbers = 0;
        memset(&set, 0, sizeof set);
        set.support = Q(octahedron), set.user = &tips;
        set.extent = (REAL)(k == 0 ? 1e15 : k == 1 ? 1e7 : decade(0.5, k % 2 ? 8 : 20));
        for (int i = 0; i < 3; ++i) {
            if (k > 1) tips.axes[i] = (REAL)between(0.5, 2), gauge.half[i] = (REAL)between(0.5, 3);
            sum += (double)gauge.half[i] / tips.axes[i];
        }
        memset(&result, 0, sizeof result);
        result.struct_size = sizeof result;
        CHECK(Q(qdist_unit_box)(&unit, &gauge) == QDIST_OK);
        CHECK(Q(qdist_solve3)(solver, &set, &unit, NULL, &result) == QDIST_OK && result.outcome == QDIST_CONVERGED);
        CHECK(result.lower <= (1 + 1e-15) / sum && (1 - 1e-15) / sum <= result.upper && result.upper - result.lower <= WIDTH / sum);
        CHECK(tips.none == 0 && tips.calls == result.support_calls);
        for (int i = 0; i < 6; ++i) numbers += fabs((double)result.direction[i]) + fabs((double)result.support[i]);
        for (unsigned i = 0; i < 6 * result.point_count; ++i) numbers += fabs((double)((const REAL *)result.points)[i]);
        CHECK(numbers > 0.5 && numbers < 1000);
    }
}

/* A box whose shortcut is none: it sees every other vertex, falls short, breaks ties the other way, sees one vertex, or any. */
typedef struct {
    double half[3];
    int wrong;
} Q(shorted);

static int32_t Q(honest)(void *user, const REAL *direction, REAL *point) {
    const Q(shorted) *box = user;
    for (int k = 0; k < 3; ++k) point[k] = (REAL)(direction[k] < 0 ? -box->half[k] : box->half[k]);
    return 0;
}

static int32_t Q(shortcut)(void *user, const REAL *direction, REAL *point) {
    const Q(shorted) *box = user;
    Q(honest)(user, direction, point);
    switch (box->wrong) {
    case 0: /* vertices of an even number of signs */
        if ((point[0] < 0) ^ (point[1] < 0) ^ (point[2] < 0)) point[2] = -point[2];
        break;
    case 1:
        for (int k = 0; k < 3; ++k) point[k] *= (REAL)0.99;
        break;
    case 2:
        for (int k = 0; k < 3; ++k) point[k] = (REAL)(direction[k] <= 0 ? -box->half[k] : box->half[k]);
        break;
    case 3:
        for (int k = 0; k < 3; ++k) point[k] = (REAL)box->half[k];
        break;
    default:
        for (int k = 0; k < 3; ++k) point[k] = (REAL)(fmod(fabs((double)direction[k]) * 1e6, 2) < 1 ? box->half[k] : -box->half[k]);
    }
    return 0;
}

/* Point and witness are of one call: boxes side by side, whose depth is the least overlap along an axis. */
static void Q(wrong_shortcuts)(qdist_solver *solver) {
    const int single = sizeof(REAL) == sizeof(float);
    for (int k = 0; k < 200; ++k) {
        Q(shorted) boxes[2];
        Q(qdist_set) set;
        Q(body) bodies[2];
        Q(depth) depth;
        double overlap[3], apart[3];
        int least = 0;
        for (int which = 0; which < 2; ++which) {
            boxes[which].wrong = (int)below(5);
            for (int i = 0; i < 3; ++i) boxes[which].half[i] = (REAL)between(0.5, 1.5);
            memset(&set, 0, sizeof set);
            set.support = Q(shortcut), set.exhaustive = Q(honest), set.user = &boxes[which];
            set.extent = below(2) ? 3 : 0;
            CHECK(Q(qdist_body_set)(&bodies[which], &set) == QDIST_OK);
        }
        for (int i = 0; i < 3; ++i) {
            bodies[1].translation[i] = (REAL)between(-0.4, 0.4);
            if (i == k % 3) bodies[1].translation[i] = (REAL)(boxes[0].half[i] + boxes[1].half[i] - between(0.1, 0.4));
            apart[i] = bodies[1].translation[i];
            overlap[i] = boxes[0].half[i] + boxes[1].half[i] - fabs(apart[i]);
            if (overlap[i] < overlap[least]) least = i;
        }
        depth = Q(ask)(solver, &bodies[0], &bodies[1], NULL);
        /* (Callbacks do not tell their points in two words: float may not say it to the tolerance.) */
        CHECK(depth.lower <= overlap[least] && overlap[least] <= depth.upper && depth.upper - depth.lower <= (single ? 4 : 1) * WIDTH);
        CHECK(depth.outcome == QDIST_CONVERGED || (single && depth.outcome == QDIST_PRECISION));
        for (int i = 0; i < 3; ++i) {
            CHECK(fabs(depth.point_a[i]) <= boxes[0].half[i] + 4 * WIDTH && fabs(depth.point_b[i] - apart[i]) <= boxes[1].half[i] + 4 * WIDTH);
            CHECK(fabs(depth.point_a[i] - depth.point_b[i] - overlap[least] * depth.normal[i]) <= 2 * sqrt(WIDTH));
        }
    }
}

/* Six points that hardly differ along y: a graph as good as the list, or flat; the documented memory is enough. */
static void Q(flat_hulls)(qdist_solver *solver) {
    static const double six[18] = {-0.172454029,   7.14247108e-06, -0.678314567, 0.0897212848, 6.2423228e-06,   -0.776069701,
                                   0.815044343,    -1.74616491e-06, 0.552459776, 0.937620878,  -9.01898545e-07, -0.335757196,
                                   -0.151917607,   4.48652781e-06, -0.880699575, 0.25318408,   6.1916021e-06,   -0.743329346};
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, 4, 12)];
    const Q(qdist_box) cube = {{1, 1, 1}};
    int graphs = 0;
    for (int k = 0; k < 200; ++k) {
        const double flat = k && k % 2 ? decade(sizeof(REAL) == 8 ? -9 : -1, 1) : 1;
        REAL points[18];
        uint16_t graph[QDIST_HULL_GRAPH_LEN(6)];
        const Q(qdist_points) list = {points, 6, 3};
        Q(qdist_hull) hull;
        Q(body) a, b, c;
        Q(depth) one, two;
        qdist_solver *workspace;
        for (int i = 0; i < 18; ++i) points[i] = (REAL)(six[i] * (i % 3 == 1 ? flat : 1) * (k ? between(0.7, 1.3) : 1));
        CHECK(Q(qdist_solver_init)(memory, sizeof memory, 3, 4, 12, &workspace) == QDIST_OK);
        const qdist_status status = Q(qdist_hull_prepare)(&hull, workspace, points, 6, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(6));
        CHECK(status == QDIST_OK || status == QDIST_ERROR_FLAT);
        CHECK(k != 0 || status == QDIST_OK);
        if (status != QDIST_OK) continue;
        ++graphs;
        CHECK(Q(qdist_body_hull)(&a, &hull) == QDIST_OK && Q(qdist_body_points)(&b, &list) == QDIST_OK && Q(qdist_body_box)(&c, &cube) == QDIST_OK);
        c.translation[0] = (REAL)between(-1, 1), c.translation[1] = (REAL)0.75;
        one = Q(ask)(solver, &a, &c, NULL);
        two = Q(ask)(solver, &b, &c, NULL);
        CHECK(one.lower <= two.upper && two.lower <= one.upper && one.upper - one.lower <= 1e-3);
    }
    CHECK(graphs > 100);
}

/* Any words are a graph, and none makes a query much dearer than the list of points does: vertices that lead upwards one by one, through lists that
 * overlap and are 65,535 long; and words that mean nothing. */
static void Q(any_graph)(qdist_solver *solver) {
    enum { MOST = 400, WORDS = 2 + 1 + MOST + 4 * (MOST + 1) + 65536 };
    static REAL points[3 * MOST];
    static uint16_t words[WORDS];
    static unsigned rank[MOST], upwards[MOST];
    const Q(qdist_sphere) ball = {(REAL)0.25};
    double with = 0, without = 0;
    Q(body) a, b, c;
    CHECK(Q(qdist_body_sphere)(&c, &ball) == QDIST_OK);
    for (int k = 0; k < 60; ++k) {
        const unsigned count = 100 + below(MOST - 100);
        const int nonsense = k % 3 == 2;
        const Q(qdist_points) list = {points, count, 3};
        const Q(qdist_hull) hull = {list, words, WORDS};
        for (unsigned i = 0; i < count; ++i) rank[i] = i;
        for (unsigned i = count; i-- > 1;) {
            const unsigned j = below(i + 1), r = rank[i];
            rank[i] = rank[j], rank[j] = r;
        }
        for (unsigned i = 0; i < count; ++i) {
            upwards[rank[i]] = i;
            points[3 * i] = (REAL)((rank[i] + 0.4 * dice()) / count), points[3 * i + 1] = (REAL)(0.1 * dice() / count), points[3 * i + 2] = (REAL)(0.1 * dice() / count);
        }
        for (unsigned i = 0; i < WORDS; ++i) words[i] = (uint16_t)below(nonsense ? 2 * count : 65536);
        words[0] = (uint16_t)(nonsense ? 4 : 1), words[1] = (uint16_t)count;
        for (unsigned i = 0; !nonsense && i < count; ++i) words[3 + i] = (uint16_t)(count - rank[i]);
        if (!nonsense) words[2] = (uint16_t)upwards[0];
        for (unsigned block = 0; !nonsense && 3 + count + 4 * block + 4 <= WORDS; ++block) {
            const unsigned next = block > count + 1 ? 0 : count + 1 - block < count ? count + 1 - block : count - 1;
            uint16_t *at = words + 3 + count + 4 * block;
            at[0] = (uint16_t)(block <= count ? 65535 - below(1000) : 65535);
            for (int i = 1; i < 4; ++i) at[i] = (uint16_t)upwards[next];
        }
        CHECK(Q(qdist_body_hull)(&a, &hull) == QDIST_OK && Q(qdist_body_points)(&b, &list) == QDIST_OK);
        c.translation[0] = (REAL)between(1.3, 1.6), c.translation[1] = (REAL)(0.01 * dice());
        const clock_t start = clock();
        const Q(depth) one = Q(ask)(solver, &a, &c, NULL);
        const clock_t middle = clock();
        const Q(depth) two = Q(ask)(solver, &b, &c, NULL);
        with += (double)(middle - start), without += (double)(clock() - middle);
        CHECK(one.lower <= two.upper && two.lower <= one.upper && (nonsense || one.upper - one.lower <= 1e-3));
    }
    /* 25 products a point at most instead of one; without a bound it is thousands. */
    CHECK(with <= 100 * without + 0.05 * CLOCKS_PER_SEC);
}

/* More points than 16 bits promise, nearly all of them inside: prepared as far as words can number them, and any number in wide words. */
static void Q(many_points)(qdist_solver *solver) {
    enum { MOST = 100000 };
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, 4, 65535)];
    static REAL points[3 * MOST];
    static uint16_t graph[QDIST_HULL_GRAPH_LEN(65535)];
    static uint32_t large_graph[QDIST_HULL_LARGE_GRAPH_LEN(MOST)], scratch[QDIST_HULL_LARGE_WORKSPACE_LEN(MOST)];
    const uint32_t counts[] = {30001, 65534, 65535, MOST};
    const Q(qdist_box) cube = {{1, 1, 1}};
    qdist_solver *workspace;
    Q(qdist_hull) hull;
    Q(qdist_hull_large) large;
    Q(body) a, b, exact;
    Q(depth) depth;
    CHECK(Q(qdist_solver_init)(memory, sizeof memory, 3, 4, 65535, &workspace) == QDIST_OK);
    CHECK(Q(qdist_body_box)(&exact, &cube) == QDIST_OK);
    for (unsigned k = 0; k < sizeof counts / sizeof *counts; ++k) {
        const uint32_t count = counts[k];
        for (uint32_t i = 0; i < 3 * count; ++i) points[i] = (REAL)(0.99 * dice());
        for (uint32_t i = 0; i < 8; ++i)
            for (uint32_t j = 0; j < 3; ++j) points[3 * (count / 9 * (i + 1)) + j] = (REAL)(i >> j & 1 ? 1 : -1);
        const qdist_status status = Q(qdist_hull_prepare)(&hull, workspace, points, count, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(65535));
        CHECK(status == (count < 65535 ? QDIST_OK : count == 65535 ? QDIST_ERROR_HULL_POINTS : QDIST_ERROR_WORKSPACE_SIZE));
        CHECK(Q(qdist_hull_large_prepare)(&large, scratch, QDIST_HULL_LARGE_WORKSPACE_LEN(count), points, count, NULL, NULL, large_graph,
                                          QDIST_HULL_LARGE_GRAPH_LEN(count)) == QDIST_OK);
        for (int wide = status == QDIST_OK ? 0 : 1; wide < 2; ++wide) {
            CHECK((wide ? Q(qdist_body_hull_large)(&a, &large) : Q(qdist_body_hull)(&a, &hull)) == QDIST_OK);
            b = exact;
            b.translation[0] = (REAL)(1 + between(0.5, 0.9)), b.translation[1] = (REAL)between(-0.2, 0.2);
            depth = Q(ask)(solver, &a, &b, NULL);
            CHECK(Q(brackets)(depth.lower, depth.upper, 2 - (double)b.translation[0]) && Q(consistent)(&depth, 2));
        }
    }
}

static void Q(smoke)(void) {
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, 128, 256)];
    qdist_solver *solver = NULL;
    CHECK(Q(qdist_solver_init)(memory, BYTES(3, 128, 256), 3, 128, 256, &solver) == QDIST_OK);
    if (solver == NULL) return;
    Q(pairs)(solver);
    Q(limits)(solver);
    Q(skewed)(solver);
    Q(callbacks)(solver);
    Q(units)(solver);
    Q(loose_extents)(solver);
    Q(wrong_shortcuts)(solver);
    Q(hulls)(solver);
    Q(flat_hulls)(solver);
    Q(any_graph)(solver);
    Q(many_points)(solver);
    Q(dimensions)();
    Q(plans)();
    Q(flat)(solver);
}

#endif
