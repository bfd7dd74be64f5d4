// SPDX-License-Identifier: Apache-2.0
// What importers, exporters and denoisers declare.
#pragma once

#include "model/param.hpp"

#include <string>
#include <vector>

namespace restage::model {

struct Importer {
    std::string format; // "pbrt"
    std::string label;  // "pbrt scene (v3, v4)"
    std::vector<std::string> extensions; // without dots
    std::vector<Param> options;
};

struct Exporter {
    std::string format, label;
    std::vector<std::string> extensions;
    std::vector<Param> options;
};

} // namespace restage::model
