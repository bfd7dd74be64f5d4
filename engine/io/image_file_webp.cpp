// SPDX-License-Identifier: Apache-2.0
// WebP, lossy and lossless, through libwebp. Animations are refused: they are not one picture.

#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <webp/decode.h>
#include <algorithm>

namespace restage::io {

bool is_webp(std::string_view bytes) { return bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP"); }

Result<DecodedImage> decode_webp(std::string_view bytes, bool header_only) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const auto truncated = [&] {
        return fail(fmt::format("truncated: the file ends inside the picture ({} bytes)", bytes.size()));
    };
    WebPBitstreamFeatures features{};
    const VP8StatusCode status = WebPGetFeatures(data, bytes.size(), &features);
    if (status == VP8_STATUS_NOT_ENOUGH_DATA) return truncated();
    if (status != VP8_STATUS_OK) return fail("the picture is broken: WebP: invalid header");
    if (features.has_animation) return fail("animated WebP pictures are not read; save one frame");
    const auto width = static_cast<std::uint32_t>(std::max(features.width, 0)),
               height = static_cast<std::uint32_t>(std::max(features.height, 0));
    RESTAGE_CHECK(check_image_size(width, height, bytes.size()));
    std::uint64_t riff = 8; // bytes 4-7: how many follow, little-endian; checked before allocating
    for (std::size_t i = 0; i < 4; ++i)
        riff += std::uint64_t{data[4 + i]} << (8 * i);
    if (riff > bytes.size()) return truncated();
    DecodedImage image{.width = width, .height = height, .channels = features.has_alpha ? 4u : 3u};
    if (header_only) return image;

    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config)) return fail("libwebp's version differs from the one built against");
    std::vector<std::uint8_t> values(std::size_t{width} * height * image.channels);
    config.output.colorspace = features.has_alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = values.data();
    config.output.u.RGBA.stride = static_cast<int>(width * image.channels);
    config.output.u.RGBA.size = values.size();
    const VP8StatusCode decoded = WebPDecode(data, bytes.size(), &config);
    WebPFreeDecBuffer(&config.output);
    if (decoded == VP8_STATUS_NOT_ENOUGH_DATA || decoded == VP8_STATUS_SUSPENDED) return truncated();
    if (decoded == VP8_STATUS_OUT_OF_MEMORY) return fail("out of memory");
    if (decoded != VP8_STATUS_OK)
        return fail(fmt::format("the picture is broken: WebP: error {}", static_cast<int>(decoded)));
    image.values = std::move(values);
    return image;
}

} // namespace restage::io
