// SPDX-License-Identifier: Apache-2.0
// Anisotropic microfacet distributions (GGX, Beckmann) with Smith shadowing and visible-normal sampling.
//
// Everything is expressed by sigma(w) = cos(w) * (1 + Lambda(w)), the microsurface area that w sees (Heitz 2014, Eq. 26
// with G1 = 1 / (1 + Lambda)), because sigma stays finite at grazing angles where Lambda does not. With co, ci > 0:
//   density of visible normals   D_w(h) = D(h) <w,h> / sigma(w)                                     Heitz 2014, Eq. 16
//   G2 / (co ci)                 = 1 / (ci sigma_o + co sigma_i - co ci)   (height-correlated)      Heitz 2014, Eq. 99
//   reflection                   f ci = D F ci V / 4, density D / (4 sigma_o), weight F ci V sigma_o
// Directions passed here have z > 0.
#ifndef RESTAGE_V1_MICROFACET
#define RESTAGE_V1_MICROFACET

#include <restage/v1/bsdf.glsl>

const float ALPHA_SMOOTH = 1e-3; // below this a surface is a mirror (pbrt-v4, EffectivelySmooth)
const int REMAP_V4 = 0;          // choices of every `remap` parameter: "v4|v3|none"
const int REMAP_V3 = 1;
const int DISTRIBUTION_GGX = 0; // choices of every `distribution` parameter: "ggx|beckmann"
const int DISTRIBUTION_BECKMANN = 1;

bool alpha_is_smooth(vec2 alpha) { return min(alpha.x, alpha.y) < ALPHA_SMOOTH; }

// pbrt-v4: sqrt; pbrt-v3: its polynomial in ln(roughness), at least 0.001 there; else alpha itself, up to the maximum of v3's
// polynomial.
vec2 alpha_from_roughness(float u, float v, int remap) {
    vec2 r = clamp(vec2(u, v), 0.0, 1.0);
    if (remap == REMAP_V4)
        return sqrt(r);
    if (remap == REMAP_V3) {
        vec2 x = log(max(r, 1e-3));
        return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
    }
    return clamp(vec2(u, v), 0.0, 1.62142);
}

// Trowbridge and Reitz 1975; Walter et al. 2007, Eq. 33; anisotropic: Heitz 2014, Eq. 85.
float ggx_d(vec3 h, vec2 alpha) {
    vec2 s = h.xy / alpha;
    return 1.0 / (PI * alpha.x * alpha.y * sqr(dot(s, s) + h.z * h.z));
}
// Heitz 2014, Eqs. 86 and 72.
float ggx_sigma(vec3 w, vec2 alpha) { return 0.5 * (w.z + length(vec3(alpha * w.xy, w.z))); }
// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
vec3 ggx_sample(vec3 w, vec2 alpha, vec2 u) {
    vec3 s = normalize(vec3(alpha * w.xy, w.z));
    float phi = TWO_PI * u.x;
    float z = (1.0 - u.y) * (1.0 + s.z) - s.z;
    vec3 c = vec3(sqrt(max(0.0, 1.0 - z * z)) * vec2(cos(phi), sin(phi)), z) + s;
    return normalize(vec3(alpha * c.xy, max(c.z, 1e-7)));
}

// exp(x^2) * erfc(x), x >= 0: Abramowitz and Stegun 7.1.26, |error of erf| <= 1.5e-7.
float erfcx_positive(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * x);
    return t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
}
// Giles 2010, "Approximating the erfinv function", table 5.
float erf_inverse(float x) {
    float w = -log(max(1.0 - x * x, 1e-20));
    bool central = w < 5.0;
    w = central ? w - 2.5 : sqrt(w) - 3.0;
    float p = central ? 2.81022636e-08 : -0.000200214257;
    p = p * w + (central ? 3.43273939e-07 : 0.000100950558);
    p = p * w + (central ? -3.5233877e-06 : 0.00134934322);
    p = p * w + (central ? -4.39150654e-06 : -0.00367342844);
    p = p * w + (central ? 0.00021858087 : 0.00573950773);
    p = p * w + (central ? -0.00125372503 : -0.0076224613);
    p = p * w + (central ? -0.00417768164 : 0.00943887047);
    p = p * w + (central ? 0.246640727 : 1.00167406);
    p = p * w + (central ? 1.50140941 : 2.83297682);
    return p * x;
}

