// SPDX-License-Identifier: Apache-2.0
// A direct implementation with only Embree and C++, for the room's three materials: one path after the other, no
// wavefront, no shaders. The same estimator as the engine's (light sampling and BSDF sampling with the power heuristic,
// Russian roulette), so about the same rays; numbers are pseudo-random. For comparison, not a renderer.
#pragma once

#include "base/jobs.hpp"
#include "scene/scene.hpp"

#include <memory>

namespace restage::bench {

struct PlainResult {
    std::uint64_t rays = 0, shadow_rays = 0;
    double mean_luminance = 0;
};

class PlainTracer {
  public:
    explicit PlainTracer(
        const scene::Scene&); // diffuse, conductor (GGX, alpha as it is), dielectric (smooth); area lights
    ~PlainTracer();
    PlainResult trace(std::uint32_t samples, Jobs& jobs) const;

  private:
    struct Data;
    std::unique_ptr<Data> d_;
};

} // namespace restage::bench
