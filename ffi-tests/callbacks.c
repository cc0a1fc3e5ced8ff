/* What callbacks may do and may not: shortcuts that are wrong, functions that use the solver that is calling them, numbers that are none. */
#include "qdist_grasp.h"
#include "dice.h"
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

/* At a random moment of a random query, one of its callbacks uses its solver: any function is told so, and the query's answer is the same to the last bit. */
enum { IN_SPACE, IN_SIX };
static qdist_solver *solvers[2];
static struct {
    unsigned dimension;
    int moment; /* callbacks still to come; -1: never */
    unsigned function;
    qdist_status told;
    int entered;
} entry;

static qdist_status enter_by(unsigned function, qdist_solver *busy) {
    static const double corners[18] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    static double tips[72];
    static uint16_t graph[QDIST_HULL_GRAPH_LEN(6)];
    static qdist_body2_f64 flat;
    const qdist_points_f64 list = {tips, 12, 6};
    const qdist_disc_f64 disc = {1};
    const qdist_box_f64 box = {{1, 2, 3}};
    qdist_set_f64 sets[2];
    qdist_body_f64 body;
    qdist_hull_f64 hull;
    qdist_tracker_f64 tracker;
    qdist_depth_f64 depth;
    qdist_result_f64 result;
    qdist_closure_f64 closure;
    qdist_best_f64 best;
    for (int k = 0; k < 6; ++k) tips[12 * k + k] = 1, tips[12 * k + 6 + k] = -1;
    depth.struct_size = sizeof depth, result.struct_size = sizeof result, closure.struct_size = sizeof closure;
    best.struct_size = sizeof best, best.result.struct_size = sizeof result;
    CHECK(qdist_body_box_f64(&body, &box) == QDIST_OK && qdist_body2_disc_f64(&flat, &disc) == QDIST_OK);
    CHECK(qdist_set_points_f64(&sets[0], &list) == QDIST_OK);
    sets[1] = sets[0];
    if (entry.dimension == IN_SIX) {
        CHECK(qdist_tracker_init_f64(&tracker, 6) == QDIST_OK);
        switch (function % 5) {
        case 0: return qdist_solve6_f64(busy, sets, NULL, NULL, &result);
        case 1: return qdist_solve_in_span_f64(busy, sets, NULL, NULL, &result);
        case 2: return qdist_solve_warm6_f64(busy, &tracker, sets, NULL, 0, NULL, &result);
        case 3: return qdist_force_closure_f64(busy, sets, NULL, &closure);
        default: return qdist_best_of6_f64(busy, sets, 2, NULL, NULL, &best);
        }
    }
    CHECK(qdist_tracker_init_f64(&tracker, 3) == QDIST_OK);
    switch (function % 5) {
    case 0: return qdist_depth3_f64(busy, &body, &body, NULL, &depth);
    case 1: return qdist_solve3_f64(busy, &body.set, NULL, NULL, &result);
    case 2: return qdist_solve_in_span_f64(busy, &body.set, NULL, NULL, &result);
    case 3: return qdist_solve_warm3_f64(busy, &tracker, &body.set, NULL, 0, NULL, &result);
    default: return qdist_hull_prepare_f64(&hull, busy, corners, 6, NULL, NULL, graph, QDIST_HULL_GRAPH_LEN(6));
    }
}

static void maybe_enter(void) {
    if (entry.moment < 0 || entry.moment-- > 0) return;
    entry.entered = 1;
    entry.told = enter_by(entry.function, solvers[entry.dimension]);
}

static int32_t boxed(void *user, const double *u, double *point) {
    const double *half = user;
    maybe_enter();
    for (int k = 0; k < (entry.dimension == IN_SIX ? 6 : 3); ++k) point[k] = u[k] < 0 ? -half[k] : half[k];
    return 0;
}

static double crossed(void *user, const double *u) {
    double most = 0;
    (void)user;
    maybe_enter();
    for (int k = 0; k < (entry.dimension == IN_SIX ? 6 : 3); ++k) most = fmax(most, fabs(u[k]));
    return most;
}

static int32_t late(void *user) {
    (void)user;
    maybe_enter();
    return 0;
}

