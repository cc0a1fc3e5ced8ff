/* Meshes from C: reports, mass, collision, distance, contacts, depth against closed forms, cold and from tick
 * to tick, a metric of the caller's, cancelling, bad arguments, and that all memory of
 * the caller's allocator comes back. */
#include "qdist_mesh.h"
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An allocator that counts, and checks what it gets back. */
struct account {
    size_t blocks, bytes;
    long total, misfits;
};

/* Before the memory that is handed out. */
struct front {
    void *block;
    size_t size, align;
};

static void *take(void *user, size_t size, size_t align) {
    struct account *account = user;
    struct front front;
    uintptr_t memory;
    if (size == 0 || align == 0 || (align & (align - 1)) != 0) ++account->misfits;
    front.block = malloc(sizeof front + align + size), front.size = size, front.align = align;
    if (front.block == NULL) return NULL;
    memory = ((uintptr_t)front.block + sizeof front + align - 1) & ~(uintptr_t)(align - 1);
    memcpy((void *)(memory - sizeof front), &front, sizeof front);
    ++account->blocks, ++account->total, account->bytes += size;
    return (void *)memory;
}

static void give(void *user, void *memory, size_t size, size_t align) {
    struct account *account = user;
    struct front front;
    memcpy(&front, (char *)memory - sizeof front, sizeof front);
    if (front.size != size || front.align != align) ++account->misfits;
    --account->blocks, account->bytes -= size;
    free(front.block);
}

static struct account account;
static const qdist_allocator counting = {take, give, &account};

