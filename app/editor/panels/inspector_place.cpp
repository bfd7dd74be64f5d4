// SPDX-License-Identifier: Apache-2.0
// Inspector, place: an object's position, rotation and size, about the centre of its box, as with the handles in the
// picture. Shear is kept and not shown. For several objects: changes relative to their current places.
#include "inspector.hpp"
#include "scene/edits.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

struct Parts { // of an affine transform: m = translate(pivot) * rotation * (shear and scale) about the object's own
               // pivot
    glm::dvec3 pivot{0}, scale{1}, euler{0}; // euler [deg]: about z after y after x
    glm::dmat3 rotation{1};
};

glm::dmat3 rotation_from(const glm::dvec3& degrees) {
    const glm::dvec3 a = glm::radians(degrees);
    return glm::dmat3(glm::rotate(glm::dmat4(1), a.z, glm::dvec3(0, 0, 1)) *
                      glm::rotate(glm::dmat4(1), a.y, glm::dvec3(0, 1, 0)) *
                      glm::rotate(glm::dmat4(1), a.x, glm::dvec3(1, 0, 0)));
}

glm::dvec3 own_center(const scene::Scene& s, const scene::Instance& instance) {
    const scene::Mesh* mesh = s.meshes.find(instance.mesh);
    return mesh && mesh->data ? 0.5 * (glm::dvec3(mesh->data->lower) + glm::dvec3(mesh->data->upper)) : glm::dvec3(0);
}

Parts parts_of(const scene::Scene& s, const scene::Instance& instance) {
    const glm::dmat4& m = instance.object_to_world;
    Parts p;
    p.pivot = glm::dvec3(m * glm::dvec4(own_center(s, instance), 1));
    glm::dmat3 r(m);
    for (int i = 0; i < 3; ++i)
        p.scale[i] = glm::length(r[i]);
    if (glm::determinant(r) < 0) p.scale.x = -p.scale.x; // mirrored: attributed to x
    // Gram-Schmidt from the x axis.
    r[0] /= p.scale.x;
    r[1] /= p.scale.y;
    r[1] = glm::normalize(r[1] - r[0] * glm::dot(r[0], r[1]));
    r[2] = glm::cross(r[0], r[1]);
    p.rotation = r;
    // R = Rz Ry Rx: the third row's first entry is -sin y.
    p.euler.y = glm::degrees(std::asin(glm::clamp(-r[0][2], -1.0, 1.0)));
    if (std::abs(r[0][2]) < 1 - 1e-12) {
        p.euler.x = glm::degrees(std::atan2(r[1][2], r[2][2]));
        p.euler.z = glm::degrees(std::atan2(r[0][1], r[0][0]));
    } else { // gimbal lock: all of it about z
        p.euler.z = glm::degrees(std::atan2(-r[1][0], r[1][1]));
    }
    return p;
}

// The transform with another linear part whose own centre lands on `pivot`.
glm::dmat4 placed(const scene::Scene& s, const scene::Instance& instance, const glm::dmat3& linear,
                  const glm::dvec3& pivot) {
    glm::dmat4 m(linear);
    m[3] = glm::dvec4(pivot - linear * own_center(s, instance), 1);
    return m;
}

bool three(const char* id, glm::dvec3& v, double speed, const char* format) {
    return ImGui::DragScalarN(id, ImGuiDataType_Double, &v.x, 3, float(speed), nullptr, nullptr, format);
}

void ask_transform(EditContext& e, InstanceId id, const glm::dmat4& m, const char* verb, const char* gesture) {
    e.edit(
        [id, m, verb](const scene::Scene& s) {
            auto edit = scene::set_transform(s, id, m);
            if (edit) edit->label = std::string(verb) + " " + s.instances[id].name;
            return edit;
        },
        gesture);
}

void uniform_button(SelectContext& e) { // next to the scale fields
    InspectorState& state = e.panel_state->inspector;
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (icon_button("##uniform", state.uniform_scale ? Icon::lock : Icon::lock_open, state.uniform_scale,
                    state.uniform_scale ? "All three change together. Click to change them separately"
                                        : "Click to change all three together"))
        state.uniform_scale = !state.uniform_scale;
    e.mark("inspector.uniform");
}

