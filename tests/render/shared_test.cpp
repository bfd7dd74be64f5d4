// SPDX-License-Identifier: Apache-2.0
// Functions of shaders/shared that C++ and GLSL both compile: the same inputs give the same answers in both.
#include "kernel_lab.hpp"
#include "shared/hash.h"
#include "shared/normal.h"

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
