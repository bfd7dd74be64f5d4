// SPDX-License-Identifier: Apache-2.0
#include "widgets.hpp"

#include "theme.hpp"

#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

namespace restage::editor {

void form_row(const char* label, const char* tooltip, float right) {
    const float left = ImGui::GetCursorPosX(), all = ImGui::GetContentRegionAvail().x;
    const float scale = ImGui::GetStyle().FontScaleMain, gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const bool above = all < 215 * scale; // no room for two columns
    const float column = above ? 0 : std::floor(std::min(all * 0.40f, 150 * scale));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float room = above ? all : column - gap;
    const bool cut = ImGui::CalcTextSize(label).x > room;
    ImGui::AlignTextToFramePadding();
    if (cut) { // an ellipsis marks the cut
        const ImVec2 size(room, ImGui::GetTextLineHeight());
        const float y = at.y + ImGui::GetStyle().FramePadding.y;
        ImGui::RenderTextEllipsis(ImGui::GetWindowDrawList(), {at.x, y}, {at.x + size.x, y + size.y}, at.x + size.x,
                                  label, nullptr, nullptr);
        ImGui::Dummy({room, ImGui::GetFrameHeight()});
    } else {
        ImGui::TextUnformatted(label);
    }
    if (cut && tooltip && *tooltip)
        tip((std::string(label) + "\n" + tooltip).c_str());
    else
        tip(cut ? label : tooltip);
    if (!above) ImGui::SameLine(left + column);
    ImGui::SetNextItemWidth(
        std::max(40 * ImGui::GetStyle().FontScaleMain, all - column - (right > 0 ? right + gap : 0)));
}

void dialog_width(float width) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImGui::Dummy({std::min(width * scale, ImGui::GetMainViewport()->WorkSize.x - 40 * scale), 0});
}

bool section_header(const char* label, bool open_at_first) {
    ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyleColorVec4(ImGuiCol_TableHeaderBg));
    ImGui::PushStyleColor(ImGuiCol_HeaderActive, ImGui::GetStyleColorVec4(ImGuiCol_FrameBgActive));
    const bool open = ImGui::CollapsingHeader(label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    ImGui::PopStyleColor(2);
    return open;
}

void tip(const char* text) {
    if (text && *text && ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled)) {
        if (!ImGui::BeginTooltip()) return;
        ImGui::PushTextWrapPos(std::min(ImGui::GetFontSize() * 24,
                                        ImGui::GetMainViewport()->WorkSize.x - 3 * ImGui::GetStyle().WindowPadding.x));
        ImGui::TextUnformatted(text);
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
}

void empty_note(const char* text) {
    ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}

static void colored_note(const char* text, const ImVec4& color) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextWrapped("%s", text);
    ImGui::PopStyleColor();
}
void warning_note(const char* text) { colored_note(text, colors::warning); }
void error_note(const char* text) { colored_note(text, colors::error); }

void draw_icon(ImDrawList* draw, Icon icon, ImVec2 corner, float size, ImU32 color) {
    const ImVec2 c(corner.x + size / 2, corner.y + size / 2);
    const float r = size * 0.32f, line = std::max(1.f, size / 14);
    switch (icon) {
        case Icon::eye:
        case Icon::eye_closed: {
            const ImVec2 a(c.x - r * 1.25f, c.y), b(c.x + r * 1.25f, c.y);
            draw->AddBezierQuadratic(a, {c.x, c.y + r * 1.5f}, b, color, line);
            if (icon == Icon::eye) {
                draw->AddBezierQuadratic(a, {c.x, c.y - r * 1.5f}, b, color, line);
                draw->AddCircleFilled(c, r * 0.42f, color);
            }
            break;
        }
        case Icon::lock:
        case Icon::lock_open: {
            draw->AddRectFilled({c.x - r * 0.85f, c.y - r * 0.1f}, {c.x + r * 0.85f, c.y + r * 1.1f}, color, line);
            const float shift = icon == Icon::lock_open ? r * 0.9f : 0;
            draw->PathArcTo({c.x + shift, c.y - r * 0.1f}, r * 0.55f, 3.14159f, 2 * 3.14159f);
            draw->PathStroke(color, line);
            break;
        }
        case Icon::texture:
            draw->AddRect({c.x - r, c.y - r}, {c.x + r, c.y + r}, color, line, line);
            draw->AddRectFilled({c.x - r, c.y - r}, c, color);
            draw->AddRectFilled(c, {c.x + r, c.y + r}, color);
            break;
        case Icon::light:
        case Icon::sky:
            draw->AddCircleFilled(c, r * 0.5f, color);
            for (int i = 0; i < 8; ++i) {
                const float a = float(i) * 0.785398f, x = std::cos(a), y = std::sin(a);
                draw->AddLine({c.x + x * r * 0.8f, c.y + y * r * 0.8f}, {c.x + x * r * 1.25f, c.y + y * r * 1.25f},
                              color, line);
            }
            break;
        case Icon::camera:
            draw->AddRect({c.x - r * 1.1f, c.y - r * 0.7f}, {c.x + r * 0.5f, c.y + r * 0.7f}, color, line, line);
            draw->AddTriangleFilled({c.x + r * 0.5f, c.y}, {c.x + r * 1.25f, c.y - r * 0.6f},
                                    {c.x + r * 1.25f, c.y + r * 0.6f}, color);
            break;
        case Icon::mesh: { // a box, seen from above a corner
            const float h = r * 0.55f;
            const ImVec2 top[] = {{c.x, c.y - r * 1.1f}, {c.x + r, c.y - h}, {c.x, c.y}, {c.x - r, c.y - h}};
            draw->AddPolyline(top, 4, color, line, ImDrawFlags_Closed);
            const ImVec2 sides[] = {top[3], {c.x - r, c.y + h}, {c.x, c.y + r * 1.1f}, {c.x + r, c.y + h}, top[1]};
            draw->AddPolyline(sides, 5, color, line);
            draw->AddLine(top[2], sides[2], color, line);
            break;
        }
        case Icon::cross:
            draw->AddLine({c.x - r * 0.7f, c.y - r * 0.7f}, {c.x + r * 0.7f, c.y + r * 0.7f}, color, line);
            draw->AddLine({c.x + r * 0.7f, c.y - r * 0.7f}, {c.x - r * 0.7f, c.y + r * 0.7f}, color, line);
            break;
    }
}

