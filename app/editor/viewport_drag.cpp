// SPDX-License-Identifier: Apache-2.0
// Dragging the selection directly, or by the knob between its handles: it slides horizontally, and stays under the
// mouse. This also works if handles point at the viewer and are too short to drag. Also things that follow the mouse:
// sticking the selection to the surface under it, and the values of the pixel there.
#include "collide_drag.hpp"
#include "document/session.hpp"
#include "panel_context.hpp"
#include "pick_tool.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/edits.hpp"
#include "snap_drag.hpp"
#include "theme.hpp"
#include "viewport.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

DragPath::Mouse mouse_at(const PanelContext& e, const Viewport& v, ImVec2 screen) {
    return {query::view_ray(e.camera(), v.film_point(screen), e.film_aspect()),
            glm::normalize(glm::dvec3(e.camera().camera_to_world[1]))};
}

} // namespace

bool Viewport::can_drag(const PanelContext& e, ImVec2 screen) const {
    return e.view.gizmo == GizmoMode::move && !e.selection.empty() &&
           (on_knob_ || e.selection.contains(picked_at(e, screen)));
}

void Viewport::start_sliding(PanelContext& e, ImVec2 screen) {
    const DragPath::Mouse mouse = mouse_at(e, *this, screen);
    const auto hits = query::raycast_all(e.scene(), mouse.ray.origin, mouse.ray.direction,
                                         [&](InstanceId id) { return !e.selection.contains(id); });
    if (hits.empty() && !on_knob_) return;
    begin_drag(e, slide_, ImGui::GetIO().KeyShift);
    const glm::dvec3 at = hits.empty() ? gizmo_drag.pivot : hits[0].position;
    slide_.path.begin(at, e.up(), mouse, false);
    begin_snapping(e, slide_, at, mouse.ray);
    begin_colliding(e, slide_);
}

void Viewport::slide(PanelContext& e) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        slide_ = {};
        e.end_gesture();
        return;
    }
    const DragPath::Mouse mouse = mouse_at(e, *this, io.MousePos);
    const glm::dvec3 free =
        slide_.path.update(io.KeyAlt, mouse, std::nullopt, io.KeyCtrl ? double(e.view.snap_move) : 0);
    const glm::dvec3 wanted = snapped(e, slide_, free, mouse.ray, std::nullopt);
    const glm::dvec3 by = collided(slide_, wanted, io.KeyAlt, wanted != free);
    ask_drag(e, slide_, glm::translate(glm::dmat4(1), by), "Move");
    draw_snapping(e, slide_);
    draw_colliding(e, slide_);
}

bool Viewport::dragging() const {
    return slide_.active || gizmo_drag.active || boxing_ || sticking_ || cone_held_ ||
           placing.held != TexturePlacing::Hold::none;
}

void Viewport::cancel(PanelContext& e) {
    cancel_drag(e, slide_);
    cancel_drag(e, gizmo_drag);
    if (sticking_ || cone_held_) e.change([](document::Session& session) { session.cancel_gesture(); });
    cancel_placing(e);
    release_gizmo();
    pressed_ = boxing_ = sticking_ = on_knob_ = false;
    if (std::exchange(cone_held_, false)) ImGui::ClearActiveID();
    cancelled_ = true;
}

void Viewport::stick(PanelContext& e, bool over) {
    const bool held = over && ImGui::IsKeyDown(ImGuiKey_T) && !ImGui::GetIO().WantTextInput &&
                      navigation_ == Navigation::none && !cancelled_ && !e.selection.instances().empty();
    if (!held) {
        if (std::exchange(sticking_, false)) e.end_gesture();
        return;
    }
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (sticking_ && moved.x == 0 && moved.y == 0) return;
    sticking_ = true;
    const query::ViewRay ray = query::view_ray(e.camera(), film_point(ImGui::GetIO().MousePos), e.film_aspect());
    const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction,
                                         [&](InstanceId id) { return e.selection.contains(id); });
    if (hits.empty()) return;
    // The centre of the box side that faces the surface is placed on it.
    const scene::Bounds bounds = e.selection.bounds(e.scene());
    const glm::dvec3 n = hits[0].normal;
    const double reach = 0.5 * glm::dot(bounds.size(), glm::abs(n));
    const glm::dmat4 by = glm::translate(glm::dmat4(1), hits[0].position + n * reach - bounds.center());
    e.edit(
        [ids = e.selection.instances(), by](const scene::Scene& s) {
            auto edit = scene::move_instances(s, ids, by);
            if (edit) edit->label = "Stick to surface";
            return edit;
        },
        "stick");
}

void Viewport::inspect_pixel(PanelContext& e, bool over) {
    if (!e.view.inspect_pixels || !over || !drawn_ || navigation_ != Navigation::none) return;
    const glm::dvec2 p = film_point(ImGui::GetIO().MousePos);
    if (p.x < 0 || p.y < 0 || p.x >= 1 || p.y >= 1) return;
    const render::FilmImage& image = drawn_->image;
    const auto x = std::uint32_t(p.x * image.width), y = std::uint32_t(p.y * image.height);
    const std::size_t i = std::size_t(y) * image.width + x;
    const scene::Instance* instance = e.scene().instances.find({image.instance_id[i]});
    const scene::Material* material = e.scene().materials.find({image.material_id[i]});
    const glm::vec3 c = image.color[i], s = image.std_error[i], n = image.normal[i];
    if (!ImGui::BeginTooltip()) return;
    ImGui::TextColored(colors::dim, "pixel %u, %u of %ux%u", x, y, image.width, image.height);
    ImGui::Text("radiance   %.4g  %.4g  %.4g", double(c.x), double(c.y), double(c.z));
    if (image.samples > 1)
        ImGui::Text("std error  %.2g  %.2g  %.2g", double(s.x), double(s.y), double(s.z));
    else
        ImGui::TextUnformatted("std error  from two samples on");
    ImGui::Text("object     %s", instance ? instance->name.c_str() : "none");
    ImGui::Text("material   %s", material ? material->name.c_str() : "none");
    if (instance) {
        ImGui::Text("distance   %.5g", double(image.depth[i]));
        ImGui::Text("normal     %.3f  %.3f  %.3f", double(n.x), double(n.y), double(n.z));
    }
    ImGui::EndTooltip();
}

} // namespace restage::editor
