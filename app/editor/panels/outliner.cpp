// SPDX-License-Identifier: Apache-2.0
// Outliner: groups, objects, lights and cameras by name; search, select, rename, hide, lock, arrange in groups. Only
// visible rows are drawn: outliner_rows.cpp makes the list of all of them when the scene or a filter changes.
#include "outliner.hpp"

#include "actions.hpp"
#include "linking.hpp"
#include "panels.hpp"
#include "panels/state.hpp"
#include "scene/edits.hpp"
#include "scene/edits_groups.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <functional>

namespace restage::editor {

namespace {

using Row = OutlinerState::Row;

void click(SelectContext& e, std::span<const InstanceId> ids) {
    const ImGuiIO& io = ImGui::GetIO();
    e.selection.set(ids, io.KeyCtrl    ? Selection::Mode::toggle
                         : io.KeyShift ? Selection::Mode::add
                                       : Selection::Mode::replace);
}

template <class T>
void rename_field(EditContext& e, OutlinerState& state, scene::Id<T> id) {
    if (std::exchange(state.focus_name, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-3 * ImGui::GetFrameHeight());
    ImGui::InputText("##rename", &state.new_name, ImGuiInputTextFlags_AutoSelectAll);
    e.mark("outliner.rename");
    if (!ImGui::IsItemDeactivated()) return;
    if (ImGui::IsItemDeactivatedAfterEdit() && !state.new_name.empty())
        e.edit([id, name = state.new_name](const scene::Scene& s) { return scene::rename(s, id, name); });
    state.renaming = {};
}

// True while this row's name is edited.
bool renaming(const OutlinerState& state, const Row& row) {
    return state.renaming.id == row.id && state.renaming.kind == row.kind;
}

void ask_hidden(EditContext& e, std::vector<InstanceId> ids, bool hidden) {
    e.edit([ids = std::move(ids), hidden](const scene::Scene& s) { return scene::set_hidden(s, ids, hidden); });
}

// The row itself, with as much of its name as fits before `icons` at its right end. Names are not Dear ImGui
// labels: "##" is shown, and two rows may have the same name. True if clicked.
bool row_label(const std::string& name, bool selected, int icons, bool dim = false, const std::string& tooltip = {}) {
    const float side = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemSpacing.x;
    const bool pressed = ImGui::Selectable(
        "##row", selected, ImGuiSelectableFlags_AllowOverlap | ImGuiSelectableFlags_AllowDoubleClick, {0, side});
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    const float left = from.x + gap / 2, right = to.x - float(icons) * side - gap;
    const bool cut = left + ImGui::CalcTextSize(name.c_str(), name.c_str() + name.size()).x > right;
    const ImVec2 at(left, from.y + (to.y - from.y - ImGui::GetTextLineHeight()) / 2);
    if (dim) ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
    if (right > left)
        ImGui::RenderTextEllipsis(ImGui::GetWindowDrawList(), at, {right, to.y}, right, name.c_str(),
                                  name.c_str() + name.size(), nullptr);
    if (dim) ImGui::PopStyleColor();
    if (cut || !tooltip.empty()) tip((!cut ? tooltip : tooltip.empty() ? name : name + "\n" + tooltip).c_str());
    return pressed;
}

// At the right end of the row: locked, visible.
struct RightIcons {
    bool lock = false, eye = false; // pressed
};
// `locked`: none = not lockable.
RightIcons right_icons(PanelUi& e, std::optional<bool> locked, bool visible, const std::string& name) {
    RightIcons pressed;
    const float size = ImGui::GetFrameHeight();
    const ImVec2 top = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
    ImGui::SameLine();
    ImGui::SetCursorScreenPos({end.x - (locked ? 2 : 1) * size - ImGui::GetStyle().ItemSpacing.x / 2, top.y});
    if (locked) {
        // Open locks are shown on hover only, so that closed ones stand out.
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const bool near = ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) && mouse.y >= top.y &&
                          mouse.y < top.y + size;
        if (!*locked && !near) ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0);
        pressed.lock = icon_button(
            "lock", *locked ? Icon::lock : Icon::lock_open, *locked,
            *locked ? "Locked: clicks in the picture ignore it" : "Lock: clicks in the picture will ignore it");
        if (!*locked && !near) ImGui::PopStyleVar();
        e.mark("outliner.lock." + name);
        ImGui::SameLine(0, 0);
    }
    pressed.eye = icon_button("eye", visible ? Icon::eye : Icon::eye_closed, visible, visible ? "Hide it" : "Show it");
    e.mark("outliner.eye." + name);
    return pressed;
}

void instance_menu(SelectContext& e, OutlinerState& state, const Row& row) {
    const InstanceId id{row.id};
    const scene::Instance& instance = e.scene().instances[id];
    if (!e.selection.contains(id)) {
        const InstanceId ids[] = {id};
        e.selection.set(ids);
    }
    if (ImGui::MenuItem("Rename", "F2")) start_renaming(state, row, instance.name);
    for (const char* action : {"edit.duplicate", "edit.delete", "select.hide", "select.isolate", "view.frame_selected"})
        menu_item(e, action);
    ImGui::Separator();
    if (ImGui::MenuItem("Group the selection")) group_selected(e);
    if (ImGui::MenuItem("Take out of the group", nullptr, false, bool(instance.group))) move_to_group(e, {});
    ImGui::Separator();
    if (ImGui::MenuItem("Select all with this material")) {
        std::vector<InstanceId> same;
        e.scene().instances.each([&](InstanceId other, const scene::Instance& i) {
            if (i.material == instance.material) same.push_back(other);
        });
        e.selection.set(same);
    }
    if (ImGui::MenuItem("List only users of this material", nullptr, false, bool(instance.material)))
        state.material = instance.material;
    e.mark("outliner.menu.material");
}

constexpr const char* tree_payload = "restage.objects"; // the selection, and OutlinerState::dragged

// Makes the row a source. `begin` selects what is dragged.
void drag_source(SelectContext& e, OutlinerState& state, const std::function<void()>& begin) {
    if (!ImGui::BeginDragDropSource()) return;
    if (!ImGui::GetDragDropPayload()) begin();
    ImGui::SetDragDropPayload(tree_payload, "", 1);
    const std::size_t groups = state.dragged.size(), objects = e.selection.instances().size();
    if (!state.drop_problem.empty())
        ImGui::TextColored(colors::error, "%s", state.drop_problem.c_str());
    else
        ImGui::Text("%zu %s%s into a group, or below the list out of it", groups ? groups : objects,
                    groups ? "group" : "object", (groups ? groups : objects) == 1 ? "" : "s");
    ImGui::EndDragDropSource();
    state.drop_problem.clear(); // until a target sets it again
}

void drop_target(SelectContext& e, OutlinerState& state, GroupId group) {
    if (!ImGui::BeginDragDropTarget()) return;
    const ImGuiPayload* payload = ImGui::GetDragDropPayload();
    if (payload && payload->IsDataType(tree_payload) &&
        std::ranges::any_of(state.dragged, [&](GroupId one) { return scene::is_in_group(e.scene(), group, one); })) {
        state.drop_problem = "A group cannot be moved into itself";
        ImGui::SetMouseCursor(ImGuiMouseCursor_NotAllowed);
    } else if (ImGui::AcceptDragDropPayload(tree_payload)) {
        move_to_group(e, group, state.dragged);
    }
    ImGui::EndDragDropTarget();
}

void instance_row(SelectContext& e, OutlinerState& state, const Row& row) {
    const InstanceId id{row.id};
    const scene::Instance* instance = e.scene().instances.find(id);
    if (!instance) return;
    if (renaming(state, row)) {
        rename_field(e, state, id);
        return;
    }
    const InstanceId ids[] = {id};
    if (row_label(instance->name, e.selection.contains(id), 2, instance->hidden)) {
        click(e, ids);
        state.cursor = row;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) start_renaming(state, row, instance->name);
    }
    if (ImGui::IsItemHovered()) e.hovered = id;
    e.mark("outliner." + instance->name);
    drag_source(e, state, [&] {
        state.dragged.clear();
        if (!e.selection.contains(id)) e.selection.set(ids);
    });
    if (instance->group) drop_target(e, state, instance->group);
    if (ImGui::BeginPopupContextItem("row")) {
        instance_menu(e, state, row);
        ImGui::EndPopup();
    }
    const bool locked = e.locked.contains(id.value);
    const RightIcons pressed = right_icons(e, locked, !instance->hidden, instance->name);
    if (pressed.lock)
        e.later([&e, id, locked] { locked ? void(e.locked.erase(id.value)) : void(e.locked.insert(id.value)); });
    if (pressed.eye) ask_hidden(e, {id}, !instance->hidden);
}

