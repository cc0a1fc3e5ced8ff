/* Bodies in the plane, half spaces and hulls of two bodies through the C interface: closed forms, witnesses, bad arguments, in both
 * scalar types. Then bodies of any size, far away, on wide floors, and around one axis: random ones whose depth is a sum of a few numbers. The file includes
 * itself once for each. */
#ifndef REAL

#include "qdist.h"
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
#define WORDS QDIST_WORKSPACE_WORDS_F64
#define WIDTH 1e-6
#define MOST DBL_MAX
#define PROMISED 140
#define DECADES 308
#include "bodies.c"
#undef REAL
#undef SUFFIX
#undef WORDS
#undef WIDTH
#undef MOST
#undef PROMISED
#undef DECADES

#define REAL float
#define SUFFIX _f32
#define WORDS QDIST_WORKSPACE_WORDS_F32
#define WIDTH 1e-4
#define MOST FLT_MAX
#define PROMISED 17
#define DECADES 38
#include "bodies.c"

int main(void) {
    bodies_f64();
    bodies_f32();
    CHECK(strcmp(qdist_status_string(QDIST_ERROR_UNBOUNDED), "half space where it cannot serve") == 0);
    CHECK(strcmp(qdist_outcome_string(QDIST_UNBOUNDED), "unbounded") == 0);
    return finish("bodies");
}

#else

typedef Q(qdist_body) Q(body);
typedef Q(qdist_body2) Q(flat);
typedef Q(qdist_depth) Q(depth);

static uint64_t Q(memory2)[WORDS(2, 32, 32)], Q(memory3)[WORDS(3, 128, 256)];
static qdist_solver *Q(solver2), *Q(solver3);

static Q(depth) Q(in_plane)(const Q(flat) *a, const Q(flat) *b) {
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_depth2)(Q(solver2), a, b, NULL, &depth) == QDIST_OK);
    CHECK(depth.normal[2] == 0 && depth.point_a[2] == 0 && depth.point_b[2] == 0);
    return depth;
}

static Q(depth) Q(in_space)(const Q(body) *a, const Q(body) *b) {
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_depth3)(Q(solver3), a, b, NULL, &depth) == QDIST_OK);
    return depth;
}

/* The bracket contains d, is narrow, the outcome fits, and the points are depth * normal apart. */
static void Q(expect)(const Q(depth) *depth, double d, int line) {
    const double slack = WIDTH * fabs(d) + 0.25 * WIDTH;
    double off = 0;
    int i;
    check(depth->lower <= d && d <= depth->upper, "the bracket holds", __FILE__, line);
    check(depth->upper - depth->lower <= slack, "the bracket is narrow", __FILE__, line);
    if (d > 0) {
        const int met = depth->upper - depth->lower <= WIDTH * depth->lower;
        check(depth->outcome == (met ? QDIST_CONVERGED : QDIST_PRECISION), "the outcome fits", __FILE__, line);
    } else {
        check(depth->outcome == (d < 0 ? QDIST_SEPARATED : QDIST_TOUCHING), "the outcome fits", __FILE__, line);
    }
    for (i = 0; i < 3; ++i) off = fmax(off, fabs(depth->point_a[i] - depth->point_b[i] - d * depth->normal[i]));
    check(off <= 4 * sqrt(slack), "the points are depth * normal apart", __FILE__, line);
}

static void Q(place)(Q(flat) *body, double c, double s, double x, double y) {
    body->rotation[0] = body->rotation[3] = (REAL)c;
    body->rotation[2] = (REAL)s;
    body->rotation[1] = -body->rotation[2];
    body->translation[0] = (REAL)x;
    body->translation[1] = (REAL)y;
}

