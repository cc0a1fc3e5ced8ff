// FCL's boolean test and distance of two triangle meshes, timed.
//
//     pdg_fcl IN OUT ROUNDS
//
// IN: vertices and triangles of A (two counts, coordinates, indices), the same for B, the number of poses, and for every pose the rotation row by
// row and the translation of A in the frame of B. OUT, a line for every pose: collides (0 or 1), median ns, distance, median ns. Poses are asked in
// rounds, so that no query follows itself.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Clock = std::chrono::steady_clock;

namespace {

std::shared_ptr<Model> read_mesh(std::istream &in) {
    std::size_t vertices = 0, triangles = 0;
    in >> vertices >> triangles;
    std::vector<fcl::Vector3d> points(vertices);
    for (auto &p : points) in >> p[0] >> p[1] >> p[2];
    std::vector<fcl::Triangle> faces;
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

double median(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return times.empty() ? 0 : times[times.size() / 2];
}

template <class Ask>
double nanoseconds(Ask ask) {
    const auto begin = Clock::now();
    ask();
    return std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
}

}  // namespace

int main(int argc, char **argv) {
    if (argc != 4) {
        std::cerr << "usage: pdg_fcl IN OUT ROUNDS\n";
        return 2;
    }
    std::ifstream in(argv[1]);
    const auto a = read_mesh(in), b = read_mesh(in);
    std::size_t count = 0;
    in >> count;
    std::vector<fcl::Transform3d> poses(count, fcl::Transform3d::Identity());
    for (auto &pose : poses) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) in >> pose.linear()(i, j);
        for (int i = 0; i < 3; ++i) in >> pose.translation()[i];
    }
    if (!in) {
        std::cerr << argv[1] << ": it ends too early\n";
        return 1;
    }
    const int rounds = std::atoi(argv[3]);
    const auto rest = fcl::Transform3d::Identity();
    std::vector<std::vector<double>> collision_times(count), distance_times(count);
    std::vector<char> collides(count);
    std::vector<double> distances(count);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < count; ++i) {
            collision_times[i].push_back(nanoseconds([&] {
                fcl::CollisionRequestd request;
                fcl::CollisionResultd result;
                collides[i] = fcl::collide(a.get(), poses[i], b.get(), rest, request, result) > 0;
            }));
        }
    }
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < count; ++i) {
            distance_times[i].push_back(nanoseconds([&] {
                fcl::DistanceRequestd request;
                fcl::DistanceResultd result;
                distances[i] = fcl::distance(a.get(), poses[i], b.get(), rest, request, result);
            }));
        }
    }
    std::ofstream out(argv[2]);
    out.precision(17);
    for (std::size_t i = 0; i < count; ++i) {
        out << int(collides[i]) << ' ' << median(collision_times[i]) << ' ' << distances[i] << ' ' << median(distance_times[i])
            << '\n';
    }
    return out ? 0 : 1;
}
