// What the bench of meshes gives to other libraries, and how they are timed.
//
// IN: vertices and triangles of A (two counts, coordinates, indices), the same for B, the number of poses, and for every pose the rotation row by
// row and the translation of A in the frame of B.
#pragma once

#include <algorithm>
#include <chrono>
#include <istream>
#include <memory>
#include <vector>

template <class Model, class Vector, class Triangle>
std::shared_ptr<Model> read_mesh(std::istream &in) {
    std::size_t vertices = 0, triangles = 0;
    in >> vertices >> triangles;
    std::vector<Vector> points(vertices);
    for (auto &p : points) in >> p[0] >> p[1] >> p[2];
    std::vector<Triangle> faces;
    for (std::size_t i = 0; i < triangles; ++i) {
        std::size_t a = 0, b = 0, c = 0;
        in >> a >> b >> c;
        faces.emplace_back(a, b, c);
    }
    auto model = std::make_shared<Model>();
    model->beginModel();
    model->addSubModel(points, faces);
    model->endModel();
    return model;
}

inline double median(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times.empty() ? 0 : times[times.size() / 2];
}

template <class Ask>
double nanoseconds(Ask ask) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    ask();
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}
