// SPDX-License-Identifier: Apache-2.0
// Colour temperature: the colour of a black body, as printed on lamps, and back.
#pragma once

#include <glm/glm.hpp>

namespace restage::scene {

inline constexpr double least_kelvin = 1667, most_kelvin = 25000;

// Linear sRGB, the largest channel 1, channels outside the gamut 0. Kim et al., US patent 7024034 (2002): cubic splines
// of the Planckian locus in CIE xy, within 1667..25000 K; other temperatures are clamped.
glm::dvec3 blackbody_color(double kelvin);

// Correlated colour temperature of a linear sRGB colour: McCamy, "Correlated color temperature as an explicit function
// of chromaticity coordinates", 1992. 0 if undefined (black, or far from any black body).
double color_temperature(const glm::dvec3& rgb);

} // namespace restage::scene
