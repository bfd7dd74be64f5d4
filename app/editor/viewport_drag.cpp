// SPDX-License-Identifier: Apache-2.0
// Dragging what is selected by itself, or by the knob between its handles: it slides over the floor, at its height, and
// stays under the mouse. Handles that point at the viewer are too short to drag; this never is.
#include "editor.hpp"
#include "pick_tool.hpp"
#include "session/navigation.hpp"
#include "session/raycast.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

constexpr double farthest = 8; // times the distance at which it was taken up, so that the horizon is not reached

// Where the ray through that point of the screen meets the plane through `at`.
std::optional<glm::dvec3> on_plane(const session::ViewRay& ray, const glm::dvec3& at, const glm::dvec3& normal) {
    const double slope = glm::dot(ray.direction, normal);
    const double t = glm::dot(at - ray.origin, normal) / slope;
    if (!std::isfinite(t) || t <= 0) return std::nullopt;
    const double taken = glm::length(at - ray.origin), now = t * glm::length(ray.direction);
    if (now > farthest * taken) return std::nullopt;
    return ray.origin + t * ray.direction;
}

// On the knob in the middle of the handles (gizmo.cpp).
bool on_knob(const Editor& e, const Viewport& v, ImVec2 screen) {
    const glm::dvec3 p = session::project(e.camera(), e.gizmo_drag.pivot, e.film_aspect());
    return e.view.show_overlays && p.z > 0 && std::abs(v.corner.x + float(p.x) * v.size.x - screen.x) <= 10 &&
           std::abs(v.corner.y + float(p.y) * v.size.y - screen.y) <= 10;
}

} // namespace

bool Viewport::can_drag(const Editor& e, ImVec2 screen) const {
    return e.view.gizmo == GizmoMode::move && !e.selection.empty() &&
           (on_knob(e, *this, screen) || e.selection.contains(picked_at(e, screen)));
}

void Viewport::start_sliding(Editor& e, ImVec2 screen) {
    const session::ViewRay ray = session::view_ray(e.camera(), film_point(screen), e.film_aspect());
    const auto hits = session::raycast_all(e.scene(), ray.origin, ray.direction,
                                           [&](InstanceId id) { return !e.selection.contains(id); });
    if (hits.empty() && !on_knob(e, *this, screen)) return;
    grabbed_ = hits.empty() ? e.gizmo_drag.pivot : hits[0].position;
    begin_drag(e, slide_, ImGui::GetIO().KeyShift);
}

void Viewport::slide(Editor& e) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        grabbed_.reset();
        slide_ = {};
        e.end_gesture();
        return;
    }
    const session::ViewRay ray = session::view_ray(e.camera(), film_point(io.MousePos), e.film_aspect());
    const auto to = on_plane(ray, *grabbed_, e.up());
    if (!to) return;
    glm::dvec3 by = *to - *grabbed_;
    if (io.KeyCtrl && e.view.snap_move > 0) by = glm::round(by / double(e.view.snap_move)) * double(e.view.snap_move);
    ask_drag(e, slide_, glm::translate(glm::dmat4(1), by), "Move");
}

} // namespace restage::editor
