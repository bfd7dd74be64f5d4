// SPDX-License-Identifier: Apache-2.0
#include "session/studio.hpp"

#include "scene/bounds.hpp"
#include "scene/edits.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::session {

using namespace scene;

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

// A grey room with a wide soft box overhead and one at the side: rows from above to below.
std::shared_ptr<const PixelData> sky_pixels() {
    constexpr std::uint32_t width = 64, height = 32;
    auto pixels = std::make_shared<PixelData>(PixelData{.width = width, .height = height, .channels = 3, .values = {}});
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const float h = 1 - 2 * (float(y) + 0.5f) / height; // 1 above, -1 below
            const float around = (float(x) + 0.5f) / width - 0.3f;
            const float above = 1 / (1 + std::exp(-10 * (h - 0.45f)));
            const float side = std::exp(-18 * around * around - 12 * (h - 0.35f) * (h - 0.35f));
            pixels->values.insert(pixels->values.end(), 3,
                                  0.35f + 1.1f * above + 1.6f * side + std::min(h, 0.f) * 0.2f);
        }
    return pixels;
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
    const auto image = add(Image{.name = "studio", .encoding = RESTAGE_LINEAR, .data = sky_pixels()});
    // The panorama's pole is +z; here y is up.
    s.environment = {
        Environment{.name = "Studio",
                    .image = image,
                    .light_to_world = glm::rotate(glm::dmat4(1), glm::radians(-90.0), glm::dvec3(1, 0, 0))},
        s.clock};
    Camera camera{.name = "camera", .fov = 40};
    camera.camera_to_world =
        glm::inverse(glm::lookAt(glm::dvec3(2.6, 1.9, 3.6), glm::dvec3(0, 0.5, 0), glm::dvec3(0, 1, 0)));
    camera.camera_to_world[2] *= -1; // cameras look along +z; x stays on the right
    camera.focal_distance = 4.7f;
    s.active_camera = {add(std::move(camera)), s.clock};
    s.film = {Film{.width = 1280, .height = 720}, s.clock};
    s.settings.version = s.clock;
    return s;
}

} // namespace restage::session
