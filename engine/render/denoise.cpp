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
        const char* reason = nullptr;
        const CrashNote note(entry.plugin->blame("while it was asked whether it can be used"));
        if (!entry.table->available(&reason))
            why = std::string(entry.table->type) + " cannot be used: " + (reason ? reason : "it does not say why");
        else if (!best || (entry.plugin->own && !best->plugin->own))
            best = &entry;
    }
    if (!name.empty()) return fail("there is no denoiser \"" + name + "\"; there are " + known);
    if (!best) return fail(why);
    return *best;
}

std::string denoiser_label(const plugin::DenoiserEntry& entry, RestageDenoiseQuality quality) {
    const char* words[] = {"fast", "balanced", "high"};
    return std::string(entry.table->type) + " " + words[quality];
}

Result<std::vector<glm::vec3>> denoise(const FilmImage& image, const plugin::DenoiserEntry& entry,
                                       RestageDenoiseQuality quality, unsigned threads,
                                       std::function<bool(double done)> keep_going) {
    const RestageDenoiser1& denoiser = *entry.table;
    const CrashNote note(entry.plugin->blame("while it denoised a picture"));
    const char* reason = "";
    if (!denoiser.available(&reason))
        return fail(std::string("the denoiser ") + denoiser.type + " is not available: " + reason);
    std::vector<glm::vec3> output(image.color.size());
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    RestageDenoiseJob job{};
    job.size = sizeof(job);
    job.width = image.width;
    job.height = image.height;
    job.color = &image.color[0].x;
    job.albedo = &image.albedo[0].x;
    job.normal = &image.normal[0].x;
    job.output = &output[0].x;
    job.quality = quality;
    job.threads = threads;
    struct Progress {
        std::function<bool(double)> keep_going;
        std::atomic<bool> stopped{false}; // a denoiser may ask from any thread
    } progress{std::move(keep_going)};
    if (progress.keep_going) {
        job.progress_ctx = &progress;
        job.progress = [](void* ctx, double done) {
            auto& p = *static_cast<Progress*>(ctx);
            if (!p.keep_going(done)) p.stopped = true;
            return p.stopped ? 0 : 1;
        };
    }
    const bool ran = denoiser.run(&job, &reason) != 0;
    if (!ran && progress.stopped) return cancelled(std::string(denoiser.type) + ": stopped on request");
    if (!ran) return fail(std::string(denoiser.type) + ": " + (reason ? reason : "failed"));
    return output;
}

} // namespace restage::render
