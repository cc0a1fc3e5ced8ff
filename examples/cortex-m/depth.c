/* Depth of two bodies in space, in float: the program that a firmware with a Cortex-M4F would have. One pair of shapes each, SCENE, so that the linker
 * leaves the others out. */
#include "measure.h"
#include "qdist.h"

#define BOXES 1
#define CAPSULE_ELLIPSOID 2
#define CYLINDER_CONE 3
#define HULL_BOX 4
#define CALLBACK_BOX 5

enum { VERTICES = 32, FACETS = 64 };
static uint64_t memory[QDIST_WORKSPACE_WORDS_F32(3, VERTICES, FACETS)];

#if SCENE == BOXES || SCENE == HULL_BOX || SCENE == CALLBACK_BOX
static const qdist_box_f32 box = {{0.5f, 0.375f, 0.25f}};
#endif
#if SCENE == BOXES
#define QUERY "box-box"
static const qdist_box_f32 other = {{0.25f, 0.5f, 0.75f}};
static qdist_status make(qdist_body_f32 *a, qdist_body_f32 *b) {
    const qdist_status status = qdist_body_box_f32(a, &box);
    return status ? status : qdist_body_box_f32(b, &other);
}
#elif SCENE == CAPSULE_ELLIPSOID
#define QUERY "capsule-ellipsoid"
static const qdist_capsule_f32 capsule = {0.25f, 0.5f};
static const qdist_ellipsoid_f32 ellipsoid = {{0.5f, 0.375f, 0.25f}};
static qdist_status make(qdist_body_f32 *a, qdist_body_f32 *b) {
    const qdist_status status = qdist_body_capsule_f32(a, &capsule);
    return status ? status : qdist_body_ellipsoid_f32(b, &ellipsoid);
}
#elif SCENE == CYLINDER_CONE
#define QUERY "cylinder-cone"
static const qdist_cylinder_f32 cylinder = {0.375f, 0.5f};
static const qdist_cone_f32 cone = {0.5f, 0.5f};
static qdist_status make(qdist_body_f32 *a, qdist_body_f32 *b) {
    const qdist_status status = qdist_body_cylinder_f32(a, &cylinder);
    return status ? status : qdist_body_cone_f32(b, &cone);
}
#elif SCENE == HULL_BOX
#define QUERY "hull32-box"
enum { CORNERS = 32 };
static float corners[3 * CORNERS];
static const qdist_points_f32 hull = {corners, CORNERS, 3};
static qdist_status make(qdist_body_f32 *a, qdist_body_f32 *b) {
    qdist_status status;
    for (int i = 0; i < CORNERS;) {
        float square = 0;
        for (int k = 0; k < 3; ++k) corners[3 * i + k] = 0.75f * dice(), square += corners[3 * i + k] * corners[3 * i + k];
        i += square > 0.25f && square < 0.375f; /* near a sphere */
    }
    status = qdist_body_points_f32(a, &hull);
    return status ? status : qdist_body_box_f32(b, &box);
}
#elif SCENE == CALLBACK_BOX
#define QUERY "callback-box"
static const float corners[4][3] = {{0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f}, {-0.5f, 0.5f, -0.5f}, {-0.5f, -0.5f, 0.5f}};
static int32_t tetrahedron(void *user, const float *direction, float *point) {
    float most = 0;
    int best = 0;
    (void)user;
    for (int i = 0; i < 4; ++i) {
        const float height = corners[i][0] * direction[0] + corners[i][1] * direction[1] + corners[i][2] * direction[2];
        if (i == 0 || height > most) most = height, best = i;
    }
    for (int k = 0; k < 3; ++k) point[k] = corners[best][k];
    return 0;
}
static qdist_set_f32 set; /* zeros: what is not said is not known */
static qdist_status make(qdist_body_f32 *a, qdist_body_f32 *b) {
    qdist_status status;
    set.support = tetrahedron;
    status = qdist_body_set_f32(a, &set);
    return status ? status : qdist_body_box_f32(b, &box);
}
#endif

int main(void) {
    qdist_solver *solver;
    qdist_body_f32 a, b;
    qdist_depth_f32 depth;
    qdist_options_f32 options;

    if (qdist_options_default_f32(&options) != QDIST_OK) return measure_refused("qdist_options_default_f32");
#if SCENE == CALLBACK_BOX
    options.absolute = 2e-5f; /* a function of your own tells points in one word, and no more should be asked of them */
#endif
    if (qdist_solver_init_f32(memory, sizeof memory, 3, VERTICES, FACETS, &solver) != QDIST_OK) return measure_refused("qdist_solver_init_f32");
    if (make(&a, &b) != QDIST_OK) return measure_refused("a body");
    for (int i = 0; i < POSES; ++i) {
        random_rotation(a.rotation), random_rotation(b.rotation);
        for (int k = 0; k < 3; ++k) b.translation[k] = 0.75f * dice(); /* most of them overlap */
        depth.struct_size = sizeof depth;
        measure_begin();
        const qdist_status status = qdist_depth3_f32(solver, &a, &b, &options, &depth);
        measure_end();
        if (status != QDIST_OK) return measure_refused("qdist_depth3_f32");
        measure_answer(depth.outcome == QDIST_CONVERGED || depth.outcome == QDIST_SEPARATED);
        measure_numbers(&depth.lower, sizeof depth.lower), measure_numbers(&depth.upper, sizeof depth.upper);
        measure_numbers(depth.normal, sizeof depth.normal), measure_numbers(&depth.outcome, sizeof depth.outcome);
        measure_numbers(depth.point_a, sizeof depth.point_a), measure_numbers(depth.point_b, sizeof depth.point_b);
    }
    measure_report(QUERY, sizeof memory);
    return 0;
}
