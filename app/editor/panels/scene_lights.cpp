// SPDX-License-Identifier: Apache-2.0
// Scene panel, lights: all emitters, and new lights where the camera looks.
#include "scene_panel.hpp"

#include "document/session.hpp"
#include "io/material_emission.hpp"
#include "light_buttons.hpp"
#include "plugin/registry.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/edits.hpp"
#include "scene/merge.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

// A point above the surface in the middle of the picture, below any ceiling, and its height above it.
struct Place {
    glm::dvec3 target{0}, above{0};
    double height = 1;
};

Place place_for_light(const SelectContext& e) {
    const scene::Bounds all = scene::world_bounds(e.scene());
    Place place;
    const double size = all.empty() ? 1 : std::max(all.radius(), 1e-6);
    place.target = all.empty() ? glm::dvec3(0) : all.center();
    const query::ViewRay ray = query::view_ray(e.camera(), {0.5, 0.5}, e.film_aspect());
    if (const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction); !hits.empty())
        place.target = hits[0].position;
    place.height = 0.5 * size;
    const auto ceiling = query::raycast_all(e.scene(), place.target + e.up() * (1e-4 * size), e.up());
    if (!ceiling.empty()) place.height = std::min(place.height, 0.7 * ceiling[0].t);
    place.above = place.target + e.up() * place.height;
    return place;
}

// Emits along +z, which becomes `direction`.
glm::dmat4 aimed(const glm::dvec3& at, const glm::dvec3& direction) {
    const glm::dvec3 z = glm::normalize(direction);
    const glm::dvec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(at, 1)};
}

void add_light(SelectContext& e, const scene::LightKindRow& row) {
    const Place place = place_for_light(e);
    const auto h2 = float(place.height * place.height);
    scene::Light light{.kind = row.kind, .light_to_world = aimed(place.above, -e.up())};
    // A visible brightness: 10 W/m2 on the surface below.
    light.name = row.name;
    light.value = row.placed ? glm::vec3(10 * h2) : glm::vec3(10);
    if (!row.placed) // from behind the camera's shoulder
        light.light_to_world = aimed(place.above, glm::dvec3(e.camera().camera_to_world[2]) * 0.6 - e.up() +
                                                      glm::dvec3(e.camera().camera_to_world[0]) * 0.5);
    e.change([&e, light = std::move(light)](document::Session& session) mutable {
        const auto id = session.scene().lights.next();
        std::set<std::string> taken;
        session.scene().lights.each([&](auto, const scene::Light& other) { taken.insert(other.name); });
        light.name = scene::free_name(light.name, taken);
        const std::string label = "Add " + light.name;
        if (auto made = session.edit(scene::insert(session.scene(), std::move(light), label)); !made)
            e.notices.add(LogLevel::error, made.error().message);
        else
            e.selection.set_light(id);
    });
}

void add_area_light(SelectContext& e) {
    const Place place = place_for_light(e);
    auto square = std::make_shared<scene::MeshData>(); // faces +z
    square->positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    square->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    square->triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::compute_bounds(*square);
    const double side = 0.5 * place.height;
    const glm::dmat4 to_world = aimed(place.above, -e.up()) * glm::scale(glm::dmat4(1), glm::dvec3(side, side, side));
    const std::string type = e.registry().find_material("diffuse") || e.registry().materials().empty()
                                 ? "diffuse"
                                 : e.registry().materials().front().table->type;
    e.change([&e, square, to_world, type](document::Session& session) {
        const scene::Scene& s = session.scene();
        scene::Edit edit{"Add area light", {}};
        const auto mesh = s.meshes.next();
        edit.changes.push_back(
            scene::Change<scene::Mesh>{mesh, std::nullopt, scene::Mesh{.name = "Area light", .data = square}});
        const auto material = s.materials.next();
        edit.changes.push_back(scene::Change<scene::Material>{material, std::nullopt,
                                                              scene::Material{.name = "Area light", .type = type}});
        const InstanceId id = s.instances.next();
        edit.changes.push_back(
            scene::Change<scene::Instance>{id, std::nullopt,
                                           scene::Instance{.name = "Area light",
                                                           .mesh = mesh,
                                                           .material = material,
                                                           .object_to_world = to_world,
                                                           .emission = scene::Emission{.radiance = glm::vec3(15)}}});
        const InstanceId ids[] = {id};
        if (auto made = session.edit(std::move(edit)); !made)
            e.notices.add(LogLevel::error, made.error().message);
        else
            e.selection.set(ids);
    });
}

} // namespace

void lights_section(SelectContext& e) {
    const bool open = section_header("Lights");
    e.mark("scene.lights");
    if (!open) return;
    ImGui::PushID("lights");
    light_board_note(e);
    std::size_t shown = 0;
    if (e.scene().environment.value) {
        ImGui::TextUnformatted("The sky");
        light_row_end(e, view::sky_key, "sky", "Sky");
    }
    e.scene().lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        ImGui::PushID(int(id.value));
        if (ImGui::Selectable(light.name.c_str(), e.selection.light() == id, ImGuiSelectableFlags_AllowOverlap))
            e.selection.set_light(id);
        e.mark("lights." + light.name);
        light_row_end(e, view::key_of(id), light.name, scene::light_row(light.kind).label);
        ImGui::PopID();
        ++shown;
    });
    constexpr std::size_t most = 50; // a file can have thousands of emitting triangles
    std::size_t emitters = 0;
    const io::MaterialEmissions emissions(e.registry(), e.scene());
    e.scene().instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (!emissions.shines(instance) || ++emitters > most) return;
        ImGui::PushID(int(id.value) + 1'000'000);
        const InstanceId ids[] = {id};
        if (ImGui::Selectable(instance.name.c_str(), e.selection.contains(id), ImGuiSelectableFlags_AllowOverlap))
            e.selection.set(ids);
        if (ImGui::IsItemHovered()) e.hovered = id;
        e.mark("lights." + instance.name);
        light_row_end(e, view::key_of(id), instance.name, "Object");
        ImGui::PopID();
        ++shown;
    });
    if (emitters > most) ImGui::TextDisabled("and %zu more emissive objects", emitters - most);
    if (shown == 0) empty_note("There are no lights but the sky.");
    for (const scene::LightKindRow& row : scene::light_kinds) {
        if (flow_button((std::string("+ ") + row.label).c_str(), &row == scene::light_kinds)) add_light(e, row);
        tip(row.added);
        e.mark(std::string("lights.add_") + row.id);
    }
    if (flow_button("+ Area")) add_area_light(e);
    tip("A square that emits downwards: soft shadows");
    e.mark("lights.add_area");
    ImGui::PopID();
}

} // namespace restage::editor
