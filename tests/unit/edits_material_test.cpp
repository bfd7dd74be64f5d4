// SPDX-License-Identifier: Apache-2.0
// edits_material: a new type keeps compatible values, a unique copy does not affect others, images are shared. And the
// colour temperature used by light widgets.
#include "scene/color_temperature.hpp"
#include "scene/edits.hpp"
#include "scene/history.hpp"

#include <array>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;

namespace {

template <class T>
Id<T> add(Scene& scene, T item) {
    const Id<T> id = table<T>(scene).next();
    apply(scene, insert(scene, std::move(item), "add"));
    return id;
}

using model::ParamType;
const std::vector<model::Param> matte{
    {.id = "reflectance", .type = ParamType::color, .texturable = true, .def = {0.5f, 0.5f, 0.5f}},
    {.id = "eta", .type = ParamType::color, .max = 10, .def = {1, 1, 1}},
    {.id = "uroughness", .type = ParamType::number, .def = {0.1f}},
};
const std::vector<model::Param> gloss{
    {.id = "kd", .type = ParamType::color, .texturable = true, .def = {0.25f, 0.25f, 0.25f}},
    {.id = "eta", .type = ParamType::number, .min = 1, .max = 3, .def = {1.5f}},
    {.id = "roughness", .type = ParamType::number, .def = {0.2f}},
    {.id = "depth", .type = ParamType::number, .max = 2, .def = {1}},
};

Material switched(const Material& material, ParamTable before, ParamTable after) {
    Scene scene;
    const auto id = add(scene, material);
    auto edit = switch_material_type(scene, id, "other", before, after);
    REQUIRE(edit);
    apply(scene, *edit);
    return scene.materials[id];
}

} // namespace

TEST_CASE("changing a material's type keeps the common values", "[scene][materials]") {
    Material m{.name = "paint", .type = "matte"};
    m.params.set("reflectance", Value::color(0.8f, 0.1f, 0.2f));
    m.params.set("uroughness", Value::number(0.4f));
    m.params.set("eta", Value::color(4, 5, 6)); // a colour there, a number here
    m.params.set("depth", Value::number(7));    // out of the new range
    m.params.set("unknown", Value::number(3));
    const Material after = switched(m, matte, gloss);
    CHECK(after.type == "other");
    CHECK(after.params.color("kd", {}) == std::array{0.8f, 0.1f, 0.2f}); // the main colour, under its new name
    CHECK(after.params.number("roughness", -1) == 0.4f);
    CHECK_FALSE(after.params.find("eta")); // incompatible: the new default applies
    CHECK(after.params.number("depth", -1) == 2);
    CHECK(after.params.number("unknown", -1) == 3);
    CHECK(after.params.color("reflectance", {}) == std::array{0.8f, 0.1f, 0.2f}); // and back again
}

TEST_CASE("a default colour carries over to the new type; values set there stay", "[scene][materials]") {
    CHECK(switched({.name = "m", .type = "matte"}, matte, gloss).params.color("kd", {}) ==
          std::array{0.5f, 0.5f, 0.5f});
    Material m{.name = "m", .type = "matte"};
    m.params.set("kd", Value::color(0, 1, 0));
    CHECK(switched(m, matte, gloss).params.color("kd", {}) == std::array{0.f, 1.f, 0.f});
}

TEST_CASE("a texture is kept only if the new type accepts one", "[scene][materials]") {
    Material m{.name = "m", .type = "matte"};
    m.params.set("roughness", {.type = model::ParamType::number, .texture = {1}});
    CHECK_FALSE(switched(m, {}, gloss).params.find("roughness")); // its default applies
    m.params.set("kd", {.type = model::ParamType::color, .texture = {1}});
    CHECK(switched(m, {}, gloss).params.texture("kd") == Id<Texture>{1});
}

