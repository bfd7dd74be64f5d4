// SPDX-License-Identifier: Apache-2.0
// Inspector, light: an object that emits, and lights without a surface.
#include "actions.hpp"
#include "inspector.hpp"
#include "io/material_emission.hpp"
#include "param_widget.hpp"
#include "plugin/registry.hpp"
#include "scene/color_temperature.hpp"
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

constexpr double pi = 3.14159265358979323846;

double luminance(const glm::vec3& c) { return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z); }

// In world units; walking a large mesh takes a while, so it is cached.
double area_of(DocumentContext& e, InstanceId id) {
    auto& known = e.panel_state->inspector.area;
    const scene::Instance& instance = e.scene().instances[id];
    if (known.of == id && known.transform == instance.object_to_world) return known.value;
    known = {.of = id, .transform = instance.object_to_world, .value = 0};
    const scene::Mesh* mesh = e.scene().meshes.find(instance.mesh);
    if (!mesh || !mesh->data) return 0;
    const glm::dmat3 m(instance.object_to_world);
    for (const glm::uvec3& t : mesh->data->triangles) {
        const glm::dvec3 a(mesh->data->positions[t.x]), b(mesh->data->positions[t.y]), c(mesh->data->positions[t.z]);
        known.value += 0.5 * glm::length(glm::cross(m * (b - a), m * (c - a)));
    }
    return known.value;
}

void ask_emission(EditContext& e, InstanceId id, std::optional<scene::Emission> emission, const char* gesture) {
    e.edit([id, emission](const scene::Scene& s) { return scene::set_emission(s, id, emission); }, gesture);
}

// Directions of lights that emit along +z: elevation and azimuth about the scene's up.
struct Angles {
    double elevation = 90, azimuth = 0; // of the direction towards the light [deg]
};

glm::dmat3 horizon(const glm::dvec3& up) { // columns: two horizontal axes and up
    const glm::dvec3 x = glm::normalize(std::abs(up.x) < 0.9 ? glm::cross(up, glm::dvec3(1, 0, 0))
                                                             : glm::cross(up, glm::dvec3(0, 1, 0)));
    return {x, glm::cross(up, x), up};
}

Angles angles_of(const glm::dmat4& light_to_world, const glm::dvec3& up) {
    const glm::dvec3 from = glm::transpose(horizon(up)) * -glm::normalize(glm::dvec3(light_to_world[2]));
    return {glm::degrees(std::asin(std::clamp(from.z, -1.0, 1.0))), glm::degrees(std::atan2(from.y, from.x))};
}

glm::dmat4 turned(const glm::dmat4& light_to_world, const Angles& angles, const glm::dvec3& up) {
    const double el = glm::radians(std::clamp(angles.elevation, -89.99, 89.99)), az = glm::radians(angles.azimuth);
    const glm::dvec3 z =
        -(horizon(up) * glm::dvec3(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)));
    const glm::dvec3 x = glm::normalize(glm::cross(up, z));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), light_to_world[3]};
}

} // namespace

bool light_value_rows(PanelUi& e, glm::vec3& value, const char* strength_label, const char* unit,
                      const std::string& mark) {
    float strength = std::max({value.x, value.y, value.z});
    glm::vec3 color = strength > 0 ? value / strength : glm::vec3(1);
    bool changed = false;
    form_row("Colour", "The light's colour, without its brightness");
    if (color_field("##color", &color.x)) {
        if (const float most = std::max({color.x, color.y, color.z}); most > 0) color /= most;
        changed = true;
    }
    e.mark(mark + ".color");
    form_row("Temperature", "Sets the colour to a lamp's: candle 1900 K, bulb 2700 K, noon 5500 K, overcast 7000 K");
    auto kelvin = float(scene::color_temperature(glm::dvec3(color)));
    const std::string shown = kelvin > 0 ? "%.0f K" : "None";
    if (kelvin <= 0) kelvin = 6500;
    if (ImGui::SliderFloat("##kelvin", &kelvin, float(scene::least_kelvin), 12000, shown.c_str(),
                           ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic)) {
        color = glm::vec3(scene::blackbody_color(double(kelvin)));
        changed = true;
    }
    e.mark(mark + ".kelvin");
    const std::string_view radiometry(unit);
    form_row(strength_label, radiometry == "W/m²"   ? "Irradiance: power per square metre facing the light"
                             : radiometry == "×"    ? "Times the light's own"
                             : radiometry == "W/sr" ? "Radiant intensity: power per solid angle"
                                                    : "Radiance: independent of distance");
    const std::string format = fmt::format("%.4g {}", unit);
    changed |= ImGui::DragFloat("##strength", &strength, drag_speed(strength, 1e-3f), 0, 1e9f, format.c_str(),
                                ImGuiSliderFlags_AlwaysClamp);
    e.mark(mark + ".strength");
    if (changed) value = color * strength;
    return changed;
}

