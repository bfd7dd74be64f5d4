// SPDX-License-Identifier: Apache-2.0
// Which light, and where on it: distributions drawn in order, the light table, the tree of emitters. Shader functions
// are held to their definitions in double precision.
#include "render/cdf_table.hpp"
#include "render/checks.hpp"
#include "render/kernel_lab.hpp"
#include "render/light_table.hpp"
#include "render/light_tree.hpp"
#include "render/scene_builder.hpp"
#include "shared/lamps.h"

#include <algorithm>
#include <numbers>
#include <random>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

namespace {

std::vector<double> some_weights(std::size_t n, std::mt19937& random) {
    std::vector<double> weights(n);
    for (std::size_t i = 0; i < n; ++i)
        weights[i] = i % 5 == 3 ? 0 : std::pow(10.0, double(random() % 1000) / 1000 * 6);
    if (n == 1) weights[0] = 2;
    return weights;
}

template <class T>
gpu::Buffer upload(std::span<const T> values) {
    auto buffer = lab().device().create_buffer_of<T>(values, "test data");
    REQUIRE(buffer);
    return std::move(*buffer);
}

} // namespace

TEST_CASE("cdf: probabilities are the weights, and zero weights are never drawn") {
    std::mt19937 random(3);
    for (const std::size_t n : {1u, 2u, 7u, 1000u, 100000u}) {
        auto weights = some_weights(n, random);
        if (n > 2) weights.back() = weights[0] = 0;
        const auto table = render::make_cdf(weights);
        REQUIRE(table.size() == n);
        double sum = 0, all = 0, worst = 0;
        for (double w : weights)
            sum += w;
        for (std::size_t i = 0; i < n; ++i) {
            const double p = render::cdf_probability(table, i);
            worst = std::max(worst, std::abs(p - weights[i] / sum));
            all += p;
            if (weights[i] == 0) CHECK(p == 0);
        }
        INFO(n << " weights");
        CHECK(worst < 0x1p-31);
        CHECK(std::abs(all - 1) < 1e-12);
    }
    CHECK(render::make_cdf(std::vector<double>{0, 0}).empty());
    CHECK(render::make_cdf(std::vector<double>{}).empty());
}

TEST_CASE("cdf: the shader finds each number's place, and what is left of it") {
    struct Drawn {
        std::uint32_t index;
        float left;
    };
    std::mt19937 random(4);
    for (const std::size_t n : {1u, 3u, 1000u, 131072u}) {
        auto weights = some_weights(n, random);
        if (n == 131072) { // one entry has 99 % of the weight
            std::ranges::fill(weights, 0.01 / double(n - 1));
            weights[12345] = 0.99;
        }
        const auto table = render::make_cdf(weights);
        std::vector<std::uint32_t> bits{0, 1, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
        for (const auto& e : table)
            if (bits.size() < 20000) bits.insert(bits.end(), {e.start, e.start - 1});
        for (int i = 0; i < 20000; ++i)
            bits.push_back(std::uint32_t(random()));
        const auto buffer = upload<shared::CdfEntry>(table);
        const auto drawn = lab().run<Drawn, std::uint32_t>(
            "#include \"lib/cdf.glsl\"\nstruct Drawn { uint index; float left; };", "uint", "Drawn",
            fmt::format("CdfDraw d = cdf_draw(root, {}u, x); result.index = d.index; result.left = cdf_left(d, x);", n),
            bits, buffer.address());
        std::size_t wrong = 0;
        double worst = 0;
        for (std::size_t k = 0; k < bits.size(); ++k) {
            const std::uint32_t b = std::min(bits[k], CDF_TOTAL - 1);
            const auto after = std::ranges::upper_bound(
                table, b, {}, &shared::CdfEntry::start); // the last of those that start at or before
            const auto expected = std::size_t(after - table.begin() - 1);
            wrong += drawn[k].index != expected || drawn[k].left < 0 || drawn[k].left >= 1;
            if (drawn[k].index != expected) continue;
            const std::uint32_t end = after == table.end() ? CDF_TOTAL : after->start;
            worst = std::max(worst, std::abs(drawn[k].left -
                                             double(b - table[expected].start) / double(end - table[expected].start)));
        }
        INFO(n << " entries");
        CHECK(wrong == 0);
        CHECK(worst < 2e-7);
    }
}

TEST_CASE("cdf: each of 33 million texels can be reached") {
    constexpr std::uint32_t count = 8192 * 4096; // twice what the 24 bits of a float tell apart
    std::vector<std::uint32_t> bits;
    for (std::uint32_t i = 0; i < 4096; ++i)
        bits.push_back((7919u * i % count) * 128u + i % 128); // 2^32 / count = 128 numbers lead to each
    const auto index = lab().run<std::uint32_t, std::uint32_t>("#include \"lib/cdf.glsl\"", "uint", "uint",
                                                               "result = scaled_index(x, 33554432u);", bits);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < bits.size(); ++i)
        wrong += index[i] != bits[i] / 128;
    CHECK(wrong == 0);
}

