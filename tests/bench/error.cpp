// SPDX-License-Identifier: Apache-2.0
// Error over samples and time: renders a scene progressively and computes relMSE against a reference at powers of two,
// for each light sampling strategy, Russian roulette on and off, several seeds; raw and denoised.
#include "bench.hpp"
#include "io/image_compare.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"
#include "pictures.hpp"
#include "render/denoise.hpp"

#include <algorithm>
#include <numeric>

namespace restage::bench {
namespace {

struct Config {
    const char* name;
    render::Strategy strategy;
    bool roulette;
    std::uint32_t most; // samples a pixel
    bool denoised;
};

constexpr float clip = 0.001f; // as in tests/golden/references.py

struct Error {
    double rel_mse = 0, trimmed = 0;
};
// relMSE, and likewise without the thousandth of the pixels that differ most: one sample of a bright light at its edge,
// or one firefly, otherwise decides the mean of all.
Error error_of(scene::PixelData a, scene::PixelData reference) {
    Error e{.rel_mse = take(io::compare_images(a, reference, {.clip = clip})).rel_mse};
    io::clip_fireflies(a, reference, clip);
    std::vector<double> pixels(a.values.size() / 3);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double r = reference.values[i], d = a.values[i] - r;
        pixels[i / 3] += d * d / (r * r + io::rel_mse_epsilon) / 3;
    }
    std::sort(pixels.begin(), pixels.end());
    pixels.resize(pixels.size() - pixels.size() / 1000);
    e.trimmed = std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
    return e;
}

} // namespace

Json measure_error(const Options& o, const std::string& path, const std::string& half1, const std::string& half2) {
    Plugins plugins;
    auto imported = take(io::import_scene(path, plugins.registry));
    scene::Scene& scene = imported.scene;
    const auto a = take(io::read_image(half1, scene::Encoding::linear)),
               b = take(io::read_image(half2, scene::Encoding::linear));
    if (a.width != b.width || a.height != b.height) die(half1 + " and " + half2 + " differ in size");
    const auto reference = mean(a, b);
    scene.film.value.width = a.width;
    scene.film.value.height = a.height;
    scene.film.version = ++scene.clock;
    const float exposure = scene.film.value.exposure;
    std::optional<plugin::DenoiserEntry> denoiser;
    for (const auto& entry : plugins.registry.denoisers())
        if (!denoiser && entry.table->available()) denoiser = entry;

    using render::Strategy;
    const std::uint32_t deep = o.quick ? 16 : o.samples, most = std::max(deep / 2, 8u);
    const Config configs[] = {{"mis", Strategy::mis, true, deep, true},
                              {"mis, no roulette", Strategy::mis, false, most, false},
                              {"light", Strategy::light_only, true, most, false},
                              {"bsdf", Strategy::bsdf_only, true, most, false}};
    Json rows = Json::array();
    for (const Config& config : configs) {
        scene.settings.value.russian_roulette = config.roulette;
        scene.settings.version = ++scene.clock;
        for (int seed = 0; seed < o.runs; ++seed) {
            const auto renderer =
                plugins.renderer({.threads = o.threads, .seed = std::uint32_t(seed), .strategy = config.strategy});
            check(renderer->sync(scene));
            check(renderer->trace(1)); // compiles
            renderer->reset();
            Seconds spent;
            for (std::uint32_t n = 1; n <= config.most; n *= 2) {
                const Seconds t = time([&] { check(renderer->trace(n - renderer->samples())); });
                spent.wall += t.wall;
                spent.cpu += t.cpu;
                const auto film = renderer->image();
                const Error raw = error_of(picture(film.color, film, exposure), reference);
                rows.push_back({{"config", config.name},
                                {"seed", seed},
                                {"samples", n},
                                {"wall", spent.wall},
                                {"cpu", spent.cpu},
                                {"rel_mse", raw.rel_mse},
                                {"trimmed", raw.trimmed}});
                if (!config.denoised || !denoiser) continue;
                std::vector<glm::vec3> clean;
                const Seconds d = time(
                    [&] { clean = take(render::denoise(film, *denoiser, plugin::DenoiseQuality::high, o.threads)); });
                rows.back()["denoise_wall"] = d.wall;
                rows.back()["denoise_cpu"] = d.cpu;
                const Error denoised = error_of(picture(clean, film, exposure), reference);
                rows.back()["rel_mse_denoised"] = denoised.rel_mse;
                rows.back()["trimmed_denoised"] = denoised.trimmed;
            }
        }
    }
    // half1 - mean = (half1 - half2) / 2, whose square is an estimate of the mean's variance
    const Error noise = error_of(a, reference);
    Json result = {{"width", a.width},
                   {"height", a.height},
                   {"clip", clip},
                   {"reference_noise", noise.rel_mse},
                   {"reference_noise_trimmed", noise.trimmed},
                   {"rows", rows}};
    if (!denoiser) result["not_denoised"] = "no denoiser is available";
    return result;
}

} // namespace restage::bench
