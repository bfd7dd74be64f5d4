// SPDX-License-Identifier: Apache-2.0
#include "render/guiding.hpp"

#include "shared/hash.h"

#include <algorithm>
#include <array>
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
constexpr std::array shares = {0.25f, 0.5f, 0.75f}; // of directions that the guide chooses

} // namespace

void Guiding::begin(scene::Technique technique, std::uint32_t planned, std::size_t pixels) {
    // The second moments of a trial do not tell where guiding pays: directions that it chooses lose the sampler's
    // stratification. So it is never chosen automatically.
    learns_ = technique == scene::Technique::on;
    next_ = first_map;
    last_ = std::clamp(std::bit_floor(std::max(planned / 4, 1u)), first_map, last_map);
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
            const float found = end.x + end.y + end.z - r.radiance, radiance = found / r.throughput;
            if (!(radiance > 0) || !(r.pdf > 0) || !std::isfinite(radiance) || !std::isfinite(r.pdf)) continue;
            records_.push_back(
                {.order = (std::uint64_t(picks[i].pixel) << 32) + (picks[i].sample_index << 4) + r.depth % 16,
                 .position = r.origin,
                 .normal = glm::vec3(glm::unpackSnorm4x8(r.normal)),
                 .direction = r.direction,
                 .radiance = radiance,
                 .pdf = r.pdf,
                 .contribution = std::abs(found)});
        }
    }
}

std::uint32_t Guiding::until_change(std::uint32_t samples) const {
    return learns_ && samples < next_ ? next_ - samples : std::numeric_limits<std::uint32_t>::max();
}

// By the first records, which the BSDF alone has sent: a map of one half of them is tried on the other.
void Guiding::choose_share(Jobs& jobs) {
    std::vector<GuidingRecord> half, other;
    for (const GuidingRecord& r : records_)
        (shared::pcg_hash(std::uint32_t(r.order >> 4) ^ shared::pcg_hash(std::uint32_t(r.order >> 32))) & 1 ? half
                                                                                                            : other)
            .push_back(r);
    if (half.empty() || other.empty()) return;
    const GuidingMap map = GuidingMap::make(half, 0, jobs);
    std::ranges::sort(other, {}, &GuidingRecord::order);
    double least = std::numeric_limits<double>::infinity();
    for (const float share : shares) {
        const double moment = map.relative_moment(other, share);
        if (moment < least) least = moment, share_ = share;
    }
}

Result<void> Guiding::advance(std::uint32_t samples, gpu::Device& device, Jobs& jobs) {
    if (!learns_ || samples < next_) return {};
    if (next_ == first_map) choose_share(jobs);
    next_ *= 2;
    if (next_ > last_) learns_ = false;
    if (records_.empty()) return {};
    const GuidingMap map = GuidingMap::make(records_, share_, jobs);
    RESTAGE_TRY(nodes_, device.create_buffer_of<shared::GuidingNode>(map.nodes, "guiding: nodes"));
    RESTAGE_TRY(leaves_, device.create_buffer_of<shared::GuidingLeaf>(map.leaves, "guiding: leaves"));
    const shared::GuidingData data{nodes_.address(), leaves_.address(), map.depth, 0};
    RESTAGE_TRY(data_, device.create_buffer_of<shared::GuidingData>(std::span(&data, 1), "guiding"));
    address_ = data_.address();
    if (!learns_) records_ = {};
    return {};
}

} // namespace restage::render