static const uint32_t BOX[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

static void box_corners(double x, double y, double z, double *xyz) {
    int i;
    for (i = 0; i < 8; ++i) {
        xyz[3 * i] = i & 1 ? x : -x;
        xyz[3 * i + 1] = i & 2 ? y : -y;
        xyz[3 * i + 2] = i & 4 ? z : -z;
    }
}

/* Half extents; the first `triangles` of twelve. */
static qdist_mesh *box(double x, double y, double z, uint32_t triangles) {
    double xyz[24];
    qdist_mesh *mesh = NULL;
    box_corners(x, y, z, xyz);
    CHECK(qdist_mesh_create(xyz, 8, BOX, triangles, &mesh, NULL) == QDIST_OK && mesh != NULL);
    return mesh;
}

static qdist_mesh_pose at(double x, double y, double z) {
    qdist_mesh_pose pose = {{1, 0, 0, 0}, {0, 0, 0}};
    pose.translation[0] = x, pose.translation[1] = y, pose.translation[2] = z;
    return pose;
}

static void allocator(void) {
    qdist_allocator half = counting;
    CHECK(qdist_mesh_set_allocator(NULL) == QDIST_ERROR_NULL);
    half.free = NULL;
    CHECK(qdist_mesh_set_allocator(&half) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_set_allocator(&counting) == QDIST_OK);
    CHECK(qdist_mesh_set_allocator(&counting) == QDIST_ERROR_ALLOCATOR);
    CHECK(account.total == 0);
}

/* A mesh that cannot be: the status, the place, and nothing else written. */
static void refused(const double *xyz, uint32_t vertices, const uint32_t *triangles, uint32_t count, qdist_status status, uint32_t place) {
    static const char untouched = 0;
    qdist_mesh *const mark = (qdist_mesh *)(void *)&untouched;
    qdist_mesh *mesh = mark;
    uint32_t which = 77;
    CHECK(qdist_mesh_create(xyz, vertices, triangles, count, &mesh, &which) == status);
    CHECK(mesh == mark && which == place);
    CHECK(qdist_mesh_create(xyz, vertices, triangles, count, &mesh, NULL) == status && mesh == mark);
}

static void bad_meshes(void) {
    double xyz[24], bad[24], line[9] = {0, 0, 0, 1, 1, 1, 3, 3, 3};
    uint32_t triangles[36];
    char bytes[64];
    qdist_mesh *mesh = NULL;
    box_corners(1, 2, 3, xyz);
    memcpy(triangles, BOX, sizeof BOX);
    refused(NULL, 8, BOX, 12, QDIST_ERROR_NULL, 77);
    refused(xyz, 8, NULL, 12, QDIST_ERROR_NULL, 77);
    CHECK(qdist_mesh_create(xyz, 8, BOX, 12, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_create(xyz, 8, BOX, 12, &mesh, (uint32_t *)(void *)(bytes + 1 + ((size_t)bytes & 1))) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_mesh_create((double *)(void *)(bytes + 1 + ((size_t)bytes & 1)), 8, BOX, 12, &mesh, NULL) == QDIST_ERROR_ALIGNMENT);
    refused(xyz, 8, BOX, 0, QDIST_ERROR_MESH_EMPTY, 77);
    refused(NULL, 0, NULL, 0, QDIST_ERROR_MESH_EMPTY, 77);
    refused(NULL, 0, BOX, 12, QDIST_ERROR_MESH_INDEX, 0);
    refused(xyz, 7, BOX, 12, QDIST_ERROR_MESH_INDEX, 3);
    triangles[35] = UINT32_MAX;
    refused(xyz, 8, triangles, 12, QDIST_ERROR_MESH_INDEX, 11);
    memcpy(bad, xyz, sizeof bad);
    bad[16] = NAN;
    refused(bad, 8, BOX, 12, QDIST_ERROR_MESH_VERTEX, 5);
    bad[16] = -INFINITY;
    refused(bad, 8, BOX, 12, QDIST_ERROR_MESH_VERTEX, 5);
    bad[16] = 1e61;
    refused(bad, 8, BOX, 12, QDIST_ERROR_MESH_VERTEX, 5);
    triangles[0] = 0, triangles[1] = 1, triangles[2] = 2;
    refused(line, 3, triangles, 1, QDIST_ERROR_MESH_COLLINEAR, 77);
    triangles[1] = 0, triangles[2] = 0;
    refused(line, 3, triangles, 1, QDIST_ERROR_MESH_COLLINEAR, 77);
    qdist_mesh_free(NULL);
    qdist_mesh_pair_free(NULL);
    qdist_mesh_tracker_free(NULL);
    CHECK(account.blocks == 0);
}

static void reports(void) {
    qdist_mesh *solid = box(1, 2, 3, 12), *open = box(1, 2, 3, 11), *broken = NULL;
    qdist_mesh_report report;
    qdist_mesh_mass mass;
    /* The box, one more vertex, one triangle twice and one without area. */
    double xyz[27];
    uint32_t triangles[42];
    memset(&report, 0, sizeof report);
    CHECK(qdist_mesh_check(solid, &report) == QDIST_ERROR_STRUCT_SIZE && report.components == 0);
    report.struct_size = sizeof report;
    CHECK(qdist_mesh_check(NULL, &report) == QDIST_ERROR_NULL && qdist_mesh_check(solid, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_check(solid, &report) == QDIST_OK && report.struct_size == sizeof report);
    CHECK(report.solid == 1 && report.clean == 1 && report.components == 1 && report.open_edges == 0);
    CHECK(report.first_open_edge[0] == QDIST_MESH_NONE && report.first_degenerate_triangle == QDIST_MESH_NONE);
    CHECK(qdist_mesh_check(open, &report) == QDIST_OK && report.solid == 0 && report.clean == 0 && report.open_edges == 3);
    /* The triangle that is missing is (3, 7, 5). */
    CHECK(report.first_open_edge[0] + report.first_open_edge[1] == 8 || report.first_open_edge[0] + report.first_open_edge[1] == 10 ||
          report.first_open_edge[0] + report.first_open_edge[1] == 12);
    CHECK(qdist_mesh_integrate(solid, &mass) == QDIST_OK && fabs(mass.volume - 48) < 1e-12);
    CHECK(fabs(mass.centre[0]) + fabs(mass.centre[1]) + fabs(mass.centre[2]) < 1e-14);
    /* V (b^2 + c^2) / 3 */
    CHECK(fabs(mass.inertia[0] - 16 * 13) < 1e-10 && fabs(mass.inertia[4] - 16 * 10) < 1e-10 && fabs(mass.inertia[8] - 16 * 5) < 1e-10);
    CHECK(fabs(mass.inertia[1]) + fabs(mass.inertia[5]) + fabs(mass.inertia[6]) < 1e-10);
    mass.volume = 7;
    CHECK(qdist_mesh_integrate(open, &mass) == QDIST_ERROR_MESH_NOT_SOLID && mass.volume == 7);
    CHECK(qdist_mesh_integrate(NULL, &mass) == QDIST_ERROR_NULL && qdist_mesh_integrate(solid, NULL) == QDIST_ERROR_NULL);
    box_corners(1, 2, 3, xyz);
    xyz[24] = xyz[25] = xyz[26] = 0;
    memcpy(triangles, BOX, sizeof BOX);
    memcpy(triangles + 36, BOX, 3 * sizeof *BOX);
    triangles[39] = triangles[40] = 2, triangles[41] = 5;
    CHECK(qdist_mesh_create(xyz, 9, triangles, 14, &broken, NULL) == QDIST_OK && qdist_mesh_check(broken, &report) == QDIST_OK);
    CHECK(report.clean == 0 && report.unreferenced_vertices == 1 && report.first_unreferenced_vertex == 8);
    CHECK(report.duplicate_triangles == 1 && report.first_duplicate_triangle == 12);
    CHECK(report.degenerate_triangles == 1 && report.first_degenerate_triangle == 13);
    CHECK(report.non_manifold_edges > 0 && report.first_non_manifold_edge[0] < 8);
    qdist_mesh_free(solid);
    qdist_mesh_free(open);
    qdist_mesh_free(broken);
    CHECK(account.blocks == 0);
}

static void proximity(void) {
    qdist_mesh *a = box(0.5, 0.5, 0.5, 12), *b = box(1, 1, 1, 12);
    qdist_mesh_pair *pair = NULL;
    qdist_mesh_distance distance;
    qdist_mesh_contact contacts[64];
    qdist_mesh_pose pose = at(0, 0, 0), bad;
    uint32_t collides = 7, count = 7, i;
    CHECK(qdist_mesh_pair_create(NULL, b, &pair) == QDIST_ERROR_NULL && qdist_mesh_pair_create(a, NULL, &pair) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_create(a, b, NULL) == QDIST_ERROR_NULL && pair == NULL);
    CHECK(qdist_mesh_pair_create(a, b, &pair) == QDIST_OK);
    /* The pair keeps its meshes. */
    qdist_mesh_free(a);
    qdist_mesh_free(b);
    CHECK(qdist_mesh_pair_collides(NULL, &pose, &collides) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_collides(pair, NULL, &collides) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_collides(pair, &pose, NULL) == QDIST_ERROR_NULL);
    bad = pose, bad.translation[1] = NAN;
    CHECK(qdist_mesh_pair_collides(pair, &bad, &collides) == QDIST_ERROR_NONFINITE);
    bad = pose, bad.translation[1] = 1e61;
    CHECK(qdist_mesh_pair_collides(pair, &bad, &collides) == QDIST_ERROR_NONFINITE);
    bad = pose, bad.rotation[2] = INFINITY;
    CHECK(qdist_mesh_pair_collides(pair, &bad, &collides) == QDIST_ERROR_NONFINITE);
    bad = pose, bad.rotation[0] = 0;
    CHECK(qdist_mesh_pair_collides(pair, &bad, &collides) == QDIST_ERROR_ROTATION);
    bad.rotation[0] = 1.0001;
    CHECK(qdist_mesh_pair_distance(pair, &bad, &distance) == QDIST_ERROR_ROTATION);
    CHECK(qdist_mesh_pair_contacts(pair, &bad, 0.1, contacts, 64, &count) == QDIST_ERROR_ROTATION);
    CHECK(collides == 7 && count == 7);
    /* Contained: the surfaces are apart, the solids are not. */
    CHECK(qdist_mesh_pair_collides(pair, &pose, &collides) == QDIST_OK && collides == 1);
    CHECK(qdist_mesh_pair_distance(pair, &pose, &distance) == QDIST_OK && fabs(distance.distance - 0.5) < 1e-12);
    CHECK(qdist_mesh_pair_distance(pair, &pose, NULL) == QDIST_ERROR_NULL);
    pose = at(0, 0, 1.75);
    CHECK(qdist_mesh_pair_collides(pair, &pose, &collides) == QDIST_OK && collides == 0);
    CHECK(qdist_mesh_pair_distance(pair, &pose, &distance) == QDIST_OK && fabs(distance.distance - 0.25) < 1e-12);
    CHECK(fabs(distance.on_a[2] - 1.25) < 1e-12 && fabs(distance.on_b[2] - 1) < 1e-12);
    CHECK(distance.feature_a <= QDIST_MESH_FACE && distance.feature_b <= QDIST_MESH_FACE);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, NAN, contacts, 64, &count) == QDIST_ERROR_NONFINITE);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, -1, contacts, 64, &count) == QDIST_ERROR_ARGUMENT);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.1, NULL, 64, &count) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.1, contacts, 64, NULL) == QDIST_ERROR_NULL && count == 7);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.1, contacts, 64, &count) == QDIST_OK && count == 0);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.3, NULL, 0, &count) == QDIST_OK && count >= 4 && count <= 64);
    i = count;
    contacts[1].gap = 99;
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.3, contacts, 1, &count) == QDIST_OK && count == i && contacts[1].gap == 99);
    CHECK(qdist_mesh_pair_contacts(pair, &pose, 0.3, contacts, 64, &count) == QDIST_OK && count == i);
    for (i = 0; i < count; ++i) {
        CHECK(fabs(contacts[i].gap - 0.25) < 1e-12 && fabs(contacts[i].normal[2] - 1) < 1e-12);
        CHECK(contacts[i].feature_a == QDIST_MESH_VERTEX || contacts[i].feature_a == QDIST_MESH_EDGE || contacts[i].feature_a == QDIST_MESH_FACE);
    }
    qdist_mesh_pair_free(pair);
    CHECK(account.blocks == 0 && account.bytes == 0);
}

