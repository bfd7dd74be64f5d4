// SPDX-License-Identifier: Apache-2.0
#include "scene/projection.hpp"

#include <cmath>

namespace restage::scene {

glm::dvec4 film_window(const Camera& camera, double aspect) {
    if (camera.frame_aspect > 0) aspect = camera.frame_aspect;
    glm::dvec4 window = aspect > 1 ? glm::dvec4(-aspect, aspect, -1, 1) : glm::dvec4(-1, 1, -1 / aspect, 1 / aspect);
    if (camera.screen_window) window = *camera.screen_window;
    if (camera.projection == RESTAGE_ORTHOGRAPHIC) return window;
    return window * std::tan(glm::radians(double(camera.fov)) / 2);
}

} // namespace restage::scene
