// SPDX-License-Identifier: Apache-2.0
#include "rendering.hpp"

#include "base/file.hpp"
#include "document/exposure.hpp"
#include "document/isolate.hpp"
#include "document/looks.hpp"
#include "document/pack.hpp"
#include "io/strict.hpp"
#include "progress.hpp"
#include "reading.hpp"
#include "render/film_error.hpp"
#include "render/tracers.hpp"
#include "scene/development.hpp"
#include "scene/tables.hpp"
#include "scene/techniques.hpp"

#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <locale>
#include <string_view>

namespace restage::app {
namespace {

double now_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

std::size_t peak_memory() {
    std::ifstream status("/proc/self/status");
    status.imbue(std::locale::classic());
    for (std::string word; status >> word;)
        if (std::size_t kib = 0; word == "VmHWM:" && status >> kib) return kib * 1024;
    return 0;
}

void add_device_options(CLI::App& command, render::RendererOptions& o) {
    const std::vector<std::string> tracers = render::tracer_names();
    command.add_option("--tracer", o.tracer, fmt::format("{} (default: by device)", fmt::join(tracers, " or ")))
        ->check(CLI::IsMember(tracers));
    command.add_option("--device", o.device,
                       "Vulkan device: its number from 0 or part of its name (default: the best one)");
    command.add_option("--threads", o.threads, "Threads of the embree tracer (0 = all)")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    command.add_flag("--validation", o.validation, "Enable Vulkan's validation layers");
}

void add_render_options(CLI::App& command, RenderOptions& o) {
    auto* spp =
        command.add_option("--spp", o.spp, "Samples per pixel (default: the scene's)")->check(CLI::Range(1u, 1u << 24));
    auto* time =
        command.add_option("--time", o.seconds, "Render for this long [s]")->check(CLI::PositiveNumber)->excludes(spp);
    command.add_option("--error", o.error, "Render until the relative standard error is below this, for example 0.02")
        ->check(CLI::PositiveNumber)
        ->excludes(spp)
        ->excludes(time);
    command.add_option("--size", o.size, "Film size WxH [pixel], for example 640x360 (default: the scene's)");
    command.add_option("--camera", o.camera, "Camera by its name or number, from 1, as `restage info` lists them");
    command.add_flag("--studio", o.studio,
                     "Light the scene with a neutral studio; if that light does not reach what the camera sees, also "
                     "with a lamp at the camera");
    command.add_option("--denoise", o.denoise, "Denoise the result; --denoise alone is high quality")
        ->expected(0, 1)
        ->default_str("high")
        ->check(CLI::IsMember({"fast", "balanced", "high"}));
    command.add_option("--denoiser", o.denoiser,
                       "Use this denoiser: its type or the id of its plugin (default: the one shipped with "
                       "Restage); implies --denoise");
    command.add_flag("--spectral", o.spectral,
                     "Trace wavelengths instead of RGB: exact saturated colours, measured metals, dispersion");
    command.add_option("--max-depth", o.max_depth, "Maximum bounces of a path (default: the scene's)")
        ->check(CLI::Range(0, 65534));
    command
        .add_option("--russian-roulette", o.roulette,
                    "End paths that carry little light early, without bias: on or off (default: the scene's)")
        ->check(CLI::IsMember({"on", "off"}));
    command.add_flag("--adaptive", o.adaptive,
                     "Give noisy parts of the picture more samples than others, without bias: --spp is their mean. Not "
                     "with --first-sample and --resume, whose samples are the same for all pixels");
    command
        .add_option(
            "--guiding", o.guiding,
            "Learn where light comes from and send paths there: on, off, or auto, which is off until a rule says "
            "where it pays (default: the scene's, or auto)")
        ->check(CLI::IsMember(scene::technique_names));
    auto* caustics =
        command
            .add_option("--caustics", o.caustics,
                        "Light through glass and off mirrors by photon maps (biased, less with every sample): auto "
                        "(where the scene has any), on or off (default: the scene's, or auto)")
            ->check(CLI::IsMember(scene::technique_names));
    auto* clamp_direct =
        command
            .add_option("--clamp-direct", o.clamp_direct,
                        "Largest contribution of directly visible or direct light (biased; 0 = off; default: the "
                        "scene's)")
            ->check(CLI::NonNegativeNumber);
    auto* clamp_indirect =
        command
            .add_option("--clamp-indirect", o.clamp_indirect,
                        "Largest contribution after a bounce (biased; 0 = off; default: the scene's)")
            ->check(CLI::NonNegativeNumber);
    auto* ray_epsilon =
        command
            .add_option("--ray-epsilon", o.ray_epsilon,
                        "Offset of ray origins [scene units] (0 = by error bounds, better; default: the scene's)")
            ->check(CLI::NonNegativeNumber);
    command
        .add_flag("--reference", o.reference,
                  "For a reference picture: turn off everything biased, whatever the scene says")
        ->excludes(caustics)
        ->excludes(clamp_direct)
        ->excludes(clamp_indirect)
        ->excludes(ray_epsilon);
    command.add_option("--strategy", o.strategy, "Light sampling strategy: mis, light or bsdf (for comparisons)")
        ->check(CLI::IsMember({"mis", "light", "bsdf"}))
        ->capture_default_str();
    command.add_option("--seed", o.renderer.seed, "Seed of the random numbers")->capture_default_str();
    add_device_options(command, o.renderer);
}

Result<std::shared_ptr<const document::IsolateOptions>> isolate_options(const Context& context) {
    if (!context.isolate) return nullptr;
    auto options = std::make_shared<document::IsolateOptions>();
    RESTAGE_TRY(options->program, executable_path());
    for (const std::string& folder : context.plugin_paths)
        options->arguments.insert(options->arguments.end(), {"--plugin-path", folder});
    options->time_limit = std::chrono::seconds(static_cast<long>(context.isolate_seconds));
    options->memory_limit = static_cast<std::uint64_t>(context.isolate_gib * double(1u << 30));
    return options;
}

Result<io::ImportedScene> open_scene(Context& context, const std::string& path, bool strict,
                                     const std::optional<scene::ParamSet>& import_options, document::Looks* looks) {
    if (path == "-") return fail("-: a scene on stdin is read by `restage render` only; name a file");
    ProgressBar bar(context.quiet);
    RESTAGE_TRY(document::ReadOptions read, reading_with(context, bar));
    read.import_options = import_options;
    io::ImportedScene imported;
    if (document::is_project(path) ||
        document::is_packed(path)) { // saved by the editor: the original scene, and the changes
        document::Session session(context.registry());
        RESTAGE_CHECK(session.open(path, read));
        imported = {.scene = session.scene(), .report = session.report(), .importer = session.base().format};
        if (looks) *looks = session.looks();
    } else {
        RESTAGE_TRY(imported, document::read_scene(path, context.registry(), read));
    }
    bar.finish();
    if (strict) RESTAGE_CHECK(io::refuse_losses(imported.report, path));
    for (const io::ReportEntry& entry : imported.report.entries) // light that was added
        if (entry.what == "exposure" || (entry.what == "light" && !entry.note.starts_with(document::no_light)))
            context.log.info(fmt::format("{}: {}: {}", path, entry.what, entry.note));
    const auto approximated = imported.report.count(io::Fate::approximated),
               dropped = imported.report.count(io::Fate::dropped);
    if (approximated + dropped > 0)
        context.log.warning(
            fmt::format("{}: {} approximated, {} dropped; `restage info` lists them", path, approximated, dropped));
    return imported;
}

std::shared_ptr<gpu::DeviceFault> device_fault() {
    const char* text = std::getenv("RESTAGE_TEST_DEVICE_LOST");
    int after = 0, times = 0;
    if (!text || std::sscanf(text, "%d,%d", &after, &times) != 2) return nullptr;
    return std::make_shared<gpu::DeviceFault>(after, times);
}

Result<glm::uvec2> parse_size(const std::string& text, const char* option) {
    unsigned w = 0, h = 0;
    const char* end = text.data() + text.size();
    const auto x = std::from_chars(text.data(), end, w);
    const auto y = x.ptr < end && *x.ptr == 'x' ? std::from_chars(x.ptr + 1, end, h) : x;
    if (x.ec != std::errc() || y.ec != std::errc() || y.ptr != end || w == 0 || h == 0 || w > 65536 || h > 65536)
        return fail(std::string(option) + " " + text +
                    ": a size is WxH with both between 1 and 65536, for example 640x360");
    return glm::uvec2(w, h);
}

namespace {

// By name, else by number.
Result<scene::Id<scene::Camera>> choose_camera(const scene::Scene& scene, const std::string& wanted) {
    scene::Id<scene::Camera> by_number;
    std::string known;
    int number = 0, asked = 0;
    const char* end = wanted.data() + wanted.size();
    if (const auto read = std::from_chars(wanted.data(), end, asked); read.ec != std::errc() || read.ptr != end)
        asked = 0;
    scene.cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& c) {
        if (++number == asked) by_number = id;
        known += fmt::format("{}{} \"{}\"", known.empty() ? "" : ", ", number, c.name);
    });
    if (const auto by_name = scene::find_by_name<scene::Camera>(scene, wanted)) return by_name;
    if (by_number) return by_number;
    return fail(fmt::format("--camera {}: no such camera; known: {}", wanted, known.empty() ? "none" : known));
}

} // namespace