void emission_section(EditContext& e, InstanceId id) {
    const bool shown = section_header("Light");
    e.mark("inspector.light");
    if (!shown) return;
    ImGui::PushID("light");
    const scene::Instance& instance = e.scene().instances[id];
    form_row("Emits light", "Makes the object a lamp: its whole surface emits light");
    if (bool on = instance.emission.has_value(); ImGui::Checkbox("##emits", &on))
        ask_emission(e, id,
                     on ? std::optional(scene::Emission{.radiance = glm::vec3(scene::blackbody_color(4000)) * 10.f})
                        : std::nullopt,
                     "");
    e.mark("light.emits");
    if (!instance.emission && io::MaterialEmissions(e.registry(), e.scene()).shines(instance))
        ImGui::TextDisabled("Its material emits light, see above.");
    if (instance.emission) {
        scene::Emission emission = *instance.emission;
        bool changed = light_value_rows(e, emission.radiance, "Brightness", "W/(m²sr)", "light");
        // Power of a Lambertian emitter: pi times area times radiance, twice with both sides.
        const double sides = pi * area_of(e, id) * (emission.two_sided ? 2 : 1);
        if (auto power = float(luminance(emission.radiance) * sides); sides > 0) {
            form_row("Power",
                     "Luminous power of the whole surface: at the same brightness it grows with the lamp's size");
            const float before = power;
            if (ImGui::DragFloat("##power", &power, drag_speed(power, 1e-3f), 0, 1e12f, "%.4g W",
                                 ImGuiSliderFlags_AlwaysClamp)) {
                emission.radiance =
                    before > 0 ? emission.radiance * (power / before) : glm::vec3(float(double(power) / sides));
                changed = true;
            }
            e.mark("light.power");
        }
        form_row("Two-sided", "The back of its surface emits light, too");
        changed |= ImGui::Checkbox("##two-sided", &emission.two_sided);
        e.mark("light.two_sided");
        if (changed) ask_emission(e, id, emission, "inspector.emission");
    }
    ImGui::PopID();
}

void light_section(EditContext& e, scene::Id<scene::Light> id) {
    const scene::Light* found = e.scene().lights.find(id);
    if (!found) return;
    scene::Light light = *found;
    std::string name = light.name;
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (name_field("##name", name)) e.edit([id, name](const scene::Scene& s) { return scene::rename(s, id, name); });
    tip("The light's name");
    e.mark("light.name");
    bool changed = false;
    form_row("Type", "How it emits light");
    if (ImGui::BeginCombo("##kind", scene::light_row(light.kind).label)) {
        for (const scene::LightKindRow& row : scene::light_kinds) {
            if (ImGui::Selectable(row.label, row.kind == light.kind)) {
                light.kind = row.kind;
                changed = true;
            }
            tip(row.shines);
        }
        ImGui::EndCombo();
    }
    e.mark("light.kind");
    changed |= light_value_rows(e, light.value, "Brightness", scene::light_row(light.kind).unit, "light");
    if (scene::light_row(light.kind).placed) {
        glm::dvec3 position(light.light_to_world[3]);
        form_row("Position", "x, y, z in scene units");
        const double size = scene::world_bounds(e.scene()).radius();
        if (ImGui::DragScalarN("##position", ImGuiDataType_Double, &position.x, 3, float(std::max(size * 0.002, 1e-4)),
                               nullptr, nullptr, "%.3f")) {
            light.light_to_world[3] = glm::dvec4(position, 1);
            changed = true;
        }
        e.mark("light.position");
    }
    if (scene::light_row(light.kind).aimed) {
        Angles angles = angles_of(light.light_to_world, e.up());
        form_row("Height", "Elevation of the light above the horizon");
        const double lowest = -90, highest = 90;
        bool turn = ImGui::DragScalar("##elevation", ImGuiDataType_Double, &angles.elevation, 0.25f, &lowest, &highest,
                                      "%.1f°", ImGuiSliderFlags_AlwaysClamp);
        e.mark("light.elevation");
        form_row("Around", "Azimuth of the light");
        turn |= ImGui::DragScalar("##azimuth", ImGuiDataType_Double, &angles.azimuth, 0.5f, nullptr, nullptr, "%.1f°");
        e.mark("light.azimuth");
        if (turn) light.light_to_world = turned(light.light_to_world, angles, e.up());
        changed |= turn;
    }
    if (scene::light_row(light.kind).cone) {
        form_row("Cone", "From the axis to the edge: half of the opening angle");
        changed |= ImGui::SliderFloat("##cone", &light.cone_angle, 0.1f, 90, "%.1f°", ImGuiSliderFlags_AlwaysClamp);
        e.mark("light.cone");
        form_row("Soft edge", "Width of the fading edge");
        changed |=
            ImGui::SliderFloat("##edge", &light.cone_delta, 0, light.cone_angle, "%.1f°", ImGuiSliderFlags_AlwaysClamp);
        light.cone_delta = std::min(light.cone_delta, light.cone_angle);
        e.mark("light.edge");
        static constexpr const char* falloffs[] = {"Smooth", "Quartic"};
        int falloff = int(light.falloff);
        form_row("Fading", "How the edge fades. Smooth: as pbrt-v4. Quartic: as pbrt-v3, darker");
        if (ImGui::Combo("##falloff", &falloff, falloffs, IM_ARRAYSIZE(falloffs))) {
            light.falloff = scene::Falloff(falloff);
            changed = true;
        }
        e.mark("light.falloff");
    }
    if (changed)
        e.edit([id, light](const scene::Scene& s) { return scene::set_light(s, id, light, "Change " + light.name); },
               "inspector.light");
    ImGui::Spacing();
    action_button(e, "edit.duplicate", "Duplicate");
    ImGui::SameLine();
    if (ImGui::Button("Delete this light")) e.edit([id](const scene::Scene& s) { return scene::remove(s, id); });
    e.mark("light.remove");
}

} // namespace restage::editor
