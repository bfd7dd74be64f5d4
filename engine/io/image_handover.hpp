// SPDX-License-Identifier: Apache-2.0
// Pictures on their way from a process that decodes them, and may end at it, to the one that wants them: plain numbers,
// which take no decoder to read. Private to the two ends of one program; the format may change.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace restage::io {

// Decodes the image file `path` into `to`. Returns what the numbers of `to` take. [bytes] [any]
Result<std::uint64_t> hand_over_image(const std::string& path, const std::filesystem::path& to, std::string* warning);

// As read_image would have given it. [any]
Result<scene::PixelData> take_over_image(const std::filesystem::path& from, scene::Encoding encoding, float gamma);

} // namespace restage::io
