// SPDX-License-Identifier: Apache-2.0
// Reading EXR: all layers of a render (read_exr), or the one picture needed by a texture (decode_exr).

#include "base/file.hpp"
#include "io/exr.hpp"
#include "io/exr_stream.hpp"
#include "io/image_file_codecs.hpp"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <memory>

namespace restage::io {

namespace {

constexpr std::uint64_t max_values = 1ull << 31; // 8 GiB in memory

struct Window {
    std::uint32_t width = 0, height = 0;
    Imath::Box2i box;
};

// Maximum texels per byte of a complete file: one channel of 16 bits, deflate's 1032:1, RLE's 128:2.
// PIZ and DWA shrink a single-colour block to nothing, however wide; each block of at most 32 or 256 rows has 8
// bytes in the offset table.
std::uint64_t most_texels_per_byte(Imf::Compression compression, std::int64_t width) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
            return 1;
        case Imf::RLE_COMPRESSION:
            return 64;
        case Imf::ZIP_COMPRESSION:
        case Imf::ZIPS_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 1032;
        default:
            return 256 * static_cast<std::uint64_t>(std::max<std::int64_t>(width, 1)) / 8;
    }
}

Result<Window> data_window(const Imf::Header& header, std::size_t file_size) {
    const Imath::Box2i& box = header.dataWindow();
    const auto width = std::int64_t{box.max.x} - box.min.x + 1, height = std::int64_t{box.max.y} - box.min.y + 1;
    RESTAGE_CHECK(check_image_size(static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)),
                                   static_cast<std::uint64_t>(std::max<std::int64_t>(height, 0)), file_size,
                                   most_texels_per_byte(header.compression(), width)));
    return Window{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), box};
}

// R G B A and X Y Z in the usual order, whatever the file's (alphabetical) one; others follow in file order.
int channel_rank(const std::string& name) {
    static constexpr std::string_view usual[] = {"R", "G", "B", "A", "X", "Y", "Z"};
    const auto* found = std::find(std::begin(usual), std::end(usual), name);
    return static_cast<int>(found - std::begin(usual));
}

std::pair<std::string, std::string> split_name(const std::string& full) {
    const auto dot = full.rfind('.');
    if (dot == std::string::npos) return {"", full};
    return {full.substr(0, dot), full.substr(dot + 1)};
}

std::string full_name(const ExrLayer& layer, const std::string& channel) {
    return layer.name.empty() ? channel : layer.name + "." + channel;
}

ExrType type_of(Imf::PixelType type) {
    return type == Imf::HALF ? ExrType::half : type == Imf::UINT ? ExrType::uint32 : ExrType::float32;
}

// Names and types of the layers, without their values.
Result<std::vector<ExrLayer>> list_layers(const Imf::ChannelList& channels) {
    std::vector<ExrLayer> layers;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            return fail(fmt::format("channel '{}' is subsampled, which is not supported", it.name()));
        const auto [layer_name, channel] = split_name(it.name());
        auto layer = std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.name == layer_name; });
        const ExrType type = type_of(it.channel().type);
        if (layer == layers.end()) {
            layers.push_back({.name = layer_name, .channels = {channel}, .type = type});
            continue;
        }
        layer->channels.push_back(channel);
        if (layer->type != type) layer->type = ExrType::float32;
    }
    for (auto& layer : layers)
        std::stable_sort(layer.channels.begin(), layer.channels.end(),
                         [](const auto& a, const auto& b) { return channel_rank(a) < channel_rank(b); });
    return layers;
}

Result<> read_values(Imf::InputPart& part, const Window& window, std::vector<ExrLayer>& layers) {
    std::uint64_t total = 0;
    for (const auto& layer : layers)
        total += std::uint64_t{window.width} * window.height * layer.channels.size();
    if (total > max_values)
        return fail(fmt::format("{} values in all channels, more than this program holds ({})", total, max_values));
    Imf::FrameBuffer buffer;
    for (auto& layer : layers) {
        const std::size_t count = layer.channels.size();
        const std::size_t size = std::size_t{window.width} * window.height * count;
        const bool integral = layer.type == ExrType::uint32;
        if (integral)
            layer.integers.resize(size);
        else
            layer.values.resize(size);
        static_assert(sizeof(float) == sizeof(std::uint32_t));
        for (std::size_t i = 0; i < count; ++i) {
            void* first = integral ? static_cast<void*>(&layer.integers[i]) : static_cast<void*>(&layer.values[i]);
            buffer.insert(full_name(layer, layer.channels[i]),
                          Imf::Slice::Make(integral ? Imf::UINT : Imf::FLOAT, first, window.box, 4 * count,
                                           4 * count * window.width));
        }
    }
    part.setFrameBuffer(buffer);
    part.readPixels(window.box.min.y, window.box.max.y);
    return {};
}

std::map<std::string, std::string> read_metadata(const Imf::Header& header) {
    static constexpr std::string_view required[] = {"name", "type",       "pixelAspectRatio", "screenWindowWidth",
                                                    "view", "chunkCount", "version",          "maxSamplesPerPixel"};
    std::map<std::string, std::string> metadata;
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string name = it.name();
        if (std::find(std::begin(required), std::end(required), name) != std::end(required)) continue;
        const Imf::Attribute* attribute = &it.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(attribute))
            metadata[name] = text->value();
        else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(attribute))
            metadata[name] = fmt::format("{}", real->value());
        else if (const auto* wide = dynamic_cast<const Imf::DoubleAttribute*>(attribute))
            metadata[name] = fmt::format("{}", wide->value());
        else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(attribute))
            metadata[name] = fmt::format("{}", whole->value());
    }
    return metadata;
}

