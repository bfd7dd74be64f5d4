// SPDX-License-Identifier: Apache-2.0
// Builds pipelines on worker threads while other work runs, from GLSL to one whose first dispatch does not stall.
// A CPU driver (lavapipe) compiles at the first dispatch, on the queue where everything else waits. So a worker
// first creates the pipeline on a separate Vulkan device and dispatches nothing with it: the code is stored in the
// driver's disk cache, and the main device only loads it.
#pragma once

#include "base/crash_note.hpp"
#include "base/result.hpp"
#include "gpu/compiler.hpp"
#include "gpu/pipeline.hpp"

#include <future>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

namespace restage::gpu {

struct ComputeRequest {
    ShaderSource shader;
    std::uint32_t push_constant_bytes = 0;
    std::vector<SpecConstant> constants;
    std::string name;
    Blame blame = {}; // for crash notes while this is built
    std::stop_token stop; // checked between steps; a step in progress (a second or two at worst) completes first
};

struct RayTracingRequest {
    static constexpr std::size_t none = ~std::size_t{0};
    struct Group {
        std::size_t closest_hit = none, any_hit = none, intersection = none; // indices into shaders
    };
    std::vector<ShaderSource> shaders; // each is compiled once, however many groups use it
    std::size_t raygen = 0;
    std::vector<std::size_t> misses;
    std::vector<Group> hit_groups;
    std::vector<std::size_t> callables;
    std::vector<std::vector<SpecConstant>> callable_constants; // see RayTracingShaders
    std::uint32_t push_constant_bytes = 0;
    std::vector<SpecConstant> constants;
    std::string name;
    Blame blame = {};
    std::stop_token stop;
};

// [any] thread. The device and the compiler outlive it. Requests are started in order.
class PipelineBuilder {
  public:
    // Measured on lavapipe with six composed kernels and cold caches: other work waits 9-14 ms at most with `avoid`,
    // up to 3 s with `allow`, which takes a quarter less time in total: for commands that show nothing
    // meanwhile.
    enum class Stalls { avoid, allow };
    PipelineBuilder(Device& device, const ShaderCompiler& compiler, unsigned threads = 2,
                    Stalls stalls = Stalls::avoid);
    ~PipelineBuilder(); // finishes started requests; the others end in an error
    PipelineBuilder(const PipelineBuilder&) = delete;
    PipelineBuilder& operator=(const PipelineBuilder&) = delete;

    std::future<Result<ComputePipeline>> build(ComputeRequest request);
    std::future<Result<RayTracingPipeline>> build(RayTracingRequest request);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::gpu
