// SPDX-License-Identifier: Apache-2.0
#include "common/textures.hpp"

#include <cstddef>

namespace restage::importing {

RestageHandle add_image_file(const RestageSceneWriter1& out, const std::string& path, RestageEncoding encoding) {
    const RestageImage image = {.name = "",
                                .path = path.c_str(),
                                .encoding = static_cast<std::uint32_t>(encoding),
                                .gamma = 2.2f,
                                .width = 0,
                                .height = 0,
                                .channels = 0,
                                .pixels = nullptr};
    return out.image(out.ctx, &image);
}

RestageHandle add_pixels(const RestageSceneWriter1& out, const std::string& name, std::uint32_t width,
                         std::uint32_t height, std::uint32_t channels,
                         const std::function<double(std::size_t, unsigned)>& value) {
    std::vector<float> pixels;
    const std::size_t count = std::size_t{width} * height;
    pixels.reserve(count * channels);
    for (std::size_t i = 0; i < count; ++i)
        for (unsigned c = 0; c < channels; ++c)
            pixels.push_back(static_cast<float>(value(i, c)));
    const RestageImage image = {.name = name.c_str(),
                                .path = "",
                                .encoding = RESTAGE_LINEAR,
                                .gamma = 1,
                                .width = width,
                                .height = height,
                                .channels = channels,
                                .pixels = pixels.data()};
    return out.image(out.ctx, &image);
}

RestageHandle add_imagemap(const RestageSceneWriter1& out, const std::string& name, RestageHandle image, bool is_float,
                           const Mapping& mapping, double factor, bool invert) {
    Values values;
    if (mapping.scale_u != 1) values.number("uscale", mapping.scale_u);
    if (mapping.scale_v != 1) values.number("vscale", mapping.scale_v);
    if (mapping.offset_u != 0) values.number("udelta", mapping.offset_u);
    if (mapping.offset_v != 0) values.number("vdelta", mapping.offset_v);
    if (mapping.shear_u != 0) values.number("ushear", mapping.shear_u);
    if (mapping.shear_v != 0) values.number("vshear", mapping.shear_v);
    if (mapping.set != 0) values.integer("uvset", mapping.set);
    if (std::string_view(mapping.wrap) != "repeat") values.choice("wrap", mapping.wrap);
    if (factor != 1) values.number("scale", factor);
    if (invert) values.boolean("invert", true);
    const RestageTexture texture = {.name = name.c_str(),
                                    .type = "imagemap",
                                    .is_float = is_float,
                                    .image = image,
                                    .values = values.data(),
                                    .value_count = values.size()};
    return image ? out.texture(out.ctx, &texture) : 0;
}

RestageHandle add_product(const RestageSceneWriter1& out, const std::string& name, RestageHandle a, RestageHandle b,
                          bool is_float) {
    if (!a || !b) return a ? a : b;
    const RestageType type = is_float ? RESTAGE_FLOAT : RESTAGE_COLOR;
    Values values;
    values.texture("tex", type, a);
    values.texture("scale", type, b);
    const RestageTexture product = {.name = name.c_str(),
                                    .type = "scale",
                                    .is_float = is_float,
                                    .image = 0,
                                    .values = values.data(),
                                    .value_count = values.size()};
    return out.texture(out.ctx, &product);
}

RestageHandle add_scaled(const RestageSceneWriter1& out, const std::string& name, RestageHandle texture, bool is_float,
                         const Rgb& factor) {
    if (!texture || factor == Rgb{1, 1, 1}) return texture;
    Values values;
    values.texture("tex", RESTAGE_COLOR, texture);
    values.color("scale", factor);
    const RestageTexture scaled = {.name = name.c_str(),
                                   .type = "scale",
                                   .is_float = is_float,
                                   .image = 0,
                                   .values = values.data(),
                                   .value_count = values.size()};
    return out.texture(out.ctx, &scaled);
}

} // namespace restage::importing
