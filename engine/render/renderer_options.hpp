// SPDX-License-Identifier: Apache-2.0
// How a Renderer is opened. Without Vulkan: for those who only pass it on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace restage::gpu {
struct DeviceFault;
}

namespace restage::render {

// How light is sampled; the last two are there for tests of the first.
enum class Strategy : std::uint32_t { mis = 0, light_only = 1, bsdf_only = 2 };

struct RendererOptions {
    std::string device;            // index or part of a name; empty = the best
    std::string tracer;            // a name of tracers.hpp; empty = by device: vulkan on GPUs with ray tracing
    bool validation = false;
    unsigned threads = 0;          // for Embree; 0 = all
    std::uint32_t seed = 0;
    Strategy strategy = Strategy::mis;
    // False: trace() waits until what it needs is compiled. True (for an editor): it does not; meanwhile a material
    // looks as it did before it changed, or, being new, like a diffuse one of its colour. See Renderer::compiling().
    bool stand_ins = false;
    std::filesystem::path shader_dir; // empty = <program>/../share/restage/shaders
    std::filesystem::path cache_dir; // empty = base's cache_dir()
    std::shared_ptr<gpu::DeviceFault> fault; // for tests, see gpu::DeviceFault
};

} // namespace restage::render
