// SPDX-License-Identifier: Apache-2.0
// Things that are moved stop at others, slide along them and rest on them.
#include "query/collision.hpp"
#include "query/triangle_sweep.hpp"
#include "scene_room.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <unordered_set>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;
using glm::dvec3;
using query::Collision;

namespace {

using InstanceId = Id<Instance>;

struct World {
    test::Room room;
    Id<Mesh> cube, quad, ball;
    glm::dmat4 turned{1}; // of everything
    double scale = 1;

    Id<Mesh> mesh(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles) {
        auto data = std::make_shared<MeshData>();
        data->positions = std::move(positions);
        data->triangles = std::move(triangles);
        compute_bounds(*data);
        return room.add(Mesh{.name = "mesh", .data = std::move(data)});
    }
    World() {
        room.scene = {};
        std::vector<glm::vec3> corners;
        for (int i = 0; i < 8; ++i)
            corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
        cube = mesh(corners, {{0, 3, 1},
                              {0, 2, 3},
                              {4, 5, 7},
                              {4, 7, 6},
                              {0, 1, 5},
                              {0, 5, 4},
                              {2, 7, 3},
                              {2, 6, 7},
                              {0, 6, 2},
                              {0, 4, 6},
                              {1, 3, 7},
                              {1, 7, 5}});
        quad = mesh({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}});
        constexpr std::uint32_t around = 48, rows = 24; // radius 1
        std::vector<glm::vec3> points;
        std::vector<glm::uvec3> triangles;
        for (std::uint32_t j = 0; j <= rows; ++j)
            for (std::uint32_t i = 0; i <= around; ++i) {
                const double p = glm::pi<double>() * j / rows, a = glm::two_pi<double>() * i / around;
                points.emplace_back(std::sin(p) * std::cos(a), std::cos(p), std::sin(p) * std::sin(a));
            }
        for (std::uint32_t j = 0; j < rows; ++j)
            for (std::uint32_t i = 0; i < around; ++i) {
                const std::uint32_t k = j * (around + 1) + i;
                triangles.push_back({k, k + 1, k + around + 1});
                triangles.push_back({k + 1, k + around + 2, k + around + 1});
            }
        ball = mesh(std::move(points), std::move(triangles));
    }
    InstanceId add(Id<Mesh> mesh, const dvec3& at, const dvec3& size) {
        return room.add(
            Instance{.name = "thing",
                     .mesh = mesh,
                     .object_to_world = turned * glm::scale(glm::translate(glm::dmat4(1), scale * at), scale * size)});
    }
    InstanceId box(const dvec3& lower, const dvec3& upper) { return add(cube, lower, upper - lower); }
    std::unique_ptr<Collision> hold(std::initializer_list<InstanceId> ids) const {
        const Collision::Thing thing = Collision::thing_of(room.scene, std::span(ids.begin(), ids.size()));
        return std::make_unique<Collision>(room.scene, thing, std::unordered_set<InstanceId>(ids),
                                           dvec3(turned * glm::dvec4(0, 1, 0, 0)));
    }
    dvec3 world(const dvec3& v) const { return dvec3(turned * glm::dvec4(scale * v, 0)); }
    // Displacement after a move in `steps` equal parts, in the coordinates of the arguments above.
    dvec3 moved(Collision& thing, const dvec3& to, int steps = 1) const {
        const dvec3 from = thing.at();
        for (int i = 1; i <= steps; ++i)
            thing.slide(from + world(to) * (double(i) / steps));
        return dvec3(glm::inverse(turned) * glm::dvec4(thing.at(), 0)) / scale;
    }
};

bool near(const dvec3& a, const dvec3& b, double slack = 1e-6) { return glm::length(a - b) < slack; }

} // namespace

