// SPDX-License-Identifier: Apache-2.0
// The two tracers give the same picture. With different seeds, within their noise; with the same seed, nearly the same
// values, since both use the same path step and only rounding in the search for hits differs.
#include "render/agreement.hpp"
#include "render/scene_builder.hpp"

#include <catch2/catch_template_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr std::uint32_t spp = 64;

struct Expected {
    double alike = 0.97;   // fraction of pixels within 0.1 % with the same seed; 0 = hashes of the last bit decide
    double ids = 0.99;     // fraction of pixels with the same instance and material
    double guides = 0.005; // mean difference
};

void check_agreement(const scene::Scene& scene, const Expected& expected = {}) {
    const auto vulkan = trace_scene("vulkan", scene, spp, 1);
    const auto same = trace_scene("embree", scene, spp, 1);
    const auto other = trace_scene("embree", scene, spp, 2);
    check_independent(vulkan.image, other.image);
    const double alike = share_alike(vulkan.image, same.image);
    INFO("fraction of equal pixels with the same seed: " << alike);
    CHECK(alike >= expected.alike);
    if (expected.alike > 0)
        CHECK(share_alike(vulkan.image, other.image) < 0.8 * expected.alike); // else the line above proves nothing
    // The same paths, so about as many rays: counted by the device here, by the CPU there.
    CHECK(std::abs(double(vulkan.stats.rays) / double(same.stats.rays) - 1) < 0.01);
    CHECK(std::abs(double(vulkan.stats.shadow_rays) / double(same.stats.shadow_rays) - 1) < 0.01);
    CHECK(vulkan.stats.paths == same.stats.paths);
    // Guides: what the first hits are does not depend on noise.
    std::size_t ids = 0;
    double normals = 0, depths = 0, albedos = 0;
    for (std::size_t i = 0; i < same.image.color.size(); ++i) {
        ids += vulkan.image.instance_id[i] == same.image.instance_id[i] &&
               vulkan.image.material_id[i] == same.image.material_id[i];
        normals += glm::length(vulkan.image.normal[i] - same.image.normal[i]);
        albedos += glm::length(vulkan.image.albedo[i] - same.image.albedo[i]);
        depths += std::abs(vulkan.image.depth[i] - same.image.depth[i]) / std::max(same.image.depth[i], 1.f);
    }
    const double n = double(same.image.color.size());
    CHECK(double(ids) >= expected.ids * n);
    CHECK(normals / n < expected.guides);
    CHECK(albedos / n < expected.guides);
    CHECK(depths / n < expected.guides);
}

scene::Id<scene::Texture> texture(SceneBuilder& b, std::string type, scene::Id<scene::Image> image = {},
                                  scene::ParamSet params = {}) {
    const auto id = b.scene.textures.next();
    b.scene.textures.set(
        id, scene::Texture{.name = type, .type = std::move(type), .image = image, .params = std::move(params)},
        ++b.scene.clock);
    return id;
}
scene::Value textured(scene::Value value, scene::Id<scene::Texture> texture) {
    value.texture = texture;
    return value;
}
// Smooth and colourful, in [lo, hi].
scene::Id<scene::Image> waves(SceneBuilder& b, std::uint32_t size, std::uint32_t channels, float lo, float hi) {
    std::vector<float> values;
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x)
            for (std::uint32_t c = 0; c < channels; ++c)
                values.push_back(lo + (hi - lo) * (0.5f + 0.5f * std::sin(0.9f * float(x) + 1.7f * float(c)) *
                                                              std::cos(0.7f * float(y) - 0.6f * float(c))));
    return b.image(size, size, channels, std::move(values));
}
glm::dmat4 at(double x, double y, double z, double scale = 1) {
    return glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(x, y, z)), glm::dvec3(scale));
}
scene::Id<scene::Instance> floor_of(SceneBuilder& b, scene::Id<scene::Material> material) {
    return b.instance(b.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), material);
}
void area_light(SceneBuilder& b, glm::vec3 radiance) { // above the scene, emitting down
    b.instance(b.quad({-2, -2, 6}, {-2, 2, 6}, {2, 2, 6}, {2, -2, 6}), b.diffuse(0, 0, 0), glm::dmat4(1),
               scene::Emission{radiance});
}
void edit_instance(SceneBuilder& b, scene::Id<scene::Instance> id, auto&& change) {
    auto instance = b.scene.instances[id];
    change(instance);
    b.scene.instances.set(id, instance, ++b.scene.clock);
}
void environment_image(SceneBuilder& b, scene::Mapping mapping) {
    std::vector<float> sky;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            const bool sun = x == 5 && y == 6;
            for (const float c : {0.3f, 0.4f, 0.6f})
                sky.push_back(sun ? 40.f : c * (1.f + 0.05f * float(y)));
        }
    const auto image = b.image(16, 16, 3, std::move(sky));
    b.scene.environment = {
        scene::Environment{.name = "sky",
                           .image = image,
                           .mapping = mapping,
                           .scale = glm::vec3(0.8f),
                           .light_to_world = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.3, 1, 0.2))},
        ++b.scene.clock};
}

