// compare OUT_DIR CASE_FILE...: runs qdist and its peers over case files and writes OUT_DIR/compare.csv, one row for
// every case and solver. compare_table.py reads it. What the children say on stderr goes to OUT_DIR/compare.log.
//
// Every solver runs in child processes: libraries of this kind abort, throw, hang and crash on some of the cases, and
// that has to become a row.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "peers.hpp"

namespace {

struct Solver {
    const char *name;
    std::unique_ptr<Query> (*make)(const Case &, double tolerance);
};

constexpr Solver SOLVERS[] = {
    {"qdist_f64", make_qdist_f64},     {"qdist_f32", make_qdist_f32},
    {"libccd_epa", make_libccd_epa},   {"libccd_mpr", make_libccd_mpr},
    {"fcl_libccd", make_fcl_libccd},   {"fcl_signed", make_fcl_signed},
};

// ---------------------------------------------------------------------------------------------------------- timing

// Median over batches of the time per run. A batch is long against the clock's resolution; all batches together are
// short enough for thousands of cases.
double median_ns(Query &query) {
    using Clock = std::chrono::steady_clock;
    constexpr double BATCH_NS = 20e3, TOTAL_NS = 5e6;
    constexpr int BATCHES = 15;
    const auto batch = [&](int runs) {
        Answer answer;
        const auto start = Clock::now();
        for (int i = 0; i < runs; ++i) {
            query.run(answer);
            asm volatile("" : : "r"(&answer) : "memory");  // the answer counts as read: no run can be optimised away
        }
        return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    };

    int runs = 1;
    double spent = 0, last;
    for (;; runs *= 2) {  // find the batch length; this warms caches and branch prediction, too
        spent += last = batch(runs);
        if (last >= BATCH_NS || spent >= TOTAL_NS) break;
    }
    std::vector<double> samples{last / runs};
    while (samples.size() < BATCHES && spent + last < TOTAL_NS) {
        spent += last = batch(runs);
        samples.push_back(last / runs);
    }
    std::nth_element(samples.begin(), samples.begin() + samples.size() / 2, samples.end());
    return samples[samples.size() / 2];
}

// ------------------------------------------------------------------------------------------------- child processes

constexpr unsigned HANG_SECONDS = 2;  // per case and solver, preparation included

struct Row {
    Answer answer;
    double ns = NAN;
};
static_assert(sizeof(Row) <= 512, "a write to a pipe is atomic up to PIPE_BUF, which is at least 512");

Row measure(const Solver &solver, const Case &c) {
    Row row;
    try {
        const std::unique_ptr<Query> query = solver.make(c, 0);
        query->run(row.answer);
        if (std::strncmp(row.answer.outcome, "status:", 7) != 0) row.ns = median_ns(*query);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "%s: %s: exception: %s\n", c.id.c_str(), solver.name, e.what());
        row = Row();
        row.answer.set_outcome("exception");
    }
    return row;
}

[[noreturn]] void child(int pipe_end, int log, const Solver &solver, const std::vector<Case> &cases, std::size_t first) {
    dup2(log, STDERR_FILENO);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    std::signal(SIGALRM, SIG_DFL);  // its default action ends the process, even inside a loop of a library
    for (std::size_t i = first; i < cases.size(); ++i) {
        alarm(HANG_SECONDS);
        const Row row = measure(solver, cases[i]);
        if (write(pipe_end, &row, sizeof row) != static_cast<ssize_t>(sizeof row)) _exit(1);
    }
    _exit(0);
}

[[noreturn]] void die(const char *what) {
    std::fprintf(stderr, "compare: %s: %s\n", what, std::strerror(errno));
    std::exit(1);
}

// Appends the rows that one child gives for the cases from rows.size() on. Returns its wait status.
int run_child(const Solver &solver, const std::vector<Case> &cases, std::vector<Row> &rows, int log) {
    int ends[2];
    if (pipe(ends) != 0) die("pipe");
    const pid_t pid = fork();
    if (pid < 0) die("fork");
    if (pid == 0) {
        close(ends[0]);
        child(ends[1], log, solver, cases, rows.size());
    }
    close(ends[1]);
    Row row;
    for (;;) {
        const ssize_t got = read(ends[0], &row, sizeof row);
        if (got < 0 && errno == EINTR) continue;
        if (got != static_cast<ssize_t>(sizeof row)) break;
        rows.push_back(row);
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR) die("waitpid");
    return status;
}

// One child for all cases of a file, and a new one behind every crash.
std::vector<Row> run_solver(const Solver &solver, const std::vector<Case> &cases, int log) {
    std::vector<Row> rows;
    while (rows.size() < cases.size()) {
        const std::size_t first = rows.size();
        const int status = run_child(solver, cases, rows, log);
        if (rows.size() == cases.size()) break;
        const bool hang = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
        // An earlier case may have damaged the heap: a case is to blame only if it crashes a fresh process.
        if (!hang && rows.size() > first) continue;
        dprintf(log, "%s: %s: %s, wait status %d\n", cases[rows.size()].id.c_str(), solver.name,
                hang ? "hang" : "abort", status);
        Row row;
        row.answer.set_outcome(hang ? "hang" : "abort");
        rows.push_back(row);
    }
    return rows;
}

// ------------------------------------------------------------------------------------------------------------- CSV

// NAN is "not said" in every column but the normal, where it is what the solver gave.
void print_number(std::FILE *csv, double value, const char *format, bool empty_if_nan) {
    std::fputc(',', csv);
    if (!(empty_if_nan && std::isnan(value))) std::fprintf(csv, format, value);
}

void print_row(std::FILE *csv, const Case &c, const Solver &solver, const Row &row) {
    std::fprintf(csv, "%s,%s,%s", c.id.c_str(), solver.name, row.answer.outcome);
    for (const double value : {row.answer.lower, row.answer.upper, row.answer.depth})
        print_number(csv, value, "%.17g", true);
    for (const double value : row.answer.normal) print_number(csv, value, "%.17g", std::isnan(row.answer.depth));
    print_number(csv, row.ns, "%.1f", true);
    std::fputc('\n', csv);
}

}  // namespace

int main(int argc, char **argv) try {
    if (argc < 3) {
        std::fprintf(stderr, "usage: compare OUT_DIR CASE_FILE...\n");
        return 2;
    }
    const std::string out = argv[1];
    std::FILE *csv = std::fopen((out + "/compare.csv").c_str(), "w");
    if (csv == nullptr) die((out + "/compare.csv").c_str());
    const int log = open((out + "/compare.log").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
    if (log < 0) die((out + "/compare.log").c_str());

    std::fprintf(csv, "case,solver,outcome,lower,upper,depth,nx,ny,nz,median_ns\n");
    for (int arg = 2; arg < argc; ++arg) {
        const auto start = std::chrono::steady_clock::now();
        const std::vector<Case> cases = load_cases(argv[arg]);
        std::fflush(csv);  // a child must not own unwritten rows
        std::vector<std::vector<Row>> rows;
        for (const Solver &solver : SOLVERS) rows.push_back(run_solver(solver, cases, log));
        for (std::size_t i = 0; i < cases.size(); ++i)
            for (std::size_t s = 0; s < rows.size(); ++s) print_row(csv, cases[i], SOLVERS[s], rows[s][i]);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::printf("%s: %zu cases, %.1f s\n", argv[arg], cases.size(), seconds.count());
        std::fflush(stdout);
    }
    if (std::fclose(csv) != 0) die("writing compare.csv");
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "compare: %s\n", e.what());
    return 1;
}
