/* The loop of ../gripper.c on a microcontroller: one of three soft fingertips creeps over the skin. Every tick moves the bracket of d, the largest wrench that is
 * resisted whatever its direction, along with the contacts, and finds the least contact forces for the load. Every PERIOD ticks, between two of them, d is searched
 * anew. */
#include "fingertips.h"

enum { TICKS = 200, PERIOD = 50, VERTICES = 48, FACETS = 224 };
static uint64_t memory[WORDS(6, VERTICES, FACETS)];
static Q(primitive) primitives[FINGERS];
static Q(contact) contacts[FINGERS];
static Q(force_memory) known;
static Q(tracker) tracker;
static Q(result) result;

int main(void) {
    const Q(wrenches) wrenches = {primitives, FINGERS, QDIST_LINF};
    const real creep = (real)5e-6, load[6] = {0, 0, (real)-0.2, 0, 0, 0}; /* 5 mm in a second */
    /* What a primitive's points move by when its contact does: at most the creep over the torque scale, for each newton. With the numbers' rounding. */
    const real moved = creep / (real)0.04 * (real)1.2 + (real)2e-6;
    real shares[6 * FINGERS];
    Q(options) options;
    Q(forces) forces;
    qdist_solver *solver;
    Q(set) set;

    if (Q(solver_init)(memory, sizeof memory, 6, VERTICES, FACETS, &solver) != QDIST_OK) return measure_refused("qdist_solver_init");
    if (Q(options_default)(&options) != QDIST_OK) return measure_refused("qdist_options_default");
    if (Q(set_wrenches)(&set, &wrenches) != QDIST_OK) return measure_refused("qdist_set_wrenches");
    if (Q(tracker_init)(&tracker, 6) != QDIST_OK) return measure_refused("qdist_tracker_init");
    touch(contacts, QDIST_SOFT, 0);
    for (int tick = 0; tick < TICKS; ++tick) {
        uint32_t which;
        contacts[2].position[2] += creep;
        if (tick % PERIOD == 0) { /* as long as it takes: a task of its own on a machine that has tasks */
            if (Q(primitives)(contacts, FINGERS, &FRAME, 0, 0, primitives, &which) != QDIST_OK) return measure_refused("qdist_primitives");
            options.relative = (real)5e-2, options.max_iterations = 0;
            result.struct_size = sizeof result;
            if (Q(solve_warm6)(solver, &tracker, &set, 0, moved, &options, &result) != QDIST_OK) return measure_refused("qdist_solve_warm6");
            continue;
        }
        options.relative = (real)0.2, options.max_iterations = 1;
        result.struct_size = sizeof result, forces.struct_size = sizeof forces;
        measure_begin();
        const qdist_status made = Q(primitives)(contacts, FINGERS, &FRAME, 0, 0, primitives, &which);
        const qdist_status followed = Q(solve_warm6)(solver, &tracker, &set, 0, moved, &options, &result);
        const qdist_status pressed = Q(contact_forces)(&wrenches, &known, load, 0, shares, &forces);
        measure_end();
        if (made != QDIST_OK || followed != QDIST_OK || pressed != QDIST_OK) return measure_refused("a tick");
        measure_answer(result.outcome == QDIST_CONVERGED && forces.outcome == QDIST_CONVERGED);
        measure_numbers(&result.lower, sizeof result.lower), measure_numbers(&result.upper, sizeof result.upper);
        measure_numbers(shares, sizeof shares);
    }
    measure_report("a tick of a gripper", sizeof memory);
    return 0;
}