static void Q(plane_shapes)(void) {
    const Q(qdist_disc) disc = {0.5f};
    const Q(qdist_box2) box = {{1, 2}};
    const Q(qdist_ellipse) ellipse = {{2, 1}};
    const Q(qdist_capsule2) capsule = {0.5f, 2};
    /* A triangle, in any order, with a point inside. */
    const REAL corners[] = {0, 0, 4, 0, 0, 3, 1, 1};
    const REAL far_corners[] = {1000, 1000, 1004, 1000, 1000, 1003};
    const Q(qdist_points) triangle = {corners, 4, 2}, far_triangle = {far_corners, 3, 2};
    Q(flat) a, b;
    Q(depth) depth;

    CHECK(Q(qdist_body2_disc)(&a, &disc) == QDIST_OK && Q(qdist_body2_disc)(&b, &disc) == QDIST_OK);
    Q(place)(&b, 1, 0, 0.75, 0);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, 0.25, __LINE__);
    CHECK(depth.normal[0] == 1 && depth.dimension <= 2);
    Q(place)(&b, 1, 0, 3, 4);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, -4, __LINE__);

    CHECK(Q(qdist_body2_box)(&a, &box) == QDIST_OK);
    Q(place)(&b, 1, 0, 1.25, 0.5);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, 0.25, __LINE__);
    Q(place)(&a, 0, 1, 0, 0); /* a quarter turn: 2 wide and 1 high */
    Q(place)(&b, 1, 0, 2.25, 0.5);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, 0.25, __LINE__);
    CHECK(Q(qdist_body2_box)(&b, &box) == QDIST_OK);
    Q(place)(&b, 1, 0, 3, 0);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, 0, __LINE__);

    CHECK(Q(qdist_body2_ellipse)(&a, &ellipse) == QDIST_OK && Q(qdist_body2_disc)(&b, &disc) == QDIST_OK);
    Q(place)(&b, 1, 0, 3.5, 0);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, -1, __LINE__);

    CHECK(Q(qdist_body2_capsule)(&a, &capsule) == QDIST_OK);
    Q(place)(&b, 1, 0, 3, 6); /* from (0, 2): (3, 4) */
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, -4, __LINE__);

    /* The hypotenuse 3 x + 4 y = 12; along its normal (0.6, 0.8), disc's centre 0.25 outside. */
    CHECK(Q(qdist_body2_points)(&a, &triangle) == QDIST_OK);
    Q(place)(&b, 1, 0, 2 + 0.15, 1.5 + 0.2);
    depth = Q(in_plane)(&a, &b);
    CHECK(depth.lower <= 0.25 + WIDTH && depth.upper >= 0.25 - WIDTH && depth.upper - depth.lower <= WIDTH);
    CHECK(fabs(depth.normal[0] - 0.6) < 1e-3 && fabs(depth.normal[1] - 0.8) < 1e-3);
    CHECK(Q(qdist_body2_points)(&a, &far_triangle) == QDIST_OK && a.spread > 0);
    Q(place)(&a, 1, 0, -1000, -1000);
    Q(place)(&b, 1, 0, 2, -0.25);
    depth = Q(in_plane)(&a, &b);
    Q(expect)(&depth, 0.25, __LINE__);

    /* Any set: the triangle by the support function of lists of any dimension. */
    {
        Q(qdist_set) set;
        CHECK(Q(qdist_set_points)(&set, &triangle) == QDIST_OK && Q(qdist_body2_set)(&a, &set) == QDIST_OK);
        depth = Q(in_plane)(&a, &b);
        Q(expect)(&depth, 0.25, __LINE__);
    }
}

static void Q(plane_arguments)(void) {
    const Q(qdist_disc) disc = {1}, negative = {-1};
    const REAL corners[] = {0, 0, 0, 4, 0, 0};
    const Q(qdist_points) in_space = {corners, 2, 3};
    const Q(qdist_half_plane) none = {{0, 0}, 1};
    Q(flat) a, b;
    Q(qdist_join2) join;
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_body2_disc)(NULL, &disc) == QDIST_ERROR_NULL && Q(qdist_body2_disc)(&a, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_body2_disc)(&a, &negative) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_body2_points)(&a, &in_space) == QDIST_ERROR_DIMENSION);
    CHECK(Q(qdist_body2_half_plane)(&a, &none) == QDIST_ERROR_ARGUMENT);
    CHECK(Q(qdist_body2_disc)(&a, &disc) == QDIST_OK && Q(qdist_body2_disc)(&b, &disc) == QDIST_OK);
    CHECK(Q(qdist_depth2)(Q(solver3), &a, &b, NULL, &depth) == QDIST_ERROR_DIMENSION);
    CHECK(Q(qdist_depth2)(Q(solver2), NULL, &b, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_depth2)(Q(solver2), &a, &b, NULL, NULL) == QDIST_ERROR_NULL);
    b.rotation[3] = -1; /* a mirror */
    CHECK(Q(qdist_depth2)(Q(solver2), &a, &b, NULL, &depth) == QDIST_ERROR_ROTATION);
    b.rotation[3] = 1;
    b.translation[1] = (REAL)NAN;
    CHECK(Q(qdist_depth2)(Q(solver2), &a, &b, NULL, &depth) == QDIST_ERROR_NONFINITE);
    b.translation[1] = 0;
    depth.struct_size = 1;
    CHECK(Q(qdist_depth2)(Q(solver2), &a, &b, NULL, &depth) == QDIST_ERROR_STRUCT_SIZE);
    join.a = &a;
    join.b = NULL;
    CHECK(Q(qdist_body2_join)(&b, &join) == QDIST_ERROR_NULL && Q(qdist_body2_join)(&b, NULL) == QDIST_ERROR_NULL);
}