struct watched {
    unsigned calls, until, wrong;
};

static int32_t watch(void *user, const qdist_mesh_progress *progress) {
    struct watched *watched = user;
    if (!(progress->lower >= 0 && progress->lower <= progress->upper && progress->fraction >= 0 && progress->fraction <= 1)) ++watched->wrong;
    return ++watched->calls >= watched->until;
}

/* Convex bodies come free by a translation: the depth is the core's. */
static void depths(void) {
    qdist_mesh *a = box(0.5, 0.4, 0.3, 12), *b = box(1, 1.5, 2, 12), *open = box(0.5, 0.4, 0.3, 11);
    qdist_mesh_pair *pair = NULL, *soup = NULL;
    qdist_mesh_options options, wrong;
    qdist_mesh_depth depth, again;
    qdist_mesh_pose pose = at(1.4, 0.2, -0.1), seed;
    qdist_mesh_mass mass;
    struct watched watched = {0, 1000000000u, 0};
    uint32_t collides, metric;
    CHECK(qdist_mesh_pair_create(a, b, &pair) == QDIST_OK && qdist_mesh_pair_create(open, b, &soup) == QDIST_OK);
    CHECK(qdist_mesh_options_default(NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_options_default(&options) == QDIST_OK && options.struct_size == sizeof options && options.relative == 1e-3);

    memset(&depth, 0, sizeof depth);
    CHECK(qdist_mesh_pair_depth(pair, &pose, NULL, &depth) == QDIST_ERROR_STRUCT_SIZE && depth.upper == 0);
    depth.struct_size = sizeof depth;
    CHECK(qdist_mesh_pair_depth(NULL, &pose, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_depth(pair, NULL, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_depth(pair, &pose, NULL, NULL) == QDIST_ERROR_NULL);
    wrong = options, wrong.struct_size = 1;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_STRUCT_SIZE);
    wrong = options, wrong.metric = QDIST_MESH_OWN;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_NULL);
    wrong.metric = QDIST_MESH_OWN + 1;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = options, wrong.effort = 3;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = options, wrong.relative = NAN;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_NONFINITE);
    wrong.relative = -1;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = options, wrong.pose_count = 1;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_NULL);
    seed = at(NAN, 0, 0), wrong.poses = &seed;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &wrong, &depth) == QDIST_ERROR_NONFINITE);
    CHECK(depth.upper == 0 && depth.outcome == 0 && depth.collision_queries == 0);

    for (metric = QDIST_MESH_DISP; metric <= QDIST_MESH_SIGMA; ++metric) {
        options.metric = metric;
        options.watch = watch, options.watch_user = &watched;
        watched.calls = 0, watched.until = 1000000000u;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_OK);
        CHECK(depth.outcome == QDIST_MESH_CONVERGED || depth.outcome == QDIST_MESH_BOUNDED);
        CHECK(depth.lower <= 0.1 + 1e-12 && depth.upper <= 0.1 * 1.01 && depth.lower <= depth.upper);
        if (metric == QDIST_MESH_DISP) CHECK(depth.upper >= 0.1 - 1e-12);
        CHECK(depth.solid == 1 && depth.collision_queries > 0 && watched.calls > 0 && watched.wrong == 0);
        CHECK(qdist_mesh_pair_collides(pair, &depth.pose, &collides) == QDIST_OK && collides == 0);
        /* The same question has the same answer. */
        again.struct_size = sizeof again;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &again) == QDIST_OK && again.upper == depth.upper);
        CHECK(memcmp(&again.pose, &depth.pose, sizeof depth.pose) == 0);
        /* An answer is a seed, and no later answer is worse. */
        options.poses = &depth.pose, options.pose_count = 1;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &again) == QDIST_OK && again.upper <= depth.upper * (1 + 1e-6));
        /* Cancelled at the first and the third question. */
        for (watched.until = 1; watched.until <= 3; watched.until += 2) {
            watched.calls = 0;
            CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &again) == QDIST_OK);
            CHECK(again.outcome == QDIST_MESH_INTERRUPTED || again.outcome == QDIST_MESH_CONVERGED);
            CHECK(watched.calls <= watched.until && again.lower <= 0.1 + 1e-12 && again.upper >= again.lower);
        }
        options.poses = NULL, options.pose_count = 0, watched.calls = 0, watched.until = 1;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &again) == QDIST_OK);
        CHECK(again.outcome == QDIST_MESH_INTERRUPTED && watched.calls == 1);
        CHECK(again.upper == DBL_MAX || again.upper >= 0.09);
        options.watch = NULL, options.max_queries = 1;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &again) == QDIST_OK && again.outcome == QDIST_MESH_BUDGET);
        options.max_queries = UINT64_MAX;
    }

    /* Separated. */
    seed = at(3, 0, 0);
    CHECK(qdist_mesh_pair_depth(pair, &seed, NULL, &depth) == QDIST_OK && depth.outcome == QDIST_MESH_SEPARATED);
    CHECK(depth.lower == 0 && depth.upper == 0 && fabs(depth.distance.distance - 1.5) < 1e-12);
    CHECK(memcmp(&depth.pose, &seed, sizeof seed) == 0);

    /* An open mesh has no mass of its own. */
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_MESH_NOT_SOLID);
    CHECK(qdist_mesh_integrate(a, &mass) == QDIST_OK);
    options.mass = &mass;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_OK);
    CHECK(depth.solid == 1 && depth.lower == 0 && depth.upper <= 0.1 * 1.01);
    mass.volume = 0;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_ARGUMENT);
    mass.volume = 1, mass.inertia[0] = NAN;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_NONFINITE);
    mass.inertia[0] = 100;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_ARGUMENT);
    memset(mass.inertia, 0, sizeof mass.inertia);
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_ARGUMENT);
    options.metric = QDIST_MESH_DISP;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_OK && depth.lower <= depth.upper);

    qdist_mesh_free(a);
    qdist_mesh_free(open);
    qdist_mesh_pair_free(pair);
    qdist_mesh_pair_free(soup);
    qdist_mesh_free(b);
    CHECK(account.blocks == 0 && account.bytes == 0);
}

