// SPDX-License-Identifier: Apache-2.0
// Photons where they are seen: when `auto` leaves light to paths, and where photons start.
#include "render/cdf_table.hpp"
#include "render/checks.hpp"
#include "render/photon_starts.hpp"
#include "render/point_grid.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

// A mirror throws the light of a small lamp on a part of the floor.
void mirror_and_lamp(SceneBuilder& b, bool surface) {
    b.set_film(48, 48);
    ground(b, 0.3f);
    b.instance(b.quad({0, -0.5f, 0.6f}, {0, 0.5f, 0.6f}, {0, 0.5f, 1.4f}, {0, -0.5f, 1.4f}), b.material("mirror"));
    if (surface) {
        b.instance(b.quad({1.95f, -0.05f, 2}, {1.95f, 0.05f, 2}, {2.05f, 0.05f, 2}, {2.05f, -0.05f, 2}),
                   b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(300)});
    } else {
        scene::Light lamp;
        lamp.kind = scene::LightKind::point;
        lamp.value = glm::vec3(3);
        lamp.light_to_world = glm::translate(glm::dmat4(1), glm::dvec3(2, 0, 2));
        b.light(lamp);
    }
}

render::FilmImage with(SceneBuilder& b, scene::Technique technique) {
    b.scene.settings.value.caustics = technique;
    b.scene.settings.version = ++b.scene.clock;
    const auto renderer = make_renderer("embree");
    return render_image(*renderer, b.scene, 16);
}

} // namespace

TEST_CASE("caustics: auto leaves to paths what they can find and the picture hardly sees") {
    const bool surface = GENERATE(false, true), edge = GENERATE(false, true);
    INFO((surface ? "a surface" : "a point") << " shines, and the picture sees " << (edge ? "the edge" : "the middle"));
    SceneBuilder b;
    mirror_and_lamp(b, surface);
    const glm::dvec3 at(1.5, edge ? -1.58 : 0,
                        0); // the mirror lights |y| < 0.875 there; the picture's half side is 0.73
    b.set_camera(at + glm::dvec3(0, 0, 2), at, {0, 1, 0}, 40);
    const auto off = with(b, scene::Technique::off);
    CHECK((with(b, scene::Technique::automatic).color == off.color) == (surface && edge));
    CHECK((with(b, scene::Technique::on).color != off.color));
}

TEST_CASE("caustics: a provisional picture has photons if the last one had some") {
    SceneBuilder b;
    mirror_and_lamp(b, false);
    b.set_camera({1.5, 0, 2}, {1.5, 0, 0}, {0, 1, 0}, 40);
    const auto off = with(b, scene::Technique::off), on = with(b, scene::Technique::automatic);
    REQUIRE((off.color != on.color));
    const auto renderer = make_renderer("embree");
    const auto again = [&](bool provisional) {
        renderer->provisional(provisional);
        renderer->reset();
        REQUIRE(renderer->trace(16).has_value());
        return renderer->image().color;
    };
    REQUIRE(renderer->sync(b.scene).has_value());
    CHECK((again(true) == off.color));
    CHECK((again(false) == on.color));
    CHECK((again(true) == on.color));
}

TEST_CASE("caustics: photons start where they were seen, and everywhere else too") {
    const std::size_t sources = GENERATE(1u, 3u, 100u);
    render::PhotonStarts starts(sources);
    const auto cells = starts.cdf.size();
    REQUIRE(cells == std::size_t(starts.rows) * starts.side * starts.side);
    CHECK(starts.rows <= 16);
    const auto learn = [&](auto&& is_seen) {
        std::mt19937 random(5);
        std::vector<render::PhotonStarts::Try> tries(16384);
        for (auto& t : tries) {
            t.cell = std::uint32_t(random() % cells);
            t.seen = is_seen(t.cell, random);
        }
        starts.learn(tries);
    };
    learn([](std::uint32_t cell, auto&) { return cell < 8; });
    double sum = 0, least = 1, most = 0;
    for (std::size_t k = 0; k < cells; ++k) {
        const double p = render::cdf_probability(starts.cdf, k);
        sum += p;
        (k < 8 ? most : least) = k < 8 ? std::max(most, p) : std::min(least, p);
    }
    CHECK(std::abs(sum - 1) < 1e-9);
    CHECK(least > 0.01 / double(cells));
    CHECK(most > 4 * least);
    CHECK(starts.gain > 3);
    learn([](std::uint32_t, auto& random) { return random() % 4 == 0; }); // wherever they start
    CHECK(std::abs(starts.gain - 1) < 0.1);
    learn([](std::uint32_t, auto&) { return false; });
    CHECK(starts.gain == 1);
}

TEST_CASE("points in space: neighbours are found once each, and their distance") {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 1000; ++i)
        points.emplace_back(i % 10, i / 10 % 10, i / 100);
    const auto place = [&](std::size_t i) { return points[i]; };
    CHECK(render::spacing(points.size(), place, 1, 0.5, 64) == 1);
    CHECK(render::spacing(0, place, 1, 0.5, 64) == 0);
    CHECK(render::spacing(1, place, 4, 0.9, 64) == 0);
    const std::uint32_t mask = GENERATE(0u, 63u, 1023u); // with many cells of one hash, and few
    const render::PointGrid grid(points.size(), mask, 1.5f, place);
    for (const glm::vec3& p : {glm::vec3(4.5f), glm::vec3(0), glm::vec3(-0.7f, 9.3f, 5)}) {
        std::vector<int> met(points.size());
        grid.near(p, [&](std::uint32_t i) { ++met[i]; });
        CHECK(*std::ranges::max_element(met) == 1);
        for (std::size_t i = 0; i < points.size(); ++i)
            if (glm::distance(points[i], p) < 1.5f) CHECK(met[i] == 1);
    }
}
