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
        values_.push_back({.type = RESTAGE_FLOAT, .id = id, .v = {static_cast<float>(value)}});
    }
    void integer(const char* id, int value) { values_.push_back({.type = RESTAGE_INT, .id = id, .i = value}); }
    void boolean(const char* id, bool value) { values_.push_back({.type = RESTAGE_BOOL, .id = id, .i = value}); }
    void color(const char* id, const Rgb& c) {
        values_.push_back({.type = RESTAGE_COLOR,
                           .id = id,
                           .v = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])}});
    }
    void choice(const char* id, const char* value) {
        values_.push_back({.type = RESTAGE_ENUM, .id = id, .text = value});
    }
    // A texture instead of a value of that type; RESTAGE_TEXTURE: a slot without a constant.
    void texture(const char* id, RestageType type, std::uint32_t handle) {
        values_.push_back({.type = static_cast<std::uint32_t>(type), .id = id, .ref = handle});
    }
    const RestageValue* data() const { return values_.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(values_.size()); }

  private:
    std::vector<RestageValue> values_;
};

} // namespace restage::importing
