// SPDX-License-Identifier: Apache-2.0
// Arrange: aligns, distributes, mirrors, repeats and replaces the selected things.
#include "actions.hpp"
#include "arrange.hpp"
#include "panels.hpp"
#include "path_tool.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <span>
#include <string>
#include <utility>

namespace restage::editor {

namespace {

constexpr const char* axis_names[] = {"x", "y", "z"};

// A row of buttons of equal width, labelled at its left. The index of the pressed one, or -1.
int button_row(PanelUi& e, const std::string& mark, const char* label, std::span<const char* const> names,
               std::span<const std::string> tips, bool enabled) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    form_row(label);
    const float width = (ImGui::CalcItemWidth() - gap * float(names.size() - 1)) / float(names.size());
    int pressed = -1;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y}); // room for the names
    ImGui::BeginDisabled(!enabled);
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) ImGui::SameLine(0, gap);
        const std::string id = mark + "." + std::to_string(i);
        if (ImGui::Button(fmt::format("{}##{}", names[i], id).c_str(), {width, 0})) pressed = int(i);
        tip(tips[i].c_str());
        e.mark(id);
    }
    ImGui::EndDisabled();
    ImGui::PopStyleVar();
    return pressed;
}

bool choice(PanelUi& e, const char* mark, const char* label, const char* tooltip, std::span<const char* const> names,
            int& chosen) {
    form_row(label, tooltip);
    bool changed = false;
    const bool open = ImGui::BeginCombo((std::string("##") + mark).c_str(), names[std::size_t(chosen)]);
    e.mark(mark);
    if (!open) return false;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (ImGui::Selectable(names[i], int(i) == chosen)) {
            chosen = int(i);
            changed = true;
        }
        e.mark(mark + ("." + std::to_string(i)));
    }
    ImGui::EndCombo();
    return changed;
}

void align_section(SelectContext& e) {
    const bool open = section_header("Align", true);
    e.mark("arrange.align");
    if (!open) return;
    static constexpr const char* sides[] = {"Min", "Centre", "Max"};
    static constexpr const char* targets[] = {"The last selected", "All selected"};
    const std::size_t things = things_of(e).size();
    int to_all = e.panel_state->arrange.align_to_all ? 1 : 0;
    choice(e, "align.to", "To", "To which box", targets, to_all);
    e.panel_state->arrange.align_to_all = to_all == 1;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string to = to_all ? "of the selection" : "of the last selected thing";
        const std::string tips[] = {fmt::format("The sides at the lower end of {} to that {}", axis_names[axis], to),
                                    fmt::format("The centres along {} to that {}", axis_names[axis], to),
                                    fmt::format("The sides at the upper end of {} to that {}", axis_names[axis], to)};
        if (const int side =
                button_row(e, std::string("align.") + axis_names[axis], axis_names[axis], sides, tips, things > 1);
            side >= 0)
            align_selection(e, axis, scene::Side(side));
    }
    if (things < 2) empty_note("For two things or more: select with Shift.");
}

void distribute_section(SelectContext& e) {
    const bool open = section_header("Distribute", true);
    e.mark("arrange.distribute");
    if (!open) return;
    static constexpr const char* ways[] = {"Gaps", "Centres"};
    const std::size_t things = things_of(e).size();
    for (int axis = 0; axis < 3; ++axis) {
        const std::string tips[] = {
            fmt::format("Equal gaps between boxes along {}; the outermost things stay", axis_names[axis]),
            fmt::format("Equal distances of centres along {}; the outermost things stay", axis_names[axis])};
        if (const int way =
                button_row(e, std::string("distribute.") + axis_names[axis], axis_names[axis], ways, tips, things > 2);
            way >= 0)
            distribute_selection(e, axis, scene::Spacing(way));
    }
    if (things < 3) empty_note("For three things or more.");
}

void mirror_section(SelectContext& e) {
    const bool open = section_header("Mirror", true);
    e.mark("arrange.mirror");
    if (!open) return;
    ArrangeState& a = e.panel_state->arrange;
    static constexpr const char* planes[] = {"Its centre", "Its lower side", "Its upper side",
                                             "The last selected's centre", "The origin"};
    int about = int(a.mirror_about);
    choice(e, "mirror.about", "About", "The place of the mirror along the axis", planes, about);
    a.mirror_about = ArrangeState::About(about);
    form_row("As a copy", "The original stays");
    ImGui::Checkbox("##mirror_copy", &a.mirror_copy);
    e.mark("mirror.copy");
    const std::string tips[] = {"Along the world's x axis", "Along the world's y axis", "Along the world's z axis"};
    if (const int axis = button_row(e, "mirror", "Along", axis_names, tips, !e.selection.empty()); axis >= 0)
        mirror_selection(e, axis);
}

