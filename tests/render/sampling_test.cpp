// SPDX-License-Identifier: Apache-2.0
// Random numbers and their uses: Owen-scrambled Sobol pairs, alias tables, the light table, maps of the
// sphere. Each shader function is checked against its definition.
#include "render/alias_table.hpp"
#include "render/kernel_lab.hpp"
#include "render/light_table.hpp"
#include "render/scene_builder.hpp"

#include <algorithm>
#include <random>
#include <set>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

namespace {

struct Ask {
    std::uint32_t seed, index, pair;
};

std::vector<glm::vec2> pairs(const std::vector<Ask>& asks) {
    return lab().run<glm::vec2, Ask>("#include \"lib/sampler.glsl\"\nstruct Ask { uint seed, index, pair; };", "Ask",
                                     "vec2", "result = sample_pair(x.seed, x.index, x.pair);", asks);
}
std::vector<glm::vec2> sequence(std::uint32_t seed, std::uint32_t pair, std::uint32_t count) {
    std::vector<Ask> asks;
    for (std::uint32_t i = 0; i < count; ++i)
        asks.push_back({seed, i, pair});
    return pairs(asks);
}

std::uint32_t reverse_bits(std::uint32_t x) {
    std::uint32_t r = 0;
    for (int i = 0; i < 32; ++i)
        r |= (x >> i & 1) << (31 - i);
    return r;
}

} // namespace

TEST_CASE("sampler: the second Sobol dimension by its direction numbers") {
    // Sobol 1967 with the primitive polynomial x + 1: v[j] = v[j-1] ^ (v[j-1] >> 1), v[0] = 2^31.
    std::uint32_t v[32];
    v[0] = 1u << 31;
    for (int j = 1; j < 32; ++j)
        v[j] = v[j - 1] ^ (v[j - 1] >> 1);
    std::mt19937 random(1);
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 4096; ++i)
        indices.push_back(i < 2048 ? i : std::uint32_t(random()));
    const auto got = lab().run<std::uint32_t, std::uint32_t>("#include \"lib/sampler.glsl\"", "uint", "uint",
                                                             "result = sobol1_reversed(x);", indices);
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        std::uint32_t y = 0;
        for (int j = 0; j < 32; ++j)
            if (indices[k] >> j & 1) y ^= v[j];
        wrong += got[k] != reverse_bits(y);
    }
    CHECK(wrong == 0);
}

TEST_CASE("sampler: every elementary interval of the first 2^k samples holds one point") {
    for (const auto& [seed, pair] :
         std::vector<std::pair<unsigned, unsigned>>{{1, 0}, {0xdeadbeef, 3}, {77, 40}, {0, 0}}) {
        const auto points = sequence(seed, pair, 4096);
        for (int k = 0; k <= 12; ++k)
            for (int a = 0; a <= k; ++a) { // 2^a columns, 2^(k-a) rows
                std::vector<int> boxes(std::size_t(1) << k);
                for (std::size_t i = 0; i < boxes.size(); ++i) {
                    const auto x = std::size_t(points[i].x * float(1 << a)),
                               y = std::size_t(points[i].y * float(1 << (k - a)));
                    ++boxes[(y << a) + x];
                }
                INFO("seed " << seed << ", pair " << pair << ", 2^" << k << " points, 2^" << a << " columns");
                CHECK(std::ranges::all_of(boxes, [](int n) { return n == 1; }));
            }
    }
}

TEST_CASE("sampler: pairs and pixels are independent") {
    // Chi-square of 8x8 cells of (a coordinate of one sequence, a coordinate of another), 63 degrees of freedom each.
    // 512 points of each; 200 couples. Stratified sequences may be more even than random ones, never less.
    constexpr std::uint32_t count = 512, couples = 200;
    std::vector<Ask> asks;
    for (std::uint32_t c = 0; c < couples; ++c)
        for (std::uint32_t i = 0; i < count; ++i) {
            const bool pixels = c % 2; // neighbouring pixels, or neighbouring pairs of one pixel
            asks.push_back({pixels ? c : 1000 + c, i, 2 + c % 7});
            asks.push_back({pixels ? c + 1 : 1000 + c, i, 2 + c % 7 + (pixels ? 0 : 1)});
        }
    const auto points = pairs(asks);
    double sum = 0, worst = 0;
    for (std::uint32_t c = 0; c < couples; ++c) {
        double cells[64] = {};
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto& p = points[2 * (c * count + i)];
            const auto& q = points[2 * (c * count + i) + 1];
            ++cells[int(p.x * 8) * 8 + int(c % 3 ? q.x * 8 : q.y * 8)];
        }
        double chi = 0;
        for (double n : cells)
            chi += (n - count / 64.0) * (n - count / 64.0) / (count / 64.0);
        sum += chi;
        worst = std::max(worst, chi);
    }
    INFO("mean chi-square " << sum / couples << " of 63, worst " << worst);
    CHECK(sum / couples < 63 + 4 * std::sqrt(2 * 63.0 / couples));
    CHECK(worst < 63 + 7 * std::sqrt(2 * 63.0));
}

