// SPDX-License-Identifier: Apache-2.0
// Arranging whole things: align, distribute, mirror, arrays, replace; and where a copy is seen.
#include "scene/arrange.hpp"
#include "query/aside.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/history.hpp"
#include "scene_room.hpp"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;

namespace {

using Ids = std::vector<Id<Instance>>;

struct Boxes { // unit cubes, outward normals
    Scene scene;
    Id<Mesh> cube;

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
        data->triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                           {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
        compute_bounds(*data);
        cube = add(Mesh{.name = "cube", .data = std::move(data)});
    }
    Id<Instance> box(const char* name, glm::dvec3 lower, glm::dvec3 upper, Id<Group> group = {}) {
        return add(Instance{.name = name,
                            .mesh = cube,
                            .group = group,
                            .object_to_world = glm::scale(glm::translate(glm::dmat4(1), lower), upper - lower)});
    }
    Bounds bounds(const Ids& ids) const { return world_bounds(scene, ids); }
    void run(Result<Edit> edit) {
        REQUIRE(edit);
        apply(scene, *edit);
    }
};

bool close(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < 1e-9; }

// The normals of its triangles by the rule of the engine: ARCHITECTURE.md, invariant 2.
bool normals_point_outward(const Scene& s, Id<Instance> id) {
    const Instance& instance = s.instances[id];
    const MeshData& data = *s.meshes[instance.mesh].data;
    const glm::dvec3 middle = world_bounds(s, id).center();
    for (const glm::uvec3& t : data.triangles) {
        const glm::dvec3 a(data.positions[t.x]), b(data.positions[t.y]), c(data.positions[t.z]);
        const glm::dvec3 n = glm::inverseTranspose(glm::dmat3(instance.object_to_world)) * glm::cross(b - a, c - a);
        const glm::dvec3 at(instance.object_to_world * glm::dvec4((a + b + c) / 3.0, 1));
        if ((glm::dot(n, at - middle) > 0) == instance.reverse_orientation) return false;
    }
    return true;
}

} // namespace

TEST_CASE("things are aligned as wholes, by a side of their boxes", "[arrange]") {
    Boxes b;
    const Ids chair = {b.box("seat", {0, 1, 0}, {1, 1.2, 1}), b.box("leg", {0, 0, 0}, {0.2, 1, 0.2})};
    const Ids table = {b.box("table", {5, 0, 3}, {8, 2, 4})};
    const std::vector<Thing> things = {chair, table};
    const auto aligned = [&](int axis, Side side) {
        Boxes after = b;
        after.run(align(b.scene, things, axis, side, b.bounds(table)));
        CHECK(close(after.bounds(table).lower, b.bounds(table).lower)); // the target stays
        CHECK(close(after.bounds(chair).size(), b.bounds(chair).size()));
        const glm::dvec3 seat = world_bounds(after.scene, chair[0]).lower,
                         leg = world_bounds(after.scene, chair[1]).lower;
        CHECK(close(seat - leg, {0, 1, 0})); // it stays a whole
        return after.bounds(chair);
    };
    CHECK(aligned(0, Side::lower).lower.x == Approx(5));
    CHECK(aligned(0, Side::upper).upper.x == Approx(8));
    CHECK(aligned(2, Side::center).center().z == Approx(3.5));
    CHECK(aligned(1, Side::upper).upper.y == Approx(2));
    CHECK_FALSE(align(b.scene, things, 0, Side::lower, {}));
    CHECK_FALSE(align(b.scene, std::vector<Thing>{{Id<Instance>{99}}}, 0, Side::lower, b.bounds(table)));
}

TEST_CASE("things are distributed with equal gaps or equal centres between the outermost", "[arrange]") {
    Boxes b;
    // Given out of order; widths 1, 2, 1, 4.
    const std::vector<Thing> things = {{b.box("c", {4, 0, 0}, {5, 1, 1})},
                                       {b.box("d", {10, 0, 0}, {14, 1, 1})},
                                       {b.box("a", {0, 0, 0}, {1, 1, 1})},
                                       {b.box("b", {1.5, 0, 0}, {3.5, 1, 1})}};
    Boxes gaps = b, centers = b;
    gaps.run(distribute(b.scene, things, 0, Spacing::gaps)); // 14 - 8 = 6 in three gaps
    CHECK(gaps.bounds(things[3]).lower.x == Approx(3));
    CHECK(gaps.bounds(things[0]).lower.x == Approx(7));
    CHECK(gaps.scene.instances[things[1][0]] == b.scene.instances[things[1][0]]);
    CHECK(gaps.scene.instances[things[2][0]] == b.scene.instances[things[2][0]]);
    centers.run(distribute(b.scene, things, 0, Spacing::centers)); // 0.5 to 12
    CHECK(centers.bounds(things[3]).center().x == Approx(0.5 + 11.5 / 3));
    CHECK(centers.bounds(things[0]).center().x == Approx(0.5 + 2 * 11.5 / 3));
    CHECK_FALSE(distribute(b.scene, std::span(things).first(2), 0, Spacing::gaps));
}

