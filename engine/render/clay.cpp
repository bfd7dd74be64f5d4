// SPDX-License-Identifier: Apache-2.0
#include "render/clay.hpp"

#include "render/hit_normal.hpp"
#include "shared/octahedral.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace restage::render {

namespace {

constexpr glm::vec3 ground(0.045f, 0.047f, 0.05f), clay(0.62f, 0.58f, 0.53f), lamp(1.f, 0.93f, 0.78f);

// Through the centre of the lens and of the pixel, like camera_ray() in lib/camera.glsl.
void aim(const shared::CameraData& camera, std::uint32_t kind, glm::vec2 film, shared::RayHit& ray) {
    glm::vec3 from(0), towards(glm::mix(camera.screen_min, camera.screen_max, film), 1);
    if (kind == CAMERA_ORTHOGRAPHIC) {
        from = {towards.x, towards.y, 0};
        towards = {0, 0, 1};
    } else if (kind == CAMERA_SPHERICAL) {
        const glm::vec2 angle = film * glm::vec2(2, 1) * std::numbers::pi_v<float>;
        towards = {std::sin(angle.y) * std::cos(angle.x), std::cos(angle.y), std::sin(angle.y) * std::sin(angle.x)};
    } else if (kind == CAMERA_EQUAL_AREA) {
        const glm::dvec3 w = shared::octahedral_to_direction(film);
        towards = {w.x, w.z, w.y};
    }
    ray.origin = camera.camera_to_world * glm::vec4(from, 1);
    ray.direction = glm::normalize(glm::vec3(camera.camera_to_world * glm::vec4(towards, 0)));
}

} // namespace

FilmImage clay_picture(const GpuScene& scene, const EmbreeScene& embree, Jobs& jobs, glm::uvec2 size) {
    FilmImage image = FilmImage::blank(size.x, size.y);
    image.samples = 1;
    image.color.assign(image.color.size(), ground);
    const shared::CameraData& camera = scene.data().camera;
    jobs.parallel_for(size.y, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t y = begin; y < end; ++y)
            for (std::uint32_t x = 0; x < size.x; ++x) {
                alignas(16) shared::RayHit ray{};
                aim(camera, scene.features().camera, (glm::vec2(float(x), float(y)) + 0.5f) / glm::vec2(size), ray);
                ray.tfar = std::numeric_limits<float>::infinity();
                ray.mask = ~0u;
                ray.geom = ray.inst = NONE;
                embree.intersect(ray);
                if (ray.inst == NONE) continue;
                const std::size_t i = y * size.x + x;
                const shared::InstanceData& instance = scene.instances()[ray.inst];
                const glm::vec3 normal = hit_normal(scene, embree, ray);
                const float facing = std::abs(glm::dot(normal, ray.direction));
                image.albedo[i] = (instance.flags & INSTANCE_EMITS) ? lamp : clay;
                image.color[i] = (instance.flags & INSTANCE_EMITS) ? lamp : clay * (0.2f + 0.8f * facing);
                image.normal[i] = normal;
                image.depth[i] = ray.tfar;
                image.coverage[i] = 1;
                image.instance_id[i] = instance.object_id;
                if (const auto material = scene.resolve_material(ray.inst, ray.prim, {ray.u, ray.v});
                    material != MATERIAL_NOTHING)
                    image.material_id[i] = scene.materials()[material].id;
            }
    });
    return image;
}

} // namespace restage::render
