/* The binary interface: the size macros agree with the library, structs look as a C compiler says they do, versions match. With
 * an argument, prints the sizes instead. */
#include "qdist_grasp.h"
#include "test.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* The macros are constant expressions, of the preprocessor too. */
#if QDIST_WORKSPACE_BYTES_F64(3, 64, 128) < 1024 || QDIST_WORKSPACE_WORDS_F32(6, 7, 12) > 1024 || QDIST_VERSION < 1
#error "the macros do not work in #if"
#endif
static uint64_t words[QDIST_WORKSPACE_WORDS_F64(6, 7, 12)];
static uint16_t graph[QDIST_HULL_GRAPH_LEN(4)];

static void sizes(void) {
    const uint32_t capacities[] = {0, 1, 3, 4, 5, 6, 7, 8, 11, 12, 13, 16, 31, 64, 100, 127, 128, 255, 256, 1000, 4095, 4096,
                                   40000, 65534, 65535};
    const unsigned count = sizeof capacities / sizeof *capacities;
    uint32_t dimension;
    unsigned v, f;
    for (dimension = 2; dimension <= 6; ++dimension) {
        for (v = 0; v < count; ++v) {
            for (f = 0; f < count; ++f) {
                const uint32_t nv = capacities[v], nf = capacities[f];
                const int legal = nv >= dimension + 1 && nf >= 2 * dimension;
                uint32_t bytes64 = 1, bytes32 = 1;
                const qdist_status status64 = qdist_workspace_query(sizeof(double), dimension, nv, nf, &bytes64);
                const qdist_status status32 = qdist_workspace_query(sizeof(float), dimension, nv, nf, &bytes32);
                if (legal) {
                    CHECK(status64 == QDIST_OK && bytes64 == QDIST_WORKSPACE_BYTES_F64(dimension, nv, nf));
                    CHECK(status32 == QDIST_OK && bytes32 == QDIST_WORKSPACE_BYTES_F32(dimension, nv, nf));
                    CHECK(QDIST_WORKSPACE_WORDS_F64(dimension, nv, nf) * 8 >= bytes64);
                } else {
                    CHECK(status64 == QDIST_ERROR_CAPACITY && status32 == QDIST_ERROR_CAPACITY && bytes64 == 1);
                }
            }
        }
    }
}

/* Exactly the bytes that the macro says: init writes nothing behind them, and a query stays inside. */
static void bounds(void) {
    uint32_t dimension, i;
    for (dimension = 2; dimension <= 6; ++dimension) {
        const uint32_t nv = 3 * dimension, nf = 9 * dimension;
        const uint32_t sizes[2] = {QDIST_WORKSPACE_BYTES_F64(dimension, nv, nf), QDIST_WORKSPACE_BYTES_F32(dimension, nv, nf)};
        for (i = 0; i < 2; ++i) {
            unsigned char *const block = malloc(sizes[i] + 16);
            qdist_solver *solver = NULL;
            if (block == NULL) return;
            memset(block, 0xa5, sizes[i] + 16);
            CHECK((i ? qdist_solver_init_f32 : qdist_solver_init_f64)(block, sizes[i], dimension, nv, nf, &solver) == QDIST_OK);
            CHECK(block[sizes[i]] == 0xa5 && block[sizes[i] + 15] == 0xa5);
            free(block);
        }
    }
}

