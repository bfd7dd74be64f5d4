// SPDX-License-Identifier: Apache-2.0
// Final pictures: the scene at its film's full size, or each of its looks and cameras, by a separate renderer in the
// background.
#include "base/version.hpp"
#include "document/looks.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "looks.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "render/denoise.hpp"
#include "render/film_error.hpp"
#include "render/renderer.hpp"
#include "saving.hpp"
#include "scene/development.hpp"
#include "scene/edits.hpp"
#include "view/picture.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

struct Wish {
    std::uint32_t samples = 64;
    float error = 0; // > 0: stop at this error, or at `samples`
    bool from_view = true; // instead of the scene's camera, if they differ
    bool denoise = true;
    bool all_looks = false, all_cameras = false; // each is a picture, and its name a part of the file's
    std::string denoiser; // as in Preferences
    fs::path path;
};

struct Shot { // a picture of a batch
    scene::Scene scene;
    std::string name; // "Oak, Camera 2"; "" = there is only this one
    fs::path path;
};

// The part of a job that is one of its pictures.
class Part {
  public:
    Part(BackgroundJob& job, std::size_t index, std::size_t count, const std::string& name)
        : job_(job),
          from_(double(index) / double(count)),
          share_(1 / double(count)),
          before_(name.empty() ? "" : fmt::format("{} of {}, {}: ", index + 1, count, name)) {}
    bool report(double done, const std::string& stage) { return job_.report(from_ + done * share_, before_ + stage); }
    bool cancelled() const { return job_.cancelled(); }
    bool stopping() const { return job_.stopping(); }
    void keep_result() { job_.keep_result(); }

  private:
    BackgroundJob& job_;
    double from_, share_;
    std::string before_;
};

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

using Done = std::function<void(PanelContext&)>;
Done say(LogLevel level, std::string text) {
    return [level, text = std::move(text)](PanelContext& e) { e.notices.add(level, text); };
}

struct Finished {
    view::Picture picture;
    view::PictureOptions how;
    std::string text; // what was done
};

// If it cannot be written it is kept until the user saves it elsewhere or discards it: it may have taken hours.
Done write(std::shared_ptr<const Finished> done, const fs::path& path) {
    const auto written = view::write_picture(path.string(), done->picture, done->how);
    if (written) return say(LogLevel::info, path.string() + ": " + done->text);
    return [done, path, reason = written.error().message](PanelContext& e) {
        show_failure(e, {.title = "The final picture was not written",
                         .reason = reason,
                         .again = [&e, done, path] { write(done, path)(e); },
                         .elsewhere =
                             [&e, done, path] {
                                 browse(e, {.title = "Final picture as",
                                            .save = true,
                                            .filters = {{"Pictures", {"exr", "png", "hdr", "pfm"}}, {"All files", {}}},
                                            .start = path.parent_path(),
                                            .name = path.filename().string(),
                                            .extension = ".exr",
                                            .done = [done](PanelContext& again, const fs::path& place) {
                                                again.files().last_picture = place;
                                                write(done, place)(again);
                                            }});
                             }});
    };
}

using RendererPointer = std::unique_ptr<render::Renderer>;

