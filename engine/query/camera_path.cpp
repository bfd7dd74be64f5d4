// SPDX-License-Identifier: Apache-2.0
#include "query/camera_path.hpp"

#include "query/navigation.hpp"
#include "scene/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace restage::query {

namespace {

struct Place {
    glm::dvec3 position;
    glm::dquat rotation;
    glm::dvec3 scale; // of its axes; x < 0: mirrored
    bool turned_over = false; // it was mirrored otherwise
};

Place place_of(const glm::dmat4& to_world) {
    glm::dmat3 axes(to_world);
    glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    if (glm::determinant(axes) < 0) scale.x = -scale.x;
    for (int i = 0; i < 3; ++i)
        axes[i] /= scale[i];
    return {.position = glm::dvec3(to_world[3]), .rotation = glm::quat_cast(axes), .scale = scale};
}

glm::dmat4 matrix_of(const Place& place) {
    glm::dmat4 m(glm::mat3_cast(glm::normalize(place.rotation)));
    for (int i = 0; i < 3; ++i)
        m[i] *= place.scale[i];
    m[3] = glm::dvec4(place.position, 1);
    return m;
}

// Between b (t = 0) and c (t = 1).
glm::dvec3 catmull_rom(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d, double t) {
    return 0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t) +
                  (3.0 * (b - c) + d - a) * (t * t * t));
}

} // namespace

scene::Camera turned(const scene::Scene& scene, const scene::Camera& camera, double degrees) {
    const scene::Bounds bounds = scene::world_bounds(scene);
    scene::Camera result = camera;
    if (bounds.empty() || degrees == 0) return result;
    const glm::dvec3 eye(camera.camera_to_world[3]), ahead = glm::normalize(glm::dvec3(camera.camera_to_world[2]));
    const double distance = glm::dot(bounds.center() - eye, ahead);
    const glm::dvec3 center = distance > 0 ? eye + distance * ahead : bounds.center();
    const glm::dmat4 turn =
        glm::rotate(glm::translate(glm::dmat4(1), center), glm::radians(degrees), glm::normalize(guess_up(camera)));
    result.camera_to_world = turn * glm::translate(glm::dmat4(1), -center) * camera.camera_to_world;
    return result;
}

std::vector<scene::Camera> camera_path(std::span<const scene::Camera> through, std::uint32_t frames) {
    std::vector<scene::Camera> path;
    if (through.empty()) return path;
    std::vector<Place> places;
    for (const scene::Camera& camera : through) {
        places.push_back(place_of(camera.camera_to_world));
        Place& place = places.back();
        place.turned_over = std::signbit(place.scale.x) != std::signbit(places.front().scale.x);
        if (place.turned_over) place.scale.x = -place.scale.x;
    }
    const std::size_t last = places.size() - 1;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const double at = frames > 1 ? double(last) * frame / (frames - 1) : 0;
        const std::size_t i = std::min(std::size_t(at), last > 0 ? last - 1 : 0), next = std::min(i + 1, last);
        const double t = at - double(i);
        const Place &from = places[i], &to = places[next];
        // Beyond the ends the path goes straight on.
        const glm::dvec3 before = i > 0 ? places[i - 1].position : 2.0 * from.position - to.position;
        const glm::dvec3 after = next < last ? places[next + 1].position : 2.0 * to.position - from.position;
        scene::Camera camera = through[0];
        const scene::Camera &a = through[i], &b = through[next];
        camera.camera_to_world = matrix_of({.position = catmull_rom(before, from.position, to.position, after, t),
                                            .rotation = glm::slerp(from.rotation, to.rotation, t),
                                            .scale = glm::mix(from.scale, to.scale, t)});
        // At a given camera exactly it, to the last bit.
        if (t == 0 && !from.turned_over) camera.camera_to_world = a.camera_to_world;
        if (t == 1 && !to.turned_over) camera.camera_to_world = b.camera_to_world;
        camera.fov = glm::mix(a.fov, b.fov, float(t));
        camera.lens_radius = glm::mix(a.lens_radius, b.lens_radius, float(t));
        camera.focal_distance = glm::mix(a.focal_distance, b.focal_distance, float(t));
        path.push_back(std::move(camera));
    }
    return path;
}

std::vector<scene::Camera> all_cameras(const scene::Scene& scene) {
    std::vector<scene::Camera> cameras;
    scene.cameras.each([&](auto, const scene::Camera& camera) { cameras.push_back(camera); });
    return cameras;
}

scene::Scene seen_from(scene::Scene scene, const scene::Camera& camera) {
    const auto id = scene.active_camera.value;
    if (const scene::Camera* active = scene.cameras.find(id)) {
        scene::Camera moved = camera;
        moved.name = active->name;
        scene.cameras.set(id, std::move(moved), ++scene.clock);
    }
    return scene;
}

} // namespace restage::query
