// SPDX-License-Identifier: Apache-2.0
// Vectors, affine matrices and random numbers in double precision. Only +, -, *, / and sqrt, which IEEE 754 rounds
// identically everywhere, so that a seed gives the same copies on every machine; hence its own sin and cos.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace scatter {

struct Vec {
    double x = 0, y = 0, z = 0;
    friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec normalize(Vec a) { return a * (1 / length(a)); }
inline Vec perpendicular(Vec unit) { // a unit vector
    const Vec axis = std::abs(unit.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
    return normalize(cross(unit, axis));
}

struct Affine { // columns
    Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{};

    Vec direction(Vec v) const { return x * v.x + y * v.y + z * v.z; }
    Vec point(Vec v) const { return direction(v) + origin; }
    friend Affine operator*(const Affine& a, const Affine& b) {
        return {a.direction(b.x), a.direction(b.y), a.direction(b.z), a.point(b.origin)};
    }
    static Affine from(const double m[16]) { // column-major
        return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
    }
    void to(double m[16]) const {
        const Vec columns[] = {x, y, z, origin};
        for (int i = 0; i < 4; ++i)
            m[4 * i] = columns[i].x, m[4 * i + 1] = columns[i].y, m[4 * i + 2] = columns[i].z, m[4 * i + 3] = i == 3;
    }
    double determinant() const { return dot(cross(x, y), z); }
};

// For angles in [-2 pi, 2 pi]: reduction by quarter turns, then the Taylor series to 17th order, whose remainder at
// pi/4 is below 2^-52.
inline std::pair<double, double> sin_cos(double angle) {
    const double turns = std::floor(angle * (2 / std::numbers::pi) + 0.5);
    const double a = angle - turns * (std::numbers::pi / 2), a2 = a * a;
    double s = 1, c = 1;
    for (int k = 16; k >= 2; k -= 2) {
        s = 1 - s * a2 / (k * (k + 1));
        c = 1 - c * a2 / (k * (k - 1));
    }
    s *= a;
    switch (static_cast<int>(turns) & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

// Rodrigues' formula: about a unit axis.
inline Affine rotation(Vec axis, double sine, double cosine) {
    const auto turn = [&](Vec v) { return v * cosine + cross(axis, v) * sine + axis * (dot(axis, v) * (1 - cosine)); };
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), {}};
}

// The smallest rotation from one unit vector to another.
inline Affine rotation(Vec from, Vec to) {
    const Vec axis = cross(from, to);
    const double sine = length(axis), cosine = dot(from, to);
    if (sine < 1e-12) return cosine > 0 ? Affine() : rotation(perpendicular(from), 0, -1);
    return rotation(axis * (1 / sine), sine, cosine);
}

// PCG-XSH-RR 64/32. M. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
// Number Generation", 2014.
class Random {
  public:
    // Streams of one seed are independent. There is one per copy, so that drawing another parameter shifts no other
    // copy.
    Random(std::uint64_t seed, std::uint64_t stream) : increment_(stream << 1 | 1) {
        next();
        state_ += seed;
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005u + increment_;
        const auto word = static_cast<std::uint32_t>((old >> 18 ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return word >> turn | word << (-turn & 31);
    }
    double uniform() { // [0, 1), 53 bits
        const std::uint64_t high = next() >> 5, low = next() >> 6;
        return static_cast<double>(high << 26 | low) * 0x1p-53;
    }
    double between(double a, double b) { return a + (b - a) * uniform(); }

  private:
    std::uint64_t state_ = 0, increment_;
};

} // namespace scatter
