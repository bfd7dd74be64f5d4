// SPDX-License-Identifier: Apache-2.0
// What image_file.cpp asks of the decoders of single formats: numbers as the file has them, not linear yet. Private to
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
    std::string warning{}; // what is wrong with a picture that can be shown all the same, or ""
};

// Messages of decoders do not name the file: read_image does.
bool is_pfm(std::string_view bytes);
Result<DecodedImage> decode_pfm(std::string_view bytes, bool header_only);
bool is_exr(std::string_view bytes);
// To be asked before OpenEXR sees the bytes: it allocates what an attribute claims before it looks whether it is there.
Result<> check_exr_header(std::string_view bytes);
Result<DecodedImage> decode_exr(std::string_view bytes, bool header_only);
bool is_hdr(std::string_view bytes);
Result<DecodedImage> decode_hdr(std::string_view bytes, bool header_only);
bool is_png(std::string_view bytes);
Result<DecodedImage> decode_png(std::string_view bytes, bool header_only);
bool is_jpeg(std::string_view bytes);
Result<DecodedImage> decode_jpeg(std::string_view bytes, bool header_only);
// 1 or 3 channels of 8 bits; up to 65500 pixels a side.
Result<std::string> encode_jpeg(std::uint32_t width, std::uint32_t height, int channels, int quality,
                                const std::vector<std::uint8_t>& values);
bool is_webp(std::string_view bytes);
Result<DecodedImage> decode_webp(std::string_view bytes, bool header_only);
// BMP, TGA: those without a sure sign at their beginning.
Result<DecodedImage> decode_stb(std::string_view bytes, bool header_only);

// Of any format, told apart by the first bytes; NaN and infinity of float files replaced, as read_image says. Errors of
// the first do not name the file, those of the second do.
Result<DecodedImage> decode_image_bytes(std::string_view bytes, bool header_only = false);
Result<DecodedImage> decode_image_file(const std::string& path, bool header_only = false);

// Numbers of 8 and 16 bits become linear, grey with alpha RGBA; as read_image says.
scene::PixelData linear_image(DecodedImage, scene::Encoding, float gamma);

// An error when a picture of this size cannot be meant: no pixels, too many to hold, or more than a file of `file_size`
// bytes can hold when a byte stands for `most_texels_per_byte` at most; 0: the format's packing knows no bound.
Result<> check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_size,
                          std::uint64_t most_texels_per_byte = 0);

} // namespace restage::io
