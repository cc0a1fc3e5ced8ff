// The solvers of the report, behind the interface of `ffi-tests/peers.hpp`. Which of them are there is decided when the program is built.
#pragma once

#include "../../../ffi-tests/peers.hpp"

// btGjkEpaSolver2 and btGjkPairDetector of Bullet, margin 0; no tolerance to choose.
std::unique_ptr<Query> make_bullet(const Case &c, double tolerance);
// mj_geomDistance of MuJoCo (ccd_tolerance; ccd_iterations as many as that takes); vertices of hulls are floats there.
std::unique_ptr<Query> make_mujoco(const Case &c, double tolerance);
// coal::collide (epa_tolerance and gjk_tolerance; iterations as many as that takes).
std::unique_ptr<Query> make_coal(const Case &c, double tolerance);

// Nothing: what the interface itself costs.
class Nothing final : public Query {
    void run(Answer &answer) override { answer.set_outcome("nothing"); }
};

inline std::unique_ptr<Query> make_nothing(const Case &, double) { return std::make_unique<Nothing>(); }

struct Solver {
    const char *name;
    std::unique_ptr<Query> (*make)(const Case &, double tolerance);
};

// Those that are here.
constexpr Solver SOLVERS[] = {
    {"nothing", make_nothing},     {"qdist", make_qdist_f64},   {"qdist f32", make_qdist_f32},
    {"libccd EPA", make_libccd_epa}, {"libccd MPR", make_libccd_mpr},
    {"FCL", make_fcl_libccd},      {"FCL signed", make_fcl_signed},
#ifdef HAS_BULLET
    {"Bullet", make_bullet},
#endif
#ifdef HAS_MUJOCO
    {"MuJoCo", make_mujoco},
#endif
#ifdef HAS_COAL
    {"coal", make_coal},
#endif
};
