// SPDX-License-Identifier: Apache-2.0
#include "param_widget.hpp"

#include "document/session.hpp"
#include "file_browser.hpp"
#include "io/image_file.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "plugin/table_reader.hpp"
#include "scene/edits_texture.hpp"
#include "texture_settings.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

constexpr float slider_span = 20; // the largest range for which a slider is useful; a drag is better beyond

bool number(const model::Param& line, float& v) {
    const std::string unit = line.unit == "deg" ? "°" : line.unit.empty() ? "" : " " + line.unit;
    const std::string format = "%.4g" + unit;
    if (line.max - line.min <= slider_span)
        return ImGui::SliderFloat("##value", &v, line.min, line.max, format.c_str(), ImGuiSliderFlags_AlwaysClamp);
    return ImGui::DragFloat("##value", &v, drag_speed(v), line.min, line.max, format.c_str(),
                            ImGuiSliderFlags_AlwaysClamp);
}

std::string default_text(const model::Param& line) {
    const scene::Value v = scene::default_value(line);
    switch (v.type) {
        case model::ParamType::color:
            return fmt::format("{:.3g}, {:.3g}, {:.3g}", v.v[0], v.v[1], v.v[2]);
        case model::ParamType::boolean:
            return v.i != 0 ? "on" : "off";
        case model::ParamType::choice:
            return v.text;
        case model::ParamType::number:
            return fmt::format("{:.4g}", v.v[0]);
        case model::ParamType::integer:
            return fmt::format("{}", v.i);
        case model::ParamType::table:
            return v.text.empty() ? "none" : std::filesystem::path(v.text).filename().string();
        default:
            return "none";
    }
}

bool enum_combo(const model::Param& line, scene::Value& v) {
    bool changed = false;
    if (!ImGui::BeginCombo("##value", choice_label(v.text).c_str())) return false;
    for (const std::string& choice : line.choices) {
        if (ImGui::Selectable(choice_label(choice).c_str(), choice == v.text)) {
            changed = v.text != choice;
            v.text = choice;
        }
    }
    ImGui::EndCombo();
    return changed;
}

bool material_combo(EditContext& e, scene::Value& v, const std::string& mark) {
    const scene::Material* current = e.scene().materials.find(v.material);
    bool changed = false;
    if (!ImGui::BeginCombo("##value", current ? current->name.c_str() : "None")) return false;
    e.scene().materials.each([&](scene::Id<scene::Material> id, const scene::Material& m) {
        if (ImGui::Selectable(fmt::format("{}##{}", m.name, id.value).c_str(), id == v.material)) {
            v.material = id;
            changed = true;
        }
        e.mark(mark + "." + m.name);
    });
    ImGui::EndCombo();
    return changed;
}

// The types of all plugins, by name.
void new_texture_menu(EditContext& e, ParamAsk& ask, const std::string& mark) {
    const bool open = ImGui::BeginMenu("New texture");
    e.mark(mark);
    if (!open) return;
    for (const plugin::TextureEntry& entry : e.registry().textures()) {
        if (ImGui::MenuItem((entry.table->label + "###" + entry.table->type).c_str()))
            ask.new_texture = entry.table->type;
        tip(entry.table->tooltip.c_str());
        e.mark(mark + "." + entry.table->type);
    }
    ImGui::EndMenu();
}

// The choices for a slot: the scene's textures, a new one, a file, none.
void texture_popup(EditContext& e, const scene::Value& value, bool scalar, const SlotRules* rules, ParamAsk& ask,
                   const std::string& mark) {
    if (!ImGui::BeginPopup("texture")) return;
    if (value.texture) {
        if (ImGui::MenuItem("Remove the texture")) {
            ask.value = value;
            ask.value->texture = {};
        }
        e.mark(mark + ".texture.remove");
        ImGui::Separator();
    }
    if (rules) new_texture_menu(e, ask, mark + ".texture.new");
    std::vector<scene::Id<scene::Texture>> ids;
    e.scene().textures.each([&](scene::Id<scene::Texture> id, const scene::Texture& t) {
        if (t.is_float != scalar && t.type != "imagemap") return;
        if (!rules || !rules->inside || !scene::contains(e.scene(), id, rules->inside)) ids.push_back(id);
    });
    if (ids.empty())
        ImGui::TextDisabled("The scene has no other textures.");
    else
        searched_list(
            e.panel_state->texture_search, ids.size(),
            [&](std::size_t i) -> std::string_view { return e.scene().textures[ids[i]].name; },
            [&](std::size_t i) {
                const scene::Texture& t = e.scene().textures[ids[i]];
                if (ImGui::Selectable(t.name.c_str(), ids[i] == value.texture)) {
                    ask.value = value;
                    ask.value->texture = ids[i];
                    ImGui::CloseCurrentPopup();
                }
                e.mark(mark + ".texture." + t.name);
            });
    ImGui::Separator();
    image_file_item(e, mark + ".texture");
    ImGui::EndPopup();
}

