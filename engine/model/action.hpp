// SPDX-License-Identifier: Apache-2.0
// Action and Panel: declarations of plugins that read a scene and return edits.
#pragma once

#include "model/param.hpp"

#include <string>
#include <vector>

namespace restage::model {

struct Action {
    std::string id; // "scatter"; unique over all plugins
    std::string label, tooltip; // as in a menu; the label also names the undo step
    std::vector<Param> params;
    bool needs_selection = false; // at least one selected object

    const Param* find(std::string_view id_) const { return find_param(params, id_); }
    bool operator==(const Action&) const = default;
};

struct Panel {
    std::string id; // "scatter"; unique over all plugins
    std::string label; // of its tab
    std::vector<Param> params; // of its widgets; not document state

    const Param* find(std::string_view id_) const { return find_param(params, id_); }
    bool operator==(const Panel&) const = default;
};

} // namespace restage::model
