// SPDX-License-Identifier: Apache-2.0
// Writing files other than the project: exports through the exporter plugins, and the live picture as an image.
#include "background.hpp"
#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "saving.hpp"
#include "scene/development.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "view/picture.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// One option of an exporter's table.
void option_widget(PanelContext& e, const model::Param& line, scene::ParamSet& values) {
    const scene::Value* set = values.find(line.id);
    scene::Value v = set ? *set : scene::default_value(line);
    bool changed = false;
    ImGui::PushID(line.id.c_str());
    form_row(line.label.c_str(), line.tooltip.c_str());
    switch (line.type) {
        case model::ParamType::boolean: {
            bool on = v.i != 0;
            changed = ImGui::Checkbox("##value", &on);
            v.i = on;
            break;
        }
        case model::ParamType::number:
            changed =
                ImGui::DragFloat("##value", &v.v[0], 0.01f, line.min, line.max, "%.4g", ImGuiSliderFlags_AlwaysClamp);
            break;
        case model::ParamType::integer:
            changed =
                ImGui::DragInt("##value", &v.i, 1.f, line.int_min, line.int_max, "%d", ImGuiSliderFlags_AlwaysClamp);
            break;
        case model::ParamType::color:
            changed = ImGui::ColorEdit3("##value", v.v.data(), ImGuiColorEditFlags_Float);
            break;
        case model::ParamType::choice:
            if (ImGui::BeginCombo("##value", choice_label(v.text).c_str())) {
                for (const std::string& choice : line.choices) {
                    if (ImGui::Selectable(choice_label(choice).c_str(), choice == v.text)) {
                        v.text = choice;
                        changed = true;
                    }
                    e.mark(fmt::format("export.{}.{}", line.id, choice));
                }
                ImGui::EndCombo();
            }
            break;
        case model::ParamType::text:
            changed = ImGui::InputText("##value", &v.text);
            break;
        case model::ParamType::material:
        case model::ParamType::texture:
        case model::ParamType::table:
            break; // not possible for an option
    }
    e.mark(std::string("export.") + line.id);
    tip(line.tooltip.c_str());
    ImGui::PopID();
    if (changed) values.set(line.id, std::move(v));
}

void show_report(PanelContext& e, const fs::path& path, io::Report report) {
    e.notices.add(LogLevel::info, "Exported " + path.filename().string());
    for (const io::ReportEntry& entry : report.entries)
        if (entry.fate != io::Fate::kept) e.notices.add(LogLevel::warning, io::to_string(entry));
    e.show_modal("Exported", [path, report = std::move(report)](PanelContext& editor) {
        dialog_width(560);
        ImGui::TextWrapped("%s is written.", path.string().c_str());
        ImGui::Text("%zu kept, %zu approximated, %zu dropped", report.count(io::Fate::kept),
                    report.count(io::Fate::approximated), report.count(io::Fate::dropped));
        const float scale = ImGui::GetStyle().FontScaleMain;
        if (report.count(io::Fate::approximated) + report.count(io::Fate::dropped) > 0) {
            ImGui::BeginChild("report", {0, 240 * scale}, ImGuiChildFlags_Borders);
            for (const io::ReportEntry& entry : report.entries) {
                if (entry.fate == io::Fate::kept) continue;
                ImGui::TextColored(entry.fate == io::Fate::dropped ? colors::error : colors::warning, "%s",
                                   io::to_string(entry.fate));
                ImGui::SameLine();
                ImGui::TextWrapped("%s: %s", entry.what.c_str(), entry.note.c_str());
            }
            ImGui::EndChild();
        }
        const bool close = ImGui::Button("Close") || ImGui::IsKeyPressed(ImGuiKey_Escape, false) ||
                           ImGui::IsKeyPressed(ImGuiKey_Enter, false);
        editor.mark("exported.close");
        return !close;
    });
}

