// A stiff contact in a loop: a mass and walls, a spring between them for every depth, and a solver that says depth and normal.
//
//     stiff scenes                                   their names
//     stiff run SCENE HZ SECONDS SOLVER:TOLERANCE    lines `energy,TIME,SHARE` and one line `sum,...` (see `Sums`); the solver `exact` is the closed form
//
// The force of a wall on the mass is STIFFNESS * depth * normal. The integrator is semi-implicit: velocity first, then position with the new velocity. With the exact
// depth this is a conservative system, and what the integrator conserves within a contact is not the energy but, to the last bit of a linear spring,
//
//     m v^2 / 2 + sum k d^2 / 2 + m g z - (h |F|)^2 / (8 m),    v the mean of the velocities before and behind the tick's force:
//
// this is called the energy here. It still changes where a contact begins or ends between two ticks: that is the integrator's, and the run with the exact depth has it, too.
// Depth in the energy is always the exact one at the place where the solver has led the mass to. The mass does not turn.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "solvers.hpp"

namespace {

using Vec = std::array<double, 3>;

Vec operator+(const Vec &a, const Vec &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec operator-(const Vec &a, const Vec &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec operator*(double s, const Vec &a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Vec &a) { return std::sqrt(dot(a, a)); }

constexpr double MASS = 0.5;        // kg
constexpr double STIFFNESS = 1e5;   // N/m
constexpr double GRAVITY = 9.81;    // m/s^2
constexpr double NEAR = 1e-4;       // m: bodies that are farther apart are not asked for, as any program would do
constexpr double TOUCH = 1e-9;      // m: no answer for less than this is no fault

struct Contact {
    double depth = 0;
    Vec normal{};  // from the wall to the mass
};

struct Wall {
    Shape shape;
    std::function<Contact(const Shape &mass)> exact;
};

struct Scene {
    const char *name;
    Shape mass;
    std::vector<Wall> walls;
    double gravity = 0;
    Vec velocity{};
    // Where the mass is led along a path, and no force moves it: its place after so many meters.
    std::function<Vec(double way)> path;
    double speed = 0;
};

constexpr std::array<double, 9> IDENTITY = {1, 0, 0, 0, 1, 0, 0, 0, 1};

// A turn about x, then one about y.
std::array<double, 9> turned(double x, double y) {
    const double cx = std::cos(x), sx = std::sin(x), cy = std::cos(y), sy = std::sin(y);
    return {cy, sy * sx, sy * cx, 0, cx, -sx, -sy, cy * sx, cy * cx};
}

Shape shape(Kind kind, std::vector<double> params, const Vec &at = {}, const std::array<double, 9> &rotation = IDENTITY) {
    return {kind, std::move(params), {}, rotation, at};
}

// The support function of a body about its own origin.
double reach(const Shape &s, const Vec &u) {
    Vec w;
    for (int j = 0; j < 3; ++j) w[j] = s.rotation[j] * u[0] + s.rotation[3 + j] * u[1] + s.rotation[6 + j] * u[2];
    const std::vector<double> &p = s.params;
    switch (s.kind) {
        case Kind::sphere: return p[0] * norm(w);
        case Kind::box: return p[0] * std::abs(w[0]) + p[1] * std::abs(w[1]) + p[2] * std::abs(w[2]);
        case Kind::ellipsoid: return norm({p[0] * w[0], p[1] * w[1], p[2] * w[2]});
        case Kind::cylinder: return p[0] * std::hypot(w[0], w[1]) + p[1] * std::abs(w[2]);
        default: throw std::runtime_error("no formula");
    }
}

// A box whose face towards `normal` is what is met: its other faces are far. The depth is how far the mass is below the face.
Wall face(const Vec &normal, double offset, const Vec &half) {
    const Vec center = (offset - std::abs(dot(normal, half))) * normal;
    return {shape(Kind::box, {half[0], half[1], half[2]}, center), [=](const Shape &mass) {
                return Contact{offset + reach(mass, -1 * normal) - dot(normal, mass.translation), normal};
            }};
}

// A box with an edge along y through the origin (it is at x < 0, z < 0), met by a cylinder along y that is shorter than it, and whose axis is outside: a disk and a corner.
Wall edge(double half) {
    return {shape(Kind::box, {half, half, half}, {-half, 0, -half}), [](const Shape &mass) {
                const Vec &c = mass.translation;
                const Vec away = {std::max(c[0], 0.0), 0, std::max(c[2], 0.0)};
                return Contact{mass.params[0] - norm(away), 1 / norm(away) * away};
            }};
}

Scene dropped(const char *name, Shape mass) {
    constexpr double HEIGHT = 0.02;
    mass.translation = {0, 0, reach(mass, {0, 0, -1}) + HEIGHT};
    return {name, mass, {face({0, 0, 1}, 0, {0.5, 0.5, 0.25})}, GRAVITY, {}, nullptr, 0};
}

// A box on the floor with ten times its weight on it, half as deep as it would rest, that slides.
Scene pressed() {
    const double force = 10 * GRAVITY;
    const Shape mass = shape(Kind::box, {0.02, 0.03, 0.02}, {0, 0, 0.02 - 0.5 * MASS * force / STIFFNESS});
    return {"box pressed flat", mass, {face({0, 0, 1}, 0, {0.5, 0.5, 0.25})}, force, {0.1, 0.02, 0}, nullptr, 0};
}

// A peg within four walls, thrown against them while it is let down.
Scene peg(const char *name, Shape mass) {
    constexpr double CLEARANCE = 2e-4;
    const double width = 0.01 + CLEARANCE;
    mass.translation = {0, 0, 0.025};
    const Vec thick_x = {0.02, 0.1, 0.1}, thick_y = {0.1, 0.02, 0.1};
    return {name, mass, {face({1, 0, 0}, -width, thick_x), face({-1, 0, 0}, -width, thick_x), face({0, 1, 0}, -width, thick_y), face({0, -1, 0}, -width, thick_y)},
            0, {0.16, 0.12, -0.05}, nullptr, 0};
}

// A peg that lies along an edge is led over it, always 0.5 mm deep: along the face, around the corner, down the other face.
Scene over_edge() {
    constexpr double RADIUS = 0.01, DEEP = 5e-4, STRAIGHT = 0.01, SPEED = 0.05, QUARTER = 1.5707963267948966;
    constexpr double ARM = RADIUS - DEEP;
    const auto path = [](double way) -> Vec {
        if (way < STRAIGHT) return {way - STRAIGHT, 0, ARM};
        const double angle = (way - STRAIGHT) / ARM;
        if (angle < QUARTER) return {ARM * std::sin(angle), 0, ARM * std::cos(angle)};
        return {ARM, 0, -ARM * (angle - QUARTER)};
    };
    const std::array<double, 9> along_y = {1, 0, 0, 0, 0, 1, 0, -1, 0};
    return {"peg over an edge", shape(Kind::cylinder, {RADIUS, 0.02}, {}, along_y), {edge(0.1)}, 0, {}, path, SPEED};
}

std::vector<Scene> scenes() {
    return {
        dropped("sphere dropped", shape(Kind::sphere, {0.02})),
        dropped("box dropped", shape(Kind::box, {0.02, 0.03, 0.04}, {}, turned(0.5, 0.4))),
        dropped("cylinder dropped", shape(Kind::cylinder, {0.02, 0.03}, {}, turned(0.5, 0.4))),
        dropped("ellipsoid dropped", shape(Kind::ellipsoid, {0.02, 0.03, 0.04}, {}, turned(0.5, 0.4))),
        pressed(),
        peg("round peg in a hole", shape(Kind::cylinder, {0.01, 0.03}, {}, turned(0.003, 0.002))),
        peg("square peg in a hole", shape(Kind::box, {0.01, 0.01, 0.03})),
        over_edge(),
    };
}

// What a solver has to say; `nullptr` asks for the closed form. Not finite: it says nothing.
Contact asked(const Solver *solver, double tolerance, const Wall &wall, const Shape &mass) {
    if (solver == nullptr) return wall.exact(mass);
    const Case c = {"", wall.shape, mass, 0.05};
    Answer answer;
    try {
        solver->make(c, tolerance)->run(answer);
    } catch (const std::exception &) {
        return {NAN, {NAN, NAN, NAN}};
    }
    return {answer.depth, {answer.normal[0], answer.normal[1], answer.normal[2]}};
}

bool finite(const Contact &c) { return std::isfinite(c.depth) && std::isfinite(dot(c.normal, c.normal)); }

// What is summed up over a run. Jumps are from tick to tick, beyond what the exact answer jumps by; lengths in m, normals as lengths of differences.
struct Sums {
    long touching = 0, silent = 0;
    double depth_error = 0, depth_jump = 0, normal_error = 0, normal_jump = 0, motion = 0;

    void add(const Contact &said, const Contact &exact, double way) {
        ++touching;
        motion += way;
        if (!finite(said) || said.depth < 0) {
            silent += exact.depth > TOUCH;
            return;
        }
        depth_error = std::max(depth_error, std::abs(said.depth - exact.depth));
        normal_error = std::max(normal_error, norm(said.normal - exact.normal));
    }
    void jump(const Contact &said, const Contact &exact, const Contact &said_before, const Contact &exact_before) {
        depth_jump = std::max(depth_jump, std::abs((said.depth - said_before.depth) - (exact.depth - exact_before.depth)));
        normal_jump = std::max(normal_jump, norm((said.normal - said_before.normal) - (exact.normal - exact_before.normal)));
    }
};

// A solver that is silent has no depth to push with.
void counted(Sums &sums, const Contact &said, const Contact &exact, std::array<Contact, 2> &before, double way) {
    if (exact.depth > 0) {
        sums.add(said, exact, way);
        if (before[1].depth > 0 && finite(said) && finite(before[0])) sums.jump(said, exact, before[0], before[1]);
    }
    before = {said, exact};
}

void run(Scene scene, double hz, double seconds, const Solver *solver, double tolerance) {
    const double h = 1 / hz;
    const auto ticks = static_cast<long>(seconds * hz);
    const long every = std::max(1L, ticks / 400);
    std::vector<std::array<Contact, 2>> before(scene.walls.size());
    Sums sums;
    Vec &x = scene.mass.translation, v = scene.velocity;
    double first = NAN, most = 0;
    for (long tick = 0; tick < ticks; ++tick) {
        if (scene.path) x = scene.path(scene.speed * h * static_cast<double>(tick));
        const double way = scene.path ? scene.speed * h : norm(v) * h;
        Vec force = {0, 0, -MASS * scene.gravity}, exact_force = force;
        double energy = MASS * scene.gravity * x[2];
        for (std::size_t i = 0; i < scene.walls.size(); ++i) {
            const Contact exact = scene.walls[i].exact(scene.mass);
            const Contact said = exact.depth > -NEAR ? asked(solver, tolerance, scene.walls[i], scene.mass) : Contact{};
            if (finite(said) && said.depth > 0) force = force + STIFFNESS * said.depth * said.normal;
            if (exact.depth > 0) {
                exact_force = exact_force + STIFFNESS * exact.depth * exact.normal;
                energy += STIFFNESS * exact.depth * exact.depth / 2;
            }
            counted(sums, said, exact, before[i], way);
        }
        if (scene.path) continue;
        const Vec behind = v + h / MASS * force, mean = 0.5 * (v + behind);
        const Vec beyond = h * exact_force, weight = {0, 0, -h * MASS * scene.gravity};
        energy += MASS * dot(mean, mean) / 2 - (dot(beyond, beyond) - dot(weight, weight)) / (8 * MASS);
        if (tick == 0) first = energy;
        most = std::max(most, std::abs(energy / first - 1));
        if (tick % every == 0) std::printf("energy,%.6g,%.17g\n", static_cast<double>(tick) * h, energy / first);
        v = behind;
        x = x + h * v;
    }
    const double motion = sums.touching > 0 ? sums.motion / static_cast<double>(sums.touching) : NAN;
    std::printf("sum,%ld,%ld,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", sums.touching, sums.silent, scene.path ? NAN : most, sums.depth_error, sums.depth_jump, sums.normal_error,
                sums.normal_jump, motion);
}

}  // namespace

int main(int argc, char **argv) try {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "scenes")
        for (const Scene &scene : scenes()) std::printf("%s\n", scene.name);
    if (what == "solvers")
        for (const Solver &solver : SOLVERS) std::printf("%s\n", solver.name);
    if (what != "run" || argc != 6) return what == "scenes" || what == "solvers" ? 0 : 2;
    const std::string text = argv[5], name = text.substr(0, text.rfind(':'));
    const Solver *solver = nullptr;
    for (const Solver &s : SOLVERS)
        if (name == s.name) solver = &s;
    if (solver == nullptr && name != "exact") throw std::runtime_error("no solver " + name);
    for (const Scene &scene : scenes())
        if (scene.name == std::string(argv[2])) run(scene, std::atof(argv[3]), std::atof(argv[4]), solver, std::atof(text.c_str() + text.rfind(':') + 1));
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "stiff: %s\n", e.what());
    return 1;
}