namespace {

std::optional<render::Emitter> emitter_in(const SceneBuilder& b, scene::Id<scene::Instance> id) {
    const auto& e = b.scene.instances[id].emission;
    return e ? std::optional(render::Emitter{.radiance = e->radiance, .two_sided = e->two_sided, .mean = {}})
             : std::nullopt;
}
render::LightTable table_of(const SceneBuilder& b, const glm::vec3& environment = glm::vec3(0)) {
    return render::make_light_table(b.scene, glm::dvec3(0), environment,
                                    [&](scene::Id<scene::Instance> id) { return emitter_in(b, id); });
}

} // namespace

TEST_CASE("light table: an entry per triangle, an emitter per instance") {
    SceneBuilder b;
    const auto one = b.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    const auto uneven =
        b.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 3, 0}); // triangles of 0.5 and 1.5: no parallelogram
    const auto lamp = [&](scene::Id<scene::Mesh> mesh, float radiance, bool two_sided, double scale) {
        return b.instance(mesh, b.diffuse(0, 0, 0), glm::scale(glm::dmat4(1), glm::dvec3(scale)),
                          scene::Emission{glm::vec3(radiance), two_sided});
    };
    lamp(one, 1, false, 1);
    lamp(uneven, 1, true, 2);
    lamp(one, 0, false, 1); // sends nothing
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(3)});
    b.light({.kind = scene::LightKind::distant, .value = glm::vec3(2)});
    b.environment(glm::vec3(1));
    const auto table = table_of(b, glm::vec3(1));
    REQUIRE(table.lights.size() == 7);
    REQUIRE(table.cdf.size() == 7);
    CHECK(table.light_base == std::vector<std::uint32_t>{NONE, 0, 2, NONE});
    CHECK(table.environment == 6);
    const std::vector<double> pmf{1, 1, 0.25, 0.75, 1, 1, 1}; // within the emitter; of a pair: of both
    const std::vector<double> intensity{1, 8, 3, 2, pi}; // luminance times area, intensity, irradiance
    REQUIRE(table.roots == 5);
    REQUIRE(table.nodes.size() == 8); // black ones fill the root
    for (std::size_t i = 0; i < pmf.size(); ++i) {
        INFO("light " << i);
        CHECK(std::abs(table.lights[i].pmf - pmf[i]) < 1e-6);
        const auto& node = table.nodes[table.lights[i].node];
        CHECK(i >= node.first);
        CHECK(i < node.first + node.lights);
    }
    for (std::size_t k = 0; k < intensity.size(); ++k) {
        INFO("emitter " << k);
        CHECK(std::abs(table.nodes[k].intensity - intensity[k]) < 1e-5 * intensity[k]);
        CHECK(table.nodes[k].parent == NONE);
        CHECK((table.nodes[k].radius < 0) == (k >= 3));
    }
    CHECK((table.lights[0].kind & LIGHT_PAIR) != 0);
    CHECK((table.lights[1].kind & LIGHT_PAIR_END) != 0);
    CHECK((table.lights[2].kind & (LIGHT_PAIR | LIGHT_PAIR_END)) == 0);
    CHECK((table.lights[1].kind & LIGHT_RECTANGLE) != 0);
    CHECK(std::abs(table.lights[1].area - 1) < 1e-6); // of both
    CHECK((table.nodes[0].flags & LIGHT_PIECES) == 0);
    CHECK((table.nodes[1].flags & LIGHT_PIECES) != 0);
    CHECK(table.kinds == (LIGHTS_SURFACES | LIGHTS_LAMPS | LIGHTS_MESHES | LIGHTS_RECTANGLES | LIGHTS_TRIANGLES));
}

