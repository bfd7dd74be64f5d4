// SPDX-License-Identifier: Apache-2.0
// Random numbers and maps of the sphere: Owen-scrambled Sobol pairs, the octahedral and equirectangular maps. Each
// shader function is checked against its definition.
#include "render/kernel_lab.hpp"
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

TEST_CASE("sampler: neighbouring pixels complete each other, whatever the number of samples") {
    // [m][k]: t of the net that the first 2^k samples of 2^m pixels are, which are neighbours in Z-order.
    constexpr int t_of[9][7] = {{0, 0, 0, 0, 0, 0, 0}, {0, 1, 0, 1, 1, 1, 0}, {0, 0, 1, 2, 1, 2, 0},
                                {1, 0, 0, 1, 2, 3, 1}, {0, 1, 1, 0, 1, 2, 1}, {1, 2, 0, 1, 2, 1, 2},
                                {1, 1, 0, 1, 1, 2, 3}, {0, 1, 1, 2, 1, 1, 1}, {1, 1, 0, 1, 2, 1, 2}};
    for (const auto& [tile, pair] : std::vector<std::pair<unsigned, unsigned>>{{0x100, 0}, {0xdeadbe00, 3}, {0, 40}}) {
        std::vector<Ask> asks;
        for (std::uint32_t place = 0; place < 256; ++place)
            for (std::uint32_t i = 0; i < 64; ++i)
                asks.push_back({tile | place, i, pair});
        const auto points = pairs(asks);
        for (int m = 0; m <= 8; ++m)
            for (int k = 0; k <= 6; ++k) {
                const int t = t_of[m][k], n = k + m - t; // 2^n boxes of 2^t points
                int uneven = 0;
                for (int block = 0; block < 1 << (8 - m); ++block)
                    for (int a = 0; a <= n; ++a) { // 2^a columns, 2^(n-a) rows
                        std::vector<int> boxes(std::size_t(1) << n);
                        for (int pixel = block << m; pixel < (block + 1) << m; ++pixel)
                            for (int i = 0; i < 1 << k; ++i) {
                                const glm::vec2& p = points[std::size_t(pixel * 64 + i)];
                                ++boxes[(std::size_t(p.y * float(1 << (n - a))) << a) +
                                        std::size_t(p.x * float(1 << a))];
                            }
                        uneven += std::ranges::any_of(boxes, [&](int count) { return count != 1 << t; });
                    }
                INFO("tile " << tile << ", pair " << pair << ", 2^" << m << " pixels, 2^" << k << " samples");
                CHECK(uneven == 0);
            }
    }
}

TEST_CASE("sampler: a pixel's seed is its tile's and its place in Z-order") {
    struct Pixel {
        std::uint32_t x, y;
    };
    const std::vector<Pixel> pixels = {{32, 48}, {33, 48}, {32, 49}, {34, 48}, {47, 63}, {48, 48}, {32, 64}, {31, 48}};
    const auto seeds =
        lab().run<std::uint32_t, Pixel>("#include \"lib/sampler.glsl\"\nstruct Pixel { uint x, y; };", "Pixel", "uint",
                                        "result = pixel_seed(uvec2(x.x, x.y), false, 7u);", pixels);
    const std::vector<std::uint32_t> places = {0, 1, 2, 4, 255, 0, 0, 85};
    std::set<std::uint32_t> tiles;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        CHECK((seeds[k] & 255) == places[k]);
        if (k < 5)
            CHECK(seeds[k] >> 8 == seeds[0] >> 8);
        else
            tiles.insert(seeds[k] >> 8);
    }
    tiles.insert(seeds[0] >> 8);
    CHECK(tiles.size() == 4);
}

TEST_CASE("sampler: pairs, tiles, and pixels of different pairs are independent") {
    // Chi-square of 8x8 cells of (a coordinate of one sequence, a coordinate of another), 63 degrees of freedom each.
    // 512 points of each; 210 couples. Stratified sequences may be more even than random ones, never less.
    constexpr std::uint32_t count = 512, couples = 210;
    std::vector<Ask> asks;
    for (std::uint32_t c = 0; c < couples; ++c)
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t tile = c << 8, pair = 2 + c % 7;
            if (c % 3 == 0) { // one pair of two tiles
                asks.push_back({tile, i, pair});
                asks.push_back({tile + 256, i, pair});
            } else if (c % 3 == 1) { // two pairs of one pixel
                asks.push_back({tile + 77, i, pair});
                asks.push_back({tile + 77, i, pair + 1});
            } else { // two pairs over the pixels of two tiles
                asks.push_back({tile + i, 3, pair});
                asks.push_back({tile + i, 3, pair + 1});
            }
        }
    const auto points = pairs(asks);
    double sum = 0, worst = 0;
    for (std::uint32_t c = 0; c < couples; ++c) {
        double cells[64] = {};
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto& p = points[2 * (c * count + i)];
            const auto& q = points[2 * (c * count + i) + 1];
            ++cells[int(p.x * 8) * 8 + int(c % 2 ? q.x * 8 : q.y * 8)];
        }
        double chi = 0;
        for (double n : cells)
            chi += (n - count / 64.0) * (n - count / 64.0) / (count / 64.0);
        sum += chi;
        worst = std::max(worst, chi);
    }
    INFO("mean chi-square " << sum / couples << " of 63, worst " << worst);
    CHECK(sum / couples < 63 + 4 * std::sqrt(2 * 63.0 / couples));
    CHECK(worst < 63 + 14 * std::sqrt(2 * 63.0)); // nested shuffles move whole blocks: wider tails than chi-square
}

TEST_CASE("sampler: each use of a pair has one of its own, at every depth") {
    constexpr std::uint32_t depths = 200;
    std::vector<std::uint32_t> asked;
    for (std::uint32_t i = 0; i < 2 + 4 * depths; ++i)
        asked.push_back(i);
    asked.push_back(~0u); // the wavelengths
    auto pairs = lab().run<std::uint32_t, std::uint32_t>(
        "#include \"lib/sampler.glsl\"", "uint", "uint",
        "uint d = (x - 2u) / 4u, k = (x - 2u) % 4u;"
        "result = x == ~0u ? PAIR_WAVELENGTHS : x == 0u ? PAIR_FILTER : x == 1u ? PAIR_LENS : k == 0u ? "
        "pair_light_pick(d) : k == 1u ? pair_light(d)"
        "       : k == 2u ? pair_bsdf(d) : pair_lobe(d);",
        asked);
    std::sort(pairs.begin(), pairs.end());
    CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
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
