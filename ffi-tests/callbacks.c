/* What callbacks may do and may not: shortcuts that are wrong, functions that use the solver that is calling them, numbers that are none. */
#include "qdist_grasp.h"
#include "test.h"

#include <math.h>
#include <string.h>

static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)], other[QDIST_WORKSPACE_WORDS_F64(3, 64, 128)];
static qdist_solver *solver, *second;

/* A unit cube; the shortcut sees its even vertices only. */
static int32_t even(void *user, const double *u, double *point) {
    double best = -1e300;
    (void)user;
    for (int i = 0; i < 8; i += 2) {
        const double p[3] = {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
        const double height = p[0] * u[0] + p[1] * u[1] + p[2] * u[2];
        if (height > best) best = height, memcpy(point, p, sizeof p);
    }
    return 0;
}

static int32_t cube(void *user, const double *u, double *point) {
    (void)user;
    for (int k = 0; k < 3; ++k) point[k] = u[k] < 0 ? -1.0 : 1.0;
    return 0;
}

static void wrong_shortcuts(void) {
    qdist_set_f64 set;
    qdist_body_f64 a, b;
    qdist_depth_f64 depth;
    memset(&set, 0, sizeof set);
    set.support = even, set.exhaustive = cube, set.extent = 1.7320508075688774;
    CHECK(qdist_body_set_f64(&a, &set) == QDIST_OK && qdist_body_set_f64(&b, &set) == QDIST_OK);
    b.translation[0] = 1.5;
    depth.struct_size = sizeof depth;
    for (int swapped = 0; swapped < 2; ++swapped) {
        CHECK(qdist_depth3_f64(solver, swapped ? &b : &a, swapped ? &a : &b, NULL, &depth) == QDIST_OK);
        CHECK(depth.outcome == QDIST_CONVERGED && depth.lower <= 0.5 && depth.upper >= 0.5 && depth.upper < 0.500001);
        const double *on_a = swapped ? depth.point_b : depth.point_a, *on_b = swapped ? depth.point_a : depth.point_b;
        for (int k = 0; k < 3; ++k) {
            CHECK(fabs(on_a[k]) <= 1 + 1e-12 && fabs(on_b[k] - (k == 0 ? 1.5 : 0)) <= 1 + 1e-12);
            CHECK(fabs(depth.point_a[k] - depth.point_b[k] - 0.5 * depth.normal[k]) < 1e-5);
        }
    }
}

/* Functions that use the solver of the query that is calling them. `inner` is what they are told. */
static qdist_status inner;
static int fails, inner_calls;

static void enter_again(void) {
    qdist_box_f64 box = {{1, 2, 3}};
    qdist_body_f64 body;
    qdist_depth_f64 depth;
    if (qdist_body_box_f64(&body, &box) != QDIST_OK) return;
    depth.struct_size = sizeof depth;
    inner = qdist_depth3_f64(solver, &body, &body, NULL, &depth);
    ++inner_calls;
    /* Another one is free to be used. */
    CHECK(qdist_depth3_f64(second, &body, &body, NULL, &depth) == QDIST_OK && depth.lower <= 2 && depth.upper >= 2);
}

static int32_t nested(void *user, const double *u, double *point) {
    enter_again();
    return cube(user, u, point) + (fails ? 77 : 0);
}

static double nested_unit(void *user, const double *u) {
    (void)user;
    enter_again();
    return fabs(u[0]) + fabs(u[1]) + fabs(u[2]);
}

static int32_t nested_interrupt(void *user) {
    (void)user;
    enter_again();
    return 0;
}

/* The solver is free again. */
static void is_free(void) {
    qdist_box_f64 box = {{1, 2, 3}};
    qdist_body_f64 body;
    qdist_depth_f64 depth;
    depth.struct_size = sizeof depth;
    CHECK(qdist_body_box_f64(&body, &box) == QDIST_OK);
    CHECK(qdist_depth3_f64(solver, &body, &body, NULL, &depth) == QDIST_OK && depth.lower <= 2 && depth.upper >= 2);
}

static void used_while_it_runs(void) {
    qdist_set_f64 set;
    qdist_body_f64 a, b;
    qdist_unit_f64 unit;
    qdist_depth_f64 depth;
    qdist_result_f64 result;
    qdist_options_f64 options;
    qdist_tracker_f64 tracker;
    memset(&set, 0, sizeof set);
    set.support = nested;
    CHECK(qdist_body_set_f64(&a, &set) == QDIST_OK && qdist_body_set_f64(&b, &set) == QDIST_OK);
    b.translation[0] = 1.5;
    depth.struct_size = sizeof depth;
    result.struct_size = sizeof result;
    inner = QDIST_OK;
    CHECK(qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_OK && inner == QDIST_ERROR_BUSY);
    CHECK(depth.lower <= 0.5 && depth.upper >= 0.5 && depth.upper < 0.500001);
    is_free();

    /* A callback that fails leaves the solver free, and so do wrong arguments. */
    fails = 1;
    CHECK(qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_ERROR_CALLBACK && depth.callback_code == 77);
    fails = 0;
    is_free();
    b.rotation[0] = 2;
    CHECK(qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_ERROR_ROTATION);
    is_free();
    depth.struct_size = 1;
    CHECK(qdist_depth3_f64(solver, &a, &b, NULL, &depth) == QDIST_ERROR_STRUCT_SIZE);
    is_free();

    memset(&unit, 0, sizeof unit);
    unit.value = nested_unit, unit.extent = 1, unit.inner_radius = 0.5;
    inner = QDIST_OK;
    CHECK(qdist_solve3_f64(solver, &set, &unit, NULL, &result) == QDIST_OK && inner == QDIST_ERROR_BUSY);
    CHECK(result.lower <= 1 && result.upper >= 1 && result.upper < 1.00001);
    inner = QDIST_OK;
    CHECK(qdist_solve_in_span_f64(solver, &set, &unit, NULL, &result) == QDIST_OK && inner == QDIST_ERROR_BUSY);
    inner = QDIST_OK;
    CHECK(qdist_tracker_init_f64(&tracker, 3) == QDIST_OK);
    for (int tick = 0; tick < 2; ++tick)
        CHECK(qdist_solve_warm3_f64(solver, &tracker, &set, &unit, 0, NULL, &result) == QDIST_OK && inner == QDIST_ERROR_BUSY);

    CHECK(qdist_options_default_f64(&options) == QDIST_OK);
    options.interrupt = nested_interrupt;
    set.support = cube;
    inner = QDIST_OK, inner_calls = 0;
    CHECK(qdist_solve3_f64(solver, &set, NULL, &options, &result) == QDIST_OK);
    CHECK(inner_calls == 0 || inner == QDIST_ERROR_BUSY);
    is_free();
    CHECK(strcmp(qdist_status_string(QDIST_ERROR_BUSY), qdist_status_string(QDIST_ERROR_INTERNAL)) != 0);
}

/* Numbers that are none. */
static double bad;

static int32_t bad_point(void *user, const double *u, double *point) {
    cube(user, u, point);
    if (u[1] > 0.1) point[2] = bad;
    return 0;
}

static double bad_value(void *user, const double *u) {
    (void)user;
    return u[1] > 0.1 ? bad : sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
}

static void numbers_that_are_none(void) {
    const double numbers[] = {NAN, INFINITY, -INFINITY};
    qdist_set_f64 set;
    qdist_unit_f64 unit;
    qdist_result_f64 result;
    qdist_depth_f64 depth;
    qdist_body_f64 a;
    result.struct_size = sizeof result;
    depth.struct_size = sizeof depth;
    for (int i = 0; i < 3; ++i) {
        bad = numbers[i];
        memset(&set, 0, sizeof set);
        set.support = bad_point, set.extent = 2;
        CHECK(qdist_solve3_f64(solver, &set, NULL, NULL, &result) == QDIST_ERROR_CALLBACK);
        CHECK(result.outcome == QDIST_SUPPORT_FAILED && result.callback_code == QDIST_CALLBACK_NONFINITE);
        CHECK(result.lower <= 1 && result.upper >= 1);
        CHECK(qdist_body_set_f64(&a, &set) == QDIST_OK);
        CHECK(qdist_depth3_f64(solver, &a, &a, NULL, &depth) == QDIST_ERROR_CALLBACK && depth.lower <= 2 && depth.upper >= 2);
        CHECK(depth.callback_code == QDIST_CALLBACK_NONFINITE);
        set.support = cube;
        for (int known = 0; known < 2; ++known) {
            memset(&unit, 0, sizeof unit);
            unit.value = bad_value, unit.extent = known;
            CHECK(qdist_solve3_f64(solver, &set, &unit, NULL, &result) == QDIST_ERROR_CALLBACK);
            CHECK(result.callback_code == QDIST_CALLBACK_NONFINITE && result.lower <= 1 && result.upper >= 1);
        }
    }
    bad = -1;
    for (int known = 0; known < 2; ++known) {
        memset(&unit, 0, sizeof unit);
        unit.value = bad_value, unit.extent = known;
        CHECK(qdist_solve3_f64(solver, &set, &unit, NULL, &result) == QDIST_ERROR_CALLBACK);
        CHECK(result.callback_code == QDIST_CALLBACK_NONFINITE);
    }
}

int main(void) {
    CHECK(qdist_solver_init_f64(memory, sizeof memory, 3, 64, 128, &solver) == QDIST_OK);
    CHECK(qdist_solver_init_f64(other, sizeof other, 3, 64, 128, &second) == QDIST_OK);
    wrong_shortcuts();
    used_while_it_runs();
    numbers_that_are_none();
    return finish("callbacks");
}
