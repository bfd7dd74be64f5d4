// SPDX-License-Identifier: Apache-2.0
// What an importer's report says that a file leaves to choose: its scenes, its variants (docs/plugins.md).
#pragma once

#include "io/report.hpp"

#include <string>
#include <vector>

namespace restage::io {

struct Choices {
    std::string option; // of the importer, a text: "scene"
    std::vector<std::string> values; // "Kitchen", "Bath"
};
std::vector<Choices> choices_of(const Report&);

} // namespace restage::io