/* With convex pieces in both, the depth of boxes is known from both sides. */
static void certified(void) {
    qdist_mesh *a = box(0.5, 0.4, 0.3, 12), *b = box(1, 1.5, 2, 12), *open = box(1, 1, 1, 11), *ca = NULL, *cb = NULL;
    qdist_mesh_pair *pair = NULL;
    qdist_mesh_depth depth;
    const qdist_mesh_pose pose = at(1.4, 0.2, -0.1);
    CHECK(qdist_mesh_certify(NULL, &ca) == QDIST_ERROR_NULL && qdist_mesh_certify(a, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_certify(open, &ca) == QDIST_ERROR_MESH_NOT_SOLID && ca == NULL);
    CHECK(qdist_mesh_certify(a, &ca) == QDIST_OK && qdist_mesh_certify(b, &cb) == QDIST_OK);
    qdist_mesh_free(a), qdist_mesh_free(b), qdist_mesh_free(open);
    CHECK(qdist_mesh_pair_create(ca, cb, &pair) == QDIST_OK);
    depth.struct_size = sizeof depth;
    CHECK(qdist_mesh_pair_depth(pair, &pose, NULL, &depth) == QDIST_OK && depth.outcome == QDIST_MESH_CONVERGED);
    CHECK(0.0999 <= depth.lower && depth.lower <= 0.1 + 1e-12 && 0.1 - 1e-12 <= depth.upper && depth.upper <= 0.1001);
    qdist_mesh_free(ca), qdist_mesh_free(cb), qdist_mesh_pair_free(pair);
    CHECK(account.blocks == 0 && account.bytes == 0);
}

/* A body as heavy as a ball, moment I / V = m in all directions: sigma = |displacement of the centre|^2 + 4 m |q|^2, q being the vector part of the
 * rotation's quaternion. */
struct ballast {
    double moment;
    unsigned calls, broken;
};

static void difference(const qdist_mesh_pose *from, const qdist_mesh_pose *to, double e[3], double *s, double q[3]) {
    const double *a = to->rotation, *b = from->rotation;
    int i;
    for (i = 0; i < 3; ++i) e[i] = to->translation[i] - from->translation[i];
    /* to * conj(from) */
    *s = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    q[0] = a[1] * b[0] - a[0] * b[1] - a[2] * b[3] + a[3] * b[2];
    q[1] = a[2] * b[0] - a[0] * b[2] - a[3] * b[1] + a[1] * b[3];
    q[2] = a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1];
}

