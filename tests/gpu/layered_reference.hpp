// SPDX-License-Identifier: Apache-2.0
// The layered model by brute force: walks through the two interfaces and the medium, each event sampled by
// its own probabilities, no next-event estimation, no MIS, no Russian roulette. Slow, but simple enough not to share
// errors.
#pragma once

#include "gpu/bsdf_reference.hpp"

#include <optional>

namespace restage::test::reference {

struct LayeredModel {
    Alpha coat{0, 0};
    double eta = 1.5;
    double thickness = 0.01;
    double albedo = 0, g = 0;
    int max_depth = 10;
    bool metal = false;
    double reflectance = 0.5; // of the diffuse base
    std::complex<double> ior{1, 0}; // of the metal, relative to the coat
    Alpha base{0, 0};
};

struct Exit {
    V wi;
    double weight;
    bool delta;
};

// Scatters at a dielectric interface seen from v (z > 0): the direction and its weight; wi.z < 0 when transmitted.
inline V dielectric_event(V v, Alpha a, double eta, Random& r, double& weight) {
    const bool smooth = std::min(a.x, a.y) < 1e-3;
    const V h = smooth ? V{0, 0, 1} : visible_normal(v, a, r);
    const double c = dot(v, h), f = fresnel(c, eta);
    V w;
    if (r() < f) {
        w = h * (2 * c) - v;
        if (w.z <= 0) weight = 0;
    } else {
        const double cos_t = std::sqrt(1 - (1 - c * c) / (eta * eta));
        w = -v * (1 / eta) + h * (c / eta - cos_t);
        if (w.z >= 0) weight = 0;
    }
    if (!smooth && weight > 0) // G2 / G1
        weight *= (1 + lambda(v, a)) / (1 + lambda(v, a) + lambda({w.x, w.y, std::abs(w.z)}, a));
    return w;
}

// Source direction of the light seen along wo (z > 0); its mean weight over a set of directions is the integral of f
// cos.
inline std::optional<Exit> layered_walk(const LayeredModel& m, V wo, Random& r) {
    double weight = 1;
    const bool coat_is_smooth = std::min(m.coat.x, m.coat.y) < 1e-3;
    bool delta = coat_is_smooth;
    V w = dielectric_event(wo, m.coat, m.eta, r, weight);
    if (weight <= 0) return std::nullopt;
    if (w.z > 0) return Exit{w, weight, delta};
    double z = m.thickness;
    for (int depth = 0; depth <= m.max_depth; ++depth) {
        if (m.albedo > 0) {
            const double to = z + w.z * -std::log(1 - r()); // extinction 1
            if (to > 0 && to < m.thickness) {
                if (depth == m.max_depth) return std::nullopt;
                z = to;
                weight *= m.albedo;
                delta = false;
                double c = 1 - 2 * r();
                if (std::abs(m.g) > 1e-6) {
                    const double s = (1 - m.g * m.g) / (1 + m.g * c);
                    c = (1 + m.g * m.g - s * s) / (2 * m.g);
                }
                const double phi = 2 * pi * r(), sin_t = std::sqrt(std::max(0.0, 1 - c * c));
                const V t = normalize(std::abs(w.x) > 0.5 ? cross(w, {0, 1, 0}) : cross(w, {1, 0, 0}));
                w = t * (sin_t * std::cos(phi)) + cross(w, t) * (sin_t * std::sin(phi)) + w * c;
                continue;
            }
        } else {
            weight *= std::exp(-m.thickness / std::abs(w.z));
        }
        z = w.z > 0 ? m.thickness : 0;
        if (w.z > 0) { // the coat from below; in the mirrored frame
            const V next = dielectric_event({-w.x, -w.y, w.z}, m.coat, 1 / m.eta, r, weight);
            if (weight <= 0) return std::nullopt;
            if (next.z < 0) return Exit{{next.x, next.y, -next.z}, weight, delta};
            w = {next.x, next.y, -next.z};
        } else if (depth == m.max_depth) {
            return std::nullopt;
        } else if (!m.metal) {
            w = cosine_direction(r);
            weight *= m.reflectance;
            delta = false;
        } else {
            const V v = -w;
            const bool smooth = std::min(m.base.x, m.base.y) < 1e-3;
            const V h = smooth ? V{0, 0, 1} : visible_normal(v, m.base, r);
            w = h * (2 * dot(v, h)) - v;
            if (w.z <= 0) return std::nullopt;
            weight *= fresnel(dot(v, h), m.ior);
            if (!smooth) weight *= (1 + lambda(v, m.base)) / (1 + lambda(v, m.base) + lambda(w, m.base));
            delta = coat_is_smooth && smooth; // no connection to a light can be made after this, see layered.glsl
        }
    }
    return std::nullopt;
}

} // namespace restage::test::reference
