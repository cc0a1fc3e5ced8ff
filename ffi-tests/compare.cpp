// compare OUT_DIR CASE_FILE...: runs qdist and its peers over case files and writes OUT_DIR/compare.csv, one row for
// every case and solver. compare_table.py reads it. What the children say on stderr goes to OUT_DIR/compare.log.
//
// Every solver runs in child processes: libraries of this kind abort, throw, hang and crash on some of the cases, and
// that has to become a row. With -DNO_QDIST only the peers are built.

#include <algorithm>
#include <cctype>
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

#ifndef NO_QDIST
#include "qdist.h"
#endif

namespace {

// ----------------------------------------------------------------------------------------------------------- qdist
#ifndef NO_QDIST

constexpr uint32_t MAX_VERTICES = 256, MAX_FACETS = 512;
constexpr std::size_t WALK_FROM = 33;  // vertices; the peers change from scan to walk at the same number

// The names of one scalar type. The tolerances are what the type can hold: `absolute` is per unit of size.
#define QDIST_SCALAR(Name, real, suffix, SUFFIX, relative_tolerance, absolute_tolerance)                          \
    struct Name {                                                                                                 \
        using Real = real;                                                                                        \
        using Body = qdist_body_##suffix;                                                                         \
        using Options = qdist_options_##suffix;                                                                   \
        using Depth = qdist_depth_##suffix;                                                                       \
        using Sphere = qdist_sphere_##suffix;                                                                     \
        using Box = qdist_box_##suffix;                                                                           \
        using Ellipsoid = qdist_ellipsoid_##suffix;                                                               \
        using Cylinder = qdist_cylinder_##suffix;                                                                 \
        using Capsule = qdist_capsule_##suffix;                                                                   \
        using Cone = qdist_cone_##suffix;                                                                         \
        using Points = qdist_points_##suffix;                                                                     \
        using Hull = qdist_hull_##suffix;                                                                         \
        static constexpr double relative = relative_tolerance, absolute = absolute_tolerance;                     \
        static constexpr std::size_t bytes = QDIST_WORKSPACE_BYTES_##SUFFIX(3, MAX_VERTICES, MAX_FACETS);         \
        static constexpr auto body_sphere = qdist_body_sphere_##suffix;                                           \
        static constexpr auto body_box = qdist_body_box_##suffix;                                                 \
        static constexpr auto body_ellipsoid = qdist_body_ellipsoid_##suffix;                                     \
        static constexpr auto body_cylinder = qdist_body_cylinder_##suffix;                                       \
        static constexpr auto body_capsule = qdist_body_capsule_##suffix;                                         \
        static constexpr auto body_cone = qdist_body_cone_##suffix;                                               \
        static constexpr auto body_points = qdist_body_points_##suffix;                                           \
        static constexpr auto body_hull = qdist_body_hull_##suffix;                                               \
        static constexpr auto hull_prepare = qdist_hull_prepare_##suffix;                                         \
        static constexpr auto solver_init = qdist_solver_init_##suffix;                                           \
        static constexpr auto options_default = qdist_options_default_##suffix;                                   \
        static constexpr auto depth3 = qdist_depth3_##suffix;                                                     \
    };
QDIST_SCALAR(F64, double, f64, F64, 1e-6, 1e-12)
QDIST_SCALAR(F32, float, f32, F32, 1e-4, 1e-5)
#undef QDIST_SCALAR

// A body and all that it points to. It must not move.
template <class Q>
struct QdistSide {
    using Real = typename Q::Real;
    typename Q::Sphere sphere{};
    typename Q::Box box{};
    typename Q::Ellipsoid ellipsoid{};
    typename Q::Cylinder cylinder{};
    typename Q::Capsule capsule{};
    typename Q::Cone cone{};
    typename Q::Points cloud{};
    typename Q::Hull hull{};
    std::vector<Real> points;
    std::vector<uint16_t> graph;
    typename Q::Body body{};

