/* The times that the header of meshes names, in microseconds on this machine: `./x figures`. */
#define _POSIX_C_SOURCE 199309L
#include "qdist_mesh.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

enum { AROUND = 54, RINGS = 27, VERTICES = AROUND * RINGS + 2, TRIANGLES = 2 * AROUND * RINGS };
static double xyz[3 * VERTICES];
static uint32_t triangles[3 * TRIANGLES];
static qdist_mesh *mesh, *body;
static qdist_mesh_pair *pair;
static qdist_mesh_tracker *tracker;
static int failures, tick;

static double least(void (*call)(void), int runs) {
    double best = 1e300;
    for (int i = 0; i < runs; i++) {
        struct timespec from, to;
        clock_gettime(CLOCK_MONOTONIC, &from);
        call();
        clock_gettime(CLOCK_MONOTONIC, &to);
        const double time = (double)(to.tv_sec - from.tv_sec) * 1e6 + (double)(to.tv_nsec - from.tv_nsec) * 1e-3;
        if (time < best) best = time;
    }
    return best;
}

/* A ball with bumps. */
static void draw(void) {
    uint32_t *t = triangles;
    for (int i = 0; i < RINGS; i++) {
        for (int k = 0; k < AROUND; k++) {
            const double a = 3.141592653589793 * (i + 1) / (RINGS + 1), b = 2 * 3.141592653589793 * k / AROUND;
            const double r = 1 + 0.2 * sin(5 * b) * sin(4 * a);
            double *p = xyz + 3 * (AROUND * i + k);
            p[0] = r * sin(a) * cos(b), p[1] = r * sin(a) * sin(b), p[2] = r * cos(a);
        }
    }
    xyz[3 * (VERTICES - 2) + 2] = 1, xyz[3 * (VERTICES - 1) + 2] = -1;
    for (uint32_t k = 0; k < AROUND; k++) {
        const uint32_t next = (k + 1) % AROUND, last = AROUND * (RINGS - 1);
        *t++ = VERTICES - 2, *t++ = k, *t++ = next;
        *t++ = VERTICES - 1, *t++ = last + next, *t++ = last + k;
        for (uint32_t i = 0; i + 1 < RINGS; i++) {
            const uint32_t a = AROUND * i + k, b = AROUND * i + next;
            *t++ = a, *t++ = a + AROUND, *t++ = b;
            *t++ = b, *t++ = a + AROUND, *t++ = b + AROUND;
        }
    }
}

static void create(void) {
    qdist_mesh_free(mesh);
    if (qdist_mesh_create(xyz, VERTICES, triangles, TRIANGLES, &mesh, NULL)) failures++;
}

static void certify(void) {
    qdist_mesh_free(body);
    if (qdist_mesh_certify(mesh, &body)) failures++;
}

static qdist_mesh_pose at(double x) {
    const qdist_mesh_pose pose = {{0.8, 0.6, 0, 0}, {x, 0.1, 0.2}};
    return pose;
}

static void collides(void) {
    const qdist_mesh_pose pose = at(2.2 + 0.001 * (tick++ % 7));
    uint32_t answer;
    if (qdist_mesh_pair_collides(pair, &pose, &answer)) failures++;
}

static void distance(void) {
    const qdist_mesh_pose pose = at(2.5 + 0.01 * (tick++ % 7));
    qdist_mesh_distance answer;
    if (qdist_mesh_pair_distance(pair, &pose, &answer)) failures++;
}

static void depth(void) {
    const qdist_mesh_pose pose = at(1.8);
    qdist_mesh_depth answer;
    answer.struct_size = sizeof answer;
    if (qdist_mesh_pair_depth(pair, &pose, NULL, &answer)) failures++;
}

static void update(void) {
    const qdist_mesh_pose pose = at(1.8 + 0.001 * (tick++ % 7));
    qdist_mesh_depth answer;
    answer.struct_size = sizeof answer;
    if (qdist_mesh_tracker_update(tracker, &pose, NULL, &answer)) failures++;
}

int main(void) {
    draw();
    const double created = least(create, 5);
    printf("mesh of %d triangles made       %9.0f, %.2f a triangle\n", TRIANGLES, created, created / TRIANGLES);
    printf("certified                       %9.0f\n", least(certify, 2));
    if (qdist_mesh_pair_create(body, body, &pair) || qdist_mesh_tracker_create(body, body, &tracker)) return 1;
    printf("collides                        %9.1f\n", least(collides, 200));
    printf("distance                        %9.1f\n", least(distance, 200));
    printf("depth                           %9.0f\n", least(depth, 2));
    printf("a tick of the tracker           %9.0f\n", least(update, 50));
    qdist_mesh_pair_free(pair);
    qdist_mesh_tracker_free(tracker);
    qdist_mesh_free(mesh);
    qdist_mesh_free(body);
    printf("figures_mesh: %d passed, %d failed\n", failures ? 0 : 1, failures);
    return failures != 0;
}
