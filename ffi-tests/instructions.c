/* instructions NAME ROUNDS: asks a fixed list of queries so many times; scripts/instructions.sh counts what a round takes.
   Without arguments: the names. */
#include "dice.h"
#include "fingertips.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POSES = 16, CORNERS = 32 };
static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(6, 64, 2048)];
static int failures;

/* Kinds of pairs, by two letters. */
#define PAIRS(scalar, real)                                                                                                       \
    static const qdist_sphere_##scalar sphere_##scalar = {1};                                                                     \
    static const qdist_box_##scalar box_##scalar = {{1, (real)0.75, (real)0.5}};                                                  \
    static const qdist_ellipsoid_##scalar ellipsoid_##scalar = {{1, (real)0.75, (real)0.5}};                                      \
    static const qdist_cylinder_##scalar cylinder_##scalar = {(real)0.75, 1};                                                     \
    static const qdist_capsule_##scalar capsule_##scalar = {(real)0.5, 1};                                                        \
    static const qdist_cone_##scalar cone_##scalar = {(real)0.75, 1};                                                             \
    static real corners_##scalar[3 * CORNERS];                                                                                    \
    static const qdist_points_##scalar hull_##scalar = {corners_##scalar, CORNERS, 3};                                            \
    static qdist_status body_##scalar(qdist_body_##scalar *body, char kind) {                                                     \
        switch (kind) {                                                                                                           \
        case 's': return qdist_body_sphere_##scalar(body, &sphere_##scalar);                                                      \
        case 'b': return qdist_body_box_##scalar(body, &box_##scalar);                                                            \
        case 'e': return qdist_body_ellipsoid_##scalar(body, &ellipsoid_##scalar);                                                \
        case 'y': return qdist_body_cylinder_##scalar(body, &cylinder_##scalar);                                                  \
        case 'c': return qdist_body_capsule_##scalar(body, &capsule_##scalar);                                                    \
        case 'n': return qdist_body_cone_##scalar(body, &cone_##scalar);                                                          \
        default: return qdist_body_points_##scalar(body, &hull_##scalar);                                                         \
        }                                                                                                                         \
    }                                                                                                                             \
    /* A turn by the unit quaternion q. */                                                                                        \
    static void place_##scalar(qdist_body_##scalar *body, const double *q, const double *shift) {                                 \
        for (int i = 0; i < 3; i++) {                                                                                             \
            const int j = (i + 1) % 3, k = (i + 2) % 3;                                                                           \
            body->rotation[3 * i + i] = (real)(1 - 2 * (q[j] * q[j] + q[k] * q[k]));                                              \
            body->rotation[3 * i + j] = (real)(2 * (q[i] * q[j] - q[k] * q[3]));                                                  \
            body->rotation[3 * i + k] = (real)(2 * (q[i] * q[k] + q[j] * q[3]));                                                  \
            body->translation[i] = (real)shift[i];                                                                                \
        }                                                                                                                         \
    }                                                                                                                             \
    static void depth_##scalar(char left, char right, int rounds) {                                                               \
        qdist_solver *solver;                                                                                                     \
        qdist_body_##scalar a, b;                                                                                                 \
        qdist_depth_##scalar depth;                                                                                               \
        for (int i = 0; i < CORNERS; i++) {                                                                                       \
            double u[3];                                                                                                          \
            random_direction(u, 3);                                                                                               \
            for (int k = 0; k < 3; k++) corners_##scalar[3 * i + k] = (real)u[k];                                                 \
        }                                                                                                                         \
        if (qdist_solver_init_##scalar(memory, sizeof memory, 3, 256, 512, &solver)) failures++;                                  \
        if (body_##scalar(&a, left) || body_##scalar(&b, right)) failures++;                                                      \
        const uint64_t poses = dice_state;                                                                                        \
        while (rounds-- > 0) {                                                                                                    \
            dice_state = poses;                                                                                                   \
            for (int i = 0; i < POSES; i++) { /* most of them overlap */                                                          \
                double q[4], shift[3];                                                                                            \
                random_direction(q, 4), random_direction(shift, 3);                                                               \
                place_##scalar(&b, q, shift);                                                                                     \
                depth.struct_size = sizeof depth;                                                                                 \
                if (qdist_depth3_##scalar(solver, &a, &b, NULL, &depth)) failures++;                                              \
            }                                                                                                                     \
        }                                                                                                                         \
    }
PAIRS(f32, float)
PAIRS(f64, double)

/* Four soft fingertips. */
static void grasp(char question, int rounds) {
    const qdist_wrench_frame_f64 frame = {{0, 0, 0}, 1};
    const double load[6] = {0.1, -0.2, 0.3, 0.02, -0.03, 0.01};
    qdist_primitive_f64 primitives[TIPS];
    const qdist_wrenches_f64 wrenches = {primitives, TIPS, question == '1' ? QDIST_L1 : QDIST_LINF};
    qdist_contact_f64 tips[TIPS];
    double shares[6 * TIPS];
    qdist_closure_f64 closed;
    qdist_result_f64 result;
    qdist_forces_f64 forces;
    qdist_solver *solver;
    qdist_set_f64 set;
    four_fingertips(tips);
    if (qdist_primitives_f64(tips, TIPS, &frame, 0, 0, primitives, NULL) || qdist_set_wrenches_f64(&set, &wrenches)) failures++;
    if (qdist_solver_init_f64(memory, sizeof memory, 6, 64, 2048, &solver)) failures++;
    closed.struct_size = sizeof closed, result.struct_size = sizeof result, forces.struct_size = sizeof forces;
    while (rounds-- > 0) {
        if (question == 'c' && qdist_force_closure_f64(solver, &set, NULL, &closed)) failures++;
        if (question == 'f' && qdist_contact_forces_f64(&wrenches, NULL, load, NULL, shares, &forces)) failures++;
        if ((question == '1' || question == 'i') && qdist_solve6_f64(solver, &set, NULL, NULL, &result)) failures++;
    }
}

static const struct {
    const char *name, *kinds; /* of a pair, or the question of a grasp */
} QUERIES[] = {
    {"spheres", "ss"},       {"boxes", "bb"},         {"ellipsoids", "ee"},       {"cylinders", "yy"},     {"cylinder-box", "yb"}, {"capsule-cone", "cn"},
    {"hulls of 32", "hh"},   {"grasp, L1", "1"},      {"grasp, L-infinity", "i"}, {"closure", "c"},        {"forces", "f"},
};
enum { COUNT = sizeof QUERIES / sizeof *QUERIES };

int main(int argc, char **argv) {
    for (int i = 0; i < COUNT; i++) {
        const char *kinds = QUERIES[i].kinds, *name = QUERIES[i].name;
        for (int single = 0; single <= (kinds[1] != '\0'); single++) {
            char full[64];
            snprintf(full, sizeof full, "%s %s", name, single ? "f32" : "f64");
            if (argc < 3) puts(full);
            if (argc < 3 || strcmp(full, argv[1]) != 0) continue;
            const int rounds = atoi(argv[2]);
            if (kinds[1] == '\0') grasp(kinds[0], rounds);
            else if (single) depth_f32(kinds[0], kinds[1], rounds);
            else depth_f64(kinds[0], kinds[1], rounds);
        }
    }
    return failures != 0;
}
