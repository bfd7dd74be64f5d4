// SPDX-License-Identifier: Apache-2.0
#include "view/light_mixer.hpp"

#include "base/thread_priority.hpp"
#include "render/catcher.hpp"
#include "render/denoise.hpp"
#include "render/film_error.hpp"
#include "render/renderer.hpp"
#include "view/merge_pictures.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace restage::view {

bool LightPictures::complete() const {
    return std::ranges::all_of(layers, [](const auto& layer) { return layer != nullptr; });
}

std::uint32_t LightPictures::samples() const {
    std::uint32_t least = ~0u;
    for (const auto& layer : layers)
        least = std::min(least, layer ? layer->film.samples : 0u);
    return layers.empty() ? 0 : least;
}

namespace {

// The light on catchers with objects, divided by that without, as it is in the layer's picture.
std::vector<glm::vec3> ratios_of(const LightPicture& layer, bool clean) {
    const render::FilmImage& film = layer.film;
    std::vector<glm::vec3> ratios = render::shadow_ratios(film);
    for (std::size_t i = 0; clean && i < ratios.size(); ++i) // what a denoised picture tells of it
        if (film.caught[i] > 0) ratios[i] = glm::vec3(1 - (film.coverage[i] - film.alpha[i]) / film.caught[i]);
    return ratios;
}

} // namespace

render::FilmImage mix(const LightPictures& pictures, std::span<const glm::vec3> weights, bool clean) {
    render::FilmImage sum = pictures.layers.front()->film;
    sum.samples = pictures.samples();
    std::ranges::fill(sum.std_error, glm::vec3(0));
    std::ranges::fill(sum.sample_error, glm::vec3(0));
    std::ranges::fill(sum.luminance_variance, 0.f);
    std::ranges::fill(sum.twin, glm::vec2(0));
    std::ranges::fill(sum.color, glm::vec3(0));
    // Shadows on catchers are ratios of sums over all lights.
    const bool catchers =
        std::ranges::all_of(pictures.layers, [](const auto& layer) { return render::has_catchers(layer->film); });
    if (catchers)
        for (auto* values : {&sum.shade, &sum.without, &sum.backdrop})
            std::ranges::fill(*values, glm::vec3(0));
    for (std::size_t i = 0; i < pictures.layers.size(); ++i) {
        const LightPicture& layer = *pictures.layers[i];
        const bool is_clean = clean && !layer.clean.empty();
        const std::vector<glm::vec3>& color = is_clean ? layer.clean : layer.film.color;
        const glm::vec3 weight = i < weights.size() ? weights[i] : glm::vec3(1);
        if (weight == glm::vec3(0)) continue;
        for (std::size_t at = 0; at < sum.color.size(); ++at)
            sum.color[at] += weight * color[at];
        if (!catchers) continue;
        const std::vector<glm::vec3> ratios = ratios_of(layer, is_clean);
        for (std::size_t at = 0; at < sum.color.size(); ++at) {
            const glm::vec3 without = weight * layer.film.without[at], behind = weight * layer.film.backdrop[at];
            sum.color[at] -= behind * (ratios[at] - 1.f);
            sum.without[at] += without;
            sum.shade[at] += without * (ratios[at] - 1.f);
            sum.backdrop[at] += behind;
        }
    }
    if (catchers) render::add_shadows(sum, render::shadow_ratios(sum));
    return sum;
}

std::vector<double> light_at(const LightPictures& pictures, std::span<const glm::vec3> weights, glm::dvec2 point) {
    std::vector<double> light(pictures.layers.size(), 0);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const LightPicture& layer = *pictures.layers[i];
        const std::vector<glm::vec3>& color = layer.clean.empty() ? layer.film.color : layer.clean;
        const glm::ivec2 size(layer.film.width, layer.film.height), at(point * glm::dvec2(size));
        const glm::ivec2 low = glm::clamp(at - 2, glm::ivec2(0), size - 1), high = glm::clamp(at + 2, low, size - 1);
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                light[i] += render::luminance(weights[i] * color[std::size_t(y) * layer.film.width + std::size_t(x)]);
        light[i] /= double(high.x - low.x + 1) * (high.y - low.y + 1);
    }
    return light;
}

std::optional<double> brightening(std::span<const double> light, std::size_t layer, double factor) {
    const double total = std::accumulate(light.begin(), light.end(), 0.0);
    if (!(light[layer] > 1e-4 * total)) return std::nullopt;
    return std::max((light[layer] + (factor - 1) * total) / light[layer], 0.0);
}

// Of the thread: a job, and what it needs.
struct LightMixer::Work {
    Job job;
    std::uint64_t number = 0;
    std::unique_ptr<render::Renderer> renderer;
    LightBoard board;
    LightPictures pictures;
    bool fresh = false; // the renderer has not seen the job's scene
};

LightMixer::~LightMixer() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

