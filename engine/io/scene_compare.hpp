// SPDX-License-Identifier: Apache-2.0
// Whether two scenes describe the same picture. Names, ids, order, file locations and splitting of an object into
// single-member groups do not count unless requested; geometry, materials as rendered, places, lights, camera and
// film do.
#pragma once

#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::io {

struct SceneCompareOptions {
    double transform_tolerance = 1e-9; // of the largest entry of the matrix
    std::size_t most = 20; // differences listed
    bool names = false; // names, group nesting and inactive cameras count too
};

// Sentences, empty if the scenes are alike. The registry supplies defaults of unset parameters.
std::vector<std::string> structural_differences(const scene::Scene& a, const scene::Scene& b, const plugin::Registry&,
                                                const SceneCompareOptions& = {});
inline bool structurally_equal(const scene::Scene& a, const scene::Scene& b, const plugin::Registry& registry) {
    return structural_differences(a, b, registry).empty();
}

} // namespace restage::io
