// SPDX-License-Identifier: Apache-2.0
#include "render/spectral_colors.hpp"

#include "render/cie.hpp"
#include "render/spectral_fit.hpp"
#include "shared/spectral.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace restage::render {
namespace {

glm::vec3 as_floats(std::uint32_t a, std::uint32_t b, float scale) {
    return {std::bit_cast<float>(a), std::bit_cast<float>(b), scale};
}

float node(float x) {
    x = x * x * (3 - 2 * x);
    return x * x * (3 - 2 * x);
}

// Light at a bin's wavelengths, divided by the density of choosing them: the bin's part of the integral, so that
// neither the bins' width nor their number matters to a sum over all.
std::vector<glm::vec4> film_weights() {
    constexpr int steps = 16; // per bin
    std::vector<glm::vec4> out(SPECTRAL_BINS);
    glm::dvec3 total(0);
    std::vector<glm::dvec3> sums(SPECTRAL_BINS, glm::dvec3(0));
    const auto edge = [](int i) {
        const double x = 0.85691062 - 1.82750197 * i / double(SPECTRAL_BINS * steps);
        return 538 - 138.888889 * std::atanh(x);
    };
    for (int i = 0; i < int(SPECTRAL_BINS) * steps; ++i) {
        const double low = edge(i), high = edge(i + 1);
        sums[std::size_t(i / steps)] += white_rgb_at(0.5 * (low + high)) * (high - low);
    }
    for (const glm::dvec3& s : sums)
        total += s;
    for (std::size_t i = 0; i < out.size(); ++i) // a quarter: the mean of four wavelengths
        out[i] = glm::vec4(sums[i] / total * (0.25 * double(SPECTRAL_BINS)), 0);
    return out;
}

std::optional<std::vector<double>> numbers(std::string_view text) {
    std::vector<double> out;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        if (*at == ' ') {
            ++at;
            continue;
        }
        double x = 0;
        const auto [next, error] = std::from_chars(at, end, x);
        if (error != std::errc() || !std::isfinite(x)) return std::nullopt;
        out.push_back(x);
        at = next;
    }
    return out;
}

const std::string* spectrum_text(const scene::Origin& origin, std::string_view id) {
    for (const auto& value : origin.values)
        if (value.id.starts_with("spectrum:") && std::string_view(value.id).substr(9) == id) return &value.text;
    return nullptr;
}

std::optional<glm::dvec3> stands_for(const std::string& text) {
    const auto all = numbers(text);
    if (!all || all->size() < 5 || all->size() % 2 == 0) return std::nullopt;
    return glm::dvec3((*all)[0], (*all)[1], (*all)[2]);
}

bool close(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) <= 1e-5 * (glm::length(a) + glm::length(b));
}

} // namespace

glm::uvec2 pack_coefficients(const glm::vec3& c) {
    std::uint32_t x[3];
    for (int k = 0; k < 3; ++k) {
        const auto bits = std::bit_cast<std::uint32_t>(std::clamp(c[k], -1e6f, 1e6f));
        x[k] = (bits + 0x400u) >> 11; // to nearest
    }
    return {x[0] | x[1] << 21, x[1] >> 11 | x[2] << 10};
}

glm::vec3 stored_smooth(const glm::vec3& coefficients, float scale) {
    const glm::uvec2 packed = pack_coefficients(coefficients);
    return as_floats(packed.x, packed.y, scale);
}

glm::vec3 stored_curve(std::uint32_t curve, float scale) { return as_floats(curve, CURVE_BIT, scale); }
std::uint32_t stored_number(std::uint32_t curve) { return CURVE_NUMBER | curve; }

SpectralColors::SpectralColors(Jobs& jobs) : film_(film_weights()) {
    const auto fitted = fit_rgb_cube(jobs);
    cells_.reserve(fitted.size());
    for (const glm::vec3& c : fitted)
        cells_.push_back(pack_coefficients(c));
}

const SpectralColors& SpectralColors::get(Jobs& jobs) {
    static const SpectralColors instance(jobs);
    return instance;
}

glm::vec3 SpectralColors::coefficients(const glm::vec3& c) const {
    constexpr auto n = int(SPECTRAL_CELLS);
    const int k = c.x >= c.y && c.x >= c.z ? 0 : c.y >= c.z ? 1 : 2;
    const float z = c[k], top = n - 1;
    const glm::vec2 others = glm::vec2(c[(k + 1) % 3], c[(k + 2) % 3]) * (top / std::max(z, 1e-12f));
    int cell = 0; // node(cell / top) <= z
    for (int step = n / 2; step > 0; step /= 2)
        if (cell + step < n - 1 && node(float(cell + step) / top) <= z) cell += step;
    const glm::ivec3 at(std::min(int(others.x), n - 2), std::min(int(others.y), n - 2), cell);
    const float z0 = node(float(cell) / top), z1 = node(float(cell + 1) / top);
    const glm::vec3 d(others - glm::vec2(at.x, at.y), (z - z0) / (z1 - z0));
    glm::vec3 sum(0);
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 o(i & 1, i >> 1 & 1, i >> 2);
        const glm::vec3 w = glm::mix(1.f - d, d, glm::vec3(o));
        const glm::ivec3 p = at + o;
        const glm::uvec2 packed = cells_[std::size_t(((k * n + p.z) * n + p.y) * n + p.x)];
        sum += w.x * w.y * w.z * shared::unpack_coefficients(packed.x, packed.y);
    }
    return sum;
}

