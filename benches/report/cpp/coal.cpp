// coal (PyPI's libcoal) behind the interface of its peers: `coal::ComputeCollision`, the prepared form of `coal::collide`, with one contact.
//
// A tolerance is given to GJK and EPA alike. It is a length, and coal advises against less than 1e-6: below 1e-8 some ellipsoids and cylinders get no depth or a wrong
// one, whatever the iterations. Boxes and cylinders are made longer by 1e-10 of themselves, on purpose (`inflate` in its support functions), and their depths are off by
// that.
#include "solvers.hpp"

#include <cstdlib>
#include <limits>

#include <coal/collision.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

namespace {

// coal and FCL bring an octomap each, of two versions. At the end of the program both take the same static objects down. So nobody does.
const int LEAVES_AT_ONCE = on_exit(
    [](int status, void *) {
        std::fflush(nullptr);
        std::_Exit(status);
    },
    nullptr);

std::unique_ptr<coal::CollisionGeometry> convex(const Shape &shape) {
    const HullMesh mesh = hull_mesh(shape.vertices);
    auto points = std::make_shared<std::vector<coal::Vec3s>>();
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 3)
        points->emplace_back(mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]);
    auto triangles = std::make_shared<std::vector<coal::Triangle>>();
    for (const auto &t : mesh.triangles)
        triangles->emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2]));
    const auto count = static_cast<unsigned>(points->size()), faces = static_cast<unsigned>(triangles->size());
    return std::make_unique<coal::Convex<coal::Triangle>>(points, count, triangles, faces);
}

// coal takes full lengths. Its cone is ours: axis z, apex at +z, origin at half height.
std::unique_ptr<coal::CollisionGeometry> geometry(const Shape &shape) {
    const std::vector<double> &p = shape.params;
    switch (shape.kind) {
        case Kind::sphere: return std::make_unique<coal::Sphere>(p[0]);
        case Kind::box: return std::make_unique<coal::Box>(2 * p[0], 2 * p[1], 2 * p[2]);
        case Kind::ellipsoid: return std::make_unique<coal::Ellipsoid>(p[0], p[1], p[2]);
        case Kind::cylinder: return std::make_unique<coal::Cylinder>(p[0], 2 * p[1]);
        case Kind::capsule: return std::make_unique<coal::Capsule>(p[0], 2 * p[1]);
        case Kind::cone: return std::make_unique<coal::Cone>(p[0], 2 * p[1]);
        case Kind::hull: break;
    }
    return convex(shape);
}

coal::Transform3s pose(const Shape &shape) {
    const coal::Matrix3s rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.rotation.data());
    return {rotation, Eigen::Map<const coal::Vec3s>(shape.translation.data())};
}

class CoalQuery final : public Query {
public:
    CoalQuery(const Case &c, double tolerance)
        : a_(geometry(c.a)), b_(geometry(c.b)), pose_a_(pose(c.a)), pose_b_(pose(c.b)), collide_(a_.get(), b_.get()) {
        request_.num_max_contacts = 1;
        request_.enable_contact = true;
        // Bodies that are apart are told about, too: with their distance, which is computed in any case.
        request_.security_margin = std::numeric_limits<double>::max();
        if (!(tolerance > 0)) return;
        request_.gjk_tolerance = request_.epa_tolerance = tolerance;
        request_.gjk_max_iterations = MOST_ITERATIONS;
        request_.epa_max_iterations = enough_iterations();
    }

    void run(Answer &answer) override {
        result_.clear();
        collide_(pose_a_, pose_b_, request_, result_);
        if (!result_.isCollision()) {
            answer.set_outcome("no_collision");
            return;
        }
        if (!request_.enable_contact) {
            answer.set_outcome("ok");
            answer.depth = 1;
            return;
        }
        const coal::Contact &contact = result_.getContact(0);  // the normal is one from A to B; the depth is a signed distance
        const double depth = -contact.penetration_depth;
        if (depth == std::numeric_limits<double>::max()) {  // how coal says that EPA has failed
            answer.set_outcome("fail");
            return;
        }
        answer.set_outcome(std::isfinite(depth) ? "ok" : "nan");
        answer.depth = depth;
        for (int i = 0; i < 3; ++i) answer.normal[i] = contact.normal[i];
    }

    bool only_overlap() override {
        request_.enable_contact = false;
        request_.security_margin = 0;
        return true;
    }

private:
    static constexpr std::size_t MOST_ITERATIONS = 1024;

    // A query of coal prepares memory for all the iterations of EPA that it may make (34 instructions each: 1024 are three times a pair of boxes). The fewest that give
    // the answer of the most are what this pair takes; coal's default is 64.
    std::size_t enough_iterations() const {
        const double wanted = depth_after(MOST_ITERATIONS);
        std::size_t iterations = coal::EPA_DEFAULT_MAX_ITERATIONS;
        while (iterations < MOST_ITERATIONS && depth_after(iterations) != wanted) iterations *= 2;
        return iterations;
    }

    double depth_after(std::size_t iterations) const {
        coal::CollisionRequest request = request_;
        request.epa_max_iterations = iterations;
        coal::CollisionResult result;
        coal::ComputeCollision(a_.get(), b_.get())(pose_a_, pose_b_, request, result);
        return result.isCollision() ? result.getContact(0).penetration_depth : 0;
    }

    std::unique_ptr<coal::CollisionGeometry> a_, b_;
    coal::Transform3s pose_a_, pose_b_;
    coal::CollisionRequest request_;
    coal::CollisionResult result_;
    coal::ComputeCollision collide_;
};

}  // namespace

std::unique_ptr<Query> make_coal(const Case &c, double tolerance) { return std::make_unique<CoalQuery>(c, tolerance); }
