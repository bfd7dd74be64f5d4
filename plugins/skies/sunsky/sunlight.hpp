// SPDX-License-Identifier: Apache-2.0
// The sun's disk as seen through the atmosphere, per wavelength.
#pragma once

#include <array>

namespace restage::sunsky {

using Color = std::array<double, 3>; // XYZ or linear sRGB

inline constexpr double sun_radius = 0.00465; // of the disk [rad], mean over the year
inline constexpr double least_turbidity = 2, most_turbidity = 10;

Color rgb_from_xyz(const Color&); // IEC 61966-2-1; out-of-gamut components are 0

// Mean radiance of the disk in luminance units [cd/m^2]: Y is what a luminance meter would show. `elevation` [rad], at
// least 0.
Color sun_xyz(double elevation, double turbidity);
Color sun_xyz_above_atmosphere();
// Illuminance of a level surface by scattered light [lx]. `elevation` [rad], at least 0.
double sky_illuminance(double elevation, double turbidity);

} // namespace restage::sunsky