TEST_CASE("a mirrored thing is its image behind the plane, with its outside outside", "[arrange]") {
    Boxes b;
    const Id<Instance> one = b.box("wedge", {1, 0, 0}, {3, 1, 1});
    REQUIRE(normals_point_outward(b.scene, one));
    History history;
    Boxes after = b;
    auto edit = mirror(b.scene, std::array{one}, 0, 0.5);
    REQUIRE(edit);
    CHECK(edit->label == "Mirror wedge");
    REQUIRE(history.push(after.scene, *edit));
    CHECK(close(after.bounds({one}).lower, {-2, 0, 0}));
    CHECK(close(after.bounds({one}).upper, {0, 1, 1}));
    CHECK(glm::determinant(glm::dmat3(after.scene.instances[one].object_to_world)) < 0);
    CHECK(normals_point_outward(after.scene, one));
    after.run(mirror(after.scene, std::array{one}, 0, 0.5)); // twice is nothing
    CHECK(after.scene.instances[one] == b.scene.instances[one]);
    // A triangle that is not symmetric.
    const glm::dvec3 p(2, 3, 4);
    CHECK(close(glm::dvec3(reflection(1, 1) * glm::dvec4(p, 1)), {2, -1, 4}));
    const Id<Light> lamp = b.add(Light{.name = "lamp", .light_to_world = glm::translate(glm::dmat4(1), {4, 5, 6})});
    b.run(mirror(b.scene, lamp, 2, 0));
    CHECK(close(glm::dvec3(b.scene.lights[lamp].light_to_world[3]), {4, 5, -6}));
    CHECK_FALSE(mirror(b.scene, Id<Light>{7}, 0, 0));
}

TEST_CASE("arrays of a line, a grid and a circle", "[arrange]") {
    const auto line = line_array(4, {1, 2, 0});
    REQUIRE(line.size() == 3);
    CHECK(close(line[2][3], {3, 6, 0}));
    CHECK(line_array(1, {1, 0, 0}).empty());
    const auto grid = grid_array({2, 1, 3}, {1, 5, 10});
    REQUIRE(grid.size() == 5);
    std::set<std::pair<double, double>> places;
    for (const glm::dmat4& m : grid) {
        CHECK(m[3].y == 0);
        places.insert({m[3].x, m[3].z});
    }
    CHECK(places == std::set<std::pair<double, double>>{{1, 0}, {0, 10}, {1, 10}, {0, 20}, {1, 20}});

    const glm::dvec3 middle(2, 7, 0);
    const auto at = [&](const glm::dmat4& m) { return glm::dvec3(m * glm::dvec4(middle, 1)); };
    const auto whole = circle_array({.count = 4, .center = {0, 0, 0}, .axis = {0, 3, 0}}, middle);
    REQUIRE(whole.size() == 3);
    CHECK(close(at(whole[0]), {0, 7, -2}));
    CHECK(close(at(whole[1]), {-2, 7, 0}));
    CHECK(close(glm::dvec3(whole[0][0]), {0, 0, -1})); // turned with it
    const auto part = circle_array({.count = 3, .axis = {0, 1, 0}, .angle = 180, .turn = false}, middle);
    CHECK(close(at(part[1]), {-2, 7, 0})); // the last one at the end of the arc
    CHECK(glm::dmat3(part[1]) == glm::dmat3(1));
    CHECK(circle_array({.count = 1}, middle).empty());
}

