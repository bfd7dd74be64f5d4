// SPDX-License-Identifier: Apache-2.0
// Pictures decoded by the importer itself: where it must look inside (alpha, one channel, an average), or where there
// is no file the host could read (embedded ones). Everything else goes to the host by its path.
#pragma once

#include "common/values.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::importing {

struct Picture { // row 0 is the top
    std::uint32_t width = 0, height = 0, channels = 0; // 1 grey, 2 grey + alpha, 3, 4 with alpha
    std::vector<std::uint8_t> texels;

    bool has_alpha() const { return channels == 2 || channels == 4; }
    bool alpha_varies() const; // not the same everywhere and not opaque
    double value(std::size_t pixel, unsigned channel) const; // 0..1, as stored; grey for all of r, g, b
};

// PNG, JPEG, TGA, BMP and the like; 16-bit files lose their lower byte. nullopt: `reason` says why.
std::optional<Picture> decode_picture(std::string_view bytes, std::string& reason);
std::optional<Picture> read_picture(const std::string& path, std::string& reason);

double srgb_to_linear(double); // IEC 61966-2-1
Rgb average_color(const Picture&, bool srgb);

} // namespace restage::importing
