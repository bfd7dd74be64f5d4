// SPDX-License-Identifier: Apache-2.0
#include "palette.hpp"

#include "actions.hpp"
#include "panel_context.hpp"
#include "panels/panels.hpp"
#include "panels/plugin_panels.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "plugin_actions.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cfloat>
#include <span>
#include <utility>

namespace restage::editor {

namespace {

using Kind = PaletteItem::Kind;

constexpr std::size_t most_recent = 24;

const char* kind_name(Kind kind) {
    static constexpr const char* names[] = {"Action", "Tool",  "Panel",    "Object",
                                            "Group",  "Light", "Material", "Camera"};
    return names[std::size_t(kind)];
}

// --- the list
// ------------------------------------------------------------------------------------------------------------

std::string recent_key(Kind kind, std::string_view name) { return fmt::format("{}:{}", int(kind), name); }

void list_items(const PanelContext& e, PaletteState& p) {
    p.items.clear();
    p.names.clear();
    p.found_query = "\n"; // searched again
    p.made_for = e.scene().clock;
    const auto add = [&](Kind kind, std::uint32_t id, std::string_view name, std::string_view more = {}) {
        int bonus = kind <= Kind::panel ? 10 : 0;
        const auto used = std::ranges::find(p.recent, recent_key(kind, name));
        if (used != p.recent.end()) bonus = 150 - 5 * int(used - p.recent.begin());
        p.items.push_back({kind, id});
        p.names.add(name, more, bonus);
    };
    std::uint32_t n = 0;
    for (const Action& action : all_actions()) {
        const std::string_view id = action.id;
        add(Kind::action, n++, e.action_state(id).label,
            fmt::format("{} {} {}", id.substr(0, id.find('.')), key_text(key_of(action, e.view.keys)), action.tooltip));
    }
    const auto catalogue = e.registry().catalogue();
    n = 0;
    for (const plugin::ActionEntry& entry : catalogue->actions)
        add(Kind::plugin_action, n++, entry.table->label, entry.table->tooltip);
    n = 0;
    for (const Panel& panel : all_panels())
        add(Kind::panel, n++, panel.title, panel.tooltip);
    for (const plugin::PanelEntry& panel : catalogue->panels) // after those of the table
        add(Kind::panel, n++, panel_title(*panel.table), panel.plugin->name());
    const scene::Scene& s = e.scene();
    s.cameras.each([&](auto id, const scene::Camera& c) { add(Kind::camera, id.value, c.name); });
    s.lights.each([&](auto id, const scene::Light& l) { add(Kind::light, id.value, l.name); });
    s.groups.each([&](auto id, const scene::Group& g) { add(Kind::group, id.value, g.name); });
    s.materials.each([&](auto id, const scene::Material& m) { add(Kind::material, id.value, m.name, m.type); });
    s.instances.each([&](auto id, const scene::Instance& i) { add(Kind::object, id.value, i.name); });
}

bool possible(const PanelContext& e, const PaletteItem& item) {
    if (item.kind == Kind::action) return e.action_state(all_actions()[item.id].id).enabled;
    if (item.kind != Kind::plugin_action) return true;
    const auto catalogue = e.registry().catalogue();
    return item.id < catalogue->actions.size() && why_not_now(e, *catalogue->actions[item.id].table).empty();
}

// --- choosing
// ------------------------------------------------------------------------------------------------------------

enum class How { choose, frame, inspect };

void select(PanelContext& e, const PaletteItem& item) {
    const scene::Scene& s = e.scene();
    if (item.kind == Kind::light) {
        e.selection.set_light({item.id});
        return;
    }
    std::vector<InstanceId> ids;
    if (item.kind == Kind::object)
        ids = {InstanceId{item.id}};
    else if (item.kind == Kind::group)
        ids = instances_in(s, {item.id});
    else
        s.instances.each([&](InstanceId id, const scene::Instance& i) {
            if (i.material.value == item.id) ids.push_back(id);
        });
    if (ids.empty())
        e.notices.add(LogLevel::info,
                      item.kind == Kind::material ? "No object has this material" : "There is nothing in this group");
    else
        e.selection.set(ids);
}

void show_panel(PanelContext& e, const std::string& title) {
    e.view.show_panels = true;
    e.open_panel(title);
    e.later([title] { ImGui::SetWindowFocus(title.c_str()); });
}

void choose(PanelContext& e, const PaletteItem& item, How how) {
    PaletteState& p = e.panel_state->palette;
    const std::size_t at = std::size_t(&item - p.items.data());
    const std::string key = recent_key(item.kind, p.names.name(at));
    std::erase(p.recent, key);
    p.recent.insert(p.recent.begin(), key);
    if (p.recent.size() > most_recent) p.recent.resize(most_recent);
    switch (item.kind) {
        case Kind::action:
            e.run(all_actions()[item.id].id);
            return;
        case Kind::plugin_action: {
            const auto catalogue = e.registry().catalogue();
            if (item.id < catalogue->actions.size()) ask_for_action(e, catalogue->actions[item.id]);
            return;
        }
        case Kind::panel:
            show_panel(e, std::string(p.names.name(at))); // its title
            return;
        case Kind::camera:
            if (const scene::Camera* camera = e.scene().cameras.find({item.id}))
                e.look_from(camera->camera_to_world, {}, "Go to camera");
            return;
        default:
            select(e, item);
            if (how == How::frame) e.run("view.frame_selected");
            if (how == How::inspect) show_panel(e, "Inspector");
    }
}

// --- drawing
// -------------------------------------------------------------------------------------------------------------

// The matched bytes in another colour; parts of a letter of several bytes go together.
void draw_name(ImDrawList* draw, ImVec2 at, float right, std::string_view name, std::span<const std::uint32_t> matched,
               ImU32 color) {
    draw->PushClipRect(at, {right, at.y + ImGui::GetFrameHeight()}, true);
    const ImU32 bright = ImGui::GetColorU32(colors::hover);
    auto next = matched.begin();
    for (std::size_t i = 0; i < name.size() && at.x < right;) {
        const auto is_matched = [&](std::size_t letter) {
            while (next != matched.end() && *next < letter)
                ++next;
            return next != matched.end() && *next == letter;
        };
        const auto continues = [&](std::size_t k) { return (static_cast<unsigned char>(name[k]) & 0xc0) == 0x80; };
        const bool marked = is_matched(i);
        std::size_t end = i + 1;
        while (end < name.size() && (continues(end) || is_matched(end) == marked))
            ++end;
        const char *from = name.data() + i, *to = name.data() + end;
        draw->AddText(at, marked ? bright : color, from, to);
        at.x += ImGui::CalcTextSize(from, to).x;
        i = end;
    }
    draw->PopClipRect();
}

// True if it was clicked.
bool draw_row(PanelContext& e, PaletteState& p, int row) {
    const std::uint32_t number = p.found[std::size_t(row)];
    const PaletteItem& item = p.items[number];
    const bool can = possible(e, item), here = row == p.cursor;
    const std::string_view name = p.names.name(number);
    ImGui::PushID(row);
    ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyleColorVec4(ImGuiCol_FrameBg));
    ImGui::PushStyleColor(ImGuiCol_HeaderHovered, ImGui::GetStyleColorVec4(ImGuiCol_FrameBg));
    const bool pressed =
        ImGui::Selectable("##row", here, ImGuiSelectableFlags_NoAutoClosePopups, {0, ImGui::GetFrameHeight()});
    ImGui::PopStyleColor(2);
    ImGui::PopID();
    const ImVec2 mouse_moved = ImGui::GetIO().MouseDelta;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && (mouse_moved.x != 0 || mouse_moved.y != 0)) p.cursor = row;
    e.mark(fmt::format("palette.{}.{}", kind_name(item.kind), name));
    const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float y = from.y + (to.y - from.y - ImGui::GetTextLineHeight()) / 2, gap = ImGui::GetStyle().ItemSpacing.x;
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text),
                dim = here || hovered ? text : ImGui::GetColorU32(colors::dim);
    std::string right = kind_name(item.kind);
    if (item.kind == Kind::action) {
        const auto state = e.action_state(all_actions()[item.id].id);
        right = !can ? "not possible now" : state.checked ? "on  " + state.key : state.key;
        tip(all_actions()[item.id].tooltip);
    }
    const float right_edge = to.x - gap - ImGui::CalcTextSize(right.c_str()).x;
    draw->AddText({right_edge, y}, dim, right.c_str());
    std::vector<std::uint32_t> matched;
    fit(name, p.query, &matched);
    if (p.query.empty()) matched.clear();
    draw_name(draw, {from.x + gap, y}, right_edge - gap, name, matched, can ? text : dim);
    return pressed;
}

