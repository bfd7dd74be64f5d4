// SPDX-License-Identifier: Apache-2.0
// Convergence: the estimated relative error of the live picture against time or samples, as it falls; the picture
// before it for comparison, and the error at which rendering stops.
#include "panels.hpp"

#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <implot.h>
#include <string>
#include <vector>

namespace restage::editor {

void follow_convergence(Editor& e) {
    ConvergenceState& state = e.panel_state->convergence;
    const auto frame = e.live().frame();
    if (!frame || frame->divider != 1 || frame->relative_error >= 1e29) return;
    if (frame->request != state.current.request) {
        // Pictures that were left after a moment, while something moved, are no comparison.
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

namespace {

// 1, 2 and 5 of every decade: ImPlot's own ticks are whole decades, of which a short curve may hold none.
void one_two_five(ImAxis axis) {
    static const auto ticks = [] {
        std::pair<std::vector<double>, std::vector<std::string>> made;
        for (double decade = 1e-3; decade < 1e7; decade *= 10)
            for (const int digit : {1, 2, 5}) {
                made.first.push_back(decade * digit);
                made.second.push_back(fmt::format("{:.6g}", decade * digit));
            }
        return made;
    }();
    std::vector<const char*> labels;
    for (const std::string& label : ticks.second)
        labels.push_back(label.c_str());
    ImPlot::SetupAxisTicks(axis, ticks.first.data(), int(ticks.first.size()), labels.data());
}

} // namespace

void draw_convergence(Editor& e) {
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
        ImGui::TextDisabled("%.2f %% after %.0f samples a pixel, %.1f s; %.2f million samples a second",
                            now.error.back(), now.samples.back(), now.seconds.back(),
                            e.live().status().samples_per_second * 1e-6);
        tip("The estimated relative error of the picture before denoising");
    }
    if (now.error.empty() && state.previous.error.empty()) {
        empty_note("The error is estimated from two samples a pixel on.");
        return;
    }
    const float scale = ImGui::GetStyle().FontScaleMain;
    ImPlotStyle& style = ImPlot::GetStyle();
    style.PlotPadding = {8 * scale, 6 * scale};
    style.LabelPadding = {4 * scale, 3 * scale};
    if (!ImPlot::BeginPlot("##error", {-1, -1}, ImPlotFlags_NoMouseText)) return;
    ImPlot::SetupAxes(state.against_samples ? "Samples a pixel" : "Time (s)", "Error (%)", ImPlotAxisFlags_AutoFit,
                      ImPlotAxisFlags_AutoFit);
    ImPlot::SetupAxisScale(ImAxis_X1, ImPlotScale_Log10);
    ImPlot::SetupAxisScale(ImAxis_Y1, ImPlotScale_Log10);
    one_two_five(ImAxis_X1);
    one_two_five(ImAxis_Y1);
    ImPlot::SetupLegend(ImPlotLocation_NorthEast);
    const auto line = [&](const char* name, const Curve& curve, const ImVec4& color) {
        if (curve.error.empty()) return;
        const auto& x = state.against_samples ? curve.samples : curve.seconds;
        ImPlotSpec spec;
        spec.LineColor = color;
        spec.LineWeight = 1.5f * scale;
        ImPlot::PlotLine(name, x.data(), curve.error.data(), int(x.size()), spec);
    };
    line("Picture before", state.previous, colors::dim);
    line("This picture", now, colors::accent);
    if (const double target = e.view.error * 100; target > 0) {
        ImPlotSpec spec;
        spec.LineColor = colors::good;
        spec.Flags = ImPlotInfLinesFlags_Horizontal;
        ImPlot::PlotInfLines("Target", &target, 1, spec);
    }
    ImPlot::EndPlot();
}

} // namespace restage::editor
