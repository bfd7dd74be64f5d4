// SPDX-License-Identifier: Apache-2.0
#include "viewport.hpp"

#include "exposure_legend.hpp"
#include "kept_pictures.hpp"
#include "opening.hpp"
#include "panel_context.hpp"
#include "panels/panels.hpp"
#include "panels/state.hpp"
#include "path_tool.hpp"
#include "pick_tool.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/development.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"

#include <ImGuizmo.h>
#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <set>

namespace restage::editor {

void draw_viewport(PanelContext& editor) { editor.viewport.draw(editor); }

void Viewport::draw(PanelContext& e) {
    ImGuizmo::BeginFrame();
    draw_toolbar(e);

    // The picture has the film's shape, as large as fits, on a darker ground.
    const ImVec2 space = ImGui::GetContentRegionAvail(), origin = ImGui::GetCursorScreenPos();
    const double aspect = e.film_aspect();
    size = {space.x, float(space.x / aspect)};
    if (size.y > space.y) size = {float(space.y * aspect), space.y};
    size = {std::max(std::floor(size.x), 16.f), std::max(std::floor(size.y), 16.f)};
    corner = {std::floor(origin.x + (space.x - size.x) / 2), std::floor(origin.y + (space.y - size.y) / 2)};
    const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
    e.set_picture_size(glm::max(
        glm::uvec2(size.x * pixels.x * e.view.resolution, size.y * pixels.y * e.view.resolution), glm::uvec2(16)));

    const ImVec2 end(corner.x + size.x, corner.y + size.y);
    update_textures(e);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(origin, {origin.x + space.x, origin.y + space.y}, ImGui::GetColorU32(ImGuiCol_DockingEmptyBg));
    if (picture_.ready()) {
        draw->AddRect({corner.x - 1, corner.y - 1}, {end.x + 1, end.y + 1},
                      ImGui::GetColorU32(ImGuiCol_FrameBgHovered));
        draw->AddImage(picture_.ref(), corner, end);
    } else if (e.scene().instances.live() == 0 && !e.opening().running()) {
        draw_welcome(e, origin, space);
    } else if (e.scene().instances.live() > 0) { // a picture is being prepared: draw_progress() shows its progress
        draw->AddRectFilled(corner, end, ImGui::GetColorU32(ImGuiCol_FrameBg));
    }
    GizmoState gizmo;
    if (e.view.show_overlays && picture_.ready()) {
        if (outline_.ready()) draw->AddImage(outline_.ref(), corner, end);
        draw_grid(e);
        draw_overlays(e);
        if (!measurement.on && !placing.on && !e.panel_state->arrange.drawing) gizmo = draw_gizmo(e, corner, size);
        if (cone_held_) gizmo.wants_mouse = true;
    }
    draw_comparison(e, corner, size);
    // Not a button: ImGuizmo ignores clicks while an item is hovered, or was a frame ago.
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy(size);
    e.mark("picture");
    accept_asset(e);
    if (e.view.display.layer != view::exposure_layer) draw_axes(e); // whose legend is there
    const bool over = (gizmo.knob || (ImGui::IsWindowHovered() && !ImGui::IsAnyItemHovered())) &&
                      ImGui::IsMouseHoveringRect(corner, end) && !cancelled_;
    if (cancelled_ && !ImGui::IsKeyDown(ImGuiKey_T) && !ImGui::IsAnyMouseDown()) cancelled_ = false;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) on_knob_ = gizmo.knob;
    if (dragging() && ImGui::IsMouseClicked(ImGuiMouseButton_Right))
        cancel(e);
    else
        navigate(e, over);
    stick(e, over);
    if (!sticking_) pick(e, over, gizmo);
    inspect_pixel(e, over);
    // The scene as it was opened, while O is held.
    e.show_original = over && ImGui::IsKeyDown(ImGuiKey_O) && !ImGui::GetIO().KeyShift && !ImGui::GetIO().KeyCtrl;
    draw_layer_note(e);
    draw_status(e);
    if (e.view.display.layer == view::exposure_layer) draw_exposure_legend(e, corner, size);
    draw_progress(e);
    draw_darkness(e);
    draw_hint(e);
    if (e.view.show_overlays) e.notices.draw(end.x, end.y - 28 * ImGui::GetStyle().FontScaleMain);
}

