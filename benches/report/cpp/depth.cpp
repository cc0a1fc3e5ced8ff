// Depth of bodies by qdist and its peers: what they answer, how long it takes, and a loop for callgrind to count.
//
//     depth solvers                                     their names
//     depth answers CASES SOLVER:TOLERANCE...           one line a case: outcome, lower, upper, depth, normal
//     depth times ROUNDS CASES SOLVER:TOLERANCE...      nanoseconds a query of each: the median over rounds, for each case
//     depth repeat COUNT CASES SOLVER:TOLERANCE         runs all cases COUNT times
//
// A tolerance of 0 is the solver's own. Cases that a solver does not answer are left out of its times and loops; whoever crashes or hangs takes the program along, so
// `answers` is run by a parent that notices, and the cases that are worth repeating are given by it in a file of their own.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "solvers.hpp"

namespace {

class Nothing final : public Query {
    void run(Answer &answer) override { answer.set_outcome("nothing"); }
};

struct Solver {
    const char *name;
    std::unique_ptr<Query> (*make)(const Case &, double tolerance);
};

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

struct Asked {
    std::string text;
    const Solver *solver;
    double tolerance;
};

Asked asked(const std::string &text) {
    const std::size_t colon = text.rfind(':');
    if (colon != std::string::npos)
        for (const Solver &solver : SOLVERS)
            if (text.compare(0, colon, solver.name) == 0) return {text, &solver, std::atof(text.c_str() + colon + 1)};
    throw std::runtime_error("no solver " + text);
}

// `nullptr` where the solver does not take the case.
std::unique_ptr<Query> made(const Asked &asked, const Case &c) {
    try {
        return asked.solver->make(c, asked.tolerance);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "%s: %s: %s\n", c.id.c_str(), asked.text.c_str(), e.what());
        return nullptr;
    }
}

void answers(const std::vector<Case> &cases, const std::vector<Asked> &all) {
    std::printf("case,solver,outcome,lower,upper,depth,nx,ny,nz\n");
    for (const Asked &asked : all)
        for (const Case &c : cases) {
            Answer answer;
            answer.set_outcome("refused");
            try {
                if (const auto query = made(asked, c)) query->run(answer);
            } catch (const std::exception &) {
                answer = Answer();
                answer.set_outcome("exception");
            }
            std::printf("%s,%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.id.c_str(), asked.text.c_str(), answer.outcome,
                        answer.lower, answer.upper, answer.depth, answer.normal[0], answer.normal[1], answer.normal[2]);
            std::fflush(stdout);
        }
}

double nanoseconds(Query &query, int runs) {
    using Clock = std::chrono::steady_clock;
    Answer answer;
    const auto start = Clock::now();
    for (int i = 0; i < runs; ++i) {
        query.run(answer);
        asm volatile("" : : "r"(&answer) : "memory");  // the answer counts as read: no run can be left out
    }
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / runs;
}

// Round by round, case by case, all solvers one after the other: what disturbs one disturbs all.
void times(int rounds, const std::vector<Case> &cases, const std::vector<Asked> &all) {
    constexpr double BATCH_NS = 30e3;
    std::printf("case,solver,ns\n");
    for (const Case &c : cases) {
        std::vector<std::unique_ptr<Query>> queries;
        std::vector<int> runs;
        for (const Asked &asked : all) {
            queries.push_back(made(asked, c));
            if (queries.back()) nanoseconds(*queries.back(), 2);
            runs.push_back(queries.back() ? 1 + static_cast<int>(BATCH_NS / nanoseconds(*queries.back(), 2)) : 0);
        }
        std::vector<std::vector<double>> samples(all.size());
        for (int round = 0; round < rounds; ++round)
            for (std::size_t s = 0; s < all.size(); ++s)
                if (queries[s]) samples[s].push_back(nanoseconds(*queries[s], runs[s]));
        for (std::size_t s = 0; s < all.size(); ++s) {
            if (samples[s].empty()) continue;
            std::nth_element(samples[s].begin(), samples[s].begin() + samples[s].size() / 2, samples[s].end());
            std::printf("%s,%s,%.1f\n", c.id.c_str(), all[s].text.c_str(), samples[s][samples[s].size() / 2]);
        }
    }
}

void repeat(int count, const std::vector<Case> &cases, const Asked &asked) {
    std::vector<std::unique_ptr<Query>> queries;
    for (const Case &c : cases) queries.push_back(made(asked, c));
    Answer answer;
    for (int i = 0; i < count; ++i)
        for (const auto &query : queries)
            if (query) query->run(answer);
}

}  // namespace

std::unique_ptr<Query> make_nothing(const Case &, double) { return std::make_unique<Nothing>(); }

int main(int argc, char **argv) try {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "solvers") {
        for (const Solver &solver : SOLVERS) std::printf("%s\n", solver.name);
        return 0;
    }
    const bool counts = what == "times" || what == "repeat";
    int at = 2 + counts;
    if ((what != "answers" && !counts) || argc < at + 2) {
        std::fprintf(stderr, "usage: see the head of depth.cpp\n");
        return 2;
    }
    const std::vector<Case> cases = load_cases(argv[at++]);
    std::vector<Asked> all;
    for (; at < argc; ++at) all.push_back(asked(argv[at]));
    if (what == "answers") answers(cases, all);
    if (what == "times") times(std::atoi(argv[2]), cases, all);
    if (what == "repeat") repeat(std::atoi(argv[2]), cases, all.front());
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "depth: %s\n", e.what());
    return 1;
}
