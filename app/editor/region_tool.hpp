// SPDX-License-Identifier: Apache-2.0
// The render region: a rectangle of the picture that alone is refined, until it is closed or the view changes.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace restage::editor {

struct RenderRegion {
    bool choosing = false; // the next drag in the picture draws it
    std::optional<glm::dvec2> from; // where that drag began [picture coordinates]
    std::optional<glm::vec4> area; // x0 x1 y0 y1 in [0,1], as Film::crop
    std::uint64_t document = 0; // it is of, seen from `camera`
    scene::Camera camera;

    bool active() const { return choosing || area; }
    void end() { *this = {}; }
};

} // namespace restage::editor
