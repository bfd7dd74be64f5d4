// SPDX-License-Identifier: Apache-2.0
// Scene panel, sky: the environment, visible and emitting light where the scene ends.
#include "document/session.hpp"
#include "panel_context.hpp"
#include "panels.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "scene_development.hpp"
#include "scene_panel.hpp"
#include "sky_blurring.hpp"

#include "document/exposure.hpp"
#include "io/material_emission.hpp"
#include "io/sky.hpp"
#include "param_widget.hpp"
#include "scene/sky.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

namespace restage::editor {

namespace {

using scene::Environment;

// The part of a rotation about `axis` [deg] (swing-twist decomposition): a rotation by d about it adds d.
double twist(const glm::dmat4& m, const glm::dvec3& axis) {
    glm::dmat3 r(m);
    if (glm::determinant(r) < 0) r[0] = -r[0]; // a mirrored sky has the twist of its mirror image
    for (int i = 0; i < 3; ++i)
        r[i] = glm::normalize(r[i]);
    const glm::dquat q(r);
    return glm::degrees(2 * std::atan2(glm::dot(glm::dvec3(q.x, q.y, q.z), axis), q.w));
}

double wrapped(double degrees) { return degrees - 360 * std::floor((degrees + 180) / 360); }

void ask_sky(EditContext& e, std::optional<Environment> sky, const char* label, const char* gesture = "") {
    e.edit([sky = std::move(sky),
            label](const scene::Scene& s) { return Result<scene::Edit>(scene::set_environment(s, sky, label)); },
           gesture);
}

// Candidate files: assets, and the scene's images. Bump maps and the like are excluded.
std::vector<std::string> known_skies(DocumentContext& e) {
    std::vector<std::string> known;
    const auto add = [&](const std::string& path) {
        if (!path.empty() && std::find(known.begin(), known.end(), path) == known.end()) known.push_back(path);
    };
    for (const std::string& path : assets_of(e, AssetKind::sky)) {
        const auto small = e.panel_state->assets.thumbnails.find(path);
        const bool seen = small != e.panel_state->assets.thumbnails.end();
        if (seen && small->second.failed) continue;
        // Only the shape of the thumbnail matters; files without one are included.
        const bool shaped = seen && small->second.size.y > 0;
        const auto wide =
            std::uint32_t(shaped ? std::lround(4096 * small->second.size.x / small->second.size.y) : 8192);
        if (plausible_sky(path, wide, 4096)) add(path);
    }
    std::set<std::uint32_t> on_surfaces; // images used by textures
    e.scene().textures.each([&](auto, const scene::Texture& t) { on_surfaces.insert(t.image.value); });
    e.scene().images.each([&](scene::Id<scene::Image> id, const scene::Image& i) {
        const bool sky = e.scene().environment.value && e.scene().environment.value->image == id;
        if (sky || (i.data && !on_surfaces.contains(id.value) && plausible_sky(i.path, i.data->width, i.data->height)))
            add(i.path);
    });
    return known;
}

void image_row(EditContext& e, const Environment& sky) {
    const scene::Image* image = e.scene().images.find(sky.image);
    form_row("Image", image ? image->path.c_str() : "A panorama as the environment: HDR or EXR is best");
    if (ImGui::Button(image ? (image->name + "###image").c_str() : "Choose...###image", {ImGui::CalcItemWidth(), 0}))
        ImGui::OpenPopup("sky image");
    if (image && !image->data)
        tip("The file could not be read: see Import report");
    else
        tip("Choose another, or drop an image here");
    e.mark("sky.image");
    if (ImGui::BeginDragDropTarget()) {
        if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("restage.path"))
            use_as_sky(e, static_cast<const char*>(payload->Data));
        ImGui::EndDragDropTarget();
    }
    if (const std::string file = chosen_image_file(e, "sky"); !file.empty()) use_as_sky(e, file);
    if (!ImGui::BeginPopup("sky image")) return;
    const std::vector<std::string> known = known_skies(e);
    if (!known.empty()) {
        std::vector<std::string> names;
        for (const std::string& path : known)
            names.push_back(std::filesystem::path(path).filename().string());
        const float high = 2.2f * ImGui::GetTextLineHeight(), wide = 2 * high;
        searched_list(
            e.panel_state->scene.sky_search, known.size(), [&](std::size_t i) -> std::string_view { return names[i]; },
            [&](std::size_t i) {
                const ImVec2 at = ImGui::GetCursorScreenPos();
                if (ImGui::Selectable("##sky", image && image->path == known[i], 0, {0, high})) {
                    use_as_sky(e, known[i]);
                    ImGui::CloseCurrentPopup();
                }
                tip(known[i].c_str());
                e.mark("sky.choose." + names[i]);
                ImDrawList* draw = ImGui::GetWindowDrawList();
                const AssetsState::Thumbnail& small = thumbnail_of(e, known[i]);
                if (small.texture && small.texture->ready()) {
                    draw->AddImage(small.texture->ref(), {at.x, at.y + 1}, {at.x + wide, at.y + high - 1});
                    e.mark("sky.thumbnail." + names[i], at, {at.x + wide, at.y + high});
                } else {
                    draw->AddRectFilled({at.x, at.y + 1}, {at.x + wide, at.y + high - 1},
                                        ImGui::GetColorU32(ImGuiCol_FrameBg));
                }
                draw->AddText(
                    {at.x + wide + ImGui::GetStyle().ItemSpacing.x, at.y + (high - ImGui::GetTextLineHeight()) / 2},
                    ImGui::GetColorU32(ImGuiCol_Text), names[i].c_str());
            },
            high + ImGui::GetStyle().ItemSpacing.y);
        ImGui::Separator();
    }
    image_file_item(e, "sky");
    ImGui::EndPopup();
}

// --- skies of plugins
// -----------------------------------------------------------------------------------------------------------

void ask_made_sky(DocumentContext& e, const plugin::SkyEntry& sky, scene::ParamSet values, std::string gesture) {
    e.panel_state->skies.ask({sky, std::move(values), std::move(gesture)}, e.scene().environment.value);
}

void sky_param(EditContext& e, const plugin::SkyEntry& sky, const scene::ParamSet& values, const model::Param& line) {
    const scene::Value* set = values.find(line.id);
    const bool fits = set && set->type == line.type;
    const ParamAsk ask =
        param_widget(e, line, fits ? *set : scene::default_value(line), set != nullptr, "sky." + line.id);
    if (!ask.reset && !ask.value) return;
    scene::ParamSet changed = values;
    if (ask.reset)
        changed.remove(line.id);
    else
        changed.set(line.id, *ask.value);
    ask_made_sky(e, sky, std::move(changed), "sky.made." + line.id);
}

void sky_params(EditContext& e, const Environment& now) {
    const auto sky = io::find_sky(e.registry(), now.sky);
    if (!sky)
        return warning_note(fmt::format("No plugin provides \"{}\". Its picture is kept, a coarse one if it was saved "
                                        "without; its values are kept and written back.",
                                        now.sky)
                                .c_str());
    const SkyMaking::Job* wanted = e.panel_state->skies.wanted();
    const scene::ParamSet values = wanted && wanted->sky.table->type == now.sky ? wanted->values : now.sky_params;
    bool advanced = false;
    for (const model::Param& line : sky->table->params)
        if (line.advanced)
            advanced = true;
        else
            sky_param(e, *sky, values, line);
    if (!advanced) return;
    const bool unfolded = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_SpanAvailWidth);
    e.mark("sky.advanced");
    if (!unfolded) return;
    for (const model::Param& line : sky->table->params)
        if (line.advanced) sky_param(e, *sky, values, line);
    ImGui::TreePop();
}

} // namespace

