// SPDX-License-Identifier: Apache-2.0
// Outliner: groups, objects and lights by name; search, select, rename, hide.
#include "panels.hpp"

#include "theme.hpp"

#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cctype>

namespace restage::editor {

namespace {

bool contains_word(const std::string& text, const std::string& word) {
    return std::search(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
           }) != text.end();
}

struct Rows { // children of each group, made anew when the scene has changed
    scene::Version version = ~std::uint64_t(0);
    std::map<std::uint32_t, std::vector<GroupId>> groups;
    std::map<std::uint32_t, std::vector<InstanceId>> instances;

    void update(const scene::Scene& s) {
        if (version == s.clock) return;
        version = s.clock;
        groups.clear();
        instances.clear();
        s.groups.each([&](GroupId id, const scene::Group& g) { groups[g.parent.value].push_back(id); });
        s.instances.each([&](InstanceId id, const scene::Instance& i) { instances[i.group.value].push_back(id); });
    }
};

struct State {
    Rows rows;
    std::string search;
    InstanceId renaming;
    std::string new_name;
    bool focus_name = false;
};

void click(Editor& e, std::span<const InstanceId> ids) {
    const ImGuiIO& io = ImGui::GetIO();
    e.selection.set(ids, io.KeyCtrl    ? Selection::Mode::toggle
                         : io.KeyShift ? Selection::Mode::add
                                       : Selection::Mode::replace);
}

void instance_row(Editor& e, State& state, InstanceId id) {
    const scene::Instance& instance = e.scene().instances[id];
    ImGui::PushID(int(id.value));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (state.renaming == id) {
        if (state.focus_name) ImGui::SetKeyboardFocusHere();
        state.focus_name = false;
        ImGui::SetNextItemWidth(-1);
        const bool done = ImGui::InputText("##name", &state.new_name,
                                           ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
        if (done && !state.new_name.empty())
            e.edit([id, name = state.new_name](const scene::Scene& s) { return scene::rename(s, id, name); });
        if (done || ImGui::IsItemDeactivated()) state.renaming = {};
    } else {
        if (instance.hidden) ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
        const InstanceId ids[] = {id};
        if (ImGui::Selectable(instance.name.c_str(), e.selection.contains(id),
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowOverlap |
                                  ImGuiSelectableFlags_AllowDoubleClick)) {
            click(e, ids);
            if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
                state.renaming = id;
                state.new_name = instance.name;
                state.focus_name = true;
            }
        }
        if (ImGui::IsItemHovered()) e.hovered = id;
        if (instance.hidden) ImGui::PopStyleColor();
        e.mark("outliner." + instance.name);
        if (ImGui::BeginPopupContextItem("row")) {
            if (!e.selection.contains(id)) e.selection.set(ids);
            if (ImGui::MenuItem("Rename", "double click")) {
                state.renaming = id;
                state.new_name = instance.name;
                state.focus_name = true;
            }
            menu_item(e, "edit.duplicate");
            menu_item(e, "edit.delete");
            menu_item(e, "select.hide");
            menu_item(e, "view.frame_selected");
            if (ImGui::MenuItem("Select all with this material")) {
                std::vector<InstanceId> same;
                e.scene().instances.each([&](InstanceId other, const scene::Instance& i) {
                    if (i.material == instance.material) same.push_back(other);
                });
                e.selection.set(same);
            }
            ImGui::EndPopup();
        }
    }
    ImGui::TableNextColumn();
    if (ImGui::SmallButton(instance.hidden ? "show" : "hide"))
        e.edit([id, hide = !instance.hidden](const scene::Scene& s) {
            const InstanceId ids[] = {id};
            return scene::set_hidden(s, ids, hide);
        });
    ImGui::PopID();
}

// True when something of the group is in the search.
void group_rows(Editor& e, State& state, GroupId group) {
    const auto groups = state.rows.groups.find(group.value);
    if (groups != state.rows.groups.end())
        for (const GroupId child : groups->second) {
            ImGui::PushID(int(child.value) + 1'000'000);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            const bool open =
                ImGui::TreeNodeEx("##group", ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth, "%s",
                                  e.scene().groups[child].name.c_str());
            if (ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen()) click(e, instances_in(e.scene(), child));
            e.mark("outliner.group." + e.scene().groups[child].name);
            ImGui::TableNextColumn();
            if (open) {
                group_rows(e, state, child);
                ImGui::TreePop();
            }
            ImGui::PopID();
        }
    const auto instances = state.rows.instances.find(group.value);
    if (instances == state.rows.instances.end()) return;
    ImGuiListClipper clipper;
    clipper.Begin(int(instances->second.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
            if (e.scene().instances.find(instances->second[std::size_t(i)]))
                instance_row(e, state, instances->second[std::size_t(i)]);
}

} // namespace

void draw_outliner(Editor& e) {
    static State state; // of the one outliner there is
    if (e.scene().instances.live() == 0) {
        ImGui::TextDisabled("Nothing is open yet.");
        return;
    }
    state.rows.update(e.scene());
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##search", "Search objects", &state.search);
    e.mark("outliner.search");
    if (!ImGui::BeginTable("rows", 2, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("eye", ImGuiTableColumnFlags_WidthFixed);
    if (state.search.empty()) {
        group_rows(e, state, {});
    } else {
        e.scene().instances.each([&](InstanceId id, const scene::Instance& instance) {
            const scene::Material* material = e.scene().materials.find(instance.material);
            if (contains_word(instance.name, state.search) || (material && contains_word(material->name, state.search)))
                instance_row(e, state, id);
        });
    }
    e.scene().lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (!state.search.empty() && !contains_word(light.name, state.search)) return;
        ImGui::PushID(int(id.value) + 2'000'000);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(("Light: " + light.name).c_str(), e.selection.light() == id,
                              ImGuiSelectableFlags_SpanAllColumns))
            e.selection.set_light(id);
        ImGui::PopID();
    });
    ImGui::EndTable();
}

} // namespace restage::editor
