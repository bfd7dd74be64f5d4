// SPDX-License-Identifier: Apache-2.0
// Snapping of dragged things: grid, corners, surfaces, walls.
#include "query/snapping.hpp"
#include "scene_room.hpp"

#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using query::SnapHint;

namespace {

struct Place { // a floor, a wall at x = 5, a table; a crate is dragged, seen from the front and above
    test::Room room;
    Id<Mesh> cube;
    Id<Instance> floor, wall, table, crate;
    Camera camera;

    Id<Instance> box(const char* name, const glm::dvec3& lower, const glm::dvec3& upper) {
        return room.add(Instance{.name = name,
                                 .mesh = cube,
                                 .object_to_world = glm::scale(glm::translate(glm::dmat4(1), lower), upper - lower)});
    }
    Place() {
        room.scene = {};
        auto data = std::make_shared<MeshData>();
        for (int i = 0; i < 8; ++i)
            data->positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
        data->triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
        compute_bounds(*data);
        cube = room.add(Mesh{.name = "cube", .data = std::move(data)});
        floor = box("floor", {-10, -0.1, -10}, {10, 0, 10});
        wall = box("wall", {5, 0, -10}, {5.2, 3, 10});
        table = box("table", {-3, 0, -1}, {-1, 0.8, 1});
        crate = box("crate", {0, 0, 0}, {0.5, 0.5, 0.5});
        camera.camera_to_world = glm::inverse(glm::lookAtLH(glm::dvec3(0, 4, 8), glm::dvec3(0, 0, 0), {0, 1, 0}));
    }
    query::ViewRay ray_to(const glm::dvec3& at) const {
        const glm::dvec3 eye(camera.camera_to_world[3]);
        return {eye, at - eye};
    }
    query::Snapping begin(const glm::dvec3& grabbed) const {
        const std::pair one(crate, room.scene.instances[crate].object_to_world);
        return {room.scene, std::span(&one, 1), {crate}, grabbed, ray_to(grabbed), {0, 1, 0}};
    }
    query::Snapping::Snapped snap(const query::SnapTo& to, const query::Snapping::Drag& drag) const {
        return begin({0.5, 0.25, 0.5}).snap(room.scene, camera, 1, to, drag);
    }
};

bool close(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-6; }

} // namespace

TEST_CASE("nothing snaps without a target", "[snap]") {
    const Place p;
    const auto free = p.snap({}, {.by = {4.45, 0, 0}, .mouse = p.ray_to({1, 0, 1}), .axis = {}, .radius = 0.03});
    CHECK(close(free.by, {4.45, 0, 0}));
    CHECK(free.hints.empty());
}

TEST_CASE("a thing snaps to the grid by the middle of its underside", "[snap]") {
    const Place p;
    query::Snapping::Drag drag{.by = {1.1, 0, 0.2}, .mouse = p.ray_to({1, 0, 1}), .axis = {}, .grid = 0.5};
    auto at = p.snap({.grid = true}, drag);
    CHECK(close(at.by, {1.25, 0, 0.25})); // its middle was at 0.25
    REQUIRE(at.hints.size() == 1);
    CHECK(at.hints[0].kind == SnapHint::Kind::grid);
    drag.axis = glm::dvec3(1, 0, 0); // by a handle: along it only
    at = p.snap({.grid = true}, drag);
    CHECK(close(at.by, {1.25, 0, 0.2}));
}

TEST_CASE("a thing snaps against a wall with its outermost side", "[snap]") {
    const Place p;
    query::Snapping::Drag drag{.by = {4.45, 0, 1}, .mouse = p.ray_to({5, 0, 1}), .axis = {}, .radius = 0.03};
    auto at = p.snap({.wall = true}, drag);
    CHECK(close(at.by, {4.5, 0, 1}));
    REQUIRE(at.hints.size() == 1);
    CHECK(at.hints[0].name == "wall");
    CHECK(close(at.hints[0].at, {5, 0, 1.25}));
    drag.by.x = 4.55; // it is in the wall already
    CHECK(close(p.snap({.wall = true}, drag).by, {4.5, 0, 1}));
    drag.by.x = 3.5; // far from it
    at = p.snap({.wall = true}, drag);
    CHECK(close(at.by, {3.5, 0, 1}));
    CHECK(at.hints.empty());
    drag.by.x = 4.45;
    drag.axis = glm::dvec3(0, 0, 1); // a handle along the wall
    CHECK(close(p.snap({.wall = true}, drag).by, {4.45, 0, 1}));
}

TEST_CASE("a thing stands on the surface under the mouse", "[snap]") {
    const Place p;
    // Held at its front, so the mouse is on the floor behind it at the start; on the table it is as far behind.
    const glm::dvec3 grabbed(0.5, 0.25, 0.5), eye(0, 4, 8);
    const glm::dvec3 behind = grabbed + (grabbed - eye) * (grabbed.y / (eye.y - grabbed.y));
    const glm::dvec3 onto(-2, 0.8, -0.6);
    auto at = p.snap({.surface = true}, {.by = {-2, 0, 0}, .mouse = p.ray_to(onto), .axis = {}, .radius = 0.03});
    REQUIRE(at.hints.size() == 1);
    CHECK(at.hints[0].name == "table");
    CHECK(close(at.by, {onto.x - behind.x, 0.8, onto.z - behind.z}));
    // The mouse is at the table's edge already, the thing still beside the table.
    at = p.snap({.surface = true},
                {.by = {-1, 0, 0}, .mouse = p.ray_to({-1.05, 0.8, 0.95}), .axis = {}, .radius = 0.03});
    CHECK(at.hints.empty());
    CHECK(close(at.by, {-1, 0, 0}));
}

TEST_CASE("a corner snaps onto a corner, before anything else", "[snap]") {
    const Place p;
    // Held near its corner (0.5, 0.5, 0.5); the table's is at (-1, 0.8, 1).
    const auto dragged = p.begin({0.45, 0.45, 0.5});
    const glm::dvec3 near = glm::dvec3(-1, 0.8, 1) - glm::dvec3(0.5, 0.5, 0.5) + glm::dvec3(0.04, 0.02, 0);
    const query::Snapping::Drag drag{.by = near, .mouse = p.ray_to({-1, 0.8, 1}), .axis = {}, .radius = 0.03};
    auto at = dragged.snap(p.room.scene, p.camera, 1, {.grid = true, .vertex = true, .wall = true}, drag);
    REQUIRE(at.hints.size() == 1);
    CHECK(at.hints[0].kind == SnapHint::Kind::vertex);
    CHECK(at.hints[0].name == "table");
    CHECK(close(at.by, glm::dvec3(-1.5, 0.3, 0.5)));
}
