// SPDX-License-Identifier: Apache-2.0
// Points on surfaces under the mouse, the spacing of grids, and looking along an axis.
#include "query/measure.hpp"
#include "query/navigation.hpp"
#include "scene/bounds.hpp"
#include "scene/statistics.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;

namespace {

// A square of side 2 at z = 5 before a camera at the origin that looks along +z.
struct Wall {
    Scene scene;
    Camera camera;
    Id<Instance> wall;
    Wall() {
        auto data = std::make_shared<MeshData>();
        data->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        data->triangles = {{0, 1, 2}, {0, 2, 3}};
        compute_bounds(*data);
        scene.meshes.set(scene.meshes.next(), Mesh{.name = "wall", .data = data}, ++scene.clock);
        wall = scene.instances.next();
        scene.instances.set(wall,
                            Instance{.name = "wall",
                                     .mesh = Id<Mesh>{1},
                                     .object_to_world = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 5))},
                            ++scene.clock);
        camera.fov = 60;
    }
    glm::dvec2 seen(const glm::dvec3& p) const { return glm::dvec2(query::project(camera, p, 1)); }
};

} // namespace

TEST_CASE("measuring: the surface under the mouse, or a corner near it") {
    const Wall w;
    const auto middle = query::surface_point(w.scene, w.camera, w.seen({0.25, -0.5, 5}), 1, 0.02);
    REQUIRE(middle);
    CHECK_FALSE(middle->vertex);
    CHECK(glm::length(middle->position - glm::dvec3(0.25, -0.5, 5)) < 1e-9);
    const auto corner = query::surface_point(w.scene, w.camera, w.seen({0.97, 0.98, 5}), 1, 0.02);
    REQUIRE(corner);
    CHECK(corner->vertex);
    CHECK(corner->position == glm::dvec3(1, 1, 5));
    CHECK_FALSE(query::surface_point(w.scene, w.camera, w.seen({0.97, 0.98, 5}), 1, 0)->vertex);
    CHECK_FALSE(query::surface_point(w.scene, w.camera, w.seen({3, 0, 5}), 1, 0.02));
}

TEST_CASE("grids have lines at 1, 2 or 5 times a power of ten") {
    CHECK(query::grid_step(20) == 1);
    CHECK(query::grid_step(4) == 0.2);
    CHECK(std::abs(query::grid_step(0.1) - 0.005) < 1e-12);
    CHECK(query::grid_step(900) == 50);
    CHECK(query::grid_step(190) == 10);
}

TEST_CASE("looking along an axis keeps distance, size and handedness, and what is up") {
    for (const double mirror : {1.0, -1.0}) {
        Camera camera;
        camera.camera_to_world = glm::translate(glm::dmat4(1), glm::dvec3(3, 2, -4)) *
                                 glm::scale(glm::dmat4(1), glm::dvec3(2 * mirror, 2, 1));
        const glm::dvec3 pivot(0, 1, 0), up(0, 1, 0);
        const double distance = glm::length(glm::dvec3(3, 1, -4));
        query::look_along(camera, pivot, {1, 0, 0}, up);
        const auto column = [&](int i) { return glm::dvec3(camera.camera_to_world[i]); };
        CHECK(glm::length(column(3) - (pivot + glm::dvec3(distance, 0, 0))) < 1e-9);
        CHECK(glm::length(column(2) - glm::dvec3(-1, 0, 0)) < 1e-9);
        CHECK(glm::length(column(1) - glm::dvec3(0, 2, 0)) < 1e-9);
        CHECK(glm::determinant(glm::dmat3(camera.camera_to_world)) * mirror > 0);
        query::look_along(camera, pivot, {0, 1, 0}, up); // from above: what was in front is up
        CHECK(glm::length(column(2) - glm::dvec3(0, -1, 0)) < 1e-9);
        CHECK(glm::length(column(1) - glm::dvec3(-2, 0, 0)) < 1e-9);
        CHECK(glm::determinant(glm::dmat3(camera.camera_to_world)) * mirror > 0);
    }
}

TEST_CASE("statistics count shared geometry once and copies as often as they are shown") {
    Wall w;
    Instance copy = w.scene.instances[w.wall];
    copy.hidden = true;
    w.scene.instances.set(w.scene.instances.next(), copy, ++w.scene.clock);
    Mesh again = w.scene.meshes[Id<Mesh>{1}];
    w.scene.meshes.set(w.scene.meshes.next(), again, ++w.scene.clock);
    const Statistics n = statistics_of(w.scene);
    CHECK(n.objects == 2);
    CHECK(n.hidden == 1);
    CHECK(n.triangles == 2);
    CHECK(n.instanced == 4);
    CHECK(n.geometry_bytes == 4 * 12 + 2 * 12);
    CHECK(n.pixel_bytes == 0);
}
