// SPDX-License-Identifier: Apache-2.0
// Services for plugins that io/ implements: plugin/ is below and knows their ids only.
#pragma once

#include "plugin/registry.hpp"

#include <utility>

namespace restage::io {

// "restage.image/1"
std::span<const plugin::HostService> services();

// The options of a registry whose plugins may ask for them, as every program's may.
inline plugin::RegistryOptions with_services(plugin::RegistryOptions options = {}) {
    options.services = services();
    return options;
}

} // namespace restage::io
