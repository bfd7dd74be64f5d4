// SPDX-License-Identifier: Apache-2.0
// Loads in 64-bit words (shaders/lib/words.glsl) find what was stored.
#include "kernel_lab.hpp"
#include "shared/scene_data.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <numeric>
#include <span>

using namespace restage;
using namespace restage::tests;

namespace {

const char* const words = "#include \"lib/words.glsl\"";

std::vector<std::uint32_t> numbers(std::size_t count, std::uint32_t first = 0) {
    std::vector<std::uint32_t> list(count);
    std::iota(list.begin(), list.end(), first);
    return list;
}

std::vector<std::uint32_t> words_of(const shared::LightData& light) {
    std::vector<std::uint32_t> list(sizeof(light) / 4);
    std::ranges::copy(std::as_bytes(std::span(&light, 1)), std::as_writable_bytes(std::span(list)).begin());
    return list;
}

} // namespace

TEST_CASE("elements of three words are loaded from both alignments", "[words]") {
    const auto stored = numbers(3 * 17 + 1, 100); // the last pair reaches beyond the last element
    auto made = lab().device().create_buffer_of<std::uint32_t>(stored, "words");
    REQUIRE(made);
    const auto got = lab().run<glm::uvec3, std::uint32_t>(words, "uint", "uvec3", "result = uvec3_at(root, x);",
                                                          numbers(17), made->address());
    for (std::uint32_t k = 0; k < got.size(); ++k) {
        INFO("element " << k);
        CHECK(got[k] == glm::uvec3(100 + 3 * k, 101 + 3 * k, 102 + 3 * k));
    }
}

TEST_CASE("a light's record is loaded as it was stored", "[words]") {
    constexpr std::size_t each = sizeof(shared::LightData) / 4;
    const auto stored = numbers(5 * each, 0x3f800000u); // floats from 1 up, so that every bit survives
    auto made = lab().device().create_buffer_of<std::uint32_t>(stored, "lights");
    REQUIRE(made);
    const auto got = lab().run<shared::LightData, std::uint32_t>(
        words, "uint", "LightData", "result = load_light(root, x);", numbers(5), made->address());
    for (std::uint32_t k = 0; k < got.size(); ++k) {
        INFO("light " << k);
        CHECK(words_of(got[k]) == numbers(each, std::uint32_t(0x3f800000u + k * each)));
    }
}
