// SPDX-License-Identifier: Apache-2.0
// Dragging what is selected by itself, or by the knob between its handles: it slides over the floor, at its height, and
// stays under the mouse. Handles that point at the viewer are too short to drag; this never is.
#include "editor.hpp"
#include "pick_tool.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"

#include <imgui_internal.h>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

DragPath::Mouse mouse_at(const Editor& e, const Viewport& v, ImVec2 screen) {
    return {query::view_ray(e.camera(), v.film_point(screen), e.film_aspect()),
            glm::normalize(glm::dvec3(e.camera().camera_to_world[1]))};
}

} // namespace

bool Viewport::can_drag(const Editor& e, ImVec2 screen) const {
    return e.view.gizmo == GizmoMode::move && !e.selection.empty() &&
           (on_knob_ || e.selection.contains(picked_at(e, screen)));
}

void Viewport::start_sliding(Editor& e, ImVec2 screen) {
    const DragPath::Mouse mouse = mouse_at(e, *this, screen);
    const auto hits = query::raycast_all(e.scene(), mouse.ray.origin, mouse.ray.direction,
                                         [&](InstanceId id) { return !e.selection.contains(id); });
    if (hits.empty() && !on_knob_) return;
    begin_drag(e, slide_, ImGui::GetIO().KeyShift);
    slide_.path.begin(hits.empty() ? e.gizmo_drag.pivot : hits[0].position, e.up(), mouse, false);
}

void Viewport::slide(Editor& e) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        slide_ = {};
        e.end_gesture();
        return;
    }
    const glm::dvec3 by = slide_.path.update(io.KeyAlt, mouse_at(e, *this, io.MousePos), std::nullopt,
                                             io.KeyCtrl ? double(e.view.snap_move) : 0);
    ask_drag(e, slide_, glm::translate(glm::dmat4(1), by), "Move");
}

bool Viewport::dragging(const Editor& e) const {
    return slide_.active || e.gizmo_drag.active || boxing_ || sticking_ || cone_held_;
}

void Viewport::cancel(Editor& e) {
    cancel_drag(e, slide_);
    cancel_drag(e, e.gizmo_drag);
    if (sticking_ || cone_held_) e.later([&e] { e.session_for_changes().cancel_gesture(); });
    release_gizmo();
    pressed_ = boxing_ = sticking_ = on_knob_ = false;
    if (std::exchange(cone_held_, false)) ImGui::ClearActiveID();
    cancelled_ = true;
}

} // namespace restage::editor
