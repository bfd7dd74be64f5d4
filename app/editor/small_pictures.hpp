// SPDX-License-Identifier: Apache-2.0
// SmallPictures: pictures of whole scenes, rendered one after the other by a separate renderer on a low-priority
// thread, so that the live picture and the window hardly notice.
#pragma once

#include "base/log.hpp"
#include "plugin/registry.hpp"
#include "render/film.hpp"
#include "render/renderer_options.hpp"
#include "scene/scene.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace restage::editor {

class SmallPictures {
  public:
    // `what`: for the message that one was not rendered.
    explicit SmallPictures(std::function<void()> wake, std::string what = "a small picture")
        : wake_(std::move(wake)), what_(std::move(what)) {}
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
        bool next = false; // before all that wait
        // [worker] Makes the scene first, or finds the picture elsewhere and returns false: nothing is rendered.
        std::function<Result<bool>(scene::Scene&)> prepare = {};
        std::function<void(const render::FilmImage&)> done = {}; // [worker] what was rendered
    };
    struct Made {
        std::uint64_t number = 0;
        render::FilmImage image; // of no pixels: it was not rendered; the log says why if it could not be
    };
    void ask(const Maker& maker, Job job); // [main] in the order asked
    void drop(std::uint64_t number); // [main] if it still waits
    struct Place {
        std::size_t before = 0; // how many are rendered before it; 0 = it is rendered now,
        double seconds = 0; // for so long
    };
    std::optional<Place> place(std::uint64_t number); // [main] of one that was asked for and is not made
    std::vector<Made> take(); // [main] those made since
    void forget(); // [main] drops all jobs, and what they made

  private:
    void work(Maker maker);

    std::function<void()> wake_;
    std::string what_;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Job> jobs_;
    std::vector<Made> made_;
    std::optional<std::uint64_t> now_; // number of the job being rendered
    std::chrono::steady_clock::time_point since_;
    bool stop_ = false, drop_ = false; // drop_: the job being rendered
    std::thread thread_;
};

} // namespace restage::editor
