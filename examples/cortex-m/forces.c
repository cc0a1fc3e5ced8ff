/* What each fingertip must press, every tick: three soft fingertips carry a load while the arm accelerates, which changes by a thousandth from tick to tick; what is known
 * from the tick before is used. */
#include "fingertips.h"

static Q(primitive) primitives[FINGERS];
static Q(contact) contacts[FINGERS];
static Q(force_memory) known; /* zeros: nothing is */

int main(void) {
    const Q(wrenches) wrenches = {primitives, FINGERS, QDIST_LINF};
    real load[6] = {0, 0, (real)-0.3, 0, 0, 0}, shares[6 * FINGERS];
    Q(forces) result;
    uint32_t which;

    touch(contacts, QDIST_SOFT, (real)0.005);
    if (Q(primitives)(contacts, FINGERS, &FRAME, 0, 0, primitives, &which) != QDIST_OK) return measure_refused("qdist_primitives");
    for (int tick = 0; tick < POSES; ++tick) {
        for (int k = 0; k < 6; ++k) load[k] += (real)2e-4 * (real)dice();
        result.struct_size = sizeof result;
        measure_begin();
        const qdist_status status = Q(contact_forces)(&wrenches, &known, load, 0, shares, &result);
        measure_end();
        if (status != QDIST_OK) return measure_refused("qdist_contact_forces");
        measure_answer(result.outcome == QDIST_CONVERGED);
        measure_numbers(&result.lower, sizeof result.lower), measure_numbers(&result.upper, sizeof result.upper);
        measure_numbers(shares, sizeof shares), measure_numbers(&result.outcome, sizeof result.outcome);
    }
    measure_report("forces", sizeof known);
    return 0;
}