TEST_CASE("a lamp of two triangles gets its points in the order of the unit square") {
    // 64 points of a (0,2)-sequence: each elementary interval of the parallelogram holds one, whatever the order of the
    // corners, the diagonal, or the side that shines.
    std::mt19937 random(8);
    std::vector<glm::uvec2> bits;
    for (std::uint32_t i = 0; i < 64; ++i) { // Hammersley, within the cells
        std::uint32_t y = 0;
        for (int k = 0; k < 32; ++k)
            y |= (i >> k & 1) << (31 - k);
        bits.emplace_back((i << 26) + (1u << 25), y + (1u << 25));
    }
    const glm::vec3 o(3, -1, 2), u(2, 0.5f, 0), v(-0.3f, 1, 0.4f), corners[4] = {o, o + u, o + u + v, o + v};
    const std::array<glm::uvec3, 2> diagonals[2] = {{glm::uvec3(0, 1, 2), {0, 2, 3}}, {glm::uvec3(0, 1, 3), {1, 2, 3}}};
    for (int kind = 0; kind < 36; ++kind) {
        scene::MeshData mesh;
        mesh.positions.assign(corners, corners + 4);
        for (int i = 0; i < 2; ++i) {
            const glm::uvec3 t = diagonals[kind / 18][std::size_t(i)];
            const int turn = i ? kind % 3 : kind / 3 % 3;
            glm::uvec3 turned(t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]);
            mesh.triangles.push_back(turned);
        }
        SceneBuilder b;
        const auto id =
            b.instance(b.mesh(std::move(mesh)), b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(1), true});
        auto instance = b.scene.instances[id];
        instance.reverse_orientation = kind / 9 % 2;
        b.scene.instances.set(id, instance, ++b.scene.clock);
        const auto table = table_of(b);
        const auto lights = upload<shared::LightData>(table.lights);
        const auto cdf = upload<shared::CdfEntry>(table.cdf);
        const auto nodes = upload<shared::LightNode>(table.nodes);
        const auto ends = lab().run<glm::vec3, glm::uvec2>(
            "#include \"lib/light.glsl\"", "uvec2", "vec3",
            fmt::format("SceneData scene; scene.lights = {}ul; scene.light_cdf = {}ul; scene.light_nodes = {}ul;"
                        "scene.ray_epsilon = 1e-30;"
                        "LightSample s = light_sample(scene, receiver_at(vec3(9.0, 5.0, 30.0), 0u), 0x80000000u, x);"
                        "result = s.pdf > 0.0 ? s.end : vec3(1e30);",
                        lights.address(), cdf.address(), nodes.address()),
            bits);
        const glm::dvec3 normal = glm::normalize(glm::cross(glm::dvec3(u), glm::dvec3(v)));
        bool even = true;
        for (const auto& [columns, rows] : {std::pair(8, 8), {4, 16}, {16, 4}, {2, 32}, {32, 2}}) {
            // its own axes: those of whichever corner the map begins with; all four are the same up to reflections
            std::vector<int> cells(64), across(64);
            for (const glm::vec3& p : ends) {
                const glm::dvec3 d = glm::dvec3(p) - glm::dvec3(o);
                CHECK(std::abs(glm::dot(d, normal)) < 1e-5);
                const double det = glm::dot(normal, glm::cross(glm::dvec3(u), glm::dvec3(v)));
                const double x = glm::dot(normal, glm::cross(d, glm::dvec3(v))) / det,
                             y = glm::dot(normal, glm::cross(glm::dvec3(u), d)) / det;
                REQUIRE((x > 0 && x < 1 && y > 0 && y < 1));
                ++cells[std::size_t(int(y * rows) * columns + int(x * columns))];
                ++across[std::size_t(int(x * rows) * columns + int(y * columns))];
            }
            const auto ones = [](const std::vector<int>& c) {
                return std::ranges::all_of(c, [](int n) { return n == 1; });
            };
            even &= ones(cells) || ones(across);
        }
        INFO("arrangement " << kind);
        CHECK(even);
    }
}

namespace {

// Emitters of all kinds, in random places, some of them inside each other.
std::vector<shared::LightNode> random_emitters(std::size_t n, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<shared::LightNode> nodes;
    for (std::size_t i = 0; i < n; ++i) {
        shared::LightNode node{};
        node.center = 10.f * glm::vec3(unit(random), unit(random), unit(random));
        node.radius = i % 4 == 3 ? 0.f : i % 29 == 7 ? -1.f : unit(random);
        const float z = 2 * unit(random) - 1, phi = 6.2831f * unit(random), r = std::sqrt(1 - z * z);
        node.axis = {r * std::cos(phi), r * std::sin(phi), z};
        node.cos_spread = i % 3 ? 1.f : 2 * unit(random) - 1;
        node.cos_reach = i % 4 == 3 ? unit(random) : i % 7 == 2 ? -1.f : 0.f;
        node.intensity = std::pow(10.f, 3 * unit(random));
        node.first = std::uint32_t(i);
        node.lights = 1;
        node.flags = i % 5 == 1 ? LIGHT_TWO_SIDED : 0;
        nodes.push_back(node);
    }
    return nodes;
}

const char* const tree_head =
    "#include \"lib/light_tree.glsl\"\nstruct Ask { vec3 p; uint what; uint normal; };\n"
    "struct Answer { uint node; float pmf; float again; };";
struct Ask {
    glm::vec3 p;
    std::uint32_t what;
    std::uint32_t normal = 0; // receiver_bits
};
struct Answer {
    std::uint32_t node;
    float pmf, again;
};

} // namespace

