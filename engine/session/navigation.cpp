// SPDX-License-Identifier: Apache-2.0
#include "session/navigation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::session {

namespace {

glm::dvec3 axis(const scene::Camera& camera, int i) { return glm::normalize(glm::dvec3(camera.camera_to_world[i])); }
glm::dvec3 position(const scene::Camera& camera) { return glm::dvec3(camera.camera_to_world[3]); }

// The turn asked for, kept 1 degree away from looking along `up`.
glm::dmat4 turn(const scene::Camera& camera, const glm::dvec3& up, glm::dvec2 angles) {
    const glm::dvec3 right = axis(camera, 0), forward = axis(camera, 2);
    const double limit = glm::radians(89.0);
    const double elevation = std::asin(std::clamp(glm::dot(forward, up), -1.0, 1.0));
    // A right-handed turn about x lifts the view of a right-handed frame downwards and of a mirrored one upwards.
    const double sense = glm::dot(glm::cross(axis(camera, 1), forward), right) > 0 ? -1 : 1;
    const double wanted = std::clamp(elevation + angles.y, std::min(-limit, elevation), std::max(limit, elevation));
    const glm::dmat4 tilt = glm::rotate(glm::dmat4(1), sense * (wanted - elevation), right);
    return glm::rotate(glm::dmat4(1), angles.x, up) * tilt;
}

} // namespace

glm::dvec3 guess_up(const scene::Camera& camera) {
    const glm::dvec3 up = axis(camera, 1);
    int best = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(up[i]) > std::abs(up[best])) best = i;
    glm::dvec3 result(0);
    result[best] = up[best] < 0 ? -1 : 1;
    return result;
}

void orbit(scene::Camera& camera, const glm::dvec3& pivot, const glm::dvec3& up, glm::dvec2 angles) {
    camera.camera_to_world = glm::translate(glm::dmat4(1), pivot) * turn(camera, up, angles) *
                             glm::translate(glm::dmat4(1), -pivot) * camera.camera_to_world;
}

void look(scene::Camera& camera, const glm::dvec3& up, glm::dvec2 angles) {
    orbit(camera, position(camera), up, angles);
}

void translate_local(scene::Camera& camera, const glm::dvec3& by) {
    camera.camera_to_world[3] +=
        glm::dvec4(axis(camera, 0) * by.x + axis(camera, 1) * by.y + axis(camera, 2) * by.z, 0);
}

glm::dvec4 film_window(const scene::Camera& camera, double aspect) {
    if (camera.frame_aspect > 0) aspect = camera.frame_aspect;
    glm::dvec4 window = aspect > 1 ? glm::dvec4(-aspect, aspect, -1, 1) : glm::dvec4(-1, 1, -1 / aspect, 1 / aspect);
    if (camera.screen_window) window = *camera.screen_window;
    return window * std::tan(glm::radians(double(camera.fov)) / 2);
}

void pan(scene::Camera& camera, glm::dvec2 delta, double distance, double aspect) {
    const glm::dvec4 window = film_window(camera, aspect);
    const double per_height = (window.w - window.z) * distance; // world units the height of the film spans there
    translate_local(camera, {-delta.x * per_height, delta.y * per_height, 0});
}

void dolly(scene::Camera& camera, const glm::dvec3& towards, double part) {
    camera.camera_to_world[3] += glm::dvec4((towards - position(camera)) * part, 0);
}

void frame(scene::Camera& camera, const scene::Bounds& bounds, double aspect) {
    if (bounds.empty()) return;
    const glm::dvec4 window = film_window(camera, aspect);
    const double half = std::min(window.y - window.x, window.w - window.z) / 2;
    const double radius = std::max(bounds.radius(), 1e-9);
    const double distance = radius / std::sin(std::atan(half));
    camera.camera_to_world[3] = glm::dvec4(bounds.center() - axis(camera, 2) * distance, 1);
}

ViewRay view_ray(const scene::Camera& camera, glm::dvec2 film, double aspect) {
    const glm::dvec4 window = film_window(camera, aspect);
    const glm::dvec3 local(glm::mix(window.x, window.y, film.x), glm::mix(window.w, window.z, film.y), 1);
    return {position(camera), glm::dvec3(camera.camera_to_world * glm::dvec4(local, 0))};
}

glm::dvec3 project(const scene::Camera& camera, const glm::dvec3& world, double aspect) {
    const glm::dvec3 local(glm::affineInverse(camera.camera_to_world) * glm::dvec4(world, 1));
    const glm::dvec4 window = film_window(camera, aspect);
    const glm::dvec2 p = glm::dvec2(local) / local.z;
    return {(p.x - window.x) / (window.y - window.x), (window.w - p.y) / (window.w - window.z), local.z};
}

} // namespace restage::session
