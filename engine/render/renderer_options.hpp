// SPDX-License-Identifier: Apache-2.0
// Options for opening a Renderer. Free of Vulkan, for code that only passes them on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace restage::gpu {
struct DeviceFault;
}

namespace restage::render {

// How light is sampled; the last two exist to test the first.
enum class Strategy : std::uint32_t { mis = 0, light_only = 1, bsdf_only = 2 };

struct RendererOptions {
    std::string device;            // index or part of a name; empty = the best
    std::string tracer;            // a name of tracers.hpp; empty = by device: vulkan on GPUs with ray tracing
    bool validation = false;
    unsigned threads = 0;          // for Embree; 0 = all
    std::uint32_t seed = 0;
    Strategy strategy = Strategy::mis;
    // False: trace() waits for compilation. True (for an editor): it does not; meanwhile a material
    // looks as before its change or, if new, like a diffuse one of its colour. See Renderer::compiling().
    bool stand_ins = false;
    bool all_features = false; // the embree tracer's shaders keep what the scene lacks, to measure what that saves
    std::filesystem::path shader_dir; // empty = <program>/../share/restage/shaders
    std::filesystem::path cache_dir; // empty = base's cache_dir()
    std::shared_ptr<gpu::DeviceFault> fault; // for tests, see gpu::DeviceFault
};

} // namespace restage::render
