// SPDX-License-Identifier: Apache-2.0
// Renders final pictures: each shot by one renderer, on the thread of a background job.
#include "base/version.hpp"
#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "final_batch.hpp"
#include "final_pictures.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "query/camera_path.hpp"
#include "render/denoise.hpp"
#include "render/film_error.hpp"
#include "render/renderer.hpp"
#include "saving.hpp"
#include "scene/development.hpp"
#include "view/picture.hpp"
#include "view/video.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// What a picture reports to: its part of its shot, which is a part of the batch.
class Progress {
  public:
    Progress(BackgroundJob& job, FinalBatch& batch, std::string name)
        : job_(job), batch_(batch), name_(std::move(name)) {}
    void frame(std::size_t index, std::size_t count) {
        from_ = double(index) / double(count);
        share_ = 1 / double(count);
        before_ = name_ + (count > 1 ? fmt::format("{} of {}: ", index + 1, count) : "");
    }
    bool report(double done, const std::string& stage) {
        batch_.report(from_ + done * share_);
        return job_.report(batch_.done(), before_ + stage) && !stopping();
    }
    bool cancelled() const { return job_.cancelled() || batch_.cancelled(); }
    bool stopping() const { return job_.stopping() || cancelled() || batch_.enough(); }
    void keep_result() { job_.keep_result(); }
    void wait_while_paused() {
        job_.wait_while_paused([this] { return stopping(); });
    }

  private:
    BackgroundJob& job_;
    FinalBatch& batch_;
    std::string name_, before_;
    double from_ = 0, share_ = 1;
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

struct Renders { // what all pictures are rendered with
    const plugin::Registry& registry;
    Log& log;
    render::RendererOptions options;
    std::string scene; // name of its file
};

// Null if it was cancelled. `renderer`: made for the first picture.
Result<std::shared_ptr<Finished>> render(Progress& job, const Renders& with, RendererPointer& renderer,
                                         const scene::Scene& scene, const FinalWish& wish) {
    render::RendererOptions options = with.options;
    job.report(0, "opening the renderer");
    options.stand_ins = false;
    if (!renderer) {
        RESTAGE_TRY(renderer, render::Renderer::create(options, render::material_lookup(with.registry), with.log));
    }
    renderer->forget_scene(); // looks of one document have the same versions
    renderer->reset_stats();
    renderer->restart(options.seed, 0);
    job.report(0, "preparing shaders and acceleration structures");
    bool revived = false;
    renderer->plan(wish.samples);
    RESTAGE_CHECK(renderer->or_revive(renderer->sync(scene), scene, revived));
    // Denoising is a small part at the end of the bar.
    const bool denoise = wish.denoise && !with.registry.denoisers().empty();
    const double traced = denoise ? 0.97 : 1.0, start = now_seconds();
    std::uint32_t batch = 1;
    double error = 0; // when looked at last
    while (renderer->samples() < wish.samples && !job.stopping()) {
        job.wait_while_paused();
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
    if (job.cancelled() || renderer->samples() == 0) return std::shared_ptr<Finished>();
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
            RESTAGE_TRY(const auto chosen, render::choose_denoiser(with.registry, wish.denoiser));
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
                with.log.error("the final picture is not denoised: " + cleaned.error().message);
        }
    }
    const auto& stats = renderer->stats();
    finished->how = {.metadata = {{"restage:version", version()},
                                  {"restage:scene", with.scene},
                                  {"restage:device", renderer->device().info().name},
                                  {"restage:tracer", renderer->tracer_name()},
                                  {"restage:samples", std::to_string(renderer->samples())},
                                  {"restage:seed", std::to_string(options.seed)},
                                  {"restage:max_depth", std::to_string(scene.settings.value.max_depth)},
                                  {"restage:denoiser", denoiser}}};
    for (const auto& [type, count] : stats.not_finite)
        with.log.warning(
            fmt::format("{} samples of material type \"{}\" were non-finite and were omitted", count, type));
    finished->text += fmt::format("{}x{}, {} samples per pixel in {:.1f} s", picture.film.width, picture.film.height,
                                  renderer->samples(), now_seconds() - start);
    return finished;
}

