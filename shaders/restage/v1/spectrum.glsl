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

#define Spectrum vec4

// Private to the host: the hero wavelength first, the others spread over the visible range (Wilkie et al. 2014).
Spectrum host_wavelengths = Spectrum(450.0, 520.0, 580.0, 640.0);
Spectrum wavelengths() { return host_wavelengths; }

// lib/spectral.glsl, after the plugin's code. rgb_from_spectrum is exact only on average over paths.
Spectrum spectrum_from_rgb(vec3 c);
Spectrum spectrum_from_rgb_unbounded(vec3 c);
vec3 rgb_from_spectrum(Spectrum s);

float luminance(Spectrum s) { return dot(s, Spectrum(0.25)); } // wavelengths are drawn roughly as the eye responds
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
