// SPDX-License-Identifier: Apache-2.0
// Materials: balls of presets and of the scene's materials. Hovering tries one on the selection, a click gives it, a
// drag drops it on an object.
#include "base/file.hpp"
#include "document/session.hpp"
#include "library.hpp"
#include "panels.hpp"
#include "plugin/registry.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <map>

namespace restage::editor {

namespace {

const scene::Material* material_of(const DocumentContext& e, const LibraryItem& item) {
    return item.preset ? item.preset->parts.materials.find(item.preset->material)
                       : e.scene().materials.find(item.material);
}

const Texture* ball_of(DocumentContext& e, const LibraryItem& item) {
    const MaterialBalls::Maker maker{e.registry(), e.log(), e.options().renderer};
    MaterialBalls& balls = e.panel_state->balls;
    return item.preset ? balls.ball(maker, *item.preset) : balls.ball(maker, e.scene(), item.material);
}

void describe(SelectContext& e, const LibraryItem& item) {
    if (!ImGui::BeginItemTooltip()) return;
    const scene::Material* material = material_of(e, item);
    const auto plugin = material ? e.registry().find_material(material->type) : std::nullopt;
    ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
    ImGui::TextUnformatted(item.name.c_str());
    if (material)
        ImGui::TextDisabled("%s (%s), %s", plugin ? plugin->table->label.c_str() : "no plugin", material->type.c_str(),
                            item.from.c_str());
    if (item.preset && !item.preset->source.empty()) ImGui::TextWrapped("%s", item.preset->source.c_str());
    ImGui::TextDisabled("%s", e.selection.instances().empty()
                                  ? "Drag it onto an object, or select one and click"
                                  : "Click: give it to the selection. Or drag it onto an object");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void context_menu(SelectContext& e, const LibraryItem& item) {
    if (!ImGui::BeginPopupContextItem("item")) return;
    if (ImGui::MenuItem("Give to selection", nullptr, false, !e.selection.instances().empty()))
        give_to_selection(e, item);
    e.mark("materials.give");
    if (!item.preset) {
        if (ImGui::MenuItem("Select its objects")) {
            std::vector<InstanceId> users;
            e.scene().instances.each([&](InstanceId id, const scene::Instance& i) {
                if (i.material == item.material) users.push_back(id);
            });
            e.later([&e, users] { e.selection.set(users); });
        }
        e.mark("materials.users");
        if (ImGui::MenuItem("Save as preset...")) ask_save_preset(e, item.material);
        e.mark("materials.save");
    }
    ImGui::EndPopup();
}

// Materials may have equal names: the second "Gold" has the mark "Gold#2".
std::string unique_mark(const std::string& name, std::map<std::string, int>& taken) {
    const int count = ++taken[name];
    return count == 1 ? name : fmt::format("{}#{}", name, count);
}

// Whether the mouse is over it.
bool cell(SelectContext& e, const LibraryItem& item, const std::string& mark, float side) {
    ImGui::PushID(item.key.c_str());
    ImGui::BeginGroup();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked =
        ImGui::InvisibleButton("ball", {side, side + ImGui::GetTextLineHeight() + 4 * ImGui::GetStyle().FontScaleMain},
                               ImGuiButtonFlags_EnableNav);
    const bool hovered = ImGui::IsItemHovered(), visible = ImGui::IsItemVisible();
    e.mark("materials." + mark);
    if (clicked) give_to_selection(e, item);
    if (ImGui::BeginDragDropSource()) {
        ImGui::SetDragDropPayload(material_payload, item.key.c_str(), item.key.size() + 1);
        ImGui::TextUnformatted(item.name.c_str());
        ImGui::EndDragDropSource();
    }
    describe(e, item);
    context_menu(e, item);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + side, at.y + side);
    const float round = side * 0.08f;
    if (const Texture* ball = visible ? ball_of(e, item) : nullptr) {
        draw->AddImageRounded(ball->ref(), at, end, {0, 0}, {1, 1}, IM_COL32_WHITE, round);
        e.mark("materials.ball." + mark, at, end);
    } else {
        draw->AddRectFilled(at, end, ImGui::GetColorU32(ImGuiCol_FrameBg), round);
    }
    if (hovered || ImGui::IsItemFocused())
        draw->AddRect(at, end, ImGui::GetColorU32(colors::hover), round, 2 * ImGui::GetStyle().FontScaleMain);
    const float gap = 2 * ImGui::GetStyle().FontScaleMain;
    const ImVec2 name(at.x, at.y + side + gap), name_end(at.x + side, name.y + ImGui::GetTextLineHeight() + gap);
    ImGui::RenderTextEllipsis(draw, name, name_end, name_end.x, item.name.c_str(), nullptr, nullptr);
    ImGui::EndGroup();
    ImGui::PopID();
    return hovered;
}

void filters(EditContext& e, LibraryState& state) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::SetNextItemWidth(130 * scale);
    if (ImGui::BeginCombo("##category", state.category.empty() ? "All" : state.category.c_str(),
                          ImGuiComboFlags_HeightLargest)) {
        std::vector<std::string> all = categories_of(e);
        all.insert(all.begin(), {"", in_this_scene, own_presets});
        for (const LibraryItem& item : state.borrowed)
            if (std::ranges::find(all, item.category) == all.end()) all.push_back(item.category);
        for (const std::string& one : all) {
            if (ImGui::Selectable(one.empty() ? "All" : one.c_str(), one == state.category)) state.category = one;
            e.mark("materials.category." + one);
        }
        ImGui::EndCombo();
    }
    e.mark("materials.category");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(140 * scale);
    ImGui::InputTextWithHint("##search", "Search", &state.search);
    e.mark("materials.search");
    if (flow_button("Reload")) state.loaded = false;
    tip("Read the folders of presets again");
    e.mark("materials.reload");
    if (flow_button("Of a file...")) ask_borrow_materials(e);
    tip("Materials of another scene or project, with their textures: nothing else of it is used");
    e.mark("materials.borrow");
}

bool wanted(const LibraryState& state, const LibraryItem& item) {
    if (!state.category.empty() && item.category != state.category && item.from != state.category) return false;
    return contains_word(item.name, state.search) || contains_word(item.category, state.search);
}

} // namespace

