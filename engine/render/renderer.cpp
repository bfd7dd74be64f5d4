// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.hpp"

#include "base/file.hpp"
#include "render/clay.hpp"
#include "render/guiding.hpp"
#include "render/tracers.hpp"
#include "scene/projection.hpp"
#include "scene/validate.hpp"

#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

namespace restage::render {

// Samples after which the time of a Tracer::settle() is worth it, and nobody seems to be editing.
constexpr std::uint32_t settling_pays = 16;

Renderer::Renderer(const RendererOptions& options, MaterialLookup lookup, Log& log)
    : options_(options),
      lookup_(std::move(lookup)),
      log_(&log),
      jobs_(options.threads),
      guiding_(std::make_unique<Guiding>()) {}

Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options, MaterialLookup lookup, Log& log) {
    std::unique_ptr<Renderer> self(new Renderer(options, std::move(lookup), log));
    if (self->options_.shader_dir.empty()) {
        RESTAGE_TRY(const auto bin, executable_dir());
        self->options_.shader_dir = bin.parent_path() / "share/restage/shaders";
    }
    if (!std::filesystem::exists(self->options_.shader_dir / "path/step.glsl"))
        return fail(self->options_.shader_dir.string() +
                    ": Restage's shaders are missing; the installation is incomplete");
    if (self->options_.cache_dir.empty())
        if (auto cache = cache_dir()) self->options_.cache_dir = std::move(*cache); // if missing: the device reports it

    if (!options.tracer.empty() && !find_tracer(options.tracer))
        return fail(
            fmt::format("there is no tracer \"{}\"; there are {}", options.tracer, fmt::join(tracer_names(), " and ")));
    RESTAGE_CHECK(self->open());
    return self;
}

Result<void> Renderer::open() {
    const TracerKind* kind = find_tracer(options_.tracer); // null: by device
    RESTAGE_TRY(device_, gpu::Device::create({.select = options_.device,
                                              .validation = options_.validation,
                                              .require_ray_tracing = kind && kind->needs_ray_tracing,
                                              .cache_dir = options_.cache_dir,
                                              .fault = options_.fault},
                                             *log_));
    const auto spirv_cache = options_.cache_dir.empty() ? std::filesystem::path() : options_.cache_dir / "spirv";
    compiler_ = std::make_unique<gpu::ShaderCompiler>(
        gpu::ShaderCompilerOptions{.include_dirs = {options_.shader_dir}, .cache_dir = spirv_cache});
    const auto& info = device_->info();
    if (!kind) kind = &best_tracer(info);
    const TracerContext context{.device = *device_,
                                .compiler = *compiler_,
                                .jobs = jobs_,
                                .log = *log_,
                                .shader_dir = options_.shader_dir,
                                .strategy = options_.strategy,
                                .stand_ins = options_.stand_ins,
                                .all_features = options_.all_features};
    RESTAGE_TRY(tracer_, kind->make(context));
    log_->debug(fmt::format("device: {} ({}); tracer: {}", info.name, info.driver, tracer_->name()));
    forget_scene();
    return {};
}

Result<void> Renderer::revive(const scene::Scene& scene) {
    if (std::exchange(revived_, true))
        return fail(
            "the graphics driver stopped again at once (VK_ERROR_DEVICE_LOST): this scene may be too much for it. Try "
            "a "
            "smaller picture, another --device or --tracer embree; if it persists, update the driver");
    log_->warning("the graphics driver stopped (VK_ERROR_DEVICE_LOST); it is restarted, and so is the picture");
    forget_clay();
    film_.reset();
    tracer_.reset();
    gpu_scene_.reset();
    compiler_.reset();
    device_.reset();
    RESTAGE_CHECK(open());
    return sync(scene);
}

Result<FilmImage> Renderer::clay(glm::uvec2 size, ClayLook look) {
    const EmbreeScene* embree = tracer_->embree();
    if (!embree && !clay_scene_) {
        RESTAGE_TRY(clay_scene_, EmbreeScene::create(jobs_.threads(), {.copies = true}));
        SceneChanges all;
        for (std::uint32_t i = 0; i < gpu_scene_->instances().size(); ++i)
            if (gpu_scene_->traced(i) || gpu_scene_->border(i)) {
                all.instances.push_back({i});
                all.meshes.push_back(gpu_scene_->mesh_of(i));
            }
        std::ranges::sort(all.meshes, {}, &scene::Id<scene::Mesh>::value);
        const auto twice = std::ranges::unique(all.meshes);
        all.meshes.erase(twice.begin(), twice.end());
        RESTAGE_CHECK(clay_scene_->update(*gpu_scene_, all));
    }
    return clay_picture(*gpu_scene_, embree ? *embree : *clay_scene_, jobs_, size, look);
}

FilmImage Renderer::image() const {
    if (!film_) return {};
    FilmImage image = film_->read();
    if (!adaptive_plan_.empty()) image.samples = samples_;
    return image;
}

std::uint32_t Renderer::most_samples() const {
    return adaptive_plan_.empty() || !film_ ? samples_ : film_->most_samples();
}

void Renderer::forget_scene() {
    clay_scene_.reset();
    gpu_scene_ = std::make_unique<GpuScene>(*device_, jobs_, lookup_, options_.strategy);
    film_.reset();
    samples_ = 0;
}

