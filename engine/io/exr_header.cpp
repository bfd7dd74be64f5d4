// SPDX-License-Identifier: Apache-2.0
// The headers of an EXR file, checked before OpenEXR allocates what they claim. OpenEXR uses an attribute's
// stated size only if its type has no fixed size, so the two must agree: else it would lose its place.

#include "io/image_file_codecs.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <optional>

namespace restage::io {

namespace {

constexpr std::uint32_t multi_part_flag = 0x1000;
constexpr std::uint64_t largest_manifest = 64u << 20; // inflated [bytes]

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | (at + i < bytes.size() ? static_cast<std::uint8_t>(bytes[at + i]) : 0u);
    return value;
}

// The size of a value of this type, if fixed.
std::optional<std::uint32_t> fixed_size(std::string_view type) {
    static constexpr std::pair<std::string_view, std::uint32_t> sizes[] = {{"box2i", 16},
                                                                           {"box2f", 16},
                                                                           {"chromaticities", 32},
                                                                           {"compression", 1},
                                                                           {"deepImageState", 1},
                                                                           {"double", 8},
                                                                           {"envmap", 1},
                                                                           {"float", 4},
                                                                           {"int", 4},
                                                                           {"keycode", 28},
                                                                           {"lineOrder", 1},
                                                                           {"m33f", 36},
                                                                           {"m33d", 72},
                                                                           {"m44f", 64},
                                                                           {"m44d", 128},
                                                                           {"rational", 8},
                                                                           {"tiledesc", 9},
                                                                           {"timecode", 8},
                                                                           {"v2i", 8},
                                                                           {"v2f", 8},
                                                                           {"v2d", 16},
                                                                           {"v3i", 12},
                                                                           {"v3f", 12},
                                                                           {"v3d", 24}};
    const auto* found =
        std::find_if(std::begin(sizes), std::end(sizes), [&](const auto& s) { return s.first == type; });
    return found == std::end(sizes) ? std::nullopt : std::optional(found->second);
}

// Names, each with 16 bytes of description, up to an empty name.
bool is_channel_list(std::string_view value) {
    for (std::size_t at = 0;;) {
        const auto end = value.find('\0', at);
        if (end == value.npos) return false;
        if (end == at) return end + 1 == value.size();
        at = end + 17;
        if (at >= value.size()) return false;
    }
}

bool is_string_vector(std::string_view value) {
    std::uint64_t at = 0;
    while (at + 4 <= value.size())
        at += 4 + std::uint64_t{little_endian(value, at)};
    return at == value.size();
}

bool is_preview(std::string_view value) {
    if (value.size() < 8) return false;
    const std::uint64_t width = little_endian(value, 0), height = little_endian(value, 4);
    return width < 65536 && height < 65536 && value.size() == 8 + 4 * width * height;
}

bool has_own_size(std::string_view type, std::string_view value) {
    if (const auto size = fixed_size(type)) return value.size() == *size;
    if (type == "chlist") return is_channel_list(value);
    if (type == "stringvector") return is_string_vector(value);
    if (type == "preview") return is_preview(value);
    if (type == "floatvector") return value.size() % 4 == 0;
    if (type == "idmanifest") return value.size() >= 8 && little_endian(value, 4) <= largest_manifest;
    return true; // string, and types unknown to OpenEXR: the stated size counts
}

} // namespace

Result<> check_exr_header(std::string_view bytes) {
    const Error truncated{"EXR: truncated: the file ends inside its header"};
    if (bytes.size() < 8) return tl::unexpected(truncated);
    const bool several = (little_endian(bytes, 4) & multi_part_flag) != 0;
    for (std::size_t at = 8;;) {
        if (at >= bytes.size()) return tl::unexpected(truncated);
        if (bytes[at] == 0) { // the end of a header; an empty one ends the list of several
            ++at;
            if (!several || at >= bytes.size() || bytes[at] == 0) return {};
            continue;
        }
        const std::size_t name_end = bytes.find('\0', at);
        const std::size_t type_end = name_end == bytes.npos ? bytes.npos : bytes.find('\0', name_end + 1);
        if (type_end == bytes.npos || bytes.size() - type_end < 5) return tl::unexpected(truncated);
        const auto name = bytes.substr(at, std::min<std::size_t>(name_end - at, 64));
        const auto type = bytes.substr(name_end + 1, type_end - name_end - 1);
        const std::uint32_t size = little_endian(bytes, type_end + 1);
        if (size > bytes.size() - type_end - 5)
            return fail(fmt::format("EXR: attribute '{}' claims {} bytes, more than the file has", name, size));
        if (!has_own_size(type, bytes.substr(type_end + 5, size)))
            return fail(fmt::format("EXR: attribute '{}' of type {} is broken", name, type.substr(0, 64)));
        at = type_end + 5 + size;
    }
}

} // namespace restage::io
