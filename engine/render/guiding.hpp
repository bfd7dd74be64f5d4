// SPDX-License-Identifier: Apache-2.0
// Guiding: while a picture is rendered, learns from its own paths where light comes from, and hands maps of that to the
// kernels. Maps change when every pixel has a certain number of samples, whatever the batches they came in, so that a
// seed has one picture. Each sample is guided by earlier ones only: all are unbiased, and all go to the film.
#pragma once

#include "gpu/device.hpp"
#include "render/guiding_map.hpp"
#include "render/path_records.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::render {

class Guiding {
  public:
    // For a new picture. planned: its samples per pixel. pixels: of the film and its twins.
    void begin(scene::Technique technique, std::uint32_t planned, std::size_t pixels);
    // Makes a new map if one is due now that every pixel has `samples`.
    Result<void> advance(std::uint32_t samples, gpu::Device& device, Jobs& jobs);
    // How many more samples there are before the next advance() that does something; 2^32 - 1 if there is none.
    std::uint32_t until_change(std::uint32_t samples) const;

    bool learns() const { return learns_; } // wants records
    bool wants(std::uint64_t path) const; // these, of this path: (pixel << 32) + sample
    void add(const PathRecords& records, std::span<const shared::SamplePick> picks,
             std::span<const shared::PathState> paths);

    std::uint64_t address() const { return address_; } // of GuidingData; 0: paths are not guided

  private:
    bool learns_ = false;
    std::uint32_t next_ = 0, last_ = 0; // numbers of samples where a map is due
    std::uint32_t kept_ = 0; // paths of 2^32 that are recorded
    std::vector<GuidingRecord> records_;
    gpu::Buffer nodes_, leaves_, data_;
    std::uint64_t address_ = 0;
};

} // namespace restage::render
