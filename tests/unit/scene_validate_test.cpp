// SPDX-License-Identifier: Apache-2.0
// scene: validate is silent about a sound scene and names what is wrong with another.
#include "scene/validate.hpp"
#include "scene_room.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::scene;
using test::not_a_number;
using test::Room;

namespace {

bool mentions(const std::vector<Problem>& problems, Problem::Severity severity, std::string_view part) {
    return std::any_of(problems.begin(), problems.end(), [&](const Problem& p) {
        return p.severity == severity && p.sentence.find(part) != std::string::npos;
    });
}

constexpr auto error = Problem::Severity::error;
constexpr auto warning = Problem::Severity::warning;

} // namespace

TEST_CASE("validate is silent about a sound scene and names what is wrong with another", "[scene]") {
    Room r;
    REQUIRE(validate(r.scene).empty());
    const auto with = [&](auto&& change) {
        Room broken;
        change(broken);
        return validate(broken.scene);
    };
    const auto change = [](Room& b, auto id, auto&& f) { apply(b.scene, *modify(b.scene, id, "", f)); };
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.material = {9}; }); }), error,
                   "instance \"chair\": material 9 does not exist"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.mesh = {}; }); }), error, "has no mesh"));
    CHECK(mentions(
        with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1][1] = not_a_number; }); }), error,
        "not a finite number"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1][3] = 1; }); }), error,
                   "projective"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1] = {}; }); }), warning,
                   "flattens"));
    CHECK(mentions(with([&](Room& b) { change(b, b.room, [&](Group& g) { g.parent = b.chairs; }); }), error,
                   "group \"chairs\" contains itself through group \"room\""));
    CHECK(mentions(with([&](Room& b) {
                       change(b, b.oak, [&](Material& m) {
                           m.params.set("first", Value{.type = RESTAGE_MATERIAL, .material = b.oak});
                       });
                   }),
                   error, "material \"oak\" contains itself"));
    CHECK(mentions(with([&](Room& b) {
                       const auto t = b.add(Texture{.name = "t", .type = "scale"});
                       const auto u = b.add(Texture{.name = "u", .type = "scale"});
                       change(b, t, [&](Texture& x) { x.params.set("tex", {.type = RESTAGE_COLOR, .texture = u}); });
                       change(b, u, [&](Texture& x) { x.params.set("tex", {.type = RESTAGE_COLOR, .texture = t}); });
                   }),
                   error, "texture \"u\" contains itself through texture \"t\""));
    CHECK(
        mentions(with([&](Room& b) { change(b, b.camera, [](Camera& c) { c.fov = 180; }); }), error, "field of view"));
    CHECK(mentions(with([&](Room& b) { apply(b.scene, set_film(b.scene, Film{.width = 1000000, .height = 1000000})); }),
                   error, "the film has 1000000x1000000 pixels"));
    CHECK(mentions(with([&](Room& b) { apply(b.scene, set_film(b.scene, Film{.width = 0})); }), error,
                   "the film has 0x"));
    CHECK(mentions(
        with([&](Room& b) { change(b, b.oak, [](Material& m) { m.params.set("x", Value::number(not_a_number)); }); }),
        error, "parameter \"x\" is not a finite number"));
    CHECK(mentions(with([&](Room& b) {
                       PixelData pixels{.width = 2, .height = 2, .channels = 3, .values = std::vector<float>(11)};
                       b.add(Image{.name = "i", .data = std::make_shared<PixelData>(pixels)});
                   }),
                   error, "11 values for 2x2 pixels"));
    CHECK(mentions(with([&](Room& b) { b.add(Image{.name = "i", .path = "/gone.png"}); }), warning,
                   "/gone.png was not read"));
    // Many of one kind are counted, not listed.
    const auto many = with([&](Room& b) {
        for (int i = 0; i < 100; ++i)
            b.add(Instance{.name = "x", .mesh = b.mesh, .material = {50}});
    });
    CHECK(many.size() == 9);
    CHECK(mentions(many, error, "92 more of this kind"));
}

TEST_CASE("check_mesh finds the first thing that is wrong", "[scene]") {
    MeshData data = *test::triangle();
    CHECK(check_mesh(data).empty());
    data.triangles.push_back({0, 1, 3});
    CHECK(check_mesh(data) == "triangle 1 refers to vertex 3 of 3");
    data = *test::triangle();
    data.positions[2].y = not_a_number;
    CHECK(check_mesh(data) == "the position of vertex 2 is not a finite number");
    data = *test::triangle();
    data.uvs.resize(2);
    CHECK(check_mesh(data) == "2 texture coordinates for 3 vertices");
    CHECK(check_mesh(MeshData{}) == "has no triangles");
}
