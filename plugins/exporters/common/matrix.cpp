// SPDX-License-Identifier: Apache-2.0
#include "common/matrix.hpp"

#include <cmath>
#include <cstddef>

namespace restage::exporters {

bool is_identity(const double m[16]) {
    for (int i = 0; i < 16; ++i)
        if (m[i] != (i % 5 == 0 ? 1.0 : 0.0)) return false;
    return true;
}

Matrix multiply(const double a[16], const double b[16]) {
    Matrix out{};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 4; ++row)
            for (std::size_t k = 0; k < 4; ++k)
                out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    return out;
}

double determinant(const double m[16]) {
    return m[0] * (m[5] * m[10] - m[9] * m[6]) + m[4] * (m[9] * m[2] - m[1] * m[10]) +
           m[8] * (m[1] * m[6] - m[5] * m[2]);
}

std::optional<Matrix> inverse(const double m[16]) {
    const auto at = [&](int row, int column) { return m[4 * column + row]; };
    const auto cofactor = [&](int r, int c) {
        const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        return at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1);
    };
    const double scale = determinant(m);
    if (scale == 0 || !std::isfinite(1 / scale)) return std::nullopt;
    Matrix out{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out[static_cast<std::size_t>(4 * column + row)] = cofactor(column, row) / scale;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t k = 0; k < 3; ++k)
            out[12 + row] -= out[4 * k + row] * m[12 + k];
    out[15] = 1;
    return out;
}

} // namespace restage::exporters
