// SPDX-License-Identifier: Apache-2.0
#include "highlight.hpp"

#include "panel_context.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/bounds.hpp"
#include "scene/edits_light.hpp"
#include "viewport.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace restage::editor {

namespace {

void highlight_at(PanelContext& e, scene::Id<scene::Light> light, const std::vector<InstanceId>& lamps, ImVec2 screen) {
    const auto is_lamp = [&](InstanceId id) { return std::ranges::find(lamps, id) != lamps.end(); };
    const query::ViewRay ray = query::view_ray(e.camera(), e.viewport.film_point(screen), e.film_aspect());
    const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction, is_lamp);
    if (hits.empty()) return e.notices.add(LogLevel::info, "There is no surface for a highlight");
    const glm::dvec3 at = hits[0].position, mirrored = glm::reflect(glm::normalize(ray.direction), hits[0].normal);
    double distance = std::numeric_limits<double>::infinity(); // of the light
    if (const scene::Light* l = e.scene().lights.find(light); l && scene::light_row(l->kind).placed)
        distance = glm::length(glm::dvec3(l->light_to_world[3]) - at);
    scene::Bounds box;
    for (const InstanceId id : lamps)
        box.add(scene::world_bounds(e.scene(), id));
    if (!box.empty()) distance = glm::length(box.center() - at);
    const double off = 1e-6 * scene::world_bounds(e.scene()).radius();
    const auto between = query::raycast_all(e.scene(), at + hits[0].normal * off, mirrored, is_lamp);
    if (!between.empty() && between[0].t < distance)
        e.notices.add(LogLevel::warning,
                      "\"" + e.scene().instances[between[0].instance].name + "\" hides the light from there");
    e.edit([=](const scene::Scene& s) {
        return light ? scene::light_from(s, light, at, mirrored) : scene::light_from(s, lamps, at, mirrored);
    });
}

} // namespace

void point_highlight(SelectContext& editor) {
    editor.pick_tool =
        PickTool{"Click where the highlight should be",
                 [light = editor.selection.light(), lamps = editor.selection.instances()](
                     PanelContext& e, InstanceId, ImVec2 screen) { highlight_at(e, light, lamps, screen); }};
}

} // namespace restage::editor
