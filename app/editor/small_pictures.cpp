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
        insert(std::move(job));
    }
    if (!thread_.joinable()) thread_ = std::thread([this, maker] { work(maker); });
    more_.notify_all();
}

void SmallPictures::drop(std::uint64_t number) {
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(jobs_, [number](const Job& job) { return job.number == number; });
        if (now_ == number) drop_ = true;
    }
    more_.notify_all();
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
    more_.notify_all();
}

void SmallPictures::hold(bool on) {
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(held_, on) == on) return;
    }
    more_.notify_all();
}

void SmallPictures::insert(Job job) { // locked
    jobs_.insert(std::ranges::find_if(jobs_, [&](const Job& other) { return other.batch < job.batch; }),
                 std::move(job));
}

// Makes the scene of a job that waits, which ends the job if nothing is to be rendered. Locked, but not meanwhile.
Result<> SmallPictures::prepare(Job& waiting, std::unique_lock<std::mutex>& lock) {
    const std::uint64_t number = waiting.number;
    const auto make = std::exchange(waiting.prepare, {});
    scene::Scene scene;
    lock.unlock();
    auto wanted = make(scene);
    lock.lock();
    const auto job = std::ranges::find(jobs_, number, &Job::number);
    if (job == jobs_.end() || job->prepare) return {}; // dropped, or asked for again
    if (wanted && *wanted) {
        job->scene = std::move(scene);
        return {};
    }
    jobs_.erase(job);
    made_.push_back({.number = number, .image = {}});
    RESTAGE_CHECK(std::move(wanted));
    return {};
}

void SmallPictures::work(Maker maker) {
    lower_thread_priority(lower_);
    maker.options.stand_ins = false;
    maker.options.threads = 1; // the live picture needs the other threads
    std::unique_ptr<render::Renderer> renderer;
    bool said = false;
    const auto say = [&](const Error& error) {
        if (!std::exchange(said, true)) maker.log.warning(what_ + " was not rendered: " + error.message);
    };
    std::unique_lock lock(mutex_);
    while (true) {
        const auto unprepared = [&] {
            return std::ranges::find_if(jobs_, [](const Job& j) { return bool(j.prepare); });
        };
        more_.wait(lock, [&] { return stop_ || (!jobs_.empty() && (!held_ || unprepared() != jobs_.end())); });
        if (stop_) return;
        if (const auto job = unprepared(); job != jobs_.end()) {
            const std::size_t before = made_.size();
            if (const auto done = prepare(*job, lock); !done) say(done.error());
            if (made_.size() != before && wake_) wake_();
            continue;
        }
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        drop_ = false;
        now_ = job.number;
        since_ = std::chrono::steady_clock::now();
        lock.unlock();
        const std::uint32_t coarse = std::exchange(job.coarse, 0);
        Made made{.number = job.number, .image = {}, .coarse = coarse > 0};
        const auto render = [&]() -> Result<void> {
            if (!renderer) {
                RESTAGE_TRY(renderer, render::Renderer::create(maker.options, render::material_lookup(maker.registry),
                                                               maker.log));
            }
            renderer->forget_scene(); // states of one document may have the same versions
            RESTAGE_CHECK(renderer->sync(job.scene));
            bool dropped = false;
            RESTAGE_CHECK(renderer->trace(coarse ? coarse : job.samples, [&] {
                std::unique_lock guard(mutex_);
                more_.wait(guard, [&] { return stop_ || drop_ || !held_; });
                dropped = stop_ || drop_;
                return !dropped;
            }));
            if (dropped) return {};
            made.image = renderer->image();
            if (!coarse && job.done) job.done(made.image);
            return {};
        };
        const auto done = render();
        if (!done) {
            renderer.reset(); // its device may be lost
            made.coarse = false;
            say(done.error());
        }
        lock.lock();
        now_.reset();
        if (stop_) return;
        if (drop_) continue;
        if (made.coarse) {
            job.batch = 0;
            insert(std::move(job));
        }
        made_.push_back(std::move(made));
        if (wake_) wake_();
    }
}

} // namespace restage::editor
