// SPDX-License-Identifier: Apache-2.0
#include "gizmo.hpp"

#include "editor.hpp"
#include "session/navigation.hpp"

#include <ImGuizmo.h>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace restage::editor {

namespace {

constexpr float handle_size = 0.16f; // of the picture's half width

glm::dmat3 rotation_of(const glm::dmat4& m) {
    glm::dmat3 r(m);
    for (int i = 0; i < 3; ++i)
        r[i] = glm::length(r[i]) > 0 ? glm::normalize(r[i]) : glm::dmat3(1)[i];
    // Handles need a right-angled frame, whatever shear the object has.
    r[1] = glm::normalize(r[1] - r[0] * glm::dot(r[0], r[1]));
    r[2] = glm::cross(r[0], r[1]);
    return r;
}

Result<scene::Edit> place(const scene::Scene& s, const GizmoDrag& d, const glm::dmat4& by, const char* verb) {
    scene::Edit edit;
    for (const auto& [id, start] : d.start) {
        auto one = scene::set_transform(s, id, by * start);
        if (!one) return one;
        edit.changes.insert(edit.changes.end(), one->changes.begin(), one->changes.end());
    }
    const scene::Instance* first = d.start.empty() ? nullptr : s.instances.find(d.start[0].first);
    edit.label = std::string(verb) + " " +
                 (d.start.size() == 1 && first ? first->name : std::to_string(d.start.size()) + " objects");
    return edit;
}

} // namespace

bool draw_gizmo(Editor& e, ImVec2 corner, ImVec2 size) {
    GizmoDrag& drag = e.gizmo_drag;
    if (e.selection.empty() || e.view.gizmo == GizmoMode::select) {
        drag = {};
        return false;
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
        // Scaling along world axes would shear a turned object, so one object is always scaled along its own.
        const bool local = own && (e.view.local_axes || e.view.gizmo == GizmoMode::scale);
        drag.frame = glm::dmat4(local ? rotation_of(*own) : glm::dmat3(1));
        drag.frame[3] = glm::dvec4(0, 0, 0, 1);
        drag.current = glm::mat4(drag.frame);
    }

    // Relative to the pivot: float matrices are then exact enough anywhere in the world. OpenGL cameras look along -z.
    glm::dmat4 to_world = camera.camera_to_world;
    to_world[3] -= glm::dvec4(drag.pivot, 0);
    const glm::mat4 view(glm::scale(glm::dmat4(1), glm::dvec3(1, 1, -1)) * glm::affineInverse(to_world));
    const glm::dvec4 window = session::film_window(camera, e.film_aspect());
    const double reach = glm::length(glm::dvec3(to_world[3])) + 1e-6;
    const double near = reach * 1e-3, far = reach * 1e3;
    const glm::mat4 projection(
        glm::frustumRH_NO(window.x * near, window.y * near, window.z * near, window.w * near, near, far));

    const ImGuiIO& io = ImGui::GetIO();
    // Its own highlight is the orange of our outlines, half transparent.
    ImGuizmo::GetStyle().Colors[ImGuizmo::SELECTION] = {1.f, 0.95f, 0.35f, 1.f};
    ImGuizmo::SetDrawlist();
    ImGuizmo::SetRect(corner.x, corner.y, size.x, size.y);
    ImGuizmo::SetOrthographic(false);
    ImGuizmo::AllowAxisFlip(false);
    ImGuizmo::SetGizmoSizeClipSpace(handle_size);
    const auto operation = e.view.gizmo == GizmoMode::move     ? ImGuizmo::TRANSLATE
                           : e.view.gizmo == GizmoMode::rotate ? ImGuizmo::ROTATE
                                                               : ImGuizmo::SCALE;
    const float step = e.view.gizmo == GizmoMode::move     ? e.view.snap_move
                       : e.view.gizmo == GizmoMode::rotate ? e.view.snap_angle
                                                           : e.view.snap_scale;
    const float snap[3] = {step, step, step};
    const bool moved =
        ImGuizmo::Manipulate(glm::value_ptr(view), glm::value_ptr(projection), operation, ImGuizmo::LOCAL,
                             glm::value_ptr(drag.current), nullptr, io.KeyCtrl ? snap : nullptr);

    for (int i = 0; i < 3; ++i) { // the middle of each handle, for tests
        const glm::dvec3 a = session::project(camera, drag.pivot, e.film_aspect());
        const glm::dvec3 b =
            session::project(camera, drag.pivot + glm::dvec3(drag.frame[i]) * reach * 1e-3, e.film_aspect());
        const glm::dvec2 on_screen = glm::dvec2(b - a) * glm::dvec2(size.x, size.y);
        const glm::dvec2 tip =
            glm::dvec2(a) * glm::dvec2(size.x, size.y) +
            (glm::length(on_screen) > 0 ? glm::normalize(on_screen) : glm::dvec2(0)) * (0.6 * handle_size / 2 * size.x);
        e.mark(i == 0 ? "gizmo.x" : i == 1 ? "gizmo.y" : "gizmo.z", {corner.x + float(tip.x), corner.y + float(tip.y)});
    }

    if (ImGuizmo::IsUsing() && !drag.active) { // it begins
        drag.active = true;
        drag.copied = false;
        drag.start.clear();
        drag.light_start = light ? std::optional(light->light_to_world) : std::nullopt;
        if (io.KeyAlt && !light) {
            // Copies stay where the originals are; they are what is dragged on.
            const auto ids = e.selection.instances();
            auto made = scene::duplicate_instances(s, ids, glm::dmat4(1));
            if (made) {
                for (std::size_t i = 0; i < ids.size(); ++i)
                    drag.start.emplace_back(made->copies[i], s.instances[ids[i]].object_to_world);
                drag.copied = true;
                e.edit([edit = made->edit](const scene::Scene&) { return Result<scene::Edit>(edit); }, "gizmo");
                e.later([&e, copies = made->copies] { e.selection.set(copies); });
            }
        }
        if (!drag.copied)
            for (const InstanceId id : e.selection.instances())
                drag.start.emplace_back(id, s.instances[id].object_to_world);
    }
    if (drag.active && moved) {
        // What the handles did since the start, about the pivot.
        const glm::dmat4 there = glm::translate(glm::dmat4(1), drag.pivot);
        const glm::dmat4 by = there * glm::dmat4(drag.current) * glm::inverse(drag.frame) * glm::inverse(there);
        const char* verb = drag.copied                         ? "Copy"
                           : e.view.gizmo == GizmoMode::move   ? "Move"
                           : e.view.gizmo == GizmoMode::rotate ? "Rotate"
                                                               : "Scale";
        if (drag.light_start)
            e.edit(
                [id = e.selection.light(), m = by * *drag.light_start](const scene::Scene& now) {
                    scene::Light changed = now.lights[id];
                    changed.light_to_world = m;
                    return scene::set_light(now, id, changed, "Move light");
                },
                "gizmo");
        else
            e.edit([d = drag, by, verb](const scene::Scene& now) { return place(now, d, by, verb); }, "gizmo");
    }
    if (drag.active && !ImGuizmo::IsUsing()) {
        drag.active = false;
        e.end_gesture();
    }
    return ImGuizmo::IsUsing() || ImGuizmo::IsOver();
}

} // namespace restage::editor
