// SPDX-License-Identifier: Apache-2.0
// What image_file.cpp asks of the decoders of single formats: numbers as the file has them, not linear yet. Private to
// io.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace restage::io {

struct DecodedImage {
    std::uint32_t width = 0, height = 0, channels = 0; // 1..4; row 0 on top
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> values;
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
// PNG, JPG, BMP, TGA.
Result<DecodedImage> decode_stb(std::string_view bytes, bool header_only);

// An error when a picture of this size cannot be meant: no pixels, too many to hold, or far more than a file of
// `file_size` bytes can hold in any format.
Result<> check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_size);

} // namespace restage::io
