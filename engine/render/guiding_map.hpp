// SPDX-License-Identifier: Apache-2.0
// GuidingMap: from where light arrives, learned from paths. A kd-tree over places and normals of their vertices, and
// in each leaf a histogram over the sphere. Mueller et al. 2017, "Practical Path Guiding for Efficient Light-Transport
// Simulation"; in proportion to the root of the second moment: Rath et al. 2020, "Variance-Aware Path Guiding".
#pragma once

#include "base/jobs.hpp"
#include "shared/guiding_data.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace restage::render {

// A vertex of a path, and the light that the path then found.
struct GuidingRecord {
    std::uint64_t order = 0; // of the path and its vertex: no two records have the same
    glm::vec3 position{0}; // world space of the kernels
    glm::vec3 normal{0}; // about unit
    glm::vec3 direction{0}; // unit, towards the light
    float radiance = 0; // that arrived [0, inf), sum of the colours; without:
    float light = 0; // of lamps and the sky along this very ray, not weighted [0, inf)
    float light_pdf = 0; // with which light sampling finds that, per solid angle; 0: it does not
    float pdf = 0; // with which the direction was chosen, per solid angle; above 0
};

struct GuidingMap {
    std::uint32_t depth = 0;
    std::vector<shared::GuidingNode> nodes;
    std::vector<shared::GuidingLeaf> leaves;

    // Sorts the records; the result depends on the set of them alone.
    static GuidingMap make(std::vector<GuidingRecord>& records, Jobs& jobs);

    // As shaders/lib/guiding.glsl.
    std::uint32_t leaf_of(const glm::vec3& p, const glm::vec3& normal) const;
    float density(std::uint32_t leaf, const glm::vec3& w) const; // per solid angle
};

} // namespace restage::render