static double own_distance(void *user, const qdist_mesh_pose *from, const qdist_mesh_pose *to) {
    struct ballast *ballast = user;
    double e[3], s, q[3];
    difference(from, to, e, &s, q);
    ++ballast->calls;
    if (ballast->broken && ballast->calls > ballast->broken) return ballast->calls % 2 ? NAN : -1;
    return sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 4 * ballast->moment * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]));
}

static void own_model(void *user, const qdist_mesh_pose *from, const qdist_mesh_pose *to, double *gradient, double *hessian) {
    const struct ballast *ballast = user;
    double e[3], s, q[3];
    int i;
    difference(from, to, e, &s, q);
    for (i = 0; i < 6; ++i) {
        if (gradient[i] != 0 || hessian[7 * i] != 0) ++failed;
        gradient[i] = i < 3 ? e[i] : 2 * ballast->moment * s * q[i - 3];
        hessian[7 * i] = i < 3 ? 1 : ballast->moment;
    }
    if (ballast->broken) gradient[ballast->calls % 6] = NAN, hessian[1] = -INFINITY;
}

/* The object norm of a cube as a metric of the caller's has the object norm's depth. */
static void own_metric(void) {
    qdist_mesh *plain = box(0.5, 0.5, 0.5, 12), *wall = box(1, 1.5, 2, 12), *open = box(0.5, 0.5, 0.5, 11), *a = NULL, *b = NULL;
    qdist_mesh_pair *pair = NULL, *soup = NULL;
    /* (b^2 + c^2) / 3 */
    struct ballast ballast = {0.5 / 3, 0, 0};
    qdist_mesh_own_metric own = {sizeof own, QDIST_MESH_SIGMA, {0, 0, 0}, 0.5, own_distance, own_model, &ballast}, wrong;
    qdist_mesh_options options;
    qdist_mesh_depth depth, sigma;
    /* An edge in a face, turned by 30 degrees about y. */
    const qdist_mesh_pose pose = {{0.9659258262890683, 0, 0.25881904510252074, 0}, {1.5, 0.3, 0.2}};
    uint32_t collides;
    unsigned broken;
    CHECK(qdist_mesh_certify(plain, &a) == QDIST_OK && qdist_mesh_certify(wall, &b) == QDIST_OK);
    CHECK(qdist_mesh_pair_create(a, b, &pair) == QDIST_OK && qdist_mesh_pair_create(open, b, &soup) == QDIST_OK);
    CHECK(qdist_mesh_options_default(&options) == QDIST_OK);
    depth.struct_size = sigma.struct_size = sizeof depth;
    options.metric = QDIST_MESH_SIGMA;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &sigma) == QDIST_OK && sigma.outcome != QDIST_MESH_SEPARATED);
    options.metric = QDIST_MESH_OWN;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_NULL);
    options.own = &wrong;
    wrong = own, wrong.struct_size = 0;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_STRUCT_SIZE);
    wrong = own, wrong.distance = NULL;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_NULL);
    wrong = own, wrong.model = NULL;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_NULL);
    wrong = own, wrong.centre[1] = NAN;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_NONFINITE);
    wrong = own, wrong.radius = INFINITY;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_NONFINITE);
    wrong = own, wrong.radius = 0;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = own, wrong.at_least = 3;
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_ERROR_ARGUMENT);
    CHECK(ballast.calls == 0);
    options.own = &own;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_ERROR_MESH_NOT_SOLID);
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_OK && ballast.calls > 0);
    CHECK(fabs(depth.upper - sigma.upper) < 0.01 * sigma.upper && fabs(depth.lower - sigma.lower) < 1e-9 && depth.lower > 0);
    CHECK(own_distance(&ballast, &pose, &depth.pose) == depth.upper);
    CHECK(qdist_mesh_pair_collides(pair, &depth.pose, &collides) == QDIST_OK && collides == 0);
    own.at_least = QDIST_MESH_OWN;
    CHECK(qdist_mesh_pair_depth(soup, &pose, &options, &depth) == QDIST_OK && depth.lower == 0);
    CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_OK && depth.lower == 0);
    /* Functions that return nonsense, at once or later: no pose of theirs is an answer. */
    for (broken = 1; broken < 200; broken += broken) {
        ballast.calls = 0, ballast.broken = broken;
        CHECK(qdist_mesh_pair_depth(pair, &pose, &options, &depth) == QDIST_OK && depth.upper > 0);
        if (depth.upper == DBL_MAX) {
            CHECK(depth.outcome == QDIST_MESH_STUCK || depth.outcome == QDIST_MESH_INVALID);
            CHECK(memcmp(&depth.pose, &pose, sizeof pose) == 0);
        } else {
            CHECK(qdist_mesh_pair_collides(pair, &depth.pose, &collides) == QDIST_OK && collides == 0);
        }
    }
    qdist_mesh_free(plain), qdist_mesh_free(wall), qdist_mesh_free(open), qdist_mesh_free(a), qdist_mesh_free(b);
    qdist_mesh_pair_free(pair), qdist_mesh_pair_free(soup);
    CHECK(account.blocks == 0 && account.bytes == 0);
}

/* A clock that is late from the n-th look on. */
struct clock {
    unsigned looks, until;
};

static int32_t late(void *user) {
    struct clock *clock = user;
    return ++clock->looks >= clock->until;
}

static qdist_mesh_budget usual_budget(void) {
    qdist_mesh_budget budget;
    CHECK(qdist_mesh_budget_default(&budget) == QDIST_OK);
    return budget;
}

