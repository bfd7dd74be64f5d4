// SPDX-License-Identifier: Apache-2.0
// Error against samples and time: renders a scene progressively and takes relMSE to a reference at powers of two, for
// each way of finding light, Russian roulette on and off, several seeds; raw and denoised.
#include "bench.hpp"
#include "io/image_compare.hpp"
#include "io/image_file.hpp"
#include "io/import.hpp"
#include "pictures.hpp"
#include "render/denoise.hpp"

namespace restage::bench {
namespace {

struct Config {
    const char* name;
    render::Strategy strategy;
    bool roulette;
    std::uint32_t most; // samples a pixel
    bool denoised;
};

constexpr float clip = 0.001f; // as tests/golden/references.py

double rel_mse(const scene::PixelData& a, const scene::PixelData& reference) {
    return take(io::compare_images(a, reference, {.clip = clip})).rel_mse;
}

} // namespace

Json measure_error(const Options& o, const std::string& path, const std::string& half1, const std::string& half2) {
    Plugins plugins;
    auto imported = take(io::import_scene(path, plugins.registry));
    scene::Scene& scene = imported.scene;
    const auto a = take(io::read_image(half1, RESTAGE_LINEAR)), b = take(io::read_image(half2, RESTAGE_LINEAR));
    if (a.width != b.width || a.height != b.height) die(half1 + " and " + half2 + " differ in size");
    const auto reference = mean(a, b);
    scene.film.value.width = a.width;
    scene.film.value.height = a.height;
    scene.film.version = ++scene.clock;
    const float exposure = scene.film.value.exposure;
    const RestageDenoiser1* denoiser = nullptr;
    const char* reason = "";
    for (const auto& entry : plugins.registry.denoisers())
        if (!denoiser && entry.table->available(&reason)) denoiser = entry.table;

    using render::Strategy;
    const std::uint32_t deep = o.quick ? 16 : o.samples, most = std::max(deep / 4, 8u);
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
                rows.push_back({{"config", config.name},
                                {"seed", seed},
                                {"samples", n},
                                {"wall", spent.wall},
                                {"cpu", spent.cpu},
                                {"rel_mse", rel_mse(picture(film.color, film, exposure), reference)}});
                if (!config.denoised || !denoiser) continue;
                std::vector<glm::vec3> clean;
                const Seconds d =
                    time([&] { clean = take(render::denoise(film, *denoiser, RESTAGE_DENOISE_HIGH, o.threads)); });
                rows.back()["denoise_wall"] = d.wall;
                rows.back()["denoise_cpu"] = d.cpu;
                rows.back()["rel_mse_denoised"] = rel_mse(picture(clean, film, exposure), reference);
            }
        }
    }
    // half1 - mean = (half1 - half2) / 2, whose square is an estimate of the mean's variance
    Json result = {{"width", a.width},
                   {"height", a.height},
                   {"clip", clip},
                   {"reference_noise", rel_mse(a, reference)},
                   {"rows", rows}};
    if (!denoiser) result["not_denoised"] = reason;
    return result;
}

} // namespace restage::bench
