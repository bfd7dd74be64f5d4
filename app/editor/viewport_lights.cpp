// SPDX-License-Identifier: Apache-2.0
// Lights without a surface as overlays: clickable marks, and the cone of a spot.
#include "panel_context.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/edits.hpp"
#include "theme.hpp"
#include "viewport.hpp"

#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>

namespace restage::editor {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr std::size_t rim_points = 48;

// A point's position on the screen; none behind the camera.
struct Cone {
    glm::dvec3 tip, x, y, z; // its axis is z
    double length = 1;
    glm::dvec3 rim(double radius, double turn) const {
        return tip + z * length + (x * std::cos(turn) + y * std::sin(turn)) * radius;
    }
};

// Extends to the surface it lights; shorter for wide ones, whose rim would be far away.
Cone cone_of(const PanelContext& e, const scene::Light& light) {
    const glm::dmat4& m = light.light_to_world;
    Cone cone{.tip = glm::dvec3(m[3]), .x = {}, .y = {}, .z = glm::normalize(glm::dvec3(m[2]))};
    cone.x = glm::normalize(std::abs(cone.z.x) < 0.9 ? glm::cross(cone.z, glm::dvec3(1, 0, 0))
                                                     : glm::cross(cone.z, glm::dvec3(0, 1, 0)));
    cone.y = glm::cross(cone.z, cone.x);
    const scene::Bounds all = scene::world_bounds(e.scene());
    const double reach = all.empty() ? 1 : std::max(all.radius(), 1e-6);
    const auto hits = query::raycast_all(e.scene(), cone.tip, cone.z);
    cone.length = hits.empty() ? reach * 0.5 : std::min(hits[0].t, reach);
    const double radius = cone.length * std::tan(glm::radians(std::min(double(light.cone_angle), 80.0)));
    if (radius > reach) cone.length *= reach / radius;
    return cone;
}

} // namespace

scene::Id<scene::Light> Viewport::light_at(const PanelContext& e, ImVec2 screen) const {
    scene::Id<scene::Light> found;
    const float r = 9 * ImGui::GetStyle().FontScaleMain;
    e.scene().lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (!scene::light_row(light.kind).placed) return;
        if (const auto c = on_screen(e, glm::dvec3(light.light_to_world[3]));
            c && std::hypot(c->x - screen.x, c->y - screen.y) < r)
            found = id;
    });
    return found;
}

void Viewport::draw_lights(PanelContext& e) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float scale = ImGui::GetStyle().FontScaleMain, r = 6 * scale;
    draw->PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
    e.scene().lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (!scene::light_row(light.kind).placed) return;
        const auto c = on_screen(e, glm::dvec3(light.light_to_world[3]));
        if (!c) return;
        const ImU32 color = ImGui::GetColorU32(id == e.selection.light() ? colors::selected
                                               : light.hidden            ? colors::lamp_off
                                                                         : colors::lamp);
        draw->AddCircle(*c, r, color, 0, 2 * scale);
        for (int i = 0; i < 8; ++i) {
            const float a = float(i) * 0.785398f;
            draw->AddLine({c->x + std::cos(a) * r * 1.3f, c->y + std::sin(a) * r * 1.3f},
                          {c->x + std::cos(a) * r * 1.8f, c->y + std::sin(a) * r * 1.8f}, color, 1.5f * scale);
        }
    });
    const scene::Light* chosen = e.scene().lights.find(e.selection.light());
    const bool cone = chosen && scene::light_row(chosen->kind).cone;
    if (cone) draw_cone(e, e.selection.light());
    if (!cone) cone_held_ = false;
    draw->PopClipRect();
}

void Viewport::draw_cone(PanelContext& e, scene::Id<scene::Light> id) {
    const scene::Light& light = e.scene().lights[id];
    const Cone cone = cone_of(e, light);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const auto line = [&](const glm::dvec3& a, const glm::dvec3& b, ImU32 color) {
        const auto from = on_screen(e, a), to = on_screen(e, b);
        if (from && to) draw->AddLine(*from, *to, color, 1.5f * ImGui::GetStyle().FontScaleMain);
    };
    const auto radius = [&](double angle) { return cone.length * std::tan(glm::radians(std::min(angle, 80.0))); };
    const auto rim = [&](double angle, ImU32 color) {
        for (std::size_t i = 0; i < rim_points; ++i)
            line(cone.rim(radius(angle), 2 * pi * double(i) / rim_points),
                 cone.rim(radius(angle), 2 * pi * double(i + 1) / rim_points), color);
    };
    const ImU32 bright = ImGui::GetColorU32(colors::selected), dim = faded(colors::selected, 0.45f);
    rim(double(light.cone_angle), bright);
    if (light.cone_delta > 0)
        rim(std::max(0.0, double(light.cone_angle - light.cone_delta)), dim); // where it begins to fade
    for (const double turn : {0.0, 0.5 * pi, pi, 1.5 * pi})
        line(cone.tip, cone.rim(radius(double(light.cone_angle)), turn), dim);

    // Its handle, at the rightmost point of the rim in the picture: dragging it outwards widens the cone.
    std::optional<ImVec2> handle;
    for (std::size_t i = 0; i < rim_points; ++i)
        if (const auto at = on_screen(e, cone.rim(radius(double(light.cone_angle)), 2 * pi * double(i) / rim_points));
            at && (!handle || at->x > handle->x) && at->x < corner.x + size.x - 8 && at->y > corner.y &&
            at->y < corner.y + size.y)
            handle = at;
    if (!handle) return;
    const float half = 7 * ImGui::GetStyle().FontScaleMain;
    ImGui::SetCursorScreenPos({handle->x - half, handle->y - half});
    ImGui::InvisibleButton("cone", {2 * half, 2 * half});
    const bool over = ImGui::IsItemHovered() || ImGui::IsItemActive();
    draw->AddCircleFilled(*handle, half * (over ? 0.8f : 0.6f),
                          ImGui::GetColorU32(over ? colors::pointed : colors::selected));
    e.mark("light.cone_handle");
    if (over) ImGui::SetTooltip("Cone %.1f°", double(light.cone_angle));
    if (!ImGui::IsItemActive()) {
        cone_held_ = false;
        return;
    }
    if (cancelled_) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!cone_held_ && !ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3)) return;
    cone_held_ = true;
    // The mouse position on the plane of the rim.
    const query::ViewRay ray = query::view_ray(e.camera(), film_point(mouse), e.film_aspect());
    const double t = glm::dot(cone.tip + cone.z * cone.length - ray.origin, cone.z) / glm::dot(ray.direction, cone.z);
    if (!std::isfinite(t) || t <= 0) return;
    const double away = glm::length(ray.origin + t * ray.direction - (cone.tip + cone.z * cone.length));
    auto angle = float(std::clamp(glm::degrees(std::atan2(away, cone.length)), 0.1, 80.0));
    if (const float step = e.view.snap_angle; ImGui::GetIO().KeyCtrl && step > 0)
        angle = std::clamp(std::round(angle / step) * step, std::min(step, 80.f), 80.f);
    e.edit(
        [id, angle](const scene::Scene& s) {
            const scene::Light* now = s.lights.find(id);
            if (!now) return Result<scene::Edit>(fail("the light no longer exists"));
            scene::Light changed = *now;
            changed.cone_angle = angle;
            changed.cone_delta = std::min(changed.cone_delta, angle);
            return scene::set_light(s, id, changed, "Cone of " + now->name);
        },
        "cone");
}

} // namespace restage::editor