int on_arrow(ImGuiInputTextCallbackData* data) {
    PaletteState& p = *static_cast<PaletteState*>(data->UserData);
    p.cursor += data->EventKey == ImGuiKey_UpArrow ? -1 : 1;
    p.follow_cursor = true;
    return 0;
}

void draw_list(PanelContext& e, PaletteState& p, int& chosen) {
    const float height = ImGui::GetFrameHeightWithSpacing();
    const float space = ImGui::GetMainViewport()->WorkSize.y * 0.6f;
    const int rows = std::clamp(int(p.found.size()), 1, std::clamp(int(space / height), 3, 14));
    if (ImGui::BeginChild("found", {0, height * float(rows)}, 0, ImGuiWindowFlags_NoNav)) {
        if (p.found.empty()) empty_note("Nothing has such a name. Fewer letters find more.");
        if (std::exchange(p.follow_cursor, false)) {
            const float y = float(p.cursor) * height, shown = ImGui::GetScrollY();
            if (y < shown) ImGui::SetScrollY(y);
            if (y + height > shown + ImGui::GetWindowHeight()) ImGui::SetScrollY(y + height - ImGui::GetWindowHeight());
        }
        ImGuiListClipper clipper;
        clipper.Begin(int(p.found.size()), height);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
                if (draw_row(e, p, i)) chosen = i;
    }
    ImGui::EndChild();
}

} // namespace

