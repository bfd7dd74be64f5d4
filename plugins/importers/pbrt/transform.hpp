// SPDX-License-Identifier: Apache-2.0
// 4x4 matrices in double and pbrt's transform directives (pbrt-v4 book, sec. 3.9).
#pragma once

#include <array>
#include <optional>

namespace restage::pbrt {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};
double dot(Vec3 a, Vec3 b);
Vec3 cross(Vec3 a, Vec3 b);
double length(Vec3 v);
Vec3 normalize(Vec3 v); // the zero vector stays

// Column-major, m[4 * column + row], as pbrt writes Transform and as the ABI wants it; acts on column vectors.
struct Matrix {
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    double at(int row, int column) const { return m[static_cast<std::size_t>(4 * column + row)]; }
    double& at(int row, int column) { return m[static_cast<std::size_t>(4 * column + row)]; }
    bool operator==(const Matrix&) const = default;
    friend Matrix operator*(const Matrix& a, const Matrix& b);
};
std::optional<Matrix> inverse(const Matrix& matrix); // nullopt: singular
double determinant3(const Matrix& matrix);           // of the linear part
Vec3 transform_point(const Matrix& matrix, Vec3 p);  // affine
Vec3 transform_vector(const Matrix& matrix, Vec3 v);

Matrix translation(Vec3 by);
Matrix scaling(Vec3 by);
Matrix rotation(double degrees, Vec3 axis);            // identity for a zero axis
std::optional<Matrix> look_at(Vec3 eye, Vec3 at, Vec3 up); // world to camera; nullopt: no direction, or up along it
// A frame whose z axis is `direction` (light space to world for lights aimed by from/to).
Matrix frame_along(Vec3 direction);

} // namespace restage::pbrt
