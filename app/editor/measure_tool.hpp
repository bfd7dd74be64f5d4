// SPDX-License-Identifier: Apache-2.0
// The measure tool: two clicks on surfaces, and the distance between them stays shown until Esc.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace restage::editor {

struct Measurement {
    bool on = false;
    std::vector<glm::dvec3> points; // world space; at most two, a third click begins again
};

} // namespace restage::editor
