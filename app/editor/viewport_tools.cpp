// SPDX-License-Identifier: Apache-2.0
// Viewport tools that follow the mouse: sticking the selection to what is under it, and the values of the pixel there.
#include "editor.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "theme.hpp"

#include <fmt/format.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

void Viewport::stick(Editor& e, bool over) {
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
    // The middle of the box's side that faces the surface comes to lie on it.
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

void Viewport::inspect_pixel(Editor& e, bool over) {
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
