// SPDX-License-Identifier: Apache-2.0
// Path guiding: unbiased, the same for the same seed, and worth it where light comes through a door ajar.
#include "render/checks.hpp"
#include "render/film_error.hpp"
#include "render/guiding_map.hpp"
#include "render/kernel_lab.hpp"
#include "shared/octahedral.h"

#include <cstring>
#include <numbers>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

// A dark room, and behind a gap in its wall a bright one whose lamp is not seen from here.
void door_ajar(SceneBuilder& b, scene::Technique guiding, std::uint32_t size) {
    b.set_film(size, size);
    b.set_camera({-1.8, -0.8, 1.6}, {-0.6, 0.6, 0.4}, {0, 0, 1}, 60);
    const auto white = b.diffuse(0.7f, 0.7f, 0.7f);
    const auto wall = [&](glm::vec3 a, glm::vec3 u, glm::vec3 v) {
        b.instance(b.quad(a, a + u, a + u + v, a + v), white);
    };
    wall({-2, -1, 0}, {4, 0, 0}, {0, 2, 0});
    wall({-2, -1, 2}, {4, 0, 0}, {0, 2, 0});
    wall({-2, -1, 0}, {4, 0, 0}, {0, 0, 2});
    wall({-2, 1, 0}, {4, 0, 0}, {0, 0, 2});
    wall({-2, -1, 0}, {0, 2, 0}, {0, 0, 2});
    wall({2, -1, 0}, {0, 2, 0}, {0, 0, 2});
    wall({0, -0.8f, 0}, {0, 1.8f, 0}, {0, 0, 2});
    b.instance(b.quad({1, 0.4f, 1.9f}, {1, 0.8f, 1.9f}, {1.4f, 0.8f, 1.9f}, {1.4f, 0.4f, 1.9f}), white, glm::dmat4(1),
               scene::Emission{glm::vec3(40)});
    b.scene.settings.value.max_depth = 8;
    b.scene.settings.value.guiding = guiding;
}

// A room that the sky lights through a window: most directions that light sampling chooses end at a wall.
void small_window(SceneBuilder& b, scene::Technique guiding, std::uint32_t size) {
    b.set_film(size, size);
    b.set_camera({1.6, -0.8, 1.6}, {-0.6, 0.4, 0.5}, {0, 0, 1}, 60);
    const auto white = b.diffuse(0.6f, 0.6f, 0.6f);
    const auto wall = [&](glm::vec3 a, glm::vec3 u, glm::vec3 v) {
        b.instance(b.quad(a, a + u, a + u + v, a + v), white);
    };
    wall({-2, -1, 0}, {4, 0, 0}, {0, 2, 0});
    wall({-2, -1, 2}, {4, 0, 0}, {0, 2, 0});
    wall({-2, 1, 0}, {4, 0, 0}, {0, 0, 2});
    wall({-2, -1, 0}, {0, 2, 0}, {0, 0, 2});
    wall({2, -1, 0}, {0, 2, 0}, {0, 0, 2});
    wall({-2, -1, 0}, {4, 0, 0}, {0, 0, 1}); // around the window
    wall({-2, -1, 1.4f}, {4, 0, 0}, {0, 0, 0.6f});
    wall({-2, -1, 1}, {1.8f, 0, 0}, {0, 0, 0.4f});
    wall({0.2f, -1, 1}, {1.8f, 0, 0}, {0, 0, 0.4f});
    b.environment({3, 3, 3});
    b.scene.settings.value.max_depth = 4;
    b.scene.settings.value.guiding = guiding;
}

// Light from one direction on a floor, and from all around on a wall.
std::vector<render::GuidingRecord> records(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> u;
    std::vector<render::GuidingRecord> out;
    for (int i = 0; i < count; ++i) {
        render::GuidingRecord r{
            .order = std::uint64_t(i), .position = {u(random), u(random), u(random)}, .radiance = 1, .pdf = 1};
        r.normal = i % 2 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
        r.direction = glm::vec3(shared::octahedral_to_direction({u(random), u(random)}));
        if (glm::dot(r.direction, r.normal) < 0) r.direction = -r.direction;
        if (i % 2 && r.direction.x > 0.7f) r.radiance = 20;
        out.push_back(r);
    }
    return out;
}

