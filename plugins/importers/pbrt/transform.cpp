// SPDX-License-Identifier: Apache-2.0
#include "transform.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace restage::pbrt {

double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Vec3 v) { return std::sqrt(dot(v, v)); }
Vec3 normalize(Vec3 v) {
    const double l = length(v);
    return l > 0 ? v * (1 / l) : v;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix out;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            double sum = 0;
            for (int k = 0; k < 4; ++k)
                sum += a.at(row, k) * b.at(k, column);
            out.at(row, column) = sum;
        }
    return out;
}

std::optional<Matrix> inverse(const Matrix& matrix) { // Gauss-Jordan with partial pivoting
    Matrix a = matrix, out;
    for (int column = 0; column < 4; ++column) {
        int pivot = column;
        for (int row = column + 1; row < 4; ++row)
            if (std::abs(a.at(row, column)) > std::abs(a.at(pivot, column))) pivot = row;
        const double head = a.at(pivot, column);
        if (!(std::abs(head) > 0) || !std::isfinite(head)) return std::nullopt;
        for (int k = 0; k < 4; ++k) {
            std::swap(a.at(pivot, k), a.at(column, k));
            std::swap(out.at(pivot, k), out.at(column, k));
        }
        for (int k = 0; k < 4; ++k) {
            a.at(column, k) /= head;
            out.at(column, k) /= head;
        }
        for (int row = 0; row < 4; ++row) {
            const double factor = a.at(row, column);
            if (row == column || factor == 0) continue;
            for (int k = 0; k < 4; ++k) {
                a.at(row, k) -= factor * a.at(column, k);
                out.at(row, k) -= factor * out.at(column, k);
            }
        }
    }
    for (const double value : out.m)
        if (!std::isfinite(value)) return std::nullopt;
    return out;
}

double determinant3(const Matrix& m) {
    return dot({m.at(0, 0), m.at(1, 0), m.at(2, 0)},
               cross({m.at(0, 1), m.at(1, 1), m.at(2, 1)}, {m.at(0, 2), m.at(1, 2), m.at(2, 2)}));
}

Vec3 transform_vector(const Matrix& m, Vec3 v) {
    return {m.at(0, 0) * v.x + m.at(0, 1) * v.y + m.at(0, 2) * v.z,
            m.at(1, 0) * v.x + m.at(1, 1) * v.y + m.at(1, 2) * v.z,
            m.at(2, 0) * v.x + m.at(2, 1) * v.y + m.at(2, 2) * v.z};
}

Vec3 transform_point(const Matrix& m, Vec3 p) {
    return transform_vector(m, p) + Vec3{m.at(0, 3), m.at(1, 3), m.at(2, 3)};
}

Matrix translation(Vec3 by) {
    Matrix out;
    out.at(0, 3) = by.x;
    out.at(1, 3) = by.y;
    out.at(2, 3) = by.z;
    return out;
}

Matrix scaling(Vec3 by) {
    Matrix out;
    out.at(0, 0) = by.x;
    out.at(1, 1) = by.y;
    out.at(2, 2) = by.z;
    return out;
}

Matrix rotation(double degrees, Vec3 axis) { // Rodrigues
    Matrix out;
    const Vec3 a = normalize(axis);
    if (!(dot(a, a) > 0)) return out;
    const double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = std::cos(angle);
    const double n[3] = {a.x, a.y, a.z};
    const double skew[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            out.at(row, column) = n[row] * n[column] * (1 - c) + (row == column ? c : 0) + skew[row][column] * s;
    return out;
}

std::optional<Matrix> look_at(Vec3 eye, Vec3 at, Vec3 up) {
    const Vec3 forward = normalize(at - eye);
    const Vec3 side = cross(normalize(up), forward);
    if (!(dot(forward, forward) > 0) || !(length(side) > 1e-12)) return std::nullopt;
    const Vec3 right = normalize(side), new_up = cross(forward, right);
    Matrix camera_to_world;
    const Vec3 columns[4] = {right, new_up, forward, eye};
    for (int column = 0; column < 4; ++column) {
        camera_to_world.at(0, column) = columns[column].x;
        camera_to_world.at(1, column) = columns[column].y;
        camera_to_world.at(2, column) = columns[column].z;
    }
    return inverse(camera_to_world);
}

Matrix frame_along(Vec3 direction) {
    const Vec3 z = normalize(direction);
    const Vec3 helper = std::abs(z.x) > 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 x = normalize(cross(helper, z)), y = cross(z, x);
    Matrix out;
    const Vec3 columns[3] = {x, y, z};
    for (int column = 0; column < 3; ++column) {
        out.at(0, column) = columns[column].x;
        out.at(1, column) = columns[column].y;
        out.at(2, column) = columns[column].z;
    }
    return out;
}

} // namespace restage::pbrt
