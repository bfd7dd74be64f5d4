// SPDX-License-Identifier: Apache-2.0
// Scene panel, development: how the picture is shown, and written as .png and .jpg.
#include "scene_development.hpp"

#include "document/session.hpp"
#include "param_widget.hpp"
#include "scene/color_temperature.hpp"
#include "scene/development.hpp"
#include "scene/edits.hpp"
#include "scene_panel.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <string>

namespace restage::editor {

bool tone_combo(PanelUi& e, scene::Development& d, const char* mark) {
    const scene::ToneCurve before = d.tone;
    const bool open = ImGui::BeginCombo("##tone", scene::tone_curves[std::size_t(d.tone)].label);
    tip("The tone curve: how bright colours are fitted into the range of a screen. Part of the project, and applied to "
        "written .png and .jpg; .exr stays linear");
    e.mark(mark);
    if (!open) return false;
    for (std::size_t i = 0; i < scene::tone_curves.size(); ++i) {
        const scene::ToneCurveRow& row = scene::tone_curves[i];
        if (ImGui::Selectable(row.label, scene::ToneCurve(i) == d.tone)) d.tone = scene::ToneCurve(i);
        tip(row.tooltip);
        e.mark(std::string(mark) + "." + row.name);
    }
    ImGui::EndCombo();
    return d.tone != before;
}

void ask_development(EditContext& e, const scene::Development& d, const char* label, const char* gesture) {
    e.edit(
        [d, label](const scene::Scene& s) {
            scene::Film film = s.film.value;
            film.development = d;
            return Result<scene::Edit>(scene::set_film(s, std::move(film), label));
        },
        gesture);
}

void backdrop_rows(EditContext& e) {
    static constexpr const char* kinds[] = {"Black", "One colour", "Transparent"};
    scene::Development d = e.scene().film.value.development;
    form_row("Backdrop", "Shown where no sky is. Transparent: with alpha in .png and .exr");
    const bool open = ImGui::BeginCombo("##backdrop", kinds[std::size_t(d.backdrop)]);
    e.mark("sky.backdrop");
    if (open) {
        for (std::size_t i = 0; i < std::size(kinds); ++i) {
            if (ImGui::Selectable(kinds[i], i == std::size_t(d.backdrop)) && i != std::size_t(d.backdrop)) {
                d.backdrop = scene::Backdrop(i);
                ask_development(e, d, "Backdrop");
            }
            e.mark(std::string("sky.backdrop.") + scene::backdrop_names[i]);
        }
        ImGui::EndCombo();
    }
    if (d.backdrop != scene::Backdrop::color) return;
    form_row("Backdrop colour", "As it is shown: exposure and tone curve do not change it");
    if (color_field("##backdrop colour", &d.backdrop_color.x)) ask_development(e, d, "Backdrop", "sky.backdrop_color");
    e.mark("sky.backdrop_color");
}

void development_section(EditContext& e) {
    const bool open = section_header("Development");
    e.mark("scene.development");
    if (!open) return;
    ImGui::PushID("development");
    empty_note("How the picture is shown, and written as .png and .jpg. An .exr stays linear.");
    const scene::Development now = e.scene().film.value.development;
    scene::Development d = now;
    form_row("Tone curve", "How bright colours are fitted into the range of a screen");
    if (tone_combo(e, d, "development.tone")) ask_development(e, d, "Tone curve");
    const auto slider = [&](const char* label, const char* tooltip, float& value, float least, float most,
                            const char* format, const char* mark, ImGuiSliderFlags flags = 0) {
        ImGui::PushID(mark);
        form_row(label, tooltip);
        if (ImGui::SliderFloat("##value", &value, least, most, format, ImGuiSliderFlags_AlwaysClamp | flags))
            ask_development(e, d, label, mark);
        e.mark(mark);
        ImGui::PopID();
    };
    slider("White balance",
           "The colour temperature of the light that is shown as white: about 2900 K for bulbs, 6504 K (daylight) "
           "changes nothing",
           d.temperature, 2000, 12000, "%.0f K", "development.white_balance", ImGuiSliderFlags_Logarithmic);
    slider("Tint", "Of that light: to the right greenish, as of fluorescent lamps, which makes the picture pinker",
           d.tint, -scene::most_tint, scene::most_tint, "%+.0f", "development.tint");
    slider("Vignette", "Darkens towards the corners, as wide lenses do: 1 leaves a quarter there", d.vignette, 0, 1,
           d.vignette > 0 ? "%.2f" : "Off", "development.vignette");
    slider("Bloom", "The fraction of all light that is scattered into a glow, as in lenses and eyes", d.bloom, 0, 0.5f,
           d.bloom > 0 ? "%.3f" : "Off", "development.bloom", ImGuiSliderFlags_Logarithmic);
    ImGui::BeginDisabled(now == scene::Development{});
    if (ImGui::Button("Reset")) ask_development(e, {}, "Reset development");
    tip("Standard tone curve, daylight, nothing darkened or scattered");
    e.mark("development.reset");
    ImGui::EndDisabled();
    ImGui::PopID();
}

} // namespace restage::editor