void one_object(SelectContext& e, InstanceId id) {
    InspectorState& state = e.panel_state->inspector;
    const scene::Scene& s = e.scene();
    const scene::Instance& instance = s.instances[id];
    Parts p = parts_of(s, instance);
    const glm::dmat3 linear(instance.object_to_world);
    const scene::Bounds bounds = scene::world_bounds(s, id);
    const double size = bounds.empty() ? 1 : std::max(bounds.radius(), 1e-6);

    form_row("Position", "x, y, z of the object's centre, in scene units");
    if (three("##position", p.pivot, size * 0.005, "%.3f"))
        ask_transform(e, id, placed(s, instance, linear, p.pivot), "Move", "inspector.position");
    e.mark("inspector.position");

    // The user's angles are shown as long as they represent the current rotation, as angles are not unique.
    if (state.euler_of == id && state.euler) {
        const glm::dmat3 same = rotation_from(*state.euler);
        double off = 0;
        for (int c = 0; c < 3; ++c)
            off = std::max(off, glm::length(same[c] - p.rotation[c]));
        if (off < 1e-6) p.euler = *state.euler;
    }
    form_row("Rotation", "Rotation about x, then y, then z");
    glm::dvec3 euler = p.euler + 0.0; // no negative zero
    if (three("##rotation", euler, 0.5, "%.1f°")) {
        state.euler = euler;
        state.euler_of = id;
        ask_transform(e, id, placed(s, instance, rotation_from(euler) * glm::transpose(p.rotation) * linear, p.pivot),
                      "Rotate", "inspector.rotation");
    }
    e.mark("inspector.rotation");

    form_row("Scale", "Along the object's own axes", ImGui::GetFrameHeight());
    glm::dvec3 scale = p.scale;
    if (three("##scale", scale, 0.005, "%.3f")) {
        glm::dvec3 ratio = scale / p.scale;
        if (state.uniform_scale) // the changed one determines the others
            for (int i = 0; i < 3; ++i)
                if (scale[i] != p.scale[i]) ratio = glm::dvec3(ratio[i]);
        if (glm::all(glm::greaterThan(glm::abs(ratio), glm::dvec3(1e-6)))) {
            glm::dmat3 scaled = linear;
            for (int i = 0; i < 3; ++i)
                scaled[i] *= ratio[i];
            ask_transform(e, id, placed(s, instance, scaled, p.pivot), "Scale", "inspector.scale");
        }
    }
    e.mark("inspector.scale");
    uniform_button(e);

    if (!bounds.empty()) {
        form_row("Size", "Of its bounding box, along the world's axes, in scene units");
        ImGui::TextDisabled("%.3g × %.3g × %.3g", bounds.size().x, bounds.size().y, bounds.size().z);
    }
    if (flow_button("Reset rotation", true)) {
        state.euler.reset();
        ask_transform(e, id, placed(s, instance, glm::transpose(p.rotation) * linear, p.pivot), "Straighten", "");
    }
    e.mark("inspector.reset_rotation");
    if (flow_button("Reset scale")) {
        glm::dmat3 unscaled = linear;
        for (int i = 0; i < 3; ++i)
            unscaled[i] /= std::abs(p.scale[i]);
        ask_transform(e, id, placed(s, instance, unscaled, p.pivot), "Unscale", "");
    }
    e.mark("inspector.reset_scale");
    const scene::Instance* opened = e.original() ? e.original()->instances.find(id) : nullptr;
    ImGui::BeginDisabled(!opened || opened->object_to_world == instance.object_to_world);
    if (flow_button("As opened") && opened) ask_transform(e, id, opened->object_to_world, "Put back", "");
    ImGui::EndDisabled();
    tip("Back to its place when the scene was opened");
    e.mark("inspector.as_opened");
}

void several_objects(SelectContext& e) {
    auto& r = e.panel_state->inspector.relative;
    const scene::Bounds bounds = e.selection.bounds(e.scene());
    const double size = bounds.empty() ? 1 : std::max(bounds.radius(), 1e-6);
    bool changed = false, active = false;
    const auto field = [&](const char* label, const char* id, const char* tooltip, glm::dvec3& v, double speed,
                           const char* format, const char* mark) {
        form_row(label, tooltip, &v == &r.scale ? ImGui::GetFrameHeight() : 0);
        const bool dragged = three(id, v, speed, format);
        if (ImGui::IsItemActivated()) { // a drag begins: changes count from here
            r.start.clear();
            for (const InstanceId one : e.selection.instances())
                r.start.emplace_back(one, e.scene().instances[one].object_to_world);
            r.pivot = bounds.empty() ? glm::dvec3(0) : bounds.center();
        }
        changed |= dragged;
        active |= ImGui::IsItemActive();
        e.mark(mark);
    };
    const double before_scale[3] = {r.scale.x, r.scale.y, r.scale.z};
    field("Move by", "##move", "x, y, z in scene units", r.move, size * 0.005, "%.3f", "inspector.move_by");
    field("Turn by", "##turn", "About their common centre: about x, then y, then z", r.turn, 0.5, "%.1f°",
          "inspector.turn_by");
    field("Scale by", "##scale", "From their common centre", r.scale, 0.005, "%.3f", "inspector.scale_by");
    uniform_button(e);
    if (e.panel_state->inspector.uniform_scale)
        for (int i = 0; i < 3; ++i)
            if (r.scale[i] != before_scale[i]) {
                r.scale = glm::dvec3(r.scale[i]);
                break;
            }
    if (changed && glm::all(glm::greaterThan(glm::abs(r.scale), glm::dvec3(1e-6)))) {
        const glm::dmat4 by = glm::translate(glm::dmat4(1), r.pivot + r.move) * glm::dmat4(rotation_from(r.turn)) *
                              glm::scale(glm::dmat4(1), r.scale) * glm::translate(glm::dmat4(1), -r.pivot);
        e.edit(
            [by, start = r.start](const scene::Scene& s) {
                scene::Edit edit{fmt::format("Move {} objects", start.size()), {}};
                for (const auto& [id, from] : start) {
                    auto one = scene::set_transform(s, id, by * from);
                    if (!one) return one;
                    edit.changes.insert(edit.changes.end(), one->changes.begin(), one->changes.end());
                }
                return Result<scene::Edit>(std::move(edit));
            },
            "inspector.relative");
    }
    if (!active && !changed) r = {}; // the fields start again at "no change"
    if (!bounds.empty()) {
        form_row("Size", "Of their common bounding box, in scene units");
        ImGui::TextDisabled("%.3g × %.3g × %.3g", bounds.size().x, bounds.size().y, bounds.size().z);
    }
}

} // namespace

void place_section(SelectContext& e) {
    const bool open = section_header("Place", true);
    e.mark("inspector.place");
    if (!open) return;
    ImGui::PushID("place");
    if (e.selection.instances().size() > 1)
        several_objects(e);
    else
        one_object(e, e.selection.active());
    ImGui::PopID();
}

} // namespace restage::editor