/* What every tick promises of the depth x, a box that has sunk so far, and the bracket otherwise. */
static int promises(qdist_mesh_pair *pair, const qdist_mesh_depth *depth, double x) {
    uint32_t collides = 1;
    if (qdist_mesh_pair_collides(pair, &depth->pose, &collides) != QDIST_OK || collides) return 0;
    if (x < -1e-9) return depth->outcome == QDIST_MESH_SEPARATED && depth->upper == 0 && depth->lower == 0;
    return depth->lower <= x * (1 + 1e-9) + 1e-12 && depth->upper >= x * (1 - 1e-9) - 1e-9 && depth->upper <= 1.05 * x + 2e-3;
}

/* A box that sinks into another: its depth is known. */
static void tracker(void) {
    qdist_mesh *plain = box(0.5, 0.5, 0.5, 12), *wall = box(2, 2, 2, 12), *open = box(0.5, 0.5, 0.5, 11), *a = NULL, *b = NULL;
    qdist_mesh_pair *pair = NULL;
    qdist_mesh_tracker *tracker = NULL, *soup = NULL;
    qdist_mesh_budget budget = usual_budget(), wrong;
    qdist_mesh_depth depth, cold;
    qdist_mesh_pose pose = at(0.2, -0.1, 2.4), bad;
    struct clock clock = {0, 1000000000u};
    struct ballast ballast = {0.5 / 3, 0, 0};
    const qdist_mesh_own_metric own = {sizeof own, QDIST_MESH_SIGMA, {0, 0, 0}, 0.5, own_distance, own_model, &ballast};
    uint32_t taken = 7, metric;
    long allocated = 0;
    int tick;
    char bytes[64];
    CHECK(qdist_mesh_certify(plain, &a) == QDIST_OK && qdist_mesh_certify(wall, &b) == QDIST_OK);
    CHECK(qdist_mesh_pair_create(a, b, &pair) == QDIST_OK);
    CHECK(qdist_mesh_tracker_create(NULL, b, &tracker) == QDIST_ERROR_NULL && qdist_mesh_tracker_create(a, NULL, &tracker) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_tracker_create(a, b, NULL) == QDIST_ERROR_NULL && tracker == NULL);
    CHECK(qdist_mesh_tracker_create(a, b, (qdist_mesh_tracker **)(void *)(bytes + 1 + ((size_t)bytes & 1))) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_mesh_tracker_create(a, b, &tracker) == QDIST_OK && qdist_mesh_tracker_create(open, b, &soup) == QDIST_OK);
    /* Trackers keep their meshes. */
    qdist_mesh_free(plain), qdist_mesh_free(wall), qdist_mesh_free(open), qdist_mesh_free(a), qdist_mesh_free(b);

    /* What is wrong, and nothing is written. */
    CHECK(qdist_mesh_budget_default(NULL) == QDIST_ERROR_NULL);
    CHECK(budget.struct_size == sizeof budget && budget.max_queries == 16 && budget.probes == 4 && budget.certify == 1 && budget.late == NULL);
    memset(&depth, 0, sizeof depth);
    CHECK(qdist_mesh_tracker_update(tracker, &pose, NULL, &depth) == QDIST_ERROR_STRUCT_SIZE && depth.upper == 0);
    CHECK(qdist_mesh_tracker_merge(tracker, &depth, &taken) == QDIST_ERROR_STRUCT_SIZE);
    depth.struct_size = cold.struct_size = sizeof depth;
    CHECK(qdist_mesh_tracker_update(NULL, &pose, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_tracker_update(tracker, NULL, NULL, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_tracker_update(tracker, &pose, NULL, NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_tracker_update(tracker, (qdist_mesh_pose *)(void *)(bytes + 1 + ((size_t)bytes & 1)), NULL, &depth) == QDIST_ERROR_ALIGNMENT);
    CHECK(qdist_mesh_tracker_update(tracker, &pose, (qdist_mesh_budget *)(void *)(bytes + 1 + ((size_t)bytes & 1)), &depth) == QDIST_ERROR_ALIGNMENT);
    bad = at(0, NAN, 0);
    CHECK(qdist_mesh_tracker_update(tracker, &bad, NULL, &depth) == QDIST_ERROR_NONFINITE);
    bad = pose, bad.rotation[0] = 0.9;
    CHECK(qdist_mesh_tracker_update(tracker, &bad, NULL, &depth) == QDIST_ERROR_ROTATION);
    wrong = budget, wrong.struct_size = 8;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_STRUCT_SIZE);
    wrong = budget, wrong.metric = 3;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = budget, wrong.relative = -1;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = budget, wrong.relative = NAN;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_NONFINITE);
    wrong = budget, wrong.certify = 2;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = budget, wrong.effort = 3;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_ARGUMENT);
    wrong = budget, wrong.metric = QDIST_MESH_OWN;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &wrong, &depth) == QDIST_ERROR_NULL);
    wrong = budget, wrong.metric = QDIST_MESH_SIGMA;
    CHECK(qdist_mesh_tracker_update(soup, &pose, &wrong, &depth) == QDIST_ERROR_MESH_NOT_SOLID);
    CHECK(depth.upper == 0 && depth.outcome == 0 && depth.collision_queries == 0);
    CHECK(qdist_mesh_tracker_reset(NULL) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_tracker_merge(NULL, &depth, &taken) == QDIST_ERROR_NULL && qdist_mesh_tracker_merge(tracker, NULL, &taken) == QDIST_ERROR_NULL);
    /* The pose is all 0: no rotation. */
    CHECK(qdist_mesh_tracker_merge(tracker, &depth, &taken) == QDIST_ERROR_ROTATION && taken == 7);

    for (metric = QDIST_MESH_DISP; metric <= QDIST_MESH_OWN; ++metric) {
        double least = 1;
        budget.metric = metric, budget.own = &own, budget.late = late, budget.late_user = &clock;
        clock.until = 1000000000u;
        CHECK(qdist_mesh_tracker_reset(tracker) == QDIST_OK);
        for (tick = 0; tick < 400; ++tick) {
            pose.translation[2] = 2.6 - 2e-3 * (tick < 200 ? tick : 400 - tick);
            clock.looks = 0;
            CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK);
            CHECK(promises(pair, &depth, 2.5 - pose.translation[2]) && clock.looks > 0);
            CHECK(depth.collision_queries + depth.contact_queries + depth.distance_queries <= (tick ? 16u : 30u));
            if (tick == 200) least = depth.lower;
            if (pose.translation[2] < 2.4) CHECK(depth.lower > 0.05);
        }
        /* In the same place as before, nothing is allocated. */
        CHECK(least > 0.2);
        CHECK(depth.outcome == QDIST_MESH_SEPARATED && depth.distance_queries == 1 && fabs(depth.distance.distance - 0.098) < 1e-9);
    }

    /* Without certificates, ticks where it has been before allocate nothing. */
    budget.certify = 0;
    for (tick = 0; tick < 400; ++tick) {
        pose.translation[2] = 2.6 - 2e-3 * (tick < 200 ? tick : 400 - tick);
        if (tick == 201) allocated = account.total;
        CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && promises(pair, &depth, 2.5 - pose.translation[2]));
    }
    CHECK(account.total == allocated);

    /* Late from the n-th look on, which is also how to cancel; without queries; and no lower bounds. */
    pose = at(0.2, -0.1, 2.3);
    for (tick = 0; tick < 20; ++tick) CHECK(qdist_mesh_tracker_update(tracker, &pose, NULL, &depth) == QDIST_OK);
    budget = usual_budget(), budget.late = late, budget.late_user = &clock;
    for (clock.until = 1; clock.until < 9; ++clock.until) {
        clock.looks = 0, pose.translation[2] -= 1e-3;
        CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && promises(pair, &depth, 2.5 - pose.translation[2]));
        CHECK(clock.looks <= clock.until + 1 && depth.collision_queries + depth.contact_queries <= clock.until);
        if (clock.until == 1) CHECK(depth.outcome == QDIST_MESH_INTERRUPTED);
    }
    budget = usual_budget(), budget.max_queries = 0;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && depth.collision_queries == 1);
    CHECK(promises(pair, &depth, 2.5 - pose.translation[2]));
    CHECK(qdist_mesh_tracker_reset(tracker) == QDIST_OK);
    budget.certify = 0;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && depth.lower == 0);

    /* A cold answer is taken over, and what is not free is not. */
    CHECK(qdist_mesh_tracker_reset(tracker) == QDIST_OK && qdist_mesh_pair_depth(pair, &pose, NULL, &cold) == QDIST_OK);
    CHECK(qdist_mesh_tracker_merge(tracker, &cold, &taken) == QDIST_OK && taken == 1);
    CHECK(qdist_mesh_tracker_merge(tracker, &cold, NULL) == QDIST_OK);
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && depth.upper <= cold.upper);
    cold.pose = pose;
    CHECK(qdist_mesh_tracker_merge(tracker, &cold, &taken) == QDIST_OK && taken == 0);
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK && depth.upper > 0.2);

    /* A soup sees surfaces, and mass of the caller's makes it a body. */
    CHECK(qdist_mesh_tracker_update(soup, &pose, NULL, &depth) == QDIST_OK && depth.lower == 0 && depth.upper < DBL_MAX);
    qdist_mesh_pair_free(pair);
    qdist_mesh_tracker_free(tracker);
    qdist_mesh_tracker_free(soup);
    CHECK(account.blocks == 0 && account.bytes == 0);
}

