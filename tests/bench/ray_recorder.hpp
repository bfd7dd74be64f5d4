// SPDX-License-Identifier: Apache-2.0
// Records every ray the engine passes to Embree, in the order of each thread, so that the same rays can be retraced
// without the engine. The linker inserts it between the two (see CMakeLists.txt): the engine is unaware of it.
#pragma once

#include "base/jobs.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace restage::bench {

struct RecordedRay { // 36 bytes
    glm::vec3 origin;
    float tnear;
    glm::vec3 direction;
    float tfar;
    bool shadow;
};

void start_recording();
std::vector<RecordedRay> stop_recording(); // threads one after the other

// Traces them in a plain loop over rtcIntersect1 and rtcOccluded1, against the scene they were recorded on.
// Returns the number of hits.
std::uint64_t trace_plainly(const std::vector<RecordedRay>& rays, Jobs& jobs);

} // namespace restage::bench
