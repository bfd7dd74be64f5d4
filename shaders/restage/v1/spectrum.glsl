// SPDX-License-Identifier: Apache-2.0
// Spectrum: a colour, reflectance or index of refraction, one number per wavelength that a path carries. In RGB mode
// these are three, linear with Rec. 709 primaries; in spectral mode (RESTAGE_SPECTRAL is defined) four hero wavelengths
// (Wilkie et al. 2014; Pharr et al. 2023, ch. 4). Code for both uses `Spectrum`, never vec3, .rgb or three arguments:
//
//   Spectrum(x)                     the same at every wavelength
//   spectrum_from_rgb(c)            a reflectance: within [0,1] if c is
//   spectrum_from_rgb_unbounded(c)  may exceed 1: an absorption coefficient, an index of refraction, a radiance
//   wavelengths()                   [nm], of each component: data that depend on the wavelength (Cauchy's or Sellmeier's
//                                   formula, the phase of a thin film, measured eta and k in a Table) are evaluated there
//   rgb_from_spectrum(s)            back; to inspect a colour, not to compute with it
//   luminance, average, max_component, min_component, is_black, finite
//
// Componentwise are + - * /, min, max, clamp, mix, exp, log, pow, sqrt, step, and comparisons (lessThan; mix takes their
// result). COLOR parameters arrive as Spectrum: a reflectance where their maximum is at most 1, else unbounded.
#ifndef RESTAGE_V1_SPECTRUM
#define RESTAGE_V1_SPECTRUM
#include <restage/v1/numbers.glsl>

float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); } // Rec. 709 primaries, linear
float max_component(vec3 c) { return max(c.x, max(c.y, c.z)); }
float min_component(vec3 c) { return min(c.x, min(c.y, c.z)); }
float average(vec3 c) { return dot(c, vec3(1.0 / 3.0)); }
bool is_black(vec3 c) { return c == vec3(0); }

#ifdef RESTAGE_SPECTRAL

// A placeholder until there is a spectral renderer: every path uses these wavelengths, and the three primaries
// are curves that sum to 1 everywhere. Code that uses the functions above will not have to change.
#define Spectrum vec4

Spectrum wavelengths() { return Spectrum(450.0, 520.0, 580.0, 640.0); }

void spectrum_primaries(out Spectrum r, out Spectrum g, out Spectrum b) {
    Spectrum l = wavelengths();
    b = 1.0 - smoothstep(Spectrum(460.0), Spectrum(510.0), l);
    r = smoothstep(Spectrum(560.0), Spectrum(610.0), l);
    g = 1.0 - r - b;
}
Spectrum spectrum_from_rgb_unbounded(vec3 c) {
    Spectrum r, g, b;
    spectrum_primaries(r, g, b);
    return c.x * r + c.y * g + c.z * b;
}
Spectrum spectrum_from_rgb(vec3 c) { return spectrum_from_rgb_unbounded(c); }
vec3 rgb_from_spectrum(Spectrum s) {
    Spectrum r, g, b;
    spectrum_primaries(r, g, b);
    const Spectrum one = Spectrum(1);
    return vec3(dot(s, r) / dot(one, r), dot(s, g) / dot(one, g), dot(s, b) / dot(one, b));
}
float luminance(Spectrum s) { return luminance(rgb_from_spectrum(s)); }
float max_component(Spectrum s) { return max(max(s.x, s.y), max(s.z, s.w)); }
float min_component(Spectrum s) { return min(min(s.x, s.y), min(s.z, s.w)); }
float average(Spectrum s) { return dot(s, Spectrum(0.25)); }
bool is_black(Spectrum s) { return s == Spectrum(0); }
bool finite(Spectrum s) { return finite(s.x + s.y + s.z + s.w); }

#else

#define Spectrum vec3

// The dominant wavelengths of the primaries.
Spectrum wavelengths() { return Spectrum(611.4, 549.1, 464.3); }
Spectrum spectrum_from_rgb(vec3 c) { return c; }
Spectrum spectrum_from_rgb_unbounded(vec3 c) { return c; }
vec3 rgb_from_spectrum(Spectrum s) { return s; }

#endif

#endif
