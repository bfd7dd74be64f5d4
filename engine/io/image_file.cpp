// SPDX-License-Identifier: Apache-2.0
// Image files: decoder selection, linearisation, and checks on every incoming picture.

#include "io/image_file.hpp"

#include "base/file.hpp"
#include "io/exr.hpp"
#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <new>

namespace restage::io {

namespace {

constexpr std::uint64_t max_extent = 1u << 17;       // texels per side
constexpr std::uint64_t max_texels = 1ull << 28;     // 16384 x 16384; 4 GiB as float RGBA
constexpr std::uint64_t most_image_bytes = 5ull << 30; // max_texels as plain float RGBA, and a gigabyte of names
constexpr const char* out_of_memory =
    "out of memory: the picture is too large for this machine or the configured limit";
constexpr float largest_half = 65504.f;

float decode(float encoded, scene::Encoding encoding, float gamma) {
    switch (encoding) {
        case scene::Encoding::srgb:
            return srgb_to_linear(encoded);
        case scene::Encoding::gamma:
            return std::pow(encoded, gamma);
        case scene::Encoding::linear:
            break;
    }
    return encoded;
}

// 0..2^bits-1 -> linear.
std::vector<float> decoding_table(std::size_t size, scene::Encoding encoding, float gamma) {
    std::vector<float> table(size);
    for (std::size_t i = 0; i < size; ++i)
        table[i] = decode(static_cast<float>(i) / static_cast<float>(size - 1), encoding, gamma);
    return table;
}

template <class Integer>
std::vector<float> linearise(const std::vector<Integer>& encoded, std::uint32_t channels, scene::Encoding encoding,
                             float gamma) {
    constexpr std::size_t levels = std::size_t{1} << (8 * sizeof(Integer));
    const auto table = decoding_table(levels, encoding, gamma);
    const bool has_alpha = channels == 2 || channels == 4;
    std::vector<float> linear(encoded.size());
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        const bool alpha = has_alpha && i % channels == channels - 1;
        linear[i] = alpha ? static_cast<float>(encoded[i]) / static_cast<float>(levels - 1) : table[encoded[i]];
    }
    return linear;
}

std::vector<float> grey_alpha_to_rgba(const std::vector<float>& in) {
    std::vector<float> out(in.size() * 2);
    for (std::size_t i = 0; i < in.size() / 2; ++i) {
        out[4 * i] = out[4 * i + 1] = out[4 * i + 2] = in[2 * i];
        out[4 * i + 3] = in[2 * i + 1];
    }
    return out;
}

// Keeps NaN and infinity out of shaders and sums.
std::string replace_non_finite(std::vector<float>& values) {
    std::size_t nan = 0, infinite = 0;
    for (float& v : values) {
        if (std::isfinite(v)) continue;
        if (std::isnan(v)) {
            v = 0;
            ++nan;
        } else {
            v = std::copysign(largest_half, v);
            ++infinite;
        }
    }
    std::string text;
    if (nan > 0) text = fmt::format("{} values are NaN and became 0", nan);
    if (infinite > 0)
        text += fmt::format("{}{} values are infinite and became {}", nan > 0 ? ", " : "", infinite, largest_half);
    return text;
}

} // namespace

