// SPDX-License-Identifier: Apache-2.0
// ViewDenoiser: denoises the pictures of a LiveView on its own thread, newest first. [any]
#pragma once

#include "plugin/registry.hpp"
#include "view/live_view.hpp"

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace restage::view {

class ViewDenoiser {
  public:
    struct Host { // all called on that thread
        std::function<bool(const Frame&)> wanted; // false: it may be skipped
        std::function<void(std::shared_ptr<const Frame>)> done;
        std::function<void(const std::string& problem)> says; // why pictures are not denoised; "" = they are
    };
    ViewDenoiser(const plugin::Registry& registry, Host host);
    ~ViewDenoiser(); // stops within about 50 ms

    void add(std::shared_ptr<const Frame> frame);
    // Waits until no coarse picture (divider > 1) is queued or being denoised.
    void finish_coarse();
    // Selects the denoiser, also for the last picture; see render::choose_denoiser.
    void choose(std::string name);

  private:
    void run();
    bool choose_again(std::optional<plugin::DenoiserEntry>& chosen);

    const plugin::Registry& registry_;
    Host host_;
    std::mutex mutex_;
    std::condition_variable wake_, rest_;
    bool stop_ = false;
    std::deque<std::shared_ptr<const Frame>> queue_; // at most a coarse one and the full one
    std::shared_ptr<const Frame> last_; // last added
    std::string name_;
    bool chosen_ = false; // the thread has taken `name_`
    bool coarse_ = false; // it is busy with a coarse picture
    std::thread thread_;
};

} // namespace restage::view