namespace {

// Exactly 1 at every wavelength: 1 + 4096^2 is rounded to 4096^2.
constexpr glm::vec3 one(0, 0, 4096);

} // namespace

glm::vec3 SpectralColors::reflectance(const glm::vec3& rgb) const {
    const glm::vec3 c = glm::clamp(rgb, 0.f, 1.f);
    if (c.x == c.y && c.y == c.z) return stored_smooth(one, c.x);
    return stored_smooth(coefficients(c), 1);
}

glm::vec3 SpectralColors::unbounded(const glm::vec3& rgb) const {
    const glm::vec3 c = glm::max(rgb, 0.f);
    if (c.x == c.y && c.y == c.z) return stored_smooth(one, c.x);
    const float scale = 2 * std::max({c.x, c.y, c.z});
    return stored_smooth(coefficients(c / scale), scale);
}

std::optional<std::uint32_t> SpectralCurves::find(const std::string& text, bool light) {
    const auto [entry, is_new] = known_.try_emplace((light ? "L" : "V") + text);
    if (!is_new) return entry->second;
    const auto all = numbers(text);
    const std::vector<double> pairs(all->begin() + 3, all->end());
    std::vector<float> values;
    std::size_t at = 0; // the pair at or before nm
    for (int nm = int(SPECTRAL_FIRST); nm <= int(SPECTRAL_LAST); ++nm) {
        while (at + 2 < pairs.size() && pairs[at + 2] <= nm)
            at += 2;
        double v = pairs[at + 1];
        if (nm > pairs[at] && at + 2 < pairs.size()) {
            const double t = (nm - pairs[at]) / (pairs[at + 2] - pairs[at]);
            v += t * (pairs[at + 3] - v);
        }
        values.push_back(float(light ? v / cie::at(cie::d65, nm) : v));
    }
    if (light) {
        const double luminance = luminance_of(values);
        if (!(luminance > 0)) return std::nullopt;
        for (float& v : values)
            v = float(v / luminance);
    }
    entry->second = std::uint32_t(entries_.size() / SPECTRAL_CURVE);
    for (std::size_t i = 0; i < values.size(); ++i)
        entries_.emplace_back(values[i], values[std::min(i + 1, values.size() - 1)]);
    return entry->second;
}

std::optional<std::uint32_t> SpectralCurves::of_value(const scene::Origin& origin, std::string_view id,
                                                      const glm::vec3& value) {
    const std::string* text = spectrum_text(origin, id);
    const auto stands = text ? stands_for(*text) : std::nullopt;
    if (!stands || !close(*stands, value)) return std::nullopt;
    return find(*text, false);
}

std::optional<std::uint32_t> SpectralCurves::of_light(const scene::Origin& origin, std::string_view id,
                                                      const glm::vec3& value) {
    const std::string* text = spectrum_text(origin, id);
    const auto stands = text ? stands_for(*text) : std::nullopt;
    if (!stands || !(glm::length(*stands) > 0) || !(glm::length(value) > 0)) return std::nullopt;
    if (!close(glm::normalize(*stands), glm::normalize(glm::dvec3(value)))) return std::nullopt;
    return find(*text, true);
}

void SpectralCurves::clear() {
    known_.clear();
    entries_.clear();
}

glm::vec4 spectrum_at(const glm::vec3& stored, float hero, std::span<const glm::vec2> curves) {
    const auto low = std::bit_cast<std::uint32_t>(stored.x), high = std::bit_cast<std::uint32_t>(stored.y);
    glm::vec4 out;
    for (int k = 0; k < 4; ++k) {
        const float nm = shared::visible_wavelength(glm::fract(hero + 0.25f * float(k)));
        if (high & CURVE_BIT) {
            const float x = std::clamp(nm - float(SPECTRAL_FIRST), 0.f, float(SPECTRAL_CURVE - 1));
            const glm::vec2& v = curves[low * SPECTRAL_CURVE + std::size_t(x)];
            out[k] = stored.z * glm::mix(v.x, v.y, x - std::floor(x));
        } else {
            out[k] = stored.z * float(smooth_spectrum(shared::unpack_coefficients(low, high), double(nm)));
        }
    }
    return out;
}

} // namespace restage::render
