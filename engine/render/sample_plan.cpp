// SPDX-License-Identifier: Apache-2.0
#include "render/sample_plan.hpp"

#include <algorithm>

namespace restage::render {

SamplePlan::SamplePlan(const TraceRequest& request, std::uint32_t pixels, std::uint32_t most,
                       std::uint32_t most_per_pixel)
    : request_(request), pixels_(pixels), most_(most) {
    std::uint32_t busy = 0; // pixels with samples to take
    for (std::uint32_t p = 0; p < pixels; ++p) {
        const std::uint32_t count = of(p).count;
        longest_ = std::max(longest_, count);
        busy += count > 0;
    }
    per_pixel_ = std::clamp(std::min(most / std::max(busy, 1u), most_per_pixel), 1u, std::max(longest_, 1u));
}

PixelSamples SamplePlan::of(std::uint32_t pixel) const {
    return request_.pixels.empty() ? PixelSamples{request_.first_sample, request_.samples} : request_.pixels[pixel];
}

bool SamplePlan::next() {
    picks_.clear();
    runs_.clear();
    for (; taken_ < longest_ && picks_.empty(); taken_ += per_pixel_, at_ = 0) { // a pixel has one run in a wave
        for (; at_ < pixels_; ++at_) {
            const PixelSamples samples = of(at_);
            if (samples.count <= taken_) continue;
            const std::uint32_t count = std::min(per_pixel_, samples.count - taken_);
            const auto first = std::uint32_t(picks_.size());
            if (first + count > most_) return true;
            runs_.push_back({at_, first, count});
            for (std::uint32_t k = 0; k < count; ++k)
                picks_.push_back({at_, samples.first + taken_ + k});
        }
    }
    return !picks_.empty();
}

} // namespace restage::render
