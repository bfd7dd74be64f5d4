// SPDX-License-Identifier: Apache-2.0
// Inspector, material: its name, the objects that share it, its type, and a row for every line of the plugin's table.
#include "copy_paste.hpp"
#include "drop.hpp"
#include "inspector.hpp"
#include "library.hpp"
#include "panel_context.hpp"
#include "panels/plugin_ui.hpp"
#include "param_widget.hpp"
#include "pick_tool.hpp"
#include "plugin/registry.hpp"
#include "project_texture.hpp"
#include "scene/edits_texture.hpp"
#include "scene/merge.hpp"
#include "state.hpp"
#include "texture_settings.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace restage::editor {

using MaterialId = scene::Id<scene::Material>;

namespace {

scene::ParamTable table_of(const std::optional<plugin::MaterialEntry>& plugin) {
    return plugin ? scene::ParamTable(plugin->table->params) : scene::ParamTable();
}

// Its ball; until that is rendered, its main colour.
void swatch(DocumentContext& e, MaterialId id, ImVec2 at, float size) {
    const Texture* ball = e.panel_state->balls.ball({e.registry(), e.log(), e.options().renderer}, e.scene(), id);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + size, at.y + size);
    if (ball) {
        draw->AddImageRounded(ball->ref(), at, end, {0, 0}, {1, 1}, IM_COL32_WHITE, size * 0.15f);
        e.mark("material.ball." + e.scene().materials[id].name, at, end);
        return;
    }
    const glm::vec3 c = swatch_color(e, e.scene().materials[id]);
    draw->AddRectFilled(at, end, ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1}), size * 0.15f);
}

std::string type_name(const model::Material& table) { return table.label + " (" + table.type + ")"; }

struct TypeUse {
    plugin::MaterialEntry type;
    std::map<std::string, std::size_t> presets; // by what they are
    const document::Preset* example = nullptr; // of the main category
};

// The types by what most of their presets are; those without presets come last.
std::vector<std::pair<std::string, std::vector<TypeUse>>> types_by_use(DocumentContext& e) {
    std::map<std::string, std::vector<TypeUse>> found;
    std::vector<TypeUse> others;
    for (const plugin::MaterialEntry& type : e.registry().materials()) {
        TypeUse use{.type = type, .presets = {}};
        std::map<std::string, const document::Preset*> first;
        for (const LibraryItem& item : presets_of(e))
            if (item.preset->parts.materials[item.preset->material].type == type.table->type) {
                ++use.presets[item.category];
                first.emplace(item.category, item.preset.get());
            }
        const auto most = std::ranges::max_element(use.presets, {}, [](const auto& one) { return one.second; });
        if (most == use.presets.end()) {
            others.push_back(std::move(use));
            continue;
        }
        use.example = first[most->first];
        found[most->first].push_back(std::move(use));
    }
    std::vector<std::pair<std::string, std::vector<TypeUse>>> all(found.begin(), found.end());
    if (!others.empty()) all.emplace_back("Other", std::move(others));
    return all;
}

// A ball of it, its name, and what its presets are. True if it was chosen.
bool type_row(DocumentContext& e, const TypeUse& use, const std::string& current) {
    const model::Material& table = *use.type.table;
    const float line = ImGui::GetTextLineHeight(), high = 2.2f * line;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(table.type.c_str());
    const bool chosen = ImGui::Selectable("##type", current == table.type, 0, {21 * ImGui::GetFontSize(), high});
    ImGui::PopID();
    tip(table.tooltip.c_str());
    e.mark("material.type." + table.type);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const Texture* ball = use.example && ImGui::IsItemVisible()
                              ? e.panel_state->balls.ball({e.registry(), e.log(), e.options().renderer}, *use.example)
                              : nullptr;
    const ImVec2 from(at.x, at.y + 1), to(at.x + high - 2, at.y + high - 1);
    if (ball)
        draw->AddImageRounded(ball->ref(), from, to, {0, 0}, {1, 1}, IM_COL32_WHITE, high * 0.15f);
    else
        draw->AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_FrameBg), high * 0.15f);
    const float text = at.x + high + ImGui::GetStyle().ItemSpacing.x;
    std::string uses;
    for (const auto& [what, count] : use.presets)
        uses += (uses.empty() ? "" : ", ") + what;
    const float top = at.y + (high - (uses.empty() ? line : 2 * line)) / 2;
    draw->AddText({text, top}, ImGui::GetColorU32(ImGuiCol_Text), type_name(table).c_str());
    const float end = std::min(ImGui::GetItemRectMax().x, draw->GetClipRectMax().x);
    ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
    ImGui::RenderTextEllipsis(draw, {text, top + line}, {end, top + 2 * line}, end, uses.c_str(), nullptr, nullptr);
    ImGui::PopStyleColor();
    return chosen;
}

