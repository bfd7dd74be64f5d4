// SPDX-License-Identifier: Apache-2.0
#include "scene/projection.hpp"

#include <algorithm>
#include <cmath>

namespace restage::scene {

glm::dvec4 film_window(const Camera& camera, double aspect) {
    if (camera.frame_aspect > 0) aspect = camera.frame_aspect;
    const double half =
        camera.projection == scene::Projection::orthographic ? 1.0 : std::tan(glm::radians(double(camera.fov)) / 2);
    if (camera.screen_window) return glm::dvec4(*camera.screen_window) * half;
    double height = aspect > 1 ? half : half / aspect;
    if (const double fit = camera.fit_aspect; fit > 0 && !(camera.frame_aspect > 0)) {
        const double frame_height = fit > 1 ? half : half / fit;
        height = std::max(frame_height, frame_height * fit / aspect);
    }
    return {-height * aspect, height * aspect, -height, height};
}

glm::uvec4 crop_window(const Film& f) {
    const auto pixel = [](float x, std::uint32_t n) {
        return std::uint32_t(std::clamp(std::ceil(x * float(n)), 0.f, float(n)));
    };
    return {pixel(f.crop.x, f.width), pixel(f.crop.y, f.width), pixel(f.crop.z, f.height), pixel(f.crop.w, f.height)};
}

double camera_fov(const Camera& camera, double aspect) {
    if (!(camera.fit_aspect > 0) || camera.screen_window || camera.frame_aspect > 0 ||
        camera.projection != scene::Projection::perspective)
        return double(camera.fov);
    const glm::dvec4 window = film_window(camera, aspect);
    return glm::degrees(2 * std::atan(std::min(window.y, window.w)));
}

} // namespace restage::scene