Result<void> apply_options(Context& context, const RenderOptions& o, scene::Scene& scene) {
    if (!o.camera.empty()) {
        RESTAGE_TRY(const auto camera, choose_camera(scene, o.camera));
        scene.active_camera = {camera, ++scene.clock};
    }
    if (!o.size.empty()) {
        RESTAGE_TRY(const auto size, parse_size(o.size, "--size"));
        auto film = scene.film.value;
        film.width = size.x;
        film.height = size.y;
        scene.film = {film, ++scene.clock};
    }
    if (o.studio)
        scene::apply(scene, document::light_studio(scene, context.registry()));
    else if (!document::has_light(scene, context.registry()))
        context.log.warning(std::string(document::no_light) + "; --studio lights it");
    auto settings = scene.settings.value;
    if (o.max_depth >= 0) settings.max_depth = std::uint32_t(o.max_depth);
    if (!o.roulette.empty()) settings.russian_roulette = o.roulette == "on";
    settings.spectral |= o.spectral;
    settings.adaptive |= o.adaptive;
    settings.guiding = scene::find_technique(o.guiding).value_or(settings.guiding);
    settings.caustics = scene::find_technique(o.caustics).value_or(settings.caustics);
    settings.clamp_direct = o.clamp_direct.value_or(settings.clamp_direct);
    settings.clamp_indirect = o.clamp_indirect.value_or(settings.clamp_indirect);
    settings.ray_epsilon = o.ray_epsilon.value_or(settings.ray_epsilon);
    if (o.reference) settings = scene::for_reference(std::move(settings));
    if (!(settings == scene.settings.value)) scene.settings = {settings, ++scene.clock};
    return {};
}

