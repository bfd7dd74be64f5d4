// SPDX-License-Identifier: Apache-2.0
// Renderer: from a scene to a film, in the order sync, reset, trace. Denoising and display work on image()'s result.
// After an error, check lost(): a driver that stopped can be restarted by revive(). One thread at a time.
#pragma once

#include "render/adaptive.hpp"
#include "render/clay_look.hpp"
#include "render/embree_scene.hpp"
#include "render/renderer_options.hpp"
#include "render/tracer.hpp"

#include <memory>
#include <string>
#include <utility>

namespace restage::render {

class Guiding;

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options, MaterialLookup lookup, Log& log);
    ~Renderer();
    Renderer(const Renderer&) = delete;

    // Updates to the scene. If a visible change occurred, the film restarts.
    Result<void> sync(const scene::Scene& scene);
    // How many samples per pixel the picture will have, for techniques that pay in long renderings only; 0: those of
    // its Settings. Of pictures that begin after the call.
    void plan(std::uint32_t samples) { planned_ = samples; }
    // Whether pictures are replaced soon by better ones, so that not all is worth its time: light is carried by photons
    // (Technique::automatic) only if the last picture had some, and then their pilot decides again.
    void provisional(bool is) { provisional_ = is; }
    // Adds `samples` to every pixel, or with Settings::adaptive to their mean; first restarts the film if newly
    // compiled shaders changed the picture. `keep_going` is called between batches of work (a bounce of 65536 paths,
    // a rectangle of the film) and while shaders compile; false stops early and is not an error.
    Result<void> trace(std::uint32_t samples, std::function<bool()> keep_going = {});

    // The driver has stopped (VK_ERROR_DEVICE_LOST): everything fails until revive().
    bool lost() const { return !device_ || device_->lost(); }
    // Reopens the device, rederives everything from the scene and logs it; the film is empty, and
    // restart()'s numbers stay. An error if the driver stopped again before it delivered a sample: retrying would
    // never end. After an error the renderer is unusable.
    Result<void> revive(const scene::Scene& scene);
    // The result of sync() or trace(); if the driver stopped and `once` is still false, that of revive(). For work
    // that is retried in that case, but only once.
    Result<void> or_revive(Result<void> did, const scene::Scene& scene, bool& once) {
        return did || !lost() || std::exchange(once, true) ? did : revive(scene);
    }

    // A picture that needs no shader, of the last sync(); see clay.hpp. `size` in pixels. The first of a scene builds
    // what it needs if the tracer does not use Embree; forget_clay() frees that.
    Result<FilmImage> clay(glm::uvec2 size, ClayLook look = ClayLook::clay);
    void forget_clay() { clay_scene_.reset(); }

    // What workers are compiling; nullopt: the picture has (or, before trace() has begun, may have) no stand-ins.
    std::optional<CompileProgress> compiling() const { return tracer_->compiling(); }

    std::uint32_t samples() const { return samples_; } // per pixel (adaptive: their mean), since the last reset
    std::uint32_t most_samples() const; // of a pixel
    FilmImage image() const;
    const Film* film() const { return film_ ? &*film_ : nullptr; } // null before the first sync
    double relative_error() const { return film_ ? film_->relative_error() : 1e30; }
    void reset() {
        samples_ = 0;
        adaptive_plan_ = {};
        if (film_) film_->clear();
        tracer_->film_emptied();
    }
    // Restarts the film with other random numbers: of this seed, starting at this sample per pixel. Sample ranges
    // of one seed, rendered separately, add up to the result of a single rendering.
    void restart(std::uint32_t seed, std::uint32_t first_sample = 0) {
        options_.seed = seed;
        first_sample_ = first_sample;
        reset();
    }

    const TraceStats& stats() const { return tracer_->stats(); }
    void reset_stats() { tracer_->reset_stats(); }
    const char* tracer_name() const { return tracer_->name(); }
    gpu::Device& device() { return *device_; }
    const GpuScene& gpu_scene() const { return *gpu_scene_; }
    Jobs& jobs() { return jobs_; }
    // A new scene: forgets what was derived from the old one.
    void forget_scene();

  private:
    Renderer(const RendererOptions& options, MaterialLookup lookup, Log& log);
    Result<void> open();
    // These return false if keep_going stopped them; the first three add to the mean of the pixels' samples.
    Result<bool> trace_some(std::uint32_t samples, const std::function<bool()>& keep_going);
    Result<bool> trace_uniform(std::uint32_t samples, const std::function<bool()>& keep_going);
    Result<bool> trace_adaptive(std::uint32_t samples, const std::function<bool()>& keep_going);
    Result<bool> trace(TraceRequest request, const std::function<bool()>& keep_going);
    TraceRequest request() const;

    RendererOptions options_;
    MaterialLookup lookup_;
    Log* log_;
    Jobs jobs_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::ShaderCompiler> compiler_;
    std::unique_ptr<GpuScene> gpu_scene_;
    std::unique_ptr<Tracer> tracer_;
    std::unique_ptr<EmbreeScene> clay_scene_;
    std::optional<Film> film_;
    glm::uvec2 crop_origin_{0};
    std::uint32_t samples_ = 0, first_sample_ = 0;
    bool adaptive_ = false;
    AdaptivePlan adaptive_plan_; // made after the pilot
    scene::Technique guiding_technique_ = scene::Technique::off;
    std::uint32_t planned_ = 0, scene_samples_ = 0; // see plan()
    bool provisional_ = false;
    std::unique_ptr<Guiding> guiding_;
    bool revived_ = false; // and has delivered no sample since
};

} // namespace restage::render
