// SPDX-License-Identifier: Apache-2.0
// Layers of a scene's lights, and the weights of a mix as an edit.
#include "view/light_layers.hpp"

#include "export_scene.hpp"
#include "scene/edits_light.hpp"
#include "scene/emission.hpp"
#include "scene_room.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using view::key_of, view::LightLayer;

namespace {

struct Lit : test::Room {
    test::Plugins plugins;
    Id<Light> spot, off;
    Id<Material> glow;
    Id<Instance> sign, sign2;
    Lit() {
        spot = add(Light{.name = "spot", .kind = LightKind::spot, .value = glm::vec3(2)});
        off = add(Light{.name = "off", .hidden = true});
        apply(scene, *set_emission(scene, lamp, Emission{.radiance = glm::vec3(1, 2, 3)}));
        glow = add(Material{.name = "glow", .type = "emissive"});
        glm::dmat4 large(4);
        large[3] = {0, 0, 0, 1};
        sign = add(Instance{.name = "sign", .mesh = mesh, .material = glow, .object_to_world = large});
        sign2 = add(Instance{.name = "sign 2", .mesh = mesh, .material = glow});
        apply(scene, set_environment(scene, Environment{.name = "sky", .scale = glm::vec3(2)}));
    }
    std::vector<LightLayer> layers(std::size_t most = 12) { return view::light_layers(scene, plugins.registry, most); }
    Result<Edit> weighed(std::vector<glm::vec3> weights, std::size_t most = 12) {
        return view::weigh_lights(scene, plugins.registry, layers(most), weights);
    }
};

} // namespace

TEST_CASE("light layers: the sky, lights that are on, and objects that emit alike") {
    Lit r;
    const auto layers = r.layers();
    REQUIRE(layers.size() == 4);
    CHECK(layers[0].lights == std::vector{view::sky_key});
    CHECK(layers[1].name == "spot");
    CHECK(layers[2].name == "sign and 1 more"); // the larger: 10 * 17 times the triangle
    CHECK(layers[2].lights == std::vector{key_of(r.sign), key_of(r.sign2)});
    CHECK(layers[3].lights == std::vector{key_of(r.lamp)});
    const Id<Instance> ids[] = {r.sign};
    apply(r.scene, *set_hidden(r.scene, ids, true));
    CHECK(r.layers()[2].lights == std::vector{key_of(r.sign2)});
    CHECK(r.layers()[2].name == "sign 2");
}

TEST_CASE("light layers: the last of too many are one") {
    Lit r;
    const auto layers = r.layers(3);
    REQUIRE(layers.size() == 3);
    CHECK(layers[1].name == "spot");
    CHECK(layers[2].name == "2 others");
    CHECK(layers[2].lights == std::vector{key_of(r.sign), key_of(r.sign2), key_of(r.lamp)});
}

TEST_CASE("light layers: weights become the lights' values, by one edit that undo takes back") {
    Lit r;
    const Scene before = r.scene;
    const auto edit = r.weighed({{0.5f, 1, 1}, glm::vec3(3), {2, 1, 0.5f}, glm::vec3(1, 1, 2)});
    REQUIRE(edit);
    apply(r.scene, *edit);
    CHECK(r.scene.environment.value->scale == glm::vec3(1, 2, 2));
    CHECK(r.scene.lights[r.spot].value == glm::vec3(6));
    CHECK(r.scene.instances[r.lamp].emission->radiance == glm::vec3(1, 2, 6));
    CHECK_FALSE(r.scene.instances[r.sign].emission); // it still emits by its material, once
    const auto glow =
        emission_of(*r.plugins.registry.find_material("emissive")->table, r.scene.materials[r.glow].params);
    REQUIRE(glow);
    CHECK(glow->radiance == glm::vec3(20, 10, 5));
    CHECK(r.scene.materials[r.glow].params.find("scale")->scalar() == 20); // colours stay within 0 to 1
    apply(r.scene, inverse(*edit));
    CHECK(r.scene.environment.value == before.environment.value);
    CHECK(r.scene.materials[r.glow] == before.materials[r.glow]);
    CHECK(r.scene.instances[r.lamp] == before.instances[r.lamp]);
    CHECK(r.weighed({glm::vec3(1), glm::vec3(1)})->changes.empty());
}

TEST_CASE("light layers: what is coloured by a texture is only dimmed") {
    Lit r;
    const auto texture = r.add(Texture{.name = "picture", .type = "constant"});
    Value color = Value::color(0, 0, 0);
    color.texture = texture;
    apply(r.scene, *set_param(r.scene, r.glow, "radiance", color));
    REQUIRE(r.layers().size() == 4);
    const auto of_sign = [&] {
        const auto all = r.layers();
        return *std::ranges::find_if(all, [](const LightLayer& layer) { return layer.name == "sign and 1 more"; });
    }();
    CHECK_FALSE(of_sign.tinted);
    const LightLayer layers[] = {of_sign};
    const glm::vec3 half[] = {glm::vec3(0.5f)}, red[] = {{1, 0, 0}};
    const auto dimmed = view::weigh_lights(r.scene, r.plugins.registry, layers, half);
    REQUIRE(dimmed);
    apply(r.scene, *dimmed);
    CHECK(r.scene.materials[r.glow].params.find("scale")->scalar() == 5);
    CHECK(r.scene.materials[r.glow].params.texture("radiance") == texture);
    const auto tinted = view::weigh_lights(r.scene, r.plugins.registry, layers, red);
    REQUIRE_FALSE(tinted);
    CHECK_THAT(tinted.error().message, ContainsSubstring("not tinted"));
}
