/* How deep is the origin in a set of six dimensions that a function of the program describes? The set: the hull of 24 points. With -DIN_SPAN in its own
 * subspace, which has four dimensions then. */
#include "measure.h"
#include "qdist.h"
#include "real.h"

enum { VERTICES = 64, FACETS = 512, POINTS = 24 };
static uint64_t memory[WORDS(6, VERTICES, FACETS)];
static real points[POINTS][6];
static Q(result) result;

static int32_t farthest(void *user, const real *direction, real *point) {
    real most = 0;
    int best = 0;
    (void)user;
    for (int i = 0; i < POINTS; ++i) {
        real height = 0;
        for (int k = 0; k < 6; ++k) height += points[i][k] * direction[k];
        if (i == 0 || height > most) most = height, best = i;
    }
    for (int k = 0; k < 6; ++k) point[k] = points[best][k];
    return 0;
}

int main(void) {
    qdist_solver *solver;
    Q(options) options;
    static Q(set) set; /* zeros: what is not said is not known */

    set.support = farthest;
    if (Q(solver_init)(memory, sizeof memory, 6, VERTICES, FACETS, &solver) != QDIST_OK) return measure_refused("qdist_solver_init");
    if (Q(options_default)(&options) != QDIST_OK) return measure_refused("qdist_options_default");
    options.relative = WITHIN;
    for (int i = 0; i < POSES; ++i) {
        for (int j = 0; j < POINTS; ++j)
            for (int k = 0; k < 6; ++k) points[j][k] = (real)dice();
        result.struct_size = sizeof result;
#ifdef IN_SPAN
        for (int j = 0; j < POINTS; ++j) points[j][4] = points[j][5] = 0;
        measure_begin();
        const qdist_status status = Q(solve_in_span)(solver, &set, 0, &options, &result);
#else
        measure_begin();
        const qdist_status status = Q(solve6)(solver, &set, 0, &options, &result);
#endif
        measure_end();
        if (status != QDIST_OK) return measure_refused("qdist_solve");
        measure_answer(result.outcome == QDIST_CONVERGED || result.outcome == QDIST_SEPARATED);
        measure_numbers(&result.lower, sizeof result.lower), measure_numbers(&result.upper, sizeof result.upper);
        measure_numbers(result.direction, sizeof result.direction), measure_numbers(&result.outcome, sizeof result.outcome);
    }
    measure_report(
#ifdef IN_SPAN
        "solve-in-span6",
#else
        "solve6",
#endif
        sizeof memory);
    return 0;
}
