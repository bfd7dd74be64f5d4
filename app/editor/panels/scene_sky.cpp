// SPDX-License-Identifier: Apache-2.0
// Scene panel, sky: what is seen, and shines, where the scene ends.
#include "panels.hpp"
#include "scene_panel.hpp"

#include "param_widget.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace restage::editor {

namespace {

using scene::Environment;

// Equirectangular images have +z on top.
glm::dmat4 upright(const glm::dvec3& up) {
    const glm::dvec3 x = glm::normalize(std::abs(up.x) < 0.9 ? glm::cross(up, glm::dvec3(1, 0, 0))
                                                             : glm::cross(up, glm::dvec3(0, 1, 0)));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(up, x), 0), glm::dvec4(up, 0), glm::dvec4(0, 0, 0, 1)};
}

// The part of a rotation that is about `axis` [deg] (swing-twist decomposition): turning by d about it adds d.
double twist(const glm::dmat4& m, const glm::dvec3& axis) {
    glm::dmat3 r(m);
    if (glm::determinant(r) < 0) r[0] = -r[0]; // mirrored skies turn as their mirror images do
    for (int i = 0; i < 3; ++i)
        r[i] = glm::normalize(r[i]);
    const glm::dquat q(r);
    return glm::degrees(2 * std::atan2(glm::dot(glm::dvec3(q.x, q.y, q.z), axis), q.w));
}

double wrapped(double degrees) { return degrees - 360 * std::floor((degrees + 180) / 360); }

void ask_sky(Editor& e, std::optional<Environment> sky, const char* label, const char* gesture = "") {
    e.edit([sky = std::move(sky),
            label](const scene::Scene& s) { return Result<scene::Edit>(scene::set_environment(s, sky, label)); },
           gesture);
}

void image_row(Editor& e, const Environment& sky) {
    const scene::Image* image = e.scene().images.find(sky.image);
    form_row("Image",
             image ? image->path.c_str() : "Where light comes from all around: an HDR or EXR panorama is best");
    if (ImGui::Button(image ? (image->name + "###image").c_str() : "Choose...###image", {ImGui::CalcItemWidth(), 0}))
        ImGui::OpenPopup("sky image");
    if (image && !image->data)
        tip("The file could not be read: see Import report");
    else
        tip("Choose another; or drop an image here");
    e.mark("sky.image");
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("restage.path"))
            use_as_sky(e, static_cast<const char*>(payload->Data));
        ImGui::EndDragDropTarget();
    }
    if (!ImGui::BeginPopup("sky image")) return;
    std::vector<std::string> known = e.panel_state->assets.files_of(AssetKind::sky);
    e.scene().images.each([&](auto, const scene::Image& i) {
        if (!i.path.empty() && i.encoding == RESTAGE_LINEAR &&
            std::find(known.begin(), known.end(), i.path) == known.end())
            known.push_back(i.path);
    });
    if (!known.empty()) {
        std::vector<std::string> names;
        for (const std::string& path : known)
            names.push_back(std::filesystem::path(path).filename().string());
        searched_list(
            e.panel_state->scene.sky_search, known.size(), [&](std::size_t i) -> std::string_view { return names[i]; },
            [&](std::size_t i) {
                if (ImGui::Selectable(names[i].c_str(), image && image->path == known[i])) {
                    use_as_sky(e, known[i]);
                    ImGui::CloseCurrentPopup();
                }
                tip(known[i].c_str());
                e.mark("sky.choose." + names[i]);
            });
        ImGui::Separator();
    }
    if (const std::string file = image_file_popup(e, "sky"); !file.empty()) {
        use_as_sky(e, file);
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

} // namespace

bool has_light(const scene::Scene& s) {
    bool found = s.environment.value.has_value() || s.lights.live() > 0;
    if (!found)
        s.instances.each([&](InstanceId, const scene::Instance& i) { found = found || (i.emission && !i.hidden); });
    return found;
}

