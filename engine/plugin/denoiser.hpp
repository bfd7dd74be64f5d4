// SPDX-License-Identifier: Apache-2.0
// Denoiser: a filter provided by a plugin (restage/denoiser.h), as called by the engine.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <functional>
#include <string>

struct RestageDenoiser1;

namespace restage::plugin {

enum class DenoiseQuality { fast, balanced, high }; // high prefilters the guides first

struct DenoiseJob {
    std::uint32_t width = 0, height = 0;
    const float* color = nullptr;  // RGB, linear, 3 per pixel, row 0 on top
    const float* albedo = nullptr; // RGB in [0,1], or null
    const float* normal = nullptr; // xyz in [-1,1], world space, or null
    float* output = nullptr;       // RGB; may be `color`
    DenoiseQuality quality = DenoiseQuality::high;
    unsigned threads = 0; // 0 = the denoiser's choice
    std::function<bool(double done)> progress; // false = stop; may be empty
};

class Denoiser {
  public:
    static Result<Denoiser> read(const RestageDenoiser1&); // [main] the table must outlive it

    std::string type;  // "oidn"
    std::string label; // "Open Image Denoise 2.5"

    Result<> available() const;              // [any] the error says why it is unavailable here
    Result<> run(const DenoiseJob& job) const; // [worker] one job at a time; a stopped job returns `cancelled`

    // The reason when the plugin gives none.
    static constexpr const char* no_reason = "it gave no reason";

  private:
    const RestageDenoiser1* table_ = nullptr;
};

} // namespace restage::plugin