Result<void> render_to_target(Context& context, const RenderOptions& o, const scene::Scene& scene,
                              render::Renderer& renderer, const std::string& label, CpuSeconds* spent) {
    catch_interrupts();
    ProgressBar bar(context.quiet);
    bar.show(0, label + "preparing shaders and acceleration structures");
    bool revived = false;
    renderer.plan(o.seconds > 0 || o.error > 0 ? 1u << 24 : o.spp);
    RESTAGE_CHECK(renderer.or_revive(renderer.sync(scene), scene, revived));
    const auto warn_unused = [&](scene::Technique technique, const char* option, bool used, const char* where) {
        if (technique == scene::Technique::on && !used)
            context.log.warning(fmt::format("{} on has no effect here: it needs {}", option, where));
    };
    const render::TracerKind& tracer = *render::find_tracer(renderer.tracer_name());
    warn_unused(scene.settings.value.guiding, "--guiding", tracer.guides, "a tracer that guides paths");
    warn_unused(scene.settings.value.caustics, "--caustics", tracer.photons && renderer.gpu_scene().features().caustics,
                "a tracer with photon maps, a light, and a material that mirrors or refracts sharply");
    const double start = now_seconds(), cpu_start = cpu_seconds();
    const std::uint32_t file_spp = scene.settings.value.samples ? scene.settings.value.samples : 64;
    const bool open_ended = o.seconds > 0 || o.error > 0;
    const std::uint32_t target = open_ended ? 1u << 24 : o.spp ? o.spp : file_spp;
    std::uint32_t batch = 1;
    double error = 0, done_at_look = 0; // when looked at last
    while (renderer.samples() < target && !interrupted()) {
        const double before = now_seconds();
        batch = std::min(batch, target - renderer.samples());
        if (o.error > 0) batch = std::min(batch, render::next_look(renderer.samples()) - renderer.samples());
        RESTAGE_CHECK(renderer.or_revive(renderer.trace(batch, [] { return !interrupted(); }), scene, revived));
        const double now = now_seconds(), took = now - before, elapsed = now - start;
        if (spent) {
            spent->all = cpu_seconds() - cpu_start;
            if (spent->first == 0) spent->first = spent->all;
        }
        double done = double(renderer.samples()) / target;
        std::string note = fmt::format("{}{} spp", label, renderer.samples());
        if (o.seconds > 0) {
            done = std::min(1.0, elapsed / o.seconds);
            if (elapsed >= o.seconds) break;
        } else if (o.error > 0) {
            if (render::is_look(renderer.samples())) {
                error = renderer.relative_error();
                done_at_look = error > 0 ? std::min(1.0, (o.error * o.error) / (error * error)) : 1;
                if (error <= o.error) break;
            }
            done = done_at_look;
            if (error > 0) note += fmt::format(", error {:.4f}", error);
        }
        bar.show(done, note);
        // Batches of about 0.2 s, none beyond a time target.
        const double per_sample = took / batch;
        double next = 0.2 / std::max(per_sample, 1e-6);
        if (o.seconds > 0) next = std::min(next, (o.seconds - elapsed) / std::max(per_sample, 1e-6));
        batch = std::uint32_t(std::clamp(next, 1.0, 1024.0));
    }
    bar.finish();
    for (const auto& [type, count] : renderer.stats().not_finite)
        context.log.warning(
            fmt::format("{} samples of material type \"{}\" were non-finite and were omitted", count, type));
    if (renderer.stats().dropped > 0)
        context.log.warning(
            fmt::format("{} samples summed to more light than the film can hold, or to NaN, and were "
                        "omitted: check the lights and the environment",
                        renderer.stats().dropped));
    if (interrupted()) context.log.warning(fmt::format("stopped after {} samples per pixel", renderer.samples()));
    return {};
}

