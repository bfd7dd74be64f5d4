// SPDX-License-Identifier: Apache-2.0
#include "render/wave_queues.hpp"

#include <numeric>

namespace restage::render {
namespace {

constexpr std::size_t chunk = WaveHits::chunk;
constexpr std::uint8_t type_emit = WaveMemory::type_emit, type_none = WaveMemory::type_none;

} // namespace

void WaveQueues::begin(std::uint32_t paths) {
    active_.resize(paths);
    std::iota(active_.begin(), active_.end(), 0);
}

void WaveQueues::sort(const WaveHits& hits, bool spectral) {
    const auto queue = wave_.queue();
    const auto types = hits.types(), emits = hits.emits();
    places_.assign(hits.counts().begin(), hits.counts().end());
    const std::size_t n = active_.size(), chunks = places_.size();
    // Start of each chunk's paths of each type in the queue, and of its live ones in the next active list.
    count_.fill(0);
    for (auto& c : places_)
        for (std::size_t t = 0; t < type_none; ++t)
            count_[t] += c[t];
    WaveHits::TypeCounts next{};
    for (std::uint32_t t = 1; t < 256; ++t)
        next[t] = next[t - 1] + WaveMemory::whole_groups(count_[t - 1]);
    first_ = next;
    queued_ = next[type_none];
    std::uint32_t live = 0;
    std::vector<std::uint32_t> live_first(chunks);
    for (std::size_t k = 0; k < chunks; ++k) {
        live_first[k] = live;
        for (std::size_t t = 0; t < type_none; ++t) {
            const std::uint32_t c = places_[k][t];
            places_[k][t] = next[t];
            next[t] += c;
            live += t < type_emit ? c : 0;
        }
    }
    next_active_.resize(live);
    jobs_.parallel_for(chunks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t k = begin; k < end; ++k) {
            std::uint32_t to = live_first[k];
            for (std::size_t a = k * chunk; a < std::min(n, (k + 1) * chunk); ++a) {
                const std::uint32_t i = active_[a];
                if (emits[i]) queue[places_[k][type_emit]++] = i;
                if (types[i] == type_none) continue;
                queue[places_[k][types[i]]++] = i;
                if (types[i] < type_emit) next_active_[to++] = i;
            }
        }
    });
    fill_groups(spectral);
    active_.swap(next_active_);
}

// Completes the last group of each type's queue.
void WaveQueues::fill_groups(bool spectral) {
    const auto queue = wave_.queue();
    std::uint32_t spare = WaveMemory::most_paths;
    for (std::size_t t = 0; t < type_none; ++t) {
        const std::uint32_t end = first_[t] + count_[t], whole = first_[t] + WaveMemory::whole_groups(count_[t]);
        for (std::uint32_t k = end; k < whole; ++k, ++spare) {
            const std::uint32_t i = queue[first_[t]];
            wave_.rays()[spare] = wave_.rays()[i];
            wave_.paths()[spare] = wave_.paths()[i];
            if (spectral) wave_.fourths()[spare] = wave_.fourths()[i];
            queue[k] = spare;
        }
    }
}

} // namespace restage::render
