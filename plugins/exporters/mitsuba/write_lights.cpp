// SPDX-License-Identifier: Apache-2.0
// Lights without a surface, and the environment.
#include "exporter.hpp"

#include <cmath>

namespace restage::mitsuba_out {

namespace {

Color color_of(const float (&c)[3]) { return {c[0], c[1], c[2]}; }

// A rotation whose z is the matrix's, at its origin.
Matrix looking_along_z(const double m[16]) {
    const double length = std::sqrt(m[8] * m[8] + m[9] * m[9] + m[10] * m[10]);
    const std::array<double, 3> z{m[8] / length, m[9] / length, m[10] / length};
    const std::size_t least = std::abs(z[0]) < std::abs(z[1]) ? (std::abs(z[0]) < std::abs(z[2]) ? 0 : 2)
                                                              : (std::abs(z[1]) < std::abs(z[2]) ? 1 : 2);
    std::array<double, 3> x{}, y{};
    x[least] = 1;
    for (std::size_t k = 0; k < 3; ++k) // y = z cross x
        y[k] = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
    const double size = std::sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    for (double& c : y)
        c /= size;
    for (std::size_t k = 0; k < 3; ++k)
        x[k] = y[(k + 1) % 3] * z[(k + 2) % 3] - y[(k + 2) % 3] * z[(k + 1) % 3];
    return {x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, z[0], z[1], z[2], 0, m[12], m[13], m[14], 1};
}

} // namespace

void Exporter::light(RestageHandle handle) {
    RestageLight light{};
    if (!in_.light(in_.ctx, handle, &light)) return;
    const std::string what = std::string("light \"") + light.name + "\"";
    if (light.flags & RESTAGE_LIGHT_HIDDEN) return dropped(what, "it is switched off, and left out");
    report_kept(*light.origin, what);
    const double* m = light.light_to_world;
    const std::string id = unique_id("light", light.name);
    if (light.kind == RESTAGE_LIGHT_POINT) {
        lights_.open("emitter", "point", id);
        lights_.point("position", {m[12], m[13], m[14]});
        lights_.rgb("intensity", color_of(light.value));
    } else if (light.kind == RESTAGE_LIGHT_SPOT) {
        if (light.cone_delta > 0)
            approximated(what, "Mitsuba's spots fade in proportion to the angle between the edges, ours smoothly");
        lights_.open("emitter", "spot", id);
        lights_.matrix("to_world", looking_along_z(m));
        lights_.rgb("intensity", color_of(light.value));
        lights_.put("cutoff_angle", light.cone_angle);
        // A fade of no width would divide by zero there.
        lights_.put("beam_width", std::min(light.cone_angle - light.cone_delta, light.cone_angle * 0.9999f));
    } else {
        const double length = std::sqrt(m[8] * m[8] + m[9] * m[9] + m[10] * m[10]);
        lights_.open("emitter", "directional", id);
        lights_.point("direction", {m[8] / length, m[9] / length, m[10] / length}, "vector");
        lights_.rgb("irradiance", color_of(light.value));
    }
    lights_.close();
}

// Ours (pbrt-v3): z up, u = phi / 2 pi from +x. Mitsuba: y up, u from -z over +x.
void Exporter::environment() {
    RestageEnvironment e{};
    if (!in_.environment(in_.ctx, &e)) return;
    const std::string what = std::string("environment \"") + e.name + "\"";
    report_kept(*e.origin, what);
    if (e.hidden_from_camera)
        approximated(what, "Mitsuba hides all lights from the camera or none: it is visible there");
    if (e.sky && *e.sky)
        approximated(what, std::string("Mitsuba has no sky \"") + e.sky + "\" of these values: its picture is written");
    const Color scale = color_of(e.scale);
    const std::string id = unique_id("environment", e.name);
    RestageImage image{};
    if (!e.image || !in_.image(in_.ctx, e.image, &image) || !image.pixels || image.width == 0) {
        if (e.image) dropped(what, "its picture cannot be read; a constant is written");
        lights_.open("emitter", "constant", id);
        lights_.rgb("radiance", scale);
        lights_.close();
        return;
    }
    const bool grey = scale[0] == scale[1] && scale[1] == scale[2];
    std::string file;
    std::error_code code;
    const bool readable = *image.path && std::filesystem::exists(image.path, code) && image.encoding != RESTAGE_GAMMA &&
                          std::string_view(image.path).find('$') == std::string_view::npos;
    const std::string ending = std::filesystem::path(image.path).extension().string();
    const bool floats = ending == ".exr" || ending == ".hdr" || ending == ".pfm";
    if (e.mapping == RESTAGE_EQUIRECT && grey && readable && floats) {
        file = places_.of(image.path);
    } else {
        OwnPicture own{image.width, image.height, {}};
        if (e.mapping == RESTAGE_OCTAHEDRAL) {
            own = resampled(image, false, 2);
            approximated(what, "its picture was resampled from the octahedral to the equirectangular mapping");
        } else {
            for (std::size_t p = 0; p < std::size_t{image.width} * image.height; ++p)
                for (std::size_t c = 0; c < 3; ++c)
                    own.pixels.push_back(image.pixels[p * image.channels + (image.channels >= 3 ? c : 0)]);
        }
        for (std::size_t k = 0; k < own.pixels.size() && !grey; ++k)
            own.pixels[k] *= scale[k % 3];
        RestageImage made = image;
        made.width = own.width;
        made.height = own.height;
        made.channels = 3;
        made.pixels = own.pixels.data();
        file = places_.of_pixels(made);
    }
    static constexpr double from_mitsuba[16] = {0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, 0, 1}; // (x y z) -> (-z x y)
    lights_.open("emitter", "envmap", id);
    lights_.put("filename", std::string_view(file));
    if (grey && scale[0] != 1) lights_.put("scale", scale[0]);
    lights_.matrix("to_world", multiply(e.light_to_world, from_mitsuba));
    lights_.close();
}

} // namespace restage::mitsuba_out
