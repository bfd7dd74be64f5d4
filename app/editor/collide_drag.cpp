// SPDX-License-Identifier: Apache-2.0
#include "collide_drag.hpp"

#include "drag.hpp"
#include "panel_context.hpp"
#include "viewport.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <memory>
#include <string>

namespace restage::editor {

void begin_colliding(PanelContext& e, Drag& drag) {
    drag.colliding.reset();
    if (!e.preferences.collide || drag.start.empty()) return;
    drag.colliding = std::shared_ptr<Colliding>(new Colliding{
        .query{e.scene(), query::Collision::thing_of(e.scene(), drag.thing()), drag.dragged(), e.up()}, .met = {}});
}

glm::dvec3 collided(Drag& drag, const glm::dvec3& by, bool straight, bool snapped) {
    if (!drag.colliding) return by;
    Colliding& c = *drag.colliding;
    c.met.clear();
    const bool shift = ImGui::GetIO().KeyShift, was_through = c.through;
    c.free_shift |= !shift;
    c.through = shift && c.free_shift;
    if (c.through) return by;
    if (was_through)
        c.query.force(by);
    else if (!snapped || !c.query.place(by))
        c.met = straight ? c.query.stop(by) : c.query.slide(by);
    drag.path.stop_at(c.query.at());
    return c.query.at();
}

void draw_colliding(PanelContext& e, const Drag& drag) {
    if (!drag.active || !drag.colliding) return;
    const Colliding& c = *drag.colliding;
    if (c.met.empty() && !c.through) return;
    const scene::Instance* first = c.met.empty() ? nullptr : e.scene().instances.find(c.met[0]);
    const std::string text = c.through ? "through things"
                             : first   ? fmt::format("stopped by {}. Shift: through it", first->name)
                                       : "";
    const scene::Bounds box = e.selection.bounds(e.scene());
    const auto at = box.empty() ? std::nullopt : e.viewport.on_screen(e, box.center());
    if (!text.empty() && at)
        picture_label(e, {at->x, at->y + 14 * ImGui::GetStyle().FontScaleMain}, text, "collide.hint");
}

glm::dvec3 room_for(const PanelContext& e, const scene::Scene& from, std::span<const InstanceId> ids,
                    const glm::dmat4& move) {
    if (!e.preferences.collide) return glm::dvec3(0);
    auto thing = query::Collision::thing_of(from, ids);
    for (auto& part : thing)
        part.place = move * part.place;
    return query::Collision(e.scene(), thing, {}, e.up()).make_room(glm::dvec3(e.camera().camera_to_world[3]));
}

} // namespace restage::editor
