// SPDX-License-Identifier: Apache-2.0
// Smooth spectra for RGB colours: Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral
// Upsampling". Linear sRGB under the illuminant D65, seen by the CIE 1931 observer.
#pragma once

#include "base/jobs.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace restage::render {

// s(t) = 1/2 + x / (2 sqrt(1 + x^2)), x = c.x t^2 + c.y t + c.z; t = -1 at 360 nm, 1 at 830 nm.
double smooth_spectrum(const glm::dvec3& c, double nm);

glm::dvec3 rgb_of_xyz(const glm::dvec3& xyz); // D65 as tabulated is exactly white
// Of white light (D65) of luminance 1, per nm: its integral over the visible range is (1, 1, 1).
glm::dvec3 white_rgb_at(double nm);
double d65_at(double nm); // in the table's own unit
// Luminance of light given relative to D65, at 360, 361, ... 830 nm; 1 everywhere has luminance 1.
double luminance_of(const std::vector<float>& relative);

// Coefficients for all nodes of shared/spectral.h's table, x fastest, then y, z, and the brightest component: of the
// colour whose brightest component (r, g, b) is n(n(z)), n(x) = x^2 (3 - 2x), and whose next two (cyclically) are x and
// y times as bright. About a second of CPU time.
std::vector<glm::vec3> fit_rgb_cube(Jobs& jobs);

} // namespace restage::render
