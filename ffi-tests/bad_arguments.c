/* Every wrong argument has its status, and a call that fails writes nothing. */
#include "qdist.h"
#include "test.h"

#include <math.h>
#include <string.h>

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 128)];
static uint64_t other[QDIST_WORKSPACE_WORDS_F64(3, 64, 128)];

static const double BAD[] = {NAN, INFINITY, -INFINITY};

/* One struct of every kind, all valid. */
static qdist_sphere_f64 sphere = {1};
static qdist_box_f64 box = {{1, 1, 1}};
static qdist_ellipsoid_f64 ellipsoid = {{1, 1, 1}};
static qdist_cylinder_f64 cylinder = {1, 1};
static qdist_capsule_f64 capsule = {1, 1};
static qdist_cone_f64 cone = {1, 1};
static double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

static void memory_and_handles(void) {
    const uint32_t bytes = QDIST_WORKSPACE_BYTES_F64(3, 64, 128);
    qdist_solver *const untouched = (qdist_solver *)corners;
    qdist_solver *solver = untouched, *solver32 = NULL, *solver6 = NULL;
    uint64_t junk[4] = {0, 0, 0, 0};
    qdist_body_f64 a;
    qdist_body_f32 a32;
    const qdist_box_f32 box32 = {{1, 1, 1}};
    qdist_depth_f64 depth;
    qdist_depth_f32 depth32;
    qdist_result_f64 result;
    uint32_t n = 7, dimension;

    CHECK(qdist_solver_init_f64(NULL, bytes, 3, 64, 128, &solver) == QDIST_ERROR_NULL);
    CHECK(qdist_solver_init_f64(memory, bytes, 3, 64, 128, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_solver_init_f64(memory, bytes - 1, 3, 64, 128, &solver) == QDIST_ERROR_WORKSPACE_SIZE);
    CHECK(qdist_solver_init_f64(memory, 0, 3, 64, 128, &solver) == QDIST_ERROR_WORKSPACE_SIZE);
    CHECK(qdist_solver_init_f64((char *)memory + 4, bytes, 3, 64, 128, &solver) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_solver_init_f64((char *)memory + 1, bytes, 3, 64, 128, &solver) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_solver_init_f32((char *)memory + 4, bytes, 3, 64, 128, &solver) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_solver_init_f64(memory, bytes, 3, 3, 128, &solver) == QDIST_ERROR_CAPACITY);
    CHECK(qdist_solver_init_f64(memory, bytes, 3, 64, 5, &solver) == QDIST_ERROR_CAPACITY);
    CHECK(qdist_solver_init_f64(memory, bytes, 3, 65536, 128, &solver) == QDIST_ERROR_CAPACITY);
    CHECK(qdist_solver_init_f64(memory, UINT32_MAX, 3, 64, UINT32_MAX, &solver) == QDIST_ERROR_CAPACITY);
    CHECK(solver == untouched);
    CHECK(memory[0] == 0);

    for (dimension = 0; dimension < 12; ++dimension) {
        const int known = dimension >= 2 && dimension <= 6;
        n = 7;
        CHECK(qdist_workspace_query(sizeof(double), dimension, 64, 128, &n) == (known ? QDIST_OK : QDIST_ERROR_DIMENSION));
        CHECK(known || n == 7);
    }
    n = 7;
    CHECK(qdist_workspace_query(sizeof(double), 3, 64, 128, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_workspace_query(sizeof(double), 6, 6, 128, &n) == QDIST_ERROR_CAPACITY && n == 7);
    CHECK(qdist_workspace_query(sizeof(float), 6, 7, 11, &n) == QDIST_ERROR_CAPACITY && n == 7);

    CHECK(qdist_solver_init_f64(memory, bytes, 3, 64, 128, &solver) == QDIST_OK && (void *)solver == (void *)memory);
    CHECK(qdist_solver_init_f32(other, sizeof other, 3, 64, 128, &solver32) == QDIST_OK);
    CHECK(qdist_body_box_f64(&a, &box) == QDIST_OK && qdist_body_box_f32(&a32, &box32) == QDIST_OK);
    memset(&depth, 0, sizeof depth);
    depth.struct_size = sizeof depth;
    memset(&depth32, 0, sizeof depth32);
    depth32.struct_size = sizeof depth32;
    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    CHECK(qdist_depth3_f64(NULL, &a, &a, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_depth3_f64((qdist_solver *)junk, &a, &a, NULL, &depth) == QDIST_ERROR_SOLVER);
    CHECK(qdist_depth3_f64((qdist_solver *)((char *)memory + 4), &a, &a, NULL, &depth) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_depth3_f64(solver32, &a, &a, NULL, &depth) == QDIST_ERROR_SCALAR);
    CHECK(qdist_depth3_f32(solver, &a32, &a32, NULL, &depth32) == QDIST_ERROR_SCALAR);
    CHECK(qdist_solve4_f64(solver, &a.set, NULL, NULL, &result) == QDIST_ERROR_DIMENSION);
    CHECK(qdist_depth3_f64(solver, &a, &a, NULL, &depth) == QDIST_OK);
    CHECK(qdist_solver_init_f64(memory, sizeof memory, 6, 64, 128, &solver6) == QDIST_OK);
    depth.upper = 7;
    CHECK(qdist_depth3_f64(solver6, &a, &a, NULL, &depth) == QDIST_ERROR_DIMENSION && depth.upper == 7);
    CHECK(qdist_solve6_f64(solver6, &a.set, NULL, NULL, &result) == QDIST_ERROR_DIMENSION);
}

#define REFUSES(name, value, status)                                                          \
    do {                                                                                      \
        qdist_body_f64 body;                                                                  \
        memset(&body, 0x55, sizeof body);                                                     \
        memcpy(&copy, &body, sizeof body);                                                    \
        CHECK(qdist_body_##name##_f64(&body, value) == (status));                             \
        CHECK(memcmp(&body, &copy, sizeof body) == 0);                                        \
    } while (0)

static void shapes(void) {
    qdist_body_f64 copy;
    double *const sizes[] = {&sphere.radius, &box.half[1], &ellipsoid.semi_axes[2], &cylinder.radius,
                             &cylinder.half_height, &capsule.radius, &capsule.half_height, &cone.radius, &cone.half_height};
    unsigned i, k;

    for (i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        for (k = 0; k < 4; ++k) {
            const double good = *sizes[i];
            const qdist_status status = k < 3 ? QDIST_ERROR_NONFINITE : QDIST_ERROR_ARGUMENT;
            *sizes[i] = k < 3 ? BAD[k] : -1e-300;
            if (i == 0) REFUSES(sphere, &sphere, status);
            if (i == 1) REFUSES(box, &box, status);
            if (i == 2) REFUSES(ellipsoid, &ellipsoid, status);
            if (i == 3 || i == 4) REFUSES(cylinder, &cylinder, status);
            if (i == 5 || i == 6) REFUSES(capsule, &capsule, status);
            if (i == 7 || i == 8) REFUSES(cone, &cone, status);
            *sizes[i] = good;
        }
    }
    box.half[0] = 1e300;
    REFUSES(box, &box, QDIST_ERROR_NONFINITE);
    box.half[0] = 1;
    REFUSES(sphere, NULL, QDIST_ERROR_NULL);
    REFUSES(box, NULL, QDIST_ERROR_NULL);
    REFUSES(points, NULL, QDIST_ERROR_NULL);
    REFUSES(hull, NULL, QDIST_ERROR_NULL);
    REFUSES(hull_large, NULL, QDIST_ERROR_NULL);
    REFUSES(set, NULL, QDIST_ERROR_NULL);
    CHECK(qdist_body_box_f64(NULL, &box) == QDIST_ERROR_NULL);
    CHECK(qdist_body_points_f64(NULL, NULL) == QDIST_ERROR_NULL);
    REFUSES(box, (const qdist_box_f64 *)((const char *)&box + 1), QDIST_ERROR_ALIGNMENT);
}

static void lists(void) {
    qdist_body_f64 copy;
    qdist_set_f64 set, before;
    qdist_points_f64 list = {corners, 4, 3};
    qdist_hull_f64 hull, hull_before;
    qdist_hull_large_f64 large, large_before;
    uint16_t graph[QDIST_HULL_GRAPH_LEN(4)];
    uint32_t wide[QDIST_HULL_LARGE_GRAPH_LEN(4)], scratch[QDIST_HULL_LARGE_WORKSPACE_LEN(4)];
    qdist_solver *solver, *small;
    const uint32_t words = QDIST_HULL_GRAPH_LEN(4), wides = QDIST_HULL_LARGE_GRAPH_LEN(4);
    const uint32_t work = QDIST_HULL_LARGE_WORKSPACE_LEN(4);
    unsigned k;

    memset(&set, 0x55, sizeof set);
    before = set;
    list.count = 0;
    REFUSES(points, &list, QDIST_ERROR_ARGUMENT);
    CHECK(qdist_set_points_f64(&set, &list) == QDIST_ERROR_ARGUMENT);
    list.count = 4, list.points = NULL;
    REFUSES(points, &list, QDIST_ERROR_NULL);
    CHECK(qdist_set_points_f64(&set, &list) == QDIST_ERROR_NULL);
    list.points = (const double *)((const char *)corners + 4), list.count = 3;
    REFUSES(points, &list, QDIST_ERROR_ALIGNMENT);
    list.points = corners, list.count = 4, list.dimension = 2;
    REFUSES(points, &list, QDIST_ERROR_DIMENSION);
    for (k = 0; k < 9; k == 1 ? (k = 7) : ++k) {
        list.dimension = k;
        CHECK(qdist_set_points_f64(&set, &list) == QDIST_ERROR_DIMENSION);
    }
    list.dimension = 3;
    for (k = 0; k < 3; ++k) {
        corners[11] = BAD[k];
        REFUSES(points, &list, QDIST_ERROR_NONFINITE);
        CHECK(qdist_set_points_f64(&set, &list) == QDIST_ERROR_NONFINITE);
    }
    corners[11] = 1;
    CHECK(memcmp(&set, &before, sizeof set) == 0);

    memset(&hull, 0x55, sizeof hull);
    memcpy(&hull_before, &hull, sizeof hull);
    CHECK(qdist_solver_init_f64(memory, sizeof memory, 3, 8, 16, &solver) == QDIST_OK);
    CHECK(qdist_hull_prepare_f64(NULL, solver, corners, 4, NULL, NULL, graph, words) == QDIST_ERROR_NULL);
    CHECK(qdist_hull_prepare_f64(&hull, solver, NULL, 4, NULL, NULL, graph, words) == QDIST_ERROR_NULL);
    CHECK(qdist_hull_prepare_f64(&hull, solver, corners, 4, NULL, NULL, NULL, words) == QDIST_ERROR_NULL);
    CHECK(qdist_hull_prepare_f64(&hull, NULL, corners, 4, NULL, NULL, graph, words) == QDIST_ERROR_NULL);
    CHECK(qdist_hull_prepare_f64(&hull, solver, corners, 0, NULL, NULL, graph, words) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_hull_prepare_f64(&hull, solver, corners, 4, NULL, NULL, graph, 3) == QDIST_ERROR_WORKSPACE_SIZE);
    CHECK(qdist_hull_prepare_f64(&hull, solver, corners, 3, NULL, NULL, graph, words) == QDIST_ERROR_FLAT);
    CHECK(qdist_solver_init_f64(other, sizeof other, 2, 8, 16, &small) == QDIST_OK);
    CHECK(qdist_hull_prepare_f64(&hull, small, corners, 4, NULL, NULL, graph, words) == QDIST_ERROR_DIMENSION);
    CHECK(memcmp(&hull, &hull_before, sizeof hull) == 0);
    CHECK(qdist_hull_prepare_f64(&hull, solver, corners, 4, NULL, NULL, graph, words) == QDIST_OK);
    hull.graph_len = 1;
    REFUSES(hull, &hull, QDIST_ERROR_ARGUMENT);
    hull.graph_len = words, hull.graph = NULL;
    REFUSES(hull, &hull, QDIST_ERROR_NULL);
    /* Any words are safe. */
    hull.graph = graph;
    memset(graph, 0xff, sizeof graph);
    REFUSES(hull, &hull, QDIST_ERROR_ARGUMENT);
    for (k = 0; k < words; ++k) graph[k] = (uint16_t)(k * 7);
    graph[0] = 3, graph[1] = 4;
    {
        qdist_body_f64 a, b;
        qdist_depth_f64 depth;
        depth.struct_size = sizeof depth;
        CHECK(qdist_body_hull_f64(&a, &hull) == QDIST_OK && qdist_body_points_f64(&b, &list) == QDIST_OK);
        CHECK(qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_OK && depth.lower <= depth.upper);
    }

    memset(&large, 0x55, sizeof large);
    memcpy(&large_before, &large, sizeof large);
#define PREPARE(hull, points, count, graph, words, scratch, work) \
    qdist_hull_large_prepare_f64(hull, scratch, work, points, count, NULL, NULL, graph, words)
    CHECK(PREPARE(NULL, corners, 4, wide, wides, scratch, work) == QDIST_ERROR_NULL);
    CHECK(PREPARE(&large, NULL, 4, wide, wides, scratch, work) == QDIST_ERROR_NULL);
    CHECK(PREPARE(&large, corners, 4, NULL, wides, scratch, work) == QDIST_ERROR_NULL);
    CHECK(PREPARE(&large, corners, 4, wide, wides, NULL, work) == QDIST_ERROR_NULL);
    CHECK(PREPARE(&large, corners, 4, (uint32_t *)((char *)wide + 1), wides, scratch, work) == QDIST_ERROR_ALIGNMENT);
    CHECK(PREPARE(&large, corners, 4, wide, wides, (uint32_t *)((char *)scratch + 2), work) == QDIST_ERROR_ALIGNMENT);
    CHECK(PREPARE(&large, corners, 0, wide, wides, scratch, work) == QDIST_ERROR_ARGUMENT);
    CHECK(PREPARE(&large, corners, QDIST_HULL_LARGE_POINTS + 1, wide, wides, scratch, work) == QDIST_ERROR_HULL_POINTS);
    CHECK(PREPARE(&large, corners, 4, wide, wides - 1, scratch, work) == QDIST_ERROR_WORKSPACE_SIZE);
    CHECK(PREPARE(&large, corners, 4, wide, wides, scratch, work - 1) == QDIST_ERROR_WORKSPACE_SIZE);
    CHECK(PREPARE(&large, corners, 3, wide, wides, scratch, work) == QDIST_ERROR_FLAT);
    corners[11] = BAD[0];
    CHECK(PREPARE(&large, corners, 4, wide, wides, scratch, work) == QDIST_ERROR_NONFINITE);
    corners[11] = 1;
    CHECK(memcmp(&large, &large_before, sizeof large) == 0);
    CHECK(PREPARE(&large, corners, 4, wide, wides, scratch, work) == QDIST_OK);
    large.graph_len = 1;
    REFUSES(hull_large, &large, QDIST_ERROR_ARGUMENT);
    large.graph_len = wides, large.graph = NULL;
    REFUSES(hull_large, &large, QDIST_ERROR_NULL);
}

/* Functions that the library has put into sets, bodies and unit sets. */
static void by_hand(void) {
    double direction[6] = {1, 0, 0, 0, 0, 0}, point[6], matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    qdist_points_f64 list = {corners, 4, 3};
    qdist_box_f64 cube = {{1, 1, 1}};
    qdist_set_f64 a, sum, image;
    qdist_body_f64 body, points;
    qdist_pair_f64 pair = {&a, &a, 3};
    qdist_linear_f64 map = {&a, matrix, {0, 0, 0, 0, 0, 0}, 3, 3};
    qdist_box_unit_f64 cuboid = {{1, 1, 1, 0, 0, 0}, 3};
    qdist_segment_unit_f64 ray = {{1, 1, 1, 0, 0, 0}, 3};
    qdist_unit_f64 unit, segment;

    CHECK(qdist_set_points_f64(&a, &list) == QDIST_OK && qdist_body_box_f64(&body, &cube) == QDIST_OK);
    CHECK(qdist_body_points_f64(&points, &list) == QDIST_OK && qdist_set_sum_f64(&sum, &pair) == QDIST_OK);
    CHECK(qdist_set_linear_f64(&image, &map) == QDIST_OK && qdist_unit_box_f64(&unit, &cuboid) == QDIST_OK);
    CHECK(qdist_unit_segment_f64(&segment, &ray) == QDIST_OK);
    CHECK(body.set.support(NULL, direction, point) == QDIST_ERROR_NULL);
    CHECK(body.set.support(&cube, NULL, point) == QDIST_ERROR_NULL);
    CHECK(body.set.support(&cube, direction, NULL) == QDIST_ERROR_NULL);
    CHECK(body.set.support(&cube, (double *)(void *)((char *)direction + 1), point) == QDIST_ERROR_ALIGNMENT);
    CHECK(a.support(&list, NULL, point) == QDIST_ERROR_NULL && a.support(&list, direction, NULL) == QDIST_ERROR_NULL);
    CHECK(points.set.support(NULL, direction, point) == QDIST_ERROR_NULL);
    CHECK(sum.support(NULL, direction, point) == QDIST_ERROR_NULL && image.support(NULL, direction, point) == QDIST_ERROR_NULL);
    CHECK(isnan(unit.value(NULL, direction)) && isnan(unit.value(&cuboid, NULL)));
    CHECK(unit.point(&cuboid, direction, NULL) == QDIST_ERROR_NULL && unit.vertex(NULL, 0, point) == QDIST_ERROR_NULL);
    ray.dimension = 100;
    CHECK(isnan(segment.value(&ray, direction)));
    a.support = NULL;
    CHECK(image.support(&map, direction, point) == QDIST_ERROR_NULL);
}

static void sets_and_units(void) {
    qdist_points_f64 list = {corners, 4, 3};
    qdist_set_f64 a, b, made, before;
    qdist_pair_f64 pair = {&a, &b, 3};
    double matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    qdist_linear_f64 map = {&a, matrix, {0, 0, 0, 0, 0, 0}, 3, 3};
    qdist_unit_f64 unit, unit_before;
    qdist_box_unit_f64 cuboid = {{1, 1, 1, 0, 0, 0}, 3};
    qdist_cross_unit_f64 cross = {{1, 1, 1, 0, 0, 0}, 3};
    qdist_ellipsoid_unit_f64 egg = {{1, 1, 1, 0, 0, 0}, matrix, 3};
    qdist_segment_unit_f64 ray = {{1, 1, 1, 0, 0, 0}, 3};
    unsigned k;

    CHECK(qdist_set_points_f64(&a, &list) == QDIST_OK && qdist_set_points_f64(&b, &list) == QDIST_OK);
    memset(&made, 0x55, sizeof made);
    before = made;
    pair.a = NULL;
    CHECK(qdist_set_sum_f64(&made, &pair) == QDIST_ERROR_NULL);
    pair.a = &a, pair.dimension = 7;
    CHECK(qdist_set_sum_f64(&made, &pair) == QDIST_ERROR_DIMENSION);
    pair.dimension = 4;
    CHECK(qdist_set_difference_f64(&made, &pair) == QDIST_ERROR_DIMENSION);
    pair.dimension = 3;
    a.support = NULL;
    CHECK(qdist_set_difference_f64(&made, &pair) == QDIST_ERROR_NULL);
    CHECK(qdist_set_linear_f64(&made, &map) == QDIST_ERROR_NULL);
    a.support = b.support;
    a.radius = -1;
    CHECK(qdist_set_difference_f64(&made, &pair) == QDIST_ERROR_ARGUMENT);
    a.radius = 0;
    CHECK(qdist_set_sum_f64(NULL, &pair) == QDIST_ERROR_NULL && qdist_set_sum_f64(&made, NULL) == QDIST_ERROR_NULL);
    matrix[4] = NAN;
    CHECK(qdist_set_linear_f64(&made, &map) == QDIST_ERROR_NONFINITE);
    CHECK(qdist_unit_ellipsoid_f64(&unit, &egg) == QDIST_ERROR_NONFINITE);
    matrix[4] = 1, map.rows = 1;
    CHECK(qdist_set_linear_f64(&made, &map) == QDIST_ERROR_DIMENSION);
    map.rows = 3, map.matrix = NULL;
    CHECK(qdist_set_linear_f64(&made, &map) == QDIST_ERROR_NULL);
    CHECK(memcmp(&made, &before, sizeof made) == 0);

    memset(&unit, 0x55, sizeof unit);
    unit_before = unit;
    CHECK(qdist_unit_ball_f64(&unit, 0) == QDIST_ERROR_ARGUMENT && qdist_unit_ball_f64(&unit, -1) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_unit_ball_f64(&unit, NAN) == QDIST_ERROR_NONFINITE && qdist_unit_ball_f64(NULL, 1) == QDIST_ERROR_NULL);
    matrix[0] = 2;
    CHECK(qdist_unit_ellipsoid_f64(&unit, &egg) == QDIST_ERROR_ROTATION);
    matrix[0] = 1;
    cuboid.dimension = 1, cross.dimension = 7, egg.dimension = 0, ray.dimension = 100;
    CHECK(qdist_unit_box_f64(&unit, &cuboid) == QDIST_ERROR_DIMENSION);
    CHECK(qdist_unit_cross_f64(&unit, &cross) == QDIST_ERROR_DIMENSION);
    CHECK(qdist_unit_ellipsoid_f64(&unit, &egg) == QDIST_ERROR_DIMENSION);
    CHECK(qdist_unit_segment_f64(&unit, &ray) == QDIST_ERROR_DIMENSION);
    cuboid.dimension = cross.dimension = egg.dimension = ray.dimension = 3;
    for (k = 0; k < 3; ++k) cuboid.half[k] = cross.semi_axes[k] = egg.semi_axes[k] = ray.end[k] = 0;
    CHECK(qdist_unit_box_f64(&unit, &cuboid) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_unit_cross_f64(&unit, &cross) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_unit_ellipsoid_f64(&unit, &egg) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_unit_segment_f64(&unit, &ray) == QDIST_ERROR_ARGUMENT);
    list.count = 1; /* the origin */
    CHECK(qdist_unit_vertices_f64(&unit, &list) == QDIST_ERROR_ARGUMENT);
    cuboid.half[1] = -1, cross.semi_axes[1] = INFINITY, egg.semi_axes[1] = NAN, ray.end[1] = NAN;
    CHECK(qdist_unit_box_f64(&unit, &cuboid) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_unit_cross_f64(&unit, &cross) == QDIST_ERROR_NONFINITE);
    CHECK(qdist_unit_ellipsoid_f64(&unit, &egg) == QDIST_ERROR_NONFINITE);
    CHECK(qdist_unit_segment_f64(&unit, &ray) == QDIST_ERROR_NONFINITE);
    CHECK(qdist_unit_box_f64(&unit, NULL) == QDIST_ERROR_NULL && qdist_unit_box_f64(NULL, &cuboid) != QDIST_OK);
    CHECK(memcmp(&unit, &unit_before, sizeof unit) == 0);

    /* The library's own functions, called by hand. */
    by_hand();
}

static qdist_solver *solver;
static qdist_body_f64 first, second;
static qdist_options_f64 options;
static qdist_depth_f64 depth;
static qdist_result_f64 result;
static qdist_unit_f64 unit;

/* One wrong value in an otherwise good query. */
static void refused(qdist_status status) {
    qdist_depth_f64 depth_before;
    qdist_result_f64 result_before;
    memcpy(&depth_before, &depth, sizeof depth);
    memcpy(&result_before, &result, sizeof result);
    CHECK(qdist_depth3_f64(solver, &first, &second, &options, &depth) == status);
    CHECK(qdist_depth3_f64(solver, &second, &first, &options, &depth) == status);
    CHECK(memcmp(&depth, &depth_before, sizeof depth) == 0 && memcmp(&result, &result_before, sizeof result) == 0);
}

static void refused_set(qdist_status status) {
    refused(status);
    CHECK(qdist_solve3_f64(solver, &first.set, &unit, &options, &result) == status);
}

static void refused_options(qdist_status status) {
    refused_set(status);
    options.use_guess = options.use_threshold = 0;
    options.absolute = 0, options.relative = 1e-6, options.threshold = options.guess[2] = 0;
    options.struct_size = sizeof options;
    CHECK(qdist_depth3_f64(solver, &first, &second, &options, &depth) == QDIST_OK);
}

#define WITH(place, value, check)                        \
    do {                                                 \
        const qdist_body_f64 good = first;               \
        (place) = (value);                               \
        check;                                           \
        first = good;                                    \
    } while (0)

static void queries(void) {
    unsigned k;
    CHECK(qdist_solver_init_f64(memory, sizeof memory, 3, 64, 128, &solver) == QDIST_OK);
    CHECK(qdist_body_box_f64(&first, &box) == QDIST_OK && qdist_body_box_f64(&second, &box) == QDIST_OK);
    CHECK(qdist_options_default_f64(&options) == QDIST_OK && qdist_options_default_f64(NULL) == QDIST_ERROR_NULL);
    CHECK(options.struct_size == sizeof options && options.relative == 1e-6 && options.absolute == 0);
    CHECK(qdist_unit_ball_f64(&unit, 1) == QDIST_OK);
    memset(&depth, 0x55, sizeof depth);
    memset(&result, 0x55, sizeof result);
    depth.struct_size = sizeof depth;
    result.struct_size = sizeof result;

    CHECK(qdist_depth3_f64(solver, NULL, &second, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_depth3_f64(solver, &first, NULL, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_depth3_f64(solver, &first, &second, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_solve3_f64(solver, NULL, NULL, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve3_f64(solver, &first.set, NULL, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_solve3_f64(NULL, &first.set, NULL, NULL, &result) == QDIST_ERROR_NULL);

    for (k = 0; k < 3; ++k) {
        WITH(first.rotation[k * 4], BAD[k], refused(QDIST_ERROR_NONFINITE));
        WITH(first.translation[k], BAD[k], refused(QDIST_ERROR_NONFINITE));
        WITH(first.set.radius, BAD[k], refused_set(QDIST_ERROR_NONFINITE));
        WITH(first.set.extent, BAD[k], refused_set(QDIST_ERROR_NONFINITE));
        WITH(first.set.error, BAD[k], refused_set(QDIST_ERROR_NONFINITE));
        WITH(first.spread, BAD[k], refused(QDIST_ERROR_NONFINITE));
        WITH(first.rolling_radius, BAD[k], refused(QDIST_ERROR_NONFINITE));
        options.absolute = BAD[k];
        refused_options(QDIST_ERROR_NONFINITE);
        options.relative = BAD[k];
        refused_options(QDIST_ERROR_NONFINITE);
        options.threshold = BAD[k], options.use_threshold = 1;
        refused_options(QDIST_ERROR_NONFINITE);
        options.guess[2] = BAD[k], options.use_guess = 1;
        refused_options(QDIST_ERROR_NONFINITE);
    }
    WITH(first.rotation[1], 1e-3, refused(QDIST_ERROR_ROTATION));
    WITH(first.rotation[0], -1, refused(QDIST_ERROR_ROTATION));
    WITH(first.rotation[0], 0, refused(QDIST_ERROR_ROTATION));
    WITH(first.symmetry, 3, refused(QDIST_ERROR_ARGUMENT));
    WITH(first.spread, -1, refused(QDIST_ERROR_ARGUMENT));
    WITH(first.rolling_radius, -1, refused(QDIST_ERROR_ARGUMENT));
    WITH(first.rolling_radius, 1, refused(QDIST_ERROR_ARGUMENT)); /* a part of set.radius, which is 0 */
    WITH(first.set.radius, -1, refused_set(QDIST_ERROR_ARGUMENT));
    WITH(first.set.extent, -1, refused_set(QDIST_ERROR_ARGUMENT));
    WITH(first.set.error, -1, refused_set(QDIST_ERROR_ARGUMENT));
    WITH(first.set.support, NULL, refused_set(QDIST_ERROR_NULL));
    WITH(first.set.dimension, 4, refused_set(QDIST_ERROR_DIMENSION));
    options.absolute = -1;
    refused_options(QDIST_ERROR_ARGUMENT);
    options.relative = -1;
    refused_options(QDIST_ERROR_ARGUMENT);
    options.relative = 0;
    refused_options(QDIST_ERROR_ARGUMENT);
    options.use_guess = 2;
    refused_options(QDIST_ERROR_ARGUMENT);
    options.use_threshold = 2;
    refused_options(QDIST_ERROR_ARGUMENT);
    options.struct_size -= 1;
    refused_options(QDIST_ERROR_STRUCT_SIZE);
    options.struct_size = 0;
    refused_options(QDIST_ERROR_STRUCT_SIZE);
    depth.struct_size = result.struct_size = 4;
    refused_set(QDIST_ERROR_STRUCT_SIZE);
    depth.struct_size = sizeof depth, result.struct_size = sizeof result;

    unit.dimension = 2;
    CHECK(qdist_solve3_f64(solver, &first.set, &unit, NULL, &result) == QDIST_ERROR_DIMENSION);
    unit.dimension = 0, unit.ball_radius = -1;
    CHECK(qdist_solve3_f64(solver, &first.set, &unit, NULL, &result) == QDIST_ERROR_ARGUMENT);
    unit.ball_radius = 0;
    CHECK(qdist_solve3_f64(solver, &first.set, &unit, NULL, &result) == QDIST_ERROR_NULL);
    const qdist_box_unit_f64 cuboid = {{1, 1, 1, 0, 0, 0}, 3};
    CHECK(qdist_unit_box_f64(&unit, &cuboid) == QDIST_OK);
    unit.extent = NAN;
    CHECK(qdist_solve3_f64(solver, &first.set, &unit, NULL, &result) == QDIST_ERROR_NONFINITE);
}

/* Shapes are trusted once their body is made. One that is spoiled later gives points that are not finite, and nothing worse. */
static void spoiled(void) {
    qdist_body_f64 bodies[5];
    double *const sizes[] = {&box.half[0], &ellipsoid.semi_axes[1], &cylinder.radius, &cylinder.half_height,
                             &capsule.half_height, &cone.radius, &cone.half_height};
    const unsigned owner[] = {0, 1, 2, 2, 3, 4, 4};
    unsigned i, k;
    CHECK(qdist_body_box_f64(&bodies[0], &box) == QDIST_OK && qdist_body_ellipsoid_f64(&bodies[1], &ellipsoid) == QDIST_OK);
    CHECK(qdist_body_cylinder_f64(&bodies[2], &cylinder) == QDIST_OK && qdist_body_capsule_f64(&bodies[3], &capsule) == QDIST_OK);
    CHECK(qdist_body_cone_f64(&bodies[4], &cone) == QDIST_OK);
    for (i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        const double good = *sizes[i];
        for (k = 0; k < 3; ++k) {
            *sizes[i] = BAD[k];
            CHECK(qdist_depth3_f64(solver, &bodies[owner[i]], &second, NULL, &depth) == QDIST_ERROR_CALLBACK);
            CHECK(depth.outcome == QDIST_SUPPORT_FAILED && depth.callback_code == QDIST_CALLBACK_NONFINITE);
            CHECK(depth.lower <= depth.upper);
        }
        *sizes[i] = -1;
        CHECK(qdist_depth3_f64(solver, &bodies[owner[i]], &second, NULL, &depth) == QDIST_OK);
        *sizes[i] = good;
        CHECK(qdist_depth3_f64(solver, &bodies[owner[i]], &second, NULL, &depth) == QDIST_OK);
    }
}

/* Unit sets of the caller. */
static double nothing(void *user, const double *u) {
    (void)user, (void)u;
    return 0;
}

static double taxi(void *user, const double *u) {
    (void)user;
    return fabs(u[0]) + fabs(u[1]) + fabs(u[2]);
}

static int32_t no_vertex(void *user, uint32_t index, double *point) {
    (void)index;
    point[0] = point[1] = point[2] = *(const double *)user;
    return 0;
}

static int32_t silent_vertex(void *user, uint32_t index, double *point) {
    (void)user, (void)index, (void)point;
    return 0;
}

/* Unit sets that make no sense. */
static void wrong_units(void) {
    static uint64_t least[QDIST_WORKSPACE_WORDS_F64(3, 4, 6)]; /* in more, an expansion might not ask for vertices */
    qdist_solver *rays = NULL;
    double value = 0;
    unsigned k;
    CHECK(qdist_solver_init_f64(least, sizeof least, 3, 4, 6, &rays) == QDIST_OK);
    result.struct_size = sizeof result;
#define GIVES(expected) CHECK(qdist_solve3_f64(rays, &first.set, &unit, NULL, &result) == (expected))
    memset(&unit, 0, sizeof unit);
    GIVES(QDIST_ERROR_NULL);
    unit.value = nothing; /* the origin alone */
    GIVES(QDIST_ERROR_ARGUMENT);
    unit.extent = 1; /* it says so, but bounds nothing */
    GIVES(QDIST_OK);
    CHECK(result.outcome != QDIST_CONVERGED && result.upper == 1.7976931348623157e308);
    unit.value = taxi, unit.user = &value, unit.vertex_count = 8;
    GIVES(QDIST_ERROR_NULL); /* no function for the vertices */
    unit.extent = 2, unit.vertex = no_vertex;
    for (k = 0; k < 3; ++k) {
        value = BAD[k];
        GIVES(QDIST_ERROR_CALLBACK);
        CHECK(result.outcome == QDIST_SUPPORT_FAILED && result.callback_code == QDIST_CALLBACK_NONFINITE);
    }
    value = 1e300; /* too large to be a point */
    GIVES(QDIST_ERROR_CALLBACK);
    unit.vertex = silent_vertex;
    GIVES(QDIST_ERROR_CALLBACK);
    CHECK(result.callback_code == QDIST_CALLBACK_NONFINITE && result.lower <= 1 && result.upper >= 1);
    unit.vertex = no_vertex, value = 0; /* no direction to shoot in */
    GIVES(QDIST_OK);
    CHECK(result.lower <= 1 && result.upper >= 1);
    unit.vertex_count = 0;
    for (k = 0; k < 3; ++k) {
        unit.inner_radius = BAD[k];
        GIVES(QDIST_ERROR_NONFINITE);
    }
    unit.inner_radius = -1;
    GIVES(QDIST_ERROR_ARGUMENT);
    unit.inner_radius = 3; /* more than the extent */
    GIVES(QDIST_ERROR_ARGUMENT);
    unit.inner_radius = 1;
    GIVES(QDIST_OK);
#undef GIVES
}

/* Whatever is wrong with a tracker or with `moved`, neither tracker nor result is written. */
static void warm_starts(void) {
    qdist_tracker_f64 tracker, good, before;
    qdist_result_f64 result_before;
    double lower = 7;
    unsigned k;

    memset(&tracker, 0x55, sizeof tracker);
    before = tracker;
    CHECK(qdist_tracker_init_f64(NULL, 3) == QDIST_ERROR_NULL);
    CHECK(qdist_tracker_init_f64((qdist_tracker_f64 *)((char *)&tracker + 4), 3) == QDIST_ERROR_ALIGNMENT);
    for (k = 0; k < 9; k == 1 ? (k = 7) : ++k) CHECK(qdist_tracker_init_f64(&tracker, k) == QDIST_ERROR_DIMENSION);
    CHECK(memcmp(&tracker, &before, sizeof tracker) == 0);
    CHECK(qdist_tracker_init_f64(&tracker, 3) == QDIST_OK);
    memset(&result, 0x55, sizeof result);
    result.struct_size = sizeof result;
    memcpy(&result_before, &result, sizeof result);
#define WARM(moved) qdist_solve_warm3_f64(solver, &tracker, &first.set, NULL, moved, NULL, &result)
#define REFUSED(change, moved, expected)                                                                  \
    do {                                                                                                  \
        good = tracker;                                                                                   \
        change;                                                                                           \
        before = tracker;                                                                                 \
        CHECK(WARM(moved) == (expected));                                                                 \
        CHECK(qdist_tracker_lower_after_f64(&tracker, NULL, moved, &lower) == (expected) && lower == 7);  \
        CHECK(memcmp(&tracker, &before, sizeof tracker) == 0);                                            \
        CHECK(memcmp(&result, &result_before, sizeof result) == 0);                                       \
        tracker = good;                                                                                   \
    } while (0)
    CHECK(qdist_solve_warm3_f64(solver, NULL, &first.set, NULL, 0, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_warm3_f64(NULL, &tracker, &first.set, NULL, 0, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_warm3_f64(solver, &tracker, NULL, NULL, 0, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_warm3_f64(solver, &tracker, &first.set, NULL, 0, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_warm3_f64(solver, (qdist_tracker_f64 *)((char *)&tracker + 4), &first.set, NULL, 0, NULL, &result) ==
          QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_tracker_lower_after_f64(NULL, NULL, 0, &lower) == QDIST_ERROR_NULL);
    CHECK(qdist_tracker_lower_after_f64(&tracker, NULL, 0, NULL) == QDIST_ERROR_NULL);
    REFUSED(tracker.struct_size = 0, 0, QDIST_ERROR_STRUCT_SIZE);
    REFUSED(tracker.struct_size = sizeof(qdist_tracker_f32), 0, QDIST_ERROR_STRUCT_SIZE);
    REFUSED(tracker.dimension = 0, 0, QDIST_ERROR_DIMENSION);
    REFUSED(tracker.directions[0][0] = 2, 0, QDIST_ERROR_ARGUMENT); /* not of unit length */
    for (k = 0; k < 3; ++k) {
        REFUSED((void)0, BAD[k], QDIST_ERROR_NONFINITE);
        REFUSED(tracker.lower = BAD[k], 0, QDIST_ERROR_NONFINITE);
        REFUSED(tracker.directions[3][2] = BAD[k], 0, QDIST_ERROR_NONFINITE);
    }
    /* Of another dimension. */
    CHECK(qdist_tracker_init_f64(&tracker, 2) == QDIST_OK && WARM(0) == QDIST_ERROR_DIMENSION);
    CHECK(qdist_tracker_init_f64(&tracker, 3) == QDIST_OK && WARM(-1) == QDIST_OK && result.lower <= 1 && result.upper >= 1);
    CHECK(WARM(0) == QDIST_OK && result.plan == QDIST_PLAN_WARM && tracker.lower > 0.99 && tracker.lower <= 1);
    CHECK(qdist_tracker_lower_after_f64(&tracker, NULL, 0.25, &lower) == QDIST_OK && lower > 0.74 && lower <= 0.75);
    CHECK(qdist_tracker_lower_after_f64(&tracker, NULL, -1, &lower) == QDIST_OK && lower < -1e300);

    CHECK(qdist_solve_in_span_f64(NULL, &first.set, NULL, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_in_span_f64(solver, NULL, NULL, NULL, &result) == QDIST_ERROR_NULL);
    CHECK(qdist_solve_in_span_f64(solver, &first.set, NULL, NULL, NULL) == QDIST_ERROR_NULL);
    result.struct_size = 0;
    CHECK(qdist_solve_in_span_f64(solver, &first.set, NULL, NULL, &result) == QDIST_ERROR_STRUCT_SIZE);
    CHECK(WARM(0) == QDIST_ERROR_STRUCT_SIZE);
#undef WARM
#undef REFUSED
}

static void names(void) {
    qdist_status status;
    CHECK(strcmp(qdist_status_string(QDIST_ERROR_NULL), "null pointer") == 0);
    for (status = -3; status < 40; ++status) {
        CHECK(qdist_status_string(status) != NULL && qdist_status_string(status)[0] != '\0');
        CHECK(qdist_outcome_string(status) != NULL && qdist_outcome_string(status)[0] != '\0');
        CHECK(qdist_plan_string(status) != NULL && qdist_plan_string(status)[0] != '\0');
    }
}

int main(void) {
    memory_and_handles();
    shapes();
    lists();
    sets_and_units();
    queries();
    wrong_units();
    warm_starts();
    spoiled();
    names();
    return finish("bad_arguments");
}
