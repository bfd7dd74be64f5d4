// SPDX-License-Identifier: Apache-2.0
#include "render/denoise.hpp"

#include <atomic>
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

std::string denoiser_label(const plugin::DenoiserEntry& entry, plugin::DenoiseQuality quality) {
    const char* words[] = {"fast", "balanced", "high"};
    return entry.table->type + " " + words[std::size_t(quality)];
}

Result<std::vector<glm::vec3>> denoise(const FilmImage& image, const plugin::DenoiserEntry& entry,
                                       plugin::DenoiseQuality quality, unsigned threads,
                                       std::function<bool(double done)> keep_going) {
    const plugin::Denoiser& denoiser = *entry.table;
    const CrashNote note(entry.plugin->blame("while it denoised a picture"));
    if (const auto usable = denoiser.available(); !usable)
        return fail("the denoiser " + denoiser.type + " is not available: " + usable.error().message);
    std::vector<glm::vec3> output(image.color.size());
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    const plugin::DenoiseJob job{.width = image.width,
                                 .height = image.height,
                                 .color = &image.color[0].x,
                                 .albedo = &image.albedo[0].x,
                                 .normal = &image.normal[0].x,
                                 .output = &output[0].x,
                                 .quality = quality,
                                 .threads = threads,
                                 .progress = std::move(keep_going)};
    if (const auto done = denoiser.run(job); !done) return fail(denoiser.type, done.error());
    return output;
}

} // namespace restage::render