float srgb_to_linear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float linear_to_srgb(float linear) {
    if (!(linear > 0)) return 0; // also NaN
    if (linear >= 1) return 1;
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

scene::PixelData linear_image(DecodedImage decoded, scene::Encoding encoding, float gamma) {
    scene::PixelData image{.width = decoded.width, .height = decoded.height, .channels = decoded.channels};
    if (auto* bytes = std::get_if<std::vector<std::uint8_t>>(&decoded.values))
        image.values = linearise(*bytes, decoded.channels, encoding, gamma);
    else if (auto* words = std::get_if<std::vector<std::uint16_t>>(&decoded.values))
        image.values = linearise(*words, decoded.channels, encoding, gamma);
    else
        image.values = std::move(std::get<std::vector<float>>(decoded.values));
    if (image.channels == 2) {
        image.values = grey_alpha_to_rgba(image.values);
        image.channels = 4;
    }
    assert(image.values.size() == std::size_t{image.width} * image.height * image.channels);
    return image;
}

Result<DecodedImage> decode_image_bytes(std::string_view bytes, bool header_only) {
    try {
        if (bytes.empty()) return fail("the file is empty");
        auto image = is_exr(bytes)    ? decode_exr(bytes, header_only)
                     : is_pfm(bytes)  ? decode_pfm(bytes, header_only)
                     : is_hdr(bytes)  ? decode_hdr(bytes, header_only)
                     : is_png(bytes)  ? decode_png(bytes, header_only)
                     : is_jpeg(bytes) ? decode_jpeg(bytes, header_only)
                     : is_webp(bytes) ? decode_webp(bytes, header_only)
                                      : decode_stb(bytes, header_only);
        if (!image) return image;
        if (auto* values = std::get_if<std::vector<float>>(&image->values))
            if (const auto note = replace_non_finite(*values); !note.empty())
                image->warning += (image->warning.empty() ? "" : "; ") + note;
        return image;
    } catch (const std::bad_alloc&) {
        return fail(out_of_memory);
    }
}

Result<DecodedImage> decode_image_file(const std::string& path, bool header_only) {
    RESTAGE_TRY(const std::string bytes, read_file(path, most_image_bytes));
    auto decoded = decode_image_bytes(bytes, header_only);
    if (!decoded) return fail(path, decoded.error());
    return decoded;
}

Result<> check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t file_size,
                          std::uint64_t most_texels_per_byte) {
    if (width == 0 || height == 0) return fail(fmt::format("the header says {} x {}: no pixels", width, height));
    if (width > max_extent || height > max_extent || width * height > max_texels)
        return fail(
            fmt::format("the header says {} x {} pixels, more than this program holds ({} in total, {} per side)",
                        width, height, max_texels, max_extent));
    if (most_texels_per_byte > 0 && width * height > file_size * most_texels_per_byte)
        return fail(
            fmt::format("the header says {} x {} pixels, but the file has only {} bytes", width, height, file_size));
    return {};
}

Result<scene::PixelData> read_image(const std::string& path, scene::Encoding encoding, float gamma,
                                    std::string* warning) {
    RESTAGE_TRY(DecodedImage decoded, decode_image_file(path));
    if (warning) *warning = decoded.warning.empty() ? "" : path + ": " + decoded.warning;
    try {
        return linear_image(std::move(decoded), encoding, gamma);
    } catch (const std::bad_alloc&) {
        return fail(path, Error{out_of_memory});
    }
}

Result<scene::PixelData> read_image_header(const std::string& path) {
    RESTAGE_TRY(const DecodedImage decoded, decode_image_file(path, true));
    return scene::PixelData{
        .width = decoded.width, .height = decoded.height, .channels = decoded.channels == 2 ? 4 : decoded.channels};
}

Result<> write_image(const std::string& path, const scene::PixelData& image) {
    auto extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension == ".png") return write_png(path, image);
    if (extension == ".jpg" || extension == ".jpeg") return write_jpg(path, image);
    if (extension == ".pfm") return write_pfm(path, image);
    if (extension == ".hdr") return write_hdr(path, image);
    if (extension == ".exr") {
        static const std::vector<std::string> names[] = {{"Y"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
        if (image.channels != 1 && image.channels != 3 && image.channels != 4)
            return fail(fmt::format("{}: cannot write {} channels, only 1, 3 or 4", path, image.channels));
        ExrImage exr{.width = image.width, .height = image.height};
        exr.layers.push_back({.channels = names[image.channels == 1 ? 0 : image.channels - 2], .values = image.values});
        return write_exr(path, exr);
    }
    return fail(path + ": unknown image format '" + extension + "'; known: .exr .hdr .jpg .pfm .png");
}

} // namespace restage::io
