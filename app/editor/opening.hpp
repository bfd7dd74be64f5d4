// SPDX-License-Identifier: Apache-2.0
// Opening: a scene file is read on a thread of its own while the editor goes on, with progress and cancel.
#pragma once

#include "io/import.hpp"
#include "plugin/registry.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace restage::editor {

class Opening {
  public:
    enum class Purpose { replace, insert }; // becomes the document, or joins it

    Opening(const plugin::Registry& registry, std::function<void()> wake)
        : registry_(registry), wake_(std::move(wake)) {}
    ~Opening() { cancel_and_wait(); }

    // Gives up what is being read, if anything.
    void start(std::filesystem::path path, Purpose purpose);
    void cancel() { cancelled_ = true; }
    bool running() const { return thread_.joinable(); }
    float progress() const { return progress_; }
    std::string stage() const;
    const std::filesystem::path& path() const { return path_; }
    Purpose purpose() const { return purpose_; }
    // What came of it, once; nothing while it runs.
    std::optional<Result<io::ImportedScene>> take();
    bool was_cancelled() const { return cancelled_; }

  private:
    void cancel_and_wait();

    const plugin::Registry& registry_;
    std::function<void()> wake_;
    std::thread thread_;
    std::filesystem::path path_;
    Purpose purpose_ = Purpose::replace;
    std::atomic<bool> cancelled_ = false, finished_ = false;
    std::atomic<float> progress_ = 0;
    mutable std::mutex mutex_;
    std::string stage_;
    std::optional<Result<io::ImportedScene>> result_;
};

} // namespace restage::editor
