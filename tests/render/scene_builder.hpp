// SPDX-License-Identifier: Apache-2.0
// Small scenes built in code, for tests with a closed form.
#pragma once

#include "scene/edit.hpp"
#include "scene/scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>

namespace restage::tests {

class SceneBuilder {
  public:
    scene::Scene scene;

    SceneBuilder() {
        set_film(32, 32);
        scene.settings.value.max_depth = 5;
    }
    void set_film(std::uint32_t width, std::uint32_t height) {
        scene.film.value.width = width;
        scene.film.value.height = height;
        scene.film.value.filter = {.kind = scene::FilterKind::box, .radius = glm::vec2(0.5f)};
        scene.film.version = ++scene.clock;
    }
    // Looks from `eye` to `at`; pbrt's camera: +z forward, +x right, +y up (left-handed).
    void set_camera(glm::dvec3 eye, glm::dvec3 at, glm::dvec3 up, float fov) {
        const glm::dvec3 f = glm::normalize(at - eye), r = glm::normalize(glm::cross(up, f)), u = glm::cross(f, r);
        scene::Camera camera;
        camera.camera_to_world = glm::dmat4(glm::dvec4(r, 0), glm::dvec4(u, 0), glm::dvec4(f, 0), glm::dvec4(eye, 1));
        camera.fov = fov;
        const auto id = scene.active_camera.value ? scene.active_camera.value : scene.cameras.next();
        scene.cameras.set(id, camera, ++scene.clock);
        scene.active_camera = {id, scene.clock};
    }
    scene::Id<scene::Material> material(std::string type, scene::ParamSet params = {}) {
        const auto id = scene.materials.next();
        scene.materials.set(id, scene::Material{.name = type, .type = type, .params = std::move(params)},
                            ++scene.clock);
        return id;
    }
    scene::Id<scene::Material> diffuse(float r, float g, float b) {
        scene::ParamSet p;
        p.set("reflectance", scene::Value::color(r, g, b));
        return material("diffuse", p);
    }
    scene::Id<scene::Mesh> mesh(scene::MeshData data, std::string name = "mesh") {
        data.lower = glm::vec3(1e30f);
        data.upper = glm::vec3(-1e30f);
        for (const auto& p : data.positions) {
            data.lower = glm::min(data.lower, p);
            data.upper = glm::max(data.upper, p);
        }
        const auto id = scene.meshes.next();
        scene.meshes.set(id, scene::Mesh{.name = name, .data = std::make_shared<scene::MeshData>(std::move(data))},
                         ++scene.clock);
        return id;
    }
    scene::Id<scene::Instance> instance(scene::Id<scene::Mesh> mesh, scene::Id<scene::Material> material,
                                        glm::dmat4 transform = glm::dmat4(1),
                                        std::optional<scene::Emission> emission = {}) {
        const auto id = scene.instances.next();
        scene.instances.set(id,
                            scene::Instance{.name = "instance",
                                            .mesh = mesh,
                                            .material = material,
                                            .object_to_world = transform,
                                            .emission = emission},
                            ++scene.clock);
        return id;
    }
    // Two triangles a, b, c, d; the normal is cross(b-a, c-a).
    scene::Id<scene::Mesh> quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
        return mesh(
            {.positions = {a, b, c, d}, .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, .triangles = {{0, 1, 2}, {0, 2, 3}}},
            "quad");
    }
    // Unit sphere, outward normals; scaled so that its area is the true sphere's when `same_area`.
    scene::Id<scene::Mesh> sphere(int rows = 64, int columns = 128, bool shading_normals = true,
                                  bool same_area = false) {
        scene::MeshData m;
        for (int i = 0; i <= rows; ++i)
            for (int j = 0; j <= columns; ++j) {
                const double theta = std::numbers::pi * i / rows, phi = 2 * std::numbers::pi * j / columns;
                m.positions.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                         std::cos(theta));
                m.uvs.emplace_back(float(j) / columns, float(i) / rows);
            }
        if (shading_normals) m.normals = m.positions;
        double area = 0;
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            const auto n =
                glm::cross(glm::dvec3(m.positions[b] - m.positions[a]), glm::dvec3(m.positions[c] - m.positions[a]));
            if (glm::length(n) < 1e-9) return;
            area += glm::length(n) / 2;
            m.triangles.emplace_back(a, b, c);
        };
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const std::uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
                add(a, b, b + 1);
                add(a, b + 1, a + 1);
            }
        if (same_area)
            for (auto& p : m.positions)
                p *= float(std::sqrt(4 * std::numbers::pi / area));
        return mesh(std::move(m), "sphere");
    }
    void light(scene::Light light) { scene.lights.set(scene.lights.next(), std::move(light), ++scene.clock); }
    void environment(glm::vec3 radiance) {
        scene.environment = {scene::Environment{.name = "sky", .scale = radiance}, ++scene.clock};
    }
    scene::Id<scene::Image> image(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                  std::vector<float> values) {
        auto data = std::make_shared<scene::PixelData>();
        *data = {.width = width, .height = height, .channels = channels, .values = std::move(values)};
        const auto id = scene.images.next();
        scene.images.set(id, scene::Image{.name = "image", .data = data}, ++scene.clock);
        return id;
    }
};

} // namespace restage::tests
