// SPDX-License-Identifier: Apache-2.0
// WaveQueues: the paths of a wave that still live, and the hits of each shading type in the queue that kernels read.
#pragma once

#include "render/wave_hits.hpp"

namespace restage::render {

class WaveQueues {
  public:
    WaveQueues(WaveMemory& wave, Jobs& jobs) : wave_(wave), jobs_(jobs) {}

    void begin(std::uint32_t paths); // all are active
    // Queues the hits of the active paths by type, in whole groups; those that will be shaded stay active.
    void sort(const WaveHits& hits, bool spectral);

    std::span<const std::uint32_t> active() const { return active_; } // in natural order
    std::uint32_t first(std::size_t type) const { return first_[type]; } // of the type's hits in the queue
    std::span<const std::uint32_t> counts() const { return std::span(count_).first(WaveMemory::type_none); } // by type
    std::span<const std::uint32_t> of(std::size_t type) const { // its hits in the queue
        return wave_.queue().subspan(first_[type], count_[type]);
    }
    bool empty() const { return queued_ == 0; }

  private:
    void fill_groups(bool spectral);

    WaveMemory& wave_;
    Jobs& jobs_;
    std::vector<std::uint32_t> active_, next_active_;
    std::vector<WaveHits::TypeCounts> places_; // by chunk: where its next hit of each type goes
    WaveHits::TypeCounts count_{}, first_{};
    std::uint32_t queued_ = 0;
};

} // namespace restage::render
