// The header of meshes is C++, too; here with the system's allocator.
#include "qdist_mesh.h"
#include "test.h"

int main() {
    const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    const qdist_mesh_pose pose = {{1, 0, 0, 0}, {0, 0, 0.9}};
    qdist_mesh *body = nullptr;
    qdist_mesh_pair *pair = nullptr;
    CHECK(qdist_mesh_create(xyz, 4, triangles, 4, &body, nullptr) == QDIST_OK);
    CHECK(qdist_mesh_pair_create(body, body, &pair) == QDIST_OK);
    // Memory has been allocated, so it is too late for another allocator.
    static const qdist_allocator late = {[](void *, size_t, size_t) -> void * { return nullptr; }, [](void *, void *, size_t, size_t) {}, nullptr};
    CHECK(qdist_mesh_set_allocator(&late) == QDIST_ERROR_ALLOCATOR);
    qdist_mesh_depth depth{};
    depth.struct_size = sizeof depth;
    CHECK(qdist_mesh_pair_depth(pair, &pose, nullptr, &depth) == QDIST_OK);
    CHECK(depth.lower <= depth.upper && 0 < depth.upper && depth.upper <= 0.11);
    // Tick by tick, with a clock that is a lambda.
    qdist_mesh_tracker *tracker = nullptr;
    qdist_mesh_budget budget;
    int looks = 0;
    CHECK(qdist_mesh_tracker_create(body, body, &tracker) == QDIST_OK);
    CHECK(qdist_mesh_budget_default(&budget) == QDIST_OK);
    budget.late = [](void *user) -> int32_t { return ++*static_cast<int *>(user) > 100; };
    budget.late_user = &looks;
    CHECK(qdist_mesh_tracker_update(tracker, &pose, &budget, &depth) == QDIST_OK);
    CHECK(depth.lower <= depth.upper && depth.upper <= 0.2 && 0 < looks && looks <= 100);
    qdist_mesh_tracker_free(tracker);
    qdist_mesh_pair_free(pair);
    qdist_mesh_free(body);
    return finish("mesh_cpp");
}
