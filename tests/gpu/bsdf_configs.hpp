// SPDX-License-Identifier: Apache-2.0
// Random directions and random parameter sets drawn from a material's own table.
#pragma once

#include "gpu/bench.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

namespace restage::test {

struct Engine { // std::mt19937 whose numbers have 32 bits by type, too
    using result_type = std::uint32_t;
    explicit Engine(std::uint32_t seed) : engine(seed) {}
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return 0xffffffffu; }
    result_type operator()() { return static_cast<result_type>(engine()); }
    std::mt19937 engine;
};

inline float uniform(Engine& e, float lo = 0, float hi = 1) { return std::uniform_real_distribution<float>(lo, hi)(e); }
inline float unit(Engine& e) { return static_cast<float>(e() >> 8) * (1.f / 16777216.f); } // [0, 1)
inline Vec3 unit3(Engine& e) { return {unit(e), unit(e), unit(e)}; }
inline Vec3 direction(float z, float phi) {
    const float r = std::sqrt(std::max(0.f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}
inline Vec3 random_direction(Engine& e, float z_min = -1) {
    return direction(uniform(e, z_min, 1), uniform(e, 0, 2 * std::numbers::pi_v<float>));
}
inline float luminance(const Vec3& c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

inline bool is_opacity(const RestageParam& p) { return std::string_view(p.id) == "opacity"; }

// The i-th choice of "a|b|c".
inline std::string choice(const RestageParam& p, std::size_t i) {
    std::stringstream all(p.choices);
    std::string word;
    for (std::size_t k = 0; k <= i; ++k)
        std::getline(all, word, '|');
    return word;
}
inline std::size_t choices(const RestageParam& p) {
    const std::string_view text = p.choices;
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '|')) + 1;
}

// Scales the colours of an ADDITIVE material so that they sum to at most 1 (RESTAGE_MATERIAL_ADDITIVE).
inline void keep_sum(const RestageMaterial1& table, scene::ParamSet& set) {
    if (!(table.flags & RESTAGE_MATERIAL_ADDITIVE)) return;
    float sum = 0;
    for (std::uint32_t i = 0; i < table.param_count; ++i)
        if (const RestageParam& p = table.params[i]; p.type == RESTAGE_COLOR && !is_opacity(p)) {
            const auto c = set.color(p.id, {p.def[0], p.def[1], p.def[2]});
            sum += std::max({c[0], c[1], c[2]});
        }
    for (std::uint32_t i = 0; i < table.param_count; ++i)
        if (const RestageParam& p = table.params[i]; p.type == RESTAGE_COLOR && !is_opacity(p)) {
            const auto c = set.color(p.id, {p.def[0], p.def[1], p.def[2]});
            const float s = 1 / std::max(1.f, sum);
            set.set(p.id, scene::Value::color(c[0] * s, c[1] * s, c[2] * s));
        }
}

// Every line anywhere in its range; one in five at an end of it.
inline scene::ParamSet random_config(const RestageMaterial1& table, Engine& e) {
    scene::ParamSet set;
    const auto number = [&](const RestageParam& p) {
        const float x = uniform(e);
        return x < 0.1f ? p.min : x < 0.2f ? p.max : uniform(e, p.min, p.max);
    };
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& p = table.params[i];
        switch (p.type) {
            case RESTAGE_FLOAT:
                set.set(p.id, scene::Value::number(number(p)));
                break;
            case RESTAGE_COLOR:
                set.set(p.id, scene::Value::color(number(p), number(p), number(p)));
                break;
            case RESTAGE_INT:
                set.set(p.id, scene::Value::integer(static_cast<int>(std::lround(number(p)))));
                break;
            case RESTAGE_BOOL:
                set.set(p.id, scene::Value::boolean(uniform(e) < 0.5f));
                break;
            case RESTAGE_ENUM:
                set.set(p.id, scene::Value::choice(choice(p, e() % choices(p))));
                break;
            default:
                break;
        }
    }
    keep_sum(table, set);
    return set;
}

inline bool is_roughness(const RestageParam& p) {
    return std::string_view(p.id).find("roughness") != std::string_view::npos;
}

// A random set whose lobes are wide enough for a grid to see: roughness between 0.2 and 1, taken as alpha where the
// material lets us.
inline scene::ParamSet wide_config(const RestageMaterial1& table, Engine& e) {
    scene::ParamSet set = random_config(table, e);
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& p = table.params[i];
        if (is_roughness(p)) set.set(p.id, scene::Value::number(uniform(e, 0.2f, 0.8f)));
        if (std::string_view(p.id) == "remap") set.set(p.id, scene::Value::choice("none"));
        if (p.type == RESTAGE_INT) set.set(p.id, scene::Value::integer(static_cast<int>(p.def[0])));
    }
    return set;
}

// Defaults, with every colour at 1 (ADDITIVE: sharing 1).
inline scene::ParamSet white_config(const RestageMaterial1& table) {
    scene::ParamSet set;
    for (std::uint32_t i = 0; i < table.param_count; ++i)
        if (const RestageParam& p = table.params[i]; p.type == RESTAGE_COLOR)
            set.set(p.id, scene::Value::color(1, 1, 1));
    keep_sum(table, set);
    return set;
}

// To replay a failure.
inline std::string describe(const scene::ParamSet& set) {
    std::ostringstream out;
    out.precision(9);
    for (const auto& [id, v] : set.entries()) {
        out << id << '=';
        if (v.type == RESTAGE_ENUM)
            out << v.text;
        else if (v.type == RESTAGE_COLOR)
            out << '(' << v.v[0] << ' ' << v.v[1] << ' ' << v.v[2] << ')';
        else
            out << v.v[0];
        out << ' ';
    }
    return out.str();
}
inline std::string describe(const BsdfJob& job, const BsdfAnswer& a) {
    std::ostringstream out;
    out.precision(9);
    const auto vec = [&](const char* name, const Vec3& v) {
        out << name << "(" << v[0] << ", " << v[1] << ", " << v[2] << ") ";
    };
    vec("wo", job.wo), vec("wi", job.wi), vec("u", job.u);
    out << "seed " << job.seed << " -> ";
    vec("eval", a.eval);
    out << "pdf " << a.pdf << " sample: ";
    vec("wi", a.wi), vec("weight", a.weight);
    out << "pdf " << a.sample_pdf << " flags " << a.flags << " eta " << a.eta << " there: ";
    vec("eval", a.eval_sampled), vec("reverse", a.eval_reverse), vec("albedo", a.albedo);
    out << "pdf " << a.pdf_sampled;
    return out.str();
}

} // namespace restage::test
