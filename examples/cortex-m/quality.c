/* How large a wrench does a grasp of three hard fingertips resist, whatever its direction? To 1 %, in six dimensions; one limit of force each (QDIST_LINF). */
#include "fingertips.h"

#ifdef DOUBLE
enum { VERTICES = 64, FACETS = 384 };
#else
enum { VERTICES = 64, FACETS = 240 };
#endif
static uint64_t memory[WORDS(6, VERTICES, FACETS)];
static Q(primitive) primitives[FINGERS];
static Q(contact) contacts[FINGERS];
static Q(result) result;

int main(void) {
    const Q(wrenches) wrenches = {primitives, FINGERS, QDIST_LINF};
    qdist_solver *solver;
    Q(options) options;
    Q(set) set;

    if (Q(solver_init)(memory, sizeof memory, 6, VERTICES, FACETS, &solver) != QDIST_OK) return measure_refused("qdist_solver_init");
    if (Q(options_default)(&options) != QDIST_OK) return measure_refused("qdist_options_default");
    options.relative = WITHIN;
    for (int i = 0; i < POSES; ++i) {
        uint32_t which;
        touch(contacts, QDIST_HARD, (real)0.02);
        if (Q(primitives)(contacts, FINGERS, &FRAME, 0, 0, primitives, &which) != QDIST_OK) return measure_refused("qdist_primitives");
        if (Q(set_wrenches)(&set, &wrenches) != QDIST_OK) return measure_refused("qdist_set_wrenches");
        result.struct_size = sizeof result;
        measure_begin();
        const qdist_status status = Q(solve6)(solver, &set, 0, &options, &result);
        measure_end();
        if (status != QDIST_OK) return measure_refused("qdist_solve6");
        measure_answer(result.outcome == QDIST_CONVERGED);
        measure_numbers(&result.lower, sizeof result.lower), measure_numbers(&result.upper, sizeof result.upper);
        measure_numbers(result.direction, sizeof result.direction), measure_numbers(&result.outcome, sizeof result.outcome);
    }
    measure_report("quality", sizeof memory);
    return 0;
}
