// SPDX-License-Identifier: Apache-2.0
// JPEG through libjpeg(-turbo): baseline, progressive, arithmetic; grey, YCbCr, RGB, CMYK and YCCK. The EXIF
// orientation is not applied: texture coordinates are those of the stored rows.

#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <csetjmp>
#include <cstdio> // jpeglib.h needs FILE
#include <cstdlib>

#include <jerror.h>
#include <jpeglib.h>

namespace restage::io {

namespace {

constexpr int most_scans = 500; // of a progressive picture: a small file could otherwise demand days of work

// libjpeg's error handlers must not return: the only way out is longjmp, over C frames.
struct Errors {
    jpeg_error_mgr manager{}; // first: libjpeg gives us a pointer to it
    std::jmp_buf back{};
    char message[JMSG_LENGTH_MAX]{};
    bool truncated = false;
};

[[noreturn]] void give_up(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<Errors*>(jpeg->err);
    jpeg->err->format_message(jpeg, errors->message);
    std::longjmp(errors->back, 1);
}

// Warnings (level -1) mean damaged data: the picture is shown as in other viewers, and the first one is reported. A
// truncated file is an error.
void note(j_common_ptr jpeg, int level) {
    if (level >= 0) return;
    auto* errors = reinterpret_cast<Errors*>(jpeg->err);
    errors->truncated = jpeg->err->msg_code == JWRN_JPEG_EOF;
    if (errors->truncated) give_up(jpeg);
    if (errors->manager.num_warnings++ == 0) jpeg->err->format_message(jpeg, errors->message);
}

void silent(j_common_ptr) {}

void count_scans(j_common_ptr jpeg) {
    if (!jpeg->is_decompressor || reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans) return;
    ERREXIT(jpeg, JERR_BAD_PROGRESSION);
}

struct Decoder {
    Errors errors;
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};

    Decoder() {
        jpeg.err = jpeg_std_error(&errors.manager);
        errors.manager.error_exit = give_up;
        errors.manager.emit_message = note;
        errors.manager.output_message = silent;
        progress.progress_monitor = count_scans;
    }
    ~Decoder() { jpeg_destroy_decompress(&jpeg); } // safe even if never created: it is zeroed
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    // Each returns false if libjpeg gave up. They contain no objects with destructors, because of longjmp.
    bool read_header(std::string_view bytes) {
        if (setjmp(errors.back)) return false; // NOLINT(cert-err52-cpp): libjpeg's only way
        jpeg_create_decompress(&jpeg);
        jpeg.progress = &progress;
        jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
                     static_cast<unsigned long>(bytes.size()));
        jpeg_read_header(&jpeg, TRUE);
        jpeg.out_color_space = jpeg.num_components == 1 ? JCS_GRAYSCALE : jpeg.num_components == 4 ? JCS_CMYK : JCS_RGB;
        return true;
    }
    // Memory grows as rows arrive: a truncated file gets little.
    bool read_rows(std::vector<std::uint8_t>& to) {
        if (setjmp(errors.back)) return false; // NOLINT(cert-err52-cpp)
        jpeg_start_decompress(&jpeg);
        const std::size_t stride = std::size_t{jpeg.output_width} * static_cast<unsigned>(jpeg.output_components);
        const std::size_t whole = stride * jpeg.output_height;
        while (jpeg.output_scanline < jpeg.output_height) {
            const std::size_t at = stride * jpeg.output_scanline;
            if (to.size() < at + stride) to.resize(std::min(whole, std::max(2 * to.size(), 64 * stride)));
            JSAMPROW row = to.data() + at;
            jpeg_read_scanlines(&jpeg, &row, 1);
        }
        jpeg_finish_decompress(&jpeg);
        return true;
    }
    tl::unexpected<Error> problem(std::size_t size) const {
        if (errors.truncated) return fail(fmt::format("truncated: the file ends inside the picture ({} bytes)", size));
        return fail(fmt::format("the picture is broken: JPEG: {}", errors.message));
    }
};