// The types of all material plugins except those that need something else (mixes, interfaces), which have
// their own scenes below.
std::vector<const model::Material*> material_types() {
    std::vector<const model::Material*> types;
    for (const auto& entry : plugins().registry.materials())
        if (entry.table->has_code()) types.push_back(entry.table);
    return types;
}

// Two spheres of each type: behind with its table's defaults, in front with textures and roughness.
void gallery(SceneBuilder& b, const std::vector<const model::Material*>& types) {
    b.set_film(64, 36);
    b.set_camera({0, -11, 4.5}, {0, 0.2, 0.7}, {0, 0, 1}, 30);
    const auto colors = texture(b, "imagemap", waves(b, 8, 3, 0.1f, 0.45f));
    const auto heights = texture(b, "imagemap", waves(b, 8, 1, 0, 0.1f));
    scene::ParamSet checks;
    checks.set("tex1", scene::Value::color(0.6f, 0.5f, 0.4f));
    checks.set("tex2", scene::Value::color(0.2f, 0.2f, 0.3f));
    checks.set("uscale", scene::Value::number(12));
    checks.set("vscale", scene::Value::number(12));
    scene::ParamSet ground;
    ground.set("reflectance", textured(scene::Value::color(1, 1, 1), texture(b, "checkerboard", {}, checks)));
    ground.set("sigma", scene::Value::number(20));
    floor_of(b, b.material("diffuse", ground));
    area_light(b, glm::vec3(6));
    const auto ball = b.sphere(24, 48);
    for (std::size_t k = 0; k < types.size(); ++k) {
        const model::Material& table = *types[k];
        const double x = 2.0 * (double(k) - 0.5 * double(types.size() - 1));
        b.instance(ball, b.material(table.type), at(x, 1.8, 0.85, 0.85));
        scene::ParamSet params;
        for (std::uint32_t p = 0; p < table.params.size(); ++p) {
            const model::Param& line = table.params[p];
            const std::string_view id = line.id;
            if (line.type == model::ParamType::color && line.texturable && line.max <= 1)
                params.set(id, textured(scene::default_value(line), colors));
            if (line.type == model::ParamType::number && id.find("rough") != id.npos)
                params.set(id, scene::Value::number(id.find('u') < id.find("rough") ? 0.15f : 0.35f));
        }
        params.set("bump", textured(scene::Value::number(0), heights));
        b.instance(ball, b.material(table.type, params), at(x, -0.8, 0.85, 0.85));
    }
}

} // namespace

// Every type is in one of the parts, which are separate cases: with cold caches, compiling them all takes ten
// minutes.
constexpr std::size_t gallery_parts = 8;

TEMPLATE_TEST_CASE_SIG("tracers agree: every material, area light, sky, textures and bump", "",
                       ((std::size_t Part), Part), 0, 1, 2, 3, 4, 5, 6, 7) {
    static_assert(Part < gallery_parts);
    const auto all = material_types();
    REQUIRE(all.size() >= 11);
    std::vector<const model::Material*> types;
    for (std::size_t k = Part; k < all.size(); k += gallery_parts)
        types.push_back(all[k]);
    SceneBuilder b;
    gallery(b, types);
    environment_image(b, Part % 2 == 0 ? scene::Mapping::equirect : scene::Mapping::octahedral);
    check_agreement(b.scene);
}

