// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <restage/scene_io.h>
#include <array>
#include <string>
#include <string_view>

namespace restage::exporters {

// The values of a material or texture, by id, with defaults from the plugins' tables for unset ones.
class Values {
  public:
    Values(const RestageValue* values, std::uint32_t count) : values_(values), count_(count) {}
    const RestageValue* find(std::string_view id) const;
    float number(std::string_view id, float otherwise) const;
    int integer(std::string_view id, int otherwise) const; // a boolean, too
    bool boolean(std::string_view id, bool otherwise) const { return integer(id, otherwise) != 0; }
    std::string choice(std::string_view id, const char* otherwise) const;
    std::array<float, 3> color(std::string_view id, std::array<float, 3> otherwise) const;
    RestageHandle ref(std::string_view id) const;

  private:
    const RestageValue* values_;
    std::uint32_t count_;
};

// The mean of a texture as far as its values tell, for approximations; grey where they do not. `depth` ends cycles.
std::array<float, 3> average(const RestageSceneReader1&, RestageHandle texture, int depth = 0);

// The microfacets' alpha of a roughness; remap: "v4" (pbrt-v4 TrowbridgeReitzDistribution::RoughnessToAlpha), "v3"
// (pbrt-v3's) or "none".
double alpha_of_roughness(double roughness, std::string_view remap);

} // namespace restage::exporters
