// SPDX-License-Identifier: Apache-2.0
// PNG through libspng. Values stay as in the file: gAMA, sRGB, iCCP and cHRM chunks are not applied (the scene
// sets the encoding), 16 bits stay 16 bits, palettes and tRNS become colours and alpha.

#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <spng.h>
#include <memory>

namespace restage::io {

namespace {

struct FreeContext {
    void operator()(spng_ctx* p) const { spng_ctx_free(p); }
};

constexpr std::size_t most_chunk_bytes = std::size_t{64} << 20; // of a chunk that is not pixels: a profile, a text

tl::unexpected<Error> broken(int code, std::size_t size) {
    if (code == SPNG_IO_EOF) return fail(fmt::format("truncated: the file ends inside the picture ({} bytes)", size));
    return fail(fmt::format("the picture is broken: PNG: {}", spng_strerror(code)));
}

// The format requested from libspng, and the resulting channels.
struct Layout {
    int format = 0, flags = 0;
    std::uint32_t channels = 0;
};

Layout layout(const spng_ihdr& header, bool has_transparency) {
    const bool wide = header.bit_depth == 16;
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_GRAYSCALE:
            if (has_transparency) return {wide ? SPNG_FMT_GA16 : SPNG_FMT_GA8, SPNG_DECODE_TRNS, 2};
            return {wide ? SPNG_FMT_PNG : SPNG_FMT_G8, 0, 1};
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return {SPNG_FMT_PNG, 0, 2};
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return {SPNG_FMT_PNG, 0, 4};
        default: // colour, palette
            if (has_transparency) return {wide ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS, 4};
            return {wide ? SPNG_FMT_PNG : SPNG_FMT_RGB8, 0, 3};
    }
}

} // namespace

bool is_png(std::string_view bytes) { return bytes.starts_with("\x89PNG"); }

Result<DecodedImage> decode_png(std::string_view bytes, bool header_only) {
    const std::unique_ptr<spng_ctx, FreeContext> context(spng_ctx_new(0));
    if (!context) return fail("out of memory");
    spng_set_chunk_limits(context.get(), most_chunk_bytes, most_chunk_bytes);
    int code = spng_set_png_buffer(context.get(), bytes.data(), bytes.size());
    spng_ihdr header{};
    if (code == 0) code = spng_get_ihdr(context.get(), &header);
    if (header.width > 0 || code == 0) RESTAGE_CHECK(check_image_size(header.width, header.height, bytes.size()));
    if (code != 0) return broken(code, bytes.size());
    // Deflate expands one byte to at most 1032 (zlib's technical notes), so a complete picture of this size has at
    // least that many bytes: no valid file is refused, not even a 1-bit one of a single colour.
    constexpr std::uint32_t samples[] = {1, 0, 3, 1, 2, 0, 4};
    const std::uint64_t row = (std::uint64_t{header.width} * samples[header.color_type] * header.bit_depth + 7) / 8;
    if (row * header.height > 1032 * std::uint64_t{bytes.size()})
        return fail(fmt::format("truncated: the header says {} x {} pixels, but the file has only {} bytes",
                                header.width, header.height, bytes.size()));
    spng_trns transparency{};
    code = spng_get_trns(context.get(), &transparency); // reads all chunks before the pixels
    if (code != 0 && code != SPNG_ECHUNKAVAIL) return broken(code, bytes.size());
    const Layout wanted = layout(header, code == 0);
    DecodedImage image{.width = header.width, .height = header.height, .channels = wanted.channels};
    if (header_only) return image;

    const auto decode = [&](auto values) -> Result<DecodedImage> {
        std::size_t size = 0;
        if (const int e = spng_decoded_image_size(context.get(), wanted.format, &size)) return broken(e, bytes.size());
        values.resize(std::size_t{image.width} * image.height * image.channels);
        if (size != values.size() * sizeof values[0]) return fail("the picture is broken: PNG: inconsistent size");
        if (const int e = spng_decode_image(context.get(), values.data(), size, wanted.format, wanted.flags))
            return broken(e, bytes.size());
        // What follows the pixels is irrelevant, but a truncated file is reported.
        if (spng_decode_chunks(context.get()) == SPNG_IO_EOF) return broken(SPNG_IO_EOF, bytes.size());
        image.values = std::move(values);
        return std::move(image);
    };
    return header.bit_depth == 16 ? decode(std::vector<std::uint16_t>()) : decode(std::vector<std::uint8_t>());
}

} // namespace restage::io