static void Q(half_planes)(void) {
    const Q(qdist_half_plane) ground = {{0, 2}, 1}; /* y <= 1/2 */
    const Q(qdist_box2) box = {{1, 1}};
    Q(qdist_join2) join;
    Q(flat) a, b, c;
    Q(depth) depth;
    CHECK(Q(qdist_body2_half_plane)(&a, &ground) == QDIST_OK && Q(qdist_body2_box)(&b, &box) == QDIST_OK);
    Q(place)(&b, 0.6, 0.8, 100, 1.5); /* reaches 1.4 down */
    depth = Q(in_plane)(&b, &a);
    CHECK(fabs(depth.lower - 0.4) < WIDTH && fabs(depth.upper - 0.4) < WIDTH && depth.outcome == QDIST_CONVERGED);
    CHECK(depth.normal[1] == -1 && fabs(depth.point_b[1] - 0.5) < WIDTH && depth.support_calls == 1);
    depth = Q(in_plane)(&a, &b);
    CHECK(depth.normal[1] == 1 && fabs(depth.point_a[1] - 0.5) < WIDTH);
    depth = Q(in_plane)(&a, &a);
    CHECK(depth.outcome == QDIST_UNBOUNDED && depth.lower == MOST && depth.upper == MOST);
    join.a = &a;
    join.b = &b;
    CHECK(Q(qdist_body2_join)(&c, &join) == QDIST_ERROR_UNBOUNDED);
}

static void Q(half_spaces)(void) {
    const Q(qdist_half_space) ground = {{0, 0, 1}, 0}, ceiling = {{0, 0, -1}, -3}, bad = {{0, 0, (REAL)NAN}, 0};
    const Q(qdist_sphere) ball = {0.5f};
    const Q(qdist_box) box = {{1, 1, 1}};
    Q(qdist_options) options;
    Q(qdist_result) result;
    Q(body) a, b, c;
    Q(depth) depth;
    CHECK(Q(qdist_body_half_space)(&a, &bad) == QDIST_ERROR_NONFINITE && Q(qdist_body_half_space)(&a, NULL) == QDIST_ERROR_NULL);
    CHECK(Q(qdist_body_half_space)(&a, &ground) == QDIST_OK && Q(qdist_body_sphere)(&b, &ball) == QDIST_OK);
    b.translation[0] = 10000;
    b.translation[2] = 0.375f;
    depth = Q(in_space)(&b, &a);
    Q(expect)(&depth, 0.125, __LINE__);
    CHECK(depth.normal[2] == -1 && depth.point_b[2] == 0 && depth.upper - depth.lower <= 0.1 * WIDTH);
    b.translation[2] = 0.5f;
    depth = Q(in_space)(&a, &b);
    Q(expect)(&depth, 0, __LINE__);
    b.translation[2] = 2.5f;
    depth = Q(in_space)(&a, &b);
    Q(expect)(&depth, -2, __LINE__);
    CHECK(Q(qdist_body_box)(&b, &box) == QDIST_OK);
    a.translation[2] = 0.75f;
    depth = Q(in_space)(&b, &a);
    Q(expect)(&depth, 1.75, __LINE__);
    CHECK(Q(qdist_options_default)(&options) == QDIST_OK);
    options.use_threshold = 1;
    options.threshold = 2;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_depth3)(Q(solver3), &b, &a, &options, &depth) == QDIST_OK && depth.outcome == QDIST_BELOW);
    options.relative = -1;
    CHECK(Q(qdist_depth3)(Q(solver3), &b, &a, &options, &depth) == QDIST_ERROR_ARGUMENT);
    a.rotation[0] = 2;
    CHECK(Q(qdist_depth3)(Q(solver3), &b, &a, NULL, &depth) == QDIST_ERROR_ROTATION);
    a.rotation[0] = 1;
    a.translation[2] = 0;
    /* Floor and ceiling, 3 apart. */
    CHECK(Q(qdist_body_half_space)(&c, &ceiling) == QDIST_OK);
    depth = Q(in_space)(&a, &c);
    Q(expect)(&depth, -3, __LINE__);
    depth = Q(in_space)(&a, &a);
    CHECK(depth.outcome == QDIST_UNBOUNDED && depth.lower == MOST && depth.upper == MOST);
    /* As a set of a query it says what it is. */
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_solve3)(Q(solver3), &a.set, NULL, NULL, &result) == QDIST_ERROR_CALLBACK);
    CHECK(result.callback_code == QDIST_ERROR_UNBOUNDED);
}

