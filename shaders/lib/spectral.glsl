// SPDX-License-Identifier: Apache-2.0
// Colours of records as what a path carries: RGB, or four wavelengths. See shared/spectral.h.
#ifndef RESTAGE_LIB_SPECTRAL
#define RESTAGE_LIB_SPECTRAL
#include <restage/v1/spectrum.glsl>
#include "lib/sampler.glsl"
#include "lib/scene.glsl"

#ifdef RESTAGE_SPECTRAL
#include "shared/spectral.h"

address spectral_coefficients, spectral_curves, spectral_film;
float path_hero;             // in [0, 1)
bool path_disperses = false; // a number of the material depends on the wavelength

// For a path whose wavelengths are chosen by this number. Before anything else here, and wavelengths().
void spectral_begin(SceneData scene, float hero) {
    spectral_coefficients = scene.spectral_coefficients;
    spectral_curves = scene.spectral_curves;
    spectral_film = scene.spectral_film;
    path_hero = hero;
    vec4 u = fract(hero + vec4(0.0, 0.25, 0.5, 0.75));
    host_wavelengths = Spectrum(visible_wavelength(u.x), visible_wavelength(u.y), visible_wavelength(u.z), visible_wavelength(u.w));
}
float hero_number(uint seed, uint sample_index) { return to_unit(sample_bits(seed, sample_index, PAIR_WAVELENGTHS).x); }

// Jakob and Hanika 2019, eq. 4.
Spectrum smooth_spectrum(vec3 c) {
    Spectrum t = (wavelengths() - 595.0) * (1.0 / 235.0);
    Spectrum x = (c.x * t + c.y) * t + c.z;
    return 0.5 + 0.5 * x * inversesqrt(1.0 + x * x);
}

float curve_at(uint curve, float nm) {
    float x = clamp(nm - float(SPECTRAL_FIRST), 0.0, float(SPECTRAL_CURVE - 1u));
    uint i = uint(x);
    vec2 v = Vec2Array(spectral_curves).at[curve * SPECTRAL_CURVE + i];
    return mix(v.x, v.y, x - float(i));
}

Spectrum stored_spectrum(vec3 stored) {
    uvec3 w = floatBitsToUint(stored);
    if (HAS_CURVES && (w.y & CURVE_BIT) != 0u) {
        Spectrum l = wavelengths();
        return stored.z * Spectrum(curve_at(w.x, l.x), curve_at(w.x, l.y), curve_at(w.x, l.z), curve_at(w.x, l.w));
    }
    return stored.z * smooth_spectrum(unpack_coefficients(w.x, w.y));
}

// At the hero wavelength.
float stored_number(uint word) {
    if (HAS_CURVES && (word & 0x7fc00000u) == CURVE_NUMBER) {
        path_disperses = true;
        return curve_at(word & 0x3fffffu, wavelengths().x);
    }
    return uintBitsToFloat(word);
}

// Where, from 0 to 1, a node of the table's brightest component lies, and the inverse.
float table_node(float x) {
    x = x * x * (3.0 - 2.0 * x);
    return x * x * (3.0 - 2.0 * x);
}
float table_place(float y) {
    y = 0.5 - sin(asin(1.0 - 2.0 * y) * (1.0 / 3.0));
    return 0.5 - sin(asin(clamp(1.0 - 2.0 * y, -1.0, 1.0)) * (1.0 / 3.0));
}

// The spectrum of a colour within [0, 1], by the table of coefficients. pbrt 4ed, 4.6.6: trilinear over the brightest
// component and the other two relative to it; greys are exact.
Spectrum table_spectrum(vec3 c) {
    float z = max_component(c);
    bool r = c.x >= z, g = !r && c.y >= z;
    vec2 others = (r ? c.yz : g ? c.zx : c.xy) / max(z, 1e-12);
    float top = float(SPECTRAL_CELLS - 1u);
    float place = clamp(table_place(z) * top, 0.0, top - 1.0);
    uvec3 cell = uvec3(min(uvec2(others * top), uvec2(SPECTRAL_CELLS - 2u)), min(uint(place), SPECTRAL_CELLS - 2u));
    float z0 = table_node(float(cell.z) / top), z1 = table_node(float(cell.z + 1u) / top);
    vec3 d = vec3(others * top - vec2(cell.xy), (z - z0) / (z1 - z0));
    uint first = (((r ? 0u : g ? 1u : 2u) * SPECTRAL_CELLS + cell.z) * SPECTRAL_CELLS + cell.y) * SPECTRAL_CELLS + cell.x;
    vec3 sum = vec3(0);
    for (uint k = 0u; k < 8u; ++k) {
        uvec3 o = uvec3(k & 1u, (k >> 1) & 1u, k >> 2);
        vec3 w = mix(1.0 - d, d, vec3(o));
        uvec2 packed = Uvec2Array(spectral_coefficients).at[first + (o.z * SPECTRAL_CELLS + o.y) * SPECTRAL_CELLS + o.x];
        sum += w.x * w.y * w.z * unpack_coefficients(packed.x, packed.y);
    }
    return min_component(c) == z ? Spectrum(z) : smooth_spectrum(sum);
}
Spectrum spectrum_from_rgb(vec3 c) { return table_spectrum(clamp(c, vec3(0), vec3(1))); }
Spectrum spectrum_from_rgb_unbounded(vec3 c) {
    c = max(c, vec3(0));
    float scale = 2.0 * max_component(c);
    return scale * table_spectrum(c / max(scale, 1e-30));
}

vec3 rgb_from_spectrum(Spectrum s) {
    uint bin = uint(path_hero * float(SPECTRAL_BINS));
    vec3 sum = vec3(0);
    for (uint k = 0u; k < 4u; ++k)
        sum += s[k] * Vec4Array(spectral_film).at[(bin + k * (SPECTRAL_BINS / 4u)) % SPECTRAL_BINS].xyz;
    return sum;
}

#else

Spectrum stored_spectrum(vec3 c) { return c; }
float stored_number(uint word) { return uintBitsToFloat(word); }

#endif

#endif
