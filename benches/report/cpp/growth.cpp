// How qdist grows with what a problem has most of: the same few queries at every size.
//
//     growth times ROUNDS LARGEST     a line a size: series,size,ns,calls,vertices,facets,bytes; times are medians over rounds of the mean over the queries
//     growth count LARGEST            under callgrind: three dumps a line, of 1, 1 and 3 rounds; series,size,queries
//
// LARGEST is the most vertices of a hull. `bytes` is what a query needs: a workspace for so many vertices and facets, and of hulls points and graph.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS
#endif

#include "qdist_grasp.h"

namespace {

// What a query has used, in sums over queries.
struct Used {
    double calls = 0, vertices = 0, facets = 0, bytes = 0;
};

using Query = std::function<void(Used &)>;

struct Line {
    std::string series;
    double size;
    std::vector<Query> queries;
};

void must(qdist_status status) {
    if (status != QDIST_OK) throw std::runtime_error(qdist_status_string(status));
}

// Random numbers that are the same everywhere.
class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
    std::vector<double> direction(int n) {
        for (;;) {
            std::vector<double> v(n);
            double square = 0;
            for (double &x : v) {
                x = between(-1, 1);
                square += x * x;
            }
            if (square < 0.01 || square > 1) continue;
            for (double &x : v) x /= std::sqrt(square);
            return v;
        }
    }

private:
    std::mt19937 engine_;
};

// A solver and its memory: of the plans that fill it, none is to be short of it.
struct Solver {
    std::vector<uint64_t> memory;
    qdist_solver *solver = nullptr;
    Solver(uint32_t dimension, uint32_t vertices, uint32_t facets) : memory(QDIST_WORKSPACE_WORDS_F64(dimension, vertices, facets)) {
        must(qdist_solver_init_f64(memory.data(), static_cast<uint32_t>(8 * memory.size()), dimension, vertices, facets, &solver));
    }
};

qdist_options_f64 within(double relative) {
    qdist_options_f64 options;
    must(qdist_options_default_f64(&options));
    options.relative = relative;
    options.absolute = 0;
    return options;
}

template <class Result>
void add(Used &used, const Result &result, uint32_t dimension, double more) {
    used.calls += result.support_calls;
    used.vertices += result.vertices_used;
    used.facets += result.facets_used;
    used.bytes += QDIST_WORKSPACE_BYTES_F64(dimension, result.vertices_used, result.facets_used) + more;
}

// ------------------------------------------------------------------------------------------------------ pairs of bodies

struct Pair {
    qdist_ellipsoid_f64 ellipsoids[2]{};
    qdist_cylinder_f64 cylinders[2]{};
    std::vector<double> points[2];
    std::vector<uint32_t> graphs[2];
    qdist_hull_large_f64 hulls[2]{};
    qdist_body_f64 bodies[2]{};
    double bytes = 0;
};

void turn(qdist_body_f64 &body, Dice &dice) {
    const std::vector<double> q = dice.direction(4);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z), 1 - 2 * (x * x + z * z),
                            2 * (y * z - w * x),     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
    std::copy(rows, rows + 9, body.rotation);
}

// The second body is moved away by this, in a random direction: bodies have sizes of 0.5 to 1, and overlap.
void place(Pair &pair, Dice &dice, double distance) {
    for (auto &body : pair.bodies) turn(body, dice);
    const std::vector<double> u = dice.direction(3);
    for (int i = 0; i < 3; ++i) pair.bodies[1].translation[i] = distance * u[i];
}

std::shared_ptr<Pair> ellipsoids(Dice &dice) {
    auto pair = std::make_shared<Pair>();
    for (int k = 0; k < 2; ++k) {
        for (double &axis : pair->ellipsoids[k].semi_axes) axis = dice.between(0.5, 1);
        must(qdist_body_ellipsoid_f64(&pair->bodies[k], &pair->ellipsoids[k]));
    }
    place(*pair, dice, 0.9);
    return pair;
}