TEST_CASE("two triangles meet when and where they do", "[collision]") {
    const query::Triangle flat{dvec3(0, 0, 0), dvec3(2, 0, 0), dvec3(0, 0, 2)};
    query::TriangleSweep met;
    // A corner onto a face.
    const query::Triangle above{dvec3(0.5, 1, 0.5), dvec3(0.4, 2, 0.5), dvec3(0.6, 2, 0.5)};
    REQUIRE(query::sweep(above, flat, {0, -4, 0}, 0, 1, met));
    CHECK(met.enter == Approx(0.25));
    CHECK(near(met.normal, {0, 1, 0}));
    CHECK_FALSE(query::sweep(above, flat, {0, -0.9, 0}, 0, 1, met));
    CHECK_FALSE(query::sweep(above, flat, {0, 4, 0}, 0, 1, met));
    // An edge across an edge.
    const query::Triangle edge{dvec3(1, 1, -1), dvec3(1, 1, 0.5), dvec3(1, 3, 0)};
    REQUIRE(query::sweep(edge, flat, {0, -2, 0}, 0, 1, met));
    CHECK(met.enter == Approx(0.5));
    // In one plane.
    const query::Triangle beside{dvec3(3, 0, 0), dvec3(5, 0, 0), dvec3(3, 0, 2)};
    REQUIRE(query::sweep(beside, flat, {-4, 0, 0}, 0, 1, met));
    CHECK(met.enter == Approx(0.25));
    CHECK(near(met.normal, {1, 0, 0}, 1.0));
    CHECK_FALSE(query::sweep(beside, flat, {0, -1, 0}, 0, 1, met));
    CHECK(query::sweep(beside, flat, {0, -1, 0}, 1.1, 1, met)); // as close as that
}

TEST_CASE("a box stops at a box, at any size and direction", "[collision]") {
    for (const double scale : {1e-3, 1.0, 1e4})
        for (const glm::dmat4& turned : {glm::dmat4(1), glm::rotate(glm::dmat4(1), 2.0, glm::normalize(dvec3(1, 2, 3))),
                                         glm::translate(glm::dmat4(1), dvec3(scale * 50, 0, scale * -20))}) {
            World w;
            w.scale = scale;
            w.turned = turned;
            const auto held = w.box({0, 0, 0}, {1, 1, 1});
            const auto other = w.box({3, 0.2, 0.3}, {4, 0.7, 0.8});
            const auto thing = w.hold({held});
            CHECK(near(w.moved(*thing, {1.5, 0, 0}), {1.5, 0, 0}, 1e-12));
            CHECK(thing->slide(thing->at() + w.world({9, 0, 0})) == std::vector{other});
            CHECK(near(w.moved(*thing, {0, 0, 0}), {2, 0, 0}));
            CHECK(near(w.moved(*thing, {3, 0, 0}, 20), {2, 0, 0})); // no creeping
            CHECK(near(w.moved(*thing, {-3, 0, 0}), {-1, 0, 0}));
        }
}

TEST_CASE("a ball stops at a ball", "[collision]") {
    World w;
    const auto held = w.add(w.ball, {0, 0, 0}, dvec3(0.5));
    w.add(w.ball, {4, 0, 0}, dvec3(1));
    const auto thing = w.hold({held});
    // Their meshes have corners on this axis.
    CHECK(near(w.moved(*thing, {3, 0, 0}), {2.5, 0, 0}));
    // Beside it, it slides around: it is never nearer than inscribed meshes allow.
    const auto again = w.hold({held});
    for (int i = 1; i <= 60; ++i) {
        again->slide({0.1 * i, 0, 0.3});
        CHECK(glm::length(again->at() - dvec3(4, 0, 0)) > 1.5 * 0.99);
    }
    CHECK(near(again->at(), {6, 0, 0.3}, 0.3)); // on the other side
}

TEST_CASE("what meets a wall obliquely slides along it, and stops in a corner", "[collision]") {
    for (const glm::dmat4& turned : {glm::dmat4(1), glm::rotate(glm::dmat4(1), 2.0, glm::normalize(dvec3(1, 2, 3)))}) {
        World w;
        w.turned = turned;
        w.box({-10, -1, -10}, {10, 0, 10}); // the floor it stands on
        w.box({5, 0, -10}, {6, 3, 10});
        const auto thing = w.hold({w.box({0, 0, 0}, {1, 1, 1})});
        CHECK(near(w.moved(*thing, {7, 0, 2}), {4, 0, 2}));
        CHECK(near(w.moved(*thing, {1, -1, -5}, 50), {4, 0, -3}));
    }
    World w;
    w.box({-10, -1, -10}, {10, 0, 10});
    w.box({5, 0, -10}, {6, 3, 10});
    w.box({-10, 0, 5}, {10, 3, 6});
    const auto thing = w.hold({w.box({0, 0, 0}, {1, 1, 1})});
    CHECK(near(w.moved(*thing, {8, -2, 9}), {4, 0, 4}));
    CHECK(near(w.moved(*thing, {8, -2, 9}, 10), {4, 0, 4}));
    CHECK(near(w.moved(*thing, {-9, 0, -9}), {-5, 0, -5}));
}

