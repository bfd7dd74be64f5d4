// SPDX-License-Identifier: Apache-2.0
// PathRecords: the scattered rays of the paths of a wave. When the paths have ended, what each ray brought is the
// radiance that its path has gained since.
#pragma once

#include "base/jobs.hpp"
#include "shared/path_data.h"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::render {

struct PathRecord {
    glm::vec3 origin{0}, direction{0};
    std::uint32_t normal = 0; // receiver_bits of its vertex
    float pdf = 0;
    float throughput = 0, radiance = 0; // of the path when the ray left, sums of the colours; radiance: with its lamps
    std::uint32_t depth = 0; // vertices before it
    float light = 0, light_pdf = 0; // that it met, with its whole weight; and with which light sampling finds that
};

class PathRecords {
  public:
    static constexpr std::uint32_t most = 8; // per path

    void begin(std::size_t paths);
    // The rays of these paths, after the shadow rays of their vertices. A ray that a mirror or the camera sends is left
    // out.
    void note(std::span<const std::uint32_t> active, std::span<const shared::PathState> paths,
              std::span<const shared::RayHit> rays, Jobs& jobs);
    // Light that the last ray of these paths met, after the kernels that add it.
    void note_light(std::span<const std::uint32_t> met, std::span<const shared::RayHit> rays);
    std::span<const PathRecord> of(std::size_t path) const { return {&records_[path * most], count_[path]}; }

  private:
    std::vector<PathRecord> records_;
    std::vector<std::uint8_t> count_;
    std::vector<std::uint8_t> fresh_; // whether the last record is of the ray traced last
};

} // namespace restage::render
