// SPDX-License-Identifier: Apache-2.0
// Functions of shaders/shared, compiled as C++ and as GLSL: the same inputs give the same results in both.
#include "kernel_lab.hpp"
#include "scene/light_kinds.hpp"
#include "shared/hash.h"
#include "shared/lamps.h"
#include "shared/normal.h"
#include "shared/octahedral.h"

#include <glm/glm.hpp>
#include <limits>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

struct Where { // of a choice
    glm::vec3 origin, direction;
    std::uint32_t id, prim;
};
const char* const where = "#include \"shared/hash.h\"\nstruct Where { vec3 origin, direction; uint id, prim; };";

std::vector<Where> places() {
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0, 3);
    std::vector<Where> list;
    for (int i = 0; i < 4000; ++i) {
        Where w;
        for (int k = 0; k < 3; ++k)
            w.origin[k] = normal(random), w.direction[k] = normal(random);
        w.id = std::uint32_t(random()) >> (random() % 32);
        w.prim = std::uint32_t(random()) >> (random() % 32);
        list.push_back(w);
    }
    const float odd[] = {0.f, -0.f, 1e-45f, -1e-40f, 3e38f, std::numeric_limits<float>::infinity()};
    for (const float v : odd)
        list.push_back({glm::vec3(v), glm::vec3(v, 0, -v), 0xffffffffu, 0x01000001u});
    return list;
}

} // namespace

TEST_CASE("hashes are the same bits in C++ and in GLSL", "[shared]") {
    const auto inputs = places();
    const auto alpha = lab().run<float, Where>(where, "Where", "float",
                                               "result = alpha_choice(x.origin, x.direction, x.id, x.prim);", inputs);
    const auto mix = lab().run<float, Where>(where, "Where", "float",
                                             "result = mix_choice(x.origin.xy, x.prim, x.id & 7u);", inputs);
    const auto bits = lab().run<std::uint32_t, Where>(where, "Where", "uint", "result = pcg_hash(x.id);", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Where& w = inputs[i];
        INFO("input " << i);
        REQUIRE(bits[i] == shared::pcg_hash(w.id));
        REQUIRE(alpha[i] == shared::alpha_choice(w.origin, w.direction, w.id, w.prim));
        REQUIRE(mix[i] == shared::mix_choice(glm::vec2(w.origin), w.prim, w.id & 7u));
    }
}

TEST_CASE("the outside of a triangle is the same in C++ and in GLSL", "[shared]") {
    const std::vector<float> inputs{-1.f, -1e-38f, -0.f, 0.f, 1e-38f, 1.f, std::numeric_limits<float>::quiet_NaN()};
    for (const bool reversed : {false, true}) {
        const auto got = lab().run<std::uint32_t, float>(
            "#include \"shared/normal.h\"", "float", "uint",
            std::string("result = points_inward(x, ") + (reversed ? "true" : "false") + ") ? 1u : 0u;", inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i)
            CHECK((got[i] != 0) == shared::points_inward(double(inputs[i]), reversed));
    }
}

TEST_CASE("a lamp's light at a point is the same in C++ and in GLSL", "[shared]") {
    struct In {
        std::uint32_t lamp;
        glm::vec3 position, axis, cone, p;
    };
    std::mt19937 random(11);
    std::normal_distribution<float> normal(0, 2);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto point = [&] { return glm::vec3(normal(random), normal(random), normal(random)); };
    std::vector<In> inputs;
    for (std::uint32_t i = 0; i < 6000; ++i) {
        const float edge = 2 * unit(random) - 1, start = edge + (1 - edge) * unit(random);
        In in{i % std::uint32_t(std::size(scene::light_kinds)), point(), glm::normalize(point()),
              glm::vec3(edge, start, i % 2), point()};
        if (i % 97 == 0) in.p = in.position;      // the lamp itself
        if (i % 89 == 0) in.cone.y = in.cone.x;   // a hard edge
        inputs.push_back(in);
    }
    const auto got = lab().run<glm::vec4, In>(
        "#include \"shared/lamps.h\"\nstruct In { uint lamp; vec3 position, axis, cone, p; };", "In", "vec4",
        "LampRay r = lamp_ray(x.lamp, x.position, x.axis, x.cone, x.p); result = vec4(r.wi, r.amount);", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const In& in = inputs[i];
        const auto want = shared::lamp_ray(in.lamp, in.position, in.axis, in.cone, in.p);
        INFO("input " << i << ", lamp " << in.lamp);
        CHECK(glm::length(glm::vec3(got[i]) - want.wi) <= 1e-6f);
        // At a hard edge the last bit of the cosine decides between all and nothing.
        if (in.cone.y == in.cone.x && std::abs(-glm::dot(in.axis, want.wi) - in.cone.x) < 1e-5f) continue;
        CHECK(std::abs(got[i].w - want.amount) <= 2e-4f * want.amount + 1e-7f);
    }
}

TEST_CASE("the octahedral map is the same in C++ and in GLSL, and invertible", "[shared]") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec2> inputs{{0, 0}, {1, 1}, {0.5f, 0.5f}, {0.5f, 0}, {0, 0.5f}, {1, 0.25f}, {0.25f, 0.75f}};
    for (int i = 0; i < 4000; ++i)
        inputs.emplace_back(unit(random), unit(random));
    const std::string include = "#include \"shared/octahedral.h\"";
    const auto out =
        lab().run<glm::vec3, glm::vec2>(include, "vec2", "vec3", "result = octahedral_to_direction(x);", inputs);
    const auto back =
        lab().run<glm::vec2, glm::vec3>(include, "vec3", "vec2", "result = direction_to_octahedral(x);", out);
    const auto wrapped =
        lab().run<glm::vec2, glm::vec2>(include, "vec2", "vec2", "result = octahedral_wrap(3.0 * x - 1.0);", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        INFO("input " << i << ": " << inputs[i].x << " " << inputs[i].y);
        const glm::dvec3 w = shared::octahedral_to_direction(inputs[i]);
        CHECK(std::abs(glm::length(w) - 1) < 1e-12);
        CHECK(glm::length(glm::dvec3(out[i]) - w) < 2e-6);
        // An edge of the square is folded onto itself: both of its points are the same direction.
        CHECK(glm::length(shared::octahedral_to_direction(shared::direction_to_octahedral(w)) - w) < 1e-7);
        CHECK(glm::length(shared::octahedral_to_direction(glm::dvec2(back[i])) - w) < 1e-3);
        CHECK(glm::length(glm::dvec2(wrapped[i]) - shared::octahedral_wrap(glm::dvec2(3.f * inputs[i] - 1.f))) < 1e-6);
    }
}