std::shared_ptr<Pair> cylinders(Dice &dice) {
    auto pair = std::make_shared<Pair>();
    for (int k = 0; k < 2; ++k) {
        pair->cylinders[k].radius = dice.between(0.5, 1);
        pair->cylinders[k].half_height = dice.between(0.5, 1);
        must(qdist_body_cylinder_f64(&pair->bodies[k], &pair->cylinders[k]));
    }
    place(*pair, dice, 0.9);
    return pair;
}

std::shared_ptr<Pair> hulls(Dice &dice, uint32_t count) {
    auto pair = std::make_shared<Pair>();
    std::vector<uint32_t> workspace(QDIST_HULL_LARGE_WORKSPACE_LEN(count));
    for (int k = 0; k < 2; ++k) {
        for (uint32_t i = 0; i < count; ++i)
            for (const double x : dice.direction(3)) pair->points[k].push_back(x);
        pair->graphs[k].resize(QDIST_HULL_LARGE_GRAPH_LEN(count));
        must(qdist_hull_large_prepare_f64(&pair->hulls[k], workspace.data(), static_cast<uint32_t>(workspace.size()), pair->points[k].data(), count, nullptr, nullptr,
                                          pair->graphs[k].data(), static_cast<uint32_t>(pair->graphs[k].size())));
        must(qdist_body_hull_large_f64(&pair->bodies[k], &pair->hulls[k]));
        pair->bytes += 8.0 * 3 * count + 4.0 * pair->hulls[k].graph_len;
    }
    place(*pair, dice, 1.7);
    return pair;
}

Query preparation(Dice &dice, uint32_t count) {
    const auto points = std::make_shared<std::vector<double>>();
    for (uint32_t i = 0; i < count; ++i)
        for (const double x : dice.direction(3)) points->push_back(x);
    const auto workspace = std::make_shared<std::vector<uint32_t>>(QDIST_HULL_LARGE_WORKSPACE_LEN(count));
    const auto graph = std::make_shared<std::vector<uint32_t>>(QDIST_HULL_LARGE_GRAPH_LEN(count));
    return [=](Used &used) {
        qdist_hull_large_f64 hull;
        must(qdist_hull_large_prepare_f64(&hull, workspace->data(), static_cast<uint32_t>(workspace->size()), points->data(), count, nullptr, nullptr, graph->data(),
                                          static_cast<uint32_t>(graph->size())));
        used.bytes += 8.0 * static_cast<double>(points->size()) + 4.0 * static_cast<double>(workspace->size() + graph->size());
    };
}

Query depth_of(std::shared_ptr<Pair> pair, double relative) {
    static Solver solver(3, 2048, 4096);
    return [pair, relative](Used &used) {
        const qdist_options_f64 options = within(relative);
        qdist_depth_f64 result;
        result.struct_size = sizeof result;
        must(qdist_depth3_f64(solver.solver, &pair->bodies[0], &pair->bodies[1], &options, &result));
        add(used, result, 3, pair->bytes);
    };
}

// -------------------------------------------------------------------------------------------------- d_Q in n dimensions

struct Solve {
    std::vector<double> semi_axes;
    std::vector<qdist_primitive_f64> primitives;
    std::vector<double> vertices;
    qdist_points_f64 points{};
    qdist_wrenches_f64 wrenches{};
    qdist_set_f64 set{};
    qdist_unit_f64 unit{};
};

// A set of one's own, as a user writes it: an ellipsoid, of which nothing else is told.
int32_t ellipsoid_support(void *user, const double *direction, double *point) {
    const auto &axes = *static_cast<const std::vector<double> *>(user);
    double square = 0;
    for (std::size_t i = 0; i < axes.size(); ++i) square += axes[i] * axes[i] * direction[i] * direction[i];
    for (std::size_t i = 0; i < axes.size(); ++i) point[i] = axes[i] * axes[i] * direction[i] / std::sqrt(square);
    return 0;
}

