// SPDX-License-Identifier: Apache-2.0
// The stages of an import: bytes, tinygltf, what the file requires, nodes, cameras and lights, leftovers.
#include "load.hpp"

#include "common/file.hpp"
#include "common/stage.hpp"
#include "importer.hpp"

#include <algorithm>
#include <cstring>

namespace restage::gltf {

namespace fs = std::filesystem;

void Importer::progress(float done, const char* what) const {
    if (!out_.progress(out_.ctx, std::min(done, 1.f), what)) throw Cancelled{};
}

// What a file requires and we lack; what it merely uses is reported where it is met.
void Importer::check_extensions() {
    static constexpr std::string_view known[] = {
        "KHR_texture_transform", "KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
        "KHR_materials_unlit",   "KHR_texture_basisu",  "EXT_texture_webp"};
    for (const std::string& name : model_.extensionsRequired)
        if (std::find(std::begin(known), std::end(known), name) == std::end(known) &&
            !name.starts_with("KHR_materials_"))
            report_.approximated("extension " + quote(name),
                                 "the file requires it and it is not known; what it stands for is missing");
    for (const std::string& name : model_.extensionsUsed)
        if (name == "EXT_lights_image_based" || name == "KHR_xmp_json_ld" || name == "KHR_animation_pointer")
            report_.dropped("extension " + quote(name), "not read");
}

void Importer::tell_leftovers() {
    if (!model_.animations.empty())
        report_.dropped("animations",
                        std::to_string(model_.animations.size()) + "; things stand as the file places them");
    if (!model_.skins.empty())
        report_.approximated("skins",
                             std::to_string(model_.skins.size()) + "; bodies are held in the pose of the file's nodes");
    std::size_t outside = 0;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
        outside += visits_[i] == 0 && model_.nodes[i].mesh >= 0;
    if (outside) report_.dropped("nodes", std::to_string(outside) + " with a mesh stand outside the scene");
    const bool single =
        std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return !m.second.two_sided; });
    if (single) report_.kept("single-sided materials", "both sides of a surface are seen; nothing is culled");
}

void Importer::run() {
    check_extensions();
    world_.resize(model_.nodes.size());
    visits_.resize(model_.nodes.size());
    const auto& scene = model_.scenes[static_cast<std::size_t>(choose_scene())];
    for (const int root : scene.nodes)
        find_transforms(root, Matrix(), 0);
    for (const int root : scene.nodes)
        node(root, 0);
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
        if (visits_[i] == 0) continue;
        const auto& node = model_.nodes[i];
        if (node.camera >= 0) camera(static_cast<int>(i));
        const auto it = node.extensions.find("KHR_lights_punctual");
        if (it != node.extensions.end())
            light(static_cast<int>(i), static_cast<int>(number_of(it->second, "light", -1)));
    }
    if (objects_ == 0) {
        report_.flush();
        throw ImportError{"the scene shows nothing: it has no triangles"};
    }
    report_.kept("scene", std::to_string(objects_) + " objects, " + std::to_string(materials_.size()) + " materials, " +
                              std::to_string(lights_) + " lights, " + std::to_string(cameras_) + " cameras");
    tell_leftovers();
    if (cameras_ == 0) {
        add_camera(out_, report_, bounds_, Up::y);
        add_film(out_);
    }
    if (lights_ == 0) add_studio(out_, report_, Up::y);
}

int probe(const char* path, const void* head, std::size_t head_size) {
    const std::string_view text(static_cast<const char*>(head), head ? head_size : 0);
    if (text.starts_with("glTF")) return 100;
    if (has_extension(path, "gltf")) return 100;
    if (has_extension(path, "glb")) return 60; // without its magic number: broken, but whose else?
    return text.find("\"asset\"") != text.npos && text.find("\"version\"") != text.npos && text.find('{') != text.npos
               ? 60
               : 0;
}

int load(const char* path, const RestageSceneWriter1* out) {
    if (!path || !out) return 0;
    return guarded_load(path, *out, [&] {
        std::error_code code;
        fs::path full = fs::weakly_canonical(path, code);
        if (code) full = path;
        std::string reason;
        const auto bytes = read_file(full, reason);
        if (!bytes) throw ImportError{"the file cannot be read: " + reason};
        const tinygltf::Model model = parse_model(full, *bytes, *out);
        Importer(*out, full, model).run();
    });
}

} // namespace restage::gltf
