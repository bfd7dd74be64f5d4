// SPDX-License-Identifier: Apache-2.0
// Scene: sky, camera, film and how it is rendered.
#include "panels.hpp"

#include <imgui.h>

namespace restage::editor {

void draw_scene_settings(Editor& e) {
    if (ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen) && e.camera_id()) {
        scene::Camera camera = e.camera();
        bool changed =
            ImGui::SliderFloat("Field of view", &camera.fov, 1, 150, "%.1f deg", ImGuiSliderFlags_AlwaysClamp);
        changed |= ImGui::DragFloat("Lens radius", &camera.lens_radius, 0.001f, 0, 1e6f, "%.4f");
        changed |= ImGui::DragFloat("Focal distance", &camera.focal_distance, 0.01f, 1e-4f, 1e9f, "%.3f");
        if (changed)
            e.edit(
                [camera](const scene::Scene& s) {
                    return scene::set_camera(s, s.active_camera.value, camera, "Change camera");
                },
                "scene.camera");
    }
    if (ImGui::CollapsingHeader("Rendering", ImGuiTreeNodeFlags_DefaultOpen)) {
        scene::Settings settings = e.scene().settings.value;
        int depth = int(settings.max_depth), samples = int(settings.samples);
        bool changed = ImGui::SliderInt("Longest path", &depth, 0, 100);
        changed |= ImGui::DragInt("Samples", &samples, 1, 1, 1 << 20);
        changed |= ImGui::Checkbox("Russian roulette", &settings.russian_roulette);
        settings.max_depth = std::uint32_t(depth);
        settings.samples = std::uint32_t(samples);
        if (changed)
            e.edit([settings](const scene::Scene& s) { return Result<scene::Edit>(scene::set_settings(s, settings)); },
                   "scene.settings");
    }
}

} // namespace restage::editor
