// SPDX-License-Identifier: Apache-2.0
// Guides over the picture: the grid on the floor, the axes in the corner, and what a layer means.
#include "opening.hpp"
#include "panel_context.hpp"
#include "query/measure.hpp"
#include "query/navigation.hpp"
#include "scene/bounds.hpp"
#include "scene/projection.hpp"
#include "theme.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace restage::editor {

namespace {

constexpr int half_lines = 16; // of the grid, to each side of its centre
constexpr const char* axis_names[] = {"x", "y", "z"};

// The world axis that it is along.
int axis_of(const glm::dvec3& direction) {
    return std::abs(direction.x) > 0.5 ? 0 : std::abs(direction.y) > 0.5 ? 1 : 2;
}

} // namespace

void Viewport::draw_grid(PanelContext& e) {
    if (!e.view.show_grid || !drawn_ || scene::is_spherical(e.camera())) return;
    if (std::exchange(world_of_, e.scene().clock) != e.scene().clock) world_ = scene::world_bounds(e.scene());
    if (world_.empty()) return;
    const int up = axis_of(e.up()), across[] = {(up + 1) % 3, (up + 2) % 3};
    const double step = query::grid_step(std::max({world_.size()[across[0]], world_.size()[across[1]], 1e-6}));
    const double lowest = e.up()[up] > 0 ? world_.lower[up] : world_.upper[up];
    const double floor = world_.lower[up] <= 0 && world_.upper[up] >= 0 ? 0 : lowest;
    const glm::dvec3 centre = glm::round(world_.center() / step) * step;
    const scene::Camera& camera = e.camera();
    const double aspect = e.film_aspect();
    const glm::dvec3 eye(camera.camera_to_world[3]);
    const bool parallel = camera.projection == scene::Projection::orthographic;
    const render::FilmImage& image = drawn_->image;
    struct Node {
        ImVec2 at;
        bool visible; // before the camera, and no surface is before it
    };
    const auto node = [&](const glm::dvec3& world) -> Node {
        const glm::dvec3 p = query::project(camera, world, aspect);
        const ImVec2 at(corner.x + float(p.x) * size.x, corner.y + float(p.y) * size.y);
        if (!(p.z > 1e-4 * step)) return {at, false};
        if (p.x < 0 || p.y < 0 || p.x >= 1 || p.y >= 1) return {at, true}; // clipped when drawn
        const auto x = std::size_t(p.x * image.width), y = std::size_t(p.y * image.height);
        const float depth = image.depth[y * image.width + x]; // a distance along the ray
        const double away = parallel ? p.z : glm::length(world - eye);
        return {at, !(depth > 0) || away <= double(depth) * 1.005 + 0.1 * step}; // rugs are thin
    };
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
    const float thick = std::max(1.f, ImGui::GetStyle().FontScaleMain);
    for (int direction = 0; direction < 2; ++direction) {
        const int along = across[direction], beside = across[1 - direction];
        for (int i = -half_lines; i <= half_lines; ++i) {
            glm::dvec3 world = centre;
            world[up] = floor;
            world[beside] += i * step;
            const auto number = std::lround(world[beside] / step); // of the line, from the origin
            const ImVec4& color = number == 0 ? colors::axes[along] : ImGui::GetStyleColorVec4(ImGuiCol_Text);
            const float strength = number == 0 ? 0.9f : number % 5 == 0 ? 0.65f : 0.3f;
            constexpr int pieces = 2; // to a step
            Node last{};
            for (int j = -half_lines * pieces; j <= half_lines * pieces; ++j) {
                world[along] = centre[along] + j * step / pieces;
                const Node now = node(world);
                const float fade = 1 - std::hypot(float(i), float(j) / pieces) / half_lines;
                if (j > -half_lines * pieces && now.visible && last.visible && fade > 0) {
                    const float alpha = strength * std::min(2 * fade, 1.f);
                    draw->AddLine({last.at.x, last.at.y + thick}, {now.at.x, now.at.y + thick},
                                  faded(colors::over_picture, 0.6f * alpha), thick); // for bright floors
                    draw->AddLine(last.at, now.at, faded(color, alpha), thick);
                }
                last = now;
            }
        }
    }
    draw->PopClipRect();
}