// Assigns, copies, creates. `current` may be none.
void material_choice(SelectContext& e, MaterialId current) {
    const auto selected = e.selection.instances();
    const scene::Material* material = e.scene().materials.find(current);
    const auto assign = [&](MaterialId to) {
        e.edit([&e, selected, to](const scene::Scene& s) {
            return project_where_needed(e, s, scene::set_material(s, selected, to), selected);
        });
    };
    form_row("Material", "Choose another of the scene's materials for the selection");
    if (ImGui::BeginCombo("##choose", material ? material->name.c_str() : "none", ImGuiComboFlags_HeightLargest)) {
        std::vector<MaterialId> ids;
        e.scene().materials.each([&](MaterialId id, const scene::Material&) { ids.push_back(id); });
        const float high = 2.2f * ImGui::GetTextLineHeight();
        searched_list(
            e.panel_state->inspector.material_search, ids.size(),
            [&](std::size_t i) -> std::string_view { return e.scene().materials[ids[i]].name; },
            [&](std::size_t i) {
                const scene::Material& m = e.scene().materials[ids[i]];
                const ImVec2 at = ImGui::GetCursorScreenPos();
                if (ImGui::Selectable("##material", ids[i] == current, 0, {0, high})) {
                    assign(ids[i]);
                    ImGui::CloseCurrentPopup();
                }
                e.mark("material.choose." + m.name);
                swatch(e, ids[i], {at.x, at.y + 1}, high - 2);
                ImGui::GetWindowDrawList()->AddText(
                    {at.x + high + ImGui::GetStyle().ItemSpacing.x, at.y + (high - ImGui::GetTextLineHeight()) / 2},
                    ImGui::GetColorU32(ImGuiCol_Text), m.name.c_str());
            },
            high + ImGui::GetStyle().ItemSpacing.y);
        ImGui::EndCombo();
    }
    e.mark("material.choose");

    if (flow_button("Pick", true)) e.pick_tool = material_eyedropper(e);
    tip("Take the material of an object you click in the picture");
    e.mark("material.pick");
    if (flow_button("New")) {
        const std::string type = e.registry().find_material("diffuse") || e.registry().materials().empty()
                                     ? "diffuse"
                                     : e.registry().materials().front().table->type;
        e.edit([selected, type](const scene::Scene& s) {
            std::set<std::string> taken;
            s.materials.each([&](auto, const scene::Material& m) { taken.insert(m.name); });
            const MaterialId id = s.materials.next();
            scene::Edit edit = scene::insert(
                s, scene::Material{.name = scene::free_name("Material", taken), .type = type}, "New material");
            for (const InstanceId one : selected) {
                scene::Instance after = s.instances[one];
                after.material = id;
                edit.changes.push_back(scene::Change<scene::Instance>{one, s.instances[one], std::move(after)});
            }
            return Result<scene::Edit>(std::move(edit));
        });
    }
    tip("A new matte material for the selection");
    e.mark("material.new");
    ImGui::BeginDisabled(!material);
    if (flow_button("Copy")) {
        e.material_clipboard = current;
        copy_material(e, current);
    }
    ImGui::EndDisabled();
    tip("Copy this material, to paste it on other objects, also in another Restage window");
    e.mark("material.copy");
    const scene::Material* held = e.material_clipboard ? e.scene().materials.find(*e.material_clipboard) : nullptr;
    if (flow_button("Paste")) {
        if (held && !newer_in_clipboard(e))
            assign(*e.material_clipboard);
        else
            e.run("edit.paste");
    }
    tip(held ? ("Give the selection \"" + held->name + "\"").c_str()
             : "Give the selection the copied material, from here or another Restage window");
    e.mark("material.paste");
    ImGui::BeginDisabled(!material);
    if (flow_button("Save as preset...")) ask_save_preset(e, current);
    ImGui::EndDisabled();
    tip("For the panel Materials, in every scene");
    e.mark("material.save_preset");
    bool mixed = false;
    for (const InstanceId one : selected)
        mixed = mixed || e.scene().instances[one].material != current;
    if (mixed && material) {
        if (flow_button("Give to all selected")) assign(current);
        tip("The selected objects have different materials now");
        e.mark("material.assign");
    }
}