glm::dvec2 Viewport::film_point(ImVec2 screen) const {
    return {(screen.x - corner.x) / size.x, (screen.y - corner.y) / size.y};
}

std::optional<ImVec2> Viewport::on_screen(const SelectContext& e, const glm::dvec3& world) const {
    const glm::dvec3 p = query::project(e.camera(), world, e.film_aspect());
    if (!(p.z > 0) || std::abs(p.x) > 1e4 || std::abs(p.y) > 1e4) return std::nullopt;
    return ImVec2(corner.x + float(p.x) * size.x, corner.y + float(p.y) * size.y);
}

InstanceId Viewport::instance_at(const PanelContext& e, ImVec2 screen) const {
    const glm::dvec2 p = film_point(screen);
    if (!drawn_ || p.x < 0 || p.y < 0 || p.x >= 1 || p.y >= 1) return {};
    const render::FilmImage& image = drawn_->image;
    const auto x = std::uint32_t(p.x * image.width), y = std::uint32_t(p.y * image.height);
    const InstanceId id{image.instance_id[std::size_t(y) * image.width + x]};
    return e.scene().instances.find(id) ? id : InstanceId{};
}

// --- drawing
// -----------------------------------------------------------------------------------------------------------

void Viewport::update_textures(PanelContext& e) {
    const auto frame = e.shown_frame();
    if (!frame) { // another scene, with no picture yet
        drawn_ = nullptr;
        picture_.hide();
        outline_.hide();
        outlined_ = {};
        return;
    }
    view::DisplaySettings settings = e.view.display;
    settings.scale = e.scene().film.value.exposure;
    settings.development = scene::development_of(e.scene());
    if (view::look_of(settings.layer) && !frame->look) settings.layer = view::picture_layer; // until it is there
    if (frame->clay && (settings.layer == view::picture_layer || settings.layer == view::exposure_layer)) settings = {};
    if (frame != drawn_ || settings != drawn_settings_) {
        scale_ = view::to_display(frame->image, settings, pixels_, frame->counts);
        if (settings.development.backdrop == scene::Backdrop::transparent)
            view::over_checkers(frame->image.width, pixels_);
        picture_.set(frame->image.width, frame->image.height, pixels_);
        drawn_ = frame;
        drawn_settings_ = settings;
    }
    // Outlines: the edges of selected or hovered objects, from the instance ids.
    OutlineKey key{frame.get(), e.selection.instances(), {}};
    if (e.scene().instances.find(e.drop_target_before))
        key.hovered = {e.drop_target_before}, key.selected.clear(); // only the drop target
    else if (e.scene().instances.find(e.hovered_before) && frame->divider <= 2)
        key.hovered = e.selection.click_target(e.scene(), e.hovered_before);
    if (key == outlined_) return;
    const render::FilmImage& image = frame->image;
    std::vector<std::uint8_t> mark(e.scene().instances.size() + 1, 0); // 1 hovered, 2 selected
    for (const InstanceId id : key.hovered)
        mark[id.value] = 1;
    for (const InstanceId id : key.selected)
        if (id.value < mark.size()) mark[id.value] = 2;
    outlined_ = std::move(key);
    if (view::to_outlines(image, mark, frame->divider > 1 ? 1 : 2,
                          {ImGui::GetColorU32(colors::pointed), ImGui::GetColorU32(colors::selected)}, pixels_))
        outline_.set(image.width, image.height, pixels_);
    else
        outline_.hide();
}