std::shared_ptr<Solve> ellipsoid_in(uint32_t n) {
    auto solve = std::make_shared<Solve>();
    for (uint32_t i = 0; i < n; ++i) solve->semi_axes.push_back(1 + static_cast<double>(i) / (n - 1));
    solve->set.support = ellipsoid_support;
    solve->set.user = &solve->semi_axes;
    solve->set.dimension = n;
    must(qdist_unit_ball_f64(&solve->unit, 1));
    return solve;
}

// Soft fingers on an ellipsoid about the size of what hands hold; grasps that are not closed are thrown again.
std::shared_ptr<Solve> grasp(Dice &dice, uint32_t count) {
    static Solver solver(6, 512, 4096);
    constexpr double AXES[3] = {1, 0.8, 0.6};
    for (;;) {
        std::vector<qdist_contact_f64> contacts(count);
        for (qdist_contact_f64 &c : contacts) {
            std::memset(&c, 0, sizeof c);
            const std::vector<double> u = dice.direction(3);
            double length = 0;
            for (int i = 0; i < 3; ++i) length = std::hypot(length, u[i] / AXES[i]);
            for (int i = 0; i < 3; ++i) c.position[i] = AXES[i] * u[i], c.normal[i] = -u[i] / AXES[i] / length;
            c.friction = QDIST_SOFT, c.mu = dice.between(0.3, 0.8), c.mus = dice.between(0.05, 0.3), c.force_cap = 1;
        }
        auto solve = std::make_shared<Solve>();
        solve->primitives.resize(count);
        const qdist_wrench_frame_f64 frame = {{0, 0, 0}, 1};
        must(qdist_primitives_f64(contacts.data(), count, &frame, 0, 0, solve->primitives.data(), nullptr));
        solve->wrenches = {solve->primitives.data(), count, QDIST_LINF};
        must(qdist_set_wrenches_f64(&solve->set, &solve->wrenches));
        must(qdist_unit_ball_f64(&solve->unit, 1));
        qdist_options_f64 options = within(1e-2);
        options.use_threshold = 1;
        options.threshold = 0.05;
        qdist_result_f64 result;
        result.struct_size = sizeof result;
        must(qdist_solve6_f64(solver.solver, &solve->set, &solve->unit, &options, &result));
        if (result.lower > 0.05) return solve;
    }
}

// Q is a hull of so many points on a ball.
std::shared_ptr<Solve> vertices_of_q(Dice &dice, uint32_t count) {
    auto solve = ellipsoid_in(3);
    for (uint32_t i = 0; i < count; ++i)
        for (const double x : dice.direction(3)) solve->vertices.push_back(x);
    solve->points.points = solve->vertices.data(), solve->points.count = count, solve->points.dimension = 3;
    must(qdist_unit_vertices_f64(&solve->unit, &solve->points));
    return solve;
}

Query solved(std::shared_ptr<Solve> solve, uint32_t n, double relative) {
    static constexpr decltype(&qdist_solve6_f64) SOLVES[] = {qdist_solve2_f64, qdist_solve3_f64, qdist_solve4_f64, qdist_solve5_f64, qdist_solve6_f64};
    static Solver solvers[] = {{2, 512, 4096}, {3, 1024, 4096}, {4, 1024, 8192}, {5, 1024, 16384}, {6, 1024, 32768}};
    return [solve, n, relative](Used &used) {
        const qdist_options_f64 options = within(relative);
        qdist_result_f64 result;
        result.struct_size = sizeof result;
        must(SOLVES[n - 2](solvers[n - 2].solver, &solve->set, &solve->unit, &options, &result));
        add(used, result, n, 0);
    };
}

