// SPDX-License-Identifier: Apache-2.0
// scene: validate reports nothing for a valid scene and names the errors of an invalid one.
#include "scene/edits.hpp"
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

TEST_CASE("validate reports nothing for a valid scene and names the errors of an invalid one", "[scene]") {
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
        "non-finite value"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1][3] = 1; }); }), error,
                   "projective"));
    CHECK(mentions(with([&](Room& b) { change(b, b.chair, [](Instance& i) { i.object_to_world[1] = {}; }); }), warning,
                   "flattens"));
    CHECK(mentions(with([&](Room& b) { change(b, b.room, [&](Group& g) { g.parent = b.chairs; }); }), error,
                   "group \"chairs\" contains itself through group \"room\""));
    CHECK(mentions(with([&](Room& b) {
                       change(b, b.oak, [&](Material& m) {
                           m.params.set("first", Value{.type = model::ParamType::material, .material = b.oak});
                       });
                   }),
                   error, "material \"oak\" contains itself"));
    CHECK(mentions(
        with([&](Room& b) {
            const auto t = b.add(Texture{.name = "t", .type = "scale"});
            const auto u = b.add(Texture{.name = "u", .type = "scale"});
            change(b, t, [&](Texture& x) { x.params.set("tex", {.type = model::ParamType::color, .texture = u}); });
            change(b, u, [&](Texture& x) { x.params.set("tex", {.type = model::ParamType::color, .texture = t}); });
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

TEST_CASE("check_mesh finds the first error", "[scene]") {
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

TEST_CASE("an edit with values that cannot be rendered is refused with a message", "[scene]") {
    Room r;
    r.add(Light{.name = "spot", .kind = scene::LightKind::spot});
    apply(r.scene, set_environment(r.scene, Environment{.name = "sky"}));
    const float inf = std::numeric_limits<float>::infinity();
    const auto refused = [&](Result<Edit> edit, std::string_view part) {
        INFO(part);
        const auto checked = edit ? check_edit(*edit) : Result<>(fail(edit.error().message));
        REQUIRE_FALSE(checked);
        INFO(checked.error().message);
        CHECK(checked.error().message.find(part) != std::string::npos);
    };
    const auto camera = [&](auto&& f, std::string_view part) { refused(modify(r.scene, r.camera, "", f), part); };
    for (const float bad : {not_a_number, inf, -inf, -1.f}) {
        for (const float fov : {bad, 0.f, 180.f, 360.f})
            camera([&](Camera& c) { c.fov = fov; }, "field of view");
        camera([&](Camera& c) { c.lens_radius = bad; }, "lens radius");
        camera([&](Camera& c) { c.focal_distance = bad; }, "focal distance");
        camera([&](Camera& c) { c.frame_aspect = bad; }, "frame aspect");
        camera([&](Camera& c) { c.screen_window = glm::vec4(-1, bad, -1, 1); }, "screen window");
        Film film;
        film.exposure = bad;
        refused(set_film(r.scene, film), "exposure");
        for (const auto field : {&Development::temperature, &Development::vignette, &Development::bloom}) {
            film = {};
            film.development.*field = bad;
            refused(set_film(r.scene, film), "must be from");
        }
        film = {};
        film.development.tint = bad * 1000;
        refused(set_film(r.scene, film), "tint");
        film = {};
        film.filter.radius.x = bad;
        refused(set_film(r.scene, film), "pixel filter");
        film = {};
        film.filter = {.kind = FilterKind::gaussian, .radius = {2, 2}, .params = {bad, 0}};
        refused(set_film(r.scene, film), "pixel filter");
        Settings settings;
        settings.clamp_indirect = bad;
        refused(set_settings(r.scene, settings), "clamp");
        const glm::vec3 light(1, bad, 1);
        refused(set_emission(r.scene, r.chair, Emission{light, false}), "emission");
        refused(modify(r.scene, Id<Light>{1}, "", [&](Light& l) { l.value = light; }), "light \"spot\": a value");
        refused(insert(r.scene, Light{.name = "new", .value = light}, ""), "light \"new\": a value");
        refused(set_environment(r.scene, Environment{.name = "sky", .scale = light}), "the environment: a scale");
        refused(modify(r.scene, Id<Light>{1}, "", [&](Light& l) { l.cone_angle = bad; }), "spot");
    }
    for (const double bad : {double(not_a_number), double(inf), 1e300}) {
        camera([&](Camera& c) { c.camera_to_world[3][0] = bad; }, "transform");
        refused(modify(r.scene, r.chair, "", [&](Instance& i) { i.object_to_world[3][2] = bad; }), "transform");
        refused(modify(r.scene, Id<Light>{1}, "", [&](Light& l) { l.light_to_world[3][1] = bad; }), "transform");
    }
    refused(set_param(r.scene, r.oak, "x", Value::number(not_a_number)), "not a finite number");
    refused(insert(r.scene, Mesh{.name = "m", .data = std::make_shared<MeshData>()}, ""), "has no triangles");
    refused(insert(r.scene, Image{.name = "i", .data = std::make_shared<PixelData>()}, ""), "channels");

    // Invalid contents of a file may be moved, renamed and fixed, but not get new errors.
    apply(r.scene, *set_emission(r.scene, r.lamp, Emission{{1, 1, -0.01f}, false}));
    CHECK(check_edit(*set_transform(r.scene, r.lamp, glm::dmat4(1))));
    CHECK(check_edit(*set_emission(r.scene, r.lamp, Emission{{1, 1, 0}, false})));
    refused(set_emission(r.scene, r.lamp, Emission{{1, 1, inf}, false}), "emission");
    CHECK(check_edit(*modify(r.scene, r.camera, "", [](Camera& c) { c.fov = 179; })));
}
