// SPDX-License-Identifier: Apache-2.0
#include "gizmo.hpp"

#include "collide_drag.hpp"
#include "panel_context.hpp"
#include "query/navigation.hpp"
#include "scene/projection.hpp"
#include "snap_drag.hpp"
#include "viewport.hpp"

#include <ImGuizmo.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace restage::editor {

namespace {

constexpr float knob_pixels = 10; // half of its side, as ImGuizmo draws it
constexpr float handle_pixels = 90; // of a handle perpendicular to the view; handles towards the viewer are shorter

glm::dmat3 rotation_of(const glm::dmat4& m) {
    glm::dmat3 r(m);
    for (int i = 0; i < 3; ++i)
        r[i] = glm::length(r[i]) > 0 ? glm::normalize(r[i]) : glm::dmat3(1)[i];
    // Handles need an orthogonal frame, even for sheared objects.
    r[1] = glm::normalize(r[1] - r[0] * glm::dot(r[0], r[1]));
    r[2] = glm::cross(r[0], r[1]);
    return r;
}

DragPath::Mouse mouse_of(const PanelContext& e) {
    const ImVec2 at = ImGui::GetIO().MousePos;
    return {query::view_ray(e.camera(), e.viewport.film_point(at), e.film_aspect()),
            glm::normalize(glm::dvec3(e.camera().camera_to_world[1]))};
}

} // namespace

void release_gizmo() {
    ImGuizmo::Enable(false); // the only way to cancel its drag
    ImGuizmo::Enable(true);
}

