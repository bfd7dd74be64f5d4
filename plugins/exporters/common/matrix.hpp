// SPDX-License-Identifier: Apache-2.0
// 4x4 matrices as scene_io.h has them: column-major double[16].
#pragma once

#include <array>
#include <optional>

namespace restage::exporters {

using Matrix = std::array<double, 16>;

bool is_identity(const double m[16]);
Matrix multiply(const double a[16], const double b[16]);
std::optional<Matrix> inverse(const double m[16]); // of an affine one, through the adjugate of its linear part
double determinant(const double m[16]); // of the linear part

} // namespace restage::exporters
