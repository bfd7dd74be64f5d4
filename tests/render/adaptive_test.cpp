// SPDX-License-Identifier: Apache-2.0
// Adaptive sampling: who gets how many samples, that the picture stays right, and that it has less error.
#include "render/adaptive.hpp"
#include "render/checks.hpp"
#include "render/film_error.hpp"
#include "render/sample_plan.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <map>

using namespace restage;
using namespace restage::tests;

namespace {

// Half of the picture is a calm wall with light of its own, half a floor lit by a small lamp behind a blind.
void calm_and_noisy(SceneBuilder& b) {
    b.set_film(48, 32);
    b.set_camera({0, -6, 0}, {0, 0, 0}, {0, 0, 1}, 40);
    b.instance(b.quad({-4, 0, -4}, {0, 0, -4}, {0, 0, 4}, {-4, 0, 4}), b.diffuse(0, 0, 0), glm::dmat4(1),
               scene::Emission{glm::vec3(0.3f), true});
    b.instance(b.quad({0, 0, -4}, {4, 0, -4}, {4, 0, 4}, {0, 0, 4}), b.diffuse(0.5f, 0.5f, 0.5f));
    for (int i = 0; i < 5; ++i)
        b.instance(b.sphere(), b.diffuse(0.8f, 0.8f, 0.8f), placed({0.3 + 0.45 * i, -1, 0.2 * (i % 3)}, 0.2));
    b.instance(b.quad({0.5f, -2.5f, 2.f}, {0.5f, -1.5f, 2.f}, {2.5f, -1.5f, 2.f}, {2.5f, -2.5f, 2.f}),
               b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(3)});
}

std::vector<std::uint32_t> counts(const render::Renderer& renderer, std::size_t n) {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < n; ++i)
        out.push_back(renderer.film()->samples_of(i));
    return out;
}

} // namespace

TEST_CASE("adaptive: a plan has each sample of a request once, a pixel once in a wave") {
    const std::uint32_t most = GENERATE(1u, 7u, 64u, 100000u), most_per_pixel = GENERATE(1u, 5u, 100000u);
    const std::vector<render::PixelSamples> asked = {{0, 3}, {5, 0}, {2, 17}, {9, 1}, {0, 64}, {1, 2}};
    for (const bool listed : {true, false}) {
        render::TraceRequest request;
        request.first_sample = 4;
        request.samples = 9;
        if (listed) request.pixels = asked;
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> seen;
        render::SamplePlan plan(request, std::uint32_t(asked.size()), most, most_per_pixel);
        while (plan.next()) {
            REQUIRE(!plan.picks().empty());
            REQUIRE(plan.picks().size() <= most);
            std::uint32_t first = 0;
            for (std::size_t r = 0; r < plan.runs().size(); ++r) {
                const auto& run = plan.runs()[r];
                if (r > 0) REQUIRE(plan.runs()[r - 1].pixel < run.pixel);
                REQUIRE(run.first == first);
                REQUIRE((run.count >= 1 && run.count <= most_per_pixel));
                for (std::uint32_t k = 0; k < run.count; ++k) {
                    const auto& pick = plan.picks()[run.first + k];
                    REQUIRE(pick.pixel == run.pixel);
                    ++seen[{pick.pixel, pick.sample_index}];
                }
                first += run.count;
            }
            REQUIRE(first == plan.picks().size());
        }
        std::size_t all = 0;
        for (std::uint32_t p = 0; p < asked.size(); ++p) {
            const render::PixelSamples s = listed ? asked[p] : render::PixelSamples{4, 9};
            all += s.count;
            for (std::uint32_t k = 0; k < s.count; ++k)
                CHECK(seen[{p, s.first + k}] == 1);
        }
        CHECK(seen.size() == all);
    }
}

TEST_CASE("adaptive: noisy pixels get more samples, their mean is what was asked, in batches of any size") {
    SceneBuilder b;
    calm_and_noisy(b);
    b.scene.settings.value.adaptive = true;
    const auto renderer = make_renderer(GENERATE("embree", "vulkan"));
    const std::size_t n = std::size_t(48) * 32;
    const render::FilmImage whole = render_image(*renderer, b.scene, 64);
    const auto once = counts(*renderer, n);
    double sum = 0, calm = 0;
    for (std::size_t i = 0; i < n; ++i) {
        CHECK(once[i] >= render::adaptive_pilot);
        sum += once[i];
        if (i % 48 >= 28) calm += once[i];
    }
    CHECK(sum / double(n) >= 64);
    CHECK(sum / double(n) < 65);
    CHECK(calm / (20 * 32) < 40);
    CHECK(whole.samples == 64);
    CHECK(renderer->most_samples() == std::ranges::max(once));

    renderer->reset();
    for (const std::uint32_t batch : {3u, 20u, 1u, 40u})
        REQUIRE(renderer->trace(batch).has_value());
    CHECK(counts(*renderer, n) == once);
    CHECK((renderer->image().color == whole.color));
}

TEST_CASE("adaptive: a trace that was stopped goes on where it was") {
    SceneBuilder b;
    calm_and_noisy(b);
    b.scene.settings.value.adaptive = true;
    const auto renderer = make_renderer("embree");
    const render::FilmImage whole = render_image(*renderer, b.scene, 256);
    renderer->reset();
    REQUIRE(renderer->trace(16).has_value());
    int waves = 0;
    REQUIRE(renderer->trace(240, [&] { return ++waves < 2; }).has_value());
    CHECK(renderer->samples() == 16);
    REQUIRE(renderer->trace(240).has_value());
    CHECK(renderer->samples() == 256);
    CHECK((renderer->image().color == whole.color));
}

TEST_CASE("adaptive: unbiased, and with less error for as many samples") {
    SceneBuilder b;
    calm_and_noisy(b);
    const auto renderer = make_renderer("embree");
    const std::uint32_t samples = 32, seeds = 40;
    const auto run = [&](bool adaptive, std::vector<double>& mean, std::vector<double>& square) {
        b.scene.settings = {b.scene.settings.value, ++b.scene.clock};
        b.scene.settings.value.adaptive = adaptive;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            renderer->restart(seed);
            const auto film = render_image(*renderer, b.scene, samples);
            mean.resize(film.pixels()), square.resize(film.pixels());
            for (std::size_t i = 0; i < film.pixels(); ++i) {
                const double l = render::luminance(film.color[i]);
                mean[i] += l / seeds, square[i] += l * l / seeds;
            }
        }
    };
    std::vector<double> mean[2], square[2];
    for (const bool adaptive : {false, true})
        run(adaptive, mean[adaptive], square[adaptive]);
    double difference = 0, variance = 0, error[2] = {};
    for (std::size_t i = 0; i < mean[0].size(); ++i) {
        difference += mean[1][i] - mean[0][i];
        for (const int k : {0, 1}) {
            const double v = (square[k][i] - mean[k][i] * mean[k][i]) * seeds / (seeds - 1);
            variance += v / seeds;
            error[k] += v / std::pow(mean[0][i] + 0.01, 2);
        }
    }
    INFO("z of the mean " << difference / std::sqrt(variance) << "; error " << error[1] / error[0]
                          << " of that of as many samples everywhere");
    CHECK(std::abs(difference) < 3.5 * std::sqrt(variance));
    CHECK(error[1] < 0.75 * error[0]);
}
