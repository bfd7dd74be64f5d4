// SPDX-License-Identifier: Apache-2.0
// ImageLoads: reads image files on its own thread, one after the other; callbacks run on the main
// thread, in poll().
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace restage::editor {

class ImageLoads {
  public:
    explicit ImageLoads(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~ImageLoads();
    ImageLoads(const ImageLoads&) = delete;
    ImageLoads& operator=(const ImageLoads&) = delete;

    struct Job {
        std::string path;
        scene::Encoding encoding = scene::Encoding::srgb;
        float gamma = 2.2f;
        std::uint32_t thumbnail = 0; // longer side [pixel]; 0 = all of it
        std::function<void(Result<std::shared_ptr<const scene::PixelData>>)> done; // [main]
    };
    void start(Job job); // thumbnails wait until all others are read
    void poll();         // [main] once a frame
    std::size_t waiting() const;

  private:
    void work();

    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Job> jobs_;
    struct Finished {
        Job job;
        Result<std::shared_ptr<const scene::PixelData>> pixels;
    };
    std::deque<Finished> finished_;
    std::thread thread_;
    std::size_t running_ = 0;
    bool stop_ = false;
};

// The image scaled down to this longer side by averaging; smaller ones stay as they are. [any]
scene::PixelData thumbnail_of(const scene::PixelData& image, std::uint32_t longer_side);

} // namespace restage::editor