/* A query of its kind; the answer goes to `answer`, which is cleared before. */
static void query_of(unsigned kind, double *half, void *answer, size_t size) {
    qdist_set_f64 set;
    qdist_unit_f64 unit;
    qdist_options_f64 options;
    qdist_tracker_f64 tracker;
    qdist_body_f64 a, b;
    union {
        qdist_depth_f64 depth;
        qdist_result_f64 result;
        qdist_closure_f64 closure;
    } to;
    qdist_solver *const own = solvers[entry.dimension];
    memset(&set, 0, sizeof set), memset(&unit, 0, sizeof unit), memset(&to, 0, sizeof to);
    set.support = boxed, set.user = half;
    if (kind & 8) set.exhaustive = boxed;
    unit.value = crossed, unit.extent = 3;
    CHECK(qdist_options_default_f64(&options) == QDIST_OK && qdist_tracker_init_f64(&tracker, entry.dimension == IN_SIX ? 6 : 3) == QDIST_OK);
    options.interrupt = late, options.relative = 1e-2, options.max_iterations = 60;
    qdist_status status = QDIST_OK;
    const qdist_unit_f64 *q = kind & 16 ? &unit : NULL;
    switch (entry.dimension * 4 + kind % 4) {
    case 0:
        to.depth.struct_size = sizeof to.depth;
        CHECK(qdist_body_set_f64(&a, &set) == QDIST_OK);
        b = a, b.translation[0] = half[0], b.translation[1] = 0.25 * half[1];
        status = qdist_depth3_f64(own, &a, &b, &options, &to.depth);
        break;
    case 1: to.result.struct_size = sizeof to.result, status = qdist_solve3_f64(own, &set, q, &options, &to.result); break;
    case 2: case 6: to.result.struct_size = sizeof to.result, status = qdist_solve_in_span_f64(own, &set, q, &options, &to.result); break;
    case 3: to.result.struct_size = sizeof to.result, status = qdist_solve_warm3_f64(own, &tracker, &set, q, 0, &options, &to.result); break;
    case 4: to.closure.struct_size = sizeof to.closure, status = qdist_force_closure_f64(own, &set, &options, &to.closure); break;
    case 5: to.result.struct_size = sizeof to.result, status = qdist_solve6_f64(own, &set, q, &options, &to.result); break;
    default: to.result.struct_size = sizeof to.result, status = qdist_solve_warm6_f64(own, &tracker, &set, q, 0, &options, &to.result); break;
    }
    CHECK(status == QDIST_OK && sizeof to <= size);
    memcpy(answer, &to, sizeof to);
}

static void used_at_any_moment(void) {
    static unsigned char alone[4096], entered[4096];
    static uint64_t space[QDIST_WORKSPACE_WORDS_F64(3, 64, 128)], six[QDIST_WORKSPACE_WORDS_F64(6, 32, 256)];
    int disturbed = 0;
    CHECK(qdist_solver_init_f64(space, sizeof space, 3, 64, 128, &solvers[IN_SPACE]) == QDIST_OK);
    CHECK(qdist_solver_init_f64(six, sizeof six, 6, 32, 256, &solvers[IN_SIX]) == QDIST_OK);
    for (int k = 0; k < 400; ++k) {
        const unsigned kind = below(32);
        double half[6];
        for (int i = 0; i < 6; ++i) half[i] = between(0.5, 2);
        entry.dimension = k % 2 ? IN_SIX : IN_SPACE, entry.function = below(5), entry.entered = 0, entry.told = QDIST_OK;
        entry.moment = -1;
        memset(alone, 0, sizeof alone), memset(entered, 0, sizeof entered);
        query_of(kind, half, alone, sizeof alone);
        entry.moment = (int)below(k % 4 < 2 ? 10 : 100);
        query_of(kind, half, entered, sizeof entered);
        CHECK(!entry.entered || entry.told == QDIST_ERROR_BUSY);
        CHECK(memcmp(alone, entered, sizeof alone) == 0);
        disturbed += entry.entered;
    }
    CHECK(disturbed > 200);
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
    used_at_any_moment();
    numbers_that_are_none();
    return finish("callbacks");
}
