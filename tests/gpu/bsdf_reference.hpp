// SPDX-License-Identifier: Apache-2.0
// BSDF formulas in double precision, written from the papers in their textbook form (angles, tangents, complex numbers,
// slope space) and not from the shaders, which rearrange them: the references for the GLSL.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace restage::test::reference {

inline constexpr double pi = std::numbers::pi;

struct V {
    double x = 0, y = 0, z = 0;
    V operator+(V b) const { return {x + b.x, y + b.y, z + b.z}; }
    V operator-(V b) const { return {x - b.x, y - b.y, z - b.z}; }
    V operator-() const { return {-x, -y, -z}; }
    V operator*(double s) const { return {x * s, y * s, z * s}; }
};
inline double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline V normalize(V a) { return a * (1 / std::sqrt(dot(a, a))); }
inline double tan2_theta(V w) { return std::max(0.0, 1 - w.z * w.z) / (w.z * w.z); }

struct Alpha {
    double x, y;
    bool beckmann = false;
};
inline double roughness_to_alpha(double r, int remap) { // 0 v4, 1 v3, 2 none
    const double x = std::log(std::max(r, 1e-3));
    return remap == 0   ? std::sqrt(r)
           : remap == 1 ? 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x
                        : r;
}

// tan^2(theta) (cos^2(phi) / ax^2 + sin^2(phi) / ay^2)
inline double slope_term(V h, double ax2, double ay2) {
    const double phi = std::atan2(h.y, h.x);
    return tan2_theta(h) * (std::pow(std::cos(phi), 2) * ax2 + std::pow(std::sin(phi), 2) * ay2);
}
inline double distribution(V h, Alpha a) { // Walter et al. 2007, Eqs. 25 and 33, anisotropic
    const double e = slope_term(h, 1 / (a.x * a.x), 1 / (a.y * a.y));
    const double cos4 = std::pow(h.z, 4);
    return a.beckmann ? std::exp(-e) / (pi * a.x * a.y * cos4) : 1 / (pi * a.x * a.y * cos4 * (1 + e) * (1 + e));
}
inline double lambda(V w, Alpha a) { // Heitz 2014, Eqs. 68 and 72
    const double t = slope_term(w, a.x * a.x, a.y * a.y);
    if (!a.beckmann) return (-1 + std::sqrt(1 + t)) / 2;
    const double b = 1 / std::sqrt(std::max(t, 1e-300));
    return (std::erf(b) - 1) / 2 + std::exp(-b * b) / (2 * b * std::sqrt(pi));
}
inline double g2(V wo, V wi, Alpha a) { return 1 / (1 + lambda(wo, a) + lambda(wi, a)); }

// Amplitudes of Fresnel, with a complex index; eta = transmitted / incident.
inline double fresnel(double cos_i, std::complex<double> eta) {
    const std::complex<double> cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (eta * eta));
    const auto parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const auto perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (std::norm(parallel) + std::norm(perpendicular)) / 2;
}

// f |cos wi| of a microfacet interface, both in the frame of wo (wo.z > 0), radiance: Walter et al. 2007, Eqs. 20, 21.
inline double microfacet_reflection(V wo, V wi, Alpha a, std::complex<double> eta) {
    const V h = normalize(wo + wi);
    return fresnel(dot(wo, h), eta) * distribution(h, a) * g2(wo, wi, a) / (4 * wo.z);
}
inline double microfacet_transmission(V wo, V wi, Alpha a, double eta) { // eta = ior of wi's side / of wo's
    V h = normalize(-(wo + wi * eta)); // Eq. 16
    if (h.z < 0) h = -h;
    if (dot(wo, h) <= 0 || dot(wi, h) >= 0) return 0;
    const double denominator = dot(wo, h) + eta * dot(wi, h);
    const V wi_up{wi.x, wi.y, -wi.z};
    const double f = std::abs(dot(wo, h) * dot(wi, h) / (wo.z * wi.z)) * eta * eta * (1 - fresnel(dot(wo, h), eta)) *
                     g2(wo, wi_up, a) * distribution(h, a) / (denominator * denominator);
    return f * std::abs(wi.z) / (eta * eta); // radiance
}

inline double schlick(double f0, double f90, double c) { return f0 + (f90 - f0) * std::pow(1 - c, 5); }

