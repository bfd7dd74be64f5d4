// SPDX-License-Identifier: Apache-2.0
// Denoiser: a filter that a plugin brings (restage/denoiser.h), as the engine calls it.
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
    const float* color = nullptr;  // RGB, linear, 3 a pixel, row 0 on top
    const float* albedo = nullptr; // RGB in [0,1], or null
    const float* normal = nullptr; // xyz in [-1,1], world space, or null
    float* output = nullptr;       // RGB; may be `color`
    DenoiseQuality quality = DenoiseQuality::high;
    unsigned threads = 0; // 0 = the denoiser's choice
    std::function<bool(double done)> progress; // false = stop; may be empty
};

class Denoiser {
  public:
    static Result<Denoiser> read(const RestageDenoiser1&); // [main] the table outlives it

    std::string type;  // "oidn"
    std::string label; // "Open Image Denoise 2.5"

    Result<> available() const;              // [any] the error says why it cannot be used here
    Result<> run(const DenoiseJob& job) const; // [worker] one job at a time; what was stopped is cancelled

    // What `available` and `run` say of a plugin that does not.
    static constexpr const char* no_reason = "it does not say why";

  private:
    const RestageDenoiser1* table_ = nullptr;
};

} // namespace restage::plugin