TEST_CASE("light tree: each emitter is chosen as often as its probability says") {
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-2, 12);
    for (const std::size_t n : {1u, 2u, 8u, 9u, 70u, 3000u}) {
        const auto tree = render::make_light_tree(random_emitters(n, random));
        const auto buffer = upload<shared::LightNode>(tree.nodes);
        std::vector<std::uint32_t> leaves;
        for (std::uint32_t i = 0; i < tree.nodes.size(); ++i)
            if (tree.nodes[i].lights > 0) leaves.push_back(i);
        REQUIRE(leaves.size() == n);
        const std::string scene = "SceneData scene; scene.light_nodes = root;";
        for (int k = 0; k < 4; ++k) {
            const glm::vec3 p(unit(random), unit(random), unit(random));
            const auto normal = std::uint32_t(random());
            std::vector<Ask> asks;
            for (auto leaf : leaves)
                asks.push_back({p, leaf, normal});
            const auto pmf =
                lab().run<float, Ask>(tree_head, "Ask", "float",
                                      scene + "result = light_choice_pmf(scene, receiver_at(x.p, x.normal), x.what);",
                                      asks, buffer.address());
            double sum = 0;
            for (float f : pmf)
                sum += f;
            if (sum == 0) continue; // no light gets there
            INFO(n << " emitters, point " << k << ", sum of probabilities " << sum);
            constexpr std::uint32_t draws = 1 << 17;
            asks.clear();
            for (std::uint32_t i = 0; i < draws; ++i)
                asks.push_back({p, std::uint32_t(random()), normal});
            const auto drawn = lab().run<Answer, Ask>(
                tree_head, "Ask", "Answer",
                scene +
                    "result.node = light_choose(scene, receiver_at(x.p, x.normal), x.what, result.pmf);"
                    "result.again = result.pmf > 0.0 ? light_choice_pmf(scene, receiver_at(x.p, x.normal), "
                    "result.node) : 0.0;",
                asks, buffer.address());
            std::vector<double> count(tree.nodes.size());
            std::size_t nothing = 0, differ = 0;
            for (const Answer& a : drawn) {
                nothing += a.pmf == 0;
                if (a.pmf > 0) ++count[a.node];
                differ += !(std::abs(a.again - a.pmf) <= 1e-5f * a.pmf);
            }
            CHECK(differ == 0);
            // where an inner node's bounds promise light that none of its emitters sends, nothing is chosen
            CHECK(std::abs(double(nothing) / draws - (1 - sum)) < 5 * std::sqrt((1 - sum + 1e-6) / draws) + 1e-5);
            double chi = 0, rest = 0, rest_count = 0;
            int degrees = 0;
            for (std::size_t i = 0; i < leaves.size(); ++i) {
                const double expected = pmf[i] * double(draws);
                if (pmf[i] == 0) CHECK(count[leaves[i]] == 0);
                rest += expected;
                rest_count += count[leaves[i]];
                if (rest < 20) continue;
                chi += (rest_count - rest) * (rest_count - rest) / rest;
                ++degrees;
                rest = rest_count = 0;
            }
            INFO("chi-square " << chi << " of " << degrees);
            CHECK(chi < degrees + 5 * std::sqrt(2.0 * degrees) + 5);
        }
    }
}

