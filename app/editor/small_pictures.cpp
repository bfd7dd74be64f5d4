// SPDX-License-Identifier: Apache-2.0
#include "small_pictures.hpp"

#include "base/thread_priority.hpp"
#include "render/renderer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace restage::editor {

SmallPictures::~SmallPictures() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    more_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SmallPictures::ask(const Maker& maker, Job job) {
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(jobs_, [&](const Job& other) { return other.number == job.number; });
        jobs_.insert(job.next ? jobs_.begin() : jobs_.end(), std::move(job));
    }
    if (!thread_.joinable()) thread_ = std::thread([this, maker] { work(maker); });
    more_.notify_all();
}

void SmallPictures::drop(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    std::erase_if(jobs_, [number](const Job& job) { return job.number == number; });
}

std::optional<SmallPictures::Place> SmallPictures::place(std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    if (now_ == number)
        return Place{.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since_).count()};
    const auto found = std::ranges::find(jobs_, number, &Job::number);
    if (found == jobs_.end()) return std::nullopt;
    return Place{.before = std::size_t(found - jobs_.begin()) + 1};
}

std::vector<SmallPictures::Made> SmallPictures::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(made_, {});
}

void SmallPictures::forget() {
    const std::lock_guard lock(mutex_);
    jobs_.clear();
    made_.clear();
    drop_ = true;
}

void SmallPictures::work(Maker maker) {
    lower_thread_priority(10);
    maker.options.stand_ins = false;
    maker.options.threads = 1; // the live picture needs the other threads
    std::unique_ptr<render::Renderer> renderer;
    bool said = false;
    std::unique_lock lock(mutex_);
    while (true) {
        more_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
        if (stop_) return;
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        drop_ = false;
        now_ = job.number;
        since_ = std::chrono::steady_clock::now();
        lock.unlock();
        Made made{job.number, {}};
        const auto render = [&]() -> Result<void> {
            if (job.prepare) {
                RESTAGE_TRY(const bool wanted, job.prepare(job.scene));
                if (!wanted) return {};
            }
            if (!renderer) {
                RESTAGE_TRY(renderer, render::Renderer::create(maker.options, render::material_lookup(maker.registry),
                                                               maker.log));
            }
            renderer->forget_scene(); // states of one document may have the same versions
            RESTAGE_CHECK(renderer->sync(job.scene));
            bool dropped = false;
            RESTAGE_CHECK(renderer->trace(job.samples, [&] {
                const std::lock_guard guard(mutex_);
                dropped = stop_ || drop_;
                return !dropped;
            }));
            if (dropped) return {};
            made.image = renderer->image();
            if (job.done) job.done(made.image);
            return {};
        };
        if (const auto done = render(); !done) {
            renderer.reset(); // its device may be lost
            if (!std::exchange(said, true)) maker.log.warning(what_ + " was not rendered: " + done.error().message);
        }
        lock.lock();
        now_.reset();
        if (stop_) return;
        if (drop_) continue;
        made_.push_back(std::move(made));
        if (wake_) wake_();
    }
}

} // namespace restage::editor