TEST_CASE("tracers agree: mixes and cut-outs") {
    SceneBuilder b;
    b.set_film(64, 36);
    b.set_camera({0, -11, 4.5}, {0, 0.2, 0.7}, {0, 0, 1}, 30);
    b.scene.film.value.filter = {.kind = scene::FilterKind::triangle, .radius = glm::vec2(1.5f)};
    const auto amounts = texture(b, "imagemap", waves(b, 8, 1, -0.2f, 1.2f));
    scene::ParamSet flip;
    flip.set("tex", textured(scene::Value::number(1), amounts));
    flip.set("scale", scene::Value::number(0.8f));
    const auto scaled = texture(b, "scale", {}, flip);
    const auto mix = [&](scene::Id<scene::Material> first, scene::Id<scene::Material> second, scene::Value amount) {
        scene::ParamSet p;
        p.set("first", {.type = model::ParamType::material, .material = first});
        p.set("second", {.type = model::ParamType::material, .material = second});
        p.set("amount", amount);
        return b.material("mix", p);
    };
    const auto gold = b.material("conductor");
    const auto inner = mix(b.diffuse(0.7f, 0.1f, 0.1f), b.diffuse(0.1f, 0.2f, 0.7f), scene::Value::number(0.3f));
    const auto ball = b.sphere(24, 48), panel = b.quad({-1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 2});
    floor_of(b,
             mix(b.diffuse(0.6f, 0.6f, 0.6f), b.diffuse(0.2f, 0.3f, 0.2f), textured(scene::Value::number(0), scaled)));
    b.instance(ball, mix(gold, inner, textured(scene::Value::number(0), amounts)), at(-3.2, 0, 0.9, 0.9));
    b.instance(ball, mix(inner, {}, scene::Value::number(0.5f)),
               at(-1, 0.6, 0.9, 0.9)); // a missing child: the placeholder
    b.instance(ball, mix(b.material("interface"), gold, scene::Value::number(0.5f)),
               at(-3, 2.6, 0.9, 0.9)); // full of holes
    edit_instance(b, b.instance(panel, b.diffuse(0.3f, 0.7f, 0.3f), at(1.2, -0.6, 0)),
                  [&](auto& i) { i.alpha_texture = scaled; });
    edit_instance(b, b.instance(panel, b.diffuse(0.8f, 0.7f, 0.3f), at(3.4, -0.3, 0)),
                  [&](auto& i) { i.alpha = 0.4f; });
    edit_instance(b, b.instance(ball, gold, at(1.2, 2, 0.9, 0.9)), [&](auto& i) { i.alpha = 0; }); // does not exist
    b.instance(panel, b.diffuse(0.8f, 0.7f, 0.3f), at(3.4, 1.5, 0)); // the same mesh, without cut-outs
    area_light(b, glm::vec3(6));
    b.environment(glm::vec3(0.4f, 0.5f, 0.7f));
    check_agreement(b.scene, {.alike = 0, .ids = 0.7, .guides = 0.05});
}

