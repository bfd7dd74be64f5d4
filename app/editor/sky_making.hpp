// SPDX-License-Identifier: Apache-2.0
// SkyMaking: generates images of sky plugins on its own thread. Of the requests that arrive meanwhile only the newest
// is processed next, so that a slider may be dragged; a run for another type is cancelled. [main], except the thread.
#pragma once

#include "base/result.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace restage::editor {

class SkyMaking {
  public:
    explicit SkyMaking(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~SkyMaking();
    SkyMaking(const SkyMaking&) = delete;
    SkyMaking& operator=(const SkyMaking&) = delete;

    struct Job {
        plugin::SkyEntry sky;
        scene::ParamSet values;
        std::string gesture; // of the edit; see scene::History
    };
    struct Made {
        Job job;
        Result<std::shared_ptr<const scene::PixelData>> pixels;
    };
    // `now`: the environment that it will replace.
    void ask(Job job, const std::optional<scene::Environment>& now);
    const Job* wanted() const { return wanted_ ? &*wanted_ : nullptr; } // the newest pending request
    // The finished sky, returned once. If the environment has changed since the request, by an edit or an undo,
    // returns nothing and drops all requests.
    std::optional<Made> take(const std::optional<scene::Environment>& now);
    void made_environment(const std::optional<scene::Environment>& now) { expected_ = now; } // by an edit of this class
    void stop();

  private:
    void work();

    std::function<void()> wake_;
    std::optional<Job> wanted_;
    std::optional<scene::Environment> expected_;

    std::mutex mutex_; // of the members below
    std::condition_variable more_;
    std::optional<Job> next_;
    std::optional<Made> made_;
    std::string running_; // type
    bool stop_ = false, abandon_ = false; // abandon: cancels the current run
    std::thread thread_;
};

} // namespace restage::editor
