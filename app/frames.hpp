// SPDX-License-Identifier: Apache-2.0
// Frames of an animation with one scene file each: shot.0001.pbrt, shot.0002.pbrt ...
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace restage::app {

// "7", "1-24", "1-24x2" (every second one), "1-3,9": in the given order.
Result<std::vector<std::uint32_t>> parse_frames(const std::string& text);

// The last run of # is replaced by the number, padded with zeros to its length: "shot.####.pbrt" -> "shot.0012.pbrt".
std::string frame_path(const std::string& path, std::uint32_t frame);

} // namespace restage::app