std::optional<std::string> dropped_path() {
    std::optional<std::string> path;
    if (!ImGui::BeginDragDropTarget()) return path;
    if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload("restage.path"))
        path = static_cast<const char*>(payload->Data);
    ImGui::EndDragDropTarget();
    return path;
}

// The name of a table's file, a drop target and file chooser. Below it, its error if there is one.
bool table_field(EditContext& e, const model::Param& line, scene::Value& v, const plugin::TableReader* reader,
                 const std::string& mark) {
    const std::filesystem::path path(v.text);
    const std::string problem = reader ? reader->problem(line.id, v.text) : "";
    const float button = ImGui::CalcTextSize("Choose...").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    std::string shown = v.text.empty() ? "None" : path.filename().string();
    ImGui::SetNextItemWidth(std::max(ImGui::CalcItemWidth() - button - gap, button));
    if (!problem.empty()) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::ColorConvertFloat4ToU32(colors::error));
    ImGui::InputText("##value", &shown, ImGuiInputTextFlags_ReadOnly);
    if (!problem.empty()) ImGui::PopStyleColor();
    tip((line.tooltip + (line.tooltip.empty() ? "" : "\n") + (v.text.empty() ? "No file is chosen" : v.text)).c_str());
    e.mark(mark + ".file");
    std::optional<std::string> chosen = dropped_path();
    ImGui::SameLine(0, gap);
    if (ImGui::Button("Choose...")) {
        std::vector<FileFilter> filters;
        if (reader) filters.push_back({"Tables", reader->extensions()});
        filters.push_back({"All files", {}});
        const std::filesystem::path document(e.session().path());
        browse(e, {.title = "Choose a file",
                   .filters = std::move(filters),
                   .start = path.empty() ? document.parent_path() : path.parent_path(),
                   .done = [mark](PanelUi& editor, const std::filesystem::path& file) {
                       editor.panel_state->image_choice = {mark, file.string()};
                   }});
    }
    tip("Choose a file, or drop one on its name");
    if (const std::string file = chosen_image_file(e, mark); !file.empty()) chosen = file;
    if (!chosen) return false;
    v.text = std::filesystem::absolute(*chosen).lexically_normal().string();
    return true;
}

void accept_image(ParamAsk& ask) {
    if (auto path = dropped_path()) ask.image_file = std::move(*path);
}

} // namespace

void image_file_item(EditContext& e, const std::string& mark) {
    if (ImGui::MenuItem("Image file...")) {
        const std::filesystem::path document(e.session().path());
        browse(e,
               {.title = "Choose an image",
                .filters = {{"Images", {"png", "jpg", "jpeg", "exr", "hdr", "tga", "bmp", "pfm"}}, {"All files", {}}},
                .start = document.parent_path(),
                .done = [mark](PanelUi& editor, const std::filesystem::path& path) {
                    editor.panel_state->image_choice = {mark, path.string()};
                }});
    }
    tip("PNG, JPG, EXR, HDR, TGA, BMP or PFM");
    e.mark(mark + ".file");
}

std::string chosen_image_file(PanelUi& e, const std::string& mark) {
    auto& [asked_by, path] = e.panel_state->image_choice;
    return asked_by == mark ? std::exchange(path, {}) : "";
}

