// SPDX-License-Identifier: Apache-2.0
// WaveMemory: the records of a wave's paths, where kernels and the CPU pass between them both read and write.
#pragma once

#include "gpu/device.hpp"
#include "render/sample_plan.hpp"
#include "render/wave_kernels.hpp"
#include "shared/path_data.h"
#include "shared/wave_data.h"

#include <cstdint>
#include <span>

namespace restage::render {

struct WaveMemory {
    static constexpr std::uint32_t most_paths = WAVE_PATHS;
    static constexpr std::uint32_t group_size = 64; // of the kernels
    // Shading types of a path: those of materials, and pseudo types.
    static constexpr std::uint8_t type_emit = WaveKernels::emit, type_escape = WaveKernels::escape,
                                  type_none = 255; // no kernel
    // Kernels over paths run whole groups, without a test of the number of paths: on lavapipe everything behind such a
    // test is masked, and a masked load is a branch per lane. A queue's last group is filled with copies of a path of
    // the same type.
    static constexpr std::uint32_t spare_paths = (type_escape + 1) * group_size;
    static constexpr std::uint32_t all_paths = most_paths + spare_paths;
    static constexpr std::uint32_t groups(std::uint32_t n) { return (n + group_size - 1) / group_size; }
    static constexpr std::uint32_t whole_groups(std::uint32_t n) { return groups(n) * group_size; }

    Result<void> create(gpu::Device&);
    Result<void> create_fourths(gpu::Device&); // for spectral scenes, unless they exist

    std::span<shared::RayHit> rays() { return ray_buffer.span<shared::RayHit>(); }
    std::span<shared::ShadowRay> shadows() { return shadow_buffer.span<shared::ShadowRay>(); }
    std::span<shared::PathState> paths() { return path_buffer.span<shared::PathState>(); }
    std::span<shared::FourthData> fourths() { return fourth_buffer.span<shared::FourthData>(); }
    std::span<std::uint32_t> queue() { return queue_buffer.span<std::uint32_t>(); }

    // Writes the plan's wave for the kernels, in whole groups. The address of its samples.
    std::uint64_t place(const SamplePlan&);

    gpu::Buffer ray_buffer, shadow_buffer, path_buffer, fourth_buffer, guide_buffer; // by path
    gpu::Buffer queue_buffer, counters, picks, runs;
};

} // namespace restage::render
