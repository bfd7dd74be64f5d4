// SPDX-License-Identifier: Apache-2.0
// Scene panel, rendering settings. Settings of the scene are undone and saved; those of this
// machine (targets of the live picture, device, threads) are not.
#include "scene_panel.hpp"

#include "base/jobs.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "render/tracers.hpp"
#include "scene/edits.hpp"
#include "scene/techniques.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace restage::editor {

namespace {

void scene_rows(EditContext& e) {
    scene::Settings settings = e.scene().settings.value;
    bool changed = false;
    int samples = int(settings.samples), depth = int(settings.max_depth);
    form_row("Samples", "Light paths per pixel: twice as many take twice the time and leave 0.7 of the noise");
    changed |= ImGui::DragInt("##samples", &samples, std::max(1.f, float(samples) * 0.01f), 1, 1 << 20, "%d a pixel",
                              ImGuiSliderFlags_AlwaysClamp);
    e.mark("render.samples");
    form_row("Longest path",
             "How often light is followed from surface to surface; glass and bright rooms need more (maximum depth)");
    changed |= ImGui::SliderInt("##depth", &depth, 0, 100, "%d bounces", ImGuiSliderFlags_AlwaysClamp);
    e.mark("render.depth");
    form_row("End dim paths",
             "Ends paths that carry little light at random, and compensates: faster, unbiased (Russian roulette)");
    changed |= ImGui::Checkbox("##roulette", &settings.russian_roulette);
    e.mark("render.roulette");
    form_row(
        "Wavelengths",
        "Traces four wavelengths a path instead of RGB: saturated colours and measured metals are exact, and glass "
        "with measured indices splits light (spectral rendering)");
    changed |= ImGui::Checkbox("##spectral", &settings.spectral);
    e.mark("render.spectral");
    form_row("Adaptive",
             "Gives noisy parts of the picture more samples than others: Samples is their mean (adaptive sampling, "
             "unbiased)");
    changed |= ImGui::Checkbox("##adaptive", &settings.adaptive);
    e.mark("render.adaptive");
    const auto technique_row = [&](const char* label, const char* tooltip, scene::Technique& t, const char* mark) {
        static constexpr std::array labels{"Automatic", "On", "Off"};
        form_row(label, tooltip);
        const std::string name = mark + 2; // without the ##
        const bool open = ImGui::BeginCombo(mark, labels[std::size_t(t)]);
        e.mark(name);
        if (!open) return;
        for (std::size_t i = 0; i < labels.size(); ++i) {
            const auto choice = scene::Technique(i);
            if (ImGui::Selectable(labels[i], choice == t) && choice != t) {
                t = choice;
                changed = true;
            }
            e.mark(name + "." + scene::technique_names[i]);
        }
        ImGui::EndCombo();
    };
    technique_row("Guiding",
                  "Learns where light comes from and sends paths there: less noise behind half-open doors and in the "
                  "light of windows, but more elsewhere. Automatic: off, as yet",
                  settings.guiding, "##render.guiding");
    technique_row("Caustics",
                  "Light that lamps and the sun send through glass or off mirrors, by photon maps: slightly blurred, "
                  "sharper with every sample (biased). Automatic: where the scene has any",
                  settings.caustics, "##render.caustics");
    const auto clamp_row = [&](const char* label, const char* tooltip, float& v, const char* mark) {
        form_row(label, tooltip);
        changed |= ImGui::DragFloat(mark, &v, drag_speed(v, 0.01f), 0, 1e6f, v > 0 ? "%.3g (biased)" : "Off",
                                    ImGuiSliderFlags_AlwaysClamp);
        e.mark(mark + 2); // without the ##
    };
    clamp_row("Limit direct",
              "Removes bright specks of light directly from a lamp, and some light with them: the picture gets "
              "too dark there (clamping, biased). 0 = off",
              settings.clamp_direct, "##render.clamp_direct");
    clamp_row("Limit indirect",
              "Removes bright specks of reflected light, and some light with them (clamping of fireflies, "
              "biased). 0 = off",
              settings.clamp_indirect, "##render.clamp_indirect");
    form_row("Ray offset",
             "Distance of ray origins from a surface. 0 = from the rounding error of each hit, which is right almost "
             "always; else a distance in scene units");
    changed |= ImGui::DragFloat("##epsilon", &settings.ray_epsilon, drag_speed(settings.ray_epsilon, 1e-6f), 0, 1,
                                settings.ray_epsilon > 0 ? "%.2g units" : "Automatic", ImGuiSliderFlags_AlwaysClamp);
    e.mark("render.epsilon");
    form_row("Reference", "Turns off everything biased: caustics by photon maps, both limits, and the ray offset");
    ImGui::BeginDisabled(scene::for_reference(settings) == settings);
    if (ImGui::Button("Unbiased")) {
        settings = scene::for_reference(std::move(settings));
        changed = true;
    }
    ImGui::EndDisabled();
    e.mark("render.reference");
    settings.samples = std::uint32_t(samples);
    settings.max_depth = std::uint32_t(depth);
    if (changed)
        e.edit(
            [settings](const scene::Scene& s) {
                return Result<scene::Edit>(scene::set_settings(s, settings, "Change rendering"));
            },
            "scene.settings");
}

// Loaded denoisers by name; the choice persists.
void denoiser_row(EditContext& e, PictureView& picture) {
    const auto denoisers = e.registry().denoisers();
    const std::string& now = e.preferences.denoiser;
    std::string shown = now.empty() ? "Built-in" : now + " (not loaded)";
    for (const plugin::DenoiserEntry& entry : denoisers)
        if (now == entry.table->type || now == entry.plugin->manifest.id) shown = entry.table->label;
    form_row("Denoiser", "The denoiser for live and final pictures; stored for all scenes");
    const bool open = ImGui::BeginCombo("##denoiser", shown.c_str());
    e.mark("render.denoiser");
    if (!open) return;
    const auto choice = [&](const char* label, const std::string& name) {
        if (ImGui::Selectable(label, now == name))
            e.later([&e, &picture, name] {
                e.preferences.denoiser = name;
                picture.live().denoise_by(name);
            });
        e.mark("render.denoiser." + name);
    };
    choice("Built-in", "");
    for (const plugin::DenoiserEntry& entry : denoisers)
        choice(entry.table->label.c_str(), entry.table->type.c_str());
    ImGui::EndCombo();
}

void live_rows(EditContext& e, PictureView& picture) {
    ImGui::SeparatorText("Live picture");
    form_row("Denoise", "Shows the picture without its noise");
    ImGui::BeginDisabled(!picture.live().denoiser_missing().empty());
    ImGui::Checkbox("##denoise", &picture.view.denoise);
    ImGui::EndDisabled();
    if (!picture.live().denoiser_missing().empty()) tip(picture.live().denoiser_missing().c_str());
    e.mark("render.denoise");
    denoiser_row(e, picture);
    int samples = int(picture.view.samples);
    form_row("Stop at samples", "Of the live picture. 0 = at the scene's number of samples");
    if (ImGui::DragInt("##live samples", &samples, 1, 0, 1 << 20, samples ? "%d a pixel" : "As above",
                       ImGuiSliderFlags_AlwaysClamp))
        picture.view.samples = std::uint32_t(samples);
    e.mark("render.live_samples");
    auto seconds = float(picture.view.seconds), error = float(picture.view.error * 100);
    form_row("Stop after", "Time for each picture. 0 = no limit");
    if (ImGui::DragFloat("##seconds", &seconds, 0.5f, 0, 86400, seconds > 0 ? "%.0f s" : "No limit",
                         ImGuiSliderFlags_AlwaysClamp))
        picture.view.seconds = double(seconds);
    e.mark("render.seconds");
    form_row("Stop at error", "Stop at this noise: the estimated relative error before denoising. 0 = no target");
    if (ImGui::DragFloat("##error", &error, 0.02f, 0, 100, error > 0 ? "%.2f %%" : "No target",
                         ImGuiSliderFlags_AlwaysClamp))
        picture.view.error = double(error) / 100;
    e.mark("render.error");
    form_row("Resolution", "Pixels of the live picture per screen pixel: less is faster and coarser");
    ImGui::SliderFloat("##resolution", &picture.view.resolution, 0.1f, 2, "%.2f×", ImGuiSliderFlags_AlwaysClamp);
    e.mark("render.resolution");
}

void machine_rows(EditContext& e, PictureView& picture) {
    ImGui::SeparatorText("This machine");
    const view::ViewStatus status = picture.live().status();
    render::RendererOptions options = e.options().renderer;
    SceneState& state = e.panel_state->scene;
    std::vector<const char*> labels{"Automatic"};
    std::string help;
    int tracer = 0;
    for (const render::TracerKind& kind : render::tracer_kinds()) {
        if (kind.name == options.tracer) tracer = int(labels.size());
        labels.push_back(kind.label);
        help += fmt::format("{}{}: {}", help.empty() ? "" : ". ", kind.label, kind.says);
    }
    form_row("Ray tracing", help.c_str());
    if (ImGui::Combo("##tracer", &tracer, labels.data(), int(labels.size()))) {
        options.tracer = tracer > 0 ? render::tracer_kinds()[std::size_t(tracer - 1)].name : "";
        e.later([&picture, options] { picture.configure_renderer(options); });
    }
    if (!status.tracer.empty()) tip(("In use: " + status.tracer).c_str());
    e.mark("render.tracer");
    form_row("Graphics card", "Its number or part of its name, as Vulkan lists them; empty = the best one");
    if (!std::exchange(state.device_shown, true)) state.device = options.device;
    ImGui::InputTextWithHint("##device", status.device.empty() ? "The best" : status.device.c_str(), &state.device);
    if (ImGui::IsItemDeactivatedAfterEdit() && state.device != options.device) {
        options.device = state.device;
        e.later([&picture, options] { picture.configure_renderer(options); });
    }
    e.mark("render.device");
    int threads = int(options.threads);
    const int most = int(Jobs::hardware());
    form_row("Threads", "Processor threads that trace rays. 0 = all");
    ImGui::SliderInt("##threads", &state.threads, 0, most, state.threads ? "%d" : fmt::format("All {}", most).c_str(),
                     ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemDeactivatedAfterEdit() && state.threads != threads) { // reopens the renderer: not during a drag
        options.threads = unsigned(state.threads);
        e.later([&picture, options] { picture.configure_renderer(options); });
    } else if (!ImGui::IsItemActive()) {
        state.threads = threads;
    }
    e.mark("render.threads");
    if (status.gpu_bytes) {
        form_row("Memory", "Memory of the scene on the graphics card, or in main memory if the CPU replaces it");
        ImGui::TextDisabled("%.0f MiB", double(status.gpu_bytes) / 1048576);
    }
    for (const auto& [type, count] : status.not_finite)
        warning_note(fmt::format("{} samples of {} were non-finite and were dropped.", count, type).c_str());
}

} // namespace

void render_section(EditContext& e, PictureView& picture) {
    const bool open = section_header("Rendering");
    e.mark("scene.render");
    if (!open) return;
    ImGui::PushID("render");
    scene_rows(e);
    live_rows(e, picture);
    machine_rows(e, picture);
    ImGui::PopID();
}

} // namespace restage::editor
