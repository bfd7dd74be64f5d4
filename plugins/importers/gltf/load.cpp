// SPDX-License-Identifier: Apache-2.0
// The stages of an import: bytes, tinygltf, required extensions, nodes, cameras and lights, leftovers.
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

// Unknown required extensions are refused (glTF 2.0, 3.12); those merely used are reported.
void Importer::check_extensions() {
    static constexpr std::string_view known[] = {
        "KHR_texture_transform", "KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
        "KHR_node_visibility", "KHR_xmp_json_ld", "KHR_materials_unlit", "KHR_materials_ior", "KHR_materials_specular",
        "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_clearcoat", "KHR_materials_sheen",
        "KHR_materials_anisotropy", "KHR_materials_iridescence", "KHR_materials_emissive_strength",
        "KHR_materials_variants", "KHR_materials_pbrSpecularGlossiness",
        // they are reported where they occur
        "KHR_materials_dispersion", "KHR_materials_diffuse_transmission", "KHR_texture_basisu", "EXT_texture_webp",
        "KHR_draco_mesh_compression", "EXT_meshopt_compression"};
    const auto is_known = [](const std::string& name) {
        return std::find(std::begin(known), std::end(known), name) != std::end(known);
    };
    std::string missing;
    for (const std::string& name : model_.extensionsRequired)
        if (!is_known(name)) missing += (missing.empty() ? "" : ", ") + name;
    if (!missing.empty())
        throw ImportError{"the file requires unknown extensions: " + missing +
                          "; save it without, or with a version for programs that lack it"};
    std::string unread;
    for (const std::string& name : model_.extensionsUsed)
        if (!is_known(name)) unread += (unread.empty() ? "" : ", ") + name;
    if (!unread.empty()) report_.dropped("extensions", "not read: " + unread);
}

void Importer::tell_leftovers() {
    if (!model_.animations.empty())
        report_.dropped("animations",
                        std::to_string(model_.animations.size()) + "; objects stay where the file places them");
    if (!model_.skins.empty())
        report_.approximated("skins",
                             std::to_string(model_.skins.size()) + "; bodies are held in the pose of the file's nodes");
    std::size_t outside = 0;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
        outside += visits_[i] == 0 && model_.nodes[i].mesh >= 0;
    if (outside) report_.dropped("nodes", std::to_string(outside) + " with a mesh are outside the scene");
    if (hidden_objects_)
        report_.kept("hidden objects", std::to_string(hidden_objects_) + " of " + std::to_string(objects_) +
                                           ", as KHR_node_visibility has it; they can be shown");
    const bool single =
        std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return !m.second.two_sided; });
    if (single) report_.kept("single-sided materials", "both sides of a surface are visible; nothing is culled");
}

void Importer::run() {
    check_extensions();
    world_.resize(model_.nodes.size(), placement_.to_world);
    visits_.resize(model_.nodes.size());
    hidden_.resize(model_.nodes.size());
    choose_variant();
    const std::vector<int> roots = choose_roots();
    for (const int root : roots)
        find_transforms(root, placement_.to_world, false, 0);
    for (const int root : roots)
        node(root, 0);
    if (bounds_.empty()) bounds_ = hidden_bounds_;
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
    if (cameras_ == 0) add_camera(out_, report_, bounds_, Up::y);
    // The file's own camera may be in a closed room; ours shows everything from outside, in the studio.
    add_film(out_, aspect_, lights_ > 0 || cameras_ > 0);
    if (lights_ == 0) add_studio(out_, report_, Up::y);
}

int probe(const char* path, const void* head, std::size_t head_size) {
    const std::string_view text(static_cast<const char*>(head), head ? head_size : 0);
    if (text.starts_with("glTF")) return 100;
    if (has_extension(path, "gltf")) return 100;
    if (has_extension(path, "glb")) return 60; // without the magic number: broken, but still ours by name
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
