// SPDX-License-Identifier: Apache-2.0
// Image files in and out: PNG, JPG, WebP, BMP, TGA, HDR, EXR, PFM. Pixels read are linear, row 0 on top.
// Layered EXR files: exr.hpp. Comparing pictures: image_compare.hpp.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <string>

namespace restage::io {

// Reads any of the formats, detected by content (TGA by name). `encoding` and `gamma` give the meaning of 8-
// and 16-bit values; float files and alpha are always linear. Grey with alpha becomes RGBA. NaN becomes 0, infinity
// the largest half (65504); `warning`, if not null, receives a sentence about that, or "". [any]
// "wood.tga: truncated: ..." for files that misstate their size or end early.
Result<scene::PixelData> read_image(const std::string& path, scene::Encoding encoding, float gamma = 2.2f,
                                    std::string* warning = nullptr);

// Width, height and channels without decoding; data stays empty.
Result<scene::PixelData> read_image_header(const std::string& path);

// 8-bit sRGB of the linear picture times 2^exposure, clamped to [0,1]. 1, 3 or 4 channels; alpha is not exposed.
Result<> write_png(const std::string& path, const scene::PixelData&, float exposure = 0);
// Likewise as JPEG of quality 95; alpha is dropped.
Result<> write_jpg(const std::string& path, const scene::PixelData&, float exposure = 0);
// Float, little-endian; 1 or 3 channels (of 4, alpha is dropped).
Result<> write_pfm(const std::string& path, const scene::PixelData&);
// Radiance RGBE; 1 or 3 channels (of 4, alpha is dropped); negative values become 0.
Result<> write_hdr(const std::string& path, const scene::PixelData&);
// By the extension: .png .jpg .pfm .hdr .exr (float). Others are refused, listing these.
Result<> write_image(const std::string& path, const scene::PixelData&);

// The transfer functions of IEC 61966-2-1, exact and piecewise; encoding clamps to [0,1].
float srgb_to_linear(float encoded);
float linear_to_srgb(float linear);

} // namespace restage::io