static void Q(joins)(void) {
    const Q(qdist_sphere) big = {1}, small = {0.5f}, probe_ball = {0.25f};
    const Q(qdist_cylinder) disc = {1, 0}, lid = {0.5f, 0};
    const Q(qdist_box) box = {{1, 1, 1}};
    const Q(qdist_half_space) ground = {{0, 0, 1}, 0};
    Q(body) a, b, c, probe, hull, outer;
    Q(qdist_join) join, again;
    Q(depth) depth;
    CHECK(Q(qdist_body_sphere)(&a, &big) == QDIST_OK && Q(qdist_body_sphere)(&b, &small) == QDIST_OK);
    CHECK(Q(qdist_body_sphere)(&probe, &probe_ball) == QDIST_OK);
    b.translation[2] = 4;
    join.a = &a;
    join.b = &b;
    CHECK(Q(qdist_body_join)(&hull, &join) == QDIST_OK);
    CHECK(hull.set.radius == 0.5f && hull.symmetry == QDIST_SYMMETRY_AXIS && hull.set.exhaustive == NULL);
    /* Over the tip, beside the big ball, and on the axis inside: 1.125 at z = 1, since the side leans by 1/8. */
    probe.translation[2] = 5;
    depth = Q(in_space)(&hull, &probe);
    Q(expect)(&depth, -0.25, __LINE__);
    probe.translation[2] = -1;
    depth = Q(in_space)(&hull, &probe);
    Q(expect)(&depth, 0.25, __LINE__);
    probe.translation[2] = 1;
    depth = Q(in_space)(&hull, &probe);
    CHECK(fabs(depth.upper - (1 - 0.125 + 0.25)) <= 4 * WIDTH);
    /* Below, it stands in the ground. */
    CHECK(Q(qdist_body_half_space)(&c, &ground) == QDIST_OK);
    hull.translation[2] = 0.75f;
    depth = Q(in_space)(&hull, &c);
    Q(expect)(&depth, 0.25, __LINE__);
    again.a = &hull;
    again.b = &c;
    CHECK(Q(qdist_body_join)(&outer, &again) == QDIST_ERROR_UNBOUNDED);

    /* A frustum of two discs: the lid at z = 1. */
    CHECK(Q(qdist_body_cylinder)(&a, &disc) == QDIST_OK && Q(qdist_body_cylinder)(&b, &lid) == QDIST_OK);
    b.translation[2] = 1;
    CHECK(Q(qdist_body_join)(&hull, &join) == QDIST_OK && hull.set.radius == 0);
    probe.translation[2] = 1.125f;
    depth = Q(in_space)(&hull, &probe);
    Q(expect)(&depth, 0.125, __LINE__);

    /* A box swept along x, then joined with itself turned upside down: the same set. */
    CHECK(Q(qdist_body_box)(&a, &box) == QDIST_OK && Q(qdist_body_box)(&b, &box) == QDIST_OK);
    b.translation[0] = 4;
    CHECK(Q(qdist_body_join)(&hull, &join) == QDIST_OK && hull.symmetry == QDIST_SYMMETRY_NONE);
    again.a = again.b = &hull;
    CHECK(Q(qdist_body_join)(&outer, &again) == QDIST_OK);
    probe.translation[0] = 2;
    depth = Q(in_space)(&outer, &probe);
    Q(expect)(&depth, 0.125, __LINE__);
    CHECK(Q(qdist_body_join)(&hull, NULL) == QDIST_ERROR_NULL && Q(qdist_body_join)(NULL, &join) == QDIST_ERROR_NULL);
    b.rotation[0] = 2;
    CHECK(Q(qdist_body_join)(&hull, &join) == QDIST_ERROR_ROTATION);
}

/* Sets of any dimension, by lists of one point: a unit ball at 6 on the first axis, and one of radius 1/2 at 2. */
static void Q(joined_sets)(void) {
    static uint64_t memory[WORDS(4, 64, 256)];
    const REAL near[] = {2, 0, 0, 0}, far[] = {6, 0, 0, 0};
    const Q(qdist_points) large = {far, 1, 4}, tip = {near, 1, 4};
    qdist_solver *solver;
    Q(qdist_set) a, b, join, unknown;
    Q(qdist_pair) pair;
    Q(qdist_result) result;
    CHECK(Q(qdist_solver_init)(memory, sizeof memory, 4, 64, 256, &solver) == QDIST_OK);
    CHECK(Q(qdist_set_points)(&a, &large) == QDIST_OK && Q(qdist_set_points)(&b, &tip) == QDIST_OK);
    a.radius = 1;
    b.radius = 0.5f;
    pair.a = &a;
    pair.b = &b;
    pair.dimension = 4;
    CHECK(Q(qdist_set_join)(&join, &pair) == QDIST_OK && join.radius == 0.5f);
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(Q(qdist_solve4)(solver, &join, NULL, NULL, &result) == QDIST_OK);
    CHECK(result.lower <= -1.5 && -1.5 <= result.upper && result.upper - result.lower <= 2 * WIDTH);
    unknown = a;
    unknown.extent = 0;
    pair.a = &unknown;
    CHECK(Q(qdist_set_join)(&join, &pair) == QDIST_ERROR_ARGUMENT && Q(qdist_set_join)(&join, NULL) == QDIST_ERROR_NULL);
}

