// SPDX-License-Identifier: Apache-2.0
#include "sky_making.hpp"

#include "base/thread_priority.hpp"
#include "io/sky.hpp"

#include <utility>

namespace restage::editor {

namespace {

bool same(const std::optional<scene::Environment>& a, const std::optional<scene::Environment>& b) {
    return a && b ? a->sky == b->sky && a->sky_params == b->sky_params && a->image == b->image : !a && !b;
}

} // namespace

SkyMaking::~SkyMaking() {
    {
        std::lock_guard lock(mutex_);
        stop_ = true;
    }
    more_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SkyMaking::ask(Job job, const std::optional<scene::Environment>& now) {
    wanted_ = job;
    expected_ = now;
    {
        std::lock_guard lock(mutex_);
        if (running_ != job.sky.table->type) abandon_ = true;
        next_ = std::move(job);
    }
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    more_.notify_all();
}

void SkyMaking::stop() {
    wanted_.reset();
    std::lock_guard lock(mutex_);
    next_.reset();
    made_.reset();
    abandon_ = true;
}

std::optional<SkyMaking::Made> SkyMaking::take(const std::optional<scene::Environment>& now) {
    if (!wanted_) return std::nullopt;
    if (!same(expected_, now)) {
        stop();
        return std::nullopt;
    }
    std::lock_guard lock(mutex_);
    if (!made_) return std::nullopt;
    if (!next_ && running_.empty()) wanted_.reset();
    return std::exchange(made_, std::nullopt);
}

void SkyMaking::work() {
    lower_thread_priority(10);
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (!next_) {
            more_.wait(lock);
            continue;
        }
        Job job = std::move(*next_);
        next_.reset();
        running_ = job.sky.table->type;
        abandon_ = false;
        lock.unlock();
        auto pixels = io::make_sky(job.sky, job.values, [&](float, std::string_view) {
            std::lock_guard asked(mutex_);
            return !stop_ && !abandon_;
        });
        lock.lock();
        running_.clear();
        if (!abandon_) made_ = Made{std::move(job), std::move(pixels)};
        if (wake_) wake_();
    }
}

} // namespace restage::editor
