// SPDX-License-Identifier: Apache-2.0
// BMP and TGA through stb_image, compiled with nothing else; PNG and HDR are written through stb_image_write.
// stb fills missing bytes with zeros in some formats; reading through callbacks shows when it ran past the end.

#include "base/file.hpp"
#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

// Static, so that it cannot clash with the copy in another library.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS (1 << 30) // check_image_size gives a better message
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_image.h>
#include <stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace restage::io {

namespace {

struct Source {
    std::string_view bytes;
    std::size_t at = 0;
    bool overrun = false; // a read past the end was requested
};

constexpr int refill_size = sizeof(stbi__context::buffer_start);

int source_read(void* user, char* data, int size) {
    auto& source = *static_cast<Source*>(user);
    const std::size_t wanted = static_cast<std::size_t>(std::max(size, 0));
    const std::size_t count = std::min(source.bytes.size() - source.at, wanted);
    // A refill reads ahead: a short read is harmless, an empty one is not.
    if (count < wanted && (count == 0 || size != refill_size)) source.overrun = true;
    std::memcpy(data, source.bytes.data() + source.at, count);
    if (size == refill_size) std::memset(data + count, 0, wanted - count); // stb does not always check the count
    source.at += count;
    return static_cast<int>(count);
}

void source_skip(void* user, int distance) {
    auto& source = *static_cast<Source*>(user);
    const auto target = static_cast<std::int64_t>(source.at) + distance;
    if (target < 0 || target > static_cast<std::int64_t>(source.bytes.size())) source.overrun = true;
    const auto end = static_cast<std::int64_t>(source.bytes.size());
    source.at = static_cast<std::size_t>(std::clamp<std::int64_t>(target, 0, end));
}

int source_eof(void* user) {
    const auto& source = *static_cast<Source*>(user);
    return source.at >= source.bytes.size();
}

constexpr stbi_io_callbacks callbacks{source_read, source_skip, source_eof};

struct FreeStb {
    void operator()(void* p) const { stbi_image_free(p); }
};

Error reason() {
    const char* why = stbi_failure_reason();
    return {why ? why : "unknown"};
}

// Loads with one of stb's loaders; T is the type of its numbers.
template <class T, class Load>
Result<DecodedImage> load(std::string_view bytes, Load&& loader) {
    Source source{bytes};
    int width = 0, height = 0, channels = 0;
    std::unique_ptr<T, FreeStb> pixels{loader(&callbacks, &source, &width, &height, &channels, 0)};
    if (source.overrun)
        return fail(fmt::format("truncated: the file ends inside the picture ({} bytes)", bytes.size()));
    if (!pixels) return fail("the picture is broken", reason());
    DecodedImage image{.width = static_cast<std::uint32_t>(width),
                       .height = static_cast<std::uint32_t>(height),
                       .channels = static_cast<std::uint32_t>(channels)};
    const std::size_t count = std::size_t{image.width} * image.height * image.channels;
    image.values = std::vector<T>(pixels.get(), pixels.get() + count);
    return image;
}

void append(void* string, void* data, int size) {
    static_cast<std::string*>(string)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

Result<> check_channels(const std::string& path, const scene::PixelData& image) {
    if (image.channels != 1 && image.channels != 3 && image.channels != 4)
        return fail(fmt::format("{}: cannot write {} channels, only 1, 3 or 4", path, image.channels));
    if (image.width == 0 || image.height == 0) return fail(path + ": the picture has no pixels");
    return {};
}

} // namespace

Result<DecodedImage> decode_stb(std::string_view bytes, bool header_only) {
    Source source{bytes};
    DecodedImage image;
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels))
        return fail(
            "not a picture this program can read (PNG, JPG, WebP, BMP, TGA, HDR, EXR, PFM), or its header is broken",
            reason());
    image.width = static_cast<std::uint32_t>(std::max(width, 0));
    image.height = static_cast<std::uint32_t>(std::max(height, 0));
    image.channels = static_cast<std::uint32_t>(channels);
    // The shortest run of a TGA is two bytes for 128 texels.
    RESTAGE_CHECK(check_image_size(image.width, image.height, bytes.size(), 64));
    if (header_only) return image;
    return load<stbi_uc>(bytes, stbi_load_from_callbacks);
}

namespace {

std::vector<std::uint8_t> encode_srgb(const scene::PixelData& image, float exposure) {
    const float factor = std::exp2(exposure);
    std::vector<std::uint8_t> encoded(image.values.size());
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        const bool alpha = image.channels == 4 && i % 4 == 3;
        const float v = image.values[i];
        const float value = alpha ? (v > 0 ? std::min(v, 1.f) : 0.f) : linear_to_srgb(v * factor);
        encoded[i] = static_cast<std::uint8_t>(std::lround(value * 255));
    }
    return encoded;
}

} // namespace

Result<> write_jpg(const std::string& path, const scene::PixelData& image, float exposure) {
    RESTAGE_CHECK(check_channels(path, image));
    std::vector<std::uint8_t> encoded = encode_srgb(image, exposure);
    if (image.channels == 4) { // without alpha
        for (std::size_t i = 0; i < encoded.size() / 4; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                encoded[3 * i + c] = encoded[4 * i + c];
        encoded.resize(encoded.size() / 4 * 3);
    }
    auto bytes = encode_jpeg(image.width, image.height, image.channels == 1 ? 1 : 3, 95, encoded);
    if (!bytes) return fail(path, bytes.error());
    return write_file_atomic(path, *bytes);
}

Result<> write_png(const std::string& path, const scene::PixelData& image, float exposure) {
    RESTAGE_CHECK(check_channels(path, image));
    const std::vector<std::uint8_t> encoded = encode_srgb(image, exposure);
    std::string bytes;
    const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
    const int channels = static_cast<int>(image.channels);
    if (!stbi_write_png_to_func(append, &bytes, width, height, channels, encoded.data(), width * channels))
        return fail(path + ": the PNG could not be encoded (out of memory?)");
    return write_file_atomic(path, bytes);
}

Result<> write_hdr(const std::string& path, const scene::PixelData& image) {
    RESTAGE_CHECK(check_channels(path, image));
    std::vector<float> positive(image.values.size()); // RGBE has no sign
    std::transform(image.values.begin(), image.values.end(), positive.begin(), [](float v) { return v > 0 ? v : 0.f; });
    std::string bytes;
    if (!stbi_write_hdr_to_func(append, &bytes, static_cast<int>(image.width), static_cast<int>(image.height),
                                static_cast<int>(image.channels), positive.data()))
        return fail(path + ": the HDR could not be encoded (out of memory?)");
    return write_file_atomic(path, bytes);
}

} // namespace restage::io