TEST_CASE("alias table: it draws its pmf, for any weights") {
    std::mt19937 random(3);
    for (const std::size_t n : {1u, 2u, 7u, 1000u}) {
        std::vector<double> weights(n);
        for (std::size_t i = 0; i < n; ++i)
            weights[i] = i % 5 == 3 ? 0 : std::pow(10.0, double(random() % 1000) / 1000 * 6);
        if (n == 1) weights[0] = 2;
        const auto table = render::make_alias_table(weights);
        double sum = 0;
        for (double w : weights)
            sum += w;
        // exact: the fraction of the unit interval that leads to each index
        std::vector<double> drawn(n);
        double pmf = 0;
        for (std::size_t i = 0; i < n; ++i) {
            drawn[i] += table[i].q / double(n);
            drawn[table[i].alias] += (1 - table[i].q) / double(n);
            pmf += table[i].pmf;
        }
        CHECK(std::abs(pmf - 1) < 1e-5);
        for (std::size_t i = 0; i < n; ++i) {
            CHECK(std::abs(table[i].pmf - weights[i] / sum) <= 1e-6 * weights[i] / sum);
            CHECK(std::abs(drawn[i] - weights[i] / sum) < 1e-7);
            if (weights[i] == 0) CHECK(drawn[i] == 0);
        }
    }
    CHECK(render::make_alias_table(std::vector<double>{0, 0}).empty());
    CHECK(render::make_alias_table(std::vector<double>{}).empty());
}

TEST_CASE("alias table: the shader draws by the pmf from many entries too") {
    // One entry has 99 % of the weight; the other 131071 share the rest. With 24-bit numbers, the remainder of the one
    // that chose among them has 7 bits, too coarse for their 1 %: so the sampler gives the shader a second one.
    constexpr std::uint32_t n = 1 << 17, draws = 1 << 20;
    std::vector<double> weights(n, 0.01 / (n - 1));
    weights[12345] = 0.99;
    const auto table = render::make_alias_table(weights);
    const auto buffer = lab().device().create_buffer_of<shared::AliasEntry>(table, "alias table");
    REQUIRE(buffer);
    std::vector<std::uint32_t> indices(draws);
    for (std::uint32_t i = 0; i < draws; ++i)
        indices[i] = i;
    struct Drawn {
        std::uint32_t index;
        float left;
    };
    const auto drawn = lab().run<Drawn, std::uint32_t>(
        "#include \"lib/light.glsl\"\n#include \"lib/sampler.glsl\"\nstruct Drawn { uint index; float left; };", "uint",
        "Drawn",
        "result.left = sample_pair(9u, x, pair_lobe(0u)).y;"
        "result.index = alias_pick(root, 131072u, sample_bits(9u, x, pair_light_pick(0u)).x, result.left);",
        indices, buffer->address());
    double dim = 0, left = 0;
    std::size_t wrong = 0;
    for (const auto& d : drawn) {
        dim += d.index != 12345;
        left += d.left / draws;
        wrong += d.index >= n || d.left < 0 || d.left >= 1;
    }
    INFO("dim entries drawn " << dim << " times of " << draws << ", mean of what is left " << left);
    CHECK(wrong == 0);
    CHECK(std::abs(dim - 0.01 * draws) < 4 * std::sqrt(0.01 * draws));
    CHECK(std::abs(left - 0.5) < 4 * 0.29 / std::sqrt(double(draws))); // still uniform
}

TEST_CASE("alias table: each of 33 million texels can be reached") {
    constexpr std::uint32_t count = 8192 * 4096; // twice what the 24 bits of a float can distinguish
    std::vector<std::uint32_t> bits;
    for (std::uint32_t i = 0; i < 4096; ++i)
        bits.push_back((7919u * i % count) * 128u + i % 128); // 2^32 / count = 128 numbers lead to each
    const auto index = lab().run<std::uint32_t, std::uint32_t>("#include \"lib/light.glsl\"", "uint", "uint",
                                                               "result = scaled_index(x, 33554432u);", bits);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < bits.size(); ++i)
        wrong += index[i] != bits[i] / 128;
    CHECK(wrong == 0);
}

