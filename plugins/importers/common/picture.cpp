// SPDX-License-Identifier: Apache-2.0
#include "common/picture.hpp"

#include "common/file.hpp"

#include <cmath>
#include <memory>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 16384
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace restage::importing {

namespace {
constexpr std::size_t most_pixels = std::size_t{1} << 27;
}

bool Picture::alpha_varies() const {
    if (!has_alpha()) return false;
    for (std::size_t i = channels - 1; i < texels.size(); i += channels)
        if (texels[i] != 255) return true;
    return false;
}

double Picture::value(std::size_t pixel, unsigned channel) const {
    if (channel == 3 && !has_alpha()) return 1;
    const unsigned stored = channels >= 3 ? channel : channel == 3 ? 1 : 0;
    return texels[pixel * channels + stored] / 255.0;
}

std::optional<Picture> decode_picture(std::string_view bytes, std::string& reason) {
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (bytes.size() > 0x7fffffff || !stbi_info_from_memory(data, size, &width, &height, &channels)) {
        reason = "it is no picture of a known format (PNG, JPEG, TGA, BMP)";
        return std::nullopt;
    }
    // A compressed pixel takes a thousandth of a byte at least: what promises more than it can hold is not believed.
    if (width <= 0 || height <= 0 || std::size_t(width) * std::size_t(height) > most_pixels ||
        std::size_t(width) * std::size_t(height) > bytes.size() * 4096) {
        reason = "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be in " +
                 std::to_string(bytes.size()) + " bytes";
        return std::nullopt;
    }
    const std::unique_ptr<stbi_uc, decltype(&std::free)> texels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 0), &std::free);
    if (!texels || channels < 1 || channels > 4) {
        reason = std::string("the picture is damaged: ") + (stbi_failure_reason() ? stbi_failure_reason() : "?");
        return std::nullopt;
    }
    Picture picture{static_cast<std::uint32_t>(width),
                    static_cast<std::uint32_t>(height),
                    static_cast<std::uint32_t>(channels),
                    {}};
    picture.texels.assign(texels.get(), texels.get() + std::size_t{picture.width} * picture.height * picture.channels);
    return picture;
}

std::optional<Picture> read_picture(const std::string& path, std::string& reason) {
    const auto bytes = read_file(path, reason);
    return bytes ? decode_picture(*bytes, reason) : std::nullopt;
}

double srgb_to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

Rgb average_color(const Picture& picture, bool srgb) {
    Rgb sum{};
    const std::size_t count = std::size_t{picture.width} * picture.height;
    for (std::size_t i = 0; i < count; ++i)
        for (unsigned c = 0; c < 3; ++c)
            sum[c] += srgb ? srgb_to_linear(picture.value(i, c)) : picture.value(i, c);
    for (double& x : sum)
        x /= static_cast<double>(count ? count : 1);
    return sum;
}

} // namespace restage::importing
