// SPDX-License-Identifier: Apache-2.0
// Pictures passed from a process that decodes them, and may crash doing so, to the one that needs them: plain numbers,
// which need no decoder. Private to the two ends of one program; the format may change.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace restage::io {

// Decodes the image file `path` into `to`. Returns the size of the pixels in `to`. [bytes] [any]
Result<std::uint64_t> hand_over_image(const std::string& path, const std::filesystem::path& to, std::string* warning);

// As read_image would have returned it. [any]
Result<scene::PixelData> take_over_image(const std::filesystem::path& from, scene::Encoding encoding, float gamma);

} // namespace restage::io
