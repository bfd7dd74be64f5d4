// SPDX-License-Identifier: Apache-2.0
#include "scene/statistics.hpp"

#include <unordered_set>

namespace restage::scene {

Statistics statistics_of(const Scene& scene) {
    Statistics found;
    std::unordered_set<const void*> counted;
    const auto bytes = [](const auto&... values) { return (... + (values.size() * sizeof(values[0]))); };
    scene.meshes.each([&](auto, const Mesh& mesh) {
        if (!mesh.data) return;
        const MeshData& d = *mesh.data;
        if (!counted.insert(&d).second) return;
        found.triangles += d.triangles.size();
        found.geometry_bytes += bytes(d.positions, d.normals, d.uvs, d.triangles, d.tangents, d.uvs2);
    });
    scene.instances.each([&](auto, const Instance& instance) {
        ++found.objects;
        found.hidden += instance.hidden;
        const Mesh* mesh = scene.meshes.find(instance.mesh);
        found.instanced += mesh && mesh->data ? mesh->data->triangles.size() : 0;
    });
    scene.images.each([&](auto, const Image& image) {
        if (image.data && counted.insert(image.data.get()).second) found.pixel_bytes += bytes(image.data->values);
    });
    return found;
}

} // namespace restage::scene