Result<scene::Edit> add_studio(const scene::Scene& s, const glm::dvec3& up) {
    constexpr std::uint32_t width = 64, height = 32;
    scene::PixelData pixels{.width = width, .height = height, .channels = 3, .values = {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float h = 1 - 2 * (float(y) + 0.5f) / height;  // 1 above, -1 below
            const float soft = 1 / (1 + std::exp(-10 * (h - 0.45f))); // a wide soft box overhead
            const float side =
                std::exp(-18 * std::pow((float(x) + 0.5f) / width - 0.3f, 2.f) - 12 * std::pow(h - 0.35f, 2.f));
            const float v = 0.35f + 1.1f * soft + 1.6f * side + std::min(h, 0.f) * 0.2f;
            pixels.values.insert(pixels.values.end(), {v, v, v});
        }
    const auto id = s.images.next();
    scene::Edit edit = scene::insert(s,
                                     scene::Image{.name = "studio",
                                                  .encoding = RESTAGE_LINEAR,
                                                  .data = std::make_shared<const scene::PixelData>(std::move(pixels))},
                                     "Neutral studio");
    const Environment sky{.name = "Studio", .image = id, .mapping = RESTAGE_EQUIRECT, .light_to_world = upright(up)};
    const scene::Edit set = scene::set_environment(s, sky);
    edit.changes.insert(edit.changes.end(), set.changes.begin(), set.changes.end());
    return edit;
}

void use_as_sky(Editor& e, const std::string& file) {
    const std::string path = std::filesystem::absolute(file).lexically_normal().string();
    e.panel_state->loads.start(
        {.path = path,
         .encoding = RESTAGE_LINEAR,
         .done = [&e, path](Result<std::shared_ptr<const scene::PixelData>> pixels) {
             if (!pixels) {
                 e.notices.add(LogLevel::error, pixels.error().message);
                 return;
             }
             e.edit([path, data = *pixels, up = e.up()](const scene::Scene& s) {
                 Environment sky =
                     s.environment.value.value_or(Environment{.name = "Sky", .light_to_world = upright(up)});
                 // Square ones are octahedral maps as pbrt-v4 has them, others panoramas.
                 const RestageMapping mapping = data->width == data->height ? RESTAGE_OCTAHEDRAL : RESTAGE_EQUIRECT;
                 if (mapping != sky.mapping) sky.light_to_world = upright(up);
                 sky.mapping = mapping;
                 scene::Edit edit{"Sky " + std::filesystem::path(path).stem().string(), {}};
                 scene::Id<scene::Image> id;
                 s.images.each([&](scene::Id<scene::Image> other, const scene::Image& i) {
                     if (i.path == path && i.encoding == RESTAGE_LINEAR && i.data) id = other;
                 });
                 if (!id) {
                     id = s.images.next();
                     edit.changes.push_back(
                         scene::Change<scene::Image>{id, std::nullopt,
                                                     scene::Image{.name = std::filesystem::path(path).stem().string(),
                                                                  .path = path,
                                                                  .encoding = RESTAGE_LINEAR,
                                                                  .data = data}});
                 }
                 sky.image = id;
                 const scene::Edit set = scene::set_environment(s, sky);
                 edit.changes.insert(edit.changes.end(), set.changes.begin(), set.changes.end());
                 return Result<scene::Edit>(std::move(edit));
             });
         }});
}

void sky_section(Editor& e) {
    const bool open = section_header("Sky", true);
    e.mark("scene.sky");
    if (!open) return;
    ImGui::PushID("sky");
    if (!has_light(e.scene())) {
        warning_note("Nothing shines in this scene, so its picture is black.");
        if (ImGui::Button("Light it with a neutral studio"))
            e.edit([up = e.up()](const scene::Scene& s) { return add_studio(s, up); });
        tip("Soft grey light from all around");
        e.mark("sky.studio");
    }
    const auto& now = e.scene().environment.value;
    static constexpr const char* kinds[] = {"None", "One colour", "Image", "Neutral studio"};
    int kind = !now ? 0 : !now->image ? 1 : 2;
    form_row("Sky", "What shines where the scene ends");
    if (ImGui::BeginCombo("##kind", kinds[kind])) {
        for (int i = 0; i < 4; ++i) {
            if (ImGui::Selectable(kinds[i], i == kind) && i != kind) {
                Environment sky = now.value_or(Environment{.name = "Sky", .light_to_world = upright(e.up())});
                if (i == 0) ask_sky(e, std::nullopt, "No sky");
                if (i == 1) {
                    sky.image = {};
                    ask_sky(e, sky, "Sky of one colour");
                }
                if (i == 3) e.edit([up = e.up()](const scene::Scene& s) { return add_studio(s, up); });
                if (i == 2) e.panel_state->scene.choose_sky = true;
            }
            e.mark(std::string("sky.kind.") + kinds[i]);
        }
        ImGui::EndCombo();
    }
    e.mark("sky.kind");
    const bool choosing = e.panel_state->scene.choose_sky;
    if (now && now->image) e.panel_state->scene.choose_sky = false;
    if ((now && now->image) || choosing) image_row(e, now.value_or(Environment{}));
    if (now) {
        Environment sky = *now;
        bool changed = false;
        if (sky.image) {
            const double before = twist(sky.light_to_world, e.up());
            double angle = wrapped(before);
            form_row("Rotation", "About the scene's up: drag to turn the sky, and the sun in it [degrees]");
            if (ImGui::DragScalar("##rotation", ImGuiDataType_Double, &angle, 0.5f, nullptr, nullptr, "%.1f deg")) {
                sky.light_to_world =
                    glm::rotate(glm::dmat4(1), glm::radians(angle - before), e.up()) * sky.light_to_world;
                ask_sky(e, sky, "Rotate sky", "sky.rotation");
            }
            e.mark("sky.rotation");
        }
        float strength = std::max({sky.scale.x, sky.scale.y, sky.scale.z});
        glm::vec3 tint = strength > 0 ? sky.scale / strength : glm::vec3(1);
        form_row(sky.image ? "Tint" : "Colour",
                 sky.image ? "Multiplies the image" : "Of the light that comes from everywhere");
        if (color_field("##tint", &tint.x)) {
            if (const float most = std::max({tint.x, tint.y, tint.z}); most > 0) tint /= most;
            changed = true;
        }
        e.mark("sky.tint");
        form_row("Strength", sky.image ? "Multiplies the image" : "Radiance [W/(m2 sr)]");
        changed |= ImGui::DragFloat("##strength", &strength, drag_speed(strength, 1e-3f), 0, 1e6f,
                                    sky.image ? "%.4g x" : "%.4g W/(m2 sr)", ImGuiSliderFlags_AlwaysClamp);
        e.mark("sky.strength");
        if (changed) {
            sky.scale = tint * strength;
            ask_sky(e, sky, "Sky's light", "sky.scale");
        }
    }
    ImGui::PopID();
}

void draw_scene_settings(Editor& e) {
    sky_section(e);
    camera_section(e);
    film_section(e);
    lights_section(e);
    render_section(e);
}

} // namespace restage::editor