void Viewport::draw_axes(PanelContext& e) {
    const float scale = ImGui::GetStyle().FontScaleMain, radius = 30 * scale, ball = 9 * scale;
    if (!e.view.show_axes || !e.view.show_overlays || !picture_.ready() || std::min(size.x, size.y) < 6 * radius)
        return;
    const ImVec2 c(corner.x + size.x - radius - 18 * scale, corner.y + radius + 18 * scale);
    // Handles come first: ImGuizmo ignores clicks on what is under an item.
    if (const scene::Bounds box = e.selection.bounds(e.scene()); !box.empty() && e.view.gizmo != GizmoMode::select) {
        const glm::dvec3 p = query::project(e.camera(), box.center(), e.film_aspect());
        const double reach = 0.15 * double(size.x) + double(radius + ball);
        if (std::hypot(double(corner.x) + p.x * double(size.x) - double(c.x),
                       double(corner.y) + p.y * double(size.y) - double(c.y)) < reach)
            return;
    }
    const glm::dmat4& camera = e.camera().camera_to_world;
    struct End {
        int axis;
        double sign, away; // from the viewer
        ImVec2 at;
    };
    std::array<End, 6> ends;
    for (int i = 0; i < 6; ++i) {
        const int axis = i / 2;
        const double sign = i % 2 ? -1 : 1;
        glm::dvec3 local; // the direction in the camera's frame
        for (int k = 0; k < 3; ++k)
            local[k] = sign * glm::normalize(glm::dvec3(camera[k]))[axis];
        ends[std::size_t(i)] = {axis, sign, local.z, {c.x + float(local.x) * radius, c.y - float(local.y) * radius}};
    }
    std::ranges::sort(ends, {}, &End::away);
    const End* hovered = nullptr;
    for (const End& end : ends) { // the nearest first: it takes the mouse
        const std::string name = std::string(end.sign < 0 ? "-" : "") + axis_names[end.axis];
        ImGui::SetCursorScreenPos({end.at.x - ball, end.at.y - ball});
        if (ImGui::InvisibleButton(("axes." + name).c_str(), {2 * ball, 2 * ball})) {
            glm::dvec3 from(0);
            from[end.axis] = end.sign;
            scene::Camera moved = e.camera();
            query::look_along(moved, pivot(e), from, e.up());
            e.look_from(moved.camera_to_world, {}, "Look along an axis");
        }
        if (ImGui::IsItemHovered()) hovered = &end;
        tip(("Look from " + name).c_str());
        e.mark("axes." + name);
    }
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddCircleFilled(c, radius + ball + 3 * scale, faded(colors::over_picture, hovered ? 0.7f : 0.45f));
    const ImU32 dark = ImGui::GetColorU32(ImGuiCol_WindowBg);
    for (auto end = ends.rbegin(); end != ends.rend(); ++end) { // the farthest first
        const ImVec4& color = colors::axes[end->axis];
        const bool here = hovered == &*end;
        if (end->sign > 0) draw->AddLine(c, end->at, ImGui::GetColorU32(color), 2 * scale);
        if (end->sign > 0 || here)
            draw->AddCircleFilled(end->at, ball,
                                  ImGui::GetColorU32(here ? ImGui::GetStyleColorVec4(ImGuiCol_Text) : color));
        else
            draw->AddCircleFilled(end->at, ball * 0.7f, faded(color, 0.45f));
        if (end->sign < 0 && !here) continue;
        const char* name = axis_names[end->axis];
        const ImVec2 extent = ImGui::CalcTextSize(name);
        draw->AddText({end->at.x - extent.x / 2, end->at.y - extent.y / 2}, dark, name);
    }
}

namespace {

// The colours of the scale from end to end, and numbers below.
void draw_legend(PanelContext& e, const view::Scale& scale) {
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight() * 0.7f;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    constexpr int parts = 4; // as many as its colours have steps
    for (int i = 0; i < parts; ++i) {
        const float x0 = at.x + width * float(i) / parts, x1 = at.x + width * float(i + 1) / parts;
        const ImU32 left = view::scale_color(float(i) / parts), right = view::scale_color(float(i + 1) / parts);
        draw->AddRectFilledMultiColor({x0, at.y}, {x1, at.y + height}, left, right, right, left);
    }
    ImGui::Dummy({width, height});
    e.mark("layer.legend");
    const auto value = [&](float part) {
        return scale.logarithmic ? scale.dark * std::pow(scale.bright / scale.dark, part)
                                 : scale.dark + part * (scale.bright - scale.dark);
    };
    const std::string first = fmt::format("{:.3g}{}", value(0), scale.unit),
                      last = fmt::format("{:.3g}{}", value(1), scale.unit), middle = fmt::format("{:.3g}", value(0.5f));
    const float y = ImGui::GetCursorPosY(), x = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(first.c_str());
    ImGui::SetCursorPos({x + (width - ImGui::CalcTextSize(middle.c_str()).x) / 2, y});
    ImGui::TextUnformatted(middle.c_str());
    ImGui::SetCursorPos({x + width - ImGui::CalcTextSize(last.c_str()).x, y});
    ImGui::TextUnformatted(last.c_str());
}

} // namespace

void Viewport::draw_layer_note(PanelContext& e) {
    if (e.view.display.layer == view::picture_layer || !e.view.show_overlays || !drawn_ || e.opening().running())
        return;
    const float scale = ImGui::GetStyle().FontScaleMain;
    const view::LayerChoice& layer = view::layer_choice(e.view.display.layer);
    ImGui::SetCursorScreenPos({corner.x + 8 * scale, corner.y + 8 * scale});
    ImGui::BeginChild("layer", {std::min(250 * scale, size.x - 16 * scale), 0},
                      ImGuiChildFlags_Borders | ImGuiChildFlags_AutoResizeY);
    ImGui::TextColored(colors::accent, "%s", layer.label);
    ImGui::TextWrapped("%s", layer.about);
    if (e.view.display.layer == view::error_layer && drawn_->image.samples < 2)
        warning_note("It is known from two samples per pixel on");
    else if (scale_.dark != scale_.bright)
        draw_legend(e, scale_);
    const std::string key = e.action_state("show.picture").key;
    if (ImGui::Button(fmt::format("Back to the picture ({})", key).c_str())) e.view.display.layer = view::picture_layer;
    e.mark("layer.back");
    ImGui::EndChild();
}

} // namespace restage::editor
