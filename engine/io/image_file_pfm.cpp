// SPDX-License-Identifier: Apache-2.0
// Portable float maps: "PF" (3 channels) or "Pf" (1), width height, scale (negative: little-endian), one white-space
// character, then rows from the bottom up. The magnitude of the scale is ignored, as in all readers.
// http://www.pauldebevec.com/Research/HDR/PFM/

#include "base/file.hpp"
#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <bit>
#include <charconv>
#include <cstring>

namespace restage::io {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The next word of the header; moves `at` behind it.
std::string_view next_word(std::string_view bytes, std::size_t& at) {
    while (at < bytes.size() && is_space(bytes[at]))
        ++at;
    const std::size_t start = at;
    while (at < bytes.size() && !is_space(bytes[at]) && at - start < 64)
        ++at;
    return bytes.substr(start, at - start);
}

template <class Number>
Result<Number> next_number(std::string_view bytes, std::size_t& at, const char* what) {
    const auto word = next_word(bytes, at);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
        return fail(fmt::format("PFM header: {} expected at byte {}, not '{}'", what, at - word.size(), word));
    return value;
}

} // namespace

bool is_pfm(std::string_view bytes) {
    return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') && is_space(bytes[2]);
}

Result<DecodedImage> decode_pfm(std::string_view bytes, bool header_only) {
    std::size_t at = 2;
    RESTAGE_TRY(const auto width, next_number<std::uint32_t>(bytes, at, "the width"));
    RESTAGE_TRY(const auto height, next_number<std::uint32_t>(bytes, at, "the height"));
    RESTAGE_TRY(const auto scale, next_number<double>(bytes, at, "the scale"));
    if (!(scale < 0 || scale > 0)) return fail("PFM header: the scale must not be 0: its sign gives the byte order");
    ++at; // exactly one white-space character
    RESTAGE_CHECK(check_image_size(width, height, bytes.size(), 1));
    DecodedImage image{.width = width, .height = height, .channels = bytes[1] == 'F' ? 3u : 1u};
    if (header_only) return image;

    const std::size_t row = std::size_t{width} * image.channels;
    const std::size_t wanted = row * height * sizeof(float);
    if (bytes.size() < at || bytes.size() - at < wanted)
        return fail(fmt::format("truncated: {} bytes of pixels declared, {} found", wanted,
                                bytes.size() < at ? 0 : bytes.size() - at));
    std::vector<float> values(row * height);
    for (std::size_t y = 0; y < height; ++y)
        std::memcpy(&values[y * row], bytes.data() + at + (height - 1 - y) * row * sizeof(float), row * sizeof(float));
    if ((scale < 0) != (std::endian::native == std::endian::little))
        for (float& v : values) {
            const auto bits = std::bit_cast<std::uint32_t>(v);
            v = std::bit_cast<float>(bits >> 24 | (bits >> 8 & 0xff00u) | (bits << 8 & 0xff0000u) | bits << 24);
        }
    image.values = std::move(values);
    return image;
}

Result<> write_pfm(const std::string& path, const scene::PixelData& image) {
    static_assert(std::endian::native == std::endian::little, "write_pfm writes the machine's own byte order");
    if (image.channels != 1 && image.channels != 3 && image.channels != 4)
        return fail(fmt::format("{}: PFM holds 1 or 3 channels, not {}", path, image.channels));
    const std::uint32_t channels = image.channels == 1 ? 1 : 3;
    std::string bytes = fmt::format("{}\n{} {}\n-1.0\n", channels == 3 ? "PF" : "Pf", image.width, image.height);
    bytes.reserve(bytes.size() + std::size_t{image.width} * image.height * channels * sizeof(float));
    for (std::size_t y = image.height; y-- > 0;)
        for (std::size_t x = 0; x < image.width; ++x) {
            const float* texel = &image.values[(y * image.width + x) * image.channels];
            bytes.append(reinterpret_cast<const char*>(texel), channels * sizeof(float));
        }
    return write_file_atomic(path, bytes);
}

} // namespace restage::io
