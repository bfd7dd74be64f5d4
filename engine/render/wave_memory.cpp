// SPDX-License-Identifier: Apache-2.0
#include "render/wave_memory.hpp"

#include <algorithm>
#include <cstring>

namespace restage::render {

Result<void> WaveMemory::create(gpu::Device& device) {
    const auto create = [&](gpu::Buffer& buffer, std::size_t bytes, const char* name) -> Result<void> {
        RESTAGE_TRY(buffer, device.create_buffer(bytes, gpu::BufferKind::readback, name)); // both sides read and write
        return {};
    };
    RESTAGE_CHECK(create(ray_buffer, all_paths * sizeof(shared::RayHit), "rays"));
    RESTAGE_CHECK(create(shadow_buffer, all_paths * sizeof(shared::ShadowRay), "shadow rays"));
    RESTAGE_CHECK(create(path_buffer, all_paths * sizeof(shared::PathState), "paths"));
    RESTAGE_CHECK(create(guide_buffer, all_paths * sizeof(shared::GuideSample), "guide samples"));
    RESTAGE_CHECK(create(queue_buffer, (most_paths + all_paths) * sizeof(std::uint32_t), "queue"));
    RESTAGE_CHECK(create(counters, COUNTER_COUNT * sizeof(std::uint32_t), "counters"));
    RESTAGE_CHECK(create(picks, most_paths * sizeof(shared::SamplePick), "samples"));
    RESTAGE_CHECK(create(runs, most_paths * sizeof(shared::SampleRun), "runs of samples"));
    std::memset(counters.mapped(), 0, counters.size());
    std::memset(ray_buffer.mapped(), 0, ray_buffer.size()); // for fields kernels never write
    std::memset(shadow_buffer.mapped(), 0, shadow_buffer.size());
    for (auto& ray : rays())
        ray.mask = ~0u;
    for (auto& shadow : shadows())
        shadow.mask = ~0u;
    return {};
}

Result<void> WaveMemory::create_fourths(gpu::Device& device) {
    if (fourth_buffer) return {};
    RESTAGE_TRY(fourth_buffer, device.create_buffer(all_paths * sizeof(shared::FourthData), gpu::BufferKind::readback,
                                                    "fourth wavelengths"));
    return {};
}

std::uint64_t WaveMemory::place(const SamplePlan& plan) {
    const std::size_t count = plan.picks().size();
    auto to = picks.span<shared::SamplePick>();
    std::ranges::copy(plan.picks(), to.begin());
    std::fill(to.begin() + std::ptrdiff_t(count), to.begin() + std::ptrdiff_t(whole_groups(std::uint32_t(count))),
              plan.picks().back());
    std::ranges::copy(plan.runs(), runs.span<shared::SampleRun>().begin());
    return picks.address();
}

} // namespace restage::render
