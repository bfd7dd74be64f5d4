// SPDX-License-Identifier: Apache-2.0
// Pictures decoded for the importer: if it needs the texels (alpha, one channel, an average), or if there is no file
// for the host to read (embedded ones). The host's decoder does it; all other pictures go to the host by path.
#pragma once

#include "common/values.hpp"

#include <restage/image.h>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace restage::importing {

// For RESTAGE_PLUGIN_INIT: gets the host's decoder. 1 if it has one.
int use_host_pictures(const RestageHost*);

// Row 0 is the top. Copies share the texels; none may outlive the plugin.
struct Picture {
    std::uint32_t width = 0, height = 0, channels = 0; // 1 grey, 2 grey + alpha, 3, 4 with alpha
    std::string problem{};                             // what is wrong with a file that is still usable
    std::shared_ptr<const RestageDecodedImage> texels{};

    bool has_alpha() const { return channels == 2 || channels == 4; }
    bool alpha_varies() const; // neither uniform nor opaque
    // Colour sRGB-encoded, 0..1 (16 bits in full; float files, which are linear, are encoded, and
    // may exceed 1); grey for all of r, g, b. Channel 3 is alpha, 1 if there is none.
    double value(std::size_t pixel, unsigned channel) const;
};

// PNG, JPEG, WebP, BMP, TGA, HDR, EXR, PFM. nullopt: `reason` says why, and names the file (`name`).
std::optional<Picture> decode_picture(std::string_view bytes, const std::string& name, std::string& reason);
std::optional<Picture> read_picture(const std::string& path, std::string& reason);

double srgb_to_linear(double); // IEC 61966-2-1
Rgb average_color(const Picture&, bool srgb);

} // namespace restage::importing