TEST_CASE("light tree: bounds leave out no light") {
    // Triangles, one- and two-sided, and spots: where one of them shines on a point, its probability is not 0.
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)) * 2.f - 1.f; };
    for (const int n : {3, 40}) {
        SceneBuilder b;
        for (int i = 0; i < n; ++i) {
            if (i % 3 == 2) {
                const float angle = 5 + 80 * unit(random);
                const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 6.0 * unit(random), glm::dvec3(vector()));
                b.light({.kind = scene::LightKind::spot,
                         .value = glm::vec3(1),
                         .light_to_world = glm::translate(glm::dmat4(1), 3.0 * glm::dvec3(vector())) * turn,
                         .cone_angle = angle,
                         .cone_delta = 0.3f * angle});
                continue;
            }
            scene::MeshData mesh;
            const glm::vec3 p = 3.f * vector();
            for (int k = 0; k < 4; ++k)
                mesh.positions.push_back(p + vector());
            mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
            b.instance(b.mesh(std::move(mesh)), b.diffuse(0, 0, 0), glm::dmat4(1),
                       scene::Emission{glm::vec3(1), i % 2 == 0});
        }
        const auto table = table_of(b);
        const auto nodes = upload<shared::LightNode>(table.nodes);
        const auto lights = upload<shared::LightData>(table.lights);
        std::vector<Ask> asks;
        for (int k = 0; k < 4000; ++k)
            for (std::uint32_t i = 0; i < table.lights.size(); i += 1 + std::uint32_t(random() % 7))
                asks.push_back({5.f * vector(), i, std::uint32_t(random())});
        const auto pmf = lab().run<float, Ask>(
            tree_head, "Ask", "float",
            fmt::format("SceneData scene; scene.light_nodes = root;"
                        "LightArray lights = LightArray({}ul);"
                        "result = light_choice_pmf(scene, receiver_at(x.p, x.normal), lights.at[x.what].node);",
                        lights.address()),
            asks, nodes.address());
        std::size_t lit = 0, missed = 0;
        for (std::size_t k = 0; k < asks.size(); ++k) {
            const shared::LightData& light = table.lights[asks[k].what];
            bool shines = false;
            if ((light.kind & 255u) >= LIGHT_LAMP) {
                shines =
                    shared::lamp_ray((light.kind & 255u) - LIGHT_LAMP, light.a, light.b, light.c, asks[k].p).amount > 0;
            } else {
                const glm::dvec3 normal = glm::cross(glm::dvec3(light.b), glm::dvec3(light.c));
                const double side = glm::dot(normal, glm::dvec3(asks[k].p) - glm::dvec3(light.a));
                shines = side > 0 || (light.kind & LIGHT_TWO_SIDED);
            }
            lit += shines;
            missed += shines && !(pmf[k] > 0);
        }
        INFO(n << " emitters: " << lit << " of " << asks.size() << " lit, " << missed << " of those never");
        CHECK(lit > 1000);
        CHECK(missed == 0);
    }
}

TEST_CASE("light table: a lamp that moves is replaced, and the tree still holds all") {
    std::mt19937 random(12);
    std::uniform_real_distribution<float> unit(-1, 1);
    SceneBuilder b;
    std::vector<scene::Id<scene::Instance>> lamps;
    const auto shape = b.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    for (int i = 0; i < 100; ++i)
        lamps.push_back(b.instance(shape, b.diffuse(0, 0, 0), placed({10 * unit(random), 10 * unit(random), i}),
                                   scene::Emission{glm::vec3(1), i % 2 == 0}));
    auto table = table_of(b);
    for (int i = 0; i < 100; i += 9) {
        edit_instance(b, lamps[std::size_t(i)], [&](scene::Instance& lamp) {
            lamp.object_to_world =
                glm::rotate(placed({20 * unit(random), 20 * unit(random), 5}), double(i), glm::dvec3(1, 1, 0));
            lamp.emission->radiance = glm::vec3(2 + unit(random));
        });
        const auto replaced = render::replace_emitter(table, b.scene, glm::dvec3(0), lamps[std::size_t(i)],
                                                      emitter_in(b, lamps[std::size_t(i)]));
        REQUIRE(replaced);
        CHECK(replaced->count == 2);
    }
    const auto fresh = table_of(b);
    REQUIRE(fresh.lights.size() == table.lights.size());
    for (std::size_t i = 0; i < fresh.lights.size(); ++i) {
        auto mine = table.lights[i];
        mine.node = fresh.lights[i].node;
        CHECK(std::ranges::equal(std::as_bytes(std::span(&mine, 1)), std::as_bytes(std::span(&fresh.lights[i], 1))));
    }
    double intensity = 0;
    for (std::size_t n = 0; n < table.nodes.size(); ++n) {
        const auto& node = table.nodes[n];
        if (node.parent == NONE) intensity += node.intensity;
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
            CHECK(table.nodes[k].parent == n);
            CHECK(glm::length(table.nodes[k].center - node.center) + table.nodes[k].radius <=
                  node.radius * (1 + 1e-5f));
        }
    }
    double expected = 0;
    for (const auto& node : fresh.nodes)
        if (node.parent == NONE) expected += node.intensity;
    CHECK(std::abs(intensity / expected - 1) < 1e-5);
    // no longer a lamp
    CHECK_FALSE(render::replace_emitter(table, b.scene, glm::dvec3(0), lamps[0], std::nullopt));
}
