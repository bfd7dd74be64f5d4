// SPDX-License-Identifier: Apache-2.0
// OpenEXR files with layers and metadata: the output of a render (beauty, standard error, guides, ids).
// A channel "albedo.R" is channel R of layer "albedo"; the layer of plain R, G, B is called "".
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace restage::io {

enum class ExrType { half, float32, uint32 };
enum class ExrCompression { none, zip, piz }; // all lossless; PIZ suits noise, ZIP flat guides and ids

struct ExrLayer {
    std::string name;                  // "", "stderr", "albedo", "normal", "depth", "id"
    std::vector<std::string> channels; // {"R","G","B"}; read in the usual order (R G B A, X Y Z), else as in the file
    ExrType type = ExrType::float32; // of all its channels; on reading, the widest of them (uint with others: float)
    std::vector<float> values; // width * height * channels, interleaved, row 0 on top; half and float32
    std::vector<std::uint32_t> integers; // likewise for uint32
    bool operator==(const ExrLayer&) const = default;
};

struct ExrImage {
    std::uint32_t width = 0, height = 0;
    std::vector<ExrLayer> layers;
    std::map<std::string, std::string> metadata; // string attributes, and numbers as text
    // The layer, or null.
    const ExrLayer* find(std::string_view layer) const;
    bool operator==(const ExrImage&) const = default;
};

// The data window of the first part (scan lines or tiles, level 0). Deep data and subsampled channels are refused.
Result<ExrImage> read_exr(const std::string& path);
Result<> write_exr(const std::string& path, const ExrImage&, ExrCompression = ExrCompression::zip);

} // namespace restage::io