void draw_palette(PanelContext& e) {
    PaletteState& p = e.panel_state->palette;
    constexpr const char* id = "palette";
    if (std::exchange(p.asked, false)) {
        p.query.clear();
        p.focus = true;
        list_items(e, p);
        ImGui::OpenPopup(id);
    }
    if (!ImGui::IsPopupOpen(id)) return;
    const ImGuiViewport* main = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({main->GetCenter().x, main->WorkPos.y + 0.06f * main->WorkSize.y}, ImGuiCond_Always,
                            {0.5f, 0});
    if (!ImGui::BeginPopup(id, ImGuiWindowFlags_NoMove)) return;
    dialog_width(600);
    if (p.made_for != e.scene().clock) list_items(e, p); // something goes on in the background
    if (std::exchange(p.focus, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    bool entered = ImGui::InputTextWithHint(
        "##query", "An action, panel, object, group, light, material or camera", &p.query,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory, on_arrow, &p);
    e.mark("palette.query");
    How how = How::choose;
    if (ImGui::IsKeyChordPressed(ImGuiMod_Shift | ImGuiKey_Enter)) entered = true, how = How::frame;
    if (ImGui::IsKeyChordPressed(ImGuiMod_Ctrl | ImGuiKey_Enter)) entered = true, how = How::inspect;
    const int page = ImGui::IsKeyPressed(ImGuiKey_PageDown) - ImGui::IsKeyPressed(ImGuiKey_PageUp);
    if (page != 0) p.cursor += 10 * page, p.follow_cursor = true;
    if (p.query != p.found_query) {
        p.found = p.names.find(p.query);
        p.found_query = p.query;
        p.cursor = 0;
        p.follow_cursor = true;
    }
    p.cursor = std::clamp(p.cursor, 0, std::max(int(p.found.size()) - 1, 0));
    int chosen = -1;
    draw_list(e, p, chosen);
    ImGui::TextColored(colors::dim, "%zu found", p.found.size());
    const char* keys = "Enter: choose   Shift: and frame   Ctrl: and inspect   Esc: close";
    flow(ImGui::CalcTextSize(keys).x);
    ImGui::TextColored(colors::dim, "%s", keys);
    if (entered && !p.found.empty()) chosen = p.cursor;
    const bool can = chosen >= 0 && possible(e, p.items[p.found[std::size_t(chosen)]]);
    if (can) choose(e, p.items[p.found[std::size_t(chosen)]], how);
    if (can || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) ImGui::CloseCurrentPopup();
    p.focus = entered && !can; // Enter left the field
    ImGui::EndPopup();
}

} // namespace restage::editor
