// SPDX-License-Identifier: Apache-2.0
// BSDF formulas in double precision, written from the papers in their textbook form (angles, tangents, complex numbers,
// slope space) and not from the shaders, which rearrange them: what the GLSL is compared with.
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
