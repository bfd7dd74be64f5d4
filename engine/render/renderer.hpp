// SPDX-License-Identifier: Apache-2.0
// Renderer: from a scene to a film, in the order sync, reset, trace. Denoising and display work on what image() gives.
// After an error, ask lost(): a driver that stopped can be started again by revive(). One thread at a time.
#pragma once

#include "render/embree_scene.hpp"
#include "render/renderer_options.hpp"
#include "render/tracer.hpp"

#include <memory>
#include <string>
#include <utility>

namespace restage::render {

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(const RendererOptions& options, MaterialLookup lookup, Log& log);
    ~Renderer();
    Renderer(const Renderer&) = delete;

    // Follows the scene. When something changed that the picture shows, the film starts again.
    Result<void> sync(const scene::Scene& scene);
    // Adds `samples` to every pixel; first starts the film again if something compiled has changed the picture.
    // `keep_going` is asked between batches of work (a wave of 65536 paths, a rectangle of the film) and while shaders
    // compile; false stops early and is no error.
    Result<void> trace(std::uint32_t samples, std::function<bool()> keep_going = {});

    // The driver has stopped (VK_ERROR_DEVICE_LOST): everything fails until revive().
    bool lost() const { return !device_ || device_->lost(); }
    // Opens the device anew, derives everything from the scene again and says so in the log; the film is empty, and
    // restart()'s numbers stay. An error when the driver has stopped again before it brought a sample: it would do so
    // for ever. After an error the renderer is of no more use.
    Result<void> revive(const scene::Scene& scene);
    // What sync() or trace() gave; where the driver stopped and `once` is still false, what revive() gives. For work
    // that begins again when that happens, but does not begin for ever.
    Result<void> or_revive(Result<void> did, const scene::Scene& scene, bool& once) {
        return did || !lost() || std::exchange(once, true) ? did : revive(scene);
    }

    // A picture that needs no shader, of what sync() saw; see clay.hpp. `size` in pixels. The first of a scene builds
    // what it needs where the tracer does not use Embree; forget_clay() frees that.
    Result<FilmImage> clay(glm::uvec2 size);
    void forget_clay() { clay_scene_.reset(); }

    // What workers compile now; nullopt: the picture is (or, before trace() has begun, may be) the scene's own.
    std::optional<CompileProgress> compiling() const { return tracer_->compiling(); }

    std::uint32_t samples() const { return samples_; } // a pixel, since the last reset
    FilmImage image() const { return film_ ? film_->read() : FilmImage{}; }
    double relative_error() const { return film_ ? film_->relative_error() : 1e30; }
    void reset() {
        samples_ = 0;
        if (film_) film_->clear();
        tracer_->film_emptied();
    }
    // The film starts again with other random numbers: of this seed, from this sample of a pixel on. Ranges of samples
    // of one seed, rendered apart, are together what rendering them in one go gives.
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
    bool revived_ = false; // and has brought no sample since
};

} // namespace restage::render