bool icon_button(const char* id, Icon icon, bool on, const char* tooltip) {
    const float size = ImGui::GetFrameHeight();
    const bool pressed = ImGui::InvisibleButton(id, {size, size});
    const bool hovered = ImGui::IsItemHovered();
    const ImU32 color = ImGui::GetColorU32(hovered ? colors::hover
                                           : on    ? ImGui::GetStyleColorVec4(ImGuiCol_Text)
                                                   : colors::off);
    draw_icon(ImGui::GetWindowDrawList(), icon, ImGui::GetItemRectMin(), size, color);
    tip(tooltip);
    return pressed;
}

bool contains_word(std::string_view text, std::string_view word) {
    return std::search(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
           }) != text.end();
}

void flow(float width) {
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
}

float check_width(const char* label) {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(label, nullptr, true).x;
}

bool flow_button(const char* label, bool first) {
    if (!first) flow(ImGui::CalcTextSize(label, nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x);
    return ImGui::Button(label);
}

void searched_list(std::string& search, std::size_t count, const std::function<std::string_view(std::size_t)>& name,
                   const std::function<void(std::size_t)>& row, float row_height) {
    if (ImGui::IsWindowAppearing()) {
        search.clear();
        ImGui::SetKeyboardFocusHere();
    }
    if (count > 8 || !search.empty()) {
        ImGui::SetNextItemWidth(-FLT_MIN);
        ImGui::InputTextWithHint("##search", "Search", &search);
    }
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < count; ++i)
        if (contains_word(name(i), search)) found.push_back(i);
    if (found.empty()) ImGui::TextDisabled("Nothing matches.");
    const float height = row_height > 0 ? row_height : ImGui::GetTextLineHeightWithSpacing();
    if (!ImGui::BeginChild("list",
                           {std::max(ImGui::GetContentRegionAvail().x, 220 * ImGui::GetStyle().FontScaleMain),
                            height * float(std::clamp<std::size_t>(found.size(), 1, row_height > 0 ? 7 : 12)) + 4})) {
        ImGui::EndChild();
        return;
    }
    ImGuiListClipper clipper;
    clipper.Begin(int(found.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            ImGui::PushID(int(found[std::size_t(i)]));
            row(found[std::size_t(i)]);
            ImGui::PopID();
        }
    ImGui::EndChild();
}

bool name_field(const char* id, std::string& name) {
    const std::string before = name;
    ImGui::InputText(id, &name, ImGuiInputTextFlags_AutoSelectAll);
    return ImGui::IsItemDeactivatedAfterEdit() && !name.empty() && name != before;
}

std::string choice_label(std::string_view choice) {
    if (choice == "ggx") return "GGX"; // its authors' spelling
    if (choice.empty()) return "";
    std::string label(choice);
    std::ranges::replace(label, '_', ' ');
    const bool digit = std::any_of(label.begin(), label.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (label.size() > 2 && !digit) // not "v4", "mm", "z"
        label[0] = char(std::toupper(static_cast<unsigned char>(label[0])));
    return label;
}

float drag_speed(float value, float least) { return std::max(least, std::abs(value) * 0.01f); }

} // namespace restage::editor
