// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <restage/scene_io.h>
#include <cstdint>
#include <string>
#include <vector>

namespace restage::exporters {

struct OwnPicture { // made by the export; RGB, row 0 is the top
    std::uint32_t width = 0, height = 0;
    std::vector<float> pixels;
};
// An environment's picture in the other mapping of all directions: from equirectangular (pbrt-v3's) to octahedral
// (pbrt-v4's), or back.
OwnPicture resampled(const RestageImage&, bool to_octahedral, std::uint32_t least_side);

std::string pfm_bytes(const RestageImage&); // rows from the bottom, little-endian; alpha is left out

} // namespace restage::exporters
