#include "peers.hpp"

#include <ccd/ccd.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace {

void set_answer(Answer &answer, double depth, double nx, double ny, double nz) {
    answer.set_outcome(std::isfinite(depth) ? "ok" : "nan");
    answer.depth = depth;
    answer.normal[0] = nx;
    answer.normal[1] = ny;
    answer.normal[2] = nz;
}

// ---------------------------------------------------------------------------------------------------- libccd shapes

// Hulls with more vertices are searched by walking over edges. FCL switches at the same number.
constexpr std::size_t LINEAR_SCAN_MAX = 32;

struct CcdShape {
    std::array<double, 9> rotation;
    std::array<double, 3> translation;
    double p[3] = {0, 0, 0};
    double centre[3] = {0, 0, 0};  // world, inside the shape: where MPR starts
    std::vector<double> vertices;
    std::vector<int> first, adjacent;  // the neighbours of vertex i are adjacent[first[i]] .. adjacent[first[i + 1] - 1]
    // The walk starts where the last one ended. It is what a user would do; directions of one query are close.
    mutable int last = 0;
};

// The functions below get and return vectors in the shape's own frame.

struct SphereSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        const double scale = length > 0 ? s.p[0] / length : 0;
        for (int i = 0; i < 3; ++i) out[i] = scale * d[i];
    }
};

struct BoxSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        for (int i = 0; i < 3; ++i) out[i] = std::copysign(s.p[i], d[i]);
    }
};

struct EllipsoidSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        const double e[3] = {s.p[0] * d[0], s.p[1] * d[1], s.p[2] * d[2]};
        const double length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        const double scale = length > 0 ? 1 / length : 0;
        for (int i = 0; i < 3; ++i) out[i] = scale * s.p[i] * e[i];
    }
};

struct CylinderSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        const double radial = std::sqrt(d[0] * d[0] + d[1] * d[1]);
        const double scale = radial > 0 ? s.p[0] / radial : 0;
        out[0] = scale * d[0];
        out[1] = scale * d[1];
        out[2] = std::copysign(s.p[1], d[2]);
    }
};

struct CapsuleSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        SphereSupport::at(s, d, out);
        out[2] += std::copysign(s.p[1], d[2]);
    }
};

struct ConeSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        const double radial = std::sqrt(d[0] * d[0] + d[1] * d[1]);
        const double height = s.p[1] * d[2];
        if (height > s.p[0] * radial - height) {  // apex against rim
            out[0] = out[1] = 0;
            out[2] = s.p[1];
        } else {
            const double scale = radial > 0 ? s.p[0] / radial : 0;
            out[0] = scale * d[0];
            out[1] = scale * d[1];
            out[2] = -s.p[1];
        }
    }
};

double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct ScanSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        const double *best = s.vertices.data();
        double best_value = dot(best, d);
        for (const double *v = best + 3, *end = best + s.vertices.size(); v != end; v += 3) {
            const double value = dot(v, d);
            if (value > best_value) {
                best_value = value;
                best = v;
            }
        }
        std::copy(best, best + 3, out);
    }
};

struct WalkSupport {
    static void at(const CcdShape &s, const double *d, double *out) {
        int best = s.last;
        double best_value = dot(&s.vertices[3 * best], d);
        for (int from = -1; from != best;) {  // strictly upwards, so it ends
            from = best;
            for (int k = s.first[from]; k < s.first[from + 1]; ++k) {
                const double value = dot(&s.vertices[3 * s.adjacent[k]], d);
                if (value > best_value) {
                    best_value = value;
                    best = s.adjacent[k];
                }
            }
        }
        s.last = best;
        std::copy(&s.vertices[3 * best], &s.vertices[3 * best] + 3, out);
    }
};

template <class Local>
void ccd_support(const void *object, const ccd_vec3_t *direction, ccd_vec3_t *point) {
    const auto &s = *static_cast<const CcdShape *>(object);
    const double *r = s.rotation.data(), *w = direction->v;
    const double d[3] = {r[0] * w[0] + r[3] * w[1] + r[6] * w[2], r[1] * w[0] + r[4] * w[1] + r[7] * w[2],
                         r[2] * w[0] + r[5] * w[1] + r[8] * w[2]};
    double x[3];
    Local::at(s, d, x);
    for (int i = 0; i < 3; ++i) point->v[i] = dot(r + 3 * i, x) + s.translation[i];
}

void ccd_centre(const void *object, ccd_vec3_t *centre) {
    const auto &s = *static_cast<const CcdShape *>(object);
    for (int i = 0; i < 3; ++i) centre->v[i] = s.centre[i];
}