static void layout(void) {
    CHECK(sizeof(qdist_status) == 4 && sizeof(qdist_outcome) == 4);
    CHECK(offsetof(qdist_body_f64, set) == 0 && offsetof(qdist_hull_f64, points) == 0);
    CHECK(offsetof(qdist_options_f64, struct_size) == 0 && offsetof(qdist_depth_f64, struct_size) == 0);
    CHECK(offsetof(qdist_result_f64, struct_size) == 0);
    CHECK(offsetof(qdist_depth_f64, lower) == 8 && offsetof(qdist_depth_f32, lower) == 8);
    CHECK(sizeof(qdist_depth_f64) == 8 + 11 * 8 + 6 * 4 && sizeof(qdist_depth_f32) == 8 + 11 * 4 + 6 * 4);
    CHECK(offsetof(qdist_result_f64, lower) == 16 && offsetof(qdist_result_f32, lower) == 16);
    CHECK(offsetof(qdist_result_f64, points) == 16 + 28 * 8 && offsetof(qdist_result_f32, points) == 16 + 28 * 4);
    CHECK(sizeof(qdist_result_f64) == 16 + 70 * 8 + 10 * 4 && sizeof(qdist_result_f32) == 16 + 70 * 4 + 9 * 4);
    CHECK(sizeof(qdist_tracker_f64) == 8 + 25 * 8 && sizeof(qdist_tracker_f32) == 8 + 25 * 4);
    CHECK(offsetof(qdist_tracker_f64, lower) == 8 && offsetof(qdist_tracker_f32, directions) == 12);
    CHECK(sizeof(qdist_plan) == 4 && offsetof(qdist_options_f64, interrupt) == 8);
    CHECK(offsetof(qdist_options_f64, absolute) == 8 + 2 * sizeof(void *));
    CHECK(sizeof(qdist_options_f64) == 8 + 2 * sizeof(void *) + 3 * 8 + 8 + 6 * 8);
    CHECK(offsetof(qdist_unit_f64, extent) == 5 * sizeof(void *) && offsetof(qdist_set_f64, radius) == 4 * sizeof(void *));
    CHECK(sizeof(qdist_unit_f64) == 5 * sizeof(void *) + 3 * 8 + 8 && sizeof(qdist_unit_f32) >= 5 * sizeof(void *) + 20);
    CHECK(sizeof words >= QDIST_WORKSPACE_BYTES_F64(6, 7, 12) && sizeof graph == 2 * 60);
}

static void grasp_layout(void) {
    CHECK(offsetof(qdist_finger_f64, words) == 16 && sizeof(qdist_finger_f64) == 16 + 577 * 8);
    CHECK(offsetof(qdist_finger_f32, words) == 16 && sizeof(qdist_finger_f32) == 16 + 289 * 8);
    CHECK(sizeof(qdist_finger_wrenches_f64) == sizeof(void *) + 8 && sizeof(qdist_pyramid_wrenches_f32) == sizeof(void *) + 8);
    CHECK(sizeof(qdist_layout_f64) == 16 && sizeof(qdist_layout_f32) == 12);
    CHECK(sizeof(qdist_preset_f64) == 4 * 8 + 16 + 8 && sizeof(qdist_preset_f32) == 4 * 4 + 12 + 8);
    CHECK(sizeof(qdist_pyramid_f64) == 4 * 8 || sizeof(void *) != 8);
}

static void version(void) {
    char text[64];
    CHECK(qdist_version() == QDIST_VERSION);
    sprintf(text, "%d.%d.%d", QDIST_VERSION_MAJOR, QDIST_VERSION_MINOR, QDIST_VERSION_PATCH);
#ifdef CARGO_VERSION
    CHECK(strcmp(text, CARGO_VERSION) == 0);
#endif
    sprintf(text, "%u.%u.%u", (unsigned)(qdist_version() >> 16), (unsigned)(qdist_version() >> 8 & 255),
            (unsigned)(qdist_version() & 255));
#ifdef CARGO_VERSION
    CHECK(strcmp(text, CARGO_VERSION) == 0);
#endif
}

int main(int argc, char **argv) {
    (void)argv;
    if (argc > 1) {
        printf("qdist_depth_f64 %u, qdist_result_f64 %u, qdist_body_f64 %u bytes\n", (unsigned)sizeof(qdist_depth_f64),
               (unsigned)sizeof(qdist_result_f64), (unsigned)sizeof(qdist_body_f64));
        printf("qdist_options_f64 %u, qdist_unit_f64 %u, qdist_tracker_f64 %u bytes\n", (unsigned)sizeof(qdist_options_f64),
               (unsigned)sizeof(qdist_unit_f64), (unsigned)sizeof(qdist_tracker_f64));
        printf("solver 3-D (64, 128): f64 %u, f32 %u bytes\n", (unsigned)QDIST_WORKSPACE_BYTES_F64(3, 64, 128),
               (unsigned)QDIST_WORKSPACE_BYTES_F32(3, 64, 128));
        return 0;
    }
    sizes();
    bounds();
    layout();
    grasp_layout();
    version();
    return finish("abi");
}
