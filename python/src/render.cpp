// SPDX-License-Identifier: Apache-2.0
// Session.render: a copy of the scene, traced without the GIL until a target is met, or Ctrl-C or a callback stops it.
#include "picture.hpp"
#include "pulse.hpp"

#include "render/denoise.hpp"
#include "render/film_error.hpp"
#include "scene/development.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <chrono>
#include <shared_mutex>

namespace restage::python {

using Shared = std::shared_ptr<Workspace>;

namespace {

struct Progress { // the callback's argument
    double fraction = 0, seconds = 0, relative_error = 1e30;
    std::uint32_t samples = 0;
};

struct Target {
    std::uint32_t samples = 0; // 0 = determined by the others
    double seconds = 0, error = 0;
};

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Versions of films and settings for renders only, which no edit can have, so that the renderer notices each
// change.
scene::Version version_of_render() {
    static std::atomic<scene::Version> last = scene::Version(1) << 62;
    return ++last;
}

// Without the GIL. Batches of about 0.05 s, so that time targets are met and Ctrl-C is noticed.
Result<void> trace(render::Renderer& renderer, const Target& target, Pulse& pulse, Progress& progress, bool& finished) {
    const double start = now_seconds();
    std::uint32_t batch = 1;
    const std::uint32_t limit = target.samples ? target.samples : 1u << 24;
    while (renderer.samples() < limit) {
        batch = std::min(batch, limit - renderer.samples());
        if (target.error > 0) batch = std::min(batch, render::next_look(renderer.samples()) - renderer.samples());
        const std::uint32_t done_before = renderer.samples();
        const double before = now_seconds();
        RESTAGE_CHECK(renderer.trace(batch, [&] { return pulse.keep_going(); }));
        const double now = now_seconds(), each = (now - before) / batch;
        progress.samples = renderer.samples();
        progress.seconds = now - start;
        progress.fraction = double(renderer.samples()) / limit;
        if (target.seconds > 0) progress.fraction = std::min(1.0, progress.seconds / target.seconds);
        if (target.error > 0) {
            if (render::is_look(renderer.samples())) progress.relative_error = renderer.relative_error();
            const double e = progress.relative_error;
            progress.fraction = e > 0 ? std::min(1.0, target.error * target.error / (e * e)) : 1;
            if (e <= target.error) break;
        }
        if (target.seconds > 0 && progress.seconds >= target.seconds) break;
        if (pulse.stopped() || renderer.samples() == done_before) return {};
        double next = 0.05 / std::max(each, 1e-6);
        if (target.seconds > 0) next = std::min(next, (target.seconds - progress.seconds) / std::max(each, 1e-6));
        batch = std::uint32_t(std::clamp(next, 1.0, 1024.0));
    }
    finished = true;
    return {};
}

struct Request {
    Target target;
    RendererKey key;
    std::uint32_t seed = 0, first_sample = 0;
};

// Without the GIL.
Result<void> run(Workspace& w, const scene::Scene& scene, const Request& request, Pulse& pulse, Progress& progress,
                 Picture& out) {
    RendererUse use(w);
    const std::shared_lock plugins(w.host().in_use());
    RESTAGE_TRY(render::Renderer * renderer, use.get(request.key));
    renderer->plan(request.target.samples ? request.target.samples : 1u << 24);
    renderer->restart(request.seed, request.first_sample);
    renderer->reset_stats();
    bool revived = false; // a stopped driver is restarted, once
    RESTAGE_CHECK(renderer->or_revive(renderer->sync(scene), scene, revived));
    const double start = now_seconds();
    auto traced = trace(*renderer, request.target, pulse, progress, out.finished);
    if (!traced && renderer->lost() && !revived) {
        traced = renderer->revive(scene);
        if (traced) traced = trace(*renderer, request.target, pulse, progress, out.finished);
    }
    if (!traced) {
        use.drop(); // in any state
        return traced;
    }
    out.seconds = now_seconds() - start;
    out.film = renderer->image();
    out.not_finite = renderer->stats().not_finite;
    out.device = renderer->device().info().name;
    out.tracer = renderer->tracer_name();
    return {};
}

std::string denoise_quality(const nb::object& asked) { // "" = none
    bool flag = false;
    if (nb::try_cast(asked, flag, false)) return flag ? "high" : "";
    return asked.is_none() ? "" : nb::cast<std::string>(asked);
}

std::shared_ptr<Picture> render(const Shared& w, std::optional<std::tuple<std::uint32_t, std::uint32_t>> size,
                                std::optional<std::uint32_t> samples, std::optional<double> seconds,
                                std::optional<double> error, std::uint32_t seed, const nb::object& denoised,
                                const nb::object& callback, unsigned threads, std::optional<std::uint32_t> max_depth,
                                std::optional<bool> spectral, std::optional<bool> adaptive,
                                const std::optional<std::string>& guiding, const std::optional<std::string>& caustics,
                                std::uint32_t first_sample, const std::string& tracer, const std::string& device,
                                const std::string& denoiser, bool reference) {
    if (int(samples.has_value()) + int(seconds.has_value()) + int(error.has_value()) > 1)
        throw Failure("render: give one of samples, seconds and error");
    if ((samples && *samples == 0) || (seconds && !(*seconds > 0)) || (error && !(*error > 0)))
        throw Failure("render: samples, seconds and error must be above 0");
    if (size &&
        (!std::get<0>(*size) || !std::get<1>(*size) || std::get<0>(*size) > 65536 || std::get<1>(*size) > 65536))
        throw Failure("render: a size is (width, height), both between 1 and 65536");
    scene::Scene scene = w->scene(); // a copy; geometry and pixels are shared
    if (!scene.active_camera.value) throw Failure(std::string(scene::no_camera) + "; set session.camera");
    if (size) {
        std::tie(scene.film.value.width, scene.film.value.height) = *size;
        scene.film.version = version_of_render();
    }
    if (max_depth) scene.settings.value.max_depth = *max_depth;
    scene.settings.value.spectral = spectral.value_or(scene.settings.value.spectral);
    scene.settings.value.adaptive = adaptive.value_or(scene.settings.value.adaptive);
    if (first_sample > 0) scene.settings.value.adaptive = false; // other samples are to be added to these
    if (guiding) scene.settings.value.guiding = technique("guiding", *guiding);
    if (caustics) scene.settings.value.caustics = technique("caustics", *caustics);
    if (reference) scene.settings.value = scene::for_reference(std::move(scene.settings.value));
    scene.settings.version = version_of_render();
    const std::string quality = denoise_quality(denoised);
    if (!quality.empty()) take(render::choose_denoiser(w->host().registry(), denoiser)); // before hours are spent

    Request request{
        .key = {.device = device, .tracer = tracer, .threads = threads}, .seed = seed, .first_sample = first_sample};
    request.target.seconds = seconds.value_or(0);
    request.target.error = error.value_or(0);
    if (!seconds && !error) request.target.samples = samples ? *samples : std::max(1u, scene.settings.value.samples);

    auto picture = std::make_shared<Picture>();
    picture->host = Host::get();
    picture->seed = seed;
    picture->first_sample = first_sample;
    picture->scene = std::filesystem::path(w->session().path()).filename().string();
    Progress progress;
    Pulse pulse([&]() -> bool { return callback.is_none() || goes_on(callback(progress)); });
    auto done = [&] {
        const nb::gil_scoped_release release;
        return run(*w, scene, request, pulse, progress, *picture);
    }();
    pulse.rethrow();
    w->host().flush_log();
    take(std::move(done));
    picture->film.expose(scene.film.value.exposure);
    picture->development = scene::development_of(scene);
    picture->window = scene.film.value.crop;
    if (!quality.empty() && picture->film.samples > 0)
        try { // after a stop the callback is not called again: the partial picture is denoised
            denoise(*picture, quality, threads, denoiser,
                    [&](double) { return pulse.stopped() || callback.is_none() || goes_on(callback(progress)); });
        } catch (const Stopped&) {
            picture->finished = false;
        }
    return picture;
}

} // namespace

void bind_render(nb::module_& m, nb::class_<Workspace>& c) {
    nb::class_<Progress>(m, "Progress", "The progress of a render; the argument of its callback.")
        .def_ro("fraction", &Progress::fraction, "0 to 1, an estimate.")
        .def_ro("samples", &Progress::samples, "Samples per pixel so far.")
        .def_ro("seconds", &Progress::seconds, "Time since the first sample [s].")
        .def_ro("relative_error", &Progress::relative_error,
                "The error when last looked at if error is the target; else 1e30.")
        .def("__repr__", [](const Progress& p) {
            return "<restage.Progress " + std::to_string(int(100 * p.fraction)) + " %, " + std::to_string(p.samples) +
                   " samples a pixel>";
        });
    c.def(
        "render", &render, "size"_a = nb::none(), "samples"_a = nb::none(), "seconds"_a = nb::none(),
        "error"_a = nb::none(), "seed"_a = 0, "denoise"_a = false, "progress"_a = nb::none(), "threads"_a = 0,
        "max_depth"_a = nb::none(), "spectral"_a = nb::none(), "adaptive"_a = nb::none(), "guiding"_a = nb::none(),
        "caustics"_a = nb::none(), "first_sample"_a = 0, "tracer"_a = "", "device"_a = "", "denoiser"_a = "",
        "reference"_a = false,
        "Path-traces the scene as it is now; returns a Picture. The same seed gives the same picture.\n\n"
        "size: (width, height) [pixel], default Session.size. Target: samples per pixel (default Session.samples), or\n"
        "seconds, or error (relative standard error, 0.02). denoise: True, or fast, balanced, high. threads: 0 = all.\n"
        "progress(p): called about 20 times a second with a Progress; on False the result so far is returned "
        "and\n"
        "Picture.finished is False. Ctrl-C raises KeyboardInterrupt. Other Python threads run meanwhile, and may "
        "edit:\n"
        "a copy is rendered. first_sample: see restage.merge. tracer: see Picture.tracer; device: part of its name.\n"
        "spectral: trace wavelengths instead of RGB, default Session.spectral. adaptive: more samples where it is "
        "noisy.\n"
        "guiding, caustics: auto, on or off, default Session.guiding and .caustics. denoiser: see Picture.denoise.\n"
        "reference: turns off everything biased, whatever Session says.",
        nb::sig("def render(self, size: tuple[int, int] | None = None, samples: int | None = None, "
                "seconds: float | None = None, error: float | None = None, seed: int = 0, denoise: bool | str = False, "
                "progress: collections.abc.Callable[[Progress], bool | None] | None = None, threads: int = 0, "
                "max_depth: int | None = None, spectral: bool | None = None, adaptive: bool | None = None, guiding: "
                "str | None = None, "
                "caustics: str | None = None, first_sample: int = 0, tracer: str = '', "
                "device: str = '', denoiser: str = '', reference: bool = False) -> Picture"));
}

} // namespace restage::python
