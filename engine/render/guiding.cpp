// SPDX-License-Identifier: Apache-2.0
#include "render/guiding.hpp"

#include "shared/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

namespace restage::render {
namespace {

constexpr std::uint32_t first_map = 4; // samples per pixel; the next maps at twice as many each
constexpr std::uint32_t last_map = 32;
constexpr double most_records = 1 << 20; // about
constexpr double records_per_path = 3;

} // namespace

void Guiding::begin(scene::Technique technique, std::uint32_t planned, std::size_t pixels) {
    // The second moments of a trial do not tell where guiding pays: directions that it chooses lose the sampler's
    // stratification. So it is never chosen automatically.
    learns_ = technique == scene::Technique::on;
    next_ = first_map;
    last_ = std::clamp(std::bit_floor(std::max(planned / 2, 1u)), first_map, last_map);
    const double expected = double(pixels) * last_ * records_per_path;
    kept_ = std::uint32_t(std::min(most_records / expected, 1.0) * 4294967295.0);
    records_ = {};
    address_ = 0;
}

bool Guiding::wants(std::uint64_t path) const {
    return shared::pcg_hash(std::uint32_t(path) ^ shared::pcg_hash(std::uint32_t(path >> 32))) <= kept_;
}

void Guiding::add(const PathRecords& records, std::span<const shared::SamplePick> picks,
                  std::span<const shared::PathState> paths) {
    for (std::size_t i = 0; i < picks.size(); ++i) {
        const std::uint64_t path = (std::uint64_t(picks[i].pixel) << 32) + picks[i].sample_index;
        if (!wants(path)) continue;
        const glm::vec3 end = paths[i].radiance;
        for (const PathRecord& r : records.of(i)) {
            // Radiance has gained the light that the ray met with its weight beside light sampling (step.glsl).
            const float ratio = r.light_pdf / r.pdf, met = r.light / (1 + ratio * ratio);
            const float found = std::max((end.x + end.y + end.z - r.radiance - met) / r.throughput, 0.f);
            const float light = std::max(r.light / r.throughput, 0.f);
            if (!(r.pdf > 0) || !std::isfinite(found) || !std::isfinite(light) || !std::isfinite(r.pdf)) continue;
            records_.push_back(
                {.order = (std::uint64_t(picks[i].pixel) << 32) + (picks[i].sample_index << 4) + r.depth % 16,
                 .position = r.origin,
                 .normal = glm::vec3(glm::unpackSnorm4x8(r.normal)),
                 .direction = r.direction,
                 .radiance = r.light_pdf > 0 ? found : found + light,
                 .light = r.light_pdf > 0 ? light : 0,
                 .light_pdf = r.light_pdf,
                 .pdf = r.pdf});
        }
    }
}

std::uint32_t Guiding::until_change(std::uint32_t samples) const {
    return learns_ && samples < next_ ? next_ - samples : std::numeric_limits<std::uint32_t>::max();
}

Result<void> Guiding::advance(std::uint32_t samples, gpu::Device& device, Jobs& jobs) {
    if (!learns_ || samples < next_) return {};
    next_ *= 2;
    if (next_ > last_) learns_ = false;
    if (records_.empty()) return {};
    const GuidingMap map = GuidingMap::make(records_, jobs);
    RESTAGE_TRY(nodes_, device.create_buffer_of<shared::GuidingNode>(map.nodes, "guiding: nodes"));
    RESTAGE_TRY(leaves_, device.create_buffer_of<shared::GuidingLeaf>(map.leaves, "guiding: leaves"));
    const shared::GuidingData data{nodes_.address(), leaves_.address(), map.depth, 0};
    RESTAGE_TRY(data_, device.create_buffer_of<shared::GuidingData>(std::span(&data, 1), "guiding"));
    address_ = data_.address();
    if (!learns_) records_ = {};
    return {};
}

} // namespace restage::render
