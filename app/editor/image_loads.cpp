// SPDX-License-Identifier: Apache-2.0
#include "image_loads.hpp"

#include "base/thread_priority.hpp"
#include "io/image_file.hpp"

#include <algorithm>

namespace restage::editor {

scene::PixelData thumbnail_of(const scene::PixelData& image, std::uint32_t longer_side) {
    const std::uint32_t longer = std::max(image.width, image.height);
    if (longer <= longer_side) return image;
    scene::PixelData small{.width = std::max(1u, image.width * longer_side / longer),
                           .height = std::max(1u, image.height * longer_side / longer),
                           .channels = image.channels,
                           .values = {}};
    small.values.resize(std::size_t(small.width) * small.height * small.channels);
    for (std::uint32_t y = 0; y < small.height; ++y)
        for (std::uint32_t x = 0; x < small.width; ++x) {
            const std::uint32_t x0 = x * image.width / small.width,
                                x1 = std::max(x0 + 1, (x + 1) * image.width / small.width);
            const std::uint32_t y0 = y * image.height / small.height,
                                y1 = std::max(y0 + 1, (y + 1) * image.height / small.height);
            for (std::uint32_t c = 0; c < image.channels; ++c) {
                float sum = 0;
                for (std::uint32_t j = y0; j < y1; ++j)
                    for (std::uint32_t i = x0; i < x1; ++i)
                        sum += image.values[(std::size_t(j) * image.width + i) * image.channels + c];
                small.values[(std::size_t(y) * small.width + x) * small.channels + c] =
                    sum / float((x1 - x0) * (y1 - y0));
            }
        }
    return small;
}

ImageLoads::~ImageLoads() {
    {
        std::lock_guard lock(mutex_);
        stop_ = true;
    }
    more_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void ImageLoads::start(Job job) {
    {
        std::lock_guard lock(mutex_);
        // Before the first thumbnail, or at the back.
        const auto at = job.thumbnail
                            ? jobs_.end()
                            : std::find_if(jobs_.begin(), jobs_.end(), [](const Job& j) { return j.thumbnail != 0; });
        jobs_.insert(at, std::move(job));
    }
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    more_.notify_all();
}

std::size_t ImageLoads::waiting() const {
    std::lock_guard lock(mutex_);
    return jobs_.size() + running_ + finished_.size();
}

void ImageLoads::poll() {
    std::deque<Finished> done;
    {
        std::lock_guard lock(mutex_);
        done.swap(finished_);
    }
    for (Finished& f : done)
        if (f.job.done) f.job.done(std::move(f.pixels));
}

void ImageLoads::work() {
    lower_thread_priority(10);
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (jobs_.empty()) {
            more_.wait(lock);
            continue;
        }
        Job job = std::move(jobs_.front());
        jobs_.pop_front();
        running_ = 1;
        lock.unlock();
        auto read = io::read_image(job.path, job.encoding, job.gamma);
        Result<std::shared_ptr<const scene::PixelData>> pixels =
            read ? Result<std::shared_ptr<const scene::PixelData>>(std::make_shared<const scene::PixelData>(
                       job.thumbnail ? thumbnail_of(*read, job.thumbnail) : std::move(*read)))
                 : tl::unexpected<Error>(read.error());
        lock.lock();
        running_ = 0;
        finished_.push_back({std::move(job), std::move(pixels)});
        if (wake_) wake_();
    }
}

} // namespace restage::editor