std::vector<Line> lines(uint32_t largest) {
    std::vector<Line> all;
    const auto put = [&all](const char *series, double size, int count, const std::function<Query(Dice &)> &make) {
        Dice dice(2013);
        Line line = {series, size, {}};
        for (int k = 0; k < count; ++k) line.queries.push_back(make(dice));
        all.push_back(std::move(line));
    };
    for (const double digits : {1, 2, 3, 4, 6, 8, 10, 12}) {
        const double relative = std::pow(10.0, -digits);
        put("1/tolerance, ellipsoids", 1 / relative, 10, [=](Dice &dice) { return depth_of(ellipsoids(dice), relative); });
        put("1/tolerance, cylinders", 1 / relative, 10, [=](Dice &dice) { return depth_of(cylinders(dice), relative); });
    }
    for (const double relative : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3})
        put("1/tolerance, ellipsoid in 4-D", 1 / relative, 1, [=](Dice &) { return solved(ellipsoid_in(4), 4, relative); });
    for (const uint32_t count : {8, 30, 100, 300, 1000, 3000, 10000, 30000, 100000})
        if (count <= largest) put("vertices of a hull", count, count > 5000 ? 2 : 5, [=](Dice &dice) { return depth_of(hulls(dice, count), 1e-6); });
    for (const uint32_t count : {8, 30, 100, 300, 1000, 3000, 10000, 30000, 100000})
        if (count <= largest) put("preparation of a hull", count, 1, [=](Dice &dice) { return preparation(dice, count); });
    for (const uint32_t n : {2, 3, 4, 5, 6}) put("dimension", n, 1, [=](Dice &) { return solved(ellipsoid_in(n), n, 1e-1); });
    for (const uint32_t count : {3, 4, 5, 6, 8}) put("contacts of a grasp", count, 3, [=](Dice &dice) { return solved(grasp(dice, count), 6, 3e-2); });
    for (const uint32_t count : {8, 32, 128, 512, 2048}) put("vertices of Q", count, 2, [=](Dice &dice) { return solved(vertices_of_q(dice, count), 3, 1e-4); });
    return all;
}

void rounds(const Line &line, int count, Used &used) {
    for (int i = 0; i < count; ++i)
        for (const Query &query : line.queries) query(used);
}

void times(const std::vector<Line> &all, int samples) {
    using Clock = std::chrono::steady_clock;
    std::printf("series,size,ns,calls,vertices,facets,bytes\n");
    for (const Line &line : all) {
        const auto queries = static_cast<double>(line.queries.size());
        Used used;
        rounds(line, 1, used);
        std::vector<double> spent;
        for (int i = 0; i < samples; ++i) {
            Used ignored;
            const auto start = Clock::now();
            rounds(line, 1, ignored);
            spent.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count() / queries);
        }
        std::nth_element(spent.begin(), spent.begin() + samples / 2, spent.end());
        std::printf("\"%s\",%g,%.1f,%.6g,%.6g,%.6g,%.8g\n", line.series.c_str(), line.size, spent[samples / 2], used.calls / queries, used.vertices / queries, used.facets / queries,
                    used.bytes / queries);
        std::fflush(stdout);
    }
}

void count(const std::vector<Line> &all) {
    std::printf("series,size,queries\n");
    for (const Line &line : all) {
        for (const int repeated : {1, 1, 3}) {  // (the first one warms up)
            Used ignored;
            CALLGRIND_ZERO_STATS;
            rounds(line, repeated, ignored);
            CALLGRIND_DUMP_STATS;
        }
        std::printf("\"%s\",%g,%zu\n", line.series.c_str(), line.size, line.queries.size());
    }
}

}  // namespace

int main(int argc, char **argv) try {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "times" && argc == 4)
        times(lines(static_cast<uint32_t>(std::atol(argv[3]))), std::atoi(argv[2]));
    else if (what == "count" && argc == 3)
        count(lines(static_cast<uint32_t>(std::atol(argv[2]))));
    else
        return 2;
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "growth: %s\n", e.what());
    return 1;
}
