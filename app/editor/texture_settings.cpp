// SPDX-License-Identifier: Apache-2.0
#include "texture_settings.hpp"

#include "contexts.hpp"
#include "model/texture.hpp"
#include "panels/state.hpp"
#include "place_texture.hpp"
#include "plugin/registry.hpp"
#include "project_texture.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <cmath>
#include <filesystem>
#include <span>
#include <utility>

namespace restage::editor {

namespace {

using TextureId = scene::Id<scene::Texture>;

// Reads the file on another thread, then requests the edit built by `with`.
void read_image(EditContext& e, const std::string& file, scene::Encoding encoding,
                std::function<Result<scene::Edit>(const scene::Scene&, scene::Image)> with) {
    const std::string path = std::filesystem::absolute(file).lexically_normal().string();
    e.panel_state->loads.start(
        {.path = path,
         .encoding = encoding,
         .done = [&e, path, encoding, with = std::move(with)](Result<std::shared_ptr<const scene::PixelData>> pixels) {
             if (!pixels) {
                 e.notices.add(LogLevel::error, pixels.error().message);
                 return;
             }
             scene::Image image{.name = std::filesystem::path(path).stem().string(),
                                .path = path,
                                .encoding = encoding,
                                .data = *pixels};
             e.edit([with, image = std::move(image)](const scene::Scene& s) { return with(s, image); });
         }});
}

void image_rows(EditContext& e, TextureId id, const scene::Texture& texture, const std::string& mark) {
    const scene::Image* image = e.scene().images.find(texture.image);
    form_row("Image", image && !image->path.empty() ? image->path.c_str() : "Its picture");
    const std::string name = image ? image->name : "Choose...";
    if (ImGui::Button((name + "###image").c_str(), {ImGui::CalcItemWidth(), 0})) ImGui::OpenPopup("image");
    tip("Click to choose another file");
    e.mark(mark);
    if (ImGui::BeginPopup("image")) {
        image_file_item(e, mark);
        ImGui::EndPopup();
    }
    if (const std::string file = chosen_image_file(e, mark); !file.empty())
        read_image(e, file,
                   image              ? image->encoding
                   : texture.is_float ? scene::Encoding::linear
                                      : scene::Encoding::srgb,
                   [id](const scene::Scene& s, scene::Image i) { return scene::set_image(s, id, std::move(i)); });
    if (image && image->data)
        ImGui::TextDisabled("%u × %u, %s", image->data->width, image->data->height,
                            image->encoding == scene::Encoding::srgb ? "sRGB" : "linear");
    else
        warning_note(image ? "The image is missing; grey is shown." : "It has no image yet; grey is shown.");
}

void type_row(EditContext& e, TextureId id, const scene::Texture& texture,
              const std::optional<plugin::TextureEntry>& plugin, const std::string& mark) {
    form_row("Type", plugin ? plugin->table->tooltip.c_str() : "The type of texture");
    if (ImGui::BeginCombo("##type", (plugin ? plugin->table->label : texture.type).c_str(),
                          ImGuiComboFlags_HeightLargest)) {
        for (const plugin::TextureEntry& choice : e.registry().textures()) {
            const bool current = texture.type == choice.table->type;
            if (ImGui::Selectable(choice.table->label.c_str(), current) && !current)
                e.edit([id, plugin, choice](const scene::Scene& s) {
                    return scene::switch_texture_type(s, id, plugin ? plugin->table : nullptr, *choice.table);
                });
            tip(choice.table->tooltip.c_str());
            e.mark(mark + "." + choice.table->type);
        }
        ImGui::EndCombo();
    }
    e.mark(mark);
}

// A parameter that is an operand may hold a texture, whose rows follow.
void param_row(EditContext& e, TextureId id, const scene::Texture& texture, const model::Param& line,
               const std::string& mark) {
    const scene::Value* set = texture.params.find(line.id);
    const bool fits = set && set->type == line.type;
    scene::TextureSlot slot{.of = id,
                            .param = line.id,
                            .value = fits ? *set : scene::default_value(line),
                            .scalar = texture.is_float || line.type == model::ParamType::number};
    const SlotRules rules{.scalar = slot.scalar, .inside = id};
    model::Param shown = line;
    const bool grey = line.type == model::ParamType::color && texture.is_float; // a number on a colour's row
    if (grey) shown.type = model::ParamType::number;
    scene::Value value = slot.value;
    value.type = shown.type;
    ParamAsk ask = param_widget(e, shown, value, set != nullptr, mark + "." + line.id, nullptr, &rules);
    if (grey && ask.value) {
        ask.value->type = model::ParamType::color;
        ask.value->v[1] = ask.value->v[2] = ask.value->v[0];
    }
    carry_out(e, slot, ask, fmt::format("texture.{}.{}", id.value, line.id));
}

// Its place on the surface: the tool in the picture, and its direction in figures.
void place_rows(EditContext& e, TextureId id, const scene::Texture& texture, const std::string& mark) {
    form_row("Place", "Where it is on the surface");
    if (ImGui::Button("In the picture", {ImGui::CalcItemWidth(), 0})) ask_to_place(e, id);
    tip("A frame on the object moves, turns and scales it");
    e.mark(mark + ".place");
    const scene::TextureMap map = scene::texture_map(texture.params);
    float turn = float(scene::turn_of(map));
    form_row("Turn", "Of the texture in its coordinates, about the middle of them");
    if (ImGui::DragFloat("##turn", &turn, 0.5f, -180, 180, "%.1f°", ImGuiSliderFlags_AlwaysClamp))
        e.edit(
            [id, turn](const scene::Scene& s) -> Result<scene::Edit> {
                const scene::Texture* now = s.textures.find(id);
                if (!now) return fail("the texture no longer exists");
                const scene::TextureMap before = scene::texture_map(now->params);
                const double by = glm::radians(double(turn) - scene::turn_of(before));
                const glm::dmat2 rotation(std::cos(by), std::sin(by), -std::sin(by), std::cos(by));
                const std::pair after(id, scene::transformed(before, rotation, glm::dvec2(0.5)));
                return scene::set_texture_maps(s, std::span(&after, 1), "Turn texture " + now->name);
            },
            "texture.turn." + std::to_string(id.value));
    e.mark(mark + ".turn");
}

std::size_t slots_with(const scene::Scene& scene, TextureId id) {
    std::size_t slots = 0;
    const auto count = [&](const scene::ParamSet& params) {
        for (const auto& entry : params.entries())
            slots += entry.value.texture == id;
    };
    scene.materials.each([&](auto, const scene::Material& m) { count(m.params); });
    scene.textures.each([&](auto, const scene::Texture& t) { count(t.params); });
    return slots;
}

// On objects without texture coordinates, if it is the texture of a material.
Result<scene::Edit> projected(DocumentContext& e, const scene::TextureSlot& slot, const scene::Scene& s,
                              Result<scene::Edit> edit) {
    const auto* material = std::get_if<scene::Id<scene::Material>>(&slot.of);
    return material ? project_where_needed(e, s, std::move(edit), *material) : edit;
}

} // namespace

void carry_out(EditContext& e, const scene::TextureSlot& slot, const ParamAsk& ask, const std::string& gesture) {
    if (!ask.image_file.empty()) // colours are sRGB; heights, normals and roughness are data
        read_image(e, ask.image_file,
                   slot.value.type == model::ParamType::color && !slot.scalar ? scene::Encoding::srgb
                                                                              : scene::Encoding::linear,
                   [&e, slot](const scene::Scene& s, scene::Image i) {
                       return projected(e, slot, s, scene::set_image_texture(s, slot, std::move(i)));
                   });
    if (const auto plugin = e.registry().find_texture(ask.new_texture))
        e.edit([&e, slot, plugin](const scene::Scene& s) {
            auto edit = scene::new_texture(s, slot, *plugin->table);
            return plugin->table->mapped ? projected(e, slot, s, std::move(edit)) : edit;
        });
    std::visit(
        [&](auto id) {
            if (ask.reset || (ask.value && ask.value->type == model::ParamType::texture && !ask.value->texture))
                e.edit([id, param = slot.param](const scene::Scene& s) { return scene::reset_param(s, id, param); });
            else if (ask.value)
                e.edit([id, param = slot.param,
                        v = *ask.value](const scene::Scene& s) { return scene::set_param(s, id, param, v); },
                       gesture);
        },
        slot.of);
}

void texture_settings(EditContext& e, TextureId id, const std::string& mark) {
    const scene::Texture& texture = e.scene().textures[id];
    const auto plugin = e.registry().find_texture(texture.type);
    const bool open = ImGui::TreeNodeEx("settings", ImGuiTreeNodeFlags_SpanAvailWidth, "%s",
                                        (plugin ? plugin->table->label : texture.type).c_str());
    e.mark(mark);
    if (!open) return;
    if (const std::size_t slots = slots_with(e.scene(), id); slots > 1) {
        ImGui::TextColored(colors::hover, "In %zu places", slots);
        tip("Changes affect all of them");
        e.mark(mark + ".shared");
    }
    type_row(e, id, texture, plugin, mark + ".type");
    std::string name = texture.name;
    form_row("Name", "The texture's name");
    if (name_field("##name", name)) e.edit([id, name](const scene::Scene& s) { return scene::rename(s, id, name); });
    e.mark(mark + ".name");
    if (!plugin) {
        warning_note(
            fmt::format("No plugin provides \"{}\". It is shown as its average; its values are kept and written back.",
                        texture.type)
                .c_str());
        ImGui::TreePop();
        return;
    }
    const model::Texture& table = *plugin->table;
    if (table.mapped) place_rows(e, id, texture, mark);
    if (table.image) image_rows(e, id, texture, mark + ".image");
    std::vector<const model::Param*> advanced;
    const auto row = [&](const model::Param& line, bool folded) {
        if (folded)
            advanced.push_back(&line);
        else
            param_row(e, id, texture, line, mark);
    };
    for (const model::Param& line : table.params)
        row(line, line.advanced);
    if (table.mapped)
        for (const model::Param& line : model::mapping_params())
            row(line, !line.id.ends_with("scale") && !line.id.ends_with("delta"));
    if (!advanced.empty()) {
        const bool unfolded = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_SpanAvailWidth);
        e.mark(mark + ".advanced");
        if (unfolded) {
            for (const model::Param* line : advanced)
                param_row(e, id, texture, *line, mark);
            ImGui::TreePop();
        }
    }
    ImGui::TreePop();
}

} // namespace restage::editor
