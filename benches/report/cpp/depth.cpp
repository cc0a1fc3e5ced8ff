// Depth of bodies by qdist and its peers: what they answer, how long it takes, and loops for callgrind to count.
//
//     depth solvers                                     their names
//     depth answers CASES SOLVER:TOLERANCE...           one line a case: outcome, lower, upper, depth, normal; after `--mode up` (down, zero, ftz) with
//                                                       that rounding mode, or with subnormal numbers taken for zero
//     depth used CASES SOLVER:TOLERANCE...              of qdist: support calls, vertices and facets
//     depth times ROUNDS CASES SOLVER:TOLERANCE...      nanoseconds a query of each: the median over rounds, for each case
//     depth count CASES SOLVER:TOLERANCE...             under callgrind: three dumps a solver, of 1, 1 and 3 rounds over all cases; SOLVER,CASES
//
// `--overlap`: solvers are asked whether the bodies overlap, and nothing else. `--guess`: every case but the first is a frame that follows the one before, whose normal
// solvers that take one begin at. Solvers that know no such question are left out.
//
// A tolerance of 0 is the solver's own. Cases that a solver does not answer are left out of its times and loops; whoever crashes or hangs takes the program along, so
// `answers` is run by a parent that notices, and is told which cases to leave out for whom (`--without SOLVER:TOLERANCE=CASE,CASE`).

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "environment.hpp"
#include "solvers.hpp"

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS
#endif

namespace {

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

std::map<std::string, std::set<std::string>> left_out;

// SOLVER:TOLERANCE=CASE,CASE
void leave_out(const std::string &text) {
    const std::size_t equals = text.find('=');
    std::istringstream list(text.substr(equals + 1));
    for (std::string id; std::getline(list, id, ',');) left_out[text.substr(0, equals)].insert(id);
}

// `nullptr` where the solver does not take the case, or is not to have it.
std::unique_ptr<Query> made(const Asked &asked, const Case &c) {
    const auto out = left_out.find(asked.text);
    if (out != left_out.end() && out->second.count(c.id) > 0) return nullptr;
    try {
        return asked.solver->make(c, asked.tolerance);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "%s: %s: %s\n", c.id.c_str(), asked.text.c_str(), e.what());
        return nullptr;
    }
}

bool overlap = false, follow = false;

// All queries of a solver; `nullptr` as above.
std::vector<std::unique_ptr<Query>> made(const Asked &asked, const std::vector<Case> &cases) {
    std::vector<std::unique_ptr<Query>> queries;
    Answer before;
    for (const Case &c : cases) {
        auto query = made(asked, c);
        if (query && overlap && !query->only_overlap()) query.reset();
        if (query && follow && !std::isnan(before.normal[0]) && !query->guess(before.normal)) query.reset();
        before = Answer();
        if (query && follow) query->run(before);
        queries.push_back(std::move(query));
    }
    return queries;
}

std::string mode;

void answers(const std::vector<Case> &cases, const std::vector<Asked> &all) {
    std::printf("case,solver,outcome,lower,upper,depth,nx,ny,nz\n");
    for (const Asked &asked : all) {
        const auto queries = overlap || follow ? made(asked, cases) : std::vector<std::unique_ptr<Query>>();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Case &c = cases[i];
            Answer answer;
            answer.set_outcome("refused");
            try {
                const auto alone = queries.empty() ? made(asked, c) : nullptr;
                if (Query *query = queries.empty() ? alone.get() : queries[i].get()) {
                    const Mode held(mode);
                    query->run(answer);
                }
            } catch (const std::exception &) {
                answer = Answer();
                answer.set_outcome("exception");
            }
            std::printf("%s,%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.id.c_str(), asked.text.c_str(), answer.outcome,
                        answer.lower, answer.upper, answer.depth, answer.normal[0], answer.normal[1], answer.normal[2]);
            std::fflush(stdout);
        }
    }
}

