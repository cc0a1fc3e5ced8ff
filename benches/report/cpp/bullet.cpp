// Bullet 3.24 (Debian's libbullet-dev, its library in double precision), margin 0, behind the interface of its peers.
//
// Shapes are Bullet's own where it has them. It has no ellipsoids, and its hulls look at every vertex: those two are support functions of our own.
//
// It has two ways to a depth, and neither has a setting:
//
// * `btGjkPairDetector`, with `btVoronoiSimplexSolver` and `btGjkEpaPenetrationDepthSolver`: what its own collision detection calls.
// * `btGjkEpaSolver2::Penetration`, which the first calls in the end, called directly.
//
// The second takes half of the time (box-box 0.9 against 1.8 us, cylinders 2.7 against 4.0, hulls of 500 vertices 6 against 13), as it does not run GJK twice, and its
// answers are nearer: the first mixes them with distances of its own, and has been 0.037 of the size off for one ellipsoid in 40, where the second is never more than 6e-8
// off. Spheres and capsules are the exception: to the first they are a point and a segment, and a radius that is subtracted, so that two spheres are exact in 0.17 us,
// where the second makes polytopes of them (5e-7 off after 11 us). So a pair with one of them takes the first, and all others the second. (A capsule and a
// cone: 0.9 us and 4e-7 off at worst, against 2.5 us and 6e-10.) Where the second finds no overlap, or fails, the first says how far it is.
#include "solvers.hpp"

#define BT_USE_DOUBLE_PRECISION
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

namespace {

// Hulls with more vertices are searched by walking over edges, as the other peers do.
constexpr std::size_t LINEAR_SCAN_MAX = 32;

// What Bullet has no shape for: a support function of one's own is all that it asks.
class OwnShape : public btConvexInternalShape {
public:
    OwnShape() {
        m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
        m_collisionMargin = 0;
    }
    btVector3 localGetSupportingVertex(const btVector3 &d) const override { return localGetSupportingVertexWithoutMargin(d); }
    void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3 *d, btVector3 *out, int count) const override {
        for (int i = 0; i < count; ++i) out[i] = localGetSupportingVertexWithoutMargin(d[i]);
    }
    void calculateLocalInertia(btScalar, btVector3 &inertia) const override { inertia.setZero(); }
    const char *getName() const override { return "own"; }
};

class Ellipsoid final : public OwnShape {
public:
    explicit Ellipsoid(const btVector3 &semi_axes) : semi_axes_(semi_axes) {}
    btVector3 localGetSupportingVertexWithoutMargin(const btVector3 &d) const override {
        const btVector3 e = semi_axes_ * d;
        const btScalar length = e.length();
        return length > 0 ? semi_axes_ * e / length : btVector3(0, 0, 0);
    }

private:
    btVector3 semi_axes_;
};

class WalkedHull final : public OwnShape {
public:
    explicit WalkedHull(const HullMesh &mesh) : first_{0} {
        for (std::size_t i = 0; i < mesh.vertices.size(); i += 3)
            vertices_.emplace_back(mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2]);
        for (const auto &around : mesh.neighbours()) {
            adjacent_.insert(adjacent_.end(), around.begin(), around.end());
            first_.push_back(static_cast<int>(adjacent_.size()));
        }
    }

    // Begins where the last search ended: directions of one query are close.
    btVector3 localGetSupportingVertexWithoutMargin(const btVector3 &d) const override {
        int best = last_;
        btScalar best_value = vertices_[best].dot(d);
        for (int from = -1; from != best;) {  // strictly upwards, so it ends
            from = best;
            for (int k = first_[from]; k < first_[from + 1]; ++k) {
                const btScalar value = vertices_[adjacent_[k]].dot(d);
                if (value > best_value) {
                    best_value = value;
                    best = adjacent_[k];
                }
            }
        }
        last_ = best;
        return vertices_[best];
    }

private:
    std::vector<btVector3> vertices_;
    std::vector<int> first_, adjacent_;  // the neighbours of vertex i are adjacent_[first_[i]] .. adjacent_[first_[i + 1] - 1]
    mutable int last_ = 0;
};

