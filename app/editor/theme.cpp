// SPDX-License-Identifier: Apache-2.0
#include "theme.hpp"

#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

ImVec4 grey(float v, float alpha = 1) { return {v, std::min(v + 0.0015f, 1.f), std::min(v + 0.006f, 1.f), alpha}; }

constexpr Colors dark{.accent = {0.96f, 0.62f, 0.22f, 1},
                      .hover = {0.55f, 0.78f, 0.98f, 1},
                      .good = {0.45f, 0.78f, 0.47f, 1},
                      .warning = {0.95f, 0.76f, 0.30f, 1},
                      .error = {1.f, 0.60f, 0.56f, 1},
                      .dim = {0.70f, 0.71f, 0.74f, 1},
                      .off = {0.46f, 0.46f, 0.48f, 1},
                      .axes = {{0.93f, 0.40f, 0.40f, 1}, {0.55f, 0.80f, 0.38f, 1}, {0.42f, 0.64f, 0.98f, 1}},
                      .over_picture = {0.063f, 0.063f, 0.071f, 0.9f}};
constexpr Colors light{.accent = {0.54f, 0.245f, 0.f, 1},
                       .hover = {0.05f, 0.31f, 0.62f, 1},
                       .good = {0.08f, 0.38f, 0.12f, 1},
                       .warning = {0.47f, 0.29f, 0.f, 1},
                       .error = {0.68f, 0.08f, 0.07f, 1},
                       .dim = {0.30f, 0.31f, 0.33f, 1},
                       .off = {0.50f, 0.50f, 0.52f, 1},
                       .axes = {{0.72f, 0.13f, 0.13f, 1}, {0.20f, 0.42f, 0.06f, 1}, {0.10f, 0.30f, 0.72f, 1}},
                       .over_picture = {0.97f, 0.97f, 0.98f, 0.92f}};

Theme shown = Theme::dark;
Colors now = dark;

// Greys of one theme, by what they are the ground of.
struct Greys {
    float text, window, popup, border, frame, frame_hovered, frame_active, title, menu, grab, grab_hovered, grab_active,
        slider, button, button_hovered, button_active, row_hovered, separator, tab_hovered, dimmed_line, empty, header;
};
constexpr Greys dark_greys{.text = 0.90f,
                           .window = 0.145f,
                           .popup = 0.165f,
                           .border = 0.08f,
                           .frame = 0.22f,
                           .frame_hovered = 0.27f,
                           .frame_active = 0.30f,
                           .title = 0.11f,
                           .menu = 0.12f,
                           .grab = 0.32f,
                           .grab_hovered = 0.40f,
                           .grab_active = 0.48f,
                           .slider = 0.38f,
                           .button = 0.26f,
                           .button_hovered = 0.33f,
                           .button_active = 0.39f,
                           .row_hovered = 0.265f,
                           .separator = 0.09f,
                           .tab_hovered = 0.24f,
                           .dimmed_line = 0.3f,
                           .empty = 0.10f,
                           .header = 0.19f};
constexpr Greys light_greys{.text = 0.10f,
                            .window = 0.89f,
                            .popup = 0.94f,
                            .border = 0.66f,
                            .frame = 0.96f,
                            .frame_hovered = 0.92f,
                            .frame_active = 0.88f,
                            .title = 0.78f,
                            .menu = 0.83f,
                            .grab = 0.70f,
                            .grab_hovered = 0.62f,
                            .grab_active = 0.54f,
                            .slider = 0.74f,
                            .button = 0.79f,
                            .button_hovered = 0.73f,
                            .button_active = 0.67f,
                            .row_hovered = 0.80f,
                            .separator = 0.70f,
                            .tab_hovered = 0.86f,
                            .dimmed_line = 0.6f,
                            .empty = 0.74f,
                            .header = 0.82f};

float luminance(const ImVec4& color) {
    const auto linear = [](float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); };
    return 0.2126f * linear(color.x) + 0.7152f * linear(color.y) + 0.0722f * linear(color.z);
}

ImVec4 with_alpha(ImVec4 color, float alpha) {
    color.w = alpha;
    return color;
}

} // namespace

namespace colors {
const ImVec4 &accent = now.accent, &hover = now.hover, &good = now.good, &warning = now.warning, &error = now.error,
             &dim = now.dim, &off = now.off, &over_picture = now.over_picture;
const ImVec4 (&axes)[3] = now.axes;
} // namespace colors

Theme current_theme() { return shown; }

float contrast(const ImVec4& a, const ImVec4& b) {
    const float first = luminance(a) + 0.05f, second = luminance(b) + 0.05f;
    return std::max(first, second) / std::min(first, second);
}

ImVec4 blend(const ImVec4& top, const ImVec4& below) {
    const float rest = 1 - top.w;
    return {top.x * top.w + below.x * rest, top.y * top.w + below.y * rest, top.z * top.w + below.z * rest, 1};
}

ImU32 faded(const ImVec4& color, float alpha) { return ImGui::GetColorU32(with_alpha(color, alpha)); }

