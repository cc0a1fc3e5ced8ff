// The C++ wrapper, in both scalar types.
#include "qdist.hpp"
#include "test.h"

#include <cmath>

template <class T, class Box, class Sphere, class Points, class HalfSpace>
static void smoke() {
    static qdist::Solver<T, 3, 64, 128> solver;
    const Box box{{1, 2, 3}};
    const Sphere ball{T(0.5)};
    const auto a = qdist::body(box);
    auto b = qdist::body(ball);
    CHECK(a && b);
    b.translation[0] = T(1.25);
    const auto depth = qdist::depth(solver, a, b);
    CHECK(depth && depth.outcome == QDIST_CONVERGED && depth.lower <= T(0.25) && T(0.25) <= depth.upper);

    auto options = qdist::options<T>();
    options.use_threshold = 1;
    options.threshold = 1;
    CHECK(qdist::depth(solver, a, b, &options).outcome == QDIST_BELOW);

    auto copy = solver;  // a solver is plain memory
    CHECK(qdist::depth(copy, a, b).status == QDIST_OK);

    const Sphere wrong{T(-1)};
    const auto bad = qdist::body(wrong);
    CHECK(bad.status == QDIST_ERROR_ARGUMENT && qdist::depth(solver, a, bad).status == QDIST_ERROR_NULL);

    // A square, two units wide, by its corners.
    static qdist::Solver<T, 2, 16, 32> plane;
    const T corners[] = {1, 1, -1, 1, -1, -1, 1, -1};
    const Points list{corners, 4, 2};
    const auto square = qdist::set(list);
    CHECK(square.status == QDIST_OK);
    const auto answer = qdist::solve(plane, square);
    CHECK(answer && answer.lower <= 1 && 1 <= answer.upper && answer.upper - answer.lower < T(1e-3));

    // Two of them side by side, and a ball on the ground.
    const auto left = qdist::body2(list);
    auto right = left;
    right.translation[0] = T(1.75);
    const auto side = qdist::depth(plane, left, right);
    CHECK(side && side.outcome == QDIST_CONVERGED && side.lower <= T(0.25) && T(0.25) <= side.upper && side.normal[0] == 1);
    const HalfSpace floor{{0, 0, 1}, 0};
    const auto ground = qdist::body(floor);
    b.translation[2] = T(0.25);
    const auto contact = qdist::depth(solver, b, ground);
    CHECK(contact && contact.lower <= T(0.25) && T(0.25) <= contact.upper && contact.normal[2] == -1);
}

int main() {
    smoke<double, qdist_box_f64, qdist_sphere_f64, qdist_points_f64, qdist_half_space_f64>();
    smoke<float, qdist_box_f32, qdist_sphere_f32, qdist_points_f32, qdist_half_space_f32>();
    return finish("smoke_cpp");
}