void draw_materials(SelectContext& e) {
    LibraryState& state = e.panel_state->library;
    filters(e, state);
    std::vector<LibraryItem> items = materials_of(e);
    items.insert(items.end(), state.borrowed.begin(), state.borrowed.end());
    const auto& presets = presets_of(e);
    items.insert(items.end(), presets.begin(), presets.end());
    std::erase_if(items, [&](const LibraryItem& item) { return !wanted(state, item); });
    ImGui::Separator();
    const LibraryItem* under_mouse = nullptr;
    if (ImGui::BeginChild("grid")) {
        const float side = 76 * ImGui::GetStyle().FontScaleMain, step = side + ImGui::GetStyle().ItemSpacing.x;
        const int columns =
            std::max(1, int((ImGui::GetContentRegionAvail().x + ImGui::GetStyle().ItemSpacing.x) / step));
        int in_row = 0;
        std::string_view group;
        std::map<std::string, int> marks;
        for (const LibraryItem& item : items) {
            if (item.category != group) {
                group = item.category;
                in_row = 0;
                ImGui::SeparatorText(item.category.c_str());
            }
            if (in_row++ % columns) ImGui::SameLine();
            if (cell(e, item, unique_mark(item.name, marks), side)) under_mouse = &item;
        }
        if (items.empty() && !state.search.empty())
            empty_note("Nothing matches.");
        else if (items.empty() && state.category == own_presets)
            empty_note(
                "You have saved none yet: Save as preset in the inspector's Material section, or right click a "
                "material of the scene here.");
        else if (items.empty())
            empty_note(e.scene().instances.live() ? "The scene has no materials." : "Open a scene first.");
    }
    ImGui::EndChild();
    follow_hover(e, under_mouse);
}

} // namespace restage::editor
