// SPDX-License-Identifier: Apache-2.0
#include "render/denoise.hpp"

#include "render/catcher.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace restage::render {

Result<plugin::DenoiserEntry> choose_denoiser(const plugin::Registry& registry, const std::string& name) {
    const auto denoisers = registry.denoisers();
    if (denoisers.empty()) return fail("no denoiser plugin is loaded; `restage plugins` says why");
    std::string known, why;
    const plugin::DenoiserEntry* best = nullptr;
    for (const plugin::DenoiserEntry& entry : denoisers) {
        known += (known.empty() ? "" : ", ") + std::string(entry.table->type);
        if (!name.empty()) {
            if (name == entry.table->type || name == entry.plugin->manifest.id) return entry;
            continue;
        }
        const CrashNote note(entry.plugin->blame("while its availability was checked"));
        if (const auto usable = entry.table->available(); !usable)
            why = entry.table->type + " is unavailable: " + usable.error().message;
        else if (!best || (entry.plugin->own && !best->plugin->own))
            best = &entry;
    }
    if (!name.empty()) return fail("there is no denoiser \"" + name + "\"; there are " + known);
    if (!best) return fail(why);
    return *best;
}

namespace {

struct Guided {
    std::span<const glm::vec3> color, albedo, normal;
};

Result<std::vector<glm::vec3>> run(const FilmImage& image, const Guided& in, const plugin::DenoiserEntry& entry,
                                   plugin::DenoiseQuality quality, unsigned threads,
                                   std::function<bool(double done)> keep_going) {
    const plugin::Denoiser& denoiser = *entry.table;
    const CrashNote note(entry.plugin->blame("while it denoised a picture"));
    if (const auto usable = denoiser.available(); !usable)
        return fail("the denoiser " + denoiser.type + " is not available: " + usable.error().message);
    std::vector<glm::vec3> output(in.color.size());
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    const plugin::DenoiseJob job{.width = image.width,
                                 .height = image.height,
                                 .color = &in.color[0].x,
                                 .albedo = &in.albedo[0].x,
                                 .normal = &in.normal[0].x,
                                 .output = &output[0].x,
                                 .quality = quality,
                                 .threads = threads,
                                 .progress = std::move(keep_going)};
    if (const auto done = denoiser.run(job); !done) return fail(denoiser.type, done.error());
    return output;
}

} // namespace

std::string denoiser_label(const plugin::DenoiserEntry& entry, plugin::DenoiseQuality quality) {
    const char* words[] = {"fast", "balanced", "high"};
    return entry.table->type + " " + words[std::size_t(quality)];
}

Result<std::vector<glm::vec3>> denoise(FilmImage& image, const plugin::DenoiserEntry& entry,
                                       plugin::DenoiseQuality quality, unsigned threads,
                                       std::function<bool(double done)> keep_going) {
    if (!has_catchers(image))
        return run(image, {image.color, image.albedo, image.normal}, entry, quality, threads, std::move(keep_going));
    const auto half = [&](double first) {
        return [&keep_going, first](double done) { return !keep_going || keep_going(first + done / 2); };
    };
    FilmImage clean = image;
    remove_shadows(clean);
    RESTAGE_TRY(clean.color, run(image, {clean.color, image.albedo, image.normal}, entry, quality, threads, half(0)));
    // Guides end the shadows where the catcher does.
    std::vector<glm::vec3> where(image.pixels());
    std::ranges::transform(image.caught, where.begin(), [](float caught) { return glm::vec3(caught); });
    const std::vector<glm::vec3> flat(image.pixels(), glm::vec3(0)), noisy = shadow_ratios(image);
    RESTAGE_TRY(const auto ratios, run(image, {noisy, where, flat}, entry, quality, threads, half(0.5)));
    add_shadows(clean, ratios);
    image.alpha = std::move(clean.alpha);
    return std::move(clean.color);
}

} // namespace restage::render
