// SPDX-License-Identifier: Apache-2.0
// Radiance HDR (RGBE): reading. Both run-length codings and plain texels; EXPOSURE lines are ignored, as in pbrt.
// (stb_image's reader loops forever on truncated files.) G. Ward, "Real Pixels", Graphics Gems II, 1991.

#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace restage::io {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

struct Reader {
    std::string_view bytes;
    std::size_t at = 0;

    std::optional<std::uint8_t> byte() {
        if (at >= bytes.size()) return std::nullopt;
        return static_cast<std::uint8_t>(bytes[at++]);
    }
    std::optional<Rgbe> rgbe() {
        if (bytes.size() - at < 4) return std::nullopt;
        Rgbe value;
        for (auto& v : value)
            v = static_cast<std::uint8_t>(bytes[at++]);
        return value;
    }
    std::optional<std::string_view> line() {
        const auto end = bytes.find('\n', at);
        if (end == std::string_view::npos) return std::nullopt;
        auto text = bytes.substr(at, end - at);
        at = end + 1;
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }
};

struct Resolution {
    std::uint32_t width = 0, height = 0;
    bool bottom_up = false, right_to_left = false;
};

// "-Y 512 +X 1024": rows from the top, texels from the left.
std::optional<Resolution> parse_resolution(std::string_view line) {
    Resolution result;
    const auto take = [&](char axis, std::uint32_t& value, bool& reversed, char reversed_sign) {
        if (line.size() < 4 || (line[0] != '+' && line[0] != '-') || line[1] != axis || line[2] != ' ') return false;
        reversed = line[0] == reversed_sign;
        const auto [end, error] = std::from_chars(line.data() + 3, line.data() + line.size(), value);
        if (error != std::errc{}) return false;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        while (line.starts_with(' '))
            line.remove_prefix(1);
        return true;
    };
    if (!take('Y', result.height, result.bottom_up, '+') || !take('X', result.width, result.right_to_left, '-'))
        return std::nullopt;
    return line.empty() ? std::optional(result) : std::nullopt;
}

enum class RowStatus { good, truncated, corrupt };

// A row whose components are run-length coded separately.
RowStatus read_component_row(Reader& in, std::vector<Rgbe>& row) {
    for (std::size_t component = 0; component < 4; ++component)
        for (std::size_t x = 0; x < row.size();) {
            const auto code = in.byte();
            if (!code) return RowStatus::truncated;
            const bool run = *code > 128;
            const std::size_t count = run ? *code - 128u : *code;
            if (count == 0 || count > row.size() - x) return RowStatus::corrupt;
            std::optional<std::uint8_t> value;
            for (std::size_t i = 0; i < count; ++i) {
                if (!run || i == 0) value = in.byte();
                if (!value) return RowStatus::truncated;
                row[x++][component] = *value;
            }
        }
    return RowStatus::good;
}

// Plain texels; (1,1,1,n) repeats the last one, n << 8 k times if it is the k-th consecutive one.
RowStatus read_plain_row(Reader& in, std::vector<Rgbe>& row) {
    unsigned shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        const auto texel = in.rgbe();
        if (!texel) return RowStatus::truncated;
        const bool repeat = (*texel)[0] == 1 && (*texel)[1] == 1 && (*texel)[2] == 1;
        if (!repeat) {
            row[x++] = *texel;
            shift = 0;
            continue;
        }
        const std::size_t count = shift > 16 ? row.size() : std::size_t{(*texel)[3]} << shift;
        if (x == 0 || count > row.size() - x) return RowStatus::corrupt;
        std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
        x += count;
        shift += 8;
    }
    return RowStatus::good;
}

RowStatus read_row(Reader& in, std::vector<Rgbe>& row) {
    const auto start = in.rgbe();
    if (!start) return RowStatus::truncated;
    const bool by_component =
        row.size() >= 8 && row.size() < 32768 && (*start)[0] == 2 && (*start)[1] == 2 && (*start)[2] < 128;
    if (!by_component) {
        in.at -= 4;
        return read_plain_row(in, row);
    }
    if (((*start)[2] << 8 | (*start)[3]) != static_cast<int>(row.size())) return RowStatus::corrupt;
    return read_component_row(in, row);
}

Result<Resolution> read_header(Reader& in) {
    for (auto line = in.line(); line; line = in.line()) {
        if (line->starts_with("FORMAT=") && *line != "FORMAT=32-bit_rle_rgbe")
            return fail(
                fmt::format("HDR header: only FORMAT=32-bit_rle_rgbe is supported, not '{}'", line->substr(0, 80)));
        if (!line->empty()) continue;
        const auto resolution_line = in.line();
        if (!resolution_line) break;
        const auto resolution = parse_resolution(*resolution_line);
        if (!resolution)
            return fail(
                fmt::format("HDR header: '-Y height +X width' expected, not '{}'", resolution_line->substr(0, 80)));
        return *resolution;
    }
    return fail("truncated: the file ends inside the HDR header");
}

} // namespace

bool is_hdr(std::string_view bytes) { return bytes.starts_with("#?RADIANCE") || bytes.starts_with("#?RGBE"); }

Result<DecodedImage> decode_hdr(std::string_view bytes, bool header_only) {
    Reader in{bytes};
    RESTAGE_TRY(const Resolution size, read_header(in));
    // A row takes at least eight bytes: a texel and a run of it.
    RESTAGE_CHECK(check_image_size(size.width, size.height, bytes.size(), 1 + size.width / 8));
    DecodedImage image{.width = size.width, .height = size.height, .channels = 3};
    if (header_only) return image;

    std::vector<float> values(std::size_t{size.width} * size.height * 3);
    std::vector<Rgbe> row(size.width);
    for (std::uint32_t y = 0; y < size.height; ++y) {
        const RowStatus status = read_row(in, row);
        if (status == RowStatus::truncated)
            return fail(fmt::format("truncated: the file ends in row {} of {}", y, size.height));
        if (status == RowStatus::corrupt)
            return fail(
                fmt::format("row {} is broken: its runs do not add up to {} texels (byte {})", y, size.width, in.at));
        const std::size_t target = size.bottom_up ? size.height - 1 - y : y;
        for (std::size_t x = 0; x < size.width; ++x) {
            const Rgbe& texel = row[size.right_to_left ? size.width - 1 - x : x];
            const float scale = texel[3] ? std::ldexp(1.f, texel[3] - (128 + 8)) : 0.f;
            for (std::size_t c = 0; c < 3; ++c)
                values[(target * size.width + x) * 3 + c] = static_cast<float>(texel[c]) * scale;
        }
    }
    image.values = std::move(values);
    return image;
}

} // namespace restage::io