static void Q(joins_in_plane)(void) {
    const Q(qdist_disc) big = {1}, small = {0.5f};
    Q(qdist_join2) join;
    Q(flat) a, b, hull, probe;
    Q(depth) depth;
    CHECK(Q(qdist_body2_disc)(&a, &big) == QDIST_OK && Q(qdist_body2_disc)(&b, &small) == QDIST_OK);
    CHECK(Q(qdist_body2_disc)(&probe, &small) == QDIST_OK);
    b.translation[0] = 4;
    join.a = &a;
    join.b = &b;
    CHECK(Q(qdist_body2_join)(&hull, &join) == QDIST_OK && hull.set.radius == 0.5f);
    probe.translation[0] = 6;
    depth = Q(in_plane)(&hull, &probe);
    Q(expect)(&depth, -1, __LINE__);
    probe.translation[0] = -1;
    depth = Q(in_plane)(&hull, &probe);
    Q(expect)(&depth, 0.5, __LINE__);
}

/* Two ellipsoids of the same axes, one measured from a point that is not its center: the same point of the world as the other's center. */
static void Q(ellipsoids_from_elsewhere)(void) {
    const Q(qdist_ellipsoid) shape = {{1, 2, 3}};
    Q(body) a, b;
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_body_ellipsoid)(&a, &shape) == QDIST_OK && Q(qdist_body_ellipsoid)(&b, &shape) == QDIST_OK);
    b.translation[0] = -0.25f;
    b.center[0] = 0.25f;
    b.spread = 3.25f;
    CHECK(Q(qdist_depth3)(Q(solver3), &a, &b, NULL, &depth) == QDIST_OK);
    CHECK(depth.lower <= 1.75 && 1.75 <= depth.upper);
}

/* Turned boxes that overlap by a thousand roundoffs of their size. */
static void Q(shallow)(void) {
    const Q(qdist_box) shape = {{1, 1, 1}};
    const double c = 0.8, s = 0.6;
    Q(body) a, b;
    Q(depth) depth;
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    CHECK(Q(qdist_body_box)(&a, &shape) == QDIST_OK && Q(qdist_body_box)(&b, &shape) == QDIST_OK);
    b.rotation[0] = (REAL)c;
    b.rotation[1] = (REAL)-s;
    b.rotation[3] = (REAL)s;
    b.rotation[4] = (REAL)c;
    b.translation[0] = (REAL)2.399;
    b.translation[1] = (REAL)0.2;
    CHECK(a.precise != NULL && Q(qdist_depth3)(Q(solver3), &a, &b, NULL, &depth) == QDIST_OK);
    CHECK(depth.outcome == QDIST_CONVERGED && depth.lower > 9.99e-4 && depth.upper < 1.001e-3);
}

/* ------------------------------------------------------------------------------------------------------------ random bodies */

/* The shapes that the bodies of a pair are made of. */
static struct {
    Q(qdist_box) box;
    Q(qdist_sphere) ball;
    Q(qdist_ellipsoid) egg;
    Q(qdist_cylinder) cylinder;
    Q(qdist_capsule) capsule;
} Q(shapes)[2];

/* A body that reaches `half` along x, at a point of the axis, and at least half as far across. Two of them, t apart along x, have the depth S - t, where S
 * is the sum of their halves and t > 3/4 S: a direction of cosine c to x has a height of at least S sqrt(1/4 + 3/4 c^2) - t c, which falls towards c = 1. */
static qdist_status Q(along_x)(Q(body) *body, int which, REAL half) {
    const REAL p = half * (REAL)between(0.5, 2), q = half * (REAL)between(0.5, 2);
    const Q(qdist_box) box = {{half, p, q}};
    const Q(qdist_ellipsoid) egg = {{half, p, q}};
    Q(shapes)[which].box = box, Q(shapes)[which].egg = egg;
    Q(shapes)[which].ball.radius = Q(shapes)[which].cylinder.radius = Q(shapes)[which].capsule.radius = half;
    Q(shapes)[which].cylinder.half_height = Q(shapes)[which].capsule.half_height = p;
    switch (below(5)) {
    case 0: return Q(qdist_body_box)(body, &Q(shapes)[which].box);
    case 1: return Q(qdist_body_sphere)(body, &Q(shapes)[which].ball);
    case 2: return Q(qdist_body_ellipsoid)(body, &Q(shapes)[which].egg);
    case 3: return Q(qdist_body_cylinder)(body, &Q(shapes)[which].cylinder);
    default: return Q(qdist_body_capsule)(body, &Q(shapes)[which].capsule);
    }
}

