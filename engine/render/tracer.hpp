// SPDX-License-Identifier: Apache-2.0
// Tracer: finds the hits. There are two, sharing one path step; both fill the same film with the same picture.
#pragma once

#include "base/jobs.hpp"
#include "gpu/compiler.hpp"
#include "gpu/device.hpp"
#include "render/film.hpp"
#include "render/gpu_scene.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace restage::render {

class EmbreeScene;
class Guiding;

struct TracerContext {
    gpu::Device& device;
    const gpu::ShaderCompiler& compiler;
    Jobs& jobs;
    Log& log;
    std::filesystem::path shader_dir;
    Strategy strategy = Strategy::mis;
    bool stand_ins = false, all_features = false; // see RendererOptions
};

struct PixelSamples { // to add to a pixel
    std::uint32_t first = 0, count = 0; // of its samples
};

struct TraceRequest {
    std::uint32_t first_sample = 0, samples = 1; // per pixel
    std::span<const PixelSamples> pixels; // instead, if not empty: of each pixel of the film and its twins
    std::uint32_t seed = 0;
    std::uint32_t crop_x = 0, crop_y = 0; // of the film's first pixel within the camera's
    Guiding* guiding = nullptr; // if paths are to be guided, or learned from
    bool provisional = false;   // see Renderer::provisional
    // Called between slices of work (every 10-50 ms); false stops: the film then holds whole waves only.
    std::function<bool()> keep_going;
};

struct TraceStats {
    std::uint64_t rays = 0, shadow_rays = 0, paths = 0;
    double seconds = 0, seconds_shading = 0, seconds_tracing = 0; // wall
    std::map<std::string, std::uint64_t> not_finite;              // samples dropped, by material type
    std::uint64_t dropped = 0; // samples rejected by the film: non-finite, or too large to square. Lights or the sky
    std::size_t shader_bytes = 0; // SPIR-V of all kernels in use
};

// What workers are compiling.
struct CompileProgress {
    std::string what; // a material type, or a part of the tracer
    std::size_t left = 0; // number of things to compile, including `what`
    double seconds = 0; // since `what` was requested
};

class Tracer {
  public:
    virtual ~Tracer() = default;
    virtual const char* name() const = 0;
    virtual const EmbreeScene* embree() const { return nullptr; } // if it finds hits with Embree
    // Updates acceleration structures, and records which shaders the scene now needs.
    virtual Result<void> update(const GpuScene& scene, const SceneChanges& changes) = 0;
    // Whether tracing is as fast as in a scene just opened; settle() makes it so, in the time of building one. It may
    // not be after an update() with few changes.
    virtual bool settled() const { return true; }
    virtual Result<void> settle() { return {}; }
    // Switches to newly compiled shaders. True: the picture differs, the film must restart.
    // Cancels compilation of what the last trace() did not need: undoing an edit cancels its requests.
    virtual bool adopt() = 0;
    // nullopt: the film has no stand-ins.
    virtual std::optional<CompileProgress> compiling() const = 0;
    virtual void film_emptied() = 0; // forgets which stand-ins were seen
    // Adds samples to the film; waits. Shaders are compiled when a path first needs them.
    virtual Result<void> trace(const GpuScene& scene, Film& film, const TraceRequest& request) = 0;
    const TraceStats& stats() const { return stats_; }
    void reset_stats() { stats_ = {.shader_bytes = stats_.shader_bytes}; }

  protected:
    TraceStats stats_;
};

} // namespace restage::render
