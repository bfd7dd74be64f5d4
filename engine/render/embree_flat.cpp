// SPDX-License-Identifier: Apache-2.0
// EmbreeScene without instances: every triangle in world space, in one hierarchy.
#include "render/embree_instances.hpp"

#include <fmt/format.h>
#include <unordered_set>

namespace restage::render {

// Only a scene that is new as a whole: what is edited has instances, so that moving an object stays cheap.
bool EmbreeScene::flattening_pays(const SceneChanges& changes) const {
    if (use_.flat_from == never || !scene_->plain_hits()) return false;
    std::unordered_set<std::uint32_t> fresh, used;
    for (auto id : changes.meshes)
        fresh.insert(id.value);
    std::uint64_t triangles = 0, stored = 0;
    for (std::uint32_t i = 0; i < scene_->instances().size(); ++i) {
        if (scene_->border(i)) return false;
        if (!scene_->traced(i)) continue;
        const auto id = scene_->mesh_of(i);
        if (!fresh.contains(id.value)) return false;
        triangles += scene_->mesh(id)->triangle_count;
        if (used.insert(id.value).second) stored += scene_->mesh(id)->triangle_count;
    }
    return triangles >= use_.flat_from && triangles <= 2 * stored; // memory: meshes used often stay instances
}

Result<void> EmbreeScene::flatten(const SceneChanges& changes) {
    // Nothing of the instances is needed, and all of their meshes are replaced.
    if (flat_) rtcReleaseScene(flat_);
    surfaces_ = std::make_unique<EmbreeInstances>(device_);
    for (auto id : changes.meshes)
        meshes_.erase(id.value);
    not_built_.insert(not_built_.end(), changes.meshes.begin(), changes.meshes.end());

    flat_ = rtcNewScene(device_);
    rtcSetSceneFlags(flat_, RTC_SCENE_FLAG_ROBUST);
    for (std::uint32_t i = 0; i < scene_->instances().size(); ++i) {
        if (!scene_->traced(i)) continue;
        const auto id = scene_->mesh_of(i);
        const GpuMesh& mesh = *scene_->mesh(id);
        const auto& positions = scene_->mesh_data(id)->positions;
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        if (auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), positions.size()))) {
            const glm::dmat4x3 placement(scene_->placement(i)); // rounded once: lib/ray_offset.glsl
            for (std::size_t v = 0; v < positions.size(); ++v) {
                const glm::dvec3 at = placement * glm::dvec4(positions[v], 1);
                for (std::size_t k = 0; k < 3; ++k)
                    vertices[3 * v + k] = float(at[int(k)]);
            }
        }
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.buffer.mapped(),
                                   mesh.indices_offset, sizeof(glm::uvec3), mesh.triangle_count);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(flat_, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(flat_);
    return check("the scene");
}

Result<void> EmbreeScene::unflatten(const SceneChanges& changes) {
    rtcReleaseScene(std::exchange(flat_, nullptr));
    SceneChanges all;
    std::unordered_set<std::uint32_t> seen;
    not_built_.insert(not_built_.end(), changes.meshes.begin(), changes.meshes.end());
    for (auto id : std::exchange(not_built_, {}))
        if (seen.insert(id.value).second) all.meshes.push_back(id);
    for (std::uint32_t i = 0; i < scene_->instances().size(); ++i)
        all.instances.push_back({i});
    return update_instances(all);
}

} // namespace restage::render
