// SPDX-License-Identifier: Apache-2.0
// Do two scenes mean the same picture? Names, ids, the order of things, where files are and how an object is split into
// groups of one do not count unless asked for; geometry, materials as a renderer sees them, places, lights, camera and
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
    bool names = false; // what things are called, how groups nest and which cameras wait count too
};

// Sentences, none when the scenes are alike. The registry gives the defaults of parameters that are not set.
std::vector<std::string> structural_differences(const scene::Scene& a, const scene::Scene& b, const plugin::Registry&,
                                                const SceneCompareOptions& = {});
inline bool structurally_equal(const scene::Scene& a, const scene::Scene& b, const plugin::Registry& registry) {
    return structural_differences(a, b, registry).empty();
}

} // namespace restage::io