void prepare_walk(CcdShape &s, const Shape &shape) {
    const HullMesh mesh = hull_mesh(shape.vertices);
    s.vertices = mesh.vertices;
    s.first.push_back(0);
    for (const auto &around : mesh.neighbours()) {
        s.adjacent.insert(s.adjacent.end(), around.begin(), around.end());
        s.first.push_back(static_cast<int>(s.adjacent.size()));
    }
}

ccd_support_fn prepare(CcdShape &s, const Shape &shape) {
    s.rotation = shape.rotation;
    s.translation = shape.translation;
    std::copy(shape.params.begin(), shape.params.end(), s.p);
    double mean[3] = {0, 0, 0};  // the other shapes have their centre at 0
    const std::size_t count = shape.vertices.size() / 3;
    for (std::size_t i = 0; i < shape.vertices.size(); ++i) mean[i % 3] += shape.vertices[i] / static_cast<double>(count);
    for (int i = 0; i < 3; ++i) s.centre[i] = dot(&s.rotation[3 * i], mean) + s.translation[i];

    switch (shape.kind) {
        case Kind::sphere: return ccd_support<SphereSupport>;
        case Kind::box: return ccd_support<BoxSupport>;
        case Kind::ellipsoid: return ccd_support<EllipsoidSupport>;
        case Kind::cylinder: return ccd_support<CylinderSupport>;
        case Kind::capsule: return ccd_support<CapsuleSupport>;
        case Kind::cone: return ccd_support<ConeSupport>;
        case Kind::hull: break;
    }
    if (count > LINEAR_SCAN_MAX) {
        prepare_walk(s, shape);
        return ccd_support<WalkSupport>;
    }
    s.vertices = shape.vertices;
    return ccd_support<ScanSupport>;
}

using CcdPenetration = int (*)(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);

template <CcdPenetration penetration, int (*intersect)(const void *, const void *, const ccd_t *)>
class LibccdQuery final : public Query {
public:
    LibccdQuery(const Case &c, double tolerance) {
        // Defaults of CCD_INIT in libccd 2.1: first_dir = ccdFirstDirDefault, epa_tolerance = mpr_tolerance = 1e-4,
        // dist_tolerance = 1e-6 (not used by these two functions). max_iterations would be "without end"; 100 is what
        // all the examples in its documentation set.
        CCD_INIT(&ccd_);
        ccd_.max_iterations = 100;
        if (tolerance > 0) ccd_.epa_tolerance = ccd_.mpr_tolerance = tolerance;
        ccd_.support1 = prepare(a_, c.a);
        ccd_.support2 = prepare(b_, c.b);
        ccd_.center1 = ccd_centre;
        ccd_.center2 = ccd_centre;
    }

    void run(Answer &answer) override {
        ccd_real_t depth;
        ccd_vec3_t direction, position;
        if (only_overlap_) {
            const bool yes = intersect(&a_, &b_, &ccd_) != 0;
            answer.set_outcome(yes ? "ok" : "no_collision");
            if (yes) answer.depth = 1;
            return;
        }
        const int code = penetration(&a_, &b_, &ccd_, &depth, &direction, &position);
        if (code == 0)  // libccd: "if obj2 is translated by depth in direction dir, objects will have touching contact"
            set_answer(answer, depth, direction.v[0], direction.v[1], direction.v[2]);
        else if (code == -1)
            answer.set_outcome("no_collision");
        else
            answer.set_outcome("exception");  // -2: out of memory
    }

    bool only_overlap() override { return only_overlap_ = true; }

private:
    bool only_overlap_ = false;
    ccd_t ccd_;
    CcdShape a_, b_;
};

// ------------------------------------------------------------------------------------------------------------- FCL

std::unique_ptr<fcl::CollisionGeometryd> fcl_convex(const Shape &shape) {
    const HullMesh mesh = hull_mesh(shape.vertices);
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 3)
        vertices->emplace_back(mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]);
    auto faces = std::make_shared<std::vector<int>>();
    for (const auto &t : mesh.triangles) faces->insert(faces->end(), {3, t[0], t[1], t[2]});
    return std::make_unique<fcl::Convexd>(vertices, static_cast<int>(mesh.triangles.size()), faces);
}

