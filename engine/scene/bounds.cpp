// SPDX-License-Identifier: Apache-2.0
#include "scene/bounds.hpp"

#include "scene/placeholder.hpp"

namespace restage::scene {

void compute_bounds(MeshData& data) {
    data.lower = data.upper = data.positions.empty() ? glm::vec3(0) : data.positions.front();
    for (const glm::vec3& p : data.positions) {
        data.lower = glm::min(data.lower, p);
        data.upper = glm::max(data.upper, p);
    }
}

// J. Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems 1990: per entry of the matrix, the smaller and the
// larger of its two products.
Bounds world_bounds(const MeshData& data, const glm::dmat4& m) {
    Bounds result;
    if (data.positions.empty()) return result;
    result.lower = result.upper = glm::dvec3(m[3]);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double a = m[column][row] * static_cast<double>(data.lower[column]);
            const double b = m[column][row] * static_cast<double>(data.upper[column]);
            result.lower[row] += std::min(a, b);
            result.upper[row] += std::max(a, b);
        }
    return result;
}

Bounds world_bounds(const Scene& scene, Id<Instance> id) {
    const Instance* instance = scene.instances.find(id);
    const Mesh* mesh = instance ? scene.meshes.find(instance->mesh) : nullptr;
    return mesh && mesh->data ? world_bounds(*mesh->data, instance->object_to_world) : Bounds{};
}

Bounds world_bounds(const Scene& scene) {
    Bounds result;
    scene.instances.each([&](Id<Instance> id, const Instance& instance) {
        const Mesh* mesh = scene.meshes.find(instance.mesh);
        if (!instance.hidden && !(mesh && is_missing(*mesh))) result.add(world_bounds(scene, id));
    });
    return result;
}

} // namespace restage::scene
