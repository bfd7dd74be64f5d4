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
constexpr glm::vec3 wire(0.02f, 0.03f, 0.05f), no_uv(0.12f, 0.16f, 0.45f);

// Through the centre of the lens, like camera_ray() in lib/camera.glsl.
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

// The barycentric coordinates of where the ray meets the triangle's plane: those of `b` and `c`.
glm::vec2 meet_plane(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const shared::RayHit& ray) {
    const glm::vec3 ab = b - a, ac = c - a, n = glm::cross(ab, ac);
    const float across = glm::dot(n, ray.direction);
    const glm::vec3 at = ray.origin - a + ray.direction * (glm::dot(n, a - ray.origin) / across);
    const float area = glm::dot(n, n);
    return {glm::dot(glm::cross(at, ac), n) / area, glm::dot(glm::cross(ab, at), n) / area};
}

// How much of the pixel an edge of the triangle covers, in [0,1]: its distance comes from the coordinates at the
// neighbouring pixels. Triangles of few pixels fade, as they would be nothing but edges.
float edge_cover(const glm::vec3 (&corner)[3], glm::vec2 here, const shared::RayHit& right,
                 const shared::RayHit& below) {
    const auto all = [](glm::vec2 b) { return glm::vec3(1 - b.x - b.y, b.x, b.y); };
    const glm::vec3 b = all(here), dx = all(meet_plane(corner[0], corner[1], corner[2], right)) - b,
                    dy = all(meet_plane(corner[0], corner[1], corner[2], below)) - b;
    float nearest = 1e9f, smallest = 1e9f; // [pixel]: the distance of an edge, the height over one
    for (int i = 0; i < 3; ++i) {
        const float slope = std::hypot(dx[i], dy[i]); // of the coordinate, per pixel
        if (!(slope > 0) || !std::isfinite(slope)) continue;
        nearest = std::min(nearest, std::max(b[i], 0.f) / slope);
        smallest = std::min(smallest, 1 / slope);
    }
    return std::clamp(1.1f - nearest, 0.f, 1.f) * std::clamp(smallest / 5, 0.15f, 1.f);
}

class ClayPainter {
  public:
    ClayPainter(const GpuScene& scene, glm::uvec2 size, ClayLook look) : scene_(scene), size_(size), look_(look) {}

    shared::RayHit ray_at(glm::vec2 pixel) const {
        shared::RayHit ray{};
        aim(scene_.data().camera, scene_.features().camera, pixel / glm::vec2(size_), ray);
        return ray;
    }

    glm::vec3 color(const shared::RayHit& hit, const glm::vec3& normal, glm::vec2 pixel) const {
        const float facing = std::abs(glm::dot(normal, hit.direction));
        if (look_ == ClayLook::uv) return chequers(hit) * (0.35f + 0.65f * facing);
        if (scene_.instances()[hit.inst].flags & INSTANCE_EMITS)
            return look_ == ClayLook::wires ? edges(lamp, hit, pixel) : lamp;
        const glm::vec3 shaded = clay * (0.2f + 0.8f * facing);
        return look_ == ClayLook::wires ? edges(shaded, hit, pixel) : shaded;
    }

  private:
    glm::vec3 edges(const glm::vec3& surface, const shared::RayHit& hit, glm::vec2 pixel) const {
        if (scene_.is_quadric(hit.inst)) return surface; // no triangles
        const scene::MeshData* mesh = scene_.mesh_data(scene_.mesh_of(hit.inst));
        if (!mesh || hit.prim >= mesh->triangles.size()) return surface;
        const glm::uvec3& triangle = mesh->triangles[hit.prim];
        glm::vec3 corner[3];
        for (int i = 0; i < 3; ++i)
            corner[i] = scene_.instances()[hit.inst].object_to_world * glm::vec4(mesh->positions[triangle[i]], 1);
        const float cover =
            edge_cover(corner, {hit.u, hit.v}, ray_at(pixel + glm::vec2(1, 0)), ray_at(pixel + glm::vec2(0, 1)));
        return glm::mix(surface, wire, cover);
    }

    glm::vec3 chequers(const shared::RayHit& hit) const {
        glm::vec2 uv(hit.u, hit.v); // a quadric's
        if (!scene_.is_quadric(hit.inst)) {
            const scene::MeshData* mesh = scene_.mesh_data(scene_.mesh_of(hit.inst));
            if (!mesh || hit.prim >= mesh->triangles.size() || mesh->uvs.empty()) return no_uv;
            const glm::uvec3& t = mesh->triangles[hit.prim];
            uv = mesh->uvs[t.x] * (1 - hit.u - hit.v) + mesh->uvs[t.y] * hit.u + mesh->uvs[t.z] * hit.v;
        }
        if (!std::isfinite(uv.x + uv.y)) return no_uv;
        const glm::vec2 cell = glm::floor(uv * 8.f), part = uv - glm::floor(uv);
        const float odd = std::abs(std::fmod(cell.x + cell.y, 2.f));
        return glm::mix(glm::vec3(0.25f), glm::vec3(0.8f), odd) * (glm::vec3(0.35f) + 0.65f * glm::vec3(part, 0.3f));
    }

    const GpuScene& scene_;
    glm::uvec2 size_;
    ClayLook look_;
};

// Dark where the object changes, which also shows what has no triangles.
void draw_outlines(FilmImage& image) {
    const std::vector<std::uint32_t>& ids = image.instance_id;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const std::size_t i = std::size_t(y) * image.width + x;
            const bool edge = (x + 1 < image.width && ids[i] != ids[i + 1]) ||
                              (y + 1 < image.height && ids[i] != ids[i + image.width]);
            if (edge) image.color[i] = wire;
        }
}

} // namespace

FilmImage clay_picture(const GpuScene& scene, const EmbreeScene& embree, Jobs& jobs, glm::uvec2 size, ClayLook look) {
    FilmImage image = FilmImage::blank(size.x, size.y);
    image.samples = 1;
    image.color.assign(image.color.size(), ground);
    const ClayPainter painter(scene, size, look);
    jobs.parallel_for(size.y, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t y = begin; y < end; ++y)
            for (std::uint32_t x = 0; x < size.x; ++x) {
                const glm::vec2 pixel = glm::vec2(float(x), float(y)) + 0.5f;
                alignas(16) shared::RayHit ray = painter.ray_at(pixel);
                ray.tfar = std::numeric_limits<float>::infinity();
                ray.mask = ~0u;
                ray.geom = ray.inst = NONE;
                embree.intersect(ray);
                if (ray.inst == NONE) continue;
                const std::size_t i = y * size.x + x;
                const shared::InstanceData& instance = scene.instances()[ray.inst];
                const glm::vec3 normal = hit_normal(scene, embree, ray);
                image.albedo[i] = (instance.flags & INSTANCE_EMITS) ? lamp : clay;
                image.color[i] = painter.color(ray, normal, pixel);
                image.normal[i] = normal;
                image.depth[i] = ray.tfar;
                image.coverage[i] = 1;
                image.instance_id[i] = instance.object_id;
                if (const auto material = scene.resolve_material(ray.inst, ray.prim, {ray.u, ray.v});
                    material != MATERIAL_NOTHING)
                    image.material_id[i] = scene.materials()[material].id;
            }
    });
    if (look == ClayLook::wires) draw_outlines(image);
    return image;
}

} // namespace restage::render