// f |cos wi| of Estevez and Kulla 2017, Eqs. 2 to 4, both directions above.
inline double sheen_lambda(double cos_theta, double r) {
    const auto l = [r](double x) {
        const double t = (1 - r) * (1 - r);
        const auto p = [t](double at0, double at1) { return t * at0 + (1 - t) * at1; };
        return p(25.3245, 21.5473) / (1 + p(3.32435, 3.82987) * std::pow(x, p(0.16801, 0.19823))) +
               p(-1.27393, -1.97760) * x + p(-4.85967, -4.32054);
    };
    return cos_theta < 0.5 ? std::exp(l(cos_theta)) : std::exp(2 * l(0.5) - l(1 - cos_theta));
}
inline double sheen(V wo, V wi, double r) {
    const V h = normalize(wo + wi);
    const double d = (2 + 1 / r) * std::pow(std::sin(std::acos(std::min(h.z, 1.0))), 1 / r) / (2 * pi);
    return d / (1 + sheen_lambda(wo.z, r) + sheen_lambda(wi.z, r)) / (4 * wo.z);
}

// Reflectance of a film [nm] on a base, linear sRGB: Belcour and Barla 2017, Eqs. 3 and 10, two orders, Schlick's
// terms.
inline std::array<double, 3> thin_film(double c, double index, double thickness, std::array<double, 3> f0) {
    const double x = std::clamp(thickness / 30, 0.0, 1.0), film = 1 + (index - 1) * x * x * (3 - 2 * x);
    const double cos_t = std::sqrt(1 - (1 - c * c) / (film * film));
    const double r12 = schlick(std::pow((film - 1) / (film + 1), 2), 1, c), t121 = 1 - r12;
    const double path = 2 * film * thickness * 1e-9 * cos_t; // [m]
    std::array<double, 3> xyz[2], rgb{}, r23{}, series{}, phase{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double root = std::sqrt(std::min(f0[k], 0.9999)), base = (1 + root) / (1 - root);
        r23[k] = schlick(std::pow((base - film) / (base + film), 2), 1, cos_t);
        series[k] = t121 * t121 * r23[k] / (1 - std::clamp(r12 * r23[k], 1e-5, 0.9999));
        phase[k] = pi + (base < film ? pi : 0);
    }
    for (int m = 1; m <= 2; ++m) {
        const double w = 2 * pi * path * m;
        const auto lobe = [&](double value, double position, double variance, double shift) {
            return value * std::sqrt(2 * pi * variance) * std::cos(position * w + shift) * std::exp(-w * w * variance);
        };
        xyz[m - 1] = {
            (lobe(5.4856e-13, 1.6810e6, 4.3278e9, m * phase[0]) + lobe(9.7470e-14, 2.2399e6, 4.5282e9, m * phase[0])) /
                1.0685e-7,
            lobe(4.4201e-13, 1.7953e6, 9.3046e9, m * phase[1]) / 1.0685e-7,
            lobe(5.2481e-13, 2.2084e6, 6.6121e9, m * phase[2]) / 1.0685e-7};
    }
    constexpr double to_rgb[3][3] = {{3.2404542, -1.5371385, -0.4985314}, // IEC 61966-2-1
                                     {-0.9692660, 1.8760108, 0.0415560},
                                     {0.0556434, -0.2040259, 1.0572252}};
    for (std::size_t k = 0; k < 3; ++k) {
        rgb[k] = r12 + series[k];
        for (int m = 1; m <= 2; ++m) {
            double s = 0;
            for (std::size_t j = 0; j < 3; ++j)
                s += to_rgb[k][j] * xyz[m - 1][j];
            rgb[k] += 2 * s * (series[k] - t121) * std::pow(std::clamp(r12 * r23[k], 1e-5, 0.9999), m / 2.0);
        }
        rgb[k] = std::clamp(rgb[k], 0.0, 1.0);
    }
    return rgb;
}

// Random numbers and sampling, for walks. Visible normals by Heitz 2018 (projected hemisphere), not by spherical caps.
struct Random {
    std::mt19937_64 engine;
    double operator()() { return std::uniform_real_distribution<double>(0, 1)(engine); }
};
inline V visible_normal(V w, Alpha a, Random& r) {
    const V v = normalize({a.x * w.x, a.y * w.y, w.z});
    const V t1 = v.z < 0.9999 ? normalize(cross({0, 0, 1}, v)) : V{1, 0, 0};
    const V t2 = cross(v, t1);
    const double radius = std::sqrt(r()), phi = 2 * pi * r(), s = (1 + v.z) / 2;
    const double p1 = radius * std::cos(phi);
    const double p2 = (1 - s) * std::sqrt(1 - p1 * p1) + s * radius * std::sin(phi);
    const V n = t1 * p1 + t2 * p2 + v * std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2));
    return normalize({a.x * n.x, a.y * n.y, std::max(0.0, n.z)});
}
inline V cosine_direction(Random& r) {
    const double s = std::sqrt(r()), phi = 2 * pi * r();
    return {s * std::cos(phi), s * std::sin(phi), std::sqrt(std::max(0.0, 1 - s * s))};
}

} // namespace restage::test::reference
