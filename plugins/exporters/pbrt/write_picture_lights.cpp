// SPDX-License-Identifier: Apache-2.0
// Goniometric and projection lights, rendered as point and spot lights here. The file's own text is kept
// in a line "=whole COLOUR LightSource ...", and written in the syntax of either version.
//
// Goniometric (pbrt-v3 12.3.3, v4 12.2.3): both versions swap y and z, so that y is up, and look the direction up in
// the mapping of their environments; v4's is of one channel, the mean of the picture's. Projection (v3 12.3.2, v4
// 12.2.2): v3 shows the picture's top row at -y, v4 at +y; fov is of the shorter side, 45 degrees or 90 when not given.
#include "exporter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::pbrt_out {

struct Exporter::PictureLight {
    const RestageLight& light;
    std::string what;
    bool is_v3; // the file was
    Params given;
    bool as_given; // its colour can be written as it was
    RestageHandle handle; // its picture's, 0 = not among the scene's
    RestageImage image;

    bool has_file() const { return given.has("filename") || given.has("mapname"); }
    double number(const char* name, double otherwise) const {
        const std::string text = given.value(name);
        std::string_view rest = text;
        return read_number(rest).value_or(otherwise);
    }
    double fov() const { return number("fov", is_v3 ? 45 : 90); }
    std::array<float, 3> value(double factor) const {
        std::array<float, 3> out{};
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<float>(static_cast<double>(light.value[c]) * factor);
        return out;
    }
    double texel(std::uint32_t x, std::uint32_t y, std::uint32_t channel) const {
        const std::size_t at = (std::size_t{y} * image.width + x) * image.channels;
        return static_cast<double>(image.pixels[at + (image.channels < 3 ? 0 : channel)]);
    }
    template <class F>
    double mean(const F& f) const { // of f(x, y) over the texels
        double sum = 0;
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x)
                sum += f(x, y);
        return sum / (double(image.width) * image.height);
    }
};

namespace {

bool is_grey(const std::array<float, 3>& c) { return c[0] == c[1] && c[1] == c[2]; }

} // namespace

RestageHandle Exporter::picture_named(const std::string& file) {
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_IMAGE); ++h) {
        RestageImage image{};
        if (!in_.image(in_.ctx, h, &image)) continue;
        Params as_written; // the importer's stand-in for a missing file
        for (const std::string& line : lines(image.origin->verbatim))
            as_written.add_raw(line);
        if (image.path == file || as_written.string("filename") == file) return h;
    }
    return 0;
}

bool Exporter::picture_light(const RestageLight& light, const std::string& what, std::string& type, Params& params) {
    std::string_view rest;
    for (std::uint32_t i = 0; i < light.origin->value_count; ++i)
        if (const auto& value = RESTAGE_AT(RestageOriginValue, light.origin->values, i); value.id == whole_light)
            rest = value.text;
    if (rest.empty()) return false;
    bool is_edited = false;
    for (const float x : light.value) {
        const auto kept = read_number(rest);
        is_edited = is_edited || !kept || static_cast<float>(*kept) != x;
    }
    const KeptLine line = split_directive(rest);
    if (line.name != "goniometric" && line.name != "projection") return false;
    PictureLight p{light, what, std::string_view(light.origin->format) == "pbrt-v3", {}, false, 0, {}};
    p.given.add_raw(line.rest);
    for (const char* placed : {"from", "to"}) // are already in the transform
        p.given.remove(placed);
    Params colour = p.given, others = p.given;
    for (const char* name : {"mapname", "filename", "fov"}) {
        colour.remove(name);
        others.remove(name);
    }
    for (const char* name : {"I", "scale", "power"})
        others.remove(name);
    p.as_given = p.is_v3 == v3() && !is_edited && colour.stands_alone();
    const std::string file = p.given.string(p.given.has("filename") ? "filename" : "mapname");
    if (p.has_file()) p.handle = picture_named(file);
    if (p.handle) in_.image(in_.ctx, p.handle, &p.image);
    if (p.image.width == 0 || p.image.height == 0) p.image.pixels = nullptr;
    if (p.is_v3 == v3()) {
        params = p.given;
        if (p.handle) // possibly relinked; or missing, which is reported
            params.map_strings([&](const std::string& name) { return name == file ? image_file(p.handle) : name; });
    } else if (p.has_file() && !p.image.pixels) {
        dropped(what, "its picture is missing, and cannot be written for " + std::string(format()) +
                          "; a light without a picture is used instead");
        return false;
    } else if (!others.empty()) {
        dropped(what, "parameters unknown to either version: " + others.text());
    }
    type = line.name;
    if (type == "goniometric")
        goniometric(p, type, params);
    else
        projection(p, params);
    return true;
}