bool three(PanelUi& e, const char* mark, glm::dvec3& v, double speed) {
    const bool changed = ImGui::DragScalarN((std::string("##") + mark).c_str(), ImGuiDataType_Double, &v.x, 3,
                                            float(speed), nullptr, nullptr, "%.3f");
    e.mark(mark);
    return changed;
}

bool whole(PanelUi& e, const char* mark, int* values, int count, int most) {
    const int least = 1;
    const bool changed = ImGui::DragScalarN((std::string("##") + mark).c_str(), ImGuiDataType_S32, values, count, 0.05f,
                                            &least, &most, "%d", ImGuiSliderFlags_AlwaysClamp);
    e.mark(mark);
    return changed;
}

bool circle_rows(SelectContext& e, double speed) {
    ArrangeState::Array& a = e.panel_state->arrange.array;
    bool changed = false;
    const bool several = things_of(e).size() > 1;
    if (several) {
        form_row("Around last", "Around the last selected thing, which is not repeated: a table among chairs");
        changed |= ImGui::Checkbox("##around_last", &a.around_last);
        e.mark("array.around_last");
    }
    form_row("Centre", "x, y, z of the circle's centre");
    ImGui::BeginDisabled(several && a.around_last);
    changed |= three(e, "array.center", a.center, speed);
    ImGui::EndDisabled();
    changed |= choice(e, "array.axis", "Axis", "What the circle turns about", axis_names, a.axis);
    form_row("Angle", "From the first to the last; 360: all around");
    const double least = -360, most = 360;
    changed |= ImGui::DragScalar("##angle", ImGuiDataType_Double, &a.angle, 1, &least, &most, "%.1f°",
                                 ImGuiSliderFlags_AlwaysClamp);
    e.mark("array.angle");
    form_row("Turn", "Copies turn with the circle; else all have the same direction");
    changed |= ImGui::Checkbox("##turn", &a.turn);
    e.mark("array.turn");
    return changed;
}

bool path_rows(SelectContext& e, double speed) {
    ArrangeState& state = e.panel_state->arrange;
    ArrangeState::Array& a = state.array;
    bool changed = false;
    form_row("Path", "From the selection through points clicked on surfaces in the picture");
    const std::string label = a.path.empty() ? "Draw it..." : fmt::format("Draw again ({} points)", a.path.size());
    ImGui::BeginDisabled(state.drawing);
    if (ImGui::Button((label + "###draw").c_str(), {ImGui::CalcItemWidth(), 0})) begin_path(e);
    ImGui::EndDisabled();
    e.mark("array.draw");
    form_row("Smooth", "A curve through the points; else straight pieces");
    changed |= ImGui::Checkbox("##smooth", &a.smooth);
    e.mark("array.smooth");
    form_row("Turn", "Copies turn with the path; else all have the same direction");
    changed |= ImGui::Checkbox("##turn", &a.turn);
    e.mark("array.turn");
    static constexpr const char* ways[] = {"Number", "Distance"};
    int way = a.by_spacing ? 1 : 0;
    changed |= choice(e, "array.by", "By", "What determines how many there are", ways, way);
    a.by_spacing = way == 1;
    if (!a.by_spacing) {
        form_row("Number", "With the original");
        return whole(e, "array.count", &a.count, 1, 1000) || changed;
    }
    form_row("Distance", "From one to the next along the path, in scene units");
    const double least = 1e-6, most = 1e9;
    changed |= ImGui::DragScalar("##spacing", ImGuiDataType_Double, &a.path_spacing, float(speed), &least, &most,
                                 "%.3f", ImGuiSliderFlags_AlwaysClamp);
    e.mark("array.path_spacing");
    return changed;
}

