// SPDX-License-Identifier: Apache-2.0
#include "query/navigation.hpp"

#include "scene/projection.hpp"
#include "shared/octahedral.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace restage::query {

namespace {

constexpr double pi = std::numbers::pi;

glm::dvec3 axis(const scene::Camera& camera, int i) { return glm::normalize(glm::dvec3(camera.camera_to_world[i])); }
glm::dvec3 position(const scene::Camera& camera) { return glm::dvec3(camera.camera_to_world[3]); }

// The requested rotation, kept 1 degree away from looking along `up`.
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

// In the matrix, which a view detached from the scene's camera owns, and not in the screen window.
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
    const double per_height = (window.w - window.z) * distance; // world units spanned by the film's height there
    translate_local(camera, {-delta.x * per_height, delta.y * per_height, 0});
}

void dolly(scene::Camera& camera, const glm::dvec3& towards, double part) {
    glm::dvec3 way = (towards - position(camera)) * part;
    if (camera.projection ==
        scene::Projection::orthographic) { // distance does not affect size: shrink the film around the point
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
    } else if (is_spherical(camera)) { // sees all directions: go to the centre
        distance = 0;
    }
    camera.camera_to_world[3] = glm::dvec4(bounds.center() - axis(camera, 2) * distance, 1);
}

void look_along(scene::Camera& camera, const glm::dvec3& pivot, const glm::dvec3& from, const glm::dvec3& up) {
    const glm::dvec3 forward = -from, was = axis(camera, 2) + axis(camera, 1);
    glm::dvec3 top = up;
    if (std::abs(glm::dot(forward, up)) > 0.999) {
        int best = -1; // the axis across the view that is nearest to where the camera looked
        for (int i = 0; i < 3; ++i)
            if (std::abs(forward[i]) < 0.5 && (best < 0 || std::abs(was[i]) > std::abs(was[best]))) best = i;
        top = glm::dvec3(0);
        top[best] = was[best] < 0 ? -1 : 1;
    }
    glm::dmat4& m = camera.camera_to_world;
    const bool mirrored = glm::determinant(glm::dmat3(m)) < 0;
    const double distance = std::max(glm::length(position(camera) - pivot), 1e-6);
    const glm::dvec3 right = glm::normalize(glm::cross(top, forward)) * (mirrored ? -1.0 : 1.0);
    const glm::dvec3 axes[] = {right, glm::normalize(top - forward * glm::dot(top, forward)), forward};
    for (int i = 0; i < 3; ++i)
        m[i] = glm::dvec4(axes[i] * glm::length(glm::dvec3(m[i])), 0);
    m[3] = glm::dvec4(pivot + from * distance, 1);
}

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
        const glm::dvec3 w = shared::octahedral_to_direction(film);
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
        return {shared::direction_to_octahedral(glm::dvec3(local.x, local.z, local.y) / away), away};
    }
    const glm::dvec4 window = film_window(camera, aspect);
    const glm::dvec2 p =
        camera.projection == scene::Projection::orthographic ? glm::dvec2(local) : glm::dvec2(local) / local.z;
    return {(p.x - window.x) / (window.y - window.x), (window.w - p.y) / (window.w - window.z), local.z};
}

} // namespace restage::query
