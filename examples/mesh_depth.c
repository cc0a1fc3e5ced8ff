/* How far must a box move to come out of the corner of an L? `./x demo-mesh` builds and runs it. */
#include "qdist_mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(qdist_status status, const char *call) {
    if (status == QDIST_OK) return;
    fprintf(stderr, "%s: %s\n", call, qdist_status_string(status));
    exit(1);
}

/* A prism: a polygon with `corners` corners, counterclockwise, from z = 0 to `height`. Its caps are the triangles `cap`. */
static qdist_mesh *prism(const double (*polygon)[2], uint32_t corners, const uint32_t (*cap)[3], double height) {
    double xyz[16][3];
    uint32_t triangles[32][3], count = 0, i, k, which = QDIST_MESH_NONE;
    qdist_mesh_report report;
    qdist_mesh *mesh, *certified;
    qdist_status status;
    for (i = 0; i < 2 * corners; ++i) {
        xyz[i][0] = polygon[i % corners][0];
        xyz[i][1] = polygon[i % corners][1];
        xyz[i][2] = i < corners ? 0 : height;
    }
    for (i = 0; i < corners - 2; ++i, count += 2) {
        for (k = 0; k < 3; ++k) {
            triangles[count][k] = cap[i][2 - k];              /* seen from below */
            triangles[count + 1][k] = cap[i][k] + corners;    /* seen from above */
        }
    }
    for (i = 0; i < corners; ++i, count += 2) {
        const uint32_t j = (i + 1) % corners;
        const uint32_t sides[2][3] = {{i, j, j + corners}, {i, j + corners, i + corners}};
        for (k = 0; k < 3; ++k) {
            triangles[count][k] = sides[0][k];
            triangles[count + 1][k] = sides[1][k];
        }
    }
    status = qdist_mesh_create(xyz[0], 2 * corners, triangles[0], count, &mesh, &which);
    if (status != QDIST_OK) fprintf(stderr, "triangle or vertex %u: ", (unsigned)which);
    check(status, "qdist_mesh_create");
    report.struct_size = sizeof report;
    check(qdist_mesh_check(mesh, &report), "qdist_mesh_check");
    if (!report.clean) fprintf(stderr, "the mesh has defects, e.g. %u open edges\n", (unsigned)report.open_edges);
    check(qdist_mesh_certify(mesh, &certified), "qdist_mesh_certify"); /* for lower bounds */
    qdist_mesh_free(mesh);
    return certified;
}

/* Gives up after many questions: a program would look at its clock, or draw a progress bar. */
static int32_t patience(void *user, const qdist_mesh_progress *progress) {
    unsigned *left = user;
    (void)progress;
    return *left == 0 || --*left == 0;
}

int main(void) {
    static const double L[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const uint32_t L_cap[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    static const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const uint32_t square_cap[2][3] = {{0, 1, 2}, {0, 2, 3}};
    static const char *const names[2] = {"farthest point", "root mean square"};
    qdist_mesh *bracket = prism(L, 6, L_cap, 2), *box = prism(square, 4, square_cap, 1);
    qdist_mesh_pose pose = {{1, 0, 0, 0}, {0.8, 0.9, 0.5}};
    qdist_mesh_options options;
    qdist_mesh_depth depth;
    qdist_mesh_pair *pair;
    uint32_t metric, collides, failed = 0;

    check(qdist_mesh_pair_create(box, bracket, &pair), "qdist_mesh_pair_create");
    for (metric = QDIST_MESH_DISP; metric <= QDIST_MESH_SIGMA; ++metric) {
        const double *q = depth.pose.rotation, *t = depth.pose.translation;
        unsigned left = 1000000;
        check(qdist_mesh_options_default(&options), "qdist_mesh_options_default");
        options.metric = metric;
        options.watch = patience, options.watch_user = &left;
        depth.struct_size = sizeof depth;
        check(qdist_mesh_pair_depth(pair, &pose, &options, &depth), "qdist_mesh_pair_depth");
        check(qdist_mesh_pair_collides(pair, &depth.pose, &collides), "qdist_mesh_pair_collides");
        printf("%-17s %.6f <= depth <= %.6f (%s)\n", names[metric], depth.lower, depth.upper, qdist_mesh_outcome_string(depth.outcome));
        printf("  free at         rotation (%.6f %.6f %.6f %.6f), translation (%.6f %.6f %.6f)%s\n", q[0], q[1], q[2], q[3], t[0], t[1],
               t[2], collides ? "  WRONG: it collides" : "");
        printf("  took            %u collision, %u contact and %u distance queries\n", (unsigned)depth.collision_queries,
               (unsigned)depth.contact_queries, (unsigned)depth.distance_queries);
        failed += collides;
    }
    qdist_mesh_pair_free(pair);
    qdist_mesh_free(box);
    qdist_mesh_free(bracket);
    return failed != 0;
}