void follow_sky(EditContext& e) {
    SkyMaking& skies = e.panel_state->skies;
    auto made = skies.take(e.scene().environment.value);
    if (!made) return;
    if (!made->pixels) return e.notices.add(LogLevel::error, made->pixels.error().message);
    const std::string gesture = made->job.gesture;
    e.edit(
        [&e, job = std::move(made->job), pixels = *made->pixels](const scene::Scene& s) {
            scene::Edit edit =
                scene::made_sky(s, job.sky.table->label, job.sky.table->type, job.values, pixels, e.up());
            for (const scene::AnyChange& change : edit.changes)
                if (const auto* sky = std::get_if<scene::ChangeOne<std::optional<Environment>>>(&change))
                    e.panel_state->skies.made_environment(sky->after);
            return Result<scene::Edit>(std::move(edit));
        },
        gesture);
}

bool has_light(const DocumentContext& e) { return document::has_light(e.scene(), e.registry()); }

void light_with_studio(EditContext& e) {
    e.edit([&registry = e.registry()](const scene::Scene& s) {
        return Result<scene::Edit>(document::light_studio(s, registry));
    });
}

void use_as_sky(EditContext& e, const std::string& file) {
    const std::string path = std::filesystem::absolute(file).lexically_normal().string();
    e.panel_state->loads.start({.path = path,
                                .encoding = scene::Encoding::srgb,
                                .done = [&e, path](Result<std::shared_ptr<const scene::PixelData>> pixels) {
                                    if (!pixels) {
                                        e.notices.add(LogLevel::error, pixels.error().message);
                                        return;
                                    }
                                    e.edit([path, data = *pixels, up = e.up()](const scene::Scene& s) {
                                        return Result<scene::Edit>(scene::image_sky(s, path, data, up));
                                    });
                                }});
}