void used(const std::vector<Case> &cases, const std::vector<Asked> &all) {
    std::printf("case,solver,calls,vertices,facets\n");
    for (const Asked &asked : all)
        for (const Case &c : cases)
            if (const auto query = made(asked, c)) {
                Answer answer;
                query->run(answer);
                std::printf("%s,%s,%u,%u,%u\n", c.id.c_str(), asked.text.c_str(), answer.calls, answer.vertices, answer.facets);
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

// Round by round, case by case, all solvers one after the other: what disturbs one disturbs all. Each makes some queries before its time is taken, so that
// caches hold what it needs whoever came before it: to fetch bodies of thousands of points takes longer than a query.
void times(int rounds, const std::vector<Case> &cases, const std::vector<Asked> &all) {
    constexpr double BATCH_NS = 30e3;
    constexpr int WARM_UP = 4;
    std::printf("case,solver,ns\n");
    std::vector<std::vector<std::unique_ptr<Query>>> of_solver;
    for (const Asked &asked : all) of_solver.push_back(made(asked, cases));
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case &c = cases[i];
        std::vector<Query *> queries;
        std::vector<int> runs;
        for (const auto &made : of_solver) {
            queries.push_back(made[i].get());
            if (queries.back()) nanoseconds(*queries.back(), 2);
            runs.push_back(queries.back() ? 1 + static_cast<int>(BATCH_NS / nanoseconds(*queries.back(), 2)) : 0);
        }
        std::vector<std::vector<double>> samples(all.size());
        for (int round = 0; round < rounds; ++round)
            for (std::size_t s = 0; s < all.size(); ++s)
                if (queries[s]) {
                    nanoseconds(*queries[s], WARM_UP);
                    samples[s].push_back(nanoseconds(*queries[s], runs[s]));
                }
        for (std::size_t s = 0; s < all.size(); ++s) {
            if (samples[s].empty()) continue;
            std::nth_element(samples[s].begin(), samples[s].begin() + samples[s].size() / 2, samples[s].end());
            std::printf("%s,%s,%.1f\n", c.id.c_str(), all[s].text.c_str(), samples[s][samples[s].size() / 2]);
        }
    }
}

// What is between two dumps is a number of rounds: the difference of two of them has nothing else in it.
void count(const std::vector<Case> &cases, const std::vector<Asked> &all) {
    std::printf("solver,cases\n");
    for (const Asked &asked : all) {
        std::vector<std::unique_ptr<Query>> queries = made(asked, cases);
        queries.erase(std::remove(queries.begin(), queries.end(), nullptr), queries.end());
        Answer answer;
        for (const int rounds : {1, 1, 3}) {  // (the first one warms up)
            CALLGRIND_ZERO_STATS;
            for (int i = 0; i < rounds; ++i)
                for (const auto &query : queries) query->run(answer);
            CALLGRIND_DUMP_STATS;
        }
        std::printf("%s,%zu\n", asked.text.c_str(), queries.size());
    }
}

}  // namespace

int main(int argc, char **argv) try {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "solvers") {
        for (const Solver &solver : SOLVERS) std::printf("%s\n", solver.name);
        return 0;
    }
    int at = what == "times" ? 3 : 2;
    if ((what != "answers" && what != "used" && what != "times" && what != "count") || argc < at + 2) {
        std::fprintf(stderr, "usage: see the head of depth.cpp\n");
        return 2;
    }
    const std::vector<Case> cases = load_cases(argv[at++]);
    std::vector<Asked> all;
    for (; at < argc; ++at) {
        if (std::strcmp(argv[at], "--without") == 0 && at + 1 < argc)
            leave_out(argv[++at]);
        else if (std::strcmp(argv[at], "--mode") == 0 && at + 1 < argc)
            mode = argv[++at];
        else if (std::strcmp(argv[at], "--overlap") == 0)
            overlap = true;
        else if (std::strcmp(argv[at], "--guess") == 0)
            follow = true;
        else
            all.push_back(asked(argv[at]));
    }
    if (what == "answers") answers(cases, all);
    if (what == "used") used(cases, all);
    if (what == "times") times(std::atoi(argv[2]), cases, all);
    if (what == "count") count(cases, all);
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "depth: %s\n", e.what());
    return 1;
}
