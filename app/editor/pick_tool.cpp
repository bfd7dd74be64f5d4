// SPDX-License-Identifier: Apache-2.0
#include "pick_tool.hpp"

#include "panel_context.hpp"
#include "project_texture.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/edits.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"

#include <imgui.h>

namespace restage::editor {

InstanceId picked_at(const PanelContext& e, ImVec2 screen) {
    const auto frame = e.shown_frame();
    const auto newest = e.live().frame();
    if (frame && newest && frame->divider == 1 && e.live().status().current && frame->request == newest->request &&
        frame->request == e.viewport.shown_request())
        return e.viewport.instance_at(e, screen);
    const glm::dvec2 film = e.viewport.film_point(screen);
    if (film.x < 0 || film.y < 0 || film.x >= 1 || film.y >= 1) return {};
    const query::ViewRay ray = query::view_ray(e.camera(), film, e.film_aspect());
    const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
    return hits.empty() ? InstanceId{} : hits[0].instance;
}

bool run_pick_tool(PanelContext& e, bool over) {
    if (!e.pick_tool) return false;
    if (ImGui::IsKeyPressed(ImGuiKey_Escape) || ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        e.pick_tool.reset();
        return true;
    }
    if (!over) return true;
    const ImVec2 at = ImGui::GetIO().MousePos;
    e.hovered = e.viewport.instance_at(e, at);
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    ImGui::SetTooltip("%s (Esc: cancel)", e.pick_tool->hint.c_str());
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        const PickTool tool = *e.pick_tool; // done() may start another tool
        e.pick_tool.reset();
        tool.done(e, picked_at(e, at), at);
    }
    return true;
}

PickTool material_eyedropper(const SelectContext& editor) {
    return {"Click the object whose material to take",
            [to = editor.selection.instances()](PanelContext& e, InstanceId id, ImVec2) {
                const scene::Instance* from = e.scene().instances.find(id);
                if (!from || !from->material) return;
                e.material_clipboard = from->material;
                e.edit([&e, to, material = from->material](const scene::Scene& s) {
                    return project_where_needed(e, s, scene::set_material(s, to, material), to);
                });
            }};
}

PickTool focus_picker() {
    return {
        "Click the object that should be sharp", [](PanelContext& e, InstanceId, ImVec2 screen) {
                // The distance along the camera's axis: pbrt's focal distance.
            const query::ViewRay ray = query::view_ray(e.camera(), e.viewport.film_point(screen), e.film_aspect());
            const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
            if (hits.empty()) {
                e.notices.add(LogLevel::info, "There is nothing to focus on");
                return;
            }
            const glm::dmat4& place = e.scene_camera().camera_to_world; // the view may differ from it
            const double away = glm::dot(hits[0].position - glm::dvec3(place[3]), glm::normalize(glm::dvec3(place[2])));
            if (!(away > 0)) {
                e.notices.add(LogLevel::info, "That is behind the scene's camera: set the camera to this view first");
                return;
            }
            e.edit([t = float(away)](const scene::Scene& s) {
                const scene::Camera* now = s.cameras.find(s.active_camera.value);
                if (!now) return Result<scene::Edit>(fail("the scene has no camera"));
                scene::Camera camera = *now;
                camera.focal_distance = t;
                return scene::set_camera(s, s.active_camera.value, camera, "Focus");
            });
        }};
}

} // namespace restage::editor
