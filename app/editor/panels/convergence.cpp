// SPDX-License-Identifier: Apache-2.0
// Convergence: the estimated relative error of the live picture over time or samples; the previous picture for
// comparison, and the error at which rendering stops.
#include "panels.hpp"

#include "panel_context.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <implot.h>
#include <algorithm>
#include <utility>

namespace restage::editor {

void follow_convergence(PanelUi& e, const PictureView& picture) {
    ConvergenceState& state = e.panel_state->convergence;
    const auto frame = picture.live().frame();
    if (!frame || frame->divider != 1 || frame->relative_error >= 1e29) return;
    if (frame->request != state.current.request) {
        // Pictures soon abandoned because something moved are not useful for comparison.
        if (state.current.error.size() > 2) state.previous = std::move(state.current);
        state.current = {.request = frame->request};
    }
    Curve& curve = state.current;
    const double samples = frame->image.samples;
    if (!curve.samples.empty() && samples <= curve.samples.back()) return;
    curve.seconds.push_back(frame->seconds);
    curve.samples.push_back(samples);
    curve.error.push_back(frame->relative_error * 100);
}

void draw_convergence(PanelUi& e, const PictureView& picture) {
    ConvergenceState& state = e.panel_state->convergence;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Error against");
    ImGui::SameLine();
    if (ImGui::RadioButton("Time", !state.against_samples)) state.against_samples = false;
    e.mark("convergence.time");
    ImGui::SameLine();
    if (ImGui::RadioButton("Samples", state.against_samples)) state.against_samples = true;
    e.mark("convergence.samples");
    const Curve& now = state.current;
    if (!now.error.empty()) {
        ImGui::SameLine();
        ImGui::TextDisabled("%.2f %% after %.0f samples per pixel, %.1f s; %.2f million samples per second",
                            now.error.back(), now.samples.back(), now.seconds.back(),
                            picture.live().status().samples_per_second * 1e-6);
        tip("The estimated relative error of the picture before denoising");
    }
    if (now.error.empty() && state.previous.error.empty()) {
        empty_note("The error is estimated once there are two samples per pixel.");
        return;
    }
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImPlotStyle& style = ImPlot::GetStyle();
    style.PlotPadding = {8 * scale, 6 * scale};
    style.LabelPadding = {4 * scale, 3 * scale};
    if (!ImPlot::BeginPlot("##error", {-1, -1}, ImPlotFlags_NoMouseText)) return;
    ImPlot::SetupAxes(state.against_samples ? "Samples per pixel" : "Time (s)", "Error (%)", ImPlotAxisFlags_AutoFit,
                      ImPlotAxisFlags_AutoFit);
    // Logarithmic over more than a decade; below that there would be no ticks.
    const auto scale_of = [&](auto values) {
        double least = 1e30, most = 0;
        for (const Curve* curve : {&std::as_const(state.previous), &now})
            for (const double value : (*curve).*values) {
                least = std::min(least, value);
                most = std::max(most, value);
            }
        return most > 10 * least ? ImPlotScale_Log10 : ImPlotScale_Linear;
    };
    ImPlot::SetupAxisScale(ImAxis_X1, scale_of(state.against_samples ? &Curve::samples : &Curve::seconds));
    ImPlot::SetupAxisScale(ImAxis_Y1, scale_of(&Curve::error));
    ImPlot::SetupLegend(ImPlotLocation_NorthEast);
    const auto line = [&](const char* name, const Curve& curve, const ImVec4& color) {
        if (curve.error.empty()) return;
        const auto& x = state.against_samples ? curve.samples : curve.seconds;
        ImPlotSpec spec;
        spec.LineColor = color;
        spec.LineWeight = 1.5f * scale;
        ImPlot::PlotLine(name, x.data(), curve.error.data(), int(x.size()), spec);
    };
    line("Previous picture", state.previous, colors::dim);
    line("This picture", now, colors::accent);
    if (const double target = picture.view.error * 100; target > 0) {
        ImPlotSpec spec;
        spec.LineColor = colors::good;
        spec.Flags = ImPlotInfLinesFlags_Horizontal;
        ImPlot::PlotInfLines("Target", &target, 1, spec);
    }
    ImPlot::EndPlot();
}

} // namespace restage::editor
