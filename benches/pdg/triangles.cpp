// What people take for the depth of two triangle meshes: the largest depth of any pair of triangles that meet, timed. FCL's, or with -DCOAL coal's.
//
//     triangles IN OUT ROUNDS
//
// IN as exchange.hpp says. OUT, a line for every pose: depth (0: no contact), median ns.
#ifdef COAL
#include <coal/BVH/BVH_model.h>
#include <coal/collision.h>
namespace library = coal;
using Model = coal::BVHModel<coal::OBBRSS>;
using Vector = coal::Vec3s;
using Pose = coal::Transform3s;
using Request = coal::CollisionRequest;
using Result = coal::CollisionResult;
#else
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
namespace library = fcl;
using Model = fcl::BVHModel<fcl::OBBRSSd>;
using Vector = fcl::Vector3d;
using Pose = fcl::Transform3d;
using Request = fcl::CollisionRequestd;
using Result = fcl::CollisionResultd;
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <vector>

#include "exchange.hpp"

namespace {

constexpr std::size_t CONTACTS = 1000000;

Pose read_pose(std::istream &in) {
    Eigen::Matrix3d turn;
    Vector t;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) in >> turn(i, j);
    for (int i = 0; i < 3; ++i) in >> t[i];
#ifdef COAL
    return Pose(turn, t);
#else
    Pose pose = Pose::Identity();
    pose.linear() = turn;
    pose.translation() = t;
    return pose;
#endif
}

double deepest(const Model &a, const Pose &pose, const Model &b, const Pose &rest) {
#ifdef COAL
    const Request request(coal::CONTACT, CONTACTS);
#else
    const Request request(CONTACTS, true);
#endif
    Result result;
    library::collide(&a, pose, &b, rest, request, result);
    double depth = 0;
    for (std::size_t i = 0; i < result.numContacts(); ++i) depth = std::max(depth, std::fabs(static_cast<double>(result.getContact(i).penetration_depth)));
    return depth;
}

}  // namespace

int main(int argc, char **argv) {
    if (argc != 4) {
        std::cerr << "usage: triangles IN OUT ROUNDS\n";
        return 2;
    }
    std::ifstream in(argv[1]);
    const auto a = read_mesh<Model, Vector, library::Triangle>(in), b = read_mesh<Model, Vector, library::Triangle>(in);
    std::size_t count = 0;
    in >> count;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < count; ++i) poses.push_back(read_pose(in));
    if (!in) {
        std::cerr << argv[1] << ": it ends too early\n";
        return 1;
    }
    Pose rest;
    rest.setIdentity();
    std::ofstream out(argv[2]);
    out.precision(17);
    for (const Pose &pose : poses) {
        std::vector<double> times;
        double depth = 0;
        for (int round = 0; round < std::atoi(argv[3]); ++round) times.push_back(nanoseconds([&] { depth = deepest(*a, pose, *b, rest); }));
        out << depth << ' ' << median(times) << '\n';
    }
    return out ? 0 : 1;
}
