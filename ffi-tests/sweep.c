/* Every function of qdist.h and qdist_grasp.h with every number of its arguments replaced by what it must not be or hardly ever is: NaN, infinite,
 * huge, negative, zero, subnormal. A call that fails has written nothing; one that works has written every byte of its results, the padding
 * included, and no NaN or infinity. NaN and infinity are refused wherever they are read. The file includes itself once for each scalar type. */
#ifndef REAL

#include "qdist_grasp.h"
#include "test.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { SLOTS = 32, OUTPUTS = 4, REALS = 16, IMAGE = 16384 };

/* Numbers of an argument. */
enum reading { SOME, ALL, LIE };
static struct {
    void *at;
    unsigned count;
    int read; /* SOME: not all is read, and NaN and infinity need not be refused. LIE: what the set says of itself */
} slots[SLOTS];
/* What a function writes. */
static struct {
    void *at;
    size_t size;
    int sized; /* begins with struct_size, which is set before the call */
} outputs[OUTPUTS];
/* The numbers in it. */
static struct {
    const void *at;
    unsigned count;
} reals[REALS];
/* A struct_size within a result. */
static uint32_t *inner, inner_size;
static unsigned slot_count, output_count, real_count;
static int complaints;

static void slot(void *at, unsigned count, int read) {
    slots[slot_count].at = at, slots[slot_count].count = count, slots[slot_count++].read = read;
}

static void output(void *at, size_t size, int sized) {
    outputs[output_count].at = at, outputs[output_count].size = size, outputs[output_count++].sized = sized;
}

static void numbers(const void *at, unsigned count) { reals[real_count].at = at, reals[real_count++].count = count; }

/* The outputs full of a pattern. */
static void poison(int pattern) {
    for (unsigned i = 0; i < output_count; ++i) {
        const uint32_t size = (uint32_t)outputs[i].size;
        memset(outputs[i].at, pattern, outputs[i].size);
        if (outputs[i].sized) memcpy(outputs[i].at, &size, sizeof size);
    }
    if (inner) *inner = inner_size;
}

/* All outputs in a row. */
static size_t image(unsigned char *to) {
    size_t size = 0;
    for (unsigned i = 0; i < output_count; ++i) memcpy(to + size, outputs[i].at, outputs[i].size), size += outputs[i].size;
    return size;
}

/* How a call went, with the outputs poisoned in two ways. */
enum verdict { FINE, REFUSED, WRITES_ON_ERROR, LEAVES_BYTES, DISAGREES };

static enum verdict called(qdist_status (*run)(void), void (*prepare)(void), qdist_status *status) {
    static unsigned char before[2][IMAGE], after[2][IMAGE];
    static const int patterns[2] = {0x5A, 0xC3};
    qdist_status got[2];
    size_t size = 0;
    for (int i = 0; i < 2; ++i) {
        prepare();
        poison(patterns[i]);
        image(before[i]);
        got[i] = run();
        size = image(after[i]);
    }
    *status = got[0];
    if (got[0] != got[1]) return DISAGREES;
    if (got[0] != QDIST_OK && got[0] != QDIST_ERROR_CALLBACK) {
        return memcmp(before[0], after[0], size) || memcmp(before[1], after[1], size) ? WRITES_ON_ERROR : REFUSED;
    }
    return memcmp(after[0], after[1], size) ? LEAVES_BYTES : FINE;
}

#define JOIN_(name, suffix) name##suffix
#define JOIN(name, suffix) JOIN_(name, suffix)
#define Q(name) JOIN(name, SUFFIX)

#define REAL double
#define SUFFIX _f64
#define WORDS QDIST_WORKSPACE_WORDS_F64
#define LARGEST DBL_MAX
#define SUBNORMAL 5e-324
#include "sweep.c"
#undef REAL
#undef SUFFIX
#undef WORDS
#undef LARGEST
#undef SUBNORMAL

#define REAL float
#define SUFFIX _f32
#define WORDS QDIST_WORKSPACE_WORDS_F32
#define LARGEST FLT_MAX
#define SUBNORMAL 1e-45f
#include "sweep.c"

int main(void) {
    sweep_f64();
    sweep_f32();
    return finish("sweep");
}

#else

static uint64_t Q(memory)[5][WORDS(6, 64, 512)];
static qdist_solver *Q(solver)[7];