TEST_CASE("tracers agree: lamps without surface, lens, crop window, tabulated filter, two-sided emission") {
    SceneBuilder b;
    b.set_film(96, 54);
    b.set_camera({0, -11, 4.5}, {0, 0.2, 0.7}, {0, 0, 1}, 30);
    b.scene.film.value.crop = glm::vec4(0.1f, 0.8f, 0.2f, 0.9f);
    b.scene.film.value.filter = {
        .kind = scene::FilterKind::mitchell, .radius = glm::vec2(2), .params = glm::vec2(1.f / 3)};
    auto camera = b.scene.cameras[b.scene.active_camera.value];
    camera.lens_radius = 0.15f;
    camera.focal_distance = 10;
    b.scene.cameras.set(b.scene.active_camera.value, camera, ++b.scene.clock);
    scene::ParamSet bumps;
    bumps.set("reflectance", scene::Value::color(0.6f, 0.5f, 0.4f));
    bumps.set("normalmap",
              textured(scene::Value::color(0.5f, 0.5f, 1), texture(b, "imagemap", waves(b, 8, 3, 0.4f, 1.f))));
    floor_of(b, b.material("diffuse", bumps));
    const auto ball = b.sphere(24, 48);
    scene::ParamSet glossy;
    glossy.set("roughness", scene::Value::number(0.2f));
    b.instance(ball, b.material("plastic", glossy), at(-2, 0, 1));
    edit_instance(b, b.instance(ball, b.material("mirror"), glm::scale(at(1.5, 1, 1), glm::dvec3(-1, 0.7, 1))),
                  [&](auto& i) { i.reverse_orientation = true; });
    b.instance(b.quad({3, 0, 0.5}, {4, 0, 0.5}, {4, 0.5, 1.5}, {3, 0.5, 1.5}), b.material("interface"), glm::dmat4(1),
               scene::Emission{glm::vec3(3), true});
    b.instance(ball, b.material("interface"), at(-2, -2, 1)); // nothing to see
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(15, 10, 8), .light_to_world = at(-4, -3, 4)});
    b.light({.kind = scene::LightKind::spot,
             .value = glm::vec3(30, 40, 60),
             .light_to_world = glm::rotate(at(2, -2, 5), 3.0, glm::dvec3(1, 0, 0)),
             .cone_angle = 25,
             .cone_delta = 10});
    b.light({.kind = scene::LightKind::distant,
             .value = glm::vec3(0.6f),
             .light_to_world = glm::rotate(glm::dmat4(1), 2.4, glm::dvec3(1, 0.3, 0))});
    b.scene.settings.value.clamp_indirect = 4;
    check_agreement(b.scene);
}

TEST_CASE("tracers agree: glass with an absorbing medium, a rim of rough glass, a cloud without surface") {
    SceneBuilder b;
    b.set_film(64, 36);
    b.set_camera({0, -11, 4.5}, {0, 0.2, 0.7}, {0, 0, 1}, 30);
    b.scene.settings.value.max_depth = 10;
    const auto tea = b.scene.media.next();
    b.scene.media.set(tea, scene::Medium{.name = "tea", .sigma_a = glm::vec3(0.2f, 0.6f, 1.5f)}, ++b.scene.clock);
    floor_of(b, b.diffuse(0.6f, 0.6f, 0.6f));
    const auto ball = b.sphere(32, 64);
    scene::ParamSet rough;
    rough.set("uroughness", scene::Value::number(0.3f));
    rough.set("vroughness", scene::Value::number(0.3f));
    const auto fill = [&](auto& i) { i.media = scene::MediumInterface{.interior = tea}; };
    edit_instance(b, b.instance(ball, b.material("dielectric"), at(-1.5, 0, 1.2, 1.2)), fill);
    edit_instance(b, b.instance(ball, b.material("dielectric", rough), at(1.5, 0, 1.2, 1.2)), fill);
    edit_instance(b, b.instance(ball, b.material("interface"), at(0, -2, 1, 1.5)), fill);
    area_light(b, glm::vec3(6));
    b.environment(glm::vec3(0.3f));
    check_agreement(b.scene);
}

TEST_CASE("validation and synchronization validation are silent") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    const auto types = material_types();
    REQUIRE(types.size() >= 2);
    gallery(b, {types[0], types[1]});
    environment_image(b, scene::Mapping::equirect);
    const auto renderer = make_renderer(tracer, {.validation = true});
    render_image(*renderer, b.scene, 3);
    // an edit of everything that is updated in place: an instance moves, one comes, a mesh is replaced
    const scene::Id<scene::Instance> moved{3};
    edit_instance(b, moved, [](auto& i) { i.object_to_world[3].z += 0.5; });
    b.instance(b.quad({-1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 2}), b.material("mirror"));
    const auto image = render_image(*renderer, b.scene, 3);
    CHECK(image.samples == 3);
    for (const auto& message : renderer->device().validation_messages())
        FAIL_CHECK(message);
}
