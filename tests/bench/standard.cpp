// SPDX-License-Identifier: Apache-2.0
// The two standard scenes for comparing renderers: samples per CPU-second, and relMSE times CPU seconds at 16
// samples per pixel against our own reference in two halves, whose noise is subtracted.
#include "bench.hpp"
#include "io/image_file.hpp"
#include "pictures.hpp"
#include "scenes.hpp"

#include <fmt/format.h>
#include <filesystem>

namespace restage::bench {
namespace {

// As in the peers' figures: a pixel's squared error, mean over channels, over the mean square of its reference.
double rel_mse(const scene::PixelData& a, const scene::PixelData& reference) {
    double sum = 0;
    for (std::size_t i = 0; i < a.values.size(); i += 3) {
        double error = 0, square = 0;
        for (std::size_t c = i; c < i + 3; ++c) {
            const double r = reference.values[c], d = a.values[c] - r;
            error += d * d / 3;
            square += r * r / 3;
        }
        sum += error / (square + 0.01);
    }
    return sum / (double(a.values.size()) / 3);
}

} // namespace

Json measure_standard(const Options& o, const std::string& name, const std::string& folder,
                      std::uint32_t reference_spp) {
    const auto scene = name == "cornell" ? cornell() : room(7, name == "room-flat"); // 6 and 8 path edges
    Plugins plugins;
    scene::PixelData halves[2];
    for (std::uint32_t i = 0; i < 2; ++i) {
        const auto file =
            std::filesystem::path(folder) / fmt::format("{}.{}spp.{}.pfm", name, reference_spp / 2, i + 1);
        if (!std::filesystem::exists(file)) {
            const auto renderer = plugins.renderer({.threads = o.threads, .seed = 1000 + i});
            check(renderer->sync(scene));
            check(renderer->trace(reference_spp / 2));
            std::filesystem::create_directories(folder);
            check(io::write_image(file.string(), picture(renderer->image().color, renderer->image())));
        }
        halves[i] = take(io::read_image(file.string(), scene::Encoding::linear));
    }
    const auto reference = mean(halves[0], halves[1]);
    // half1 - mean = (half1 - half2) / 2, whose square is an estimate of the mean's variance
    const double noise = rel_mse(halves[0], reference);

    Json runs = Json::array();
    const std::uint32_t spp = 16;
    for (int i = 0; i < o.runs; ++i) {
        const auto renderer = plugins.renderer({.threads = o.threads, .seed = std::uint32_t(i)});
        check(renderer->sync(scene));
        check(renderer->trace(1));
        renderer->reset();
        renderer->reset_stats();
        const Seconds t = time([&] { check(renderer->trace(spp)); });
        const auto film = renderer->image();
        const double error = rel_mse(picture(film.color, film), reference) - noise;
        const auto& stats = renderer->stats();
        runs.push_back({{"wall", t.wall},
                        {"cpu", t.cpu},
                        {"msamples_cpu", double(stats.paths) / t.cpu * 1e-6},
                        {"mrays_cpu", double(stats.rays + stats.shadow_rays) / t.cpu * 1e-6},
                        {"rel_mse", error},
                        {"rel_mse_cpu_seconds", error * t.cpu}});
    }
    return {{"scene", name},
            {"samples", spp},
            {"reference_samples", reference_spp},
            {"reference_noise", noise},
            {"runs", runs}};
}

} // namespace restage::bench
