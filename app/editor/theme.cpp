// SPDX-License-Identifier: Apache-2.0
#include "theme.hpp"

namespace restage::editor {

namespace {

ImVec4 grey(float v, float alpha = 1) { return {v, v * 1.01f, v * 1.04f, alpha}; }

} // namespace

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
    style.FrameBorderSize = 0;
    style.TabBarBorderSize = 1;
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.DisabledAlpha = 0.45f;

    // Neutral greys, so as not to bias how the picture's colours are seen.
    ImGui::StyleColorsDark();
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = grey(0.90f);
    c[ImGuiCol_TextDisabled] = colors::dim;
    c[ImGuiCol_WindowBg] = grey(0.145f);
    c[ImGuiCol_ChildBg] = grey(0.145f);
    c[ImGuiCol_PopupBg] = grey(0.18f, 0.98f);
    c[ImGuiCol_Border] = grey(0.08f);
    c[ImGuiCol_FrameBg] = grey(0.22f);
    c[ImGuiCol_FrameBgHovered] = grey(0.28f);
    c[ImGuiCol_FrameBgActive] = grey(0.32f);
    c[ImGuiCol_TitleBg] = grey(0.11f);
    c[ImGuiCol_TitleBgActive] = grey(0.11f);
    c[ImGuiCol_TitleBgCollapsed] = grey(0.11f);
    c[ImGuiCol_MenuBarBg] = grey(0.12f);
    c[ImGuiCol_ScrollbarBg] = grey(0.12f, 0);
    c[ImGuiCol_ScrollbarGrab] = grey(0.32f);
    c[ImGuiCol_ScrollbarGrabHovered] = grey(0.40f);
    c[ImGuiCol_ScrollbarGrabActive] = grey(0.48f);
    c[ImGuiCol_CheckboxSelectedBg] = grey(0.22f);
    c[ImGuiCol_CheckMark] = colors::accent;
    c[ImGuiCol_SliderGrab] = grey(0.42f); // the value is written over it
    c[ImGuiCol_SliderGrabActive] = {0.66f, 0.43f, 0.16f, 1};
    c[ImGuiCol_Button] = grey(0.26f);
    c[ImGuiCol_ButtonHovered] = grey(0.34f);
    c[ImGuiCol_ButtonActive] = grey(0.42f);
    c[ImGuiCol_Header] = {0.96f, 0.62f, 0.22f, 0.28f};
    c[ImGuiCol_HeaderHovered] = grey(0.30f);
    c[ImGuiCol_HeaderActive] = {0.96f, 0.62f, 0.22f, 0.45f};
    c[ImGuiCol_Separator] = grey(0.09f);
    c[ImGuiCol_SeparatorHovered] = colors::accent;
    c[ImGuiCol_SeparatorActive] = colors::accent;
    c[ImGuiCol_ResizeGrip] = grey(0.3f, 0);
    c[ImGuiCol_Tab] = grey(0.11f);
    c[ImGuiCol_TabHovered] = grey(0.24f);
    c[ImGuiCol_TabSelected] = grey(0.145f);
    c[ImGuiCol_TabSelectedOverline] = colors::accent;
    c[ImGuiCol_TabDimmed] = grey(0.11f);
    c[ImGuiCol_TabDimmedSelected] = grey(0.145f);
    c[ImGuiCol_TabDimmedSelectedOverline] = grey(0.3f);
    c[ImGuiCol_DockingPreview] = {0.96f, 0.62f, 0.22f, 0.5f};
    c[ImGuiCol_DockingEmptyBg] = grey(0.10f);
    c[ImGuiCol_TextSelectedBg] = {0.96f, 0.62f, 0.22f, 0.35f};
    c[ImGuiCol_DragDropTarget] = colors::accent;
    c[ImGuiCol_NavCursor] = colors::accent;
    c[ImGuiCol_PlotHistogram] = colors::accent;
    c[ImGuiCol_TableHeaderBg] = grey(0.19f);
    c[ImGuiCol_TableRowBgAlt] = grey(1.f, 0.02f);
    c[ImGuiCol_ModalWindowDimBg] = grey(0.f, 0.5f);
    style.ScaleAllSizes(scale);
}

} // namespace restage::editor
