// SPDX-License-Identifier: Apache-2.0
// pbrt's named media, for MakeNamedMedium "preset" and Material "subsurface" "name".
#pragma once

#include "spectrum.hpp"

#include <string_view>

namespace restage::pbrt {

struct MediumPreset { // per millimetre, taken per scene unit as in pbrt
    const char* name;
    Rgb scattering, absorption; // scattering is reduced: sigma_s (1 - g)
};

const MediumPreset* medium_preset(std::string_view name); // null = unknown
inline constexpr const char* default_medium = "Wholemilk";

} // namespace restage::pbrt
