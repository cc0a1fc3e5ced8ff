// One interface for every solver that is measured, and qdist and peers (libccd, FCL) behind it.
#pragma once

#include <cmath>
#include <cstdio>
#include <memory>

#include "cases.hpp"

// What a solver says about a case. Plain bytes, because it travels through a pipe.
struct Answer {
    char outcome[48] = "";
    // NAN is "does not say": peers give no bracket, and no depth for a pair that they find separated.
    double lower = NAN, upper = NAN;
    double depth = NAN;  // signed: negative is minus the distance
    double normal[3] = {NAN, NAN, NAN};  // from A to B: moving B by depth * normal gives touching contact
    // Of qdist: what the query has done and used.
    unsigned calls = 0, vertices = 0, facets = 0;

    void set_outcome(const char *word) { std::snprintf(outcome, sizeof outcome, "%s", word); }
};

// A query that is ready to run: shapes, poses, meshes and settings are prepared in the constructor and are not timed.
class Query {
public:
    virtual ~Query() = default;
    virtual void run(Answer &answer) = 0;
    // From now on: do they overlap, and nothing else (the depth that is said means yes where it is positive). False: the solver has no such question.
    virtual bool only_overlap() { return false; }
    // From now on: begin at this normal, which was the answer a moment ago. False: the solver takes none.
    virtual bool guess(const double *normal) { return static_cast<void>(normal), false; }
};

// A `tolerance` of 0 is the solver's default, or the author's advice where there is none. Any other is given to the setting that decides how near the answer
// is to be, whatever that is relative to.

// qdist_depth3; the tolerance is relative to the depth, and by default also 1e-12 (float: 1e-5) of the case's size.
std::unique_ptr<Query> make_qdist_f64(const Case &c, double tolerance);
std::unique_ptr<Query> make_qdist_f32(const Case &c, double tolerance);
// ccdGJKPenetration and ccdMPRPenetration; depth of overlapping pairs only.
std::unique_ptr<Query> make_libccd_epa(const Case &c, double tolerance);
std::unique_ptr<Query> make_libccd_mpr(const Case &c, double tolerance);
// fcl::collide with contacts (overlap only), and fcl::distance with signed distance, both with FCL's libccd solver.
std::unique_ptr<Query> make_fcl_libccd(const Case &c, double tolerance);
std::unique_ptr<Query> make_fcl_signed(const Case &c, double tolerance);