static int Q(finite)(const Q(depth) *depth) {
    double sum = fabs((double)depth->lower) / MOST + fabs((double)depth->upper) / MOST;
    for (int i = 0; i < 3; ++i) {
        sum += fabs((double)depth->normal[i]);
        sum += (fabs((double)depth->point_a[i]) + fabs((double)depth->point_b[i])) / MOST;
    }
    return sum < 20;
}

/* Any size that the header promises, from one end to the other: the right depth, converged. */
static void Q(sizes)(void) {
    for (int k = 0; k < 150; ++k) {
        const double size = k < 10 ? pow(10, k % 2 ? -PROMISED : PROMISED) : decade(-PROMISED, PROMISED);
        const REAL p = (REAL)(size * between(0.5, 1)), q = (REAL)(size * between(0.5, 1));
        const REAL at = (REAL)((double)p + (double)q + size * between(-0.1, 0.05));
        const long double truth = (long double)p + (long double)q - (long double)at;
        Q(body) a, b;
        Q(depth) depth;
        CHECK(Q(along_x)(&a, 0, p) == QDIST_OK && Q(along_x)(&b, 1, q) == QDIST_OK);
        b.translation[0] = at;
        depth = Q(in_space)(&a, &b);
        CHECK(depth.lower <= truth && truth <= depth.upper && Q(finite)(&depth));
        CHECK(depth.upper - depth.lower <= (REAL)(WIDTH * size) && fabs(depth.normal[0] - 1) < 1e-5);
        CHECK(depth.outcome == (truth > 0 ? QDIST_CONVERGED : QDIST_SEPARATED) || sizeof(REAL) == sizeof(float));
        CHECK(depth.outcome != QDIST_DEGENERATE && depth.outcome != QDIST_SUPPORT_FAILED);
    }
}

/* Sizes and places up to the ends of the format: a status that says so, or a true answer. */
static void Q(ends_of_the_format)(void) {
    int answered = 0, refused = 0;
    for (int k = 0; k < 300; ++k) {
        const double size = decade(k % 2 ? -PROMISED : PROMISED, k % 2 ? PROMISED : DECADES - 0.5), far = decade(PROMISED, DECADES + 0.2);
        const REAL p = (REAL)(size * between(0.5, 1)), q = (REAL)(size * between(0.5, 1));
        Q(body) a, b;
        Q(depth) depth;
        const qdist_status one = Q(along_x)(&a, 0, p), two = Q(along_x)(&b, 1, q);
        CHECK((one == QDIST_OK || one == QDIST_ERROR_NONFINITE) && (two == QDIST_OK || two == QDIST_ERROR_NONFINITE));
        if (one != QDIST_OK || two != QDIST_OK) {
            ++refused;
            continue;
        }
        a.translation[0] = (REAL)(k % 3 == 0 ? 0 : -far);
        b.translation[0] = (REAL)(k % 3 == 2 ? -far : far * 0.75);
        memset(&depth, 0, sizeof depth);
        depth.struct_size = sizeof depth;
        const qdist_status status = Q(qdist_depth3)(Q(solver3), &a, &b, NULL, &depth);
        const long double truth = (long double)p + (long double)q - ((long double)b.translation[0] - (long double)a.translation[0]);
        CHECK(status == QDIST_OK || status == QDIST_ERROR_NONFINITE);
        if (status != QDIST_OK) {
            ++refused;
            continue;
        }
        ++answered;
        CHECK(Q(finite)(&depth) && depth.lower <= depth.upper);
        if (k % 3 != 2 && far > 8 * size) {
            CHECK(depth.lower <= truth && truth <= depth.upper && depth.outcome == QDIST_SEPARATED);
            CHECK(depth.upper - depth.lower <= 1e-5 * -truth);
        }
    }
    CHECK(answered >= 100 && refused >= 10);
}