void apply_colors(Theme theme) {
    shown = theme;
    now = theme == Theme::dark ? dark : light;
    const bool on_dark = theme == Theme::dark;
    const Greys& g = on_dark ? dark_greys : light_greys;
    constexpr ImVec4 orange{0.96f, 0.62f, 0.22f, 1};
    const ImVec4 bar = on_dark ? ImVec4{0.55f, 0.33f, 0.09f, 1} : ImVec4{0.95f, 0.72f, 0.42f, 1}; // below text
    // Neutral greys, so as not to bias how the picture's colours are seen.
    if (on_dark)
        ImGui::StyleColorsDark();
    else
        ImGui::StyleColorsLight();
    ImGui::GetStyle().DisabledAlpha = on_dark ? 0.45f : 0.55f;
    ImGui::GetStyle().FrameBorderSize = on_dark ? 0 : 1; // fields are hardly lighter than windows
    ImVec4* c = ImGui::GetStyle().Colors;
    c[ImGuiCol_Text] = grey(g.text);
    c[ImGuiCol_TextDisabled] = now.dim;
    c[ImGuiCol_TextLink] = now.hover;
    c[ImGuiCol_InputTextCursor] = grey(g.text);
    c[ImGuiCol_WindowBg] = grey(g.window);
    c[ImGuiCol_ChildBg] = grey(g.window);
    c[ImGuiCol_PopupBg] = grey(g.popup, 0.98f);
    c[ImGuiCol_Border] = grey(g.border);
    c[ImGuiCol_FrameBg] = grey(g.frame);
    c[ImGuiCol_FrameBgHovered] = grey(g.frame_hovered);
    c[ImGuiCol_FrameBgActive] = grey(g.frame_active);
    c[ImGuiCol_TitleBg] = grey(g.title);
    c[ImGuiCol_TitleBgActive] = grey(g.title);
    c[ImGuiCol_TitleBgCollapsed] = grey(g.title);
    c[ImGuiCol_MenuBarBg] = grey(g.menu);
    c[ImGuiCol_ScrollbarBg] = grey(g.menu, 0);
    c[ImGuiCol_ScrollbarGrab] = grey(g.grab);
    c[ImGuiCol_ScrollbarGrabHovered] = grey(g.grab_hovered);
    c[ImGuiCol_ScrollbarGrabActive] = grey(g.grab_active);
    c[ImGuiCol_CheckboxSelectedBg] = grey(g.frame);
    c[ImGuiCol_CheckMark] = now.accent;
    c[ImGuiCol_SliderGrab] = grey(g.slider); // the value is written over it
    c[ImGuiCol_SliderGrabActive] = bar;
    c[ImGuiCol_Button] = grey(g.button);
    c[ImGuiCol_ButtonHovered] = grey(g.button_hovered);
    c[ImGuiCol_ButtonActive] = grey(g.button_active);
    c[ImGuiCol_Header] = with_alpha(orange, on_dark ? 0.20f : 0.35f);
    c[ImGuiCol_HeaderHovered] = grey(g.row_hovered);
    c[ImGuiCol_HeaderActive] = with_alpha(orange, 0.42f);
    c[ImGuiCol_Separator] = grey(g.separator);
    c[ImGuiCol_SeparatorHovered] = now.accent;
    c[ImGuiCol_SeparatorActive] = now.accent;
    c[ImGuiCol_ResizeGrip] = grey(g.dimmed_line, 0);
    c[ImGuiCol_Tab] = grey(g.title);
    c[ImGuiCol_TabHovered] = grey(g.tab_hovered);
    c[ImGuiCol_TabSelected] = grey(g.window);
    c[ImGuiCol_TabSelectedOverline] = now.accent;
    c[ImGuiCol_TabDimmed] = grey(g.title);
    c[ImGuiCol_TabDimmedSelected] = grey(g.window);
    c[ImGuiCol_TabDimmedSelectedOverline] = grey(g.dimmed_line);
    c[ImGuiCol_DockingPreview] = with_alpha(orange, 0.5f);
    c[ImGuiCol_DockingEmptyBg] = grey(g.empty);
    c[ImGuiCol_TextSelectedBg] = with_alpha(orange, 0.35f);
    c[ImGuiCol_DragDropTarget] = now.accent;
    c[ImGuiCol_NavCursor] = now.accent;
    c[ImGuiCol_PlotHistogram] = bar;
    c[ImGuiCol_TableHeaderBg] = grey(g.header);
    c[ImGuiCol_TableRowBgAlt] = grey(on_dark ? 1.f : 0.f, 0.02f);
    c[ImGuiCol_ModalWindowDimBg] = grey(0.f, on_dark ? 0.5f : 0.35f);
}

void apply_theme(float scale, const std::filesystem::path& fonts, std::span<const FallbackFont> fallback) {
    ImGuiIO& io = ImGui::GetIO();
    std::error_code none;
    if (const auto text = fonts / "Roboto-Medium.ttf"; std::filesystem::exists(text, none))
        io.Fonts->AddFontFromFileTTF(text.string().c_str(), 15.f);
    else
        io.Fonts->AddFontDefaultVector();
    for (const FallbackFont& font : fallback) {
        ImFontConfig config;
        config.MergeMode = true;
        config.FontNo = static_cast<ImU32>(font.face);
        config.Flags |= ImFontFlags_NoLoadError; // optional: not a reason to fail
        io.Fonts->AddFontFromFileTTF(font.file.string().c_str(), 15.f, &config);
    }

    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    style.FontScaleMain = scale;
    style.WindowPadding = {8, 8};
    style.FramePadding = {7, 4};
    style.ItemSpacing = {7, 5};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 12;
    style.GrabMinSize = 10;
    style.WindowRounding = 4;
    style.ChildRounding = 3;
    style.FrameRounding = 3;
    style.PopupRounding = 4;
    style.GrabRounding = 3;
    style.TabRounding = 3;
    style.WindowBorderSize = 1;
    style.TabBarBorderSize = 1;
    style.WindowMenuButtonPosition = ImGuiDir_None;

    apply_colors(Theme::dark);
    style.ScaleAllSizes(scale);
}

} // namespace restage::editor