// Beckmann and Spizzichino 1963; Walter et al. 2007, Eq. 25.
float beckmann_d(vec3 h, vec2 alpha) {
    float z2 = max(h.z * h.z, 1e-12);
    vec2 s = h.xy / alpha;
    return exp(-dot(s, s) / z2) / (PI * alpha.x * alpha.y * z2 * z2);
}
// Exact Lambda (Walter et al. 2007, Eq. 26 before its rational fit): (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)).
float beckmann_sigma(vec3 w, vec2 alpha) {
    float t = length(alpha * w.xy);
    float a = w.z / max(t, 1e-12);
    return w.z + max(0.0, exp(-min(a * a, 80.0)) * (t * 0.28209479 - 0.5 * w.z * erfcx_positive(a)));
}
// Visible slopes of unit roughness (Heitz and d'Eon 2014, supplemental, Eq. 24), inverted by bracketed Newton steps in
// the domain of erf (Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution").
vec3 beckmann_sample(vec3 w, vec2 alpha, vec2 u) {
    vec3 s = normalize(vec3(alpha * w.xy, w.z));
    float sin_theta = length(s.xy);
    vec2 dir = sin_theta > 1e-6 ? s.xy / sin_theta : vec2(1, 0);
    float t = sin_theta / max(s.z, 1e-6); // tan
    float a = 1.0 / max(t, 1e-6);         // cot
    float upper = 1.0 - exp(-min(a * a, 80.0)) * erfcx_positive(a); // erf(cot)
    const float inv_sqrt_pi = 0.56418958;
    float total = 1.0 + upper + inv_sqrt_pi * t * exp(-min(a * a, 80.0));
    float target = max(u.x, 1e-6) * total;
    float lo = -1.0;
    float hi = upper;
    float theta = acos(clamp(s.z, 0.0, 1.0));
    float fit = 1.0 + theta * (-0.876 + theta * (0.4265 - 0.0594 * theta));
    float b = upper - (1.0 + upper) * pow(1.0 - max(u.x, 1e-6), fit);
    float x = 0.0;
    for (int i = 0; i < 10; ++i) {
        if (is_nan(b) || b < lo || b > hi)
            b = 0.5 * (lo + hi);
        x = erf_inverse(clamp(b, -0.9999999, 0.9999999));
        float excess = 1.0 + b + inv_sqrt_pi * t * exp(-x * x) - target;
        if (abs(excess) < 2e-6 * total)
            break;
        if (excess > 0.0)
            hi = b;
        else
            lo = b;
        b -= excess / (1.0 - x * t);
    }
    float y = erf_inverse(clamp(2.0 * u.y - 1.0, -0.9999999, 0.9999999));
    vec2 slope = vec2(dir.x * x - dir.y * y, dir.y * x + dir.x * y);
    return normalize(vec3(-alpha * slope, 1.0));
}

// Either distribution.
float microfacet_d(vec3 h, vec2 alpha, int distribution) {
    return distribution == DISTRIBUTION_BECKMANN ? beckmann_d(h, alpha) : ggx_d(h, alpha);
}
float microfacet_sigma(vec3 w, vec2 alpha, int distribution) {
    return distribution == DISTRIBUTION_BECKMANN ? beckmann_sigma(w, alpha) : ggx_sigma(w, alpha);
}
vec3 microfacet_sample(vec3 w, vec2 alpha, vec2 u, int distribution) {
    if (distribution == DISTRIBUTION_BECKMANN)
        return beckmann_sample(w, alpha, u);
    return ggx_sample(w, alpha, u);
}
// G2 / (co ci)
float smith_visibility(float co, float sigma_o, float ci, float sigma_i) {
    return 1.0 / max(ci * sigma_o + co * sigma_i - co * ci, 1e-20);
}

#endif
