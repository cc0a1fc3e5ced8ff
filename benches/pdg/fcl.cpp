// FCL's boolean test and distance of two triangle meshes, timed.
//
//     pdg_fcl IN OUT ROUNDS
//
// IN as exchange.hpp says. OUT, a line for every pose: collides (0 or 1), median ns, distance, median ns. Poses are asked in
// rounds, so that no query follows itself.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <vector>

#include "exchange.hpp"

using Model = fcl::BVHModel<fcl::OBBRSSd>;

int main(int argc, char **argv) {
    if (argc != 4) {
        std::cerr << "usage: pdg_fcl IN OUT ROUNDS\n";
        return 2;
    }
    std::ifstream in(argv[1]);
    const auto a = read_mesh<Model, fcl::Vector3d, fcl::Triangle>(in), b = read_mesh<Model, fcl::Vector3d, fcl::Triangle>(in);
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