    qdist_status prepare(const Shape &shape) {
        const qdist_status status = prepare_shape(shape);
        if (status == QDIST_OK) {  // the numbers of the file, rounded to the scalar type and nothing else
            std::copy(shape.rotation.begin(), shape.rotation.end(), body.rotation);
            std::copy(shape.translation.begin(), shape.translation.end(), body.translation);
        }
        return status;
    }

private:
    qdist_status prepare_shape(const Shape &shape) {
        const std::vector<Real> p(shape.params.begin(), shape.params.end());
        switch (shape.kind) {
            case Kind::sphere: sphere.radius = p[0]; return Q::body_sphere(&body, &sphere);
            case Kind::box: std::copy_n(p.begin(), 3, box.half); return Q::body_box(&body, &box);
            case Kind::ellipsoid:
                std::copy_n(p.begin(), 3, ellipsoid.semi_axes);
                return Q::body_ellipsoid(&body, &ellipsoid);
            case Kind::cylinder: return Q::body_cylinder(&body, round(cylinder, p));
            case Kind::capsule: return Q::body_capsule(&body, round(capsule, p));
            case Kind::cone: return Q::body_cone(&body, round(cone, p));
            case Kind::hull: break;
        }
        points.assign(shape.vertices.begin(), shape.vertices.end());
        const auto count = static_cast<uint32_t>(points.size() / 3);
        if (count >= WALK_FROM) {
            const qdist_status status = prepare_walk(count);
            // Flat up to rounding (a plate of aspect 1e6 in float): no graph, but the scan takes it.
            if (status != QDIST_ERROR_FLAT) return status;
        }
        cloud.points = points.data();
        cloud.count = count;
        cloud.dimension = 3;
        return Q::body_points(&body, &cloud);
    }

    template <class Round>
    static const Round *round(Round &shape, const std::vector<Real> &p) {
        shape.radius = p[0];
        shape.half_height = p[1];
        return &shape;
    }

    // The adjacency is computed once, with a solver that is big enough for it and is then thrown away.
    qdist_status prepare_walk(uint32_t count) {
        const uint32_t facets = 2 * count + 16;
        uint32_t bytes = 0;
        qdist_status status = qdist_workspace_query(sizeof(typename Q::Real), 3, count, facets, &bytes);
        if (status != QDIST_OK) return status;
        static_assert(QDIST_WORKSPACE_ALIGN <= __STDCPP_DEFAULT_NEW_ALIGNMENT__, "operator new aligns enough");
        std::vector<unsigned char> memory(bytes);
        qdist_solver *solver = nullptr;
        status = Q::solver_init(memory.data(), bytes, 3, count, facets, &solver);
        if (status != QDIST_OK) return status;
        graph.resize(QDIST_HULL_GRAPH_LEN(count));
        status = Q::hull_prepare(&hull, solver, points.data(), count, nullptr, nullptr, graph.data(), static_cast<uint32_t>(graph.size()));
        return status == QDIST_OK ? Q::body_hull(&body, &hull) : status;
    }
};

template <class Q>
class QdistQuery final : public Query {
public:
    explicit QdistQuery(const Case &c) {
        alignas(QDIST_WORKSPACE_ALIGN) static unsigned char memory[Q::bytes];
        Q::options_default(&options_);
        options_.relative = static_cast<typename Q::Real>(Q::relative);
        options_.absolute = static_cast<typename Q::Real>(Q::absolute * c.size);
        status_ = Q::solver_init(memory, sizeof memory, 3, MAX_VERTICES, MAX_FACETS, &solver_);
        if (status_ == QDIST_OK) status_ = a_.prepare(c.a);
        if (status_ == QDIST_OK) status_ = b_.prepare(c.b);
    }

    void run(Answer &answer) override {
        typename Q::Depth result;
        result.struct_size = sizeof result;
        const qdist_status status =
            status_ == QDIST_OK ? Q::depth3(solver_, &a_.body, &b_.body, &options_, &result) : status_;
        if (status != QDIST_OK) {
            set_word(answer, "status:", qdist_status_string(status));
            return;
        }
        set_word(answer, "", qdist_outcome_string(result.outcome));
        answer.lower = result.lower;
        answer.upper = answer.depth = result.upper;
        std::copy_n(result.normal, 3, answer.normal);
    }

private:
    // Lower case, and nothing that would break a column of the table.
    static void set_word(Answer &answer, const char *prefix, const char *word) {
        std::snprintf(answer.outcome, sizeof answer.outcome, "%s%s", prefix, word);
        for (char *c = answer.outcome; *c != '\0'; ++c)
            *c = *c == ' ' || *c == ',' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(*c)));
    }

    qdist_solver *solver_ = nullptr;
    qdist_status status_ = QDIST_OK;
    typename Q::Options options_;
    QdistSide<Q> a_, b_;
};

std::unique_ptr<Query> make_qdist_f64(const Case &c) { return std::make_unique<QdistQuery<F64>>(c); }
std::unique_ptr<Query> make_qdist_f32(const Case &c) { return std::make_unique<QdistQuery<F32>>(c); }
#endif

struct Solver {
    const char *name;
    std::unique_ptr<Query> (*make)(const Case &);
};

constexpr Solver SOLVERS[] = {
#ifndef NO_QDIST
    {"qdist_f64", make_qdist_f64},     {"qdist_f32", make_qdist_f32},
#endif
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
        const std::unique_ptr<Query> query = solver.make(c);
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