// FCL takes full lengths. Its cone has the same layout as ours: axis z, apex at +z, origin at half height.
std::unique_ptr<fcl::CollisionGeometryd> fcl_geometry(const Shape &shape) {
    const std::vector<double> &p = shape.params;
    switch (shape.kind) {
        case Kind::sphere: return std::make_unique<fcl::Sphered>(p[0]);
        case Kind::box: return std::make_unique<fcl::Boxd>(2 * p[0], 2 * p[1], 2 * p[2]);
        case Kind::ellipsoid: return std::make_unique<fcl::Ellipsoidd>(p[0], p[1], p[2]);
        case Kind::cylinder: return std::make_unique<fcl::Cylinderd>(p[0], 2 * p[1]);
        case Kind::capsule: return std::make_unique<fcl::Capsuled>(p[0], 2 * p[1]);
        case Kind::cone: return std::make_unique<fcl::Coned>(p[0], 2 * p[1]);
        case Kind::hull: break;
    }
    return fcl_convex(shape);
}

fcl::Transform3d fcl_pose(const Shape &shape) {
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    pose.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.rotation.data());
    pose.translation() = Eigen::Map<const fcl::Vector3d>(shape.translation.data());
    return pose;
}

class FclQuery : public Query {
protected:
    explicit FclQuery(const Case &c)
        : a_(fcl_geometry(c.a)), b_(fcl_geometry(c.b)), pose_a_(fcl_pose(c.a)), pose_b_(fcl_pose(c.b)) {}

    std::unique_ptr<fcl::CollisionGeometryd> a_, b_;
    fcl::Transform3d pose_a_, pose_b_;
};

class FclCollide final : public FclQuery {
public:
    // Defaults but for the contacts: one contact, gjk_tolerance 1e-6. With GST_LIBCCD this is libccd's MPR, except for
    // box-box and pairs with a sphere, which have their own code.
    FclCollide(const Case &c, double tolerance) : FclQuery(c) {
        request_.num_max_contacts = 1;
        request_.enable_contact = true;
        request_.gjk_solver_type = fcl::GST_LIBCCD;
        if (tolerance > 0) request_.gjk_tolerance = tolerance;
    }

    void run(Answer &answer) override {
        fcl::CollisionResultd result;
        fcl::collide(a_.get(), pose_a_, b_.get(), pose_b_, request_, result);
        if (!result.isCollision()) {
            answer.set_outcome("no_collision");
            return;
        }
        if (!request_.enable_contact) {
            answer.set_outcome("ok");
            answer.depth = 1;
            return;
        }
        const fcl::Contactd &contact = result.getContact(0);  // normal: from object 1 to object 2
        set_answer(answer, contact.penetration_depth, contact.normal[0], contact.normal[1], contact.normal[2]);
    }

    bool only_overlap() override {
        request_.enable_contact = false;
        return true;
    }

private:
    fcl::CollisionRequestd request_;
};

class FclSigned final : public FclQuery {
public:
    FclSigned(const Case &c, double tolerance) : FclQuery(c), rounding_(1e-12 * c.size) {
        request_.enable_nearest_points = true;  // the normal comes from them
        request_.enable_signed_distance = true;
        request_.distance_tolerance = tolerance > 0 ? tolerance : 1e-6;  // FCL's default
        request_.gjk_solver_type = fcl::GST_LIBCCD;
    }

    void run(Answer &answer) override {
        fcl::DistanceResultd result;
        fcl::distance(a_.get(), pose_a_, b_.get(), pose_b_, request_, result);
        // FCL gives no normal. Point of A minus point of B is depth * normal, apart and overlapping alike. A gap that
        // is rounding error has no direction; none is better than one that FCL has never claimed.
        const double depth = -result.min_distance;
        const fcl::Vector3d gap = result.nearest_points[0] - result.nearest_points[1];
        const double length = gap.norm();
        const fcl::Vector3d normal = gap / (length <= rounding_ ? NAN : std::copysign(length, depth));
        set_answer(answer, depth, normal[0], normal[1], normal[2]);
    }

private:
    fcl::DistanceRequestd request_;
    double rounding_;
};

}  // namespace

std::unique_ptr<Query> make_libccd_epa(const Case &c, double tolerance) {
    return std::make_unique<LibccdQuery<ccdGJKPenetration, ccdGJKIntersect>>(c, tolerance);
}
std::unique_ptr<Query> make_libccd_mpr(const Case &c, double tolerance) {
    return std::make_unique<LibccdQuery<ccdMPRPenetration, ccdMPRIntersect>>(c, tolerance);
}
std::unique_ptr<Query> make_fcl_libccd(const Case &c, double tolerance) { return std::make_unique<FclCollide>(c, tolerance); }
std::unique_ptr<Query> make_fcl_signed(const Case &c, double tolerance) { return std::make_unique<FclSigned>(c, tolerance); }
