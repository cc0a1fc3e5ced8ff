/* A loop of 1 kHz: a tool, which is a capsule, slides over a box and into it. Every tick asks for the depth, begins where the last tick's normal was, and pushes back. What
 * a tick may cost is BUDGET instructions: three quarters of what a Cortex-M4 of 100 MHz has in a millisecond, and none is late. */
#include "measure.h"
#include "qdist.h"

enum { VERTICES = 32, FACETS = 64, TICKS = 1000, BUDGET = 75000 };
static uint64_t memory[QDIST_WORKSPACE_WORDS_F32(3, VERTICES, FACETS)];

int main(void) {
    static const qdist_box_f32 table = {{0.2f, 0.15f, 0.05f}};
    static const qdist_capsule_f32 tip = {0.01f, 0.04f};
    const float stiffness = 500; /* N / m */
    float velocity[3] = {0.15f, 0.1f, 0}, force[3] = {0, 0, 0};
    qdist_solver *solver;
    qdist_body_f32 tool, box;
    qdist_depth_f32 depth;
    qdist_options_f32 options;
    uint32_t late = 0;

    if (qdist_solver_init_f32(memory, sizeof memory, 3, VERTICES, FACETS, &solver) != QDIST_OK) return measure_refused("qdist_solver_init_f32");
    if (qdist_body_capsule_f32(&tool, &tip) != QDIST_OK || qdist_body_box_f32(&box, &table) != QDIST_OK) return measure_refused("a body");
    if (qdist_options_default_f32(&options) != QDIST_OK) return measure_refused("qdist_options_default_f32");
    random_rotation(tool.rotation);
    options.relative = 1e-3f, options.absolute = 1e-5f; /* a hundredth of a millimetre */
    tool.translation[2] = 0.1f;
    for (int tick = 0; tick < TICKS; ++tick) {
        const float dt = 1e-3f, mass = 0.2f;
        depth.struct_size = sizeof depth;
        measure_begin();
        const uint32_t begin = board_instructions();
        const qdist_status status = qdist_depth3_f32(solver, &tool, &box, &options, &depth);
        late += board_instructions() - begin > BUDGET;
        measure_end();
        if (status != QDIST_OK) return measure_refused("qdist_depth3_f32");
        for (int k = 0; k < 3; ++k) {
            options.guess[k] = depth.normal[k];
            /* The normal points from the tool to the box: the box pushes back. Gravity, and some drag. */
            force[k] = depth.upper > 0 ? -stiffness * depth.upper * depth.normal[k] : 0;
            velocity[k] += dt * (force[k] / mass - (k == 2 ? 9.81f : 0) - 2 * velocity[k]);
            tool.translation[k] += dt * velocity[k];
        }
        options.use_guess = 1;
        measure_answer(depth.outcome == QDIST_CONVERGED || depth.outcome == QDIST_SEPARATED || depth.outcome == QDIST_TOUCHING);
        measure_numbers(&depth.lower, sizeof depth.lower), measure_numbers(&depth.upper, sizeof depth.upper);
        measure_numbers(depth.normal, sizeof depth.normal), measure_numbers(force, sizeof force);
    }
    measure_report("capsule on a box, a tick", sizeof memory);
    if (late != 0) return measure_refused("a tick is late: the budget"); /* (the host counts nothing) */
    return 0;
}
