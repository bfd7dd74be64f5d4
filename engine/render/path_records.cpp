// SPDX-License-Identifier: Apache-2.0
#include "render/path_records.hpp"

#include <algorithm>

namespace restage::render {
namespace {
float sum(const glm::vec3& c) { return c.x + c.y + c.z; }
} // namespace

void PathRecords::begin(std::size_t paths) {
    records_.resize(std::max(records_.size(), paths * most));
    count_.assign(paths, 0);
    fresh_.assign(paths, 0);
}

void PathRecords::note(std::span<const std::uint32_t> active, std::span<const shared::PathState> paths,
                       std::span<const shared::RayHit> rays, Jobs& jobs) {
    jobs.parallel_for(active.size(), 4096, [&](std::size_t begin, std::size_t end, unsigned) {
        for (const std::uint32_t i : active.subspan(begin, end - begin)) {
            const shared::PathState& path = paths[i];
            fresh_[i] = 0;
            const std::uint32_t depth = path.flags & PATH_DEPTH_MASK;
            if (!(rays[i].tfar > 0) || (path.flags & PATH_SPECULAR) || count_[i] == most) continue;
            PathRecord* records = &records_[i * most];
            fresh_[i] = 1;
            if (count_[i] && records[count_[i] - 1].depth == depth) continue; // it only passed a lamp
            records[count_[i]++] = {.origin = rays[i].origin,
                                    .direction = rays[i].direction,
                                    .normal = rays[i].receiver,
                                    .pdf = path.pdf,
                                    .throughput = sum(path.throughput),
                                    .radiance = sum(path.radiance),
                                    .depth = depth};
        }
    });
}

void PathRecords::note_light(std::span<const std::uint32_t> met, std::span<const shared::RayHit> rays) {
    for (const std::uint32_t i : met) {
        if (i >= fresh_.size() || !fresh_[i]) continue; // it fills a group, or a mirror or the camera sent its ray
        PathRecord& last = records_[i * most + count_[i] - 1];
        last.light += rays[i].ng.x;
        last.light_pdf = rays[i].ng.y;
    }
}

} // namespace restage::render