void group_row(SelectContext& e, OutlinerState& state, const Row& row) {
    const GroupId id{row.id};
    const scene::Group* group = e.scene().groups.find(id);
    if (!group || row.id >= state.members.size()) return;
    if (renaming(state, row)) {
        rename_field(e, state, id);
        return;
    }
    const bool open = state.open.contains(row.id) || !state.search.empty();
    const float side = ImGui::GetFrameHeight(), r = side * 0.2f;
    const ImVec2 at = ImGui::GetCursorScreenPos(), c(at.x + side / 2, at.y + side / 2);
    const bool pressed_arrow = ImGui::InvisibleButton("open", {side, side});
    const ImU32 color =
        ImGui::GetColorU32(ImGui::IsItemHovered() ? colors::hover : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    if (open)
        ImGui::GetWindowDrawList()->AddTriangleFilled({c.x - r, c.y - r * 0.6f}, {c.x + r, c.y - r * 0.6f},
                                                      {c.x, c.y + r * 0.8f}, color);
    else
        ImGui::GetWindowDrawList()->AddTriangleFilled({c.x - r * 0.6f, c.y - r}, {c.x + r * 0.8f, c.y},
                                                      {c.x - r * 0.6f, c.y + r}, color);
    if (pressed_arrow) {
        if (open)
            state.open.erase(row.id);
        else
            state.open.insert(row.id);
    }
    e.mark("outliner.open." + group->name);
    ImGui::SameLine(0, 0);
    const bool hidden = state.members[row.id] > 0 && state.hidden[row.id] == state.members[row.id];
    const bool selected =
        e.selection.active() && scene::is_in_group(e.scene(), e.scene().instances[e.selection.active()].group, id);
    if (row_label(group->name, selected, 2, hidden,
                  fmt::format("{} objects. Click: select all of them; double click: rename", state.members[row.id]))) {
        click(e, instances_in(e.scene(), id));
        state.cursor = row;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) start_renaming(state, row, group->name);
    }
    e.mark("outliner.group." + group->name);
    link_note(e, *group);
    drag_source(e, state, [&] {
        state.dragged = dragged_groups(e, id);
        if (!state.dragged.empty()) return;
        state.dragged = {id};
        e.selection.set(instances_in(e.scene(), id));
    });
    drop_target(e, state, id);
    if (ImGui::BeginPopupContextItem("group")) {
        if (ImGui::MenuItem("Select")) e.selection.set(instances_in(e.scene(), id));
        if (ImGui::MenuItem("Rename", "F2")) start_renaming(state, row, group->name);
        if (ImGui::MenuItem("Enter")) e.selection.enter({.group = id});
        tip("Clicks in the picture select its single objects; Esc leaves");
        if (ImGui::MenuItem("Ungroup")) ungroup(e, id);
        ImGui::EndPopup();
    }
    const auto all_locked = [&](const std::vector<InstanceId>& ids) {
        return !ids.empty() &&
               std::all_of(ids.begin(), ids.end(), [&](InstanceId one) { return e.locked.contains(one.value); });
    };
    // Checking every object for every row would be slow, and is not needed while nothing is locked.
    const auto few =
        !e.locked.empty() && state.members[row.id] <= 64 ? instances_in(e.scene(), id) : std::vector<InstanceId>();
    const RightIcons pressed = right_icons(e, all_locked(few), !hidden, "group." + group->name);
    if (pressed.lock)
        e.later([&e, id, all_locked] {
            const auto ids = instances_in(e.scene(), id);
            const bool unlock = all_locked(ids);
            for (const InstanceId one : ids)
                if (unlock)
                    e.locked.erase(one.value);
                else
                    e.locked.insert(one.value);
        });
    if (pressed.eye) ask_hidden(e, instances_in(e.scene(), id), !hidden);
}

