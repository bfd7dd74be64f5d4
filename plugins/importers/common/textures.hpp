// SPDX-License-Identifier: Apache-2.0
// Images and textures in the scene's form: an imagemap over uv (v upwards), optionally times a colour.
#pragma once

#include "common/picture.hpp"

#include <restage/scene_io.h>
#include <functional>
#include <string>

namespace restage::importing {

struct Mapping { // st = uv * scale + vu * shear + offset
    double scale_u = 1, scale_v = 1, offset_u = 0, offset_v = 0;
    const char* wrap = "repeat"; // repeat | black | clamp
    double shear_u = 0, shear_v = 0; // v into s, u into t
    int set = 0; // of the mesh: 0 or 1
};

// An image file for the host to read. A missing one is kept in the scene and reported.
RestageHandle add_image_file(const RestageSceneWriter1&, const std::string& path, RestageEncoding);

// Pixels made here. value(pixel, channel) is linear; channels: 1 or 3.
RestageHandle add_pixels(const RestageSceneWriter1&, const std::string& name, std::uint32_t width, std::uint32_t height,
                         std::uint32_t channels, const std::function<double(std::size_t, unsigned)>& value);

RestageHandle add_imagemap(const RestageSceneWriter1&, const std::string& name, RestageHandle image, bool is_float,
                           const Mapping&, double factor = 1, bool invert = false);
// texture * texture.
RestageHandle add_product(const RestageSceneWriter1&, const std::string& name, RestageHandle, RestageHandle,
                          bool is_float);
// texture * factor; the texture itself if the factor is white.
RestageHandle add_scaled(const RestageSceneWriter1&, const std::string& name, RestageHandle texture, bool is_float,
                         const Rgb& factor);

} // namespace restage::importing
