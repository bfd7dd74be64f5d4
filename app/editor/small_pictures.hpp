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
    // `what`: for the message that one was not rendered. `lower`: the thread's priority, as lower_thread_priority.
    explicit SmallPictures(std::function<void()> wake, std::string what = "a small picture", int lower = 10)
        : wake_(std::move(wake)), what_(std::move(what)), lower_(lower) {}
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
        std::uint32_t coarse = 0; // > 0: a picture of so few comes first; the full one waits behind all other jobs
        std::uint64_t batch = 0; // before those that wait of smaller numbers, and behind those of its own
        // [worker] Makes the scene, or finds the picture elsewhere and returns false: nothing is rendered. Done for all
        // that wait before the next is rendered.
        std::function<Result<bool>(scene::Scene&)> prepare = {};
        std::function<void(const render::FilmImage&)> done = {}; // [worker] the full picture
    };
    struct Made {
        std::uint64_t number = 0;
        render::FilmImage image; // of no pixels: it was not rendered; the log says why if it could not be
        bool coarse = false; // the full one follows
    };
    void ask(const Maker& maker, Job job); // [main] in the order asked
    void drop(std::uint64_t number); // [main] unless it is made
    void hold(bool on); // [main] while true nothing is rendered, though scenes are made
    struct Place {
        std::size_t before = 0; // how many are rendered before it; 0 = it is rendered now,
        double seconds = 0; // for so long
    };
    std::optional<Place> place(std::uint64_t number); // [main] of one that was asked for and is not made
    std::vector<Made> take(); // [main] those made since
    void forget(); // [main] drops all jobs, and what they made

  private:
    void insert(Job job);
    Result<> prepare(Job& waiting, std::unique_lock<std::mutex>& lock);
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
    bool held_ = false;
    int lower_;
    std::thread thread_;
};

} // namespace restage::editor