void sharing(SelectContext& e, MaterialId id) {
    std::size_t users = 0, chosen = 0;
    e.scene().instances.each([&](InstanceId, const scene::Instance& i) { users += i.material == id; });
    for (const InstanceId one : e.selection.instances())
        chosen += e.scene().instances[one].material == id;
    if (users <= chosen) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colors::hover, "Shared by %zu objects", users);
    tip("Changes affect all of them. Click to select them");
    if (ImGui::IsItemClicked()) {
        std::vector<InstanceId> all;
        e.scene().instances.each([&](InstanceId one, const scene::Instance& i) {
            if (i.material == id) all.push_back(one);
        });
        e.later([&e, all] { e.selection.set(all); });
    }
    e.mark("material.shared");
    ImGui::SameLine();
    if (ImGui::Button("Make unique"))
        e.edit([id, ids = e.selection.instances()](const scene::Scene& s) {
            auto made = scene::make_unique(s, ids, id);
            return made ? Result<scene::Edit>(std::move(made->edit)) : tl::unexpected<Error>(made.error());
        });
    tip("Give the selection its own copy; the others stay unchanged");
    e.mark("material.unique");
}

// Reads the file, then sets it as that colour's texture.
void give_image(EditContext& e, const MaterialScope& scope, const std::string& param, const std::string& path) {
    e.panel_state->loads.start(
        {.path = path,
         .encoding = scene::Encoding::srgb,
         .done = [&e, scope, param, path](Result<std::shared_ptr<const scene::PixelData>> pixels) {
             if (!pixels) {
                 e.notices.add(LogLevel::error, pixels.error().message);
                 return;
             }
             scene::Image image{.name = std::filesystem::path(path).stem().string(),
                                .path = path,
                                .encoding = scene::Encoding::srgb,
                                .data = *pixels};
             e.edit([&e, scope, param, image](const scene::Scene& s) {
                 return edit_in_scope(s, scope, [&](const scene::Scene& now, MaterialId id) {
                     return project_where_needed(
                         e, now, scene::set_image_texture(now, id, param, model::ParamType::color, false, image), id);
                 });
             });
         }});
}

// `line`: of the material's table, or shown as a slot for a texture only.
void param_row(EditContext& e, MaterialId id, const scene::Material& material, const model::Param& line) {
    const auto plugin = e.registry().find_material(material.type);
    const model::Param* declared = plugin ? plugin->table->find(line.id) : nullptr;
    const model::Param& own = declared ? *declared : line;
    const scene::Value* set = material.params.find(line.id);
    const bool fits = set && set->type == own.type;
    const scene::TextureSlot slot{.of = id,
                                  .param = line.id,
                                  .value = fits ? *set : scene::default_value(own),
                                  .scalar = own.type == model::ParamType::number || line.id == "bump"};
    const SlotRules rules{.scalar = slot.scalar, .inside = {}};
    const bool table = line.type == model::ParamType::table && plugin;
    const ParamAsk ask = param_widget(e, line, slot.value, set != nullptr, "material." + line.id,
                                      table ? plugin->source->table_reader().get() : nullptr, &rules);
    carry_out(e, slot, ask, fmt::format("material.{}.{}", id.value, line.id));
}

} // namespace

void texture_for_selected(SelectContext& e, const std::string& file) {
    const scene::Instance* instance = e.scene().instances.find(e.selection.active());
    const scene::Material* material = instance ? e.scene().materials.find(instance->material) : nullptr;
    if (!material) return;
    const auto plugin = e.registry().find_material(material->type);
    for (const model::Param& line : table_of(plugin))
        if (line.type == model::ParamType::color && line.texturable) {
            const std::string path = std::filesystem::absolute(file).lexically_normal().string();
            ask_scope(e, e.selection.instances(), std::filesystem::path(path).filename().string(),
                      [path, param = std::string(line.id)](SelectContext& editor, const MaterialScope& scope) {
                          give_image(editor, scope, param, path);
                      });
            return;
        }
    e.notices.add(LogLevel::info, material->name + " has no colour that a texture could replace");
}

