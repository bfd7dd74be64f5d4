// SPDX-License-Identifier: Apache-2.0
#include "opening.hpp"

#include "base/thread_priority.hpp"

namespace restage::editor {

void Opening::start(std::filesystem::path path, Purpose purpose) {
    cancel_and_wait();
    path_ = std::move(path);
    purpose_ = purpose;
    cancelled_ = finished_ = false;
    progress_ = 0;
    thread_ = std::thread([this] {
        lower_thread_priority(2);
        io::ImportOptions options;
        options.progress = [this](float done, std::string_view what) {
            progress_ = done;
            {
                std::lock_guard lock(mutex_);
                stage_ = what;
            }
            wake_();
            return !cancelled_;
        };
        auto result = io::import_scene(path_.string(), registry_, options);
        {
            std::lock_guard lock(mutex_);
            result_ = std::move(result);
        }
        finished_ = true;
        wake_();
    });
}

std::string Opening::stage() const {
    std::lock_guard lock(mutex_);
    return stage_;
}

std::optional<Result<io::ImportedScene>> Opening::take() {
    if (!thread_.joinable() || !finished_) return std::nullopt;
    thread_.join();
    std::lock_guard lock(mutex_);
    return std::exchange(result_, std::nullopt);
}

void Opening::cancel_and_wait() {
    cancelled_ = true;
    if (thread_.joinable()) thread_.join();
    result_.reset();
}

} // namespace restage::editor