void start_export(PanelContext& e, const fs::path& path, io::ExportOptions options) {
    e.files().jobs.start(
        {.title = "Exporting " + path.filename().string()},
        [path, scene = e.scene(), &registry = e.registry(),
         options = std::move(options)](BackgroundJob& job) mutable -> std::function<void(PanelContext&)> {
            options.progress = [&job](float done, std::string_view what) { return job.report(double(done), what); };
            auto report = io::export_scene(scene, path.string(), registry, options);
            if (!report)
                return [message = report.error().message, path, options](PanelContext& editor) {
                    show_failure(editor, {.title = "Not exported",
                                          .reason = message,
                                          .again = [&editor, path, options] { start_export(editor, path, options); },
                                          .elsewhere = [&editor] { export_dialog(editor); }});
                };
            return [path, report = std::move(*report)](PanelContext& editor) { show_report(editor, path, report); };
        });
}

// The live picture, as traced and, if there is a denoised one of the same film, denoised.
std::optional<view::Picture> live_picture(const PanelContext& e) {
    const auto raw = e.live().frame(), clean = e.live().denoised();
    if (!raw || raw->document != e.document()) return std::nullopt;
    const scene::Film& film = e.scene().film.value;
    view::Picture picture{.film = raw->image,
                          .denoised = std::nullopt,
                          .exposure = film.exposure,
                          .development = scene::development_of(e.scene())};
    if (clean && clean->request == raw->request && clean->image.width == raw->image.width &&
        clean->image.height == raw->image.height)
        picture.denoised = clean->image.color;
    return picture;
}

// The picture on screen, eight bits per channel.
Result<void> write_as_seen(const fs::path& path, const render::FilmImage& image, const view::DisplaySettings& settings,
                           const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> rgba;
    view::to_display(image, settings, rgba, counts);
    return view::write_rgba(path.string(), image.width, image.height, rgba);
}

} // namespace

// The exporter of the format that was opened; else the first whose files can be opened again.
static std::size_t usual_exporter(const plugin::Registry& registry, const std::string& opened) {
    const auto& exporters = registry.exporters();
    const auto of = [&](const std::string& format) {
        return std::size_t(std::ranges::find_if(exporters, [&](const auto& x) { return x.table->format == format; }) -
                           exporters.begin());
    };
    if (const std::size_t i = of(opened); i < exporters.size()) return i;
    for (const auto& importer : registry.importers())
        if (const std::size_t i = of(importer.table->format); i < exporters.size()) return i;
    return 0;
}

void export_dialog(PanelContext& e) {
    struct State {
        std::size_t exporter = 0;
        scene::ParamSet values;
    };
    if (e.registry().exporters().empty()) {
        e.notices.add(LogLevel::error, "No exporter plugin is loaded: see Plugins");
        return;
    }
    const auto state = std::make_shared<State>();
    state->exporter = usual_exporter(e.registry(), e.session().base().format);
    e.show_modal("Export", [state](PanelContext& editor) {
        const auto& exporters = editor.registry().exporters();
        const model::Exporter& exporter = *exporters[state->exporter].table;
        dialog_width(360);
        form_row("Format", "The file's format, from the loaded exporter plugins");
        if (ImGui::BeginCombo("##format", exporter.label.c_str())) {
            for (std::size_t i = 0; i < exporters.size(); ++i)
                if (ImGui::Selectable(exporters[i].table->label.c_str(), i == state->exporter)) {
                    state->exporter = i;
                    state->values = {};
                }
            ImGui::EndCombo();
        }
        editor.mark("export.format");
        for (const model::Param& option : exporter.options)
            option_widget(editor, option, state->values);
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Choose where...")) {
            stay = false;
            const fs::path path(editor.session().path());
            io::ExportOptions options{.progress = {}, .format = exporter.format, .values = state->values};
            const std::string extension = "." + exporter.extensions[0];
            browse(editor,
                   {.title = "Export as",
                    .save = true,
                    .filters = {{exporter.label, exporter.extensions}, {"All files", {}}},
                    .start = path.empty() ? fs::path() : path.parent_path(),
                    .name = (path.empty() ? "untitled" : path.stem().string() + " edited") + extension,
                    .extension = extension,
                    .done = [options](PanelContext& ed, const fs::path& place) { start_export(ed, place, options); }});
        }
        editor.mark("export.choose");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("export.cancel");
        return stay;
    });
}