/* Arguments and results of all functions. */
static struct {
    Q(qdist_box) box;
    Q(qdist_sphere) sphere;
    Q(qdist_ellipsoid) ellipsoid;
    Q(qdist_cylinder) cylinder;
    Q(qdist_capsule) capsule;
    Q(qdist_cone) cone;
    REAL tips[72], matrix[36], turn[9], limits[8], three[2][3], six[6];
    Q(qdist_points) points;
    Q(qdist_hull) hull;
    uint16_t graph[QDIST_HULL_GRAPH_LEN(6)];
    Q(qdist_body) a, b;
    Q(qdist_set) set, other, sets[2];
    Q(qdist_pair) pair;
    Q(qdist_linear) linear;
    Q(qdist_unit) unit;
    Q(qdist_box_unit) cube;
    Q(qdist_ellipsoid_unit) egg;
    Q(qdist_cross_unit) cross;
    Q(qdist_segment_unit) segment;
    Q(qdist_options) options;
    Q(qdist_tracker) tracker;
    Q(qdist_depth) depth;
    Q(qdist_result) result, answer;
    REAL lower, moved, radius, tolerance;
    Q(qdist_contact) contacts[3];
    Q(qdist_wrench_frame) frame;
    Q(qdist_primitive) primitives[3];
    Q(qdist_wrenches) wrenches;
    Q(qdist_active) active;
    uint32_t which, dimension;
    REAL basis[36], shares[18], forces[48], wrench[6], force[4];
    Q(qdist_closure) closure;
    Q(qdist_best) best;
    Q(qdist_force_memory) memory;
    Q(qdist_force_options) force_options;
    Q(qdist_forces) found;
    Q(qdist_refined) refined;
    Q(qdist_contact_gradient) gradients[3];
    Q(qdist_finger) finger;
    Q(qdist_finger_wrenches) fingers;
    Q(qdist_layout) layout;
    Q(qdist_preset) preset;
    REAL edges[6 * 3 * 10];
    uint32_t edge_count;
    uint32_t large_graph[QDIST_HULL_LARGE_GRAPH_LEN(6)], scratch[QDIST_HULL_LARGE_WORKSPACE_LEN(6)];
    Q(qdist_hull_large) large;
    Q(qdist_half_space) ground;
    Q(qdist_join) join;
    Q(qdist_body) joined;
    Q(qdist_disc) disc;
    Q(qdist_box2) rectangle;
    Q(qdist_ellipse) oval;
    Q(qdist_capsule2) stadium;
    Q(qdist_half_plane) side;
    Q(qdist_join2) join2;
    Q(qdist_body2) flat, other_flat, joined_flat;
    Q(qdist_pyramid) pyramids[3];
    Q(qdist_pyramid_wrenches) pyramid_wrenches;
} Q(w);
#define W Q(w)

/* Cases: `prepare` makes valid arguments and says what they and the results are, `run` calls. */
static REAL *Q(victim);
static REAL Q(value);

static void Q(arguments)(void) {
    static const REAL identity[36] = {1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1};
    memset(&W, 0, sizeof W);
    slot_count = output_count = real_count = 0, inner = NULL;
    for (int k = 0; k < 3; ++k) {
        W.box.half[k] = (REAL)(k + 1), W.ellipsoid.semi_axes[k] = (REAL)(k + 1);
        W.three[0][k] = (REAL)0.1, W.three[1][k] = (REAL)0.2;
        W.turn[4 * k] = 1;
    }
    W.sphere.radius = W.disc.radius = 1;
    W.rectangle.half[0] = W.oval.semi_axes[0] = 1, W.rectangle.half[1] = W.oval.semi_axes[1] = 2;
    W.stadium.radius = W.stadium.half_height = 1;
    W.ground.normal[2] = W.side.normal[1] = 2, W.ground.offset = W.side.offset = (REAL)0.5;
    W.cylinder.radius = W.capsule.radius = W.cone.radius = 1;
    W.cylinder.half_height = W.capsule.half_height = W.cone.half_height = 1;
    memcpy(W.matrix, identity, sizeof identity);
    W.points.points = W.tips, W.points.count = 12, W.points.dimension = 6;
    for (int k = 0; k < 6; ++k) {
        W.tips[12 * k + k] = (REAL)(1 + 0.1 * k), W.tips[12 * k + 6 + k] = (REAL)(-1.1);
        W.cube.half[k] = W.egg.semi_axes[k] = W.cross.semi_axes[k] = W.segment.end[k] = (REAL)(1 + 0.1 * k);
        W.six[k] = (REAL)(0.1 * (k + 1));
    }
    W.cube.dimension = W.egg.dimension = W.cross.dimension = W.segment.dimension = 6;
    W.radius = 1, W.moved = (REAL)0.01;
    Q(qdist_options_default)(&W.options);
    W.options.relative = (REAL)1e-2, W.options.max_iterations = 100;
    Q(qdist_body_box)(&W.a, &W.box);
    Q(qdist_body_capsule)(&W.b, &W.capsule);
    W.b.translation[0] = (REAL)1.5;
    Q(qdist_body2_box)(&W.flat, &W.rectangle);
    Q(qdist_body2_capsule)(&W.other_flat, &W.stadium);
    W.other_flat.translation[0] = (REAL)1.5;
    W.join.a = &W.a, W.join.b = &W.b, W.join2.a = &W.flat, W.join2.b = &W.other_flat;
    for (int i = 0; i < 3; ++i) {
        static const REAL normals[3][2] = {{1, 0}, {(REAL)-0.5, (REAL)0.8660254037844386}, {(REAL)-0.5, (REAL)-0.8660254037844386}};
        Q(qdist_contact) *contact = &W.contacts[i];
        for (int k = 0; k < 2; ++k) contact->normal[k] = normals[i][k], contact->position[k] = -normals[i][k];
        contact->friction = QDIST_SOFT, contact->mu = (REAL)0.5, contact->mus = (REAL)0.2, contact->force_cap = 1;
        contact->actuated = 1, contact->joints = 8;
        for (int k = 0; k < 4; ++k) contact->jacobian[9 * k] = 1;
    }
    W.frame.torque_scale = 1;
    Q(qdist_primitives)(W.contacts, 3, &W.frame, 0, 0, W.primitives, NULL);
    W.wrenches.primitives = W.primitives, W.wrenches.count = 3, W.wrenches.norm = QDIST_LINF;
    for (int k = 0; k < 8; ++k) W.limits[k] = (REAL)0.7;
    W.layout.kind = QDIST_LAYOUT_INSCRIBED, W.layout.sides = 8;
    W.force_options.struct_size = sizeof W.force_options, W.force_options.relative = (REAL)1e-2, W.force_options.limit = 100;
}