void light_row(SelectContext& e, OutlinerState& state, const Row& row) {
    const scene::Id<scene::Light> id{row.id};
    const scene::Light* light = e.scene().lights.find(id);
    if (!light) return;
    if (renaming(state, row)) {
        rename_field(e, state, id);
        return;
    }
    if (row_label(light->name, e.selection.light() == id, 1, light->hidden)) {
        e.selection.set_light(id);
        state.cursor = row;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) start_renaming(state, row, light->name);
    }
    e.mark("outliner.light." + light->name);
    if (ImGui::BeginPopupContextItem("light")) {
        e.selection.set_light(id);
        if (ImGui::MenuItem("Rename", "F2")) start_renaming(state, row, light->name);
        for (const char* action : {"edit.duplicate", "edit.copy", "edit.delete", "select.hide"})
            menu_item(e, action);
        ImGui::EndPopup();
    }
    if (right_icons(e, std::nullopt, !light->hidden, "light." + light->name).eye)
        e.edit([id, hidden = !light->hidden](const scene::Scene& s) { return scene::set_hidden(s, id, hidden); });
}

void camera_row(EditContext& e, OutlinerState& state, const Row& row) {
    const scene::Id<scene::Camera> id{row.id};
    const scene::Camera* camera = e.scene().cameras.find(id);
    if (!camera) return;
    if (renaming(state, row)) {
        rename_field(e, state, id);
        return;
    }
    if (row_label(camera->name, id == e.camera_id(), 0, false, "Double click: look through it")) {
        state.cursor = row;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
            e.edit([id](const scene::Scene& s) { return scene::set_active_camera(s, id); });
    }
    e.mark("outliner.camera." + camera->name);
    if (ImGui::BeginPopupContextItem("camera")) {
        if (ImGui::MenuItem("Look through it"))
            e.edit([id](const scene::Scene& s) { return scene::set_active_camera(s, id); });
        if (ImGui::MenuItem("Rename")) start_renaming(state, row, camera->name);
        ImGui::EndPopup();
    }
}