// Checks for scenes built in code, which bypass edits and importers; the rest is checked during derivation.
static Result<void> check_view(const scene::Scene& scene) {
    const auto refuse = [](const auto& thing) -> Result<void> {
        for (const auto& p : scene::value_problems(thing))
            if (p.severity == scene::Problem::Severity::error) return fail(p.sentence);
        return {};
    };
    if (const auto* camera = scene.cameras.find(scene.active_camera.value)) RESTAGE_CHECK(refuse(*camera));
    if (scene.environment.value) RESTAGE_CHECK(refuse(*scene.environment.value));
    RESTAGE_CHECK(refuse(scene.film.value));
    return refuse(scene.settings.value);
}

Result<void> Renderer::sync(const scene::Scene& scene) {
    RESTAGE_CHECK(check_view(scene));
    RESTAGE_TRY(const SceneChanges changes, gpu_scene_->sync(scene));
    for (const auto& warning : changes.warnings)
        log_->warning(warning);
    RESTAGE_CHECK(tracer_->update(*gpu_scene_, changes));
    if (clay_scene_) RESTAGE_CHECK(clay_scene_->update(*gpu_scene_, changes));
    if (changes.film || !film_) {
        const scene::Film& f = scene.film.value;
        const glm::uvec4 window = scene::crop_window(f);
        const glm::uvec2 lower(window.x, window.z), upper(window.y, window.w);
        if (upper.x <= lower.x || upper.y <= lower.y)
            return fail(fmt::format("the film's crop window [{} {} {} {}] has no pixels", f.crop.x, f.crop.y, f.crop.z,
                                    f.crop.w));
        crop_origin_ = lower;
        if (!film_ || film_->width() != upper.x - lower.x || film_->height() != upper.y - lower.y) {
            RESTAGE_TRY(auto film, Film::create(*device_, upper.x - lower.x, upper.y - lower.y));
            film_ = std::move(film);
        }
    }
    adaptive_ = scene.settings.value.adaptive;
    guiding_technique_ = scene.settings.value.guiding;
    scene_samples_ = scene.settings.value.samples;
    if (changes.image) reset();
    return {};
}

TraceRequest Renderer::request() const {
    TraceRequest r;
    r.first_sample = first_sample_ + samples_;
    r.seed = options_.seed;
    r.crop_x = crop_origin_.x;
    r.crop_y = crop_origin_.y;
    return r;
}

// Whether it was not stopped.
Result<bool> Renderer::trace(TraceRequest request, const std::function<bool()>& keep_going) {
    if (guiding_->learns() || guiding_->address()) request.guiding = guiding_.get();
    request.provisional = provisional_;
    bool stopped = false;
    request.keep_going = [&] {
        stopped = stopped || !keep_going();
        return !stopped;
    };
    RESTAGE_CHECK(tracer_->trace(*gpu_scene_, *film_, request));
    return !stopped;
}

Result<bool> Renderer::trace_uniform(std::uint32_t samples, const std::function<bool()>& keep_going) {
    TraceRequest r = request();
    r.samples = samples;
    RESTAGE_TRY(const bool whole, trace(r, keep_going));
    // If stopped within a pass, some pixels have more samples than others: count what all of them have.
    samples_ = whole ? samples_ + samples : film_->least_samples();
    return whole;
}

Result<bool> Renderer::trace_adaptive(std::uint32_t samples, const std::function<bool()>& keep_going) {
    if (adaptive_plan_.empty()) adaptive_plan_ = AdaptivePlan(*film_);
    const std::vector<std::uint32_t> goals = adaptive_plan_.counts(samples_ + samples);
    std::vector<PixelSamples> pixels(goals.size());
    for (std::size_t i = 0; i < goals.size(); ++i) {
        const std::uint32_t has = film_->samples_of(i); // also those of a trace that was stopped
        pixels[i] = {first_sample_ + has, goals[i] - std::min(has, goals[i])};
    }
    TraceRequest r = request();
    r.samples = samples;
    r.pixels = pixels;
    RESTAGE_TRY(const bool whole, trace(r, keep_going));
    if (whole) samples_ += samples;
    return whole;
}

Result<bool> Renderer::trace_some(std::uint32_t samples, const std::function<bool()>& keep_going) {
    const std::uint32_t uniform =
        adaptive_ ? std::min(samples, adaptive_pilot - std::min(samples_, adaptive_pilot)) : samples;
    bool going = true;
    if (uniform > 0) {
        RESTAGE_TRY(going, trace_uniform(uniform, keep_going));
    }
    return going && uniform < samples ? trace_adaptive(samples - uniform, keep_going) : Result<bool>(going);
}

Result<void> Renderer::trace(std::uint32_t samples, std::function<bool()> keep_going) {
    if (tracer_->adopt()) reset();
    if (!keep_going) keep_going = [] { return true; };
    if (samples_ == 0) {
        // Nobody waits for guides while a scene is edited, nor does the other tracer have them.
        const bool usable = tracer_->embree() && !(options_.stand_ins && guiding_technique_ != scene::Technique::on);
        guiding_->begin(usable ? guiding_technique_ : scene::Technique::off, planned_ ? planned_ : scene_samples_,
                        std::size_t(film_->width()) * film_->rows());
    }
    bool going = true;
    for (const std::uint32_t goal = samples_ + samples; going && samples_ < goal;) {
        RESTAGE_CHECK(guiding_->advance(samples_, *device_, jobs_));
        std::uint32_t next = std::min(goal - samples_, guiding_->until_change(samples_));
        if (!tracer_->settled()) { // while edits follow one another it stays so
            if (samples_ >= settling_pays)
                RESTAGE_CHECK(tracer_->settle());
            else
                next = std::min(next, settling_pays - samples_);
        }
        RESTAGE_TRY(going, trace_some(next, keep_going));
    }
    if (samples_ > 0) revived_ = false;
    return {};
}

} // namespace restage::render
