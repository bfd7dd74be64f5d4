// SPDX-License-Identifier: Apache-2.0
// SmallPictures: pictures of whole scenes, rendered one after the other by a separate renderer on a low-priority
// thread, so that the live picture and the window hardly notice.
#pragma once

#include "base/log.hpp"
#include "plugin/registry.hpp"
#include "render/film.hpp"
#include "render/renderer_options.hpp"
#include "scene/scene.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace restage::editor {

class SmallPictures {
  public:
    explicit SmallPictures(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~SmallPictures();
    SmallPictures(const SmallPictures&) = delete;
    SmallPictures& operator=(const SmallPictures&) = delete;

    // The renderer's host, and the log for failures. Both outlive this.
    struct Maker {
        const plugin::Registry& registry;
        Log& log;
        render::RendererOptions options;
    };
    struct Job {
        std::uint64_t number = 0; // of the caller's; an earlier job of that number is dropped
        scene::Scene scene;       // its film has the picture's size
        std::uint32_t samples = 0; // a pixel
    };
    struct Made {
        std::uint64_t number = 0;
        render::FilmImage image; // of no pixels: it could not be rendered, and the log says why
    };
    void ask(const Maker& maker, Job job); // [main] in the order asked
    std::vector<Made> take(); // [main] those made since
    void forget(); // [main] drops all jobs, and what they made

  private:
    void work(Maker maker);

    std::function<void()> wake_;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Job> jobs_;
    std::vector<Made> made_;
    bool stop_ = false, drop_ = false; // drop_: the job being rendered
    std::thread thread_;
};

} // namespace restage::editor
