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
std::unique_ptr<Query> make_nothing(const Case &c, double tolerance);
