// SPDX-License-Identifier: Apache-2.0
#include "variants.hpp"

#include "frames.hpp"
#include "query/camera_path.hpp"
#include "view/video.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>

namespace restage::app {

namespace {

constexpr std::string_view all = "all";

std::string file_word(std::string name) {
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos)
            c = '_';
    return name;
}

void replace(std::string& text, std::string_view what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
}

Result<std::vector<std::string>> look_names(const document::Looks& looks, const std::string& wanted) {
    if (wanted.empty()) return std::vector<std::string>{""};
    std::vector<std::string> names;
    std::string known;
    for (const document::Look& look : looks.list) {
        if (look.name == wanted) return std::vector<std::string>{wanted};
        names.push_back(look.name);
        known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", look.name);
    }
    if (wanted == all && !names.empty()) return names;
    return fail(fmt::format("--look {}: no such look; known: {}", wanted, known.empty() ? "none" : known));
}

} // namespace

Result<std::vector<Variant>> variants(const scene::Scene& scene, const document::Looks& looks, const std::string& look,
                                      const std::string& camera, const CameraMove& move) {
    RESTAGE_TRY(const auto names, look_names(looks, look));
    std::vector<std::string> cameras;
    if (camera == all && !scene::find_by_name<scene::Camera>(scene, all)) {
        int number = 0; // names may not be unique
        scene.cameras.each([&](auto, const auto&) { cameras.push_back(std::to_string(++number)); });
    }
    if (cameras.empty()) cameras.push_back(camera);
    std::vector<Variant> list;
    for (const std::string& name : names)
        for (const std::string& one : cameras)
            for (std::uint32_t frame = std::min(move.frames(), 1u); frame <= move.frames(); ++frame)
                list.push_back({name, one, frame});
    return list;
}

std::string CameraMove::what(std::uint32_t frame) const {
    if (frame == 0) return "";
    if (path > 0) return fmt::format("frame {} of {} on the path through all cameras", frame, path);
    return frame > 1 ? fmt::format("turned by {} degrees", 360.0 * (frame - 1) / turntable) : "";
}

Result<> move_camera(scene::Scene& scene, const CameraMove& move, std::uint32_t frame) {
    const scene::Camera* camera = scene.cameras.find(scene.active_camera.value);
    if (!camera || frame == 0) return {};
    if (move.path > 0) {
        const auto through = query::all_cameras(scene);
        if (through.size() < 2) return fail("--camera-path: the scene has one camera; a path needs two or more");
        scene = query::seen_from(scene, query::camera_path(through, move.path)[frame - 1]);
    } else {
        scene = query::seen_from(scene, query::turned(scene, *camera, 360.0 * (frame - 1) / move.turntable));
    }
    return {};
}

std::string variant_path(std::string pattern, const Variant& variant) {
    replace(pattern, "{look}", file_word(variant.look));
    replace(pattern, "{camera}", file_word(variant.camera));
    return variant.frame > 0 ? frame_path(pattern, variant.frame) : pattern;
}

Result<> check_variant_paths(const std::string& pattern, const std::vector<Variant>& variants) {
    std::map<std::string, const Variant*> made;
    const bool video = view::is_video_path(pattern);
    for (const Variant& variant : variants) {
        if (video && variant.frame > 1) continue;
        if (const auto [other, fresh] = made.emplace(variant_path(pattern, variant), &variant); !fresh)
            return fail(fmt::format("{} would be written twice; put {} in the name", other->first,
                                    other->second->look != variant.look       ? "{look}"
                                    : other->second->camera != variant.camera ? "{camera}"
                                                                              : "####"));
    }
    return {};
}

} // namespace restage::app
