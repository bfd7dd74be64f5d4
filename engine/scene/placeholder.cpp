// SPDX-License-Identifier: Apache-2.0
#include "scene/placeholder.hpp"

#include "scene/validate.hpp"

namespace restage::scene {

namespace {
constexpr std::string_view mark = "missing ";
}

bool is_missing(const Mesh& mesh) { return mesh.primitive.starts_with(mark); }
std::string missing_line(const Mesh& mesh) { return is_missing(mesh) ? mesh.primitive.substr(mark.size()) : ""; }

std::vector<Missing> missing_things(const Scene& scene) {
    std::vector<Missing> all;
    scene.images.each([&](auto, const Image& image) {
        if (!image.data && !image.path.empty()) all.push_back({"image", image.name, image.path});
    });
    scene.meshes.each([&](auto, const Mesh& mesh) {
        if (is_missing(mesh))
            all.push_back({"mesh", mesh.name, mesh.source_file.empty() ? missing_line(mesh) : mesh.source_file});
    });
    return all;
}

Result<Edit> find_mesh(const Scene& scene, Id<Mesh> id, std::string file, std::shared_ptr<const MeshData> data) {
    const Mesh* before = scene.meshes.find(id);
    if (!before || !is_missing(*before)) return fail("this mesh is no longer missing");
    if (before->source_file.empty()) return fail("\"" + before->name + "\" represents a line of the file, not a mesh");
    if (!data) return fail(file + ": contains no mesh");
    if (const std::string problem = check_mesh(*data); !problem.empty()) return fail(file + ": " + problem);
    Mesh after = *before;
    after.data = std::move(data);
    after.source_file = std::move(file);
    after.primitive.clear();
    return Edit{"Find a missing mesh", {Change<Mesh>{id, *before, std::move(after)}}};
}

} // namespace restage::scene
