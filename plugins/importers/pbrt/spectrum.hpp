// SPDX-License-Identifier: Apache-2.0
// Spectra to linear sRGB through the CIE 1931 observer, with the conventions of pbrt-v3 and pbrt-v4. All integrals are
// sums at 1 nm from 360 to 830 nm, as in pbrt-v4.
#pragma once

#include "params.hpp"

#include <array>

namespace restage::pbrt {

struct Rgb {
    double r = 0, g = 0, b = 0;
    friend Rgb operator*(Rgb x, Rgb y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
    friend Rgb operator*(Rgb x, double s) { return {x.r * s, x.g * s, x.b * s}; }
    friend Rgb operator+(Rgb x, Rgb y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
    bool operator==(const Rgb&) const = default;
};
inline double luminance(Rgb c) { return 0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b; } // of sRGB primaries

constexpr int first_nm = 360, last_nm = 830;
using Spectrum = std::array<double, last_nm - first_nm + 1>;

enum class Ends { zero, constant }; // beyond the samples: pbrt-v4's inline spectra are 0, v3's stay constant
// pairs: nm, value, nm, value, ...; wavelengths must increase (else nullopt).
std::optional<Spectrum> from_pairs(const std::vector<double>& pairs, Ends ends);
// pbrt-v4's names ("metal-Au-eta", "stdillum-D65", "glass-BK7"); nullopt if unknown.
std::optional<Spectrum> named_spectrum(std::string_view name);
// Of "glass-BK7" and others: their indices at all wavelengths. In RGB they have one, named_spectrum's, of the d line.
std::optional<Spectrum> named_dispersion(std::string_view name);
// "nm value nm value ...": the fewest pairs that are this spectrum, linear between them.
std::string to_pairs(const Spectrum& spectrum);
// "=spectrum:id r g b nm value ...": the origin of a value that has a spectrum (docs/plugins.md).
std::string spectrum_line(std::string_view id, Rgb value, const Spectrum& spectrum);
Spectrum blackbody(double kelvin); // Planck's law, its peak over all wavelengths = 1

// XYZ of an emitter, divided by the integral of y-bar: a constant spectrum of 1 has Y = 1.
std::array<double, 3> to_xyz(const Spectrum& emitted);
Rgb xyz_to_rgb(std::array<double, 3> xyz);
// pbrt-v3: emission and reflectance alike, under the equal-energy illuminant.
Rgb rgb_equal_energy(const Spectrum& spectrum);
// pbrt-v4 normalises every light given by a spectrum to luminance 1 (1 / SpectrumToPhotometric); scale follows.
Rgb rgb_of_light(const Spectrum& emitted);
// A reflectance, seen under D65 by an observer adapted to it: a constant r gives (r, r, r).
Rgb rgb_of_reflectance(const Spectrum& reflectance);
double luminance_mean(const Spectrum& spectrum); // weighted with y-bar: the index of a dispersive glass

// Colours in another space (directive ColorSpace). Lights keep their chromaticity; reflectances are adapted to
// D65 (Bradford), so that white stays white.
Rgb to_srgb(Rgb color, ColorSpace space, bool adapt_white);

// Per-channel (eta, k) whose normal-incidence Fresnel reflectance is that of the spectral metal under D65.
struct ComplexIndex {
    Rgb eta, k;
};
ComplexIndex rgb_of_metal(const Spectrum& eta, const Spectrum& k);
// The average of one channel's reflectance at normal incidence.
double fresnel_normal(double eta, double k);

} // namespace restage::pbrt