static void Q(poisoned)(void) {
    if (Q(victim)) *Q(victim) = Q(value);
}

/* The victim is named by slot and place, since `prepare` makes the arguments anew. */
static unsigned Q(at_slot), Q(at_place);
static void Q(choose)(void) {
    Q(victim) = slot_count > Q(at_slot) ? (REAL *)slots[Q(at_slot)].at + Q(at_place) : NULL;
    Q(poisoned)();
}

#define CASE(name, setup, call)             \
    static void Q(prepare_##name)(void) {    \
        Q(arguments)();                      \
        setup;                               \
        Q(choose)();                         \
    }                                        \
    static qdist_status Q(run_##name)(void) { return call; }
#define SET_OUTPUT(set) output(&(set), sizeof(set), 0), numbers(&(set).radius, 3)
#define BODY_OUTPUT(body)                                                                                          \
    output(&(body), sizeof(body), 0), numbers(&(body).set.radius, 3), numbers((body).rotation, 9), numbers((body).translation, 3), \
        numbers((body).center, 3), numbers(&(body).rolling_radius, 8)
#define FLAT_OUTPUT(body)                                                                                          \
    output(&(body), sizeof(body), 0), numbers(&(body).set.radius, 3), numbers((body).rotation, 4), numbers((body).translation, 2), \
        numbers((body).center, 2), numbers(&(body).rolling_radius, 6)
#define SET_SLOT(set) slot(&(set).radius, 1, ALL), slot(&(set).extent, 1, LIE), slot(&(set).error, 1, ALL)
#define BODY_SLOT(body)                                                                                         \
    SET_SLOT((body).set), slot((body).rotation, 9, ALL), slot((body).translation, 3, ALL), slot((body).center, 3, SOME), \
        slot(&(body).rolling_radius, 1, ALL), slot(&(body).spread, 1, ALL), slot((body).extents, 3, LIE), slot((body).errors, 3, LIE)
#define FLAT_SLOT(body)                                                                                         \
    SET_SLOT((body).set), slot((body).rotation, 4, ALL), slot((body).translation, 2, ALL), slot((body).center, 2, SOME), \
        slot(&(body).rolling_radius, 1, ALL), slot(&(body).spread, 1, ALL), slot((body).extents, 2, LIE), slot((body).errors, 2, LIE)
#define OPTIONS_SLOT() slot(&W.options.absolute, 1, ALL), slot(&W.options.relative, 1, ALL), slot(&W.options.threshold, 1, SOME), slot(W.options.guess, 6, SOME)
#define UNIT_SLOT() slot(&W.unit.extent, 1, ALL), slot(&W.unit.ball_radius, 1, ALL), slot(&W.unit.inner_radius, 1, ALL)
#define RESULT_OUTPUT(result)                                                                                                    \
    numbers(&(result).lower, 2), numbers((result).direction, 6), numbers((result).support, 6), numbers(&(result).unit, 1),      \
        numbers((result).rival, 6), numbers((result).weights, 7), numbers((result).points, 42)
#define UNIT_OUTPUT() output(&W.unit, sizeof W.unit, 0), numbers(&W.unit.extent, 3)
#define CONTACT_SLOT(contact)                                                                                              \
    slot((contact).position, 3, ALL), slot((contact).normal, 3, ALL), slot((contact).tangents, 6, ALL), slot(&(contact).mu, 1, ALL), \
        slot(&(contact).mus, 1, ALL), slot(&(contact).force_cap, 1, ALL)
#define FRAME_SLOT() slot(W.frame.reference, 3, ALL), slot(&W.frame.torque_scale, 1, ALL)
#define PRIMITIVE_SLOT(primitive) slot((primitive).center, 6, ALL), slot((primitive).disc, 18, ALL), slot((primitive).rounding, 6, ALL)
#define FINGER()                                                                                                       \
    Q(qdist_finger_init)(&W.finger, W.contacts, 1, &W.frame, W.limits, QDIST_FORCE_MODEL_PASSIVE, 0, NULL), \
        W.fingers.fingers = &W.finger, W.fingers.count = 1, W.fingers.norm = QDIST_LINF
#define PYRAMIDS()                                                                                       \
    Q(qdist_pyramids)(W.contacts, 3, &W.frame, &W.layout, W.edges, 30, W.pyramids, NULL), \
        W.pyramid_wrenches.pyramids = W.pyramids, W.pyramid_wrenches.count = 3, W.pyramid_wrenches.norm = QDIST_L1

CASE(body_box, (slot(W.box.half, 3, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_box)(&W.a, &W.box))
CASE(body_sphere, (slot(&W.sphere.radius, 1, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_sphere)(&W.a, &W.sphere))
CASE(body_ellipsoid, (slot(W.ellipsoid.semi_axes, 3, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_ellipsoid)(&W.a, &W.ellipsoid))
CASE(body_cylinder, (slot(&W.cylinder.radius, 1, ALL), slot(&W.cylinder.half_height, 1, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_cylinder)(&W.a, &W.cylinder))
CASE(body_capsule, (slot(&W.capsule.radius, 1, ALL), slot(&W.capsule.half_height, 1, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_capsule)(&W.a, &W.capsule))
CASE(body_cone, (slot(&W.cone.radius, 1, ALL), slot(&W.cone.half_height, 1, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_cone)(&W.a, &W.cone))
CASE(body_set, (W.set = W.a.set, W.set.radius = 1, SET_SLOT(W.set), BODY_OUTPUT(W.b)), Q(qdist_body_set)(&W.b, &W.set))
CASE(set_points, (slot(W.tips, 72, ALL), SET_OUTPUT(W.set)), Q(qdist_set_points)(&W.set, &W.points))
CASE(body_points, (W.points.dimension = 3, slot(W.tips, 36, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_points)(&W.a, &W.points))
CASE(set_sum, (W.set = W.other = W.a.set, W.other.radius = 1, W.pair.a = &W.set, W.pair.b = &W.other, W.pair.dimension = 3, SET_SLOT(W.set), SET_SLOT(W.other), SET_OUTPUT(W.sets[0])),
     Q(qdist_set_sum)(&W.sets[0], &W.pair))
CASE(set_difference, (W.set = W.other = W.a.set, W.pair.a = &W.set, W.pair.b = &W.other, W.pair.dimension = 3, SET_SLOT(W.set), SET_SLOT(W.other), SET_OUTPUT(W.sets[0])),
     Q(qdist_set_difference)(&W.sets[0], &W.pair))
CASE(set_linear, (W.set = W.b.set, W.linear.set = &W.set, W.linear.matrix = W.matrix, W.linear.rows = 6, W.linear.columns = 3, SET_SLOT(W.set), slot(W.matrix, 18, ALL), slot(W.linear.translation, 6, ALL), SET_OUTPUT(W.sets[0])),
     Q(qdist_set_linear)(&W.sets[0], &W.linear))
CASE(set_join, (W.set = W.other = W.a.set, W.other.radius = 1, W.pair.a = &W.set, W.pair.b = &W.other, W.pair.dimension = 3, SET_SLOT(W.set), SET_SLOT(W.other), SET_OUTPUT(W.sets[0])),
     Q(qdist_set_join)(&W.sets[0], &W.pair))
CASE(half_space, (slot(W.ground.normal, 3, ALL), slot(&W.ground.offset, 1, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_half_space)(&W.a, &W.ground))
CASE(body_join, (BODY_SLOT(W.a), BODY_SLOT(W.b), BODY_OUTPUT(W.joined)), Q(qdist_body_join)(&W.joined, &W.join))
CASE(disc, (slot(&W.disc.radius, 1, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_disc)(&W.flat, &W.disc))
CASE(rectangle, (slot(W.rectangle.half, 2, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_box)(&W.flat, &W.rectangle))
CASE(oval, (slot(W.oval.semi_axes, 2, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_ellipse)(&W.flat, &W.oval))
CASE(stadium, (slot(&W.stadium.radius, 1, ALL), slot(&W.stadium.half_height, 1, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_capsule)(&W.flat, &W.stadium))
CASE(polygon, (W.points.dimension = 2, slot(W.tips, 24, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_points)(&W.flat, &W.points))
CASE(flat_set, (W.set = W.flat.set, W.set.radius = 1, SET_SLOT(W.set), FLAT_OUTPUT(W.flat)), Q(qdist_body2_set)(&W.flat, &W.set))
CASE(half_plane, (slot(W.side.normal, 2, ALL), slot(&W.side.offset, 1, ALL), FLAT_OUTPUT(W.flat)), Q(qdist_body2_half_plane)(&W.flat, &W.side))
CASE(flat_join, (FLAT_SLOT(W.flat), FLAT_SLOT(W.other_flat), FLAT_OUTPUT(W.joined_flat)), Q(qdist_body2_join)(&W.joined_flat, &W.join2))
#define DEPTH_OUTPUT() output(&W.depth, sizeof W.depth, 1), numbers(&W.depth.lower, 2), numbers(W.depth.normal, 3), numbers(W.depth.point_a, 3), numbers(W.depth.point_b, 3)
CASE(depth2, (FLAT_SLOT(W.flat), FLAT_SLOT(W.other_flat), OPTIONS_SLOT(), DEPTH_OUTPUT()), Q(qdist_depth2)(Q(solver)[2], &W.flat, &W.other_flat, &W.options, &W.depth))
CASE(on_ground, (Q(qdist_body_half_space)(&W.a, &W.ground), slot(W.ground.normal, 3, ALL), slot(&W.ground.offset, 1, ALL), slot(W.a.rotation, 9, ALL), slot(W.a.translation, 3, ALL), BODY_SLOT(W.b), DEPTH_OUTPUT()),
     Q(qdist_depth3)(Q(solver)[3], &W.b, &W.a, &W.options, &W.depth))
CASE(unit_ball, (slot(&W.radius, 1, ALL), UNIT_OUTPUT()), Q(qdist_unit_ball)(&W.unit, W.radius))
CASE(unit_box, (slot(W.cube.half, 6, ALL), UNIT_OUTPUT()), Q(qdist_unit_box)(&W.unit, &W.cube))
CASE(unit_ellipsoid, (W.egg.rotation = W.matrix, slot(W.egg.semi_axes, 6, ALL), slot(W.matrix, 36, ALL), UNIT_OUTPUT()), Q(qdist_unit_ellipsoid)(&W.unit, &W.egg))
CASE(unit_cross, (slot(W.cross.semi_axes, 6, ALL), UNIT_OUTPUT()), Q(qdist_unit_cross)(&W.unit, &W.cross))
CASE(unit_segment, (slot(W.segment.end, 6, ALL), UNIT_OUTPUT()), Q(qdist_unit_segment)(&W.unit, &W.segment))
CASE(unit_vertices, (slot(W.tips, 72, ALL), UNIT_OUTPUT()), Q(qdist_unit_vertices)(&W.unit, &W.points))
CASE(options_default, (output(&W.options, sizeof W.options, 0)), Q(qdist_options_default)(&W.options))
#define TIPS(n)                                                                                     \
    (W.points.dimension = n, W.points.count = 2 * n, memset(W.tips, 0, sizeof W.tips), Q(tips)(n),  \
     Q(qdist_set_points)(&W.set, &W.points), W.cube.dimension = n, Q(qdist_unit_box)(&W.unit, &W.cube))
static void Q(tips)(unsigned n) {
    for (unsigned k = 0; k < n; ++k) W.tips[2 * n * k + k] = (REAL)(1 + 0.1 * k), W.tips[2 * n * k + n + k] = (REAL)(-1.1);
}
CASE(hull, (TIPS(3), slot(W.tips, 18, ALL), output(&W.hull, sizeof W.hull, 0)), Q(qdist_hull_prepare)(&W.hull, Q(solver)[3], W.tips, 6, NULL, NULL, W.graph, sizeof W.graph / 2))
CASE(large, (TIPS(3), slot(W.tips, 18, ALL), output(&W.large, sizeof W.large, 0)), Q(qdist_hull_large_prepare)(&W.large, W.scratch, sizeof W.scratch / 4, W.tips, 6, NULL, NULL, W.large_graph, sizeof W.large_graph / 4))
CASE(body_hull, (TIPS(3), Q(qdist_hull_prepare)(&W.hull, Q(solver)[3], W.tips, 6, NULL, NULL, W.graph, sizeof W.graph / 2), slot(W.tips, 18, ALL), BODY_OUTPUT(W.a)), Q(qdist_body_hull)(&W.a, &W.hull))
CASE(body_large, (TIPS(3), Q(qdist_hull_large_prepare)(&W.large, W.scratch, sizeof W.scratch / 4, W.tips, 6, NULL, NULL, W.large_graph, sizeof W.large_graph / 4), slot(W.tips, 18, ALL), BODY_OUTPUT(W.a)),
     Q(qdist_body_hull_large)(&W.a, &W.large))
CASE(depth3, (BODY_SLOT(W.a), BODY_SLOT(W.b), OPTIONS_SLOT(), output(&W.depth, sizeof W.depth, 1), numbers(&W.depth.lower, 2), numbers(W.depth.normal, 3), numbers(W.depth.point_a, 3), numbers(W.depth.point_b, 3)),
     Q(qdist_depth3)(Q(solver)[3], &W.a, &W.b, &W.options, &W.depth))
CASE(depth3_far, (W.a.spread = 4, BODY_SLOT(W.a), slot(W.a.center, 3, ALL), output(&W.depth, sizeof W.depth, 1), numbers(&W.depth.lower, 2), numbers(W.depth.normal, 3), numbers(W.depth.point_a, 3), numbers(W.depth.point_b, 3)),
     Q(qdist_depth3)(Q(solver)[3], &W.a, &W.b, &W.options, &W.depth))

/* Queries in every dimension, of a cross-polytope in a box. */
#define QUERIES(n)                                                                                                                    \
    CASE(solve##n, (TIPS(n), SET_SLOT(W.set), OPTIONS_SLOT(), UNIT_SLOT(), output(&W.result, sizeof W.result, 1), RESULT_OUTPUT(W.result)), \
         Q(qdist_solve##n)(Q(solver)[n], &W.set, &W.unit, &W.options, &W.result))                                                   \
    CASE(ball##n, (TIPS(n), SET_SLOT(W.set), OPTIONS_SLOT(), output(&W.result, sizeof W.result, 1), RESULT_OUTPUT(W.result)),        \
         Q(qdist_solve##n)(Q(solver)[n], &W.set, NULL, &W.options, &W.result))                                                       \
    CASE(span##n, (TIPS(n), SET_SLOT(W.set), OPTIONS_SLOT(), UNIT_SLOT(), output(&W.result, sizeof W.result, 1), RESULT_OUTPUT(W.result)), \
         Q(qdist_solve_in_span)(Q(solver)[n], &W.set, &W.unit, &W.options, &W.result))                                           \
    CASE(warm##n, (TIPS(n), Q(qdist_tracker_init)(&W.tracker, n), W.tracker.directions[0][0] = 1, SET_SLOT(W.set), OPTIONS_SLOT(), UNIT_SLOT(), slot(&W.moved, 1, ALL), \
                   slot(&W.tracker.lower, 1, ALL), slot(W.tracker.directions[0], n, ALL), output(&W.result, sizeof W.result, 1), RESULT_OUTPUT(W.result)),               \
         Q(qdist_solve_warm##n)(Q(solver)[n], &W.tracker, &W.set, &W.unit, W.moved, &W.options, &W.result))
QUERIES(2)
QUERIES(3)
QUERIES(4)
QUERIES(5)
QUERIES(6)
CASE(tracker, (output(&W.tracker, sizeof W.tracker, 0), numbers(&W.tracker.lower, 1), numbers(W.tracker.directions[0], 24)), Q(qdist_tracker_init)(&W.tracker, 3))
CASE(lower_after, (TIPS(3), Q(qdist_tracker_init)(&W.tracker, 3), W.tracker.lower = 1, slot(&W.tracker.lower, 1, ALL), slot(W.tracker.directions[0], 3, ALL), slot(&W.moved, 1, ALL), UNIT_SLOT(), output(&W.lower, sizeof W.lower, 0), numbers(&W.lower, 1)),
     Q(qdist_tracker_lower_after)(&W.tracker, &W.unit, W.moved, &W.lower))

CASE(passive, (CONTACT_SLOT(W.contacts[1]), FRAME_SLOT(), output(W.primitives, sizeof W.primitives, 0), numbers(W.primitives[1].center, 25)),
     Q(qdist_primitives)(W.contacts, 3, &W.frame, 0, 0, W.primitives, &W.which))
CASE(actives, (CONTACT_SLOT(W.contacts[1]), slot(W.contacts[1].jacobian, 32, ALL), FRAME_SLOT(), slot(&W.tolerance, 1, ALL), output(W.primitives, sizeof W.primitives, 0), numbers(W.primitives[1].center, 25)),
     Q(qdist_primitives)(W.contacts, 3, &W.frame, 1, W.tolerance, W.primitives, &W.which))
CASE(active, (CONTACT_SLOT(W.contacts[1]), slot(W.contacts[1].jacobian, 32, ALL), FRAME_SLOT(), slot(&W.tolerance, 1, ALL), output(&W.active, sizeof W.active, 0), numbers(&W.active.delta, 1)),
     Q(qdist_active_forces)(&W.contacts[1], &W.frame, W.tolerance, &W.active))
CASE(subspace, (PRIMITIVE_SLOT(W.primitives[1]), slot(&W.tolerance, 1, ALL), output(W.basis, sizeof W.basis, 0), output(&W.dimension, sizeof W.dimension, 0), numbers(W.basis, 36)),
     Q(qdist_wrench_subspace)(W.primitives, 3, W.tolerance, &W.dimension, W.basis))
CASE(set_wrenches, (PRIMITIVE_SLOT(W.primitives[1]), SET_OUTPUT(W.set)), Q(qdist_set_wrenches)(&W.set, &W.wrenches))
CASE(closure, (Q(qdist_set_wrenches)(&W.set, &W.wrenches), SET_SLOT(W.set), OPTIONS_SLOT(), output(&W.closure, sizeof W.closure, 1), numbers(&W.closure.radius, 1), numbers(W.closure.direction, 6)),
     Q(qdist_force_closure)(Q(solver)[6], &W.set, &W.options, &W.closure))
CASE(best, (Q(qdist_set_wrenches)(&W.sets[0], &W.wrenches), W.sets[1] = W.sets[0], SET_SLOT(W.sets[1]), OPTIONS_SLOT(), output(&W.best, sizeof W.best, 1), numbers(&W.best.ceiling, 1), RESULT_OUTPUT(W.best.result), inner = &W.best.result.struct_size, inner_size = sizeof W.best.result),
     Q(qdist_best_of6)(Q(solver)[6], W.sets, 2, NULL, &W.options, &W.best))
CASE(wrench, (FRAME_SLOT(), slot(W.three[0], 3, ALL), slot(W.three[1], 3, ALL), output(W.wrench, sizeof W.wrench, 0), numbers(W.wrench, 6)),
     Q(qdist_wrench)(&W.frame, W.three[0], W.three[1], W.wrench))
CASE(forces, (PRIMITIVE_SLOT(W.primitives[1]), slot(W.six, 6, ALL), slot(W.memory.directions, 36, ALL), slot(&W.force_options.relative, 1, ALL), slot(&W.force_options.limit, 1, ALL), output(W.shares, sizeof W.shares, 0), output(&W.found, sizeof W.found, 1),
              numbers(W.shares, 18), numbers(&W.found.lower, 2), numbers(W.found.direction, 6), numbers(&W.found.residual, 1)),
     Q(qdist_contact_forces)(&W.wrenches, &W.memory, W.six, &W.force_options, W.shares, &W.found))
CASE(force_memory, (output(&W.memory, sizeof W.memory, 0), numbers(W.memory.directions, 36)),
     (memset(&W.memory, 0, sizeof W.memory), W.found.struct_size = sizeof W.found, Q(qdist_contact_forces)(&W.wrenches, &W.memory, W.six, NULL, W.shares, &W.found)))
CASE(force, (CONTACT_SLOT(W.contacts[1]), FRAME_SLOT(), slot(W.six, 6, ALL), output(W.force, sizeof W.force, 0), numbers(W.force, 4)),
     Q(qdist_contact_force)(&W.contacts[1], &W.frame, W.six, W.force))
CASE(gradients, (Q(qdist_set_wrenches)(&W.set, &W.wrenches), W.answer.struct_size = sizeof W.answer, Q(qdist_solve6)(Q(solver)[6], &W.set, NULL, &W.options, &W.answer), CONTACT_SLOT(W.contacts[1]), FRAME_SLOT(), PRIMITIVE_SLOT(W.primitives[1]), slot(&W.answer.lower, 1, ALL), slot(&W.answer.upper, 1, ALL), slot(W.answer.direction, 6, ALL), slot(W.answer.support, 6, ALL), slot(&W.answer.unit, 1, ALL),
                 output(&W.refined, sizeof W.refined, 1), output(W.gradients, sizeof W.gradients, 0), numbers(&W.refined.upper, 1), numbers(W.refined.direction, 6), numbers(W.gradients[1].position, 44)),
     Q(qdist_grasp_gradients)(&W.wrenches, W.contacts, 3, &W.frame, 0, 0, NULL, &W.answer, &W.refined, W.gradients, &W.which))
CASE(finger_init, (CONTACT_SLOT(W.contacts[0]), slot(W.contacts[0].jacobian, 32, ALL), FRAME_SLOT(), slot(W.limits, 8, SOME), slot(&W.tolerance, 1, ALL)),
     Q(qdist_finger_init)(&W.finger, W.contacts, 1, &W.frame, W.limits, QDIST_FORCE_MODEL_PASSIVE, W.tolerance, &W.which))
CASE(set_fingers, (FINGER(), SET_OUTPUT(W.set)), Q(qdist_set_finger_wrenches)(&W.set, &W.fingers))
CASE(finger_forces, (FINGER(), slot(W.six, 6, ALL), output(W.force, sizeof W.force, 0), numbers(W.force, 4)), Q(qdist_finger_forces)(&W.finger, W.six, W.force))
CASE(finger_contact_forces, (FINGER(), slot(W.six, 6, ALL), slot(&W.force_options.relative, 1, ALL), slot(&W.force_options.limit, 1, ALL), output(W.shares, 6 * sizeof(REAL), 0), output(W.forces, 16 * sizeof(REAL), 0), output(&W.found, sizeof W.found, 1), numbers(W.shares, 6), numbers(W.forces, 16), numbers(&W.found.lower, 2), numbers(W.found.direction, 6), numbers(&W.found.residual, 1)),
     Q(qdist_finger_contact_forces)(&W.fingers, NULL, W.six, &W.force_options, W.shares, W.forces, &W.found))
CASE(graspit, (slot(W.three[0], 3, ALL), slot(&W.radius, 1, ALL), slot(&W.moved, 1, ALL), output(&W.preset, sizeof W.preset, 0), numbers(W.preset.frame.reference, 4), numbers(&W.preset.layout.length, 1)),
     Q(qdist_preset_graspit)(&W.preset, W.three[0], W.radius, W.moved, QDIST_L1))
CASE(dex_net, (slot(W.three[0], 3, ALL), slot(&W.radius, 1, ALL), slot(&W.moved, 1, ALL), output(&W.preset, sizeof W.preset, 0), numbers(W.preset.frame.reference, 4), numbers(&W.preset.layout.length, 1)),
     Q(qdist_preset_dex_net)(&W.preset, W.three[0], W.radius, 8, W.moved))
CASE(frogger, (slot(&W.radius, 1, ALL), output(&W.preset, sizeof W.preset, 0), numbers(W.preset.frame.reference, 4), numbers(&W.preset.layout.length, 1)), Q(qdist_preset_frogger)(&W.preset, 8, W.radius))
CASE(preset_contact, (Q(qdist_preset_frogger)(&W.preset, 8, 1), slot(W.contacts[1].position, 3, ALL), slot(W.contacts[1].normal, 3, ALL), slot(&W.contacts[1].mu, 1, ALL), slot(&W.contacts[1].mus, 1, ALL),
                      output(W.contacts[1].tangents, sizeof W.contacts[1].tangents, 0), output(&W.contacts[1].force_cap, sizeof(REAL), 0), numbers(W.contacts[1].tangents, 6), numbers(&W.contacts[1].force_cap, 1)),
     Q(qdist_preset_contact)(&W.preset, &W.contacts[1]))
CASE(pyramid_edges, (output(&W.edge_count, sizeof W.edge_count, 0)), Q(qdist_pyramid_edges)(&W.layout, QDIST_SOFT, &W.edge_count))
CASE(pyramids, (CONTACT_SLOT(W.contacts[1]), FRAME_SLOT(), output(W.pyramids, sizeof W.pyramids, 0), output(W.edges, 30 * 6 * sizeof(REAL), 0), numbers(W.edges, 180)),
     Q(qdist_pyramids)(W.contacts, 3, &W.frame, &W.layout, W.edges, 30, W.pyramids, &W.which))
CASE(set_pyramids, (PYRAMIDS(), slot(W.edges, 60, ALL), slot(&W.pyramids[1].extent, 1, ALL), slot(&W.pyramids[1].error, 1, ALL), SET_OUTPUT(W.set)), Q(qdist_set_pyramid_wrenches)(&W.set, &W.pyramid_wrenches))
CASE(opposed, (PYRAMIDS(), slot(W.edges, 60, ALL), output(&W.segment, sizeof W.segment, 0), numbers(W.segment.end, 6)), Q(qdist_opposed_mean)(&W.segment, W.pyramids, 3))

static const struct {
    const char *name;
    void (*prepare)(void);
    qdist_status (*run)(void);
} Q(cases)[] = {
#define ENTRY(name) {#name, Q(prepare_##name), Q(run_##name)}
#define ENTRIES(n) ENTRY(solve##n), ENTRY(ball##n), ENTRY(span##n), ENTRY(warm##n)
    ENTRY(body_box), ENTRY(body_sphere), ENTRY(body_ellipsoid), ENTRY(body_cylinder), ENTRY(body_capsule), ENTRY(body_cone),
    ENTRY(body_set), ENTRY(set_points), ENTRY(body_points), ENTRY(set_sum), ENTRY(set_difference), ENTRY(set_linear),
    ENTRY(unit_ball), ENTRY(unit_box), ENTRY(unit_ellipsoid), ENTRY(unit_cross), ENTRY(unit_segment), ENTRY(unit_vertices),
    ENTRY(options_default), ENTRY(hull), ENTRY(depth3), ENTRY(depth3_far), ENTRIES(2), ENTRIES(3), ENTRIES(4), ENTRIES(5), ENTRIES(6),
    ENTRY(tracker), ENTRY(lower_after), ENTRY(passive), ENTRY(actives), ENTRY(active), ENTRY(subspace), ENTRY(set_wrenches),
    ENTRY(closure), ENTRY(best), ENTRY(wrench), ENTRY(forces), ENTRY(force_memory), ENTRY(force), ENTRY(gradients), ENTRY(finger_init),
    ENTRY(set_fingers), ENTRY(finger_forces), ENTRY(finger_contact_forces), ENTRY(graspit), ENTRY(dex_net), ENTRY(frogger),
    ENTRY(pyramids), ENTRY(set_pyramids), ENTRY(opposed), ENTRY(preset_contact), ENTRY(pyramid_edges),
    ENTRY(set_join), ENTRY(half_space), ENTRY(body_join), ENTRY(disc), ENTRY(rectangle), ENTRY(oval), ENTRY(stadium), ENTRY(polygon),
    ENTRY(flat_set), ENTRY(half_plane), ENTRY(flat_join), ENTRY(depth2), ENTRY(on_ground), ENTRY(large), ENTRY(body_hull), ENTRY(body_large),
};

static int Q(all_finite)(void) {
    for (unsigned i = 0; i < real_count; ++i) {
        for (unsigned k = 0; k < reals[i].count; ++k) {
            REAL x;
            memcpy(&x, (const char *)reals[i].at + k * sizeof x, sizeof x);
            if (!(x >= -LARGEST && x <= LARGEST)) return 0;
        }
    }
    return 1;
}

static void Q(sweep)(void) {
    static const char *const verdicts[] = {"fine", "refused", "writes on error", "leaves bytes unwritten", "disagrees with itself"};
    const REAL values[] = {NAN, INFINITY, -INFINITY, LARGEST, -LARGEST, LARGEST / 100, (REAL)(LARGEST * 1e-10), (REAL)sqrt(LARGEST), -1, 0, SUBNORMAL, (REAL)1e-30};
    const unsigned many = sizeof values / sizeof *values;
    for (uint32_t n = 2; n <= 6; ++n) CHECK(Q(qdist_solver_init)(Q(memory)[n - 2], sizeof Q(memory)[0], n, 64, 512, &Q(solver)[n]) == QDIST_OK);
    for (unsigned c = 0; c < sizeof Q(cases) / sizeof *Q(cases); ++c) {
        qdist_status status;
        Q(at_slot) = SLOTS;
        const enum verdict usual = called(Q(cases)[c].run, Q(cases)[c].prepare, &status);
        CHECK(usual == FINE && status == QDIST_OK && Q(all_finite)());
        if (usual != FINE || status != QDIST_OK) printf("%s: %s, %s\n", Q(cases)[c].name, verdicts[usual], qdist_status_string(status));
        const unsigned own = slot_count;
        for (unsigned s = 0; s < own; ++s) {
            for (unsigned place = 0; place < slots[s].count; place += slots[s].count > 9 ? 7 : 1) {
                for (unsigned v = 0; v < many; ++v) {
                    Q(at_slot) = s, Q(at_place) = place, Q(value) = values[v];
                    const enum verdict verdict = called(Q(cases)[c].run, Q(cases)[c].prepare, &status);
                    const int finite = verdict != FINE || Q(all_finite)();
                    const int read = v > 2 || !slots[s].read || verdict == REFUSED;
                    /* A set whose stated extent is a lie may contradict itself. */
                    const int lie = slots[s].read == LIE && status == QDIST_ERROR_CALLBACK;
                    const int sound = verdict <= REFUSED && finite && read && (status != QDIST_ERROR_CALLBACK || lie);
                    CHECK(sound);
                    if (!sound && complaints++ < 200) {
                        printf("%s, slot %u, place %u, %g: %s, %s%s\n", Q(cases)[c].name, s, place, (double)values[v], verdicts[verdict],
                               qdist_status_string(status), finite ? "" : ", not finite");
                    }
                }
            }
        }
    }
}
#undef W
#undef CASE
#undef SET_OUTPUT
#undef BODY_OUTPUT
#undef FLAT_OUTPUT
#undef DEPTH_OUTPUT
#undef SET_SLOT
#undef BODY_SLOT
#undef FLAT_SLOT
#undef OPTIONS_SLOT
#undef UNIT_SLOT
#undef RESULT_OUTPUT
#undef UNIT_OUTPUT
#undef CONTACT_SLOT
#undef FRAME_SLOT
#undef PRIMITIVE_SLOT
#undef FINGER
#undef PYRAMIDS
#undef TIPS
#undef QUERIES
#undef ENTRY
#undef ENTRIES
#endif