std::uint64_t LightMixer::start(const Maker& maker, Job job) {
    scene::Film& film = job.scene.film.value;
    film.width = std::max(job.size.x, 1u);
    film.height = std::max(job.size.y, 1u);
    film.crop = {0, 1, 0, 1};
    job.scene.settings.value.adaptive = false; // pictures of different lights would have samples in different places
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        number = number_ = ++last_;
        pictures_.reset();
        done_ = false;
        next_ = std::move(job);
    }
    if (!thread_.joinable()) thread_ = std::thread([this, maker] { run(maker); });
    wake_.notify_all();
    return number;
}

void LightMixer::pause(bool on) {
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(paused_, on) == on) return;
    }
    wake_.notify_all();
}

void LightMixer::stop() {
    {
        const std::lock_guard lock(mutex_);
        number_ = 0;
        next_.reset();
        pictures_.reset();
        done_ = false;
    }
    wake_.notify_all();
}

std::shared_ptr<const LightPictures> LightMixer::pictures() const {
    const std::lock_guard lock(mutex_);
    return pictures_;
}

bool LightMixer::done() const {
    const std::lock_guard lock(mutex_);
    return done_;
}

void LightMixer::run(Maker maker) {
    lower_thread_priority(10);
    maker.options.stand_ins = false;
    Work work;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock,
                   [&] { return stop_ || (!number_ && work.renderer) || (number_ && !paused_ && (next_ || !done_)); });
        if (stop_) return;
        if (!number_) { // frees what the renderer holds
            lock.unlock();
            work = {};
            lock.lock();
            continue;
        }
        if (next_) {
            work.job = std::move(*next_);
            next_.reset();
            work.number = number_;
            work.pictures = {.layers = {work.job.layers.size(), nullptr}, .job = work.number};
            work.board.forget();
            work.fresh = true;
        }
        lock.unlock();
        const bool more = step(maker, work);
        lock.lock();
        if (work.number != number_) continue; // there is a newer one
        if (!more) done_ = true;
        if (work.pictures.complete() || !more) pictures_ = std::make_shared<const LightPictures>(work.pictures);
        lock.unlock();
        on_news_();
        lock.lock();
    }
}

bool LightMixer::step(const Maker& maker, Work& work) {
    const auto samples = [](const auto& layer) { return layer ? layer->film.samples : 0u; };
    const auto least = std::ranges::min_element(work.pictures.layers, {}, samples);
    if (least == work.pictures.layers.end() || samples(*least) >= std::max(work.job.samples, 1u)) return false;
    const auto index = std::size_t(least - work.pictures.layers.begin());
    const std::uint32_t have = samples(*least), wanted = std::clamp(have, 1u, std::max(work.job.samples - have, 1u));
    const auto wanted_still = [this, number = work.number](bool pauses) {
        const std::lock_guard lock(mutex_);
        return !stop_ && number == number_ && !(pauses && paused_);
    };
    const auto render = [&]() -> Result<std::shared_ptr<const LightPicture>> {
        if (!work.renderer) {
            RESTAGE_TRY(work.renderer,
                        render::Renderer::create(maker.options, render::material_lookup(maker.registry), maker.log));
        }
        render::Renderer& renderer = *work.renderer;
        if (std::exchange(work.fresh, false)) renderer.forget_scene(); // another's may have the same versions
        work.board.clear();
        for (const LightKey key : work.job.layers[index].lights)
            work.board.solo(key, true);
        RESTAGE_CHECK(renderer.sync(work.board.follow(work.job.scene, maker.registry)));
        renderer.restart(maker.options.seed + std::uint32_t(index), have);
        RESTAGE_CHECK(renderer.trace(wanted, [&] { return wanted_still(true); }));
        if (renderer.samples() < wanted) return std::shared_ptr<const LightPicture>();
        auto picture = std::make_shared<LightPicture>();
        picture->film = renderer.image();
        if (have > 0) {
            const std::array parts{PicturePart{.film = &(*least)->film, .first_sample = 0},
                                   PicturePart{.film = &picture->film, .first_sample = have}};
            RESTAGE_TRY(picture->film, merge_films(parts));
        }
        if (!work.job.denoise) return picture;
        const auto denoiser = render::choose_denoiser(maker.registry, "");
        if (!denoiser) return picture; // the toolbar says so
        auto clean = render::denoise(picture->film, *denoiser, plugin::DenoiseQuality::fast, 0,
                                     [&](double) { return wanted_still(false); });
        if (clean) picture->clean = std::move(*clean);
        return picture;
    };
    auto made = render();
    if (!made) {
        work.renderer.reset(); // its device may be lost
        work.fresh = true;
        maker.log.warning("the lights were not rendered: " + made.error().message);
        return false;
    }
    if (*made) *least = std::move(*made);
    return true;
}

} // namespace restage::view