// OpenEXR throws; exceptions end here.
template <class F>
auto guarded(F&& f) -> decltype(f()) {
    try {
        return f();
    } catch (const std::exception& error) {
        return fail("EXR", Error{error.what()});
    }
}

// The layer a texture is read from: plain colour or luminance first, then the first with colour, then a lone channel.
Result<std::size_t> choose_layer(const std::vector<ExrLayer>& layers) {
    const auto has = [](const ExrLayer& layer, const char* name) {
        return std::find(layer.channels.begin(), layer.channels.end(), name) != layer.channels.end();
    };
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i].name.empty() && (has(layers[i], "R") || has(layers[i], "Y"))) return i;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (has(layers[i], "R")) return i;
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i].channels.size() == 1) return i;
    std::string all;
    for (const auto& layer : layers)
        for (const auto& channel : layer.channels)
            all += (all.empty() ? "" : ", ") + full_name(layer, channel);
    return fail("EXR: none of the channels is a colour (R, G, B or Y): " + all);
}

// The layer's channels that make up the picture, in order; -1 = zeros.
std::vector<int> choose_channels(const ExrLayer& layer) {
    const auto index = [&](const char* name) {
        const auto found = std::find(layer.channels.begin(), layer.channels.end(), name);
        return found == layer.channels.end() ? -1 : static_cast<int>(found - layer.channels.begin());
    };
    std::vector<int> chosen;
    if (index("G") >= 0 || index("B") >= 0)
        chosen = {index("R"), index("G"), index("B")};
    else
        chosen = {index("R") >= 0 ? index("R") : index("Y") >= 0 ? index("Y") : 0};
    if (index("A") >= 0 && index("A") != chosen[0]) chosen.push_back(index("A"));
    return chosen;
}

// Luminance with subsampled chroma: OpenEXR's own conversion to RGBA.
Result<DecodedImage> decode_luminance_chroma(std::string_view bytes, bool header_only) {
    ExrMemoryInput stream(bytes);
    Imf::RgbaInputFile file(stream);
    RESTAGE_TRY(const Window window, data_window(file.header(), bytes.size()));
    DecodedImage image{.width = window.width, .height = window.height, .channels = 3};
    if (header_only) return image;
    std::vector<Imf::Rgba> pixels(std::size_t{window.width} * window.height);
    const auto origin = std::int64_t{window.box.min.x} + std::int64_t{window.box.min.y} * window.width;
    file.setFrameBuffer(pixels.data() - origin, 1, window.width);
    file.readPixels(window.box.min.y, window.box.max.y);
    std::vector<float> values;
    values.reserve(pixels.size() * 3);
    for (const auto& p : pixels)
        values.insert(values.end(), {p.r, p.g, p.b});
    image.values = std::move(values);
    return image;
}

Result<DecodedImage> decode(std::string_view bytes, bool header_only) {
    RESTAGE_CHECK(check_exr_header(bytes));
    ExrMemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream);
    const Imf::Header& header = file.header(0);
    if (header.hasType() && Imf::isDeepData(header.type())) return fail("EXR: deep data is not supported");
    if (header.channels().findChannel("RY") && header.channels().findChannel("BY"))
        return decode_luminance_chroma(bytes, header_only);
    RESTAGE_TRY(const Window window, data_window(header, bytes.size()));
    RESTAGE_TRY(std::vector<ExrLayer> layers, list_layers(header.channels()));
    RESTAGE_TRY(const std::size_t index, choose_layer(layers));
    layers = {layers[index]};
    ExrLayer& layer = layers.front();
    layer.type = ExrType::float32;
    const std::vector<int> chosen = choose_channels(layer);
    DecodedImage image{
        .width = window.width, .height = window.height, .channels = static_cast<std::uint32_t>(chosen.size())};
    if (header_only) return image;
    Imf::InputPart part(file, 0);
    RESTAGE_CHECK(read_values(part, window, layers));
    const std::size_t stride = layer.channels.size(), count = std::size_t{window.width} * window.height;
    std::vector<float> values(count * chosen.size());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < chosen.size(); ++c)
            if (chosen[c] >= 0)
                values[i * chosen.size() + c] = layer.values[i * stride + static_cast<std::size_t>(chosen[c])];
    image.values = std::move(values);
    return image;
}

Result<ExrImage> read_layers(std::string_view bytes) {
    if (!is_exr(bytes)) return fail("not an EXR file");
    RESTAGE_CHECK(check_exr_header(bytes));
    ExrMemoryInput stream(bytes);
    Imf::MultiPartInputFile file(stream);
    const Imf::Header& header = file.header(0);
    if (header.hasType() && Imf::isDeepData(header.type())) return fail("EXR: deep data is not supported");
    RESTAGE_TRY(const Window window, data_window(header, bytes.size()));
    ExrImage image{.width = window.width, .height = window.height};
    RESTAGE_TRY(image.layers, list_layers(header.channels()));
    Imf::InputPart part(file, 0);
    RESTAGE_CHECK(read_values(part, window, image.layers));
    image.metadata = read_metadata(header);
    return image;
}

} // namespace

bool is_exr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

Result<DecodedImage> decode_exr(std::string_view bytes, bool header_only) {
    return guarded([&] { return decode(bytes, header_only); });
}

const ExrLayer* ExrImage::find(std::string_view layer) const {
    const auto found = std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.name == layer; });
    return found == layers.end() ? nullptr : &*found;
}

Result<ExrImage> read_exr(const std::string& path) {
    RESTAGE_TRY(const std::string bytes, read_file(path));
    auto image = guarded([&] { return read_layers(bytes); });
    if (!image) return fail(path, image.error());
    return image;
}

} // namespace restage::io
