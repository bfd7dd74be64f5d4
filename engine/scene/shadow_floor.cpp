// SPDX-License-Identifier: Apache-2.0
#include "scene/shadow_floor.hpp"

#include "scene/bounds.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>

namespace restage::scene {

namespace {

std::shared_ptr<const MeshData> square() { // from -1 to 1, seen from +z
    auto mesh = std::make_shared<MeshData>();
    mesh->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_bounds(*mesh);
    return mesh;
}

} // namespace

Result<ShadowFloor> add_shadow_floor(const Scene& scene, const glm::dvec3& up, const std::string& material_type) {
    Bounds box;
    scene.instances.each([&](Id<Instance> id, const Instance& instance) {
        if (!instance.hidden && !instance.catcher) box.add(world_bounds(scene, id));
    });
    if (box.empty() || !(box.radius() > 0)) return fail("nothing is visible that a floor could be laid below");
    const glm::dvec3 half = 0.5 * box.size();
    // Not in the plane of undersides, which rays could not tell from it.
    const double down = glm::dot(glm::abs(up), half) + 1e-4 * box.radius();
    const glm::dmat4 to_world = glm::translate(glm::dmat4(1), box.center() - down * up) *
                                glm::mat4_cast(glm::dquat(glm::dvec3(0, 0, 1), up)) *
                                glm::scale(glm::dmat4(1), glm::dvec3(20 * box.radius()));
    ShadowFloor made{{"Add shadow catcher floor", {}}, scene.instances.next()};
    const std::string name = "Shadow catcher floor";
    const auto mesh = scene.meshes.next();
    made.edit.changes.push_back(Change<Mesh>{mesh, std::nullopt, Mesh{.name = name, .data = square()}});
    const auto material = scene.materials.next();
    made.edit.changes.push_back(
        Change<Material>{material, std::nullopt, Material{.name = name, .type = material_type}});
    made.edit.changes.push_back(Change<Instance>{
        made.floor, std::nullopt,
        Instance{.name = name, .mesh = mesh, .material = material, .object_to_world = to_world, .catcher = true}});
    return made;
}

} // namespace restage::scene
