// SPDX-License-Identifier: Apache-2.0
// Sky: the declaration of a sky plugin: parameters from which it generates an environment image.
#pragma once

#include "model/param.hpp"

#include <string>
#include <vector>

namespace restage::model {

struct Sky {
    std::string type; // "sunsky"; unique over all plugins
    std::string label, tooltip;
    std::vector<Param> params;

    const Param* find(std::string_view id) const { return find_param(params, id); }
    bool operator==(const Sky&) const = default;
};

} // namespace restage::model
