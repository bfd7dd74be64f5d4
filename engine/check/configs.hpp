// SPDX-License-Identifier: Apache-2.0
// Test inputs for a material: random directions, and parameter sets drawn from its own table.
#pragma once

#include "check/bsdf_lab.hpp"

#include <random>
#include <string>
#include <vector>

namespace restage::check {

struct Engine { // std::mt19937 with a 32-bit result type
    using result_type = std::uint32_t;
    explicit Engine(std::uint32_t seed) : engine(seed) {}
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return 0xffffffffu; }
    result_type operator()() { return static_cast<result_type>(engine()); }
    std::mt19937 engine;
};

float uniform(Engine& e, float lo = 0, float hi = 1);
inline float unit(Engine& e) { return static_cast<float>(e() >> 8) * (1.f / 16777216.f); } // [0, 1)
inline Vec3 unit3(Engine& e) { return {unit(e), unit(e), unit(e)}; }
Vec3 direction(float z, float phi);
Vec3 from_degrees(double theta, double phi); // theta from +z; over 90: the back side
Vec3 random_direction(Engine& e, float z_min = -1);
inline float luminance(const Vec3& c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

inline bool is_opacity(const model::Param& p) { return std::string_view(p.id) == "opacity"; }
inline bool is_roughness(const model::Param& p) {
    return std::string_view(p.id).find("roughness") != std::string_view::npos;
}
std::string choice(const model::Param& p, std::size_t i); // the i-th of "a|b|c"
std::size_t choices(const model::Param& p);

// The two ends of a line, or all of its choices; none where it has no ends (text, references, files).
std::vector<scene::Value> ends(const model::Param& p);

// Scales the colours of an ADDITIVE material so that they sum to at most 1.
void keep_sum(const model::Material& table, scene::ParamSet& set);
// Every line uniform in its range; one in five at an end of it.
scene::ParamSet random_values(model::ParamTable table, Engine& e);
scene::ParamSet random_config(const model::Material& table, Engine& e);
// A random set with wide lobes: roughness between 0.2 and 0.8, used as alpha if the material allows it.
scene::ParamSet wide_config(const model::Material& table, Engine& e);
// Defaults, with every colour at 1 (ADDITIVE: sharing 1).
scene::ParamSet white_config(const model::Material& table);
// Defaults, with every roughness at `r`; if there are two or more, every second at `r_other`.
scene::ParamSet rough_config(const model::Material& table, float r, float r_other);

// The grid of the full tests: defaults; roughness from narrow to 1, anisotropic too; each line at its ends and each
// choice, one at a time on a roughness of 0.3; white; and random ones up to `count`.
std::vector<scene::ParamSet> config_grid(const model::Material& table, Engine& e, std::size_t count);

// Human-readable, to reproduce a failure.
std::string describe(const scene::ParamSet& set); // "the defaults" if empty
std::string describe(const Vec3& v);              // "(0.5, 0, 0.866)"
std::string describe(const BsdfJob& job, const BsdfAnswer& a);

} // namespace restage::check
