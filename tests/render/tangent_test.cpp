// SPDX-License-Identifier: Apache-2.0
// Normal maps against n.l: with the mesh's tangents (glTF), for mirrored uv and mirrored objects, and without
// tangents as in pbrt; both tracers.
#include "render/checks.hpp"

#include <array>
#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr float albedo = 0.8f, irradiance = 2;
const glm::vec3 map(0.5f, -0.25f, 0.75f); // in the map's axes; its texel has no rounding
const glm::dvec3 to_light = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));

struct Quad {
    std::array<glm::vec2, 4> uvs; // of its corners (-1,-1), (1,-1), (1,1), (-1,1)
    glm::vec3 u, v;               // where uv grow on it
};
const Quad quads[] = {
    {{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, {1, 0, 0}, {0, 1, 0}},
    {{{{1, 0}, {0, 0}, {0, 1}, {1, 1}}}, {-1, 0, 0}, {0, 1, 0}},  // mirrored
    {{{{0, 1}, {1, 1}, {1, 0}, {0, 0}}}, {1, 0, 0}, {0, -1, 0}},  // mirrored
    {{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}}, {-1, 0, 0}, {0, -1, 0}}, // rotated by 180 degrees
    {{{{0, 1}, {0, 0}, {1, 0}, {1, 1}}}, {0, 1, 0}, {-1, 0, 0}},  // by 90
    {{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}}, {0, 1, 0}, {1, 0, 0}},   // by 90, mirrored
};

scene::Id<scene::Material> mapped(SceneBuilder& b) {
    const glm::vec3 texel = 0.5f * map + 0.5f;
    scene::Texture texture{
        .name = "normals", .type = "imagemap", .image = b.image(1, 1, 3, {texel.x, texel.y, texel.z})};
    const auto id = b.scene.textures.next();
    b.scene.textures.set(id, texture, ++b.scene.clock);
    scene::ParamSet p;
    p.set("reflectance", scene::Value::color(albedo, albedo, albedo));
    p.set("normalmap", {.type = model::ParamType::texture, .v = {}, .text = {}, .texture = id, .material = {}});
    return b.material("diffuse", p);
}

void light(SceneBuilder& b, glm::dvec3 towards) {
    const glm::dvec3 z = -towards, x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), z)), y = glm::cross(z, x);
    b.light(
        {.kind = scene::LightKind::distant,
         .value = glm::vec3(irradiance),
         .light_to_world = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1))});
}

double radiance(const std::string& tracer, const Quad& quad, bool tangents, const glm::dmat4& place, glm::dvec3 lamp) {
    SceneBuilder b;
    b.scene.settings.value.max_depth = 1;
    look_down(b);
    light(b, lamp);
    scene::MeshData m{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                      .normals = std::vector<glm::vec3>(4, glm::vec3(0, 0, 1)),
                      .uvs = {quad.uvs.begin(), quad.uvs.end()},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
    const float side = glm::dot(glm::cross(glm::vec3(0, 0, 1), quad.u), quad.v);
    if (tangents) m.tangents.assign(4, glm::vec4(quad.u, side));
    b.instance(b.mesh(std::move(m)), mapped(b), place);
    return mean_luminance(render_image(*make_renderer(tracer), b.scene, 4)).value;
}

double expected(const glm::vec3& u, const glm::vec3& v, glm::dvec3 lamp) {
    const glm::vec3 n = glm::normalize(map.x * u + map.y * v + map.z * glm::vec3(0, 0, 1));
    return double(albedo * irradiance) / std::numbers::pi * glm::dot(glm::dvec3(n), lamp);
}

} // namespace

TEST_CASE("normals follow the normal map, for any uv layout") {
    const std::string tracer = GENERATE("embree", "vulkan");
    for (const Quad& quad : quads) {
        INFO(tracer << ", u along " << quad.u.x << " " << quad.u.y << ", v along " << quad.v.x << " " << quad.v.y);
        const double with = radiance(tracer, quad, true, glm::dmat4(1), to_light);
        CHECK(std::abs(with - expected(quad.u, quad.v, to_light)) < 1e-4);
        // pbrt's: y is across the normal and dp/du, whichever way v grows
        const glm::vec3 across = glm::cross(glm::vec3(0, 0, 1), quad.u);
        const double without = radiance(tracer, quad, false, glm::dmat4(1), to_light);
        CHECK(std::abs(without - expected(quad.u, across, to_light)) < 1e-4);
    }
}

TEST_CASE("a mirrored object with a normal map is its mirror image") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const glm::dmat4 mirror = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
    const glm::dvec3 mirrored_light(-to_light.x, to_light.y, to_light.z);
    for (const Quad& quad : {quads[0], quads[1], quads[5]})
        CHECK(std::abs(radiance(tracer, quad, true, mirror, mirrored_light) - expected(quad.u, quad.v, to_light)) <
              1e-4);
}