Result<void> denoise_picture(Context& context, const RenderOptions& o, Picture& picture) {
    if (o.denoise.empty() && o.denoiser.empty()) return {};
    const auto quality = o.denoise == "fast"       ? plugin::DenoiseQuality::fast
                         : o.denoise == "balanced" ? plugin::DenoiseQuality::balanced
                                                   : plugin::DenoiseQuality::high;
    RESTAGE_TRY(const auto chosen, render::choose_denoiser(context.registry(), o.denoiser));
    ProgressBar bar(context.quiet);
    const bool before = interrupted(); // during rendering: the partial picture is still denoised
    auto denoised = render::denoise(picture.film, chosen, quality, o.renderer.threads, [&](double done) {
        bar.show(done, "denoising");
        return before || !interrupted();
    });
    if (!denoised && denoised.error().cancelled()) {
        context.log.warning("denoising was stopped: the picture is written without it");
        return {};
    }
    RESTAGE_TRY(picture.denoised, std::move(denoised));
    picture.denoiser = render::denoiser_label(chosen, quality);
    return {};
}

Result<Picture> take_picture(Context& context, const RenderOptions& o, const scene::Scene& scene,
                             const render::Renderer& renderer) {
    Picture picture;
    picture.film = renderer.image();
    picture.exposure = scene.film.value.exposure;
    picture.development = scene::development_of(scene);
    picture.window = scene.film.value.crop;
    RESTAGE_CHECK(denoise_picture(context, o, picture));
    return picture;
}

} // namespace restage::app