bool color_field(const char* id, float* linear, bool hdr) {
    if (hdr) return ImGui::ColorEdit3(id, linear, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
    float seen[3];
    for (int i = 0; i < 3; ++i)
        seen[i] = io::linear_to_srgb(linear[i]);
    const float before[3] = {seen[0], seen[1], seen[2]};
    if (!ImGui::ColorEdit3(id, seen, ImGuiColorEditFlags_Float)) return false;
    for (int i = 0; i < 3; ++i) // an untouched channel keeps its exact value
        if (seen[i] != before[i]) linear[i] = io::srgb_to_linear(seen[i]);
    return true;
}

scene::ParamSet fitting(model::ParamTable table, const scene::ParamSet& values) {
    scene::ParamSet result;
    for (const model::Param& line : table)
        if (const scene::Value* set = values.find(line.id); set && misfit(line, *set).empty())
            result.set(line.id, *set);
    return result;
}

ParamAsk param_widget(EditContext& e, const model::Param& line, const scene::Value& value, bool is_set,
                      const std::string& mark, const plugin::TableReader* reader, const SlotRules* rules) {
    ParamAsk ask;
    scene::Value v = value;
    const bool textured = e.scene().textures.find(value.texture) != nullptr;
    const bool slot = line.type == model::ParamType::texture || line.texturable;
    ImGui::PushID(line.id.c_str());
    const float square = ImGui::GetFrameHeight();
    form_row(line.label.c_str(), line.tooltip.c_str(), slot && line.type != model::ParamType::texture ? square : 0);
    bool changed = false;
    if (textured || line.type == model::ParamType::texture) {
        const scene::Texture* texture = e.scene().textures.find(value.texture);
        const std::string name = texture ? texture->name : "None";
        if (ImGui::Button((name + "###value").c_str(), {ImGui::CalcItemWidth(), 0})) ImGui::OpenPopup("texture");
        tip(texture ? "A texture replaces this value: click to choose another, or none"
                    : "Click to choose a texture, or drop an image here");
        accept_image(ask);
    } else {
        switch (line.type) {
            case model::ParamType::number:
                changed = number(line, v.v[0]);
                break;
            case model::ParamType::color:
                changed = color_field("##value", v.v.data(), line.max > 1);
                break;
            case model::ParamType::integer:
                changed =
                    ImGui::SliderInt("##value", &v.i, line.int_min, line.int_max, "%d", ImGuiSliderFlags_AlwaysClamp);
                break;
            case model::ParamType::boolean: {
                bool on = v.i != 0;
                changed = ImGui::Checkbox("##value", &on);
                v.i = on;
                break;
            }
            case model::ParamType::choice:
                changed = enum_combo(line, v);
                break;
            case model::ParamType::text:
                changed = ImGui::InputText("##value", &v.text);
                break;
            case model::ParamType::material:
                changed = material_combo(e, v, mark);
                break;
            case model::ParamType::table:
                changed = table_field(e, line, v, reader, mark);
                break;
            case model::ParamType::texture:
                break;
        }
        if (line.type != model::ParamType::table) tip(line.tooltip.c_str());
    }
    e.mark(mark);
    if (ImGui::BeginPopupContextItem("param")) {
        if (ImGui::MenuItem(fmt::format("Back to the default ({})", default_text(line)).c_str(), nullptr, false,
                            is_set))
            ask.reset = true;
        e.mark(mark + ".reset");
        ImGui::EndPopup();
    }
    if (slot && line.type != model::ParamType::texture) {
        ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
        if (icon_button("slot", Icon::texture, textured, "Vary this value by a texture, or drop an image here"))
            ImGui::OpenPopup("texture");
        e.mark(mark + ".texture");
        accept_image(ask);
    }
    if (slot) {
        texture_popup(e, value, rules ? rules->scalar : line.type == model::ParamType::number, rules, ask, mark);
        if (const std::string file = chosen_image_file(e, mark + ".texture"); !file.empty()) ask.image_file = file;
    }
    if (changed) ask.value = v;
    if (line.type == model::ParamType::table && reader)
        if (const std::string problem = reader->problem(line.id, value.text); !problem.empty()) {
            error_note((problem + ". It is shown as grey.").c_str());
            e.mark(mark + ".problem");
        }
    if (textured && rules) texture_settings(e, value.texture, mark + ".of");
    ImGui::PopID();
    return ask;
}

} // namespace restage::editor
