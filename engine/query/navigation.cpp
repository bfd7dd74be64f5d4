// SPDX-License-Identifier: Apache-2.0
#include "query/navigation.hpp"

#include "scene/projection.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <utility>

namespace restage::query {

namespace {

constexpr double pi = std::numbers::pi;

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

// In the matrix, which a view that has left the scene's camera has of its own, and not in the screen window.
void scale_film(scene::Camera& camera, double by) {
    camera.camera_to_world[0] *= by;
    camera.camera_to_world[1] *= by;
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

void pan(scene::Camera& camera, glm::dvec2 delta, double distance, double aspect) {
    const glm::dvec4 window = film_window(camera, aspect);
    if (camera.projection == scene::Projection::orthographic)
        distance = glm::length(glm::dvec3(camera.camera_to_world[1]));
    const double per_height = (window.w - window.z) * distance; // world units the height of the film spans there
    translate_local(camera, {-delta.x * per_height, delta.y * per_height, 0});
}

void dolly(scene::Camera& camera, const glm::dvec3& towards, double part) {
    glm::dvec3 way = (towards - position(camera)) * part;
    if (camera.projection ==
        scene::Projection::orthographic) { // nearer is no larger: the film shrinks around the point
        scale_film(camera, 1 - part);
        way -= axis(camera, 2) * glm::dot(way, axis(camera, 2));
    }
    camera.camera_to_world[3] += glm::dvec4(way, 0);
}

void frame(scene::Camera& camera, const scene::Bounds& bounds, double aspect) {
    if (bounds.empty()) return;
    const glm::dvec4 window = film_window(camera, aspect);
    const double half = std::min(window.y - window.x, window.w - window.z) / 2;
    const double radius = std::max(bounds.radius(), 1e-9);
    double distance = radius / std::sin(std::atan(half));
    if (camera.projection == scene::Projection::orthographic) {
        const double unit = glm::length(glm::dvec3(camera.camera_to_world[1]));
        scale_film(camera, radius / (half * unit));
        distance = 2 * radius;
    } else if (is_spherical(camera)) { // sees all around: from the middle
        distance = 0;
    }
    camera.camera_to_world[3] = glm::dvec4(bounds.center() - axis(camera, 2) * distance, 1);
}

namespace {

// Clarberg 2008; pbrt 4ed, 3.8.3; as shaders/lib/octahedral.glsl.
glm::dvec3 octahedral_direction(glm::dvec2 p) {
    const glm::dvec2 uv = 2.0 * p - 1.0;
    const double d = 1 - (std::abs(uv.x) + std::abs(uv.y)), r = 1 - std::abs(d);
    const double phi = (r == 0 ? 1 : (std::abs(uv.y) - std::abs(uv.x)) / r + 1) * (pi / 4);
    const double s = r * std::sqrt(std::max(0.0, 2 - r * r));
    return {std::copysign(std::cos(phi) * s, uv.x), std::copysign(std::sin(phi) * s, uv.y),
            std::copysign(1 - r * r, d)};
}
glm::dvec2 octahedral_point(const glm::dvec3& w) {
    const double r = std::sqrt(std::max(0.0, 1 - std::abs(w.z)));
    double v = std::atan2(std::abs(w.y), std::abs(w.x)) * (2 / pi) * r, u = r - v;
    if (w.z < 0) u = std::exchange(v, 1 - u), u = 1 - u;
    return 0.5 * (glm::dvec2(std::copysign(u, w.x), std::copysign(v, w.y)) + 1.0);
}

} // namespace

ViewRay view_ray(const scene::Camera& camera, glm::dvec2 film, double aspect) {
    const glm::dvec4 window = film_window(camera, aspect);
    glm::dvec3 from(0), local(glm::mix(window.x, window.y, film.x), glm::mix(window.w, window.z, film.y), 1);
    if (camera.projection == scene::Projection::orthographic) {
        from = {local.x, local.y, 0};
        local = {0, 0, 1};
    } else if (camera.projection == scene::Projection::spherical) {
        const double theta = film.y * pi, phi = film.x * 2 * pi;
        local = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
    } else if (camera.projection == scene::Projection::spherical_equal_area) {
        const glm::dvec3 w = octahedral_direction(film);
        local = {w.x, w.z, w.y};
    }
    return {glm::dvec3(camera.camera_to_world * glm::dvec4(from, 1)),
            glm::dvec3(camera.camera_to_world * glm::dvec4(local, 0))};
}

glm::dvec3 project(const scene::Camera& camera, const glm::dvec3& world, double aspect) {
    const glm::dvec3 local(glm::affineInverse(camera.camera_to_world) * glm::dvec4(world, 1));
    const double away = glm::length(local);
    if (camera.projection == scene::Projection::spherical) {
        const double phi = std::atan2(local.z, local.x);
        return {(phi < 0 ? phi + 2 * pi : phi) / (2 * pi), std::atan2(std::hypot(local.x, local.z), local.y) / pi,
                away};
    }
    if (camera.projection == scene::Projection::spherical_equal_area) {
        if (!(away > 0)) return {0.5, 0.5, 0};
        return {octahedral_point(glm::dvec3(local.x, local.z, local.y) / away), away};
    }
    const glm::dvec4 window = film_window(camera, aspect);
    const glm::dvec2 p =
        camera.projection == scene::Projection::orthographic ? glm::dvec2(local) : glm::dvec2(local) / local.z;
    return {(p.x - window.x) / (window.y - window.x), (window.w - p.y) / (window.w - window.z), local.z};
}

} // namespace restage::query
