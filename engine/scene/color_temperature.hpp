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

// CIE xy of a light of that temperature: daylight from 5000 K (CIE 015:2018, 4.1.2), a black body up to 4000 K, a
// mixture of the two between, since they are 0.003 apart. `tint`: 3000 times its distance from that line in CIE 1960
// uv, as in DNG; above 0 greenish. Temperatures are clamped to 1667..25000 K.
glm::dvec2 illuminant(double kelvin, double tint);

inline constexpr double daylight_kelvin = 6504; // D65

// The matrix for linear sRGB under which white lit by illuminant(kelvin, tint) looks as it did lit by daylight: von
// Kries' scaling of Bradford's cone responses (Lam 1985; ICC.1:2022, annex E). Its luminance is kept. Identity for 6504
// K.
glm::dmat3 white_balance(double kelvin, double tint);

} // namespace restage::scene
