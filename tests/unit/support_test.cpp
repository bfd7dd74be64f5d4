// SPDX-License-Identifier: Apache-2.0
// Dropping things onto their support, and touching things.
#include "query/support.hpp"
#include "query/touching.hpp"
#include "scene_room.hpp"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;

namespace {

using Ids = std::vector<Id<Instance>>;

struct Boxes {
    Scene scene;
    Id<Mesh> cube;
    glm::dmat4 turned{1}; // of everything, so that up can be any direction

    template <class T>
    Id<T> add(T item) {
        const Id<T> id = table<T>(scene).next();
        apply(scene, insert(scene, std::move(item), "add"));
        return id;
    }
    Boxes() {
        auto data = std::make_shared<MeshData>();
        for (int i = 0; i < 8; ++i)
            data->positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
        data->triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
        compute_bounds(*data);
        cube = add(Mesh{.name = "cube", .data = std::move(data)});
    }
    Id<Instance> box(const char* name, glm::dvec3 lower, glm::dvec3 upper) {
        return add(
            Instance{.name = name,
                     .mesh = cube,
                     .object_to_world = turned * glm::scale(glm::translate(glm::dmat4(1), lower), upper - lower)});
    }
};

} // namespace

TEST_CASE("things stand on spheres as rendered, not on their tessellation", "[support]") {
    Boxes b;
    const auto ball = [&](const char* name, double radius, glm::dvec3 centre) {
        auto data = std::make_shared<MeshData>(); // a coarse tessellation, as from importers: here an octahedron
        const float r = float(radius);
        data->positions = {{r, 0, 0}, {0, r, 0}, {0, 0, r}, {-r, 0, 0}, {0, -r, 0}, {0, 0, -r}};
        data->triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
        compute_bounds(*data);
        const auto mesh = b.add(Mesh{
            .name = name, .data = std::move(data), .primitive = "sphere \"float radius\" " + std::to_string(radius)});
        return b.add(Instance{.name = name, .mesh = mesh, .object_to_world = glm::translate(glm::dmat4(1), centre)});
    };
    ball("ground", 1000, {0, 0, -1000});
    const double x = 300, top = std::sqrt(1000.0 * 1000 - x * x) - 1000; // the octahedron is 254 lower there
    const double apart = std::sqrt(1000.2 * 1000.2 - x * x) - 1000;
    const Ids small{ball("small", 0.2, {x, 0, apart + 3})};
    CHECK(*query::fall_distance(b.scene, small, {0, 0, 1}) == Approx(3).margin(1e-3));
    const Ids box{b.box("box", {x - 0.1, -0.1, top + 2}, {x + 0.1, 0.1, top + 2.2})};
    CHECK(*query::fall_distance(b.scene, box, {0, 0, 1}) == Approx(2).margin(0.04)); // of its lower corner
}

TEST_CASE("things fall until they stand on something", "[support]") {
    for (const glm::dmat4& turned :
         {glm::dmat4(1), glm::rotate(glm::dmat4(1), glm::radians(-90.0), glm::dvec3(1, 0, 0)),
          glm::rotate(glm::dmat4(1), 2.0, glm::normalize(glm::dvec3(1, 2, 3)))}) {
        Boxes b;
        b.turned = turned;
        const glm::dvec3 up(turned * glm::dvec4(0, 0, 1, 0));
        b.box("floor", {-10, -10, -0.1}, {10, 10, 0});
        const Ids slab{b.box("slab", {0, 0, 1}, {2, 2, 1.1})};
        CHECK(*query::fall_distance(b.scene, slab, up) == Approx(1));

        // A post thinner than its load, under no corner of it.
        const auto post = b.box("post", {0.9, 1.1, 0}, {0.905, 1.105, 0.4});
        CHECK(*query::fall_distance(b.scene, slab, up) == Approx(0.6));
        // Objects that fall with it support nothing.
        CHECK(*query::fall_distance(b.scene, Ids{slab[0], post}, up) == Approx(0).margin(1e-9));
        apply(b.scene, *set_hidden(b.scene, Ids{post}, true));
        CHECK(*query::fall_distance(b.scene, slab, up) == Approx(1));

        // The slab does not stand on a plate on top of it, no matter how thin both are.
        b.box("plate", {0.5, 0.5, 1.1}, {0.7, 0.7, 1.101});
        CHECK(*query::fall_distance(b.scene, slab, up) == Approx(1));
        // Slightly sunk in: lifted out.
        const Ids chest{b.box("chest", {5, 5, -0.05}, {6, 6, 0.95})};
        CHECK(*query::fall_distance(b.scene, chest, up) == Approx(-0.05));
        CHECK_FALSE(query::fall_distance(b.scene, Ids{b.box("outside", {20, 0, 0}, {21, 1, 1})}, up));
        CHECK_FALSE(query::fall_distance(b.scene, {}, up));
    }
}

TEST_CASE("things that touch are parts of a whole, but not the floor they stand on", "[touching]") {
    Boxes b;
    const auto floor = b.box("floor", {-10, -10, -0.1}, {10, 10, 0});
    Ids chair{b.box("seat", {0, 0, 0.45}, {0.5, 0.5, 0.5})};
    for (const double x : {0.0, 0.45})
        for (const double y : {0.0, 0.45})
            chair.push_back(b.box("leg", {x, y, 0}, {x + 0.05, y + 0.05, 0.45}));
    chair.push_back(b.box("back", {0, 0.45, 0.5}, {0.5, 0.5, 1}));
    chair.push_back(b.box("cushion on the seat", {0.05, 0.05, 0.501}, {0.45, 0.4, 0.53}));
    const auto other = b.box("leg of another chair", {0.6, 0, 0}, {0.65, 0.05, 0.45});
    const auto hidden = b.box("hidden", {0, 0, 0.3}, {0.5, 0.5, 0.45});
    apply(b.scene, *set_hidden(b.scene, Ids{hidden}, true));

    for (const auto start : {chair[0], chair[5], chair[6]}) {
        Ids found = query::touching(b.scene, Ids{start});
        found.push_back(start);
        std::sort(found.begin(), found.end(), [](auto x, auto y) { return x.value < y.value; });
        CHECK(found == chair);
    }
    CHECK(query::touching(b.scene, Ids{other}).empty());
    CHECK(query::touching(b.scene, {}).empty());
    // Of the floor everything on it is a part.
    CHECK(query::touching(b.scene, Ids{floor}).size() == chair.size() + 1);
    // Objects locked in the editor are skipped, and not followed.
    const auto found = query::touching(b.scene, Ids{chair[6]}, [&](Id<Instance> id) { return id == chair[0]; });
    CHECK(found.empty());
}
