/* Penetration depth and distance of pairs of bodies that have been reported against other libraries: what the other library said,
 * the reference value, and qdist's bracket, outcome and time. `./x demo` builds and runs it. */
#define _POSIX_C_SOURCE 199309L
#include "qdist.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

enum kind { SPHERE, BOX, CYLINDER };

/* sphere: radius; box: half extents; cylinder: radius, half height. Pose: rotation row-major, translation. */
struct side {
    enum kind kind;
    double size[3], rotation[9], translation[3];
};

static const struct {
    const char *source, *reported;
    double reference;
    struct side a, b;
} CASES[] = {
    {"libccd issue 25", "depth 0, normal NaN", 0.10000000000000009,
     {BOX, {1, 1, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}},
     {BOX, {1, 1, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1.9}}},
    {"libccd boxbox.c, pen 3", "EPA: 1e-16", 0.9,
     {BOX, {0.5, 0.5, 0.5}, {0.7071067811865475, -0.7071067811865476, 0, 0.7071067811865476, 0.7071067811865475, 0, 0, 0, 1}, {0.1, 0, 0.1}},
     {BOX, {0.5, 0.5, 0.5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.1, 0, 0}}},
    {"libccd cylcyl.c, pen 3", "MPR: 0.721", 0.6457402317963139,
     {CYLINDER, {0.35, 0.25, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.3, 0.1, 0.1}},
     {CYLINDER, {0.5, 0.5, 0}, {0.7071067811865477, -0.4999999999999999, 0.4999999999999999, 0.4999999999999999, 0.8535533905932738, 0.14644660940672619, -0.4999999999999999, 0.14644660940672619, 0.8535533905932738}, {0, 0, 0}}},
    {"libccd boxcyl.c, pen 7", "MPR: 1.322", 0.7506362462294328,
     {BOX, {0.25, 0.5, 0.75}, {0.8535533905932738, 0.14644660940672619, -0.4999999999999999, 0.14644660940672619, 0.8535533905932738, 0.4999999999999999, 0.4999999999999999, -0.4999999999999999, 0.7071067811865477}, {0.6, 0, 0.5}},
     {CYLINDER, {0.4, 0.35, 0}, {0.8093434610512296, 0.23583702566695236, 0.5379071103621722, -0.2502015594233666, 0.9670268656955038, -0.0475207395275551, -0.5313777768365293, -0.096124598036587, 0.8416636620031616}, {0.6, 0, 0.5}}},
    {"FCL issue 319", "exception", -1.5543838884119522e-08,
     {CYLINDER, {0.05, 0.03, 0}, {-0.9999999999799902, 6.257283580204504e-10, 6.3260669852976095e-06, 6.326066985168371e-06, -6.394330342995855e-10, 0.9999999999799906, 6.257318015812846e-10, 1, 6.394291294599675e-10}, {0.5750000975675761, -0.42711963046787943, 1.1867093358746836}},
     {BOX, {0.0125, 0.175, 0.9225}, {0, -1, 0, 1, 0, 0, 0, 0, 1}, {0.8, -0.4575, 1.0225}}},
    {"Drake issue 21234", "exception", -3.310849914238624e-11,
     {CYLINDER, {0.041, 0.085, 0}, {0.6228644976275455, 0.7165153556804436, -0.3140789115322978, -0.20605566270224238, -0.23703718387133413, -0.9493968808305023, -0.7547058244531608, 0.6560633494842361, 4.0172294049188053e-17}, {0.2023803334682546, 0.02784568359401101, 0.31142339392466933}},
     {BOX, {0.15, 0.3, 0.008}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.4, 0, 0.26885000000000003}}},
    {"FCL issue 391", "EPA: half the depth", 1.5333941276823533e-07,
     {CYLINDER, {0.03, 0.325, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.6, 0, 0.325}},
     {SPHERE, {0.055, 0, 0}, {-0.9954758066, -0.0295866301, 0.0902914702, -0.0851034786, -0.1449450565, -0.9857729599, 0.0422530022, -0.9889972506, 0.1417713719}, {0.5419794018, -0.0621175025, 0.6016236576}}},
    {"FCL issue 395", "EPA: 0.0012", 0.013408613773995296,
     {BOX, {0.23, 0.24, 0.005}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {-0.721, -0.772, 0.81}},
     {BOX, {0.0247605, 0.073, 0.03625}, {0.10758262492983037, -0.6624881850015213, -0.7413065381787736, 0.22682184885125473, -0.7096140407752535, 0.6670830248314786, -0.9679761503760854, -0.23991106241273435, 0.07392465377049165}, {-0.4267713300299948, -0.7659685124774679, 0.8074673140009105}}},
    {"Drake issue 21673", "exception", 0.15005968486978194,
     {BOX, {0.025, 0.275, 0.15}, {0.0007963267107332644, -0.9999996829318354, 0, 0.9999996829318354, 0.0007963267107332644, 0, 0, 0, 1}, {0.7500000000000006, -2.4083553715553103e-15, 0.15}},
     {BOX, {0.125, 0.1, 0.075}, {6.123233995736766e-17, 0, 1, -1, 6.123233995736766e-17, 6.123233995736766e-17, -6.123233995736766e-17, -1, 3.749399456654644e-33}, {0.75, 0, 0.15}}},
    {"FCL issue 508", "distance 3.162", -3,
     {BOX, {0.5, 0.5, 0.5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 4, 0}},
     {BOX, {0.5, 0.5, 0.5}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}}},
    {"FCL issue 293", "points NaN", -0.05351616282454925,
     {BOX, {1.375, 3, 0.025}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1.625, 0, 0.5}},
     {BOX, {0.212, 0.075, 0.0843}, {0.13746798379749303, -0.7530393853979407, 0.643454922640385, 0.9643474173050877, -0.04655882238860287, -0.26051167880690745, 0.22613405795602542, 0.6563261080417859, 0.7197912389957681}, {0.192074, -0.27787, 0.273546}}},
};