render::FilmImage picture(void (*build)(SceneBuilder&, scene::Technique, std::uint32_t), scene::Technique guiding,
                          std::uint32_t seed, std::vector<std::uint32_t> batches, std::uint32_t size = 16) {
    SceneBuilder b;
    build(b, guiding, size);
    const auto renderer = make_renderer("embree", {.seed = seed});
    std::uint32_t all = 0;
    for (const std::uint32_t n : batches)
        all += n;
    renderer->plan(all);
    REQUIRE(renderer->sync(b.scene));
    for (const std::uint32_t n : batches)
        REQUIRE(renderer->trace(n));
    return renderer->image();
}

bool same(const render::FilmImage& a, const render::FilmImage& b) { return a.color == b.color; }

} // namespace

TEST_CASE("guiding: the density of a map is that of its directions, and integrates to 1") {
    Jobs jobs(1);
    auto all = records(20000);
    const auto map = render::GuidingMap::make(all, jobs);
    REQUIRE(map.leaves.size() > 8);
    for (const auto& leaf : map.leaves) {
        double sum = 0;
        for (const float d : leaf.density)
            sum += d * 4 * std::numbers::pi / 256;
        CHECK(std::abs(sum - 1) < 1e-5);
    }
    const auto floor_leaf = map.leaf_of({0.5f, 0.5f, 0.5f}, {0, 0, 1});
    CHECK(map.density(floor_leaf, glm::normalize(glm::vec3(1, 0, 0.3f))) >
          4 * map.density(floor_leaf, glm::normalize(glm::vec3(-1, 0, 0.3f))));

    auto nodes = *lab().device().create_buffer_of<shared::GuidingNode>(map.nodes, "nodes");
    auto leaves = *lab().device().create_buffer_of<shared::GuidingLeaf>(map.leaves, "leaves");
    const shared::GuidingData data{nodes.address(), leaves.address(), map.depth, 0};
    auto root = *lab().device().create_buffer_of<shared::GuidingData>(std::span(&data, 1), "guiding");
    std::vector<glm::vec2> u;
    constexpr int n = 256;
    for (int i = 0; i < n * n; ++i)
        u.emplace_back((float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n);
    const auto found = lab().run<glm::vec4, glm::vec2>("#include \"lib/guiding.glsl\"", "vec2", "vec4",
                                                       "GuidingData data = GuidingRef(root).guiding;\n"
                                                       "uint leaf = guiding_leaf(data, vec3(0.5), vec3(0, 0, 1));\n"
                                                       "vec3 w = guiding_direction(data, leaf, x);\n"
                                                       "result = vec4(w, guiding_density(data, leaf, w));",
                                                       u, root.address());
    std::vector<double> hits(256);
    int different = 0;
    for (const glm::vec4& f : found) {
        const glm::dvec2 p = shared::direction_to_octahedral(glm::normalize(glm::dvec3(f))) * 16.0;
        hits[std::size_t(std::min(int(p.y), 15) * 16 + std::min(int(p.x), 15))] += 1.0 / (n * n);
        different += std::abs(map.density(floor_leaf, glm::vec3(f)) - f.w) > 1e-4f * f.w;
    }
    CHECK(different < n * n / 1000); // on the edge of two cells
    for (std::size_t k = 0; k < 256; ++k)
        CHECK(std::abs(hits[k] - map.leaves[floor_leaf].density[k] * 4 * std::numbers::pi / 256) < 2e-3);
}

TEST_CASE("guiding: a map depends on its records, not on their order") {
    Jobs jobs(2);
    auto a = records(5000), b = a;
    std::ranges::reverse(b);
    const auto x = render::GuidingMap::make(a, jobs), y = render::GuidingMap::make(b, jobs);
    REQUIRE(x.leaves.size() == y.leaves.size());
    CHECK(std::memcmp(x.leaves.data(), y.leaves.data(), x.leaves.size() * sizeof(x.leaves[0])) == 0);
    CHECK(std::memcmp(x.nodes.data(), y.nodes.data(), x.nodes.size() * sizeof(x.nodes[0])) == 0);
}

TEST_CASE("guiding: what light sampling finds well is left to it") {
    // A lamp of 0.5 sr above a floor, of which `seen` is not hidden; light sampling chooses among all of it.
    const auto share = [](double seen) {
        constexpr double lamp = 0.5;
        std::mt19937 random(3);
        std::uniform_real_distribution<float> u;
        std::vector<render::GuidingRecord> all;
        for (int i = 0; i < 1000; ++i) {
            const float z = u(random), phi = 2 * float(std::numbers::pi) * u(random), r = std::sqrt(1 - z * z);
            const bool hit = 2 * std::numbers::pi * (1 - z) < lamp * seen;
            all.push_back({.order = std::uint64_t(i) << 4,
                           .position = glm::vec3(u(random), u(random), 0),
                           .normal = {0, 0, 1},
                           .direction = {r * std::cos(phi), r * std::sin(phi), z},
                           .light = hit ? 10.f : 0.f,
                           .light_pdf = hit ? float(1 / lamp) : 0.f,
                           .pdf = float(1 / (2 * std::numbers::pi))});
        }
        Jobs jobs(1);
        const auto map = render::GuidingMap::make(all, jobs);
        return map.leaves[map.leaf_of({0.5f, 0.5f, 0}, {0, 0, 1})].share;
    };
    CHECK(share(1) == 0);
    CHECK(share(0.1) > 0.2f);
}

TEST_CASE("guiding: the batches do not change the picture, and auto leaves it as it is") {
    using scene::Technique;
    CHECK(same(picture(door_ajar, Technique::on, 3, {40}), picture(door_ajar, Technique::on, 3, {1, 6, 20, 13})));
    CHECK_FALSE(same(picture(door_ajar, Technique::on, 3, {40}), picture(door_ajar, Technique::off, 3, {40})));
    CHECK(same(picture(door_ajar, Technique::automatic, 3, {40}), picture(door_ajar, Technique::off, 3, {40})));
}

namespace {

// Means and mean variances of pictures without and with guiding, and the z score between the means.
struct Compared {
    double mean[2]{}, noise[2]{}, z = 0;
};

Compared compare(void (*build)(SceneBuilder&, scene::Technique, std::uint32_t), std::uint32_t size,
                 std::uint32_t seeds) {
    Compared out;
    double error[2]{};
    for (int k = 0; k < 2; ++k) {
        std::vector<double> means, sum(std::size_t(size) * size), squares(sum.size());
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            const auto image = picture(build, k ? scene::Technique::on : scene::Technique::off, seed, {128}, size);
            means.push_back(mean_luminance(image).value);
            for (std::size_t i = 0; i < sum.size(); ++i) {
                const double l = render::luminance(image.color[i]);
                sum[i] += l, squares[i] += l * l;
            }
        }
        const double n = double(seeds);
        for (const double m : means)
            out.mean[k] += m / n;
        for (const double m : means)
            error[k] += (m - out.mean[k]) * (m - out.mean[k]) / (n * (n - 1));
        for (std::size_t i = 0; i < sum.size(); ++i)
            out.noise[k] += (squares[i] - sum[i] * sum[i] / n) / (n - 1) / double(sum.size());
    }
    out.z = (out.mean[1] - out.mean[0]) / std::sqrt(error[0] + error[1]);
    return out;
}

} // namespace

TEST_CASE("guiding: no bias, and less noise in a room behind a door ajar, and behind a small window") {
    for (const auto build : {door_ajar, small_window}) {
        const Compared c = compare(build, 64, 6);
        INFO((build == door_ajar ? "door" : "window") << ": means " << c.mean[0] << " and " << c.mean[1] << ", z "
                                                      << c.z << "; variances " << c.noise[0] << " and " << c.noise[1]);
        CHECK(std::abs(c.z) < 3);
        CHECK(c.noise[1] < (build == door_ajar ? 0.5 : 0.7) * c.noise[0]);
    }
}