GizmoState draw_gizmo(PanelContext& e, ImVec2 corner, ImVec2 size) {
    Drag& drag = e.viewport.gizmo_drag;
    // Handles are straight, but the view of a spherical camera is not. The camera's panel explains this.
    if (e.selection.empty() || e.view.gizmo == GizmoMode::select || scene::is_spherical(e.camera())) {
        drag = {};
        return {};
    }
    const scene::Scene& s = e.scene();
    const scene::Camera& camera = e.camera();
    const scene::Light* light = s.lights.find(e.selection.light());
    if (!drag.active) {
        const InstanceId active = e.selection.active();
        const bool single = e.selection.instances().size() == 1;
        drag.pivot = light ? glm::dvec3(light->light_to_world[3]) : e.selection.bounds(s).center();
        const glm::dmat4* own = light    ? &light->light_to_world
                                : single ? &s.instances[active].object_to_world
                                         : nullptr;
        // Scaling along world axes would shear a rotated object, so a single object is always scaled along its own
        // axes.
        const bool local = own && (e.view.local_axes || e.view.gizmo == GizmoMode::scale);
        drag.frame = glm::dmat4(local ? rotation_of(*own) : glm::dmat3(1));
        drag.frame[3] = glm::dvec4(0, 0, 0, 1);
        drag.current = glm::mat4(drag.frame);
    }

    // Relative to the pivot: float matrices are then exact enough anywhere in the world. OpenGL cameras look along -z.
    glm::dmat4 to_world = camera.camera_to_world;
    to_world[3] -= glm::dvec4(drag.pivot, 0);
    const glm::mat4 view(glm::scale(glm::dmat4(1), glm::dvec3(1, 1, -1)) * glm::affineInverse(to_world));
    const glm::dvec4 window = scene::film_window(camera, e.film_aspect());
    const double reach = glm::length(glm::dvec3(to_world[3])) + 1e-6;
    const double near = reach * 1e-3, far = reach * 1e3;
    const bool parallel = camera.projection == scene::Projection::orthographic;
    const glm::mat4 projection(
        parallel ? glm::orthoRH_NO(window.x, window.y, window.z, window.w, near, far)
                 : glm::frustumRH_NO(window.x * near, window.y * near, window.z * near, window.w * near, near, far));

    const ImGuiIO& io = ImGui::GetIO();
    // Its own highlight is the orange of our outlines, half transparent.
    ImGuizmo::GetStyle().Colors[ImGuizmo::SELECTION] = {1.f, 0.95f, 0.35f, 1.f};
    ImGuizmo::SetDrawlist();
    ImGuizmo::SetRect(corner.x, corner.y, size.x, size.y);
    ImGuizmo::SetOrthographic(parallel);
    ImGuizmo::AllowAxisFlip(false);
    const float handle_size = // of the picture's half width
        std::clamp(2 * handle_pixels * ImGui::GetStyle().FontScaleMain / size.x, 0.1f, 0.6f);
    ImGuizmo::SetGizmoSizeClipSpace(handle_size);
    const auto operation = e.view.gizmo == GizmoMode::move     ? ImGuizmo::TRANSLATE
                           : e.view.gizmo == GizmoMode::rotate ? ImGuizmo::ROTATE
                                                               : ImGuizmo::SCALE;
    const float step = e.view.gizmo == GizmoMode::move     ? e.view.snap_move
                       : e.view.gizmo == GizmoMode::rotate ? e.view.snap_angle
                                                           : e.view.snap_scale;
    const float snap[3] = {step, step, step};
    // ImGuizmo's knob in the middle would move things in the screen plane, off the floor: instead, as for drags of
    // the object itself, the viewport slides them over the floor (viewport_drag.cpp). ImGuizmo ignores clicks while an
    // item is under the mouse, so the knob is an item.
    const glm::dvec3 middle = query::project(camera, drag.pivot, e.film_aspect());
    const ImVec2 knob(corner.x + float(middle.x) * size.x, corner.y + float(middle.y) * size.y);
    GizmoState state;
    if (e.view.gizmo == GizmoMode::move && middle.z > 0 && !ImGuizmo::IsUsing() && knob.x > corner.x &&
        knob.y > corner.y && knob.x < corner.x + size.x && knob.y < corner.y + size.y) {
        ImGui::SetCursorScreenPos({knob.x - knob_pixels, knob.y - knob_pixels});
        ImGui::InvisibleButton("knob", {2 * knob_pixels, 2 * knob_pixels});
        state.knob = ImGui::IsItemHovered() || ImGui::IsItemActive();
    }
    const bool moved =
        ImGuizmo::Manipulate(glm::value_ptr(view), glm::value_ptr(projection), operation, ImGuizmo::LOCAL,
                             glm::value_ptr(drag.current), nullptr, io.KeyCtrl ? snap : nullptr);

    // A point on each handle, near its tip, for tests. A handle's length in the world is such that one perpendicular
    // to the view has the standard length on screen.
    const glm::dvec3 across =
        query::project(camera, drag.pivot + glm::normalize(glm::dvec3(camera.camera_to_world[0])), e.film_aspect());
    const double length = handle_size / 2 / std::max(std::abs(across.x - middle.x), 1e-9);
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 tip =
            query::project(camera, drag.pivot + glm::dvec3(drag.frame[i]) * (0.85 * length), e.film_aspect());
        e.mark(i == 0   ? "gizmo.x"
               : i == 1 ? "gizmo.y"
                        : "gizmo.z",
               {corner.x + float(tip.x) * size.x, corner.y + float(tip.y) * size.y});
    }
    e.mark("gizmo.center", knob);

    if (ImGuizmo::IsUsing() && !drag.active && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3)) {
        begin_drag(e, drag, io.KeyShift); // a click is not a drag
        drag.path.begin(drag.pivot, e.up(), mouse_of(e), true);
        if (e.view.gizmo == GizmoMode::move) {
            begin_snapping(e, drag, drag.pivot, mouse_of(e).ray);
            begin_colliding(e, drag);
        }
    }
    if (drag.active && (moved || io.KeyAlt)) {
        // The handles' change since the start, about the pivot.
        const glm::dmat4 there = glm::translate(glm::dmat4(1), drag.pivot);
        if (e.view.gizmo == GizmoMode::move) {
            const glm::dvec3 along(drag.current[3]);
            const glm::dvec3 free =
                drag.path.update(io.KeyAlt, mouse_of(e), along, io.KeyCtrl ? double(e.view.snap_move) : 0);
            glm::dvec3 by = free;
            bool straight = io.KeyAlt; // along one handle
            for (int i = 0; i < 3; ++i) // a handle of two axes does not snap
                if (const glm::dvec3 axis(drag.frame[i]);
                    std::abs(glm::dot(along, axis)) > 0.999 * glm::length(along)) {
                    by = snapped(e, drag, free, mouse_of(e).ray, axis);
                    straight = true;
                }
            by = collided(drag, by, straight, false);
            ask_drag(e, drag, glm::translate(glm::dmat4(1), by), "Move");
        } else {
            ask_drag(e, drag, there * glm::dmat4(drag.current) * glm::inverse(drag.frame) * glm::inverse(there),
                     e.view.gizmo == GizmoMode::rotate ? "Rotate" : "Scale");
        }
    }
    if (drag.active && !ImGuizmo::IsUsing()) {
        drag.active = false;
        e.end_gesture();
    }
    draw_snapping(e, drag);
    draw_colliding(e, drag);
    state.wants_mouse = ImGuizmo::IsUsing() || (ImGuizmo::IsOver() && !state.knob);
    return state;
}

} // namespace restage::editor
