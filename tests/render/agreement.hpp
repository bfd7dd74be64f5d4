// SPDX-License-Identifier: Apache-2.0
// Whether two pictures of a scene agree up to noise. Shared by the tests of agreement between tracers.
#pragma once

#include "io/image_compare.hpp"
#include "render/fixture.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::tests {

struct Traced {
    render::FilmImage image;
    render::TraceStats stats;
};

// By paths alone: only one of the tracers has photon maps and guiding.
inline Traced trace_scene(const std::string& tracer, scene::Scene scene, std::uint32_t samples, std::uint32_t seed) {
    scene.settings.value.caustics = scene.settings.value.guiding = scene::Technique::off;
    render::RendererOptions options;
    options.seed = seed;
    const auto renderer = make_renderer(tracer, options);
    Traced result;
    result.image = render_image(*renderer, scene, samples);
    result.stats = renderer->stats();
    return result;
}

inline io::Estimate estimate(const render::FilmImage& image) {
    io::Estimate e{.width = image.width, .height = image.height, .variance = image.luminance_variance};
    for (const auto& c : image.color)
        e.luminance.push_back(glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)));
    return e;
}

// Pictures whose samples are independent: each pixel's z is within 3 for 97.5 % of the pixels (99.7 % if errors were
// known, not estimated), and the means' within 3.5, since there are some 60 of these.
inline void check_independent(const render::FilmImage& a, const render::FilmImage& b) {
    const auto test = io::z_test(estimate(a), estimate(b), 3, 1);
    REQUIRE(test);
    const Mean ma = mean_luminance(a), mb = mean_luminance(b);
    const double z = (ma.value - mb.value) / std::max(std::hypot(ma.std_error, mb.std_error), 1e-12);
    INFO(fmt::format(
        "fraction of pixels within 3: {:.4f}, worst {:.2f}, rms {:.3f}; means {:.5f} +- {:.5f} and {:.5f} +- "
        "{:.5f}, z {:.2f}",
        test->share_passing, test->worst, test->rms, ma.value, ma.std_error, mb.value, mb.std_error, z));
    CHECK(test->share_passing >= 0.975);
    CHECK(test->rms < 1.25);
    CHECK(std::abs(z) <= 3.5);
    CHECK(ma.value > 0); // a black picture agrees with anything
}

// Pictures from the same random numbers: paths are the same up to rounding. The fraction of pixels whose luminance is
// within 0.1 % of each other.
inline double share_alike(const render::FilmImage& a, const render::FilmImage& b) {
    const auto la = estimate(a).luminance, lb = estimate(b).luminance;
    std::size_t alike = 0;
    for (std::size_t i = 0; i < la.size(); ++i)
        alike += std::abs(la[i] - lb[i]) <= 0.001f * std::max(la[i], lb[i]);
    return double(alike) / double(la.size());
}

} // namespace restage::tests
