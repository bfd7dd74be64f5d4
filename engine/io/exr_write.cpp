// SPDX-License-Identifier: Apache-2.0
// Writing EXR: one part, scan lines, all layers; linear sRGB primaries, as implied by a file without
// chromaticities.

#include "base/file.hpp"
#include "io/exr.hpp"
#include "io/exr_stream.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>
#include <algorithm>
#include <set>

namespace restage::io {

namespace {

Imf::PixelType pixel_type(ExrType type) {
    return type == ExrType::half ? Imf::HALF : type == ExrType::uint32 ? Imf::UINT : Imf::FLOAT;
}

Imf::Compression compression_of(ExrCompression compression) {
    switch (compression) {
        case ExrCompression::none:
            return Imf::NO_COMPRESSION;
        case ExrCompression::zip:
            return Imf::ZIP_COMPRESSION;
        case ExrCompression::piz:
            return Imf::PIZ_COMPRESSION;
    }
    return Imf::ZIP_COMPRESSION;
}

std::string full_name(const ExrLayer& layer, const std::string& channel) {
    return layer.name.empty() ? channel : layer.name + "." + channel;
}

Result<> check(const ExrImage& image) {
    if (image.width == 0 || image.height == 0 || image.layers.empty()) return fail("the picture has no pixels");
    std::set<std::string> names;
    for (const auto& layer : image.layers) {
        const std::size_t wanted = std::size_t{image.width} * image.height * layer.channels.size();
        const std::size_t found = layer.type == ExrType::uint32 ? layer.integers.size() : layer.values.size();
        if (found != wanted || layer.channels.empty())
            return fail(fmt::format("layer '{}' has {} values instead of {}", layer.name, found, wanted));
        for (const auto& channel : layer.channels)
            if (channel.empty() || !names.insert(full_name(layer, channel)).second)
                return fail(fmt::format("channel '{}' is a duplicate or unnamed", full_name(layer, channel)));
    }
    return {};
}

std::string encode(const ExrImage& image, ExrCompression compression) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = compression_of(compression);
    for (const auto& [name, text] : image.metadata)
        header.insert(name, Imf::StringAttribute(text));

    Imf::FrameBuffer buffer;
    std::vector<std::vector<half>> halves(image.layers.size()); // alive until the pixels are written
    for (std::size_t l = 0; l < image.layers.size(); ++l) {
        const ExrLayer& layer = image.layers[l];
        const Imf::PixelType type = pixel_type(layer.type);
        const std::size_t bytes = type == Imf::HALF ? 2 : 4;
        const char* first = reinterpret_cast<const char*>(layer.values.data());
        if (type == Imf::UINT) first = reinterpret_cast<const char*>(layer.integers.data());
        if (type == Imf::HALF) {
            halves[l].resize(layer.values.size());
            std::transform(layer.values.begin(), layer.values.end(), halves[l].begin(),
                           [](float v) { return half(std::clamp(v, -65504.f, 65504.f)); });
            first = reinterpret_cast<const char*>(halves[l].data());
        }
        const std::size_t stride = bytes * layer.channels.size();
        for (std::size_t c = 0; c < layer.channels.size(); ++c) {
            const std::string name = full_name(layer, layer.channels[c]);
            header.channels().insert(name, Imf::Channel(type));
            buffer.insert(name, Imf::Slice(type, const_cast<char*>(first + c * bytes), stride, stride * image.width));
        }
    }
    ExrMemoryOutput stream;
    { // the file is complete when it is closed
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(buffer);
        file.writePixels(static_cast<int>(image.height));
    }
    return stream.bytes();
}

} // namespace

Result<> write_exr(const std::string& path, const ExrImage& image, ExrCompression compression) {
    if (auto ok = check(image); !ok) return fail(path, ok.error());
    try {
        return write_file_atomic(path, encode(image, compression));
    } catch (const std::exception& error) { // OpenEXR's: an attribute name it reserves, for example
        return fail(path + ": EXR", Error{error.what()});
    }
}

} // namespace restage::io