void Exporter::goniometric(PictureLight& p, std::string& type, Params& params) {
    const auto grey = [&p](std::uint32_t x, std::uint32_t y) {
        return (p.texel(x, y, 0) + p.texel(x, y, 1) + p.texel(x, y, 2)) / 3;
    };
    if (!p.as_given) {
        for (const char* name : {"I", "scale", "power"})
            params.remove(name);
        double factor = 1; // light.value is a uniform distribution's of this power
        if (p.number("power", -1) > 0 && p.image.pixels)
            if (const double mean = p.mean(grey); mean > 0) factor = 1 / mean;
        params.add_rgb("I", p.value(factor));
    }
    if (p.is_v3 == v3()) return;
    if (!p.has_file()) {
        type = "point";
        return;
    }
    constexpr std::uint32_t least_side = 128; // v4 does not interpolate
    OwnPicture picture = resampled(p.image, !v3(), least_side);
    for (std::size_t i = 0; i < picture.pixels.size() && v3(); i += 3) {
        float* c = &picture.pixels[i];
        c[0] = c[1] = c[2] = (c[0] + c[1] + c[2]) / 3;
    }
    bool coloured = false;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3)
        coloured = coloured || !is_grey({picture.pixels[i], picture.pixels[i + 1], picture.pixels[i + 2]});
    params.add_string(v3() ? "mapname" : "filename", own_picture(picture, p.light.name));
    approximated(p.what, std::string("its distribution was resampled to ") +
                             (v3() ? "pbrt-v3's equirectangular" : "pbrt-v4's octahedral") + " mapping");
    if (coloured) approximated(p.what, "pbrt-v4's distributions are grey: the mean of its colours is read");
}

void Exporter::projection(PictureLight& p, Params& params) {
    std::array<float, 3> tint{1, 1, 1}; // which the picture itself must contain
    if (!p.as_given) {
        for (const char* name : {"I", "scale", "power"})
            params.remove(name);
        double factor = 1;
        if (p.number("power", -1) > 0 && p.image.pixels) {
            // light.value is of a spot of this power. ProjectionLight::Create: power of value 1 on a screen of area A
            const double half = p.fov() * std::numbers::pi / 360, opposite = std::tan(half);
            const double width = p.image.width, height = p.image.height, shorter = std::min(width, height);
            const double area = 4 * opposite * opposite * std::max(width, height) / shorter;
            const double power = area * p.mean([&](std::uint32_t x, std::uint32_t y) {
                const double sx = (2 * (x + 0.5) - width) / shorter * opposite,
                             sy = (2 * (y + 0.5) - height) / shorter * opposite;
                const double cosine = 1 / std::sqrt(1 + sx * sx + sy * sy);
                const double luminance =
                    0.212639 * p.texel(x, y, 0) + 0.715169 * p.texel(x, y, 1) + 0.072192 * p.texel(x, y, 2);
                return luminance * cosine * cosine * cosine;
            });
            if (power > 0) factor = 2 * std::numbers::pi * (1 - std::cos(half)) / power;
        }
        const auto value = p.value(factor);
        if (v3())
            params.add_rgb("I", value);
        else if (is_grey(value))
            params.add_float("scale", value[0]);
        else
            tint = value; // v4 has no "I"
    }
    const bool is_white = is_grey(tint);
    if (p.is_v3 == v3() && is_white) return;
    const char* name = v3() ? "mapname" : "filename";
    params.remove("fov");
    params.add_float("fov", p.fov());
    OwnPicture picture{1, 1, {tint[0], tint[1], tint[2]}};
    if (p.image.pixels) {
        picture = {p.image.width, p.image.height, {}};
        for (std::uint32_t y = 0; y < picture.height; ++y)
            for (std::uint32_t x = 0; x < picture.width; ++x)
                for (std::uint32_t c = 0; c < 3; ++c)
                    picture.pixels.push_back(static_cast<float>(
                        p.texel(x, p.is_v3 == v3() ? y : picture.height - 1 - y, c) * static_cast<double>(tint[c])));
    } else if (p.has_file()) { // v4, coloured now, and missing
        approximated(p.what,
                     "pbrt-v4 takes colours from the projected picture only, which is missing: its colour is lost");
        return;
    } else if (v3()) {
        return; // a uniform one
    }
    params.remove(name);
    params.add_string(name, own_picture(picture, p.light.name));
}

} // namespace restage::pbrt_out