bool array_rows(SelectContext& e) {
    ArrangeState::Array& a = e.panel_state->arrange.array;
    const scene::Bounds box = e.selection.bounds(e.scene());
    const double speed = std::max(box.radius(), 1e-3) * 0.01;
    bool changed = false;
    if (a.kind == ArrayKind::grid) {
        form_row("Number", "Along x, y and z, with the original");
        changed |= whole(e, "array.grid", &a.grid.x, 3, 100);
        form_row("Distance", "From one to the next along x, y and z");
        return three(e, "array.spacing", a.spacing, speed) || changed;
    }
    if (a.kind == ArrayKind::path) return path_rows(e, speed);
    form_row("Number", "With the original");
    changed |= whole(e, "array.count", &a.count, 1, 1000);
    if (a.kind == ArrayKind::circle) return circle_rows(e, speed) || changed;
    static constexpr const char* meanings[] = {"To the next one", "To the last one"};
    int to_last = a.step_to_last ? 1 : 0;
    if (choice(e, "array.meaning", "Distance", "What the offset says", meanings, to_last)) {
        a.step *= to_last ? double(std::max(a.count - 1, 1)) : 1 / double(std::max(a.count - 1, 1)); // the same array
        a.step_to_last = to_last == 1;
    }
    form_row("Offset", "Along x, y and z, in scene units");
    return three(e, "array.step", a.step, speed) || changed;
}

void array_section(SelectContext& e) {
    ArrangeState& a = e.panel_state->arrange;
    if (a.asked) ImGui::SetNextItemOpen(true);
    const bool open = section_header("Array", true);
    e.mark("arrange.array");
    if (!open) return;
    if (e.selection.instances().empty()) {
        a.asked = false;
        return empty_note("Select objects to repeat them in a line, a circle, a grid or along a path.");
    }
    if (a.drawn < 0) suit_array(e); // at first
    a.drawn = ImGui::GetFrameCount();
    bool live = array_is_live(e), changed = false;
    if (std::exchange(a.asked, false)) {
        if (!live) suit_array(e);
        if (ImGui::IsWindowAppearing()) ImGui::SetScrollHereY(0);
        changed = true;
    }
    static constexpr const char* kinds[] = {"Line", "Circle", "Grid", "Path"};
    int kind = int(a.array.kind);
    changed |= choice(e, "array.kind", "Shape", "How the copies stand", kinds, kind) && live;
    a.array.kind = ArrayKind(kind);
    changed |= array_rows(e) && live;
    if (!live) a.problem.clear();
    if (!a.problem.empty()) error_note(a.problem.c_str());
    const bool enter = ImGui::IsKeyPressed(ImGuiKey_Enter, false) && !ImGui::GetIO().WantTextInput;
    const bool ends_drawing = enter && std::exchange(a.drawing, false);
    if (live) {
        if (flow_button("Keep", true)) keep_array(e);
        tip("Enter: one undo step, and all of it is selected");
        e.mark("array.keep");
        if (flow_button("Cancel")) cancel_array(e);
        tip("Esc: without the copies");
        e.mark("array.cancel");
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        ImGui::TextColored(colors::dim, "%zu copies", a.live->copies.size());
        if (enter && !ends_drawing) keep_array(e);
    } else if (a.array.kind != ArrayKind::path || !a.array.path.empty()) {
        changed |= flow_button("Make", true);
        tip("Shows it at once; its numbers can then be changed until it is kept");
        e.mark("array.make");
        if (flow_button("Suit the selection")) suit_array(e);
        tip("Sets distances and centre by the size of what is selected");
        e.mark("array.suit");
    }
    if (changed) change_array(e);
}

void replace_section(EditContext& e) {
    const bool open = section_header("Replace", true);
    e.mark("arrange.replace");
    if (!open) return;
    ArrangeState& a = e.panel_state->arrange;
    form_row("Keep its size", "Else it is scaled to fit into the box of what it replaces");
    ImGui::Checkbox("##keep_size", &a.replace_keeps_size);
    e.mark("replace.keep_size");
    form_row("Turn", "By the angle about the vertical between both, as far as their objects tell");
    ImGui::Checkbox("##replace_turns", &a.replace_turns);
    e.mark("replace.turn");
    action_button(e, "edit.replace", "By the last selected");
    action_button(e, "edit.replace_copied", "By the copied thing");
}

} // namespace

void draw_arrange(SelectContext& e) {
    if (e.selection.empty()) {
        e.panel_state->arrange.asked = false;
        empty_note(
            "Select things in the picture or the outliner to align, distribute, mirror, repeat or replace them. "
            "Shift adds to the selection; the last selected thing is what others are aligned to or replaced by.");
        return;
    }
    const std::size_t things = things_of(e).size();
    ImGui::TextDisabled("%s", e.selection.light() ? "A light"
                              : things == 1       ? "One thing"
                                                  : fmt::format("{} things", things).c_str());
    e.mark("arrange.things");
    array_section(e);
    align_section(e);
    distribute_section(e);
    mirror_section(e);
    replace_section(e);
}

} // namespace restage::editor