TEST_CASE("make_unique copies a material for some of the objects that share it", "[scene][materials]") {
    Scene scene;
    const auto oak = add(scene, Material{.name = "oak", .type = "diffuse"});
    const auto steel = add(scene, Material{.name = "steel", .type = "conductor"});
    const auto a = add(scene, Instance{.name = "a", .material = oak});
    const auto b = add(scene, Instance{.name = "b", .material = oak});
    const auto c = add(scene, Instance{.name = "c", .material = steel});
    auto made = make_unique(scene, std::array{a, c}, oak);
    REQUIRE(made);
    History history;
    REQUIRE(history.push(scene, made->edit));
    CHECK(scene.materials[made->material].name == "oak 2");
    CHECK(scene.materials[made->material].type == "diffuse");
    CHECK(scene.instances[a].material == made->material);
    CHECK(scene.instances[b].material == oak);
    CHECK(scene.instances[c].material == steel); // it never had this material
    REQUIRE(history.undo(scene));
    CHECK(scene.instances[a].material == oak);
    CHECK(scene.materials.live() == 2);
    CHECK_FALSE(make_unique(scene, std::array{c}, oak));
    CHECK_FALSE(make_unique(scene, std::array{a}, Id<Material>{99}));
}

TEST_CASE("an image for a parameter is shared with textures that already show it", "[scene][materials]") {
    Scene scene;
    const auto oak = add(scene, Material{.name = "oak", .type = "diffuse"});
    const auto walnut = add(scene, Material{.name = "walnut", .type = "diffuse"});
    const auto pixels = std::make_shared<const PixelData>(PixelData{1, 1, 3, {1, 1, 1}});
    const Image image{
        .name = "grain", .path = "/somewhere/grain.png", .encoding = scene::Encoding::srgb, .data = pixels};
    apply(scene, *set_image_texture(scene, oak, "reflectance", model::ParamType::color, false, image));
    const auto texture = scene.materials[oak].params.texture("reflectance");
    REQUIRE(texture);
    CHECK(scene.textures[texture].name == "grain");
    CHECK(scene.textures[texture].type == "imagemap");
    CHECK(scene.images[scene.textures[texture].image].path == image.path);
    apply(scene, *set_image_texture(scene, walnut, "reflectance", model::ParamType::color, false, image));
    CHECK(scene.materials[walnut].params.texture("reflectance") == texture);
    CHECK(scene.images.live() == 1);
    // As data it is a different image, with different values.
    Image data = image;
    data.encoding = scene::Encoding::linear;
    apply(scene, *set_image_texture(scene, oak, "bump", model::ParamType::texture, true, data));
    const auto bump = scene.materials[oak].params.texture("bump");
    CHECK(bump != texture);
    CHECK(scene.textures[bump].name == "grain 2");
    CHECK(scene.textures[bump].is_float);
    CHECK(scene.images.live() == 2);
    CHECK_FALSE(set_image_texture(scene, {99}, "bump", model::ParamType::texture, true, data));
}

TEST_CASE("colour temperatures are those of the standard lamps", "[scene][materials]") {
    // CIE illuminant A, 2856 K: x 0.4476, y 0.4074; its linear sRGB, the largest channel 1, is (1, 0.448, 0.126).
    const glm::dvec3 a = scene::blackbody_color(2856);
    CHECK(a.x == 1);
    CHECK(a.y == Approx(0.448).margin(0.005));
    CHECK(a.z == Approx(0.126).margin(0.005));
    CHECK(scene::blackbody_color(12000).z == 1);
    CHECK(scene::color_temperature({1, 1, 1}) == Approx(6504).margin(20)); // D65
    for (const double t : {2000.0, 3200.0, 5000.0, 8000.0})
        CHECK(scene::color_temperature(scene::blackbody_color(t)) == Approx(t).epsilon(0.03));
    CHECK(scene::color_temperature({0, 0, 0}) == 0);
    CHECK(scene::color_temperature({0, 0, 1}) == 0);
}
