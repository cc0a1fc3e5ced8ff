// qdist behind the interface of its peers.
#include "peers.hpp"

#include <algorithm>
#include <cctype>

#include "qdist.h"

namespace {

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
    QdistQuery(const Case &c, double tolerance) {
        alignas(QDIST_WORKSPACE_ALIGN) static unsigned char memory[Q::bytes];
        Q::options_default(&options_);
        options_.relative = static_cast<typename Q::Real>(tolerance > 0 ? tolerance : Q::relative);
        options_.absolute = static_cast<typename Q::Real>(tolerance > 0 ? 0 : Q::absolute * c.size);
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
        answer.calls = result.support_calls;
        answer.vertices = result.vertices_used;
        answer.facets = result.facets_used;
    }

    // Which is the case as soon as d >= 0 or d < 0 is certain.
    bool only_overlap() override {
        options_.use_threshold = 1;
        options_.threshold = 0;
        return true;
    }

    bool guess(const double *normal) override {
        options_.use_guess = 1;
        std::copy_n(normal, 3, options_.guess);
        return true;
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

}  // namespace

std::unique_ptr<Query> make_qdist_f64(const Case &c, double tolerance) { return std::make_unique<QdistQuery<F64>>(c, tolerance); }
std::unique_ptr<Query> make_qdist_f32(const Case &c, double tolerance) { return std::make_unique<QdistQuery<F32>>(c, tolerance); }
