// SPDX-License-Identifier: Apache-2.0
#include "io/image_handover.hpp"

#include "base/file.hpp"
#include "io/image_file_codecs.hpp"

#include <array>
#include <cstring>
#include <type_traits>

namespace restage::io {

namespace {

constexpr std::array<char, 8> magic{'p', 'i', 'x', 'e', 'l', 's', ' ', '1'};

struct Header {
    std::array<char, 8> magic{};
    std::uint32_t width = 0, height = 0, channels = 0, bits = 0;
};

} // namespace

Result<std::uint64_t> hand_over_image(const std::string& path, const std::filesystem::path& to, std::string* warning) {
    RESTAGE_TRY(const DecodedImage image, decode_image_file(path));
    if (warning) *warning = image.warning;
    RESTAGE_TRY(AtomicFile file, AtomicFile::create(to));
    return std::visit(
        [&](const auto& values) -> Result<std::uint64_t> {
            const Header header{magic, image.width, image.height, image.channels, 8 * sizeof values[0]};
            const std::uint64_t size = values.size() * sizeof values[0];
            RESTAGE_CHECK(file.write({reinterpret_cast<const char*>(&header), sizeof header}));
            RESTAGE_CHECK(file.write({reinterpret_cast<const char*>(values.data()), size}));
            RESTAGE_CHECK(file.commit());
            return size;
        },
        image.values);
}

Result<scene::PixelData> take_over_image(const std::filesystem::path& from, scene::Encoding encoding, float gamma) {
    RESTAGE_TRY(const std::string bytes, read_file(from));
    Header header;
    const auto broken = [&] { return fail(from.string() + ": the decoded pixels handed over are damaged"); };
    if (bytes.size() < sizeof header) return broken();
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::string_view rest = std::string_view(bytes).substr(sizeof header);
    if (header.magic != magic || header.channels < 1 || header.channels > 4 ||
        !check_image_size(header.width, header.height, rest.size()) ||
        rest.size() != std::uint64_t{header.width} * header.height * header.channels * (header.bits / 8))
        return broken();
    DecodedImage image{.width = header.width, .height = header.height, .channels = header.channels};
    const auto fill = [&](auto values) {
        values.resize(rest.size() / sizeof values[0]);
        std::memcpy(values.data(), rest.data(), rest.size());
        image.values = std::move(values);
    };
    if (header.bits == 8)
        fill(std::vector<std::uint8_t>());
    else if (header.bits == 16)
        fill(std::vector<std::uint16_t>());
    else if (header.bits == 32)
        fill(std::vector<float>());
    else
        return broken();
    return linear_image(std::move(image), encoding, gamma);
}

} // namespace restage::io
