// SPDX-License-Identifier: Apache-2.0
// Measured curves, as numbers: the CIE 1931 2-degree observer, CIE and ACES illuminants, metals, glasses.
#pragma once

#include <string_view>

namespace restage::pbrt {

struct Curve { // samples at first, first + step, ... [nm], linear between, constant beyond
    const float* values = nullptr;
    int count = 0;
    int first = 360, step = 5;
};

Curve cie_x();
Curve cie_y();
Curve cie_z();
// "stdillum-D65", "illum-acesD60", "metal-Au-eta", ...: the names of pbrt-v4. count == 0 if there is none.
Curve named_curve(std::string_view name);
// "glass-BK7": refractive index at the sodium d line, 587.56 nm; 0 if there is none.
float named_glass(std::string_view name);
double glass_index(std::string_view name, double nm); // likewise at a wavelength

} // namespace restage::pbrt
