// SPDX-License-Identifier: Apache-2.0
// Convergence: the estimated relative error of the live picture against time, as it falls.
#include "panels.hpp"

#include <imgui.h>
#include <implot.h>

namespace restage::editor {

namespace {

struct Curve {
    std::uint64_t request = 0;
    std::vector<double> seconds, samples, error;
};

} // namespace

void draw_convergence(Editor& e) {
    static Curve curve; // of the one live picture there is
    static bool against_samples = false;
    if (const auto frame = e.live().frame(); frame && frame->divider == 1 && frame->relative_error < 1e29) {
        if (frame->request != curve.request) curve = {.request = frame->request};
        const double samples = frame->image.samples;
        if (curve.samples.empty() || samples > curve.samples.back()) {
            curve.seconds.push_back(frame->seconds);
            curve.samples.push_back(samples);
            curve.error.push_back(frame->relative_error);
        }
    }
    ImGui::Checkbox("Against samples", &against_samples);
    if (curve.error.empty()) {
        ImGui::TextDisabled("Two samples a pixel are needed to estimate an error.");
        return;
    }
    if (!ImPlot::BeginPlot("##error", {-1, -1}, ImPlotFlags_NoMouseText)) return;
    ImPlot::SetupAxes(against_samples ? "samples a pixel" : "seconds", "relative error", ImPlotAxisFlags_AutoFit,
                      ImPlotAxisFlags_AutoFit);
    ImPlot::SetupAxisScale(ImAxis_X1, ImPlotScale_Log10);
    ImPlot::SetupAxisScale(ImAxis_Y1, ImPlotScale_Log10);
    const auto& x = against_samples ? curve.samples : curve.seconds;
    ImPlot::PlotLine("estimated", x.data(), curve.error.data(), int(x.size()));
    ImPlot::EndPlot();
}

} // namespace restage::editor