void save_image_dialog(PanelContext& e) {
    struct State {
        int format = 0;
        bool denoised = true, as_seen = true;
    };
    auto state = std::make_shared<State>();
    state->denoised = e.view.denoise;
    e.show_modal("Save picture", [state](PanelContext& editor) {
        static constexpr const char* formats[] = {"PNG", "EXR", "HDR"};
        static constexpr const char* extensions[] = {".png", ".exr", ".hdr"};
        const auto picture = editor.live().frame();
        if (!picture || picture->document != editor.document())
            ImGui::TextUnformatted("There is no picture yet.");
        else
            ImGui::Text("The current live picture: %u × %u, %u samples per pixel", picture->image.width,
                        picture->image.height, picture->image.samples);
        for (int i = 0; i < 3; ++i) {
            if (i) ImGui::SameLine();
            ImGui::RadioButton(formats[i], &state->format, i);
            editor.mark(fmt::format("image.{}", formats[i]));
        }
        if (state->format == 0) {
            ImGui::Checkbox("As seen", &state->as_seen);
            tip("With the exposure and layer of the view. Off: the picture at the scene's own exposure");
        }
        ImGui::Checkbox("Denoised", &state->denoised);
        tip(state->format == 1 ? "The raw picture is an additional layer" : "Off: noisy");
        editor.mark("image.denoised");
        ImGui::Spacing();
        bool stay = true;
        ImGui::BeginDisabled(!picture);
        if (ImGui::Button("Choose where...")) {
            stay = false;
            const fs::path path(editor.session().path());
            const std::string extension = extensions[state->format];
            const fs::path& last = editor.files().last_picture;
            browse(editor, {.title = "Save picture as",
                            .save = true,
                            .filters = {{formats[state->format], {extension.substr(1)}}, {"All files", {}}},
                            .start = !last.empty()  ? last.parent_path()
                                     : path.empty() ? fs::path()
                                                    : path.parent_path(),
                            .name = (path.empty() ? "untitled" : path.stem().string()) + extension,
                            .extension = extension,
                            .done = [state](PanelContext& ed, const fs::path& place) {
                                auto shot = live_picture(ed);
                                if (!shot) return;
                                if (!state->denoised) shot->denoised.reset();
                                view::DisplaySettings settings = ed.view.display;
                                settings.scale = shot->exposure;
                                settings.development = shot->development;
                                const bool seen = state->as_seen && place.extension() == ".png";
                                if (seen && shot->denoised &&
                                    (settings.layer == view::picture_layer || settings.layer == view::exposure_layer))
                                    shot->film.color = *shot->denoised;
                                const auto shown = ed.shown_frame();
                                if (seen && shown && shown->look) shot->film = shown->image;
                                ed.files().last_picture = place;
                                ed.files().jobs.start(
                                    {.title = "Writing " + place.filename().string()},
                                    [place, shot = std::move(*shot), settings, counts = ed.live().frame()->counts,
                                     seen](BackgroundJob&) -> std::function<void(PanelContext&)> {
                                        auto written = view::check_picture_path(place.string());
                                        if (written && seen)
                                            written = write_as_seen(place, shot.film, settings, counts);
                                        else if (written)
                                            written = view::write_picture(place.string(), shot, {});
                                        const std::string message =
                                            written ? "Written: " + place.string() : written.error().message;
                                        return [message, good = written.has_value()](PanelContext& x) {
                                            if (good)
                                                x.notices.add(LogLevel::info, message);
                                            else
                                                show_failure(x, {.title = "Not written",
                                                                 .reason = message,
                                                                 .again = [&x] { save_image_dialog(x); },
                                                                 .elsewhere = [&x] { save_image_dialog(x); }});
                                        };
                                    });
                            }});
        }
        editor.mark("image.choose");
        ImGui::EndDisabled();
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("image.cancel");
        return stay;
    });
}

} // namespace restage::editor