void sky_section(EditContext& e) {
    const bool open = section_header("Sky", true);
    e.mark("scene.sky");
    if (!open) return;
    ImGui::PushID("sky");
    if (!has_light(e)) {
        warning_note("Nothing emits light in this scene, so its picture is black.");
        if (ImGui::Button("Light it with a neutral studio")) light_with_studio(e);
        tip("Soft grey light from all directions; in a closed room also a lamp at the camera");
        e.mark("sky.studio");
    }
    const auto& now = e.scene().environment.value;
    static constexpr const char* kinds[] = {"None", "One colour", "Image", "Neutral studio"};
    const bool made = now && !now->sky.empty();
    int kind = !now ? 0 : made ? 4 : !now->image ? 1 : 2;
    form_row("Sky", "The light beyond the scene");
    if (ImGui::BeginCombo("##kind", made ? now->name.c_str() : kinds[kind])) {
        for (int i = 0; i < 4; ++i) {
            if (ImGui::Selectable(kinds[i], i == kind) && i != kind) {
                Environment sky =
                    now.value_or(Environment{.name = "Sky", .light_to_world = scene::upright_sky(e.up())});
                if (i == 0) ask_sky(e, std::nullopt, "No sky");
                if (i == 1) {
                    sky.image = {}, sky.sky.clear(), sky.sky_params = {};
                    ask_sky(e, sky, "Sky of one colour");
                }
                if (i == 3)
                    e.edit(
                        [up = e.up()](const scene::Scene& s) { return Result<scene::Edit>(scene::studio_sky(s, up)); });
                if (i == 2) e.panel_state->scene.choose_sky = true;
            }
            e.mark(std::string("sky.kind.") + kinds[i]);
        }
        const auto catalogue = e.registry().catalogue();
        for (const plugin::SkyEntry& sky : catalogue->skies) {
            const bool is = made && now->sky == sky.table->type;
            if (ImGui::Selectable(sky.table->label.c_str(), is) && !is) ask_made_sky(e, sky, {}, "");
            tip(sky.table->tooltip.c_str());
            e.mark("sky.kind." + sky.table->type);
        }
        ImGui::EndCombo();
    }
    e.mark("sky.kind");
    const bool choosing = e.panel_state->scene.choose_sky;
    if (now && now->image && !made) e.panel_state->scene.choose_sky = false;
    if (made) sky_params(e, *now);
    if ((now && now->image && !made) || choosing) image_row(e, now && !made ? *now : Environment{});
    if (now) {
        Environment sky = *now;
        bool changed = false;
        if (sky.image) {
            const double before = twist(sky.light_to_world, e.up());
            double angle = wrapped(before);
            form_row("Rotation", "Rotates the sky, including its sun, about the scene's up");
            if (ImGui::DragScalar("##rotation", ImGuiDataType_Double, &angle, 0.5f, nullptr, nullptr, "%.1f°")) {
                sky.light_to_world =
                    glm::rotate(glm::dmat4(1), glm::radians(angle - before), e.up()) * sky.light_to_world;
                ask_sky(e, sky, "Rotate sky", "sky.rotation");
            }
            e.mark("sky.rotation");
            blur_row(e);
        }
        float strength = std::max({sky.scale.x, sky.scale.y, sky.scale.z});
        glm::vec3 tint = strength > 0 ? sky.scale / strength : glm::vec3(1);
        form_row(sky.image ? "Tint" : "Colour",
                 sky.image ? "Multiplies the image's colours" : "Colour of the light from all directions");
        if (color_field("##tint", &tint.x)) {
            if (const float most = std::max({tint.x, tint.y, tint.z}); most > 0) tint /= most;
            changed = true;
        }
        e.mark("sky.tint");
        form_row("Strength", sky.image ? "Multiplies the image's brightness" : "How bright it is (radiance)");
        changed |= ImGui::DragFloat("##strength", &strength, drag_speed(strength, 1e-3f), 0, 1e6f,
                                    sky.image ? "%.4g×" : "%.4g W/(m²sr)", ImGuiSliderFlags_AlwaysClamp);
        e.mark("sky.strength");
        form_row("Hide from view",
                 "Shows a backdrop instead. It still emits light, and is visible in mirrors and glass");
        if (bool hidden = sky.hidden_from_camera; ImGui::Checkbox("##hidden", &hidden)) {
            Environment other = *now;
            other.hidden_from_camera = hidden;
            ask_sky(e, other, hidden ? "Hide sky" : "Show sky");
        }
        e.mark("sky.hidden");
        if (changed) {
            sky.scale = tint * strength;
            ask_sky(e, sky, "Sky's light", "sky.scale");
        }
    }
    if (!now || now->hidden_from_camera) backdrop_rows(e);
    ImGui::PopID();
}

void draw_scene_settings(SelectContext& e, PictureView& picture) {
    choices_section(e);
    sky_section(e);
    camera_section(e);
    film_section(e);
    development_section(e);
    lights_section(e);
    render_section(e, picture);
}

} // namespace restage::editor
