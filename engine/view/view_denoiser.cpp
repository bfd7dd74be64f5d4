// SPDX-License-Identifier: Apache-2.0
#include "view/view_denoiser.hpp"

#include "base/thread_priority.hpp"
#include "render/denoise.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace restage::view {

ViewDenoiser::ViewDenoiser(const plugin::Registry& registry, Host host) : registry_(registry), host_(std::move(host)) {
    thread_ = std::thread([this] { run(); });
}

ViewDenoiser::~ViewDenoiser() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

// The newest, but a coarse one of the same request precedes the full one: it takes a quarter of the time.
void ViewDenoiser::add(std::shared_ptr<const Frame> frame) {
    {
        const std::lock_guard lock(mutex_);
        if (!queue_.empty() && queue_.back()->request != frame->request) queue_.clear();
        if (!queue_.empty() && (queue_.back()->divider == 1 || frame->divider > 1)) queue_.pop_back();
        last_ = frame;
        queue_.push_back(std::move(frame));
    }
    wake_.notify_one();
}

void ViewDenoiser::finish_coarse() {
    std::unique_lock lock(mutex_);
    rest_.wait(lock, [&] {
        return stop_ || (!coarse_ && std::ranges::all_of(queue_, [](const auto& f) { return f->divider == 1; }));
    });
}

void ViewDenoiser::choose(std::string name) {
    {
        const std::lock_guard lock(mutex_);
        if (name == name_) return;
        name_ = std::move(name);
        chosen_ = false;
        if (last_ && queue_.empty()) queue_.push_back(last_);
    }
    wake_.notify_one();
}

// False: unknown or unusable; already reported.
bool ViewDenoiser::choose_again(std::optional<plugin::DenoiserEntry>& chosen) {
    std::string name;
    {
        const std::lock_guard lock(mutex_);
        if (std::exchange(chosen_, true)) return chosen.has_value();
        name = name_;
    }
    auto found = render::choose_denoiser(registry_, name);
    chosen = found ? std::optional(*found) : std::nullopt;
    host_.says(found ? "" : found.error().message);
    return chosen.has_value();
}

void ViewDenoiser::run() {
    lower_thread_priority(3); // higher than rendering (5): it delivers the shown pictures
    std::optional<plugin::DenoiserEntry> denoiser;
    for (;;) {
        const bool able = choose_again(denoiser);
        std::shared_ptr<const Frame> source;
        {
            std::unique_lock lock(mutex_);
            coarse_ = false;
            rest_.notify_all();
            wake_.wait(lock, [&] { return stop_ || !queue_.empty() || !chosen_; });
            if (stop_) return;
            if (!chosen_) continue;
            source = std::move(queue_.front());
            queue_.pop_front();
            coarse_ = source->divider > 1;
        }
        if (!able) continue;
        const auto keep_going = [&](double) {
            {
                const std::lock_guard lock(mutex_);
                if (stop_) return false;
            }
            return host_.wanted(*source);
        };
        const auto start = std::chrono::steady_clock::now();
        auto frame = std::make_shared<Frame>(*source);
        auto color = render::denoise(frame->image, *denoiser, plugin::DenoiseQuality::fast, 0, keep_going);
        if (!color && color.error().cancelled()) continue;
        host_.says(color ? "" : color.error().message); // on failure, noisy pictures are shown
        if (!color) continue;
        frame->image.color = std::move(*color);
        frame->denoised = true;
        frame->denoise_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        frame->denoiser = denoiser->table->type;
        host_.done(std::move(frame));
    }
}

} // namespace restage::view
