// SPDX-License-Identifier: Apache-2.0
// Light for scenes whose file has none: metered exposure, closed rooms, scenes without any light.
#include "document/exposure.hpp"

#include "document/document.hpp"
#include "gltf_builder.hpp"
#include "query/light_meter.hpp"
#include "scene/bounds.hpp"

using namespace restage;
using namespace restage::tests;
using Catch::Approx;

namespace {

// A floor of 6 x 6, seen from above.
struct Floor : Builder {
    Floor() {
        const int p = floats({-3, 0, -3, -3, 0, 3, 3, 0, 3, 3, 0, -3}, "VEC3", 3),
                  i = accessor(raw(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), 5123, "SCALAR", 6);
        root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
        root["scenes"][0]["nodes"] = {0, 1};
        root["nodes"].push_back({{"camera", 0}, {"translation", {0, 4, 0}}, {"rotation", down}});
        root["cameras"] = {
            {{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"aspectRatio", 1}, {"znear", 0.1}}}}};
    }
    void lamp(const char* type, double intensity, std::array<double, 3> at) {
        root["scenes"][0]["nodes"].push_back(root["nodes"].size());
        root["nodes"].push_back(
            {{"translation", at}, {"rotation", down}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", type}, {"intensity", intensity}}}}}}};
    }
    const json down = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}; // -z of a node to -y
};

io::ImportedScene opened(const ModelFiles& files, const std::string& name) {
    auto in = document::read_scene(files.path(name), files.registry, {});
    if (!in) FAIL(in.error().message);
    return std::move(*in);
}
io::ImportedScene opened(const ModelFiles& files, Builder& b) {
    files.write("a.gltf", b.text());
    return opened(files, "a.gltf");
}

} // namespace

TEST_CASE("exposure: lamps in lux and candela are metered, the same every time", "[exposure]") {
    ModelFiles files;
    Floor sun; // 2049 lux, what 3 W/m^2 of Blender's become: a white floor has the radiance 2049 / pi
    sun.lamp("directional", 2049, {0, 0, 0});
    const auto in = opened(files, sun);
    const float exposure = in.scene.film.value.exposure;
    CHECK(double(exposure) == Approx(0.6 * 3.14159265 / 2049).epsilon(0.01));
    CHECK(says(in, io::Fate::kept, "", "exposure: set to "));
    CHECK(in.scene.lights[{1}].value == glm::vec3(2049)); // the light stays as the file gives it
    CHECK(opened(files, sun).scene.film.value.exposure == exposure);
    Floor weak; // 1 candela, 4 above a floor: 1/16 lux
    weak.lamp("point", 1, {0, 4, 0});
    CHECK(double(opened(files, weak).scene.film.value.exposure) == Approx(0.6 * 3.14159265 * 16).epsilon(0.1));
    Floor usual; // a scene with a usable exposure is unchanged
    usual.lamp("directional", 3, {0, 0, 0});
    CHECK(opened(files, usual).scene.film.value.exposure == 1);
    CHECK(opened(files, usual).report.entries == opened(files, usual).report.entries);
}

TEST_CASE("exposure: scenes with ineffective lamps get a studio, closed rooms a lamp", "[exposure]") {
    ModelFiles files;
    Floor below; // the lamp lights the floor's back
    below.lamp("point", 100, {0, -1, 0});
    auto in = opened(files, below);
    CHECK(in.scene.environment.value);
    CHECK(in.scene.lights.live() == 1);
    CHECK(says(in, io::Fate::kept, "", "light: that of the file does not reach what the camera sees"));
    Builder room; // a box around its camera
    const int p = room.floats({-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1},
                              "VEC3", 3),
              i = room.accessor(raw(std::vector<std::uint8_t>{0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                              2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5}),
                                5121, "SCALAR", 36);
    room.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
    room.root["scenes"][0]["nodes"] = {0, 1};
    room.root["nodes"].push_back({{"camera", 0}});
    room.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    in = opened(files, room);
    REQUIRE(in.scene.lights.live() == 1);
    CHECK(says(in, io::Fate::kept, "", "a lamp at the camera is added"));
    CHECK(document::read_light(in.scene, files.registry).white == Approx(0.6).epsilon(0.01));
    CHECK(in.scene.film.value.exposure == 1);
}

TEST_CASE("exposure: scenes of other formats are unchanged; those without light are reported", "[exposure]") {
    ModelFiles files;
    const std::string dark = "Camera \"perspective\"\nWorldBegin\nTranslate 0 0 5\nShape \"sphere\"\n";
    files.write("dark.pbrt", dark);
    auto in = opened(files, "dark.pbrt");
    CHECK_FALSE(document::has_light(in.scene, files.registry));
    CHECK(says(in, io::Fate::kept, "", "light: nothing emits light in this scene, so its picture is black"));
    CHECK(in.scene.lights.live() == 0);
    CHECK(in.scene.film.value.exposure == 1);
    files.write("bright.pbrt",
                "Camera \"perspective\"\nWorldBegin\nLightSource \"distant\" \"rgb L\" [ 9000 9000 9000 ]\n"
                "Translate 0 0 5\nShape \"sphere\"\n");
    in = opened(files, "bright.pbrt");
    CHECK(in.scene.film.value.exposure == 1);
    // As by the button.
    in = opened(files, "dark.pbrt");
    scene::apply(in.scene, document::light_studio(in.scene, files.registry));
    CHECK(in.scene.environment.value);
    CHECK(document::has_light(in.scene, files.registry));
    CHECK(document::read_light(in.scene, files.registry).lit > 0.9);
}

TEST_CASE("exposure: a spot is metered with its own falloff", "[exposure]") {
    // A floor of 6 x 6 from 4 above, wholly within the fading edge of a spot where the camera is: over so wide an edge
    // t^4 is darker than t^2 (3 - 2t), everywhere.
    const auto reading = [](scene::Falloff falloff) {
        scene::Scene s;
        auto floor = std::make_shared<scene::MeshData>();
        floor->positions = {{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}};
        floor->triangles = {{0, 1, 2}, {0, 2, 3}};
        scene::compute_bounds(*floor);
        s.meshes.set({1}, scene::Mesh{.name = "floor", .data = floor}, 1);
        s.instances.set({1}, scene::Instance{.name = "floor", .mesh = {1}}, 1);
        const glm::dmat4 down{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 4, 0, 1}}; // +z to -y
        s.lights.set({1},
                     scene::Light{.kind = scene::LightKind::spot,
                                  .value = glm::vec3(10),
                                  .light_to_world = down,
                                  .cone_angle = 60,
                                  .cone_delta = 60,
                                  .falloff = falloff},
                     1);
        s.cameras.set({1}, scene::Camera{.name = "camera", .camera_to_world = down, .fov = 50}, 1);
        s.active_camera.value = {1};
        return query::read_light(s, {.passes = [](const auto&) { return false; },
                                     .emission = [](const auto&) { return std::nullopt; },
                                     .albedo = [](const auto&) { return 0.0; }})
            .white;
    };
    // With c = cos of the angle to the axis, E = 10 c^3 / 16 f(t), t = (c - 1/2) / (1 - 1/2).
    const double smooth = reading(scene::Falloff::smooth), quartic = reading(scene::Falloff::quartic);
    CHECK(smooth > 0.1);
    CHECK(quartic < 0.95 * smooth);
}
