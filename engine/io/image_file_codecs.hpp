// SPDX-License-Identifier: Apache-2.0
// The interface of the individual decoders to image_file.cpp: values as in the file, not yet linear. Private to
// io.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace restage::io {

struct DecodedImage {
    std::uint32_t width = 0, height = 0, channels = 0; // 1..4; row 0 on top
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> values;
    std::string warning{}; // what is wrong with a picture that can still be shown, or ""
};

// Messages of decoders do not name the file: read_image does.
bool is_pfm(std::string_view bytes);
Result<DecodedImage> decode_pfm(std::string_view bytes, bool header_only);
bool is_exr(std::string_view bytes);
// To be called before OpenEXR sees the bytes: it allocates what an attribute claims before checking that it exists.
Result<> check_exr_header(std::string_view bytes);
Result<DecodedImage> decode_exr(std::string_view bytes, bool header_only);
bool is_hdr(std::string_view bytes);
Result<DecodedImage> decode_hdr(std::string_view bytes, bool header_only);
bool is_png(std::string_view bytes);
Result<DecodedImage> decode_png(std::string_view bytes, bool header_only);
bool is_jpeg(std::string_view bytes);
Result<DecodedImage> decode_jpeg(std::string_view bytes, bool header_only);
// 1 or 3 channels of 8 bits; up to 65500 pixels per side.
Result<std::string> encode_jpeg(std::uint32_t width, std::uint32_t height, int channels, int quality,
                                const std::vector<std::uint8_t>& values);
bool is_webp(std::string_view bytes);
Result<DecodedImage> decode_webp(std::string_view bytes, bool header_only);
// BMP, TGA: the formats without a reliable signature.
Result<DecodedImage> decode_stb(std::string_view bytes, bool header_only);

// Any format, detected by the first bytes; NaN and infinity in float files replaced as in read_image. Errors of
// the first do not name the file, those of the second do.
Result<DecodedImage> decode_image_bytes(std::string_view bytes, bool header_only = false);
Result<DecodedImage> decode_image_file(const std::string& path, bool header_only = false);

// Linearizes 8- and 16-bit values, turns grey with alpha into RGBA; as in read_image.
scene::PixelData linear_image(DecodedImage, scene::Encoding, float gamma);

// An error if a picture of this size is implausible: no pixels, too many to hold, or more than a file of `file_size`
// bytes can hold at `most_texels_per_byte` at most; 0: the format's compression is unbounded.
Result<> check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_size,
                          std::uint64_t most_texels_per_byte = 0);

} // namespace restage::io