TEST_CASE("light table: chosen by power, and the densities sum to one") {
    SceneBuilder b;
    const auto one = b.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const auto lamp = [&](float radiance, bool two_sided, double scale) {
        return b.instance(one, b.diffuse(0, 0, 0), glm::scale(glm::dmat4(1), glm::dvec3(scale)),
                          scene::Emission{glm::vec3(radiance), two_sided});
    };
    lamp(1, false, 1); // pi
    lamp(1, true, 1); // 2 pi
    lamp(1, false, 3); // 9 pi
    lamp(0, false, 1); // none
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(1)}); // 4 pi
    b.light({.kind = scene::LightKind::spot, .value = glm::vec3(1), .cone_angle = 60, .cone_delta = 0}); // pi
    b.light({.kind = scene::LightKind::distant, .value = glm::vec3(1)}); // pi r^2
    b.environment(glm::vec3(1)); // 4 pi^2 r^2
    const double r = 2;
    const auto table =
        render::make_light_table(b.scene, glm::dvec3(0), glm::vec3(1), r, [&](scene::Id<scene::Instance> id) {
            const auto& e = *b.scene.instances[id].emission;
            return std::optional(render::Emitter{.radiance = e.radiance, .two_sided = e.two_sided, .mean = {}});
        });
    REQUIRE(table.lights.size() == 10);
    const std::vector<double> power{0.5, 0.5, 1, 1, 4.5, 4.5, 4, 1, r * r, 4 * pi * r * r}; // over pi
    double all = 0, sum = 0;
    for (double p : power)
        all += p;
    for (std::size_t i = 0; i < power.size(); ++i) {
        INFO("light " << i);
        CHECK(std::abs(table.lights[i].pmf - power[i] / all) < 1e-6);
        sum += table.lights[i].pmf;
    }
    CHECK(std::abs(sum - 1) < 1e-6);
    CHECK(table.light_base == std::vector<std::uint32_t>{NONE, 0, 2, 4, NONE});
    CHECK(table.environment == 9);
}

TEST_CASE("octahedral and equirectangular maps: round trip") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec2> uv;
    for (int i = 0; i < 20000; ++i)
        uv.emplace_back(unit(random), unit(random));
    for (float u : {0.f, 0.25f, 0.5f, 0.75f, 1.f}) // edges, folds, poles
        for (float v : {0.f, 0.25f, 0.5f, 0.75f, 1.f})
            uv.emplace_back(u, v);
    struct Both {
        glm::vec3 direction;
        glm::vec2 back;
    };
    const auto octahedral = lab().run<Both, glm::vec2>(
        "#include \"lib/light.glsl\"\nstruct Both { vec3 direction; vec2 back; };", "vec2", "Both",
        "result.direction = octahedral_to_direction(x); result.back = direction_to_octahedral(result.direction);", uv);
    double worst = 0, length = 0;
    glm::dvec3 mean(0);
    glm::dmat3 second(0);
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const glm::dvec3 w(octahedral[i].direction);
        length = std::max(length, std::abs(glm::length(w) - 1));
        if (i < 20000) { // one point of the sphere may have several positions at the border
            worst = std::max(worst, double(glm::length(octahedral[i].back - uv[i])));
            mean += w / 20000.0;
            second += glm::outerProduct(w, w) / 20000.0;
        }
    }
    CHECK(length < 1e-6);
    CHECK(worst < 2e-5); // a texel of 4096 is 2.4e-4
    // equal area: uniform in the square is uniform on the sphere
    CHECK(glm::length(mean) < 4 / std::sqrt(20000.0));
    for (int k = 0; k < 3; ++k)
        CHECK(std::abs(second[k][k] - 1.0 / 3) < 4 * 0.3 / std::sqrt(20000.0));
    // pbrt's convention: the centre is +z, the middles of the right and upper edges +x and +y
    const auto fixed = lab().run<glm::vec3, glm::vec2>(
        "#include \"lib/light.glsl\"", "vec2", "vec3", "result = octahedral_to_direction(x);",
        std::vector<glm::vec2>{{0.5f, 0.5f}, {1.f, 0.5f}, {0.5f, 1.f}, {0.f, 0.f}});
    CHECK(glm::length(fixed[0] - glm::vec3(0, 0, 1)) < 1e-6f);
    CHECK(glm::length(fixed[1] - glm::vec3(1, 0, 0)) < 1e-6f);
    CHECK(glm::length(fixed[2] - glm::vec3(0, 1, 0)) < 1e-6f);
    CHECK(glm::length(fixed[3] - glm::vec3(0, 0, -1)) < 1e-6f);

    const auto equirect = lab().run<glm::vec2, glm::vec2>(
        "#include \"lib/light.glsl\"", "vec2", "vec2",
        "EnvironmentData env; env.mapping = ENV_EQUIRECT; float t = x.y * PI, p = x.x * TWO_PI;"
        "result = environment_uv(env, vec3(sin(t) * cos(p), sin(t) * sin(p), cos(t)));",
        uv);
    worst = 0;
    for (std::size_t i = 0; i < 20000; ++i)
        worst = std::max(worst,
                         double(glm::length((equirect[i] - uv[i]) * glm::vec2(2 * std::sin(float(pi) * uv[i].y), 1))));
    INFO("worst distance " << worst);
    CHECK(worst < 2e-5);
}