/* Callbacks that use, and free, what is calling them. */
static struct {
    qdist_mesh_pair *pair;
    qdist_mesh_tracker *tracker;
    qdist_status told;
    int calls;
} nested;

static void enter_again(void) {
    const qdist_mesh_pose pose = at(0, 0, 0);
    qdist_mesh_depth depth;
    qdist_mesh_distance distance;
    uint32_t collides, count;
    ++nested.calls;
    depth.struct_size = sizeof depth;
    if (nested.pair != NULL) {
        nested.told = qdist_mesh_pair_collides(nested.pair, &pose, &collides);
        CHECK(qdist_mesh_pair_distance(nested.pair, &pose, &distance) == nested.told);
        CHECK(qdist_mesh_pair_contacts(nested.pair, &pose, 1, NULL, 0, &count) == nested.told);
        CHECK(qdist_mesh_pair_depth(nested.pair, &pose, NULL, &depth) == nested.told);
        qdist_mesh_pair_free(nested.pair);
    }
    if (nested.tracker != NULL) {
        nested.told = qdist_mesh_tracker_update(nested.tracker, &pose, NULL, &depth);
        CHECK(qdist_mesh_tracker_reset(nested.tracker) == nested.told);
        depth.struct_size = sizeof depth, depth.pose = pose;
        CHECK(qdist_mesh_tracker_merge(nested.tracker, &depth, NULL) == nested.told);
        qdist_mesh_tracker_free(nested.tracker);
    }
}

static int32_t nested_watch(void *user, const qdist_mesh_progress *progress) {
    (void)user, (void)progress;
    enter_again();
    return 0;
}

static int32_t nested_late(void *user) {
    (void)user;
    enter_again();
    return 0;
}