void draw_row(SelectContext& e, OutlinerState& state, const Row& row) {
    ImGui::PushID(int(row.kind));
    ImGui::PushID(int(row.id));
    const float indent = float(row.depth) * ImGui::GetStyle().IndentSpacing;
    if (row.kind != Row::Kind::group &&
        row.kind != Row::Kind::header) // names of objects are aligned with names of groups
        ImGui::Indent(indent + (row.kind == Row::Kind::instance ? ImGui::GetFrameHeight() * 0.6f : 0.01f));
    else if (indent > 0)
        ImGui::Indent(indent);
    const float start = ImGui::GetCursorPosY();
    switch (row.kind) {
        case Row::Kind::header:
            ImGui::AlignTextToFramePadding();
            ImGui::TextDisabled("%s", row.id == 1 ? "Lights" : "Cameras");
            break;
        case Row::Kind::group:
            group_row(e, state, row);
            break;
        case Row::Kind::instance:
            instance_row(e, state, row);
            break;
        case Row::Kind::light:
            light_row(e, state, row);
            break;
        case Row::Kind::camera:
            camera_row(e, state, row);
            break;
    }
    if (row.kind != Row::Kind::group && row.kind != Row::Kind::header)
        ImGui::Unindent(indent + (row.kind == Row::Kind::instance ? ImGui::GetFrameHeight() * 0.6f : 0.01f));
    else if (indent > 0)
        ImGui::Unindent(indent);
    ImGui::SetCursorPosY(start + ImGui::GetFrameHeight()); // all rows have the same height
    ImGui::Dummy({0, 0});
    ImGui::PopID();
    ImGui::PopID();
}

} // namespace

void draw_outliner(SelectContext& e) {
    OutlinerState& state = e.panel_state->outliner;
    if (e.scene().instances.live() == 0) {
        empty_note("Nothing is open yet. Open a scene, or drop a file onto the window.");
        return;
    }
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##search", "Search objects", &state.search);
    e.mark("outliner.search");
    if (const scene::Material* material = e.scene().materials.find(state.material)) {
        if (ImGui::Button(fmt::format("Uses {}   x###filter", material->name).c_str(), {-FLT_MIN, 0}))
            state.material = {};
        tip("Only users of this material are listed. Click to list everything");
        e.mark("outliner.filter");
    } else {
        state.material = {};
    }
    update_rows(e, state);

    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, ImVec2(0, 0.5f));
    const ImGuiPayload* payload = ImGui::GetDragDropPayload();
    const bool dragging = payload && payload->IsDataType(tree_payload);
    if (ImGui::BeginChild("rows", {0, dragging ? -ImGui::GetFrameHeight() : 0}, 0, ImGuiWindowFlags_NoNavInputs)) {
        outliner_keys(e, state);
        const float height = ImGui::GetFrameHeight();
        if (e.selection.active() != state.last_active) { // selected elsewhere: scroll to it
            state.last_active = e.selection.active();
            const int row = find_row(state, state.last_active);
            const float y = float(row) * height;
            if (row >= 0 && (y < ImGui::GetScrollY() || y + height > ImGui::GetScrollY() + ImGui::GetWindowHeight()))
                ImGui::SetScrollY(std::max(0.f, y - ImGui::GetWindowHeight() / 2));
        }
        if (state.rows.empty()) empty_note("Nothing matches.");
        ImGuiListClipper clipper;
        clipper.Begin(int(state.rows.size()), height);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
                draw_row(e, state, state.rows[std::size_t(i)]);
        if (const ImVec2 rest = ImGui::GetContentRegionAvail(); rest.y > 1) { // out of every group
            ImGui::Dummy(rest);
            drop_target(e, state, {});
            e.mark("outliner.rest");
        }
    }
    ImGui::EndChild();
    if (dragging) { // the list may fill the panel
        ImGui::Button("Out of every group", {-FLT_MIN, 0});
        drop_target(e, state, {});
        e.mark("outliner.root");
    }
    ImGui::PopStyleVar(2);
}

} // namespace restage::editor