/* The shapes of a body must outlive it. */
struct shape {
    qdist_sphere_f64 sphere;
    qdist_box_f64 box;
    qdist_cylinder_f64 cylinder;
};

static qdist_status make(qdist_body_f64 *body, struct shape *shape, const struct side *side) {
    qdist_status status = QDIST_ERROR_ARGUMENT;
    shape->sphere.radius = shape->cylinder.radius = side->size[0];
    shape->cylinder.half_height = side->size[1];
    memcpy(shape->box.half, side->size, sizeof shape->box.half);
    switch (side->kind) {
        case SPHERE: status = qdist_body_sphere_f64(body, &shape->sphere); break;
        case BOX: status = qdist_body_box_f64(body, &shape->box); break;
        case CYLINDER: status = qdist_body_cylinder_f64(body, &shape->cylinder); break;
    }
    if (status == QDIST_OK) {
        memcpy(body->rotation, side->rotation, sizeof body->rotation);
        memcpy(body->translation, side->translation, sizeof body->translation);
    }
    return status;
}

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(void) {
    /* All the memory there is. */
    static uint64_t memory[QDIST_WORKSPACE_WORDS_F64(3, 64, 128)];
    enum { REPEAT = 2000, ROUNDS = 10 };
    qdist_solver *solver;
    qdist_status status = qdist_solver_init_f64(memory, sizeof memory, 3, 64, 128, &solver);
    unsigned i, wrong = 0;

    if (status != QDIST_OK) {
        fprintf(stderr, "qdist_solver_init_f64: %s\n", qdist_status_string(status));
        return 1;
    }
    printf("%-24s %-21s %17s   %20s %20s  %-10s %6s %8s\n", "case", "reported", "reference", "lower", "upper", "outcome", "calls",
           "time");
    for (i = 0; i < sizeof CASES / sizeof *CASES; ++i) {
        const double reference = CASES[i].reference;
        struct shape shapes[2];
        qdist_body_f64 a, b;
        qdist_depth_f64 depth;
        double best = 1e9;
        int round, k, holds;

        status = make(&a, &shapes[0], &CASES[i].a);
        if (status == QDIST_OK) status = make(&b, &shapes[1], &CASES[i].b);
        depth.struct_size = sizeof depth;
        for (round = 0; round < ROUNDS && status == QDIST_OK; ++round) {
            const double start = seconds();
            double time;
            for (k = 0; k < REPEAT && status == QDIST_OK; ++k) status = qdist_depth3_f64(solver, &a, &b, NULL, &depth);
            time = (seconds() - start) / REPEAT;
            if (time < best) best = time;
        }
        if (status != QDIST_OK) {
            fprintf(stderr, "%s: %s\n", CASES[i].source, qdist_status_string(status));
            return 1;
        }
        /* The reference itself is rounded, and so are its inputs: a few units in the last place of the positions. */
        holds = depth.lower <= reference + 1e-15 && reference - 1e-15 <= depth.upper;
        wrong += !holds;
        printf("%-24s %-21s %17.10g   %20.15g %20.15g  %-10s %6u %5.0f ns%s\n", CASES[i].source, CASES[i].reported, reference,
               depth.lower, depth.upper, qdist_outcome_string(depth.outcome), (unsigned)depth.support_calls, best * 1e9,
               holds ? "" : "  WRONG");
    }
    printf("%u cases, %u wrong; %u bytes of memory\n", i, wrong, (unsigned)sizeof memory);
    return wrong != 0;
}
