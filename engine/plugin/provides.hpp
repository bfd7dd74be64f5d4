// SPDX-License-Identifier: Apache-2.0
// What a plugin provides, as text for lists.
#pragma once

#include "plugin/registry.hpp"

#include <string>
#include <vector>

namespace restage::plugin {

// "material velvet", "importer gltf", "denoiser oidn (not available: ...)". [main]
std::vector<std::string> provides(const Registry&, const Entry&);

} // namespace restage::plugin
