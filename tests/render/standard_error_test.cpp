// SPDX-License-Identifier: Apache-2.0
// The standard error that a film claims is the one that it has, although samples are stratified.
#include "render/checks.hpp"
#include "render/film_error.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// A floor under a lamp, with the penumbra of a ball: much of it converges faster than independent samples would.
void lamp_over_floor(SceneBuilder& b) {
    b.set_film(64, 64);
    b.set_camera({0, -4, 3}, {0, 0, 0.3}, {0, 0, 1}, 40);
    ground(b, 0.6f);
    b.instance(b.quad({-0.5f, -0.5f, 2.5f}, {-0.5f, 0.5f, 2.5f}, {0.5f, 0.5f, 2.5f}, {0.5f, -0.5f, 2.5f}),
               b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(5)});
    b.instance(b.sphere(), b.diffuse(0.7f, 0.3f, 0.2f), placed({0, 0, 0.5}, 0.5));
}

struct Squares { // mean over pixels and pairs of pictures of the squared z
    double claimed = 0, independent = 0; // by the corrected error, and by that of independent samples
};
Squares compare(std::span<const render::FilmImage> films) {
    Squares z;
    double n = 0;
    for (std::size_t k = 0; k + 1 < films.size(); k += 2) {
        const auto &a = films[k], &b = films[k + 1];
        for (std::size_t i = 0; i < a.color.size(); ++i) {
            const double variance = double(a.luminance_variance[i]) + b.luminance_variance[i];
            if (!(variance > 0)) continue;
            const double d = render::luminance(a.color[i]) - render::luminance(b.color[i]);
            z.claimed += d * d / variance;
            z.independent += d * d / (double(render::independent_variance(a, i)) + render::independent_variance(b, i));
            ++n;
        }
    }
    z.claimed /= n;
    z.independent /= n;
    return z;
}

} // namespace

TEST_CASE("standard error: differences of pictures are as large as it says") {
    SceneBuilder b;
    lamp_over_floor(b);
    const auto renderer = make_renderer("embree");
    for (const std::uint32_t samples : {8u, 15u, 64u}) {
        std::vector<render::FilmImage> films;
        double relative = 0, claimed = 0;
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
            renderer->restart(seed);
            films.push_back(render_image(*renderer, b.scene, samples));
            claimed += std::pow(render::relative_error(films.back()), 2) / 8;
            CHECK(std::abs(renderer->relative_error() / render::relative_error(films.back()) - 1) < 1e-3);
        }
        const Squares z = compare(films);
        for (std::size_t i = 0; i < films[0].color.size(); ++i) {
            double sum = 0, square = 0;
            for (const auto& film : films) {
                const double l = render::luminance(film.color[i]);
                sum += l, square += l * l;
            }
            relative += (square - sum * sum / 8) / 7 / std::pow(sum / 8 + 0.01, 2) / double(films[0].color.size());
        }
        INFO(samples << " samples: z squared " << z.claimed << ", as if independent " << z.independent
                     << "; relative error " << std::sqrt(relative) << ", claimed " << std::sqrt(claimed));
        CHECK((z.claimed > 0.85 && z.claimed < 1.15));
        CHECK((claimed / relative > 0.8 * 0.8 && claimed / relative < 1.25 * 1.25));
        if (samples == 64) CHECK(z.independent < 0.6);
    }
}

TEST_CASE("standard error: that of parts added is that of the whole") {
    SceneBuilder b;
    lamp_over_floor(b);
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    renderer->restart(3, 5); // an odd number first
    const auto whole = render_image(*renderer, b.scene, 11);
    renderer->restart(3, 5);
    for (const std::uint32_t samples : {4u, 1u, 6u})
        REQUIRE(renderer->trace(samples));
    const auto parts = renderer->image();
    double worst = 0;
    for (std::size_t i = 0; i < whole.color.size(); ++i)
        worst = std::max(worst, double(glm::length(whole.std_error[i] - parts.std_error[i])));
    CHECK(worst < 1e-5);
    CHECK(mean_luminance(whole).std_error > 0);
}
