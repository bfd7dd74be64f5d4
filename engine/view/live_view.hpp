// SPDX-License-Identifier: Apache-2.0
// LiveView: a picture that follows a scene while it is edited. Rendering and denoising have their own threads, below
// the caller's priority; the newest scene wins. During changes, a coarse picture comes first, at a resolution chosen
// from the measured speed, and is refined by halving to the full one, which then accumulates samples.
//
// Threads: all public functions are [main] and return immediately. `on_news` is called from the threads.
#pragma once

#include "base/log.hpp"
#include "render/clay_look.hpp"
#include "render/film_layers.hpp"
#include "render/renderer_options.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace restage::plugin {
class Registry;
}

namespace restage::view {

// A finished picture. Immutable once handed out.
struct Frame {
    render::FilmImage image; // colour is denoised if `denoised`
    std::uint64_t request = 0; // of the corresponding show()
    std::uint64_t document = 0; // of its ViewOptions
    std::uint32_t divider = 1; // full resolution / this resolution
    bool denoised = false;
    std::string denoiser; // its type, if `denoised`
    bool clay = false; // first hits only, see render/clay.hpp; colours in [0,1], not to be exposed
    std::optional<render::ClayLook> look; // of one with `clay` that ViewOptions::look asked for
    std::vector<std::uint32_t> counts; // samples of each pixel; empty if `clay`
    double seconds = 0; // since that show()
    double relative_error = 1e30; // of the traced picture; render::relative_error
    double denoise_seconds = 0; // if `denoised`
};

struct ViewOptions {
    glm::uvec2 size{640, 360}; // of the full picture [pixel]
    std::uint64_t document = 0; // a new number = a new scene: nothing of the previous one is reused or shown
    std::uint64_t variant = 0; // a new number = the same document in another state (as it was opened): nothing
                               // of the previous one is reused, but its picture stays until there is a new one
    bool denoise = true;
    bool paused = false; // keep the current picture
    std::optional<render::ClayLook>
        look; // show first hits: nothing is traced meanwhile, and the picture continues later
    // Only this part is rendered, at full resolution; around it the picture stays as it was. x0 x1 y0 y1 in [0,1], as
    // Film::crop. Without a picture of the document yet, all of it.
    std::optional<glm::vec4> region;
    std::uint32_t samples = 0; // stop at this many per pixel; 0 = never
    double seconds = 0; // stop after this time; 0 = never
    double error = 0; // stop at this relative error; 0 = never
};

enum class ViewState {
    starting, // opening the device
    preparing, // uploading, building, compiling
    rendering,
    done, // a target is reached, or paused
    failed
};

struct ViewStatus {
    ViewState state = ViewState::starting;
    std::string text; // of `failed`: why
    std::string device, tracer; // once started
    std::string compiling; // a material type still compiling: a stand-in is shown, or clay; "" = none
    std::size_t compiling_left = 0; // how many types
    bool current = false; // frame() shows the newest request
    std::uint32_t samples = 0, divider = 1; // of the picture in progress
    double samples_per_second = 0; // pixels times samples, measured
    std::size_t gpu_bytes = 0;
    double update_seconds = 0, sample_seconds = 0; // the last scene's upload, the last sample of every pixel
    std::map<std::string, std::uint64_t> not_finite; // samples dropped, by material type
};

class LiveView {
  public:
    // `registry` must outlive it.
    LiveView(const plugin::Registry& registry, Log& log, render::RendererOptions options,
             std::function<void()> on_news);
    ~LiveView(); // stops within about 50 ms

    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    // Shows this scene from now on. Returns the number of the request.
    std::uint64_t show(scene::Scene scene, const ViewOptions& options);
    // Reopens the renderer, with another device, tracer or number of threads.
    void configure(render::RendererOptions options);
    // Selects the denoiser, see render::choose_denoiser; also for the current picture.
    void denoise_by(const std::string& name);

    // The newest pictures of the last requested document; null before the first. frame(): as traced.
    std::shared_ptr<const Frame> frame() const;
    std::shared_ptr<const Frame> denoised() const;
    // The picture to show; null: nothing yet. With `want_denoised` never a noisy one: the last clean one, of any
    // request, stays until the next is ready. A document starts with clay, until all it needs is compiled and its
    // first picture exists. Without a working denoiser, noisy ones.
    std::shared_ptr<const Frame> best(bool want_denoised) const;
    ViewStatus status() const;
    // Why pictures are not being denoised; "" = they are.
    std::string denoiser_missing() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::view
