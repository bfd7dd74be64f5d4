// SPDX-License-Identifier: Apache-2.0
// Plugin services that io/ implements: plugin/, a lower layer, knows only their ids.
#pragma once

#include "plugin/registry.hpp"

#include <utility>

namespace restage::io {

// "restage.image/1"
std::span<const plugin::HostService> services();

// Options for a registry that offers these services to its plugins, as every program does.
inline plugin::RegistryOptions with_services(plugin::RegistryOptions options = {}) {
    options.services = services();
    return options;
}

} // namespace restage::io