/* A cube by its corners, far away in its own frame and brought back by its pose: witnesses are as accurate as the bracket. */
static void Q(hulls_far_from_their_frame)(void) {
    const Q(qdist_box) cube = {{1, 1, 1}};
    const double near = sizeof(REAL) == 8 ? 1e-12 : 1e-4;
    for (int k = 0; k < 100; ++k) {
        REAL corners[24];
        const Q(qdist_points) list = {corners, 8, 3};
        Q(body) a, b;
        Q(depth) depth;
        double far[3], at[3];
        for (int i = 0; i < 3; ++i) far[i] = floor(decade(2, sizeof(REAL) == 8 ? 9 : 6)) * (below(2) ? 1 : -1);
        for (int i = 0; i < 24; ++i) corners[i] = (REAL)(far[i % 3] + 2 * (i / 3 >> i % 3 & 1));
        CHECK(Q(qdist_body_points)(&a, &list) == QDIST_OK && Q(qdist_body_box)(&b, &cube) == QDIST_OK && a.spread > 0);
        at[0] = 1.25 + below(32) / 64.0, at[1] = below(32) / 64.0 - 0.25, at[2] = -0.5;
        for (int i = 0; i < 3; ++i) a.translation[i] = (REAL)(-far[i] - 1), b.translation[i] = (REAL)at[i];
        depth = Q(in_space)(&a, &b);
        CHECK(depth.lower <= 2 - at[0] && 2 - at[0] <= depth.upper && depth.upper - depth.lower <= near);
        for (int i = 0; i < 3; ++i) {
            CHECK(fabs(depth.point_a[i]) <= 1 + near && fabs(depth.point_b[i] - at[i]) <= 1 + near);
            CHECK(fabs(depth.point_a[i] - depth.point_b[i] - (i == 0 ? 2 - at[0] : 0)) <= near);
        }
    }
}

/* Boxes of half extents l, l and h in any order of axes, and what stands in them: known to a share of the depth, not of l. */
static void Q(wide_floors)(void) {
    for (int k = 0; k < 100; ++k) {
        const double wide = sizeof(REAL) == 8 ? 1e6 : 1;
        const int given = k < 4; /* a cube of 2 cm, 1 mm deep */
        const double l = (given ? pow(10, k) : decade(0.5, 3)) * wide, h = given ? 0.1 : between(0.05, 0.3), size = given ? 0.01 : between(0.005, 0.05);
        const int up = k % 3;
        Q(qdist_box) floor, cube = {{(REAL)size, (REAL)size, (REAL)size}};
        Q(body) a, b;
        Q(depth) depth;
        for (int i = 0; i < 3; ++i) floor.half[i] = (REAL)(i == up ? h : l);
        CHECK(Q(qdist_body_box)(&a, &floor) == QDIST_OK && Q(qdist_body_box)(&b, &cube) == QDIST_OK);
        for (int i = 0; i < 3; ++i) b.translation[i] = (REAL)(i == up ? h + size - (given ? 1e-3 : between(1e-3, 4e-3)) : between(-0.6, 0.6) * l);
        const double truth = (double)((long double)floor.half[up] + (long double)cube.half[0] - (long double)b.translation[up]);
        depth = k % 2 ? Q(in_space)(&b, &a) : Q(in_space)(&a, &b);
        CHECK(depth.lower <= truth && truth <= depth.upper && depth.upper - depth.lower < 0.01 * truth + (l < 10 * h ? 4e-5 : 0));
        CHECK(fabs(fabs(depth.normal[up]) - 1) < 1e-5);
    }
}

/* A wide triangle and a small box through it: no such pair is flat, and d is the box's half extent less the distance of its centre. */
static void Q(wide_triangles)(void) {
    for (int k = 0; k < 100; ++k) {
        const double l = k ? decade(0, 5) : 1e4, size = k ? between(0.01, 1) : 0.1;
        const int up = k % 3, x = (up + 1) % 3, y = (up + 2) % 3;
        const Q(qdist_box) box = {{(REAL)size, (REAL)size, (REAL)size}};
        REAL corners[9] = {0};
        const Q(qdist_points) list = {corners, 3, 3};
        Q(body) a, b;
        Q(depth) depth;
        corners[x] = corners[y] = corners[3 + y] = (REAL)-l, corners[3 + x] = corners[6 + y] = (REAL)l;
        CHECK(Q(qdist_body_points)(&a, &list) == QDIST_OK && Q(qdist_body_box)(&b, &box) == QDIST_OK);
        b.translation[x] = (REAL)(0.1 * l), b.translation[y] = (REAL)(-0.5 * l), b.translation[up] = (REAL)(k ? size * between(-0.9, 0.9) : 0.05);
        const double truth = (double)((long double)box.half[0] - fabsl((long double)b.translation[up]));
        depth = k % 2 ? Q(in_space)(&b, &a) : Q(in_space)(&a, &b);
        CHECK(depth.lower <= truth && truth <= depth.upper && depth.upper - depth.lower < 1e-4 * size && depth.outcome != QDIST_DEGENERATE);
    }
}

