// SPDX-License-Identifier: Apache-2.0
// BackgroundJobs: long work (exports, final pictures) on separate threads, each with a progress bar, its current step,
// the time left, and a stop button.
#pragma once

#include "base/result.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace restage::editor {

class PanelContext;

class BackgroundJob {
  public:
    // [worker] done is 0..1. False: stop.
    bool report(double done, std::string_view stage);
    bool cancelled() const { return cancelled_; }
    bool finish_early() const { return finish_early_; } // stop early and keep the result, if the job offers it
    // [worker] From here on cancelling ends the current work, but not the job: its result is still used.
    void keep_result() { keeps_result_ = true; }
    bool stopping() const { return cancelled_ || finish_early_; }
    // [worker] While the user pauses the job, until it is stopped or `given_up()`.
    void wait_while_paused(const std::function<bool()>& given_up = {});

  private:
    friend class BackgroundJobs;
    std::string title_;
    bool can_finish_early_ = false, pauses_picture_ = false;
    std::function<void()> wake_;
    std::function<void(PanelContext&)> details_;
    bool can_pause_ = false;
    std::atomic<bool> cancelled_ = false, finish_early_ = false, finished_ = false, keeps_result_ = false,
                      paused_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::mutex mutex_;
    std::condition_variable goes_on_;
    double seconds_paused_ = 0;
    double done_ = 0;
    std::string stage_;
    std::function<void(PanelContext&)> then_;
    std::thread thread_;
};

class BackgroundJobs {
  public:
    explicit BackgroundJobs(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~BackgroundJobs();

    struct Options {
        std::string title; // "Exporting kitchen.pbrt"
        bool can_finish_early = false; // a button ends it with the result so far
        bool pauses_picture = false; // the live picture pauses meanwhile
        bool can_pause = false; // a button, for work that calls wait_while_paused
        std::function<void(PanelContext&)> details = {}; // [main] drawn below the bar
    };
    // `work` runs on a thread; the function it returns runs on the main thread, unless the job was cancelled.
    using Work = std::function<std::function<void(PanelContext&)>(BackgroundJob&)>;
    void start(Options options, Work work);

    void update(PanelContext& editor); // [main] once a frame, inside it: draws bars, completes finished jobs
    bool running() const { return !jobs_.empty(); }
    bool picture_paused() const;
    double progress() const; // of the first; 0..1

  private:
    std::function<void()> wake_;
    std::vector<std::unique_ptr<BackgroundJob>> jobs_;
};

} // namespace restage::editor
