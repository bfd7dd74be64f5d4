// SPDX-License-Identifier: Apache-2.0
// LightMixer: a picture of each layer of a scene's lights alone. Light is linear, so that their weighted sum is the
// picture with lights of other strengths and colours, without tracing again (Haeberli, "Synthetic lighting for
// photography", 1992). In spectral mode that is exact for strengths; colours are then those of the camera's RGB.
#pragma once

#include "base/log.hpp"
#include "plugin/registry.hpp"
#include "render/film_layers.hpp"
#include "render/renderer_options.hpp"
#include "view/light_layers.hpp"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace restage::view {

struct LightPicture { // immutable once handed out
    render::FilmImage film;
    std::vector<glm::vec3> clean; // its colour denoised; empty: it is not
};
struct LightPictures {
    std::vector<std::shared_ptr<const LightPicture>> layers; // in the order of the job's; null = none yet
    std::uint64_t job = 0;
    bool complete() const; // each layer has a picture
    std::uint32_t samples() const; // a pixel, of the layer with the fewest
};

// The sum of the layers, each times its weight (linear RGB); with `clean`, of denoised pictures. Guides and ids are
// those of the first layer, errors of the colour 0. `pictures` is complete and has at least one. [any]
render::FilmImage mix(const LightPictures& pictures, std::span<const glm::vec3> weights, bool clean);

// The luminance that each layer, times its weight, brings to a spot: the mean of 5 x 5 pixels around `point`; (0,0)
// is the top left, (1,1) the bottom right. [any]
std::vector<double> light_at(const LightPictures& pictures, std::span<const glm::vec3> weights, glm::dvec2 point);
// By how much that layer's weight has to be multiplied for the spot to get `factor` times its light: at least 0, as
// others may bring more than that. None if the layer does not reach it.
std::optional<double> brightening(std::span<const double> light, std::size_t layer, double factor);

class LightMixer {
  public:
    explicit LightMixer(std::function<void()> on_news) : on_news_(std::move(on_news)) {}
    ~LightMixer(); // stops within about 50 ms
    LightMixer(const LightMixer&) = delete;
    LightMixer& operator=(const LightMixer&) = delete;

    // The renderer's host, and the log for failures. Both outlive this.
    struct Maker {
        const plugin::Registry& registry;
        Log& log;
        render::RendererOptions options;
    };
    struct Job {
        scene::Scene scene;
        std::vector<LightLayer> layers;
        glm::uvec2 size{1}; // [pixel]
        std::uint32_t samples = 0; // a pixel of each layer, where it ends
        bool denoise = true;
    };
    // Renders this from now on, on an own thread of low priority: first one sample of each layer, then as many as it
    // has, and so on. Layer i has the seed options.seed + i; a picture depends on its number of samples alone.
    // Returns the job's number. [main]
    std::uint64_t start(const Maker& maker, Job job);
    void pause(bool on); // keeps the pictures [main]
    void stop(); // drops the job and its pictures [main]
    std::shared_ptr<const LightPictures> pictures() const; // of the newest job; null if none [main]
    bool done() const; // all samples of it are there, or it failed [main]

  private:
    struct Work;
    void run(Maker maker);
    bool step(const Maker& maker, Work& work); // false: there is nothing left to do

    std::function<void()> on_news_;
    mutable std::mutex mutex_; // of what follows
    std::condition_variable wake_;
    std::optional<Job> next_; // not yet taken
    std::shared_ptr<const LightPictures> pictures_;
    std::uint64_t number_ = 0; // of the newest job; 0 = stopped
    std::uint64_t last_ = 0; // given to any job
    bool stop_ = false, paused_ = false, done_ = false;
    std::thread thread_;
};

} // namespace restage::view
