// SPDX-License-Identifier: Apache-2.0
#include "scene/studio.hpp"

#include "scene/bounds.hpp"
#include "scene/sky.hpp"
#include "scene/tables.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace restage::scene {

namespace {

std::shared_ptr<const MeshData> floor_mesh() {
    auto mesh = std::make_shared<MeshData>();
    constexpr float half = 10;
    mesh->positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
    mesh->uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
    compute_bounds(*mesh);
    return mesh;
}

} // namespace

Scene studio_scene() {
    Scene s;
    s.clock = 1;
    const auto add = [&]<class T>(T item) {
        const Id<T> id = table<T>(s).next();
        table<T>(s).set(id, std::move(item), s.clock);
        return id;
    };
    const auto mesh = add(Mesh{.name = "floor", .data = floor_mesh()});
    Material paint{.name = "floor", .type = "diffuse"};
    paint.params.set("reflectance", Value::color(0.6f, 0.6f, 0.6f));
    const auto material = add(std::move(paint));
    add(Instance{.name = "floor", .mesh = mesh, .material = material});
    Camera camera{.name = "camera", .fov = 40};
    camera.camera_to_world =
        glm::inverse(glm::lookAt(glm::dvec3(2.6, 1.9, 3.6), glm::dvec3(0, 0.5, 0), glm::dvec3(0, 1, 0)));
    camera.camera_to_world[2] *= -1; // cameras look along +z; x stays on the right
    camera.focal_distance = 4.7f;
    s.active_camera = {add(std::move(camera)), s.clock};
    s.film = {Film{.width = 1280, .height = 720}, s.clock};
    s.settings.version = s.clock;
    apply(s, studio_sky(s, {0, 1, 0}));
    return s;
}

} // namespace restage::scene
