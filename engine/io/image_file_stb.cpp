// SPDX-License-Identifier: Apache-2.0
// PNG, JPG, BMP and TGA through stb_image; PNG and HDR back through stb_image_write.
// stb fills up missing bytes with zeros in some formats; reading through callbacks shows when it ran past the end.

#include "base/file.hpp"
#include "io/image_file.hpp"
#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

// Kept to this file (static), so that it cannot meet the copy in another library.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_GIF
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_PNM
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS (1 << 30) // check_image_size says it better
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
    bool overrun = false; // something behind the end was asked for
};

constexpr int refill_size = sizeof(stbi__context::buffer_start);

int source_read(void* user, char* data, int size) {
    auto& source = *static_cast<Source*>(user);
    const std::size_t wanted = static_cast<std::size_t>(std::max(size, 0));
    const std::size_t count = std::min(source.bytes.size() - source.at, wanted);
    // A refill reads ahead: coming back short means nothing, coming back empty does.
    if (count < wanted && (count == 0 || size != refill_size)) source.overrun = true;
    std::memcpy(data, source.bytes.data() + source.at, count);
    if (size == refill_size) std::memset(data + count, 0, wanted - count); // stb does not always look at the count
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
        return fail(fmt::format("truncated: the picture goes on where the file ends ({} bytes)", bytes.size()));
    if (!pixels) return fail("the picture is broken", reason());
    DecodedImage image{.width = static_cast<std::uint32_t>(width),
                       .height = static_cast<std::uint32_t>(height),
                       .channels = static_cast<std::uint32_t>(channels)};
    const std::size_t count = std::size_t{image.width} * image.height * image.channels;
    image.values = std::vector<T>(pixels.get(), pixels.get() + count);
    return image;
}

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

// Sizes of the picture, of which stb says only that this is no PNG, and of the chunks, which stb allocates unseen.
Result<> check_png_chunks(std::string_view bytes) {
    constexpr std::size_t signature = 8, frame = 12; // a chunk: length, name, data, checksum
    if (bytes.size() >= signature + 16)
        RESTAGE_CHECK(check_image_size(big_endian(bytes, 16), big_endian(bytes, 20), bytes.size()));
    for (std::size_t at = signature; at + frame <= bytes.size();) {
        const std::uint32_t length = big_endian(bytes, at);
        const std::string_view name = bytes.substr(at + 4, 4);
        if (length > bytes.size() - at - frame)
            return fail(
                fmt::format("truncated: a chunk claims {} bytes, more than the file has (byte {})", length, at));
        if (name == "IEND") break;
        at += frame + length;
    }
    return {};
}

// stb_image before 2.28 writes behind its Huffman tables when one claims more than 256 codes, and reads memory that was
// never written when a scan uses a table that was never defined. Walks over the markers as stb does and refuses both
// (ITU T.81, B.2.3 and B.2.4.2); whatever else is wrong, stb finds.
Result<> check_jpeg_tables(std::string_view bytes) {
    const auto byte = [&](std::size_t at) { return at < bytes.size() ? static_cast<std::uint8_t>(bytes[at]) : 0u; };
    constexpr std::uint32_t define_huffman = 0xc4, end_of_image = 0xd9, start_of_scan = 0xda;
    std::uint32_t defined = 0; // bit 4 * class + number: DC tables 0-3, AC tables 4-7
    for (std::size_t at = 2; at + 4 <= bytes.size();) {
        if (byte(at) != 0xff || byte(at + 1) == 0xff || byte(at + 1) == 0) { // fill, or data of a scan
            ++at;
            continue;
        }
        const std::uint32_t marker = byte(at + 1);
        if (marker == end_of_image) break;
        if (marker >= 0xd0 && marker <= 0xd7) { // restart: no length
            at += 2;
            continue;
        }
        const std::size_t length = byte(at + 2) << 8 | byte(at + 3), end = at + 2 + length;
        for (std::size_t table = at + 4; marker == define_huffman && table < end;) {
            std::size_t codes = 0;
            for (std::size_t i = 1; i <= 16; ++i)
                codes += byte(table + i);
            if (codes > 256) return fail(fmt::format("a Huffman table claims {} codes (byte {})", codes, table));
            defined |= 1u << ((byte(table) >> 4 & 1) * 4 + (byte(table) & 3));
            table += 17 + codes;
        }
        if (marker == start_of_scan) {
            const std::size_t components = byte(at + 4), spectrum = at + 5 + 2 * components;
            const bool uses_dc = byte(spectrum) == 0, uses_ac = byte(spectrum + 1) > 0;
            for (std::size_t i = 0; i < components; ++i) {
                const std::uint32_t tables = byte(at + 6 + 2 * i), dc = tables >> 4 & 3, ac = tables & 3;
                if ((uses_dc && !(defined >> dc & 1)) || (uses_ac && !(defined >> (4 + ac) & 1)))
                    return fail(fmt::format("a scan uses a Huffman table that is not defined (byte {})", at));
            }
        }
        at = std::max(end, at + 2);
    }
    return {};
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
    if (bytes.starts_with("\x89PNG")) RESTAGE_CHECK(check_png_chunks(bytes));
    if (bytes.starts_with("\xff\xd8")) RESTAGE_CHECK(check_jpeg_tables(bytes));
    Source source{bytes};
    DecodedImage image;
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels))
        return fail("not a picture this program can read (PNG, JPG, BMP, TGA, HDR, EXR, PFM), or its header is broken",
                    reason());
    image.width = static_cast<std::uint32_t>(std::max(width, 0));
    image.height = static_cast<std::uint32_t>(std::max(height, 0));
    image.channels = static_cast<std::uint32_t>(channels);
    RESTAGE_CHECK(check_image_size(image.width, image.height, bytes.size()));
    if (header_only) return image;

    source = {bytes};
    if (stbi_is_16_bit_from_callbacks(&callbacks, &source)) return load<stbi_us>(bytes, stbi_load_16_from_callbacks);
    return load<stbi_uc>(bytes, stbi_load_from_callbacks);
}

Result<> write_png(const std::string& path, const scene::PixelData& image, float exposure) {
    RESTAGE_CHECK(check_channels(path, image));
    const float factor = std::exp2(exposure);
    std::vector<std::uint8_t> encoded(image.values.size());
    for (std::size_t i = 0; i < encoded.size(); ++i) {
        const bool alpha = image.channels == 4 && i % 4 == 3;
        const float v = image.values[i];
        const float value = alpha ? (v > 0 ? std::min(v, 1.f) : 0.f) : linear_to_srgb(v * factor);
        encoded[i] = static_cast<std::uint8_t>(std::lround(value * 255));
    }
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
