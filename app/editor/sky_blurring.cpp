// SPDX-License-Identifier: Apache-2.0
#include "sky_blurring.hpp"

#include "files.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "scene/sky_blur.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <memory>
#include <utility>

namespace restage::editor {

namespace {

void blur(EditContext& e, double degrees) {
    const auto& sky = e.scene().environment.value;
    const scene::Image* image = sky ? e.scene().images.find(sky->image) : nullptr;
    if (!image || !image->data) return;
    e.files().jobs.start({.title = "Blurring the sky"},
                         [sky, data = image->data, degrees](BackgroundJob&) -> std::function<void(PanelContext&)> {
                             auto blurred =
                                 std::make_shared<scene::PixelData>(scene::blurred_sky(*data, sky->mapping, degrees));
                             return [sky, blurred](PanelContext& editor) {
                                 editor.edit([sky, blurred](const scene::Scene& s) -> Result<scene::Edit> {
                                     if (s.environment.value != sky)
                                         return fail("the sky has changed while it was blurred");
                                     return scene::set_blurred_sky(s, *blurred);
                                 });
                             };
                         });
}

} // namespace

void blur_row(EditContext& e) {
    const char* label = "Blur";
    const float width = ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x;
    form_row(label,
             "Softens the sky's image over this angle, so that reflections and the backdrop are out of focus and a sun "
             "throws softer shadows. Its light stays. The blurred image replaces the sharp one; undo brings that back",
             width + ImGui::GetStyle().ItemInnerSpacing.x);
    float& angle = e.panel_state->scene.blur;
    ImGui::DragFloat("##blur", &angle, 0.1f, float(scene::least_blur), 90, "%.1f°", ImGuiSliderFlags_AlwaysClamp);
    e.mark("sky.blur_angle");
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("Blur##sky")) blur(e, double(angle));
    tip("Blurs it now. Again: more");
    e.mark("sky.blur");
}

} // namespace restage::editor
