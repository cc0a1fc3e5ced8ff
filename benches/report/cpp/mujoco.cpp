// MuJoCo (PyPI's mujoco, the C library in it) behind the interface of its peers: `mj_geomDistance` of two geoms that do not move, with the native solver (GJK and EPA).
//
// It is the leanest public function, and lean: of 6,570 instructions for two boxes, 6,230 are the solver's (`mjc_ccd`, which the library exports, but no header of it
// declares). The functions of `mjCOLLISIONFUNC`, which its simulation calls, make several contacts a pair. Spheres and capsules have code of their own behind the same call.
//
// A tolerance is a length. Points of hulls are floats in MuJoCo, and their depths are off by that (6e-8 of the size). It has no cones, and refuses meshes that are nearly
// flat or very small.
#include "solvers.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <mujoco/mujoco.h>

namespace {

// The C library ends the program where it cannot go on, unless it is told not to.
void fail(const char *message) { throw std::runtime_error(message); }
void be_silent(const char *) {}

struct Deleter {
    void operator()(mjSpec *spec) const { mj_deleteSpec(spec); }
    void operator()(mjModel *model) const { mj_deleteModel(model); }
    void operator()(mjData *data) const { mj_deleteData(data); }
};

mjtGeom geom_type(const Shape &shape) {
    switch (shape.kind) {
        case Kind::sphere: return mjGEOM_SPHERE;
        case Kind::box: return mjGEOM_BOX;
        case Kind::ellipsoid: return mjGEOM_ELLIPSOID;
        case Kind::cylinder: return mjGEOM_CYLINDER;
        case Kind::capsule: return mjGEOM_CAPSULE;
        case Kind::hull: return mjGEOM_MESH;
        case Kind::cone: break;
    }
    throw std::runtime_error("MuJoCo has no cones");
}

// A mesh of vertices alone: MuJoCo makes their convex hull.
void add_mesh(mjSpec *spec, mjsGeom *geom, const Shape &shape, const char *name) {
    mjsMesh *mesh = mjs_addMesh(spec, nullptr);
    mjs_setName(mesh->element, name);
    mesh->inertia = mjMESH_INERTIA_CONVEX;
    const std::vector<float> vertices(shape.vertices.begin(), shape.vertices.end());
    mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
    mjs_setString(geom->meshname, name);
}

void add_geom(mjSpec *spec, const Shape &shape, const char *name) {
    mjsGeom *geom = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
    geom->type = geom_type(shape);
    std::copy(shape.params.begin(), shape.params.end(), geom->size);
    if (shape.kind == Kind::hull) add_mesh(spec, geom, shape, name);
}

class MujocoQuery final : public Query {
public:
    MujocoQuery(const Case &c, double tolerance) : flipped_(geom_type(c.a) > geom_type(c.b)) {
        mju_user_error = fail;
        mju_user_warning = be_silent;
        const std::unique_ptr<mjSpec, Deleter> spec(mj_makeSpec());
        spec->compiler.usethread = 0;
        if (tolerance > 0) {
            spec->option.ccd_tolerance = tolerance;
            spec->option.ccd_iterations = ITERATIONS;
        }
        spec->memory = MEMORY;
        const Shape &first = flipped_ ? c.b : c.a, &second = flipped_ ? c.a : c.b;
        add_geom(spec.get(), first, "first");
        add_geom(spec.get(), second, "second");
        model_.reset(mj_compile(spec.get(), nullptr));
        if (!model_) throw std::runtime_error(mjs_getError(spec.get()));
        data_.reset(mj_makeData(model_.get()));
        place(0, first);
        place(1, second);
    }

    void run(Answer &answer) override {
        mjtNum ends[6];
        const mjtNum distance = mj_geomDistance(model_.get(), data_.get(), 0, 1, far_, only_overlap_ ? nullptr : ends);
        if (!(distance < far_)) {
            answer.set_outcome(std::isnan(distance) ? "nan" : "no_collision");
            return;
        }
        answer.set_outcome("ok");
        answer.depth = -distance;
        if (only_overlap_) return;
        // From the end on B to the end on A it is depth * normal.
        double normal[3], length = 0;
        for (int i = 0; i < 3; ++i) {
            normal[i] = ends[i] - ends[3 + i];
            length += normal[i] * normal[i];
        }
        length = std::copysign(std::sqrt(length), flipped_ ? distance : -distance);
        for (int i = 0; i < 3; ++i) answer.normal[i] = normal[i] / length;
    }

    // It looks no farther than it is told to.
    bool only_overlap() override {
        far_ = 0;
        return only_overlap_ = true;
    }

private:
    static constexpr int ITERATIONS = 500;  // more than are made at 1e-12; they cost nothing when they are not
    static constexpr mjtSize MEMORY = 1 << 20;  // bytes: enough for these
    static constexpr mjtNum FAR = 1e100;

    // The numbers of the file, without a quaternion between. Meshes have been moved and turned to their own axes.
    void place(int geom, const Shape &shape) {
        mjtNum *position = data_->geom_xpos + 3 * geom, *rotation = data_->geom_xmat + 9 * geom;
        std::copy(shape.rotation.begin(), shape.rotation.end(), rotation);
        std::copy(shape.translation.begin(), shape.translation.end(), position);
        if (shape.kind != Kind::hull) return;
        const int mesh = model_->geom_dataid[geom];
        mjtNum turn[9], turned[9], moved[3];
        mju_quat2Mat(turn, model_->mesh_quat + 4 * mesh);
        mju_mulMatMat(turned, shape.rotation.data(), turn, 3, 3, 3);
        mju_mulMatVec3(moved, shape.rotation.data(), model_->mesh_pos + 3 * mesh);
        std::copy(turned, turned + 9, rotation);
        mju_addTo3(position, moved);
    }

    bool flipped_, only_overlap_ = false;
    mjtNum far_ = FAR;
    std::unique_ptr<mjModel, Deleter> model_;
    std::unique_ptr<mjData, Deleter> data_;
};

}  // namespace

std::unique_ptr<Query> make_mujoco(const Case &c, double tolerance) { return std::make_unique<MujocoQuery>(c, tolerance); }
