// SPDX-License-Identifier: Apache-2.0
// Affine transforms as the ABI has them: column-major double[16].
#pragma once

#include <array>
#include <cmath>

namespace restage::importing {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(Vec3 a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(Vec3 a, Vec3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalized(Vec3 a, Vec3 otherwise = {0, 0, 1}) {
    const double l = length(a);
    return l > 0 && std::isfinite(l) ? a * (1 / l) : otherwise;
}

struct Matrix {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    double& at(int row, int column) { return m[static_cast<unsigned>(column) * 4 + static_cast<unsigned>(row)]; }
    double at(int row, int column) const { return m[static_cast<unsigned>(column) * 4 + static_cast<unsigned>(row)]; }
    Vec3 column(int c) const { return {at(0, c), at(1, c), at(2, c)}; }
    void set_column(int c, Vec3 v) {
        for (int r = 0; r < 3; ++r)
            at(r, c) = v[static_cast<std::size_t>(r)];
    }
};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix result;
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) {
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                sum += a.at(r, k) * b.at(k, c);
            result.at(r, c) = sum;
        }
    return result;
}
inline Vec3 transform_vector(const Matrix& m, Vec3 v) {
    return m.column(0) * v[0] + m.column(1) * v[1] + m.column(2) * v[2];
}
inline Vec3 transform_point(const Matrix& m, Vec3 p) { return transform_vector(m, p) + m.column(3); }
inline double determinant(const Matrix& m) { return dot(m.column(0), cross(m.column(1), m.column(2))); }
inline bool is_finite(const Matrix& m) {
    for (const double x : m.m)
        if (!std::isfinite(x)) return false;
    return true;
}
inline bool is_affine(const Matrix& m) {
    return is_finite(m) && m.at(3, 0) == 0 && m.at(3, 1) == 0 && m.at(3, 2) == 0 && m.at(3, 3) == 1;
}
inline Matrix translation(Vec3 t) {
    Matrix m;
    m.set_column(3, t);
    return m;
}

// The smallest box around points.
struct Bounds {
    Vec3 lower{1, 1, 1}, upper{-1, -1, -1}; // empty
    bool empty() const { return lower[0] > upper[0]; }
    void add(Vec3 p) {
        const bool first = empty();
        for (std::size_t i = 0; i < 3; ++i) {
            lower[i] = first || p[i] < lower[i] ? p[i] : lower[i];
            upper[i] = first || p[i] > upper[i] ? p[i] : upper[i];
        }
    }
    void add(const Bounds& box, const Matrix& to_world) { // of the box's corners
        for (std::size_t i = 0; i < 8 && !box.empty(); ++i)
            add(transform_point(to_world, box.corner(i)));
    }
    Vec3 corner(std::size_t i) const {
        return {i & 1 ? upper[0] : lower[0], i & 2 ? upper[1] : lower[1], i & 4 ? upper[2] : lower[2]};
    }
    Vec3 center() const { return (lower + upper) * 0.5; }
    double radius() const { return empty() ? 0 : 0.5 * length(upper - lower); }
};

} // namespace restage::importing
