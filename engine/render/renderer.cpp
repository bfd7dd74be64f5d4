// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.hpp"

#include "base/file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::render {

Renderer::Renderer(const RendererOptions& options, MaterialLookup lookup, Log& log)
    : options_(options), lookup_(std::move(lookup)), log_(&log), jobs_(options.threads) {}

Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options, MaterialLookup lookup, Log& log) {
    std::unique_ptr<Renderer> self(new Renderer(options, std::move(lookup), log));
    if (self->options_.shader_dir.empty()) {
        RESTAGE_TRY(const auto bin, executable_dir());
        self->options_.shader_dir = bin.parent_path() / "share/restage/shaders";
    }
    if (!std::filesystem::exists(self->options_.shader_dir / "path/step.glsl"))
        return fail(self->options_.shader_dir.string() +
                    ": Restage's shaders are not there; the installation is incomplete");
    if (self->options_.cache_dir.empty()) {
        RESTAGE_TRY(self->options_.cache_dir, cache_dir());
    }

    const std::string& wanted = options.tracer;
    if (!wanted.empty() && wanted != "embree" && wanted != "vulkan")
        return fail("there is no tracer \"" + wanted + "\"; there are embree and vulkan");
    RESTAGE_TRY(self->device_, gpu::Device::create({.select = options.device,
                                                    .validation = options.validation,
                                                    .require_ray_tracing = wanted == "vulkan",
                                                    .cache_dir = self->options_.cache_dir},
                                                   log));
    self->compiler_ = std::make_unique<gpu::ShaderCompiler>(gpu::ShaderCompilerOptions{
        .include_dirs = {self->options_.shader_dir}, .cache_dir = self->options_.cache_dir / "spirv"});
    const auto& info = self->device_->info();
    const bool use_vulkan =
        wanted == "vulkan" || (wanted.empty() && info.ray_tracing && info.type != gpu::DeviceType::cpu);
    const TracerContext context{.device = *self->device_,
                                .compiler = *self->compiler_,
                                .jobs = self->jobs_,
                                .log = log,
                                .shader_dir = self->options_.shader_dir,
                                .strategy = options.strategy,
                                .stand_ins = options.stand_ins};
    if (use_vulkan) {
        RESTAGE_TRY(self->tracer_, make_vulkan_tracer(context));
    } else {
        RESTAGE_TRY(self->tracer_, make_embree_tracer(context));
    }
    log.debug(fmt::format("device: {} ({}); tracer: {}", info.name, info.driver, self->tracer_->name()));
    self->forget_scene();
    return self;
}

void Renderer::forget_scene() {
    gpu_scene_ = std::make_unique<GpuScene>(*device_, jobs_, lookup_);
    film_.reset();
    samples_ = 0;
}

Result<void> Renderer::sync(const scene::Scene& scene) {
    RESTAGE_TRY(const SceneChanges changes, gpu_scene_->sync(scene));
    for (const auto& warning : changes.warnings)
        log_->warning(warning);
    RESTAGE_CHECK(tracer_->update(*gpu_scene_, changes));
    if (changes.film || !film_) {
        // The crop window in pixels; pbrt 4ed, 5.4.2, in floats as there: 0.2f of 30 is 6
        const scene::Film& f = scene.film.value;
        const auto pixel = [](float x, std::uint32_t n) {
            return std::uint32_t(std::clamp(std::ceil(x * float(n)), 0.f, float(n)));
        };
        const glm::uvec2 lower(pixel(f.crop.x, f.width), pixel(f.crop.z, f.height));
        const glm::uvec2 upper(pixel(f.crop.y, f.width), pixel(f.crop.w, f.height));
        if (upper.x <= lower.x || upper.y <= lower.y)
            return fail(fmt::format("the film's crop window [{} {} {} {}] holds no pixel", f.crop.x, f.crop.y, f.crop.z,
                                    f.crop.w));
        crop_origin_ = lower;
        if (!film_ || film_->width() != upper.x - lower.x || film_->height() != upper.y - lower.y) {
            RESTAGE_TRY(auto film, Film::create(*device_, upper.x - lower.x, upper.y - lower.y));
            film_ = std::move(film);
        }
    }
    if (changes.image) reset();
    return {};
}

Result<void> Renderer::trace(std::uint32_t samples, std::function<bool()> keep_going) {
    if (tracer_->adopt()) reset();
    TraceRequest request;
    request.first_sample = first_sample_ + samples_;
    request.samples = samples;
    request.seed = options_.seed;
    request.crop_x = crop_origin_.x;
    request.crop_y = crop_origin_.y;
    bool stopped = false;
    request.keep_going = [&] {
        stopped = stopped || (keep_going && !keep_going());
        return !stopped;
    };
    RESTAGE_CHECK(tracer_->trace(*gpu_scene_, *film_, request));
    // Stopped within a pass, some pixels have more samples than others: what all of them have is what counts.
    samples_ = stopped ? film_->least_samples() : samples_ + samples;
    return {};
}

} // namespace restage::render