void Viewport::draw_overlays(PanelContext& e) {
    draw_lights(e);
    if (const auto& spot = e.panel_state->mixing.spot; spot && e.panel_state->mixing.shown()) {
        const ImVec2 at(corner.x + float(spot->x) * size.x, corner.y + float(spot->y) * size.y);
        ImGui::GetWindowDrawList()->AddCircle(at, 6 * ImGui::GetStyle().FontScaleMain,
                                              ImGui::GetColorU32(colors::accent), 0, 2);
        e.mark("picture.spot", at);
    }
    if (const scene::Bounds box = e.selection.bounds(e.scene()); !box.empty()) { // for tests
        glm::dvec2 lo(1e9), hi(-1e9);
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 at(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                                i & 4 ? box.upper.z : box.lower.z);
            const glm::dvec3 p = query::project(e.camera(), at, e.film_aspect());
            lo = glm::min(lo, glm::dvec2(p));
            hi = glm::max(hi, glm::dvec2(p));
        }
        e.mark("selection", {corner.x + float(lo.x) * size.x, corner.y + float(lo.y) * size.y},
               {corner.x + float(hi.x) * size.x, corner.y + float(hi.y) * size.y});
    }
}

// --- picking
// -----------------------------------------------------------------------------------------------------------

// Dragged to the right, a box selects objects visible only inside it, which excludes the floor and the wall behind;
// dragged to the left, all objects visible in it. As in CAD programs.
std::vector<InstanceId> Viewport::in_box(const PanelContext& e, ImVec2 from, ImVec2 to) const {
    std::vector<InstanceId> ids;
    if (!drawn_) return ids;
    const glm::dvec2 a = film_point(from), b = film_point(to);
    const auto& image = drawn_->image;
    const glm::dvec2 shape(image.width, image.height);
    const glm::uvec2 lo(glm::clamp(glm::min(a, b), 0.0, 1.0) * shape), hi(glm::clamp(glm::max(a, b), 0.0, 1.0) * shape);
    std::vector<std::uint8_t> seen(e.scene().instances.size() + 1, 0); // 1 in the box, 2 outside
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const std::uint32_t id = image.instance_id[std::size_t(y) * image.width + x];
            const bool inside = x >= lo.x && x < hi.x && y >= lo.y && y < hi.y;
            if (id < seen.size()) seen[id] |= inside ? 1 : 2;
        }
    const bool whole = to.x >= from.x;
    std::set<Whole> taken; // each checked once
    for (std::uint32_t value = 0; value < seen.size(); ++value) {
        const InstanceId id{value};
        if (!(seen[value] & 1) || e.locked.contains(value) || !e.scene().instances.find(id)) continue;
        const Whole of = e.selection.click_whole(e.scene(), id);
        if (of && !taken.insert(of).second) continue;
        const std::vector<InstanceId> parts = e.selection.click_target(e.scene(), id);
        if (whole && std::any_of(parts.begin(), parts.end(),
                                 [&](InstanceId part) { return part.value < seen.size() && (seen[part.value] & 2); }))
            continue;
        ids.insert(ids.end(), parts.begin(), parts.end());
    }
    return ids;
}

// After a double click: enters the whole. On nothing, or on a single object, the point there becomes the centre of
// orbits, and the click counts as usual: false.
bool Viewport::go_in(PanelContext& e, InstanceId id) {
    if (const Whole whole = e.selection.click_whole(e.scene(), id);
        whole && e.selection.click_target(e.scene(), id).size() > 1) {
        e.selection.enter(whole);
        e.selection.set(e.selection.click_target(e.scene(), id));
        return true;
    }
    const query::ViewRay ray = query::view_ray(e.camera(), film_point(ImGui::GetIO().MousePos), e.film_aspect());
    if (const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction); !hits.empty())
        orbit_center_ = hits[0].position;
    return false;
}