TEST_CASE("walls and floors without thickness stop things, and sheets, too", "[collision]") {
    World w;
    w.add(w.quad, {-5, 0, -5}, {10, 1, 10});
    const auto thing = w.hold({w.box({0, 1, 0}, {1, 2, 1})});
    CHECK(near(w.moved(*thing, {0.1, -5, 0.2}), {0.1, -1, 0.2}));
    CHECK(near(w.moved(*thing, {2, -1, 0}), {2.1, -1, 0.2}));
    World v;
    v.add(v.quad, {-5, 0, -5}, {10, 1, 10});
    const auto sheet = v.hold({v.add(v.quad, {0, 1, 0}, {1, 1, 1})});
    CHECK(near(v.moved(*sheet, {0.1, -5, 0.2}), {0.1, -1, 0.2}));
}

TEST_CASE("a cup goes into an open box, and rests on its bottom", "[collision]") {
    World w;
    w.box({0, 0, 0}, {2, 0.1, 2});
    for (const auto& [lower, upper] : {std::pair(dvec3(0, 0.1, 0), dvec3(0.1, 1, 2)),
                                       {dvec3(1.9, 0.1, 0), {2, 1, 2}},
                                       {dvec3(0.1, 0.1, 0), {1.9, 1, 0.1}},
                                       {dvec3(0.1, 0.1, 1.9), {1.9, 1, 2}}})
        w.box(lower, upper);
    const auto cup = w.hold({w.box({0.8, 2, 0.8}, {1.2, 2.5, 1.2})});
    CHECK(near(w.moved(*cup, {0, -5, 0}), {0, -1.9, 0}));
    CHECK(near(w.moved(*cup, {5, 0, 0}), {0.7, -1.9, 0})); // inside against its side
    // As one mesh with an opening, of which it is in the convex hull.
    World v;
    const auto bowl = v.mesh(
        {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}, {0, 1, 0}, {2, 1, 0}, {2, 1, 2}, {0, 1, 2}},
        {{0, 1, 2}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}});
    v.add(bowl, {0, 0, 0}, {1, 1, 1});
    const auto other = v.hold({v.box({0.8, 2, 0.8}, {1.2, 2.5, 1.2})});
    CHECK(near(v.moved(*other, {0, -5, 0}), {0, -2, 0}));
}

TEST_CASE("contact at the start does not hold a thing, but it goes no deeper", "[collision]") {
    for (const double sunk : {-1e-9, 0.0, 1e-9, 0.002, 0.03}) {
        INFO(sunk);
        World w; // a floor of two parts, and a wall that it leans into as well, all one mesh
        const auto room =
            w.mesh({{-9, 0, -9}, {0, 0, -9}, {0, 0, 9}, {-9, 0, 9}, {9, 0, -9}, {9, 0, 9}, {9, 3, -9}, {9, 3, 9}},
                   {{0, 2, 1}, {0, 3, 2}, {1, 2, 5}, {1, 5, 4}, {4, 5, 7}, {4, 7, 6}});
        w.add(room, {0, 0, 0}, {1, 1, 1});
        const auto thing = w.hold({w.box({8 + sunk, -sunk, 0}, {9 + sunk, 1 - sunk, 1})});
        CHECK(near(w.moved(*thing, {0, 0, 3}), {0, 0, 3}));
        CHECK(near(w.moved(*thing, {0, -1, 0}), {0, 0, 3}));
        CHECK(near(w.moved(*thing, {1, 0, 0}), {0, 0, 3}));
        CHECK(near(w.moved(*thing, {-15, 0, -5}), {-15, 0, -2})); // over the seam
        CHECK(near(w.moved(*thing, {0, 1, 0}), {-15, 1, -2}));
        CHECK(near(w.moved(*thing, {0, -4, 0}), {-15, 0, -2}));
    }
}

