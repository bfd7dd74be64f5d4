// SPDX-License-Identifier: Apache-2.0
// Parameter values on their way to the host. Ids and enum texts are literals.
#pragma once

#include <restage/params.h>
#include <array>
#include <cstdint>
#include <vector>

namespace restage::importing {

using Rgb = std::array<double, 3>; // linear sRGB primaries

class Values {
  public:
    void number(const char* id, double value) {
        values_.push_back({id, RESTAGE_FLOAT, 0, {static_cast<float>(value), 0, 0, 0}, nullptr});
    }
    void integer(const char* id, int value) {
        values_.push_back({id, RESTAGE_INT, 0, {static_cast<float>(value), 0, 0, 0}, nullptr});
    }
    void boolean(const char* id, bool value) {
        values_.push_back({id, RESTAGE_BOOL, 0, {value ? 1.f : 0.f, 0, 0, 0}, nullptr});
    }
    void color(const char* id, const Rgb& c) {
        values_.push_back({id,
                           RESTAGE_COLOR,
                           0,
                           {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), 0},
                           nullptr});
    }
    void choice(const char* id, const char* value) { values_.push_back({id, RESTAGE_ENUM, 0, {}, value}); }
    // A texture stands for a value of that type; RESTAGE_TEXTURE: a slot without a constant.
    void texture(const char* id, RestageType type, std::uint32_t handle) {
        values_.push_back({id, static_cast<std::uint32_t>(type), handle, {}, nullptr});
    }
    const RestageValue* data() const { return values_.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }

  private:
    std::vector<RestageValue> values_;
};

} // namespace restage::importing
