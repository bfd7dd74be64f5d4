// SPDX-License-Identifier: Apache-2.0
// SkyMaking: pictures of sky plugins are made on a thread of its own. Of what is asked for while one is being made only
// the newest is made next, so that a slider may be dragged; one of another type is stopped. [main], but for the thread.
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
    // `now`: the environment that it is to replace.
    void ask(Job job, const std::optional<scene::Environment>& now);
    const Job* wanted() const { return wanted_ ? &*wanted_ : nullptr; } // the newest that is not made yet
    // What is done, once. Nothing, and all that was asked for is given up, where the environment is no more what it was
    // when it was asked for: something else was done meanwhile, or undone.
    std::optional<Made> take(const std::optional<scene::Environment>& now);
    void made_environment(const std::optional<scene::Environment>& now) { expected_ = now; } // by an edit of ours
    void stop();

  private:
    void work();

    std::function<void()> wake_;
    std::optional<Job> wanted_;
    std::optional<scene::Environment> expected_;

    std::mutex mutex_; // of what follows
    std::condition_variable more_;
    std::optional<Job> next_;
    std::optional<Made> made_;
    std::string running_; // type
    bool stop_ = false, abandon_ = false; // abandon: the one that is being made
    std::thread thread_;
};

} // namespace restage::editor