TEST_CASE("what is deep in another thing can be pulled out, and does not go in again", "[collision]") {
    World w;
    w.box({-10, -1, -10}, {10, 0, 10});
    w.box({0, 0, 0}, {4, 1, 4});
    const auto thing = w.hold({w.box({-0.5, 0, 1}, {0.5, 1, 2})}); // half in it
    CHECK(near(w.moved(*thing, {-0.3, 0, 0}), {-0.3, 0, 0}));
    CHECK(near(w.moved(*thing, {0.2, 0, 0}), {-0.1, 0, 0})); // free until it has left
    CHECK(near(w.moved(*thing, {0, -1, 0}), {-0.1, 0, 0})); // the floor holds it
    CHECK(near(w.moved(*thing, {-1, 0, 0}), {-1.1, 0, 0}));
    CHECK(near(w.moved(*thing, {3, 0, 0}), {-0.5, 0, 0}));
}

TEST_CASE("a bowl stands on the table, whatever lies in it", "[collision]") {
    World w;
    w.box({-10, -1, -10}, {10, 0, 10}); // the floor
    w.box({-2, 0, -2}, {2, 1, 2});
    const auto bowl = w.box({-0.5, 1, -0.5}, {0.5, 1.5, 0.5});
    for (int i = 0; i < 4; ++i) // they come through its sides and its bottom
        w.add(w.ball, {i & 1 ? 0.4 : -0.4, 1.2, i & 2 ? 0.4 : -0.4}, dvec3(0.15));
    const auto thing = w.hold({bowl});
    CHECK(*thing->fall() == Approx(0).margin(1e-6));
    CHECK(near(w.moved(*thing, {0.5, -1, 0.3}), {0.5, 0, 0.3}));
}

TEST_CASE("things are placed where they fit, or anywhere by force", "[collision]") {
    World w;
    w.box({-10, -1, -10}, {10, 0, 10});
    w.box({3, 0, 0}, {5, 1, 1});
    const auto thing = w.hold({w.box({0, 0, 0}, {1, 1, 1})});
    CHECK_FALSE(thing->place({2.5, 0, 0}));
    CHECK(thing->at() == dvec3(0));
    CHECK(thing->place({3, 1, 0})); // onto the other
    CHECK(near(thing->at(), {3, 1, 0}));
    thing->force({2.5, 0, 0});
    CHECK(near(thing->at(), {2.5, 0, 0}, 1e-12));
    CHECK(near(w.moved(*thing, {-1, 0, 0}), {1.5, 0, 0}));
    CHECK(near(w.moved(*thing, {4, 0, 0}), {2, 0, 0}));
}

TEST_CASE("what appears inside another thing gets a place beside it or on it", "[collision]") {
    World w;
    w.box({-10, -1, -10}, {10, 0, 10});
    w.box({0, 0, 0}, {4, 1, 4});
    const auto room_for = [&](const dvec3& lower, const dvec3& viewer) {
        const InstanceId id = w.box(lower, lower + dvec3(1));
        const dvec3 by = w.hold({id})->make_room(viewer);
        apply(w.room.scene, *remove_instances(w.room.scene, std::vector{id}));
        return by;
    };
    CHECK(near(room_for({1, 0, 2}, {1.5, 0.5, 20}), {0, 0, 2}));
    CHECK(near(room_for({1, 0.2, 2}, {1.5, 20, 2.5}), {0, 0.8, 0}));
    CHECK(room_for({6, 0, 2}, {1.5, 20, 2.5}) == dvec3(0));
}

TEST_CASE("hidden and left out objects are no obstacles; nothing to move is no error", "[collision]") {
    World w;
    const auto held = w.box({0, 0, 0}, {1, 1, 1}), other = w.box({2, 0, 0}, {3, 1, 1});
    const auto both = w.hold({held, other});
    CHECK(near(w.moved(*both, {9, 0, 0}), {9, 0, 0}));
    apply(w.room.scene, *set_hidden(w.room.scene, std::vector{other}, true));
    CHECK(near(w.moved(*w.hold({held}), {9, 0, 0}), {9, 0, 0}));
    const auto nothing = w.hold({});
    CHECK(near(w.moved(*nothing, {9, 0, 0}), {9, 0, 0}));
    CHECK_FALSE(nothing->fall());
}
