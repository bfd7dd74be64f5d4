// SPDX-License-Identifier: Apache-2.0
// Renders small scenes on the test device with both tracers, and reports how far a mean is from its closed form.
#pragma once

#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"
#include "render/renderer.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

namespace restage::tests {

struct Plugins { // of the build tree
    Log log;
    plugin::Registry registry{log, io::with_services()};
    Plugins() {
        const plugin::SearchPath path{restage::test::build_dir() / "lib/restage/plugins", true};
        registry.scan({&path, 1});
    }
    render::MaterialLookup lookup() { return render::material_lookup(registry); }
};
inline Plugins& plugins() {
    static Plugins instance;
    return instance;
}

inline std::unique_ptr<render::Renderer> make_renderer(const std::string& tracer,
                                                       render::RendererOptions options = {}) {
    options.tracer = tracer;
    options.shader_dir = restage::test::source_dir() / "shaders";
    auto renderer = render::Renderer::create(options, plugins().lookup(), plugins().log);
    if (!renderer) FAIL(renderer.error().message);
    return std::move(*renderer);
}

inline render::FilmImage render_image(render::Renderer& renderer, const scene::Scene& scene, std::uint32_t samples) {
    if (auto ok = renderer.sync(scene); !ok) FAIL(ok.error().message);
    if (auto ok = renderer.trace(samples); !ok) FAIL(ok.error().message);
    CHECK(renderer.stats().not_finite.empty());
    CHECK(renderer.stats().dropped == 0);
    return renderer.image();
}

struct Mean {
    double value = 0, std_error = 0;
};
// Of the luminance over all pixels; the error from the samples' variance, pixels being independent.
inline Mean mean_luminance(const render::FilmImage& image) {
    Mean m;
    for (std::size_t i = 0; i < image.color.size(); ++i) {
        m.value += glm::dot(glm::dvec3(image.color[i]), glm::dvec3(0.2126, 0.7152, 0.0722));
        m.std_error += image.luminance_variance[i];
    }
    m.value /= double(image.color.size());
    m.std_error = std::sqrt(m.std_error) / double(image.color.size());
    return m;
}

} // namespace restage::tests