// Adobe's files hold the inks inverted (its technical note 5116): 255 is no ink. Without profiles the colour is the
// light that passes all inks.
std::vector<std::uint8_t> cmyk_to_rgb(const std::vector<std::uint8_t>& cmyk, bool inverted) {
    std::vector<std::uint8_t> rgb(cmyk.size() / 4 * 3);
    const auto light = [&](std::uint8_t ink) { return inverted ? ink : 255u - ink; };
    for (std::size_t i = 0; i < cmyk.size() / 4; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = static_cast<std::uint8_t>((light(cmyk[4 * i + c]) * light(cmyk[4 * i + 3]) + 127) / 255);
    return rgb;
}

} // namespace

bool is_jpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8"); }

Result<DecodedImage> decode_jpeg(std::string_view bytes, bool header_only) {
    Decoder decoder;
    if (!decoder.read_header(bytes)) return decoder.problem(bytes.size());
    const jpeg_decompress_struct& jpeg = decoder.jpeg;
    // A block of 64 takes at least a bit in Huffman coding, in a plain picture under 1/100 of it in arithmetic coding.
    constexpr std::uint64_t most_texels_per_byte = 8 * 64 * 64;
    RESTAGE_CHECK(check_image_size(jpeg.image_width, jpeg.image_height, bytes.size(), most_texels_per_byte));
    if (jpeg.num_components != 1 && jpeg.num_components != 3 && jpeg.num_components != 4)
        return fail(fmt::format("JPEG pictures of {} components are not read", jpeg.num_components));
    const bool cmyk = jpeg.num_components == 4;
    DecodedImage image{.width = jpeg.image_width, .height = jpeg.image_height, .channels = cmyk ? 3u : 0u};
    if (!cmyk) image.channels = static_cast<std::uint32_t>(jpeg.num_components);
    if (header_only) return image;
    std::vector<std::uint8_t> values;
    if (!decoder.read_rows(values)) return decoder.problem(bytes.size());
    if (decoder.errors.manager.num_warnings > 0)
        image.warning = fmt::format("JPEG: {}; the part decoded so far is shown", decoder.errors.message);
    image.values = cmyk ? cmyk_to_rgb(values, jpeg.saw_Adobe_marker != 0) : std::move(values);
    return image;
}

namespace {

struct Encoder {
    Errors errors;
    jpeg_compress_struct jpeg{};
    unsigned char* bytes = nullptr; // libjpeg's, from malloc
    unsigned long size = 0;

    Encoder() {
        jpeg.err = jpeg_std_error(&errors.manager);
        errors.manager.error_exit = give_up;
        errors.manager.emit_message = note;
        errors.manager.output_message = silent;
    }
    Encoder(const Encoder&) = delete;
    ~Encoder() {
        jpeg_destroy_compress(&jpeg);
        std::free(bytes);
    }
    // No objects with destructors here: see give_up.
    bool write(std::uint32_t width, std::uint32_t height, int channels, int quality, const std::uint8_t* values) {
        if (setjmp(errors.back)) return false;
        jpeg_create_compress(&jpeg);
        jpeg_mem_dest(&jpeg, &bytes, &size);
        jpeg.image_width = width;
        jpeg.image_height = height;
        jpeg.input_components = channels;
        jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
        jpeg_set_defaults(&jpeg);
        jpeg_set_quality(&jpeg, quality, TRUE);
        for (int c = 0; c < jpeg.num_components; ++c) // no chroma subsampling
            jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
        jpeg_start_compress(&jpeg, TRUE);
        while (jpeg.next_scanline < height) {
            const std::size_t row = std::size_t{jpeg.next_scanline} * width * static_cast<std::size_t>(channels);
            JSAMPROW from = const_cast<std::uint8_t*>(values + row); // read only
            jpeg_write_scanlines(&jpeg, &from, 1);
        }
        jpeg_finish_compress(&jpeg);
        return true;
    }
};

} // namespace

Result<std::string> encode_jpeg(std::uint32_t width, std::uint32_t height, int channels, int quality,
                                const std::vector<std::uint8_t>& values) {
    Encoder encoder;
    if (!encoder.write(width, height, channels, quality, values.data()))
        return fail(fmt::format("JPEG: {}", encoder.errors.message));
    return std::string(reinterpret_cast<const char*>(encoder.bytes), encoder.size);
}

} // namespace restage::io
