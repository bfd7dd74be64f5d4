// SPDX-License-Identifier: Apache-2.0
// Both themes: text can be read on every ground it is drawn on.
#include "editor/actions.hpp"
#include "headless.hpp"
#include "temporary_folder.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <string>
#include <vector>

namespace restage::tests {

namespace {

using editor::blend;
namespace colors = editor::colors;

struct Ground {
    std::string name;
    ImVec4 color;
};

ImVec4 style(ImGuiCol color) { return ImGui::GetStyleColorVec4(color); }

// What the colours of a style look like in a window and in a popup.
std::vector<Ground> grounds(std::initializer_list<ImGuiCol> of) {
    std::vector<Ground> all;
    const ImVec4 window = style(ImGuiCol_WindowBg), popup = blend(style(ImGuiCol_PopupBg), window);
    for (const ImGuiCol one : of)
        for (const auto& [name, below] : {Ground{" in a window", window}, Ground{" in a popup", popup}})
            all.push_back({ImGui::GetStyleColorName(one) + name, blend(style(one), below)});
    return all;
}

// Over the darkest and the brightest picture.
std::vector<Ground> over_pictures() {
    return {{"over black", blend(colors::over_picture, {0, 0, 0, 1})},
            {"over white", blend(colors::over_picture, {1, 1, 1, 1})}};
}

void readable(const std::string& text, const ImVec4& color, const std::vector<Ground>& on, float least = 4.5f) {
    for (const Ground& ground : on) {
        INFO(text << " on " << ground.name << ": " << editor::contrast(color, ground.color));
        CHECK(editor::contrast(color, ground.color) >= least);
    }
}

class Imgui {
  public:
    explicit Imgui(editor::Theme theme) {
        ImGui::CreateContext();
        editor::apply_theme(1, {});
        editor::apply_colors(theme);
    }
    ~Imgui() { ImGui::DestroyContext(); }
    Imgui(const Imgui&) = delete;
    Imgui& operator=(const Imgui&) = delete;
};

} // namespace

TEST_CASE("contrast is that of WCAG 2.1", "[ui]") {
    const ImVec4 black{0, 0, 0, 1}, white{1, 1, 1, 1}, grey{0.46667f, 0.46667f, 0.46667f, 1};
    CHECK(std::abs(editor::contrast(black, white) - 21) < 1e-3f);
    CHECK(editor::contrast(white, white) == 1);
    CHECK(std::abs(editor::contrast(white, grey) - 4.478f) < 0.01f); // #777: just too little
    const ImVec4 half = blend({1, 1, 1, 0.5f}, black);
    CHECK((half.x == 0.5f && half.w == 1));
}

TEST_CASE("all text of both themes has a contrast of 4.5 at least, disabled text of 3", "[ui]") {
    const auto theme = GENERATE(editor::Theme::dark, editor::Theme::light);
    INFO((theme == editor::Theme::dark ? "dark" : "light"));
    const Imgui imgui(theme);
    const auto everywhere = grounds({ImGuiCol_WindowBg,
                                     ImGuiCol_ChildBg,
                                     ImGuiCol_PopupBg,
                                     ImGuiCol_MenuBarBg,
                                     ImGuiCol_TitleBg,
                                     ImGuiCol_TitleBgActive,
                                     ImGuiCol_Tab,
                                     ImGuiCol_TabHovered,
                                     ImGuiCol_TabSelected,
                                     ImGuiCol_TabDimmed,
                                     ImGuiCol_TabDimmedSelected,
                                     ImGuiCol_FrameBg,
                                     ImGuiCol_FrameBgHovered,
                                     ImGuiCol_FrameBgActive,
                                     ImGuiCol_SliderGrab,
                                     ImGuiCol_SliderGrabActive,
                                     ImGuiCol_Button,
                                     ImGuiCol_ButtonHovered,
                                     ImGuiCol_ButtonActive,
                                     ImGuiCol_Header,
                                     ImGuiCol_HeaderHovered,
                                     ImGuiCol_HeaderActive,
                                     ImGuiCol_TableHeaderBg,
                                     ImGuiCol_TableRowBg,
                                     ImGuiCol_TableRowBgAlt,
                                     ImGuiCol_PlotHistogram});
    readable("text", style(ImGuiCol_Text), everywhere);
    readable("text", style(ImGuiCol_Text),
             {{"selected text", blend(style(ImGuiCol_TextSelectedBg), style(ImGuiCol_FrameBg))}});
    readable("text", style(ImGuiCol_Text), over_pictures());

    // Coloured and less important text, also in rows that are selected or under the mouse.
    const auto rows = grounds({ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_MenuBarBg, ImGuiCol_TableRowBgAlt,
                               ImGuiCol_Header, ImGuiCol_HeaderHovered});
    const std::pair<const char*, ImVec4> inks[] = {{"accent", colors::accent}, {"hover", colors::hover},
                                                   {"good", colors::good},     {"warning", colors::warning},
                                                   {"error", colors::error},   {"dim", colors::dim}};
    for (const auto& [name, ink] : inks) {
        readable(name, ink, rows);
        readable(name, ink, over_pictures());
    }
    readable("a hint", style(ImGuiCol_TextDisabled), grounds({ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered}));
    readable("an unreadable value", colors::error, grounds({ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered}));
    for (const ImVec4& axis : colors::axes) // a letter on the end of each
        readable("a letter", style(ImGuiCol_WindowBg), {{"an axis", axis}});

    // Disabled: the ground fades, too.
    const float alpha = ImGui::GetStyle().DisabledAlpha;
    for (const ImGuiCol one : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_Button, ImGuiCol_FrameBg}) {
        const ImVec4 window = style(ImGuiCol_WindowBg);
        ImVec4 top = style(one), text = style(ImGuiCol_Text);
        top.w *= alpha;
        text.w *= alpha;
        const ImVec4 ground = blend(top, window);
        readable("disabled text", blend(text, ground), {{ImGui::GetStyleColorName(one), ground}}, 3);
    }

    // What is no text (WCAG 2.1, 1.4.11).
    readable("an icon that is off", colors::off, grounds({ImGuiCol_WindowBg}), 3);
    readable("a check mark", style(ImGuiCol_CheckMark), grounds({ImGuiCol_CheckboxSelectedBg}), 3);
}

TEST_CASE("the theme changes at once, and is remembered", "[ui]") {
    const test::TemporaryFolder config;
    {
        Headless h("cornell/cornell.pbrt", 1, {1500, 1000}, config.path());
        CHECK(editor::current_theme() == editor::Theme::dark);
        const ImVec4 before = style(ImGuiCol_WindowBg);
        h.play("light", [&](ImGuiTestContext* ctx) {
            h.editor().run("view.light_theme");
            ctx->Yield(3);
            IM_CHECK(editor::current_theme() == editor::Theme::light);
            IM_CHECK(style(ImGuiCol_WindowBg).x > before.x + 0.3f);
            IM_CHECK(h.editor().action_state("view.light_theme").checked);
        });
        CHECK(h.step() == 0); // it is no change of the document
    }
    CHECK(editor::read_preferences(config.path()).theme == editor::Theme::light);
    Headless h("cornell/cornell.pbrt", 1, {1500, 1000}, config.path());
    CHECK(editor::current_theme() == editor::Theme::light);
}

} // namespace restage::tests