void Viewport::pick(PanelContext& e, bool over, const GizmoState& gizmo) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pickable = [&](InstanceId id) { return id && !e.locked.contains(id.value) ? id : InstanceId{}; };
    const bool free = over && !gizmo.wants_mouse && navigation_ == Navigation::none;
    if (run_pick_tool(e, over && navigation_ == Navigation::none)) return;
    if (run_measuring(e, over && navigation_ == Navigation::none)) return;
    if (run_region(e, over && navigation_ == Navigation::none)) return;
    if (run_placing(e, over && navigation_ == Navigation::none)) return;
    if (run_path_tool(e, over && navigation_ == Navigation::none)) return;
    if (over) e.hovered = free ? pickable(instance_at(e, io.MousePos)) : InstanceId{};

    if (free && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        pressed_ = true;
        pressed_twice_ = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
        press_ = io.MousePos;
    }
    if (!pressed_) {
        on_knob_ = false;
        return;
    }
    const bool far = std::abs(io.MousePos.x - press_.x) + std::abs(io.MousePos.y - press_.y) > 6;
    if (far && !boxing_ && !slide_.active && can_drag(e, press_)) start_sliding(e, press_);
    if (slide_.active) {
        slide(e);
        pressed_ = slide_.active;
        return;
    }
    boxing_ = boxing_ || far;
    const Selection::Mode mode = io.KeyCtrl    ? Selection::Mode::toggle
                                 : io.KeyShift ? Selection::Mode::add
                                               : Selection::Mode::replace;
    if (boxing_) {
        ImDrawList* draw = ImGui::GetWindowDrawList();
        draw->AddRectFilled(press_, io.MousePos, faded(colors::selected, 0.12f));
        draw->AddRect(press_, io.MousePos, ImGui::GetColorU32(colors::selected));
        ImGui::SetTooltip(io.MousePos.x >= press_.x
                              ? "Objects entirely inside the box (to the left: all it touches)"
                              : "All that the box touches (to the right: only objects entirely inside)");
    }
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
    pressed_ = false;
    if (std::exchange(boxing_, false)) {
        const std::vector<InstanceId> ids = in_box(e, press_, io.MousePos);
        e.selection.set(ids, mode);
        return;
    }
    if (pressed_twice_ && go_in(e, pickable(picked_at(e, io.MousePos)))) return;
    // A light's mark comes first.
    const scene::Id<scene::Light> light = e.view.show_overlays ? light_at(e, io.MousePos) : scene::Id<scene::Light>{};
    if (light) {
        e.selection.set_light(light);
        return;
    }
    InstanceId id = pickable(picked_at(e, io.MousePos));
    // A click at the same place, with the picked object still selected, picks the object behind.
    const bool again = !e.selection.instances().empty() &&
                       std::abs(io.MousePos.x - last_click_.x) + std::abs(io.MousePos.y - last_click_.y) < 3;
    behind_ = again && mode == Selection::Mode::replace ? behind_ + 1 : 0;
    last_click_ = io.MousePos;
    if (behind_ > 0) {
        const query::ViewRay ray = query::view_ray(e.camera(), film_point(io.MousePos), e.film_aspect());
        const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction,
                                             [&](InstanceId hit) { return e.locked.contains(hit.value); });
        // Each whole once, however many parts of it the ray hits.
        std::vector<InstanceId> targets;
        std::set<std::pair<Whole, std::uint32_t>> seen; // or the object if it is alone
        for (const query::RayHit& hit : hits) {
            const Whole whole = e.selection.click_whole(e.scene(), hit.instance);
            if (seen.insert({whole, whole ? 0 : hit.instance.value}).second) targets.push_back(hit.instance);
        }
        if (!targets.empty()) id = targets[behind_ % targets.size()];
    }
    if (!id) {
        if (mode == Selection::Mode::replace) e.selection.clear();
        return;
    }
    if (const auto around = e.selection.wholes(e.scene(), id);
        std::find(around.begin(), around.end(), e.selection.entered()) == around.end())
        e.selection.enter({});
    e.selection.set(e.selection.click_target(e.scene(), id), mode);
}

} // namespace restage::editor