// `renderer`: made for the first picture.
Result<Done> render(Part job, const plugin::Registry& registry, Log& log, render::RendererOptions options,
                    RendererPointer& renderer, const Shot& shot, const Wish& wish, const std::string& scene_name) {
    const scene::Scene& scene = shot.scene;
    RESTAGE_CHECK(view::check_picture_path(shot.path.string()));
    job.report(0, "opening the renderer");
    options.stand_ins = false;
    if (!renderer) {
        RESTAGE_TRY(renderer, render::Renderer::create(options, render::material_lookup(registry), log));
    }
    renderer->forget_scene(); // looks of one document have the same versions
    renderer->reset_stats();
    renderer->restart(options.seed, 0);
    job.report(0, "preparing shaders and acceleration structures");
    bool revived = false;
    renderer->plan(wish.samples);
    RESTAGE_CHECK(renderer->or_revive(renderer->sync(scene), scene, revived));
    // Denoising is a small part at the end of the bar.
    const bool denoise = wish.denoise && !registry.denoisers().empty();
    const double traced = denoise ? 0.97 : 1.0, start = now_seconds();
    std::uint32_t batch = 1;
    double error = 0; // when looked at last
    while (renderer->samples() < wish.samples && !job.stopping()) {
        const double before = now_seconds();
        batch = std::min(batch, wish.samples - renderer->samples());
        if (wish.error > 0) batch = std::min(batch, render::next_look(renderer->samples()) - renderer->samples());
        RESTAGE_CHECK(renderer->or_revive(renderer->trace(batch, [&] { return !job.stopping(); }), scene, revived));
        double done = double(renderer->samples()) / wish.samples;
        std::string stage = fmt::format("{} of {} samples per pixel", renderer->samples(), wish.samples);
        if (wish.error > 0 && render::is_look(renderer->samples())) {
            error = renderer->relative_error();
            if (error <= double(wish.error)) break;
        }
        if (error > 0) {
            stage += fmt::format(", {:.2f} % error", error * 100);
            done = std::max(done, std::pow(double(wish.error) / error, 2.0));
        }
        if (!job.report(done * traced, stage)) break;
        // Batches of about 0.2 s, so that a stop is quick and the bar moves.
        batch = std::uint32_t(std::clamp(0.2 / std::max((now_seconds() - before) / batch, 1e-6), 1.0, 1024.0));
    }
    if (job.cancelled() || renderer->samples() == 0) return say(LogLevel::info, "The final picture was cancelled");
    auto finished = std::make_shared<Finished>();
    view::Picture& picture = finished->picture;
    const scene::Film& film = scene.film.value;
    picture = {.film = renderer->image(),
               .denoised = std::nullopt,
               .exposure = film.exposure,
               .development = scene::development_of(scene),
               .window = film.crop};
    std::string denoiser = "none";
    if (denoise) {
        job.keep_result(); // the render may have taken hours
        job.report(traced, "denoising");
        const auto clean = [&]() -> Result<void> {
            RESTAGE_TRY(const auto chosen, render::choose_denoiser(registry, wish.denoiser));
            denoiser = render::denoiser_label(chosen, plugin::DenoiseQuality::high);
            RESTAGE_TRY(picture.denoised, render::denoise(picture.film, chosen, plugin::DenoiseQuality::high,
                                                          options.threads, [&](double done) {
                                                              job.report(traced + done * (1 - traced), "denoising");
                                                              return !job.cancelled();
                                                          }));
            return {};
        };
        const auto cleaned = clean();
        if (!cleaned) { // the rendered part is kept nevertheless
            denoiser = "none";
            if (cleaned.error().cancelled())
                finished->text = "denoising was cancelled: written without it; ";
            else
                log.error("the final picture is not denoised: " + cleaned.error().message);
        }
    }
    const auto& stats = renderer->stats();
    finished->how = {.metadata = {{"restage:version", version()},
                                  {"restage:scene", scene_name},
                                  {"restage:device", renderer->device().info().name},
                                  {"restage:tracer", renderer->tracer_name()},
                                  {"restage:samples", std::to_string(renderer->samples())},
                                  {"restage:seed", std::to_string(options.seed)},
                                  {"restage:max_depth", std::to_string(scene.settings.value.max_depth)},
                                  {"restage:denoiser", denoiser}}};
    for (const auto& [type, count] : stats.not_finite)
        log.warning(fmt::format("{} samples of material type \"{}\" were non-finite and were omitted", count, type));
    finished->text += fmt::format("{}x{}, {} samples per pixel in {:.1f} s", picture.film.width, picture.film.height,
                                  renderer->samples(), now_seconds() - start);
    return write(finished, shot.path);
}

// "kitchen.png" -> "kitchen - Oak - Camera 2.png"
fs::path shot_path(const fs::path& path, const std::vector<std::string>& names) {
    std::string stem = path.stem().string();
    for (std::string name : names) {
        for (char& c : name)
            if (std::string_view("/\\:*?\"<>|").find(c) != std::string_view::npos) c = '_';
        stem += " - " + name;
    }
    return path.parent_path() / (stem + path.extension().string());
}

std::vector<Shot> shots(const PanelContext& e, const Wish& wish) {
    std::vector<std::pair<std::string, scene::Scene>> scenes;
    if (wish.all_looks)
        for (const document::Look& look : e.session().looks().list)
            scenes.emplace_back(look.name, document::with_look(e.scene(), look));
    else
        scenes.emplace_back("", wish.from_view ? scene_as_seen(e) : e.scene());
    std::vector<Shot> list;
    for (const auto& variant : scenes) {
        const std::string& look = variant.first;
        const scene::Scene& scene = variant.second;
        std::vector<std::string> names;
        if (!look.empty()) names.push_back(look);
        if (!wish.all_cameras) {
            list.push_back({scene, look, shot_path(wish.path, names)});
            continue;
        }
        std::set<std::string> taken; // cameras of a file may have equal names
        names.emplace_back();
        scene.cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& camera) {
            names.back() = taken.contains(camera.name) ? scene::next_name(camera.name, taken) : camera.name;
            taken.insert(names.back());
            scene::Scene from = scene;
            from.active_camera = {id, ++from.clock};
            list.push_back({std::move(from), fmt::format("{}", fmt::join(names, ", ")), shot_path(wish.path, names)});
        });
    }
    return list;
}

