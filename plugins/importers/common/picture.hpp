// SPDX-License-Identifier: Apache-2.0
// Pictures decoded for the importer: where it must look inside (alpha, one channel, an average), or where there is no
// file the host could read (embedded ones). The host's decoder does it; everything else goes to the host by its path.
#pragma once

#include "common/values.hpp"

#include <restage/image.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace restage::importing {

// For RESTAGE_PLUGIN_INIT: asks the host for its decoder. 1: it has one.
int use_host_pictures(const RestageHost*);

// Row 0 is the top. Copies share the texels; none may outlive the plugin.
struct Picture {
    std::uint32_t width = 0, height = 0, channels = 0; // 1 grey, 2 grey + alpha, 3, 4 with alpha
    std::string problem{};                             // what is wrong with a file that can be shown all the same
    std::shared_ptr<const RestageDecodedImage> texels{};

    bool has_alpha() const { return channels == 2 || channels == 4; }
    bool alpha_varies() const; // not the same everywhere and not opaque
    // Colour as an sRGB file has it, 0..1 (16 bits in full; of float files, which are linear, what sRGB would make of
    // it, and it may be above 1); grey for all of r, g, b. Channel 3 is alpha, 1 where there is none.
    double value(std::size_t pixel, unsigned channel) const;
};

// PNG, JPEG, WebP, BMP, TGA, HDR, EXR, PFM. nullopt: `reason` says why, and names the file (`name`).
std::optional<Picture> decode_picture(std::string_view bytes, const std::string& name, std::string& reason);
std::optional<Picture> read_picture(const std::string& path, std::string& reason);

double srgb_to_linear(double); // IEC 61966-2-1
Rgb average_color(const Picture&, bool srgb);

} // namespace restage::importing