static void used_while_it_runs(void) {
    qdist_mesh *mesh = box(1, 1, 1, 12);
    const qdist_mesh_pose pose = at(0.1, 0.2, 1.7);
    qdist_mesh_options options;
    qdist_mesh_budget budget;
    qdist_mesh_depth depth;
    uint32_t collides = 7;
    memset(&nested, 0, sizeof nested);
    CHECK(qdist_mesh_pair_create(mesh, mesh, &nested.pair) == QDIST_OK);
    CHECK(qdist_mesh_options_default(&options) == QDIST_OK && qdist_mesh_budget_default(&budget) == QDIST_OK);
    options.watch = nested_watch;
    depth.struct_size = sizeof depth;
    CHECK(qdist_mesh_pair_depth(nested.pair, &pose, &options, &depth) == QDIST_OK);
    CHECK(nested.calls > 0 && nested.told == QDIST_ERROR_BUSY && depth.upper >= 0.3 - 1e-12 && depth.upper < 0.301);
    /* Free again, after an error too. */
    CHECK(qdist_mesh_pair_depth(nested.pair, NULL, &options, &depth) == QDIST_ERROR_NULL);
    CHECK(qdist_mesh_pair_collides(nested.pair, &pose, &collides) == QDIST_OK && collides == 1);
    qdist_mesh_pair_free(nested.pair);

    nested.pair = NULL, nested.calls = 0, nested.told = QDIST_OK;
    CHECK(qdist_mesh_tracker_create(mesh, mesh, &nested.tracker) == QDIST_OK);
    budget.late = nested_late;
    CHECK(qdist_mesh_tracker_update(nested.tracker, &pose, &budget, &depth) == QDIST_OK);
    CHECK(nested.calls > 0 && nested.told == QDIST_ERROR_BUSY && depth.lower <= 0.3 && depth.upper >= 0.3 - 1e-12);
    CHECK(qdist_mesh_tracker_reset(nested.tracker) == QDIST_OK);
    qdist_mesh_tracker_free(nested.tracker);
    qdist_mesh_free(mesh);
}

/* Every byte of what the library fills is written, padding included. */
static void written_whole(void) {
    qdist_mesh *mesh = box(1, 1, 1, 12);
    qdist_mesh_pair *pair = NULL;
    const qdist_mesh_pose pose = at(0.1, 0.2, 1.7), apart = at(0, 0, 5);
    struct {
        qdist_mesh_options options;
        qdist_mesh_budget budget;
        qdist_mesh_depth depth;
        qdist_mesh_distance distance;
        qdist_mesh_contact contact;
        qdist_mesh_report report;
        qdist_mesh_mass mass;
    } seen[2];
    CHECK(qdist_mesh_pair_create(mesh, mesh, &pair) == QDIST_OK);
    for (int i = 0; i < 2; ++i) {
        uint32_t count = 0;
        memset(&seen[i], i ? 0xC3 : 0x5A, sizeof seen[i]);
        seen[i].depth.struct_size = sizeof seen[i].depth, seen[i].report.struct_size = sizeof seen[i].report;
        CHECK(qdist_mesh_options_default(&seen[i].options) == QDIST_OK && qdist_mesh_budget_default(&seen[i].budget) == QDIST_OK);
        CHECK(qdist_mesh_pair_depth(pair, &pose, NULL, &seen[i].depth) == QDIST_OK);
        CHECK(qdist_mesh_pair_distance(pair, &apart, &seen[i].distance) == QDIST_OK);
        CHECK(qdist_mesh_pair_contacts(pair, &apart, 4, &seen[i].contact, 1, &count) == QDIST_OK && count > 0);
        CHECK(qdist_mesh_check(mesh, &seen[i].report) == QDIST_OK && qdist_mesh_integrate(mesh, &seen[i].mass) == QDIST_OK);
    }
    seen[1].depth.collision_queries = seen[0].depth.collision_queries;
    CHECK(memcmp(&seen[0].options, &seen[1].options, sizeof seen[0].options) == 0);
    CHECK(memcmp(&seen[0].budget, &seen[1].budget, sizeof seen[0].budget) == 0);
    CHECK(memcmp(&seen[0].depth, &seen[1].depth, sizeof seen[0].depth) == 0);
    CHECK(memcmp(&seen[0].distance, &seen[1].distance, sizeof seen[0].distance) == 0);
    CHECK(memcmp(&seen[0].contact, &seen[1].contact, sizeof seen[0].contact) == 0);
    CHECK(memcmp(&seen[0].report, &seen[1].report, sizeof seen[0].report) == 0);
    CHECK(memcmp(&seen[0].mass, &seen[1].mass, sizeof seen[0].mass) == 0);
    qdist_mesh_pair_free(pair);
    qdist_mesh_free(mesh);
}

static void names(void) {
    qdist_mesh_outcome outcome;
    qdist_status status;
    for (outcome = QDIST_MESH_CONVERGED; outcome <= QDIST_MESH_INVALID; ++outcome)
        CHECK(strcmp(qdist_mesh_outcome_string(outcome), "unknown outcome") != 0);
    CHECK(strcmp(qdist_mesh_outcome_string(QDIST_MESH_INVALID + 1), "unknown outcome") == 0);
    for (status = QDIST_ERROR_MESH_EMPTY; status <= QDIST_ERROR_HULL_POINTS; ++status)
        CHECK(strcmp(qdist_status_string(status), "unknown status") != 0);
    CHECK(strcmp(qdist_status_string(QDIST_ERROR_HULL_POINTS + 1), "unknown status") == 0);
}

int main(void) {
    allocator();
    bad_meshes();
    reports();
    proximity();
    depths();
    certified();
    own_metric();
    tracker();
    used_while_it_runs();
    written_whole();
    names();
    CHECK(account.total > 0 && account.blocks == 0 && account.bytes == 0 && account.misfits == 0);
    return finish("mesh");
}