TEST_CASE("an array shares geometry, copies whole groups and numbers names", "[arrange]") {
    Boxes b;
    const Id<Group> group = b.add(Group{.name = "chair"});
    const Ids chair = {b.box("seat", {0, 1, 0}, {1, 1.2, 1}, group), b.box("leg", {0, 0, 0}, {0.2, 1, 0.2}, group)};
    const auto made = duplicate_each(b.scene, chair, line_array(4, {2, 0, 0}));
    REQUIRE(made);
    CHECK(made->copies.size() == 6);
    const std::uint32_t meshes = b.scene.meshes.live();
    apply(b.scene, made->edit);
    CHECK(b.scene.meshes.live() == meshes);
    CHECK(b.scene.groups.live() == 4);
    CHECK(b.scene.instances[made->copies[0]].name == "seat 2");
    CHECK(b.scene.instances[made->copies[5]].name == "leg 4");
    for (int i = 0; i < 3; ++i) {
        const Instance &seat = b.scene.instances[made->copies[std::size_t(2 * i)]],
                       &leg = b.scene.instances[made->copies[std::size_t(2 * i + 1)]];
        CHECK(seat.group == leg.group);
        CHECK(seat.group != group);
        CHECK(seat.object_to_world[3].x == 2 * (i + 1));
    }
    CHECK_FALSE(duplicate_each(b.scene, chair, line_array(60'000, {1, 0, 0})));
    CHECK_FALSE(duplicate_each(b.scene, chair, std::array{glm::dmat4(0)}));
}

TEST_CASE("a replacement stands where the replaced thing stood, as large, turned alike", "[arrange]") {
    Boxes b;
    const Ids lamp = {b.box("lamp", {20, 0, 0}, {21, 4, 1})};
    const Ids vase = {b.box("vase", {0, 1, 0}, {1, 3, 1})}, stool = {b.box("stool", {5, 0, 5}, {7, 1, 7})};
    const std::vector<Thing> things = {vase, stool};
    Boxes after = b;
    auto made = replace(b.scene, things, lamp, {});
    REQUIRE(made);
    CHECK(made->edit.label == "Replace 2 things by lamp");
    apply(after.scene, made->edit);
    CHECK_FALSE(after.scene.instances.find(vase[0]));
    CHECK(after.scene.instances[lamp[0]] == b.scene.instances[lamp[0]]);
    REQUIRE(made->copies.size() == 2);
    const Bounds first = after.bounds({made->copies[0]}), second = after.bounds({made->copies[1]});
    CHECK(close(first.size(), {0.5, 2, 0.5})); // fits the height
    CHECK(close(first.lower, {0.25, 1, 0.25}));
    CHECK(close(second.size(), {0.25, 1, 0.25}));
    CHECK(close(second.lower, {5.875, 0, 5.875}));
    made = replace(b.scene, std::span(things).first(1), lamp, {.keep_size = true});
    REQUIRE(made);
    CHECK(made->edit.label == "Replace vase by lamp");
    Boxes kept = b;
    apply(kept.scene, made->edit);
    CHECK(close(kept.bounds(made->copies).lower, {0, 1, 0}));
    CHECK(close(kept.bounds(made->copies).upper, {1, 5, 1}));
    CHECK_FALSE(replace(b.scene, things, vase, {})); // itself
    CHECK_FALSE(replace(b.scene, things, {}, {}));

    // Turned about the vertical; a conversion of axes in one of the files does not tip it over.
    for (const double degrees : {30.0, 180.0, -135.0}) {
        CAPTURE(degrees);
        Boxes c = b;
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::dvec3(0, 1, 0));
        const glm::dmat4 converted = glm::rotate(glm::dmat4(1), glm::radians(-90.0), glm::dvec3(1, 0, 0));
        for (const glm::dmat4& frame : {glm::dmat4(1), converted}) {
            c.run(set_transform(c.scene, vase[0], turn * frame));
            auto turned = replace(c.scene, std::span(things).first(1), lamp, {});
            REQUIRE(turned);
            Boxes t = c;
            apply(t.scene, turned->edit);
            const glm::dmat3 linear(t.scene.instances[turned->copies[0]].object_to_world);
            CHECK(close(glm::normalize(linear[0]), glm::dvec3(turn[0])));
            CHECK(close(glm::normalize(linear[1]), {0, 1, 0}));
            auto straight = replace(c.scene, std::span(things).first(1), lamp, {.turn = false});
            REQUIRE(straight);
            Boxes u = c;
            apply(u.scene, straight->edit);
            CHECK(close(glm::normalize(glm::dvec3(u.scene.instances[straight->copies[0]].object_to_world[0])),
                        {1, 0, 0}));
        }
    }
}

TEST_CASE("a copy goes where the picture shows it", "[arrange]") {
    Camera camera{.name = "camera", .fov = 45};
    // At (0, 1, 10), looking along -z; +x of the camera is the world's.
    camera.camera_to_world =
        glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 10, 1));
    const glm::dvec3 up(0, 1, 0);
    const auto offset = [&](double lower, double upper) {
        const Bounds box{{lower, 0, -0.5}, {upper, 1, 0.5}};
        const glm::dvec3 by = query::visible_offset(camera, 1, up, box, 0.1);
        CHECK(by.y == 0);
        return by;
    };
    CHECK(close(offset(-0.5, 0.5), {1.05, 0, 0})); // to the right
    CHECK(close(offset(2.5, 3.5), {-1.05, 0, 0})); // there is no room: to the left
    CHECK(close(offset(-3, 3.2), {0, 0, 1.05})); // nor there: towards the viewer
    CHECK(close(offset(-3.4, 3.6), {0, 0, -1.05})); // or away
    const Bounds lamp{{0, 1, 0}, {0, 1, 0}};
    CHECK(close(query::visible_offset(camera, 1, up, lamp, 0.3), {0.3, 0, 0}));
    CHECK(query::visible_part(camera, 1, lamp) == 1);
    CHECK(query::visible_part(camera, 1, {{-1, 0, 12}, {1, 1, 14}}) == 0); // behind
    const double half = query::visible_part(camera, 1, {{-100, 0.5, 0}, {0, 1.5, 0.01}});
    CHECK((half > 0.02 && half < 0.06));
    // Everything around it is outside: the largest visible part, without a number that is not finite.
    const glm::dvec3 any = query::visible_offset(camera, 1, up, {{-50, -50, -50}, {50, 50, 50}}, 0.1);
    CHECK((std::isfinite(any.x) && glm::length(any) > 1));
}