std::unique_ptr<btConvexShape> hull(const Shape &shape) {
    if (shape.vertices.size() / 3 > LINEAR_SCAN_MAX) return std::make_unique<WalkedHull>(hull_mesh(shape.vertices));
    auto points = std::make_unique<btConvexHullShape>();
    for (std::size_t i = 0; i < shape.vertices.size(); i += 3)
        points->addPoint(btVector3(shape.vertices[i], shape.vertices[i + 1], shape.vertices[i + 2]), false);
    points->recalcLocalAabb();
    return points;
}

// Lengths of boxes and cylinders are said again after the margin has gone: the constructor has taken it off, and rounding stays.
template <class Solid>
std::unique_ptr<btConvexShape> exact(const btVector3 &half) {
    auto solid = std::make_unique<Solid>(half);
    solid->setMargin(0);
    solid->setImplicitShapeDimensions(half);
    return solid;
}

std::unique_ptr<btConvexShape> bullet_shape(const Shape &shape) {
    const std::vector<double> &p = shape.params;
    std::unique_ptr<btConvexShape> made;
    switch (shape.kind) {
        case Kind::sphere: return std::make_unique<btSphereShape>(p[0]);  // its margin is its radius
        case Kind::capsule: return std::make_unique<btCapsuleShapeZ>(p[0], 2 * p[1]);  // so is this one's
        case Kind::box: return exact<btBoxShape>({p[0], p[1], p[2]});
        case Kind::cylinder: return exact<btCylinderShapeZ>({p[0], p[0], p[1]});
        case Kind::ellipsoid: return std::make_unique<Ellipsoid>(btVector3(p[0], p[1], p[2]));
        case Kind::cone: made = std::make_unique<btConeShapeZ>(p[0], 2 * p[1]); break;
        case Kind::hull: made = hull(shape); break;
    }
    made->setMargin(0);
    return made;
}

btTransform pose(const Shape &shape) {
    const auto &r = shape.rotation;
    const auto &t = shape.translation;
    return btTransform(btMatrix3x3(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]), btVector3(t[0], t[1], t[2]));
}

bool is_round(const Shape &shape) { return shape.kind == Kind::sphere || shape.kind == Kind::capsule; }

class BulletQuery final : public Query {
public:
    explicit BulletQuery(const Case &c) : by_detector_(is_round(c.a) || is_round(c.b)), a_(bullet_shape(c.a)), b_(bullet_shape(c.b)) {
        input_.m_transformA = pose(c.a);
        input_.m_transformB = pose(c.b);
    }

    void run(Answer &answer) override {
        if (by_detector_ || !expand(answer)) detect(answer);
    }

private:
    bool expand(Answer &answer) const {
        const btTransform &a = input_.m_transformA, &b = input_.m_transformB;
        btGjkEpaSolver2::sResults found;
        if (!btGjkEpaSolver2::Penetration(a_.get(), a, b_.get(), b, b.getOrigin() - a.getOrigin(), found)) return false;
        set(answer, -found.distance, -(a.getBasis() * found.normal));  // it is left in the frame of A
        return true;
    }

    void detect(Answer &answer) {
        btGjkPairDetector detector(a_.get(), b_.get(), &simplex_, &penetration_);
        btPointCollector found;
        detector.getClosestPoints(input_, found, nullptr);
        if (found.m_hasResult)
            set(answer, -found.m_distance, -found.m_normalOnBInWorld);
        else
            answer.set_outcome("no_collision");
    }

    // Bullet's normals are from B to A.
    static void set(Answer &answer, btScalar depth, const btVector3 &normal) {
        answer.set_outcome(std::isfinite(depth) ? "ok" : "nan");
        answer.depth = depth;
        for (int i = 0; i < 3; ++i) answer.normal[i] = normal[i];
    }

    bool by_detector_;
    std::unique_ptr<btConvexShape> a_, b_;
    btDiscreteCollisionDetectorInterface::ClosestPointInput input_;
    btVoronoiSimplexSolver simplex_;
    btGjkEpaPenetrationDepthSolver penetration_;
};

}  // namespace

std::unique_ptr<Query> make_bullet(const Case &c, double) { return std::make_unique<BulletQuery>(c); }