// All pictures of a camera's move, and the video of them.
Result<Done> render_move(Progress& job, const Renders& with, RendererPointer& renderer, const Shot& shot,
                         const FinalWish& wish) {
    std::optional<view::VideoFrames> video;
    if (view::is_video_path(shot.path)) {
        RESTAGE_TRY(auto frames, view::VideoFrames::create());
        video.emplace(std::move(frames));
    } else {
        RESTAGE_CHECK(view::check_picture_path(shot.path.string()));
    }
    const double start = now_seconds();
    for (std::size_t i = 0; i < shot.cameras.size(); ++i) {
        job.frame(i, shot.cameras.size());
        RESTAGE_TRY(const auto finished,
                    render(job, with, renderer, query::seen_from(shot.scene, shot.cameras[i]), wish));
        if (!finished) return Done();
        const std::string file = video ? video->next() : frame_file(shot.path, i + 1).string();
        RESTAGE_CHECK(view::write_picture(file, finished->picture, finished->how));
    }
    if (video) {
        job.report(1, "making the video");
        RESTAGE_CHECK(video->write(shot.path, double(wish.fps)));
    }
    return say(LogLevel::info, fmt::format("{}: {} pictures in {:.1f} s", shot.path.string(), shot.cameras.size(),
                                           now_seconds() - start));
}

// What remains to be done for a shot; none = it was cancelled.
Result<Done> render_shot(Progress& job, const Renders& with, RendererPointer& renderer, const Shot& shot,
                         const FinalWish& wish) {
    if (!shot.cameras.empty()) return render_move(job, with, renderer, shot, wish);
    job.frame(0, 1);
    RESTAGE_CHECK(view::check_picture_path(shot.path.string()));
    RESTAGE_TRY(const auto finished, render(job, with, renderer, shot.scene, wish));
    return finished ? write(finished, shot.path) : Done();
}

// The job's thread: all shots in the order that the batch has by then.
Done render_all(BackgroundJob& job, FinalBatch& batch, const std::vector<Shot>& shots, const FinalWish& wish,
                const Renders& with) {
    RendererPointer renderer;
    std::vector<Done> all;
    const auto wanted = [&]() -> std::optional<std::size_t> {
        job.wait_while_paused();
        return job.cancelled() ? std::nullopt : batch.next();
    };
    while (const auto index = wanted()) {
        const Shot& shot = shots[*index];
        Progress progress(job, batch, shots.size() > 1 ? batch.count() + shot.name + ": " : "");
        auto done = render_shot(progress, with, renderer, shot, wish);
        const bool cancelled = done && !*done;
        batch.finish(cancelled ? FinalBatch::State::cancelled
                     : done    ? FinalBatch::State::done
                               : FinalBatch::State::failed);
        if (cancelled)
            all.push_back(say(LogLevel::info, shot.path.filename().string() + " was cancelled"));
        else
            all.push_back(done ? std::move(*done) : say(LogLevel::error, done.error().message));
    }
    return [all = std::move(all)](PanelContext& editor) {
        for (const Done& done : all)
            done(editor);
    };
}

} // namespace

void start_final_pictures(PanelContext& e, const FinalWish& wish) {
    if (wish.move == CameraMove::none && view::is_video_path(wish.path))
        return e.notices.add(LogLevel::error, "A video needs a camera that moves: choose one under Camera move");
    if (view::is_video_path(wish.path)) // before anything is rendered
        if (const auto possible = view::VideoFrames::create(); !possible)
            return e.notices.add(LogLevel::error, possible.error().message);
    e.files().last_picture = wish.path;
    const fs::path path(e.session().path());
    auto shots = std::make_shared<const std::vector<Shot>>(shots_of(e, wish));
    std::vector<std::string> names;
    for (const Shot& shot : *shots)
        names.push_back(shot.name);
    const auto batch = std::make_shared<FinalBatch>(names);
    const bool one = shots->size() == 1, still = wish.move == CameraMove::none;
    BackgroundJobs::Options options{.title = one ? "Final picture " + (*shots)[0].path.filename().string()
                                                 : fmt::format("{} final pictures", shots->size()),
                                    .can_finish_early = one && still,
                                    .pauses_picture = true,
                                    .can_pause = true};
    if (!one) options.details = [batch, still](PanelContext& editor) { draw_batch(editor, *batch, still); };
    const Renders with{e.registry(), e.log(), e.options().renderer, path.filename().string()};
    e.files().jobs.start(std::move(options), [wish, shots, batch, with](BackgroundJob& job) {
        return render_all(job, *batch, *shots, wish, with);
    });
}

} // namespace restage::editor