glm::vec3 swatch_color(const DocumentContext& e, const scene::Material& material) {
    glm::vec3 seen(0.5f);
    const auto plugin = e.registry().find_material(material.type);
    for (const model::Param& line : table_of(plugin)) {
        if (line.type != model::ParamType::color || line.max != 1) continue;
        const scene::Value* set = material.params.find(line.id);
        const scene::Value v = set && !set->texture ? *set : scene::default_value(line);
        for (int i = 0; i < 3; ++i)
            seen[i] = std::pow(std::clamp(v.v[std::size_t(i)], 0.f, 1.f), 1 / 2.2f);
        break;
    }
    return seen;
}

void material_section(SelectContext& e, MaterialId id) {
    const bool open = section_header("Material", true);
    e.mark("inspector.material");
    if (!open) return;
    ImGui::PushID("material");
    material_choice(e, id);
    const scene::Material* material = e.scene().materials.find(id);
    if (!material) {
        empty_note("It has no material: choose one, or create one.");
        ImGui::PopID();
        return;
    }
    sharing(e, id);
    missing_uv_note(e);
    std::string name = material->name;
    form_row("Name", "The material's name");
    if (name_field("##name", name)) e.edit([id, name](const scene::Scene& s) { return scene::rename(s, id, name); });
    e.mark("material.name");

    const auto plugin = e.registry().find_material(material->type);
    form_row("Type", plugin ? plugin->table->tooltip.c_str() : "What kind of surface it is");
    const std::string full = plugin ? type_name(*plugin->table) : material->type;
    const float room = ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - 2 * ImGui::GetStyle().FramePadding.x;
    const bool fits = !plugin || ImGui::CalcTextSize(full.c_str()).x <= room;
    if (ImGui::BeginCombo("##type", fits ? full.c_str() : plugin->table->label.c_str(),
                          ImGuiComboFlags_HeightLargest)) {
        for (const auto& [what, types] : types_by_use(e)) {
            ImGui::SeparatorText(what.c_str());
            for (const TypeUse& choice : types)
                if (type_row(e, choice, material->type) && material->type != choice.type.table->type)
                    e.edit([id, type = choice.type.table->type, before = table_of(plugin),
                            after = table_of(choice.type)](const scene::Scene& s) {
                        return scene::switch_material_type(s, id, type, before, after);
                    });
        }
        ImGui::EndCombo();
    }
    e.mark("material.type");
    if (!plugin)
        warning_note(
            fmt::format(
                "No plugin provides \"{}\". It is shown as a placeholder; its values are kept and written back.",
                material->type)
                .c_str());

    std::set<std::string> shown; // drawn by the plugin
    if (const auto* inspector = plugin ? e.registry().find_inspector(material->type) : nullptr)
        shown = draw_plugin_inspector(
            *inspector, {.editor = e,
                         .table = plugin->table->params,
                         .values = material->params,
                         .mark = "material",
                         .who = plugin->plugin->name() + ": its inspector",
                         .blame = plugin->plugin->blame("while it drew its part of the inspector"),
                         .row = [&](const model::Param& line) { param_row(e, id, *material, line); },
                         .change =
                             [&](const model::Param& line, scene::Value v) {
                                 e.edit([id, param = line.id, v = std::move(v)](
                                            const scene::Scene& s) { return scene::set_param(s, id, param, v); },
                                        fmt::format("material.{}.{}", id.value, line.id));
                             },
                         .set =
                             [&](std::string label, auto values) {
                                 e.edit([id, label = std::move(label), values = std::move(values)](
                                            const scene::Scene& s) { return scene::set_params(s, id, values, label); });
                             }});
    bool advanced = false;
    for (const model::Param& line : table_of(plugin)) {
        if (shown.contains(line.id)) continue;
        if (line.advanced)
            advanced = true;
        else
            param_row(e, id, *material, line);
    }
    if (plugin && plugin->table->has_code())
        for (const model::Param& line : model::surface_params())
            param_row(e, id, *material, line);
    if (advanced) {
        const bool unfolded = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_SpanAvailWidth);
        e.mark("material.advanced");
        if (unfolded) {
            for (const model::Param& line : table_of(plugin))
                if (line.advanced && !shown.contains(line.id)) param_row(e, id, *material, line);
            ImGui::TreePop();
        }
    }
    ImGui::PopID();
}

} // namespace restage::editor
