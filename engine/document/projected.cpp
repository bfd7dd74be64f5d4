// SPDX-License-Identifier: Apache-2.0
#include "document/projected.hpp"

#include "scene/box_projection.hpp"
#include "scene/texture_map.hpp"

#include <algorithm>
#include <utility>

namespace restage::document {

using namespace scene;

namespace {

// Its components do, too.
bool needs_uv(const Scene& scene, Id<Material> id, const plugin::Registry& registry) {
    const Material* material = scene.materials.find(id);
    if (!material) return false;
    const auto mapped = [&](Id<Texture> texture) {
        const auto plugin = registry.find_texture(scene.textures[texture].type);
        return plugin && plugin->table->mapped;
    };
    return std::ranges::any_of(textures_of(scene, *material), mapped) ||
           std::ranges::any_of(material->params.entries(),
                               [&](const auto& entry) { return needs_uv(scene, entry.value.material, registry); });
}

} // namespace

Projected project_where_needed(const Scene& before, Edit edit, std::span<const Id<Instance>> objects,
                               const plugin::Registry& registry, const glm::dvec3& up) {
    Scene after = before; // shares its data
    apply(after, edit);
    std::vector<Id<Instance>> bare;
    for (const Id<Instance> id : objects) {
        const Instance* instance = after.instances.find(id);
        const Mesh* mesh = instance ? after.meshes.find(instance->mesh) : nullptr;
        if (mesh && mesh->data && !has_uv(*mesh) && needs_uv(after, instance->material, registry)) bare.push_back(id);
    }
    if (bare.empty()) return {std::move(edit), {}};
    const auto projected =
        project_box(after, bare, {.size = covering_size(after, bare), .world_axes = false, .up = up});
    if (!projected) return {std::move(edit), {}}; // meshes without triangles
    edit.changes.insert(edit.changes.end(), projected->changes.begin(), projected->changes.end());
    return {std::move(edit), std::move(bare)};
}

} // namespace restage::document
