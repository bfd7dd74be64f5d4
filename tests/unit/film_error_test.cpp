// SPDX-License-Identifier: Apache-2.0
// The relative error of a film, at which `--error` stops.
#include "render/film_error.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

using namespace restage;
using Catch::Approx;

namespace {

// Each sample of each pixel finds light of 1 / chance with that chance: the means are 1.
render::FilmImage rare_light(double chance, std::uint32_t samples) {
    auto film = render::FilmImage::blank(64, 64);
    film.samples = samples;
    std::mt19937 random(7);
    std::binomial_distribution<int> hits(int(samples), chance);
    for (std::size_t i = 0; i < film.pixels(); ++i) {
        const double mean = hits(random) / chance / samples;
        film.color[i] = glm::vec3(float(mean));
        film.luminance_variance[i] = float((mean / chance - mean * mean) / (samples - 1));
    }
    return film;
}

} // namespace

TEST_CASE("relative error: right where few samples find the light") {
    for (const double chance : {0.5, 0.1, 1.0 / 32}) {
        const double error = std::sqrt((1 / chance - 1) / 16) / 1.01;
        INFO("light with chance " << chance);
        CHECK(render::relative_error(rare_light(chance, 16)) == Approx(error).epsilon(0.2));
    }
}

TEST_CASE("relative error: at edges a pixel's own light counts, once it is known") {
    auto film = render::FilmImage::blank(64, 64);
    film.samples = 64;
    for (std::size_t i = 0; i < film.pixels(); ++i) { // columns, each 1 % uncertain
        const float light = i % 2 ? 100.f : 1.f;
        film.color[i] = glm::vec3(light);
        film.luminance_variance[i] = float(std::pow(0.01 * light, 2));
    }
    CHECK(render::relative_error(film) == Approx(0.01).epsilon(0.03));
}

TEST_CASE("relative error: of one pixel, and of one sample") {
    auto film = render::FilmImage::blank(1, 1);
    film.samples = 16;
    film.color[0] = glm::vec3(0.99f);
    film.luminance_variance[0] = 0.04f;
    CHECK(render::relative_error(film) == Approx(0.2));
    film.samples = 1;
    CHECK(render::relative_error(film) > 1e29);
}

TEST_CASE("relative error: it is looked at four times per doubling, from 16 samples on") {
    std::vector<std::uint32_t> looks;
    for (std::uint32_t n = 0; n < 64; n = render::next_look(n))
        if (n) looks.push_back(n);
    CHECK(looks == std::vector<std::uint32_t>{16, 20, 24, 28, 32, 40, 48, 56});
    for (std::uint32_t n = 0; n < 200; ++n)
        CHECK(render::is_look(n) == (n > 0 && render::next_look(n - 1) == n));
    CHECK((render::is_look(16) && render::is_look(1u << 20) && !render::is_look(0) && !render::is_look(17)));
}
