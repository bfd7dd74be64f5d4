// SPDX-License-Identifier: Apache-2.0
// Keys in the outliner.
#include "outliner.hpp"

#include <imgui.h>

namespace restage::editor {

namespace {

using Row = OutlinerState::Row;

bool same_row(const Row& a, const Row& b) { return a.kind == b.kind && a.id == b.id; }

void select_row(SelectContext& e, OutlinerState& state, const Row& row, bool add) {
    state.cursor = row;
    const auto mode = add ? Selection::Mode::add : Selection::Mode::replace;
    if (row.kind == Row::Kind::instance) {
        const InstanceId ids[] = {{row.id}};
        e.selection.set(ids, mode);
    } else if (row.kind == Row::Kind::group) {
        e.selection.set(instances_in(e.scene(), {row.id}), mode);
    } else if (row.kind == Row::Kind::light) {
        e.selection.set_light({row.id});
    }
    state.last_active = e.selection.active(); // the list is scrolled here
}

// The key cursor's row: the last clicked one, else the active object.
void rename_row(SelectContext& e, OutlinerState& state) {
    const scene::Scene& s = e.scene();
    const auto start = [&](const auto* item) {
        if (item) start_renaming(state, state.cursor, item->name);
    };
    if (state.cursor.kind == Row::Kind::group)
        start(s.groups.find({state.cursor.id}));
    else if (state.cursor.kind == Row::Kind::camera)
        start(s.cameras.find({state.cursor.id}));
    else if (e.selection.light())
        start_renaming(state, {Row::Kind::light, e.selection.light().value, 0}, s.lights[e.selection.light()].name);
    else if (e.selection.active())
        start_renaming(state, {Row::Kind::instance, e.selection.active().value, 0},
                       s.instances[e.selection.active()].name);
}

} // namespace

void start_renaming(OutlinerState& state, const Row& row, const std::string& name) {
    state.renaming = row;
    state.new_name = name;
    state.focus_name = true;
}

void outliner_keys(SelectContext& e, OutlinerState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) || state.rows.empty() || io.KeyAlt || io.KeyCtrl)
        return;
    if (ImGui::IsKeyPressed(ImGuiKey_F2) && !io.WantTextInput) rename_row(e, state);
    const auto key = [](ImGuiKey k) { return ImGui::IsKeyPressed(k); };
    int now = -1, first = -1, last = -1;
    for (int i = 0; i < int(state.rows.size()); ++i) {
        const Row& row = state.rows[std::size_t(i)];
        if (row.kind == Row::Kind::header) continue;
        if (first < 0) first = i;
        last = i;
        if (same_row(row, state.cursor)) now = i;
    }
    // Continue from a selection made elsewhere meanwhile.
    const bool picked = e.selection.active() && state.cursor.kind == Row::Kind::instance &&
                        state.cursor.id != e.selection.active().value;
    if (now < 0 || picked)
        if (const int row = find_row(state, e.selection.active()); row >= 0) now = row;
    const auto go = [&](int to, int step) {
        while (to >= 0 && to < int(state.rows.size()) && state.rows[std::size_t(to)].kind == Row::Kind::header)
            to += step;
        if (to < 0 || to >= int(state.rows.size()) || to == now) return;
        select_row(e, state, state.rows[std::size_t(to)], io.KeyShift);
        const float height = ImGui::GetFrameHeight(), y = float(to) * height;
        if (y < ImGui::GetScrollY()) ImGui::SetScrollY(y);
        if (y + height > ImGui::GetScrollY() + ImGui::GetWindowHeight())
            ImGui::SetScrollY(y + height - ImGui::GetWindowHeight());
    };
    if (key(ImGuiKey_DownArrow)) return go(now < 0 ? first : now + 1, 1);
    if (key(ImGuiKey_UpArrow)) return go(now < 0 ? last : now - 1, -1);
    if (io.WantTextInput || now < 0) return; // these two belong to the search field
    const Row row = state.rows[std::size_t(now)];
    const bool group = row.kind == Row::Kind::group;
    if (key(ImGuiKey_RightArrow) && group) state.open.insert(row.id);
    if (!key(ImGuiKey_LeftArrow) || (group && state.open.erase(row.id))) return;
    for (int i = now - 1; i >= 0; --i)
        if (const Row& outer = state.rows[std::size_t(i)]; outer.kind == Row::Kind::group && outer.depth < row.depth)
            return go(i, -1);
}

} // namespace restage::editor