void start(PanelContext& e, const Wish& wish) {
    e.files().last_picture = wish.path;
    const fs::path path(e.session().path());
    std::vector<Shot> list = shots(e, wish);
    const bool one = list.size() == 1;
    const std::string title =
        one ? "Final picture " + list[0].path.filename().string() : fmt::format("{} final pictures", list.size());
    e.files().jobs.start({.title = title, .can_finish_early = one, .pauses_picture = true},
                         [wish, list = std::move(list), &registry = e.registry(), &log = e.log(),
                          options = e.options().renderer, name = path.filename().string()](BackgroundJob& job) -> Done {
                             RendererPointer renderer;
                             std::vector<Done> all;
                             for (std::size_t i = 0; i < list.size() && !job.cancelled(); ++i) {
                                 const std::string& called = list.size() > 1 ? list[i].name : "";
                                 auto done = render(Part(job, i, list.size(), called), registry, log, options, renderer,
                                                    list[i], wish, name);
                                 all.push_back(done ? std::move(*done) : say(LogLevel::error, done.error().message));
                             }
                             return [all = std::move(all)](PanelContext& editor) {
                                 for (const Done& done : all)
                                     done(editor);
                             };
                         });
}

} // namespace

void final_render_dialog(PanelContext& e) {
    auto wish = std::make_shared<Wish>();
    wish->samples = std::max(e.scene().settings.value.samples, 1u);
    wish->denoise = !e.registry().denoisers().empty();
    wish->denoiser = e.preferences.denoiser;
    e.show_modal("Final picture", [wish](PanelContext& editor) {
        const scene::Film& film = editor.scene().film.value;
        dialog_width(360);
        form_row("Size", "The picture's size: change it in the Scene panel, under Picture");
        ImGui::Text("%u × %u pixels", film.width, film.height);
        if (editor.views.now()) {
            form_row("From", "The viewpoint: the current view, or the scene's camera");
            if (ImGui::RadioButton("View", wish->from_view)) wish->from_view = true;
            editor.mark("final.view");
            ImGui::SameLine();
            if (ImGui::RadioButton("Camera", !wish->from_view)) wish->from_view = false;
            editor.mark("final.camera");
        }
        const std::size_t looks = editor.session().looks().list.size(), cameras = editor.scene().cameras.live();
        if (looks > 0) {
            form_row("Every look", "One picture of each look, with its name in the file's");
            ImGui::Checkbox("##looks", &wish->all_looks);
            editor.mark("final.looks");
        }
        if (cameras > 1) {
            form_row("Every camera", "One picture from each camera and bookmark, with its name in the file's");
            ImGui::Checkbox("##cameras", &wish->all_cameras);
            editor.mark("final.cameras");
        }
        int samples = int(wish->samples);
        form_row("Samples", "Light paths per pixel: twice as many take twice the time and leave 0.7 of the noise");
        if (ImGui::DragInt("##samples", &samples, 1, 1, 1 << 20, "%d a pixel", ImGuiSliderFlags_AlwaysClamp))
            wish->samples = std::uint32_t(samples);
        editor.mark("final.samples");
        float percent = wish->error * 100;
        form_row("Stop at error", "Stop at this noise: the estimated relative error before denoising. 0 = no target");
        if (ImGui::DragFloat("##error", &percent, 0.05f, 0, 100, percent > 0 ? "%.2f %%" : "No target"))
            wish->error = percent / 100;
        editor.mark("final.error");
        form_row("Denoise", "Removes the remaining noise, in high quality; in an EXR the raw picture is kept as well");
        ImGui::BeginDisabled(editor.registry().denoisers().empty());
        ImGui::Checkbox("##denoise", &wish->denoise);
        editor.mark("final.denoise");
        ImGui::EndDisabled();
        empty_note("It renders in the background while you continue editing; the live picture is paused meanwhile.");
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Choose where...")) {
            stay = false;
            const fs::path path(editor.session().path());
            const fs::path& last = editor.files().last_picture;
            browse(editor, {.title = "Final picture as",
                            .save = true,
                            .filters = {{"Pictures", {"exr", "png", "hdr", "pfm"}}, {"All files", {}}},
                            .start = !last.empty()  ? last.parent_path()
                                     : path.empty() ? fs::path()
                                                    : path.parent_path(),
                            .name = (path.empty() ? "untitled" : path.stem().string()) + ".exr",
                            .extension = ".exr",
                            .done = [wish](PanelContext& ed, const fs::path& place) {
                                wish->path = place;
                                start(ed, *wish);
                            }});
        }
        editor.mark("final.choose");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("final.cancel");
        return stay;
    });
}

} // namespace restage::editor
