// SPDX-License-Identifier: Apache-2.0
#include "document/looks.hpp"
#include "document/session.hpp"
#include "final_pictures.hpp"
#include "looks.hpp"
#include "panel_context.hpp"
#include "query/camera_path.hpp"
#include "scene/edits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <string_view>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// "kitchen.png" -> "kitchen - Oak - Camera 2.png"
fs::path shot_path(const fs::path& path, const std::vector<std::string>& names) {
    std::string stem = path.stem().string();
    for (std::string name : names) {
        for (char& c : name)
            if (std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos) c = '_';
        stem += " - " + name;
    }
    return path.parent_path() / (stem + path.extension().string());
}

std::vector<scene::Camera> cameras_of(const scene::Scene& scene, const FinalWish& wish) {
    const scene::Camera* active = scene.cameras.find(scene.active_camera.value);
    if (wish.move == CameraMove::none || !active) return {};
    if (wish.move == CameraMove::path) return query::camera_path(query::all_cameras(scene), wish.frames);
    std::vector<scene::Camera> all;
    for (std::uint32_t frame = 0; frame < wish.frames; ++frame)
        all.push_back(query::turned(scene, *active, 360.0 * frame / wish.frames));
    return all;
}

} // namespace

fs::path frame_file(const fs::path& path, std::size_t frame) {
    return path.parent_path() / fmt::format("{} {:04}{}", path.stem().string(), frame, path.extension().string());
}

std::vector<Shot> shots_of(const PanelContext& e, const FinalWish& wish) {
    std::vector<std::pair<std::string, scene::Scene>> scenes;
    if (wish.all_looks)
        for (const document::Look& look : e.session().looks().list)
            scenes.emplace_back(look.name, document::with_look(e.scene(), look));
    else
        scenes.emplace_back("", wish.from_view && wish.move != CameraMove::path ? scene_as_seen(e) : e.scene());
    std::vector<Shot> list;
    for (const auto& variant : scenes) {
        const std::string& look = variant.first;
        const scene::Scene& scene = variant.second;
        std::vector<std::string> names;
        if (!look.empty()) names.push_back(look);
        if (!wish.all_cameras || wish.move == CameraMove::path) {
            list.push_back({scene, look, shot_path(wish.path, names), cameras_of(scene, wish)});
            continue;
        }
        std::set<std::string> taken; // cameras of a file may have equal names
        names.emplace_back();
        scene.cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& camera) {
            names.back() = taken.contains(camera.name) ? scene::next_name(camera.name, taken) : camera.name;
            taken.insert(names.back());
            scene::Scene from = scene;
            from.active_camera = {id, ++from.clock};
            auto moved = cameras_of(from, wish);
            list.push_back({std::move(from), fmt::format("{}", fmt::join(names, ", ")), shot_path(wish.path, names),
                            std::move(moved)});
        });
    }
    return list;
}

} // namespace restage::editor