/* Arcs of minimisers, in the memory of README's table: a corner on the axis of a cylinder, cylinders about nearly the same axis, equal ellipsoids. (Float
 * may fill that memory before it is as narrow as asked for.) */
static void Q(arcs)(void) {
    static uint64_t memory[WORDS(3, 64, 128)];
    qdist_solver *const usual = Q(solver3);
    const int exact = sizeof(REAL) == 8;
    CHECK(Q(qdist_solver_init)(memory, sizeof memory, 3, 64, 128, &Q(solver3)) == QDIST_OK);
    for (int k = 0; k < 100; ++k) {
        const REAL size = (REAL)(k ? between(1, 3) : 1), corners[12] = {0, 0, 0, size, 0, 0, 0, size, 0, 0, 0, size};
        const Q(qdist_points) list = {corners, 4, 3};
        const Q(qdist_cylinder) post = {(REAL)(k ? between(0.05, 0.2) : 0.1), (REAL)(k ? between(0.2, 0.4) : 0.2)};
        const Q(qdist_cylinder) outer = {1, 1}, inner = {(REAL)0.99, (REAL)1.5};
        const Q(qdist_ellipsoid) egg = {{(REAL)(k ? between(0.1, 2) : 0.5), (REAL)(k ? between(0.1, 2) : 0.7), (REAL)(k ? between(0.1, 2) : 0.9)}};
        const double off = k ? decade(-14, -3) : 0, least = fmin(egg.semi_axes[0], fmin(egg.semi_axes[1], egg.semi_axes[2]));
        const double round = exact ? 1e-15 : 1e-6;
        Q(body) a, b;
        Q(depth) depth;
        CHECK(Q(qdist_body_points)(&a, &list) == QDIST_OK && Q(qdist_body_cylinder)(&b, &post) == QDIST_OK);
        depth = k % 2 ? Q(in_space)(&b, &a) : Q(in_space)(&a, &b);
        CHECK(depth.lower <= post.radius && post.radius <= depth.upper && depth.upper - depth.lower <= (exact ? WIDTH : 2e-3) * depth.upper);
        CHECK(depth.outcome == QDIST_CONVERGED || !exact);

        /* Beside each other, then tilted: the plane across one axis cuts a disc of its own radius out of the other. */
        CHECK(Q(qdist_body_cylinder)(&a, &outer) == QDIST_OK && Q(qdist_body_cylinder)(&b, &inner) == QDIST_OK);
        for (int tilted = 0; tilted < 2; ++tilted) {
            const double truth = (double)inner.radius + 1 - (tilted ? 0 : (double)(REAL)off);
            b.translation[0] = (REAL)(tilted ? 0 : off);
            b.rotation[4] = b.rotation[8] = (REAL)(tilted ? cos(off) : 1);
            b.rotation[7] = (REAL)(tilted ? sin(off) : 0), b.rotation[5] = -b.rotation[7];
            depth = k % 2 ? Q(in_space)(&b, &a) : Q(in_space)(&a, &b);
            CHECK(depth.lower <= truth + round && truth - round <= depth.upper && depth.upper - depth.lower <= 1e-4);
            CHECK(depth.outcome == QDIST_CONVERGED || !exact);
        }

        CHECK(Q(qdist_body_ellipsoid)(&a, &egg) == QDIST_OK && Q(qdist_body_ellipsoid)(&b, &egg) == QDIST_OK);
        depth = Q(in_space)(&a, &b);
        CHECK(depth.lower <= 2 * least && 2 * least <= depth.upper && depth.upper - depth.lower <= (exact ? WIDTH : 1e-2) * least);
        CHECK(depth.outcome == QDIST_CONVERGED || !exact);
    }
    Q(solver3) = usual;
}

static void JOIN(bodies, SUFFIX)(void) {
    CHECK(Q(qdist_solver_init)(Q(memory2), sizeof Q(memory2), 2, 32, 32, &Q(solver2)) == QDIST_OK);
    CHECK(Q(qdist_solver_init)(Q(memory3), sizeof Q(memory3), 3, 128, 256, &Q(solver3)) == QDIST_OK);
    Q(plane_shapes)();
    Q(plane_arguments)();
    Q(half_planes)();
    Q(half_spaces)();
    Q(joins)();
    Q(joins_in_plane)();
    Q(joined_sets)();
    Q(ellipsoids_from_elsewhere)();
    Q(shallow)();
    Q(sizes)();
    Q(ends_of_the_format)();
    Q(hulls_far_from_their_frame)();
    Q(wide_floors)();
    Q(wide_triangles)();
    Q(arcs)();
}

#endif
