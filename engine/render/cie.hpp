// SPDX-License-Identifier: Apache-2.0
// CIE 1931 2-degree colour matching functions (CIE 15:2004, table T.4) and the standard illuminant D65 (table T.1),
// 360 to 830 nm in steps of 5 nm.
#pragma once

#include <array>
#include <cstddef>

namespace restage::render::cie {

inline constexpr int first_nm = 360, last_nm = 830, step_nm = 5;
using Curve = std::array<float, (last_nm - first_nm) / step_nm + 1>;

extern const Curve x_bar, y_bar, z_bar, d65;

double at(const Curve&, double nm); // linear between samples, constant beyond

} // namespace restage::render::cie
