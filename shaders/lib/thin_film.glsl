// SPDX-License-Identifier: Apache-2.0
// Iridescence of a thin film over a base: Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence", with Schlick's Fresnel terms as KHR_materials_iridescence has it.
#ifndef RESTAGE_LIB_THIN_FILM
#define RESTAGE_LIB_THIN_FILM

#include "lib/fresnel.glsl"

// The eye's answer to a path difference [nm], linear sRGB: the Fourier transform of Gaussians fitted to the CIE 1931
// curves (Belcour and Barla 2017, sec. 4.2 and supplemental).
vec3 thin_film_sensitivity(float path, vec3 shift) {
    float phase = TWO_PI * path * 1e-9;
    const vec3 value = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const vec3 position = vec3(1.6810e+06, 1.7953e+06, 2.2084e+06);
    const vec3 variance = vec3(4.3278e+09, 9.3046e+09, 6.6121e+09);
    vec3 xyz = value * sqrt(TWO_PI * variance) * cos(position * phase + shift) * exp(-sqr(phase) * variance);
    xyz.x += 9.7470e-14 * sqrt(TWO_PI * 4.5282e+09) * cos(2.2399e+06 * phase + shift.x) * exp(-4.5282e+09 * sqr(phase));
    xyz /= 1.0685e-7;
    const mat3 xyz_to_rgb = mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, //
                                 -0.4985314, 0.0415560, 1.0572252);
    return xyz_to_rgb * xyz;
}

// Reflectance under the cosine c of a film (index, thickness [nm]) over a base that reflects f0 head on.
vec3 thin_film_reflectance(float c, float index, float thickness, vec3 f0) {
    float film = mix(1.0, index, smoothstep(0.0, 30.0, thickness)); // a film that vanishes has no index of its own
    float cos2 = 1.0 - (1.0 - c * c) / (film * film);
    if (cos2 <= 0.0)
        return vec3(1);
    float cos_t = sqrt(cos2);
    float r12 = fresnel_schlick(vec3(sqr((film - 1.0) / (film + 1.0))), c).x;
    float t121 = 1.0 - r12;
    vec3 root = sqrt(clamp(f0, vec3(0), vec3(0.9999)));
    vec3 base = (1.0 + root) / (1.0 - root);
    vec3 r1 = (base - film) / (base + film);
    vec3 r23 = fresnel_schlick(r1 * r1, cos_t);
    vec3 shift = (film < 1.0 ? 0.0 : PI) + mix(vec3(0), vec3(PI), lessThan(base, vec3(film)));
    vec3 r123 = clamp(r12 * r23, vec3(1e-5), vec3(0.9999));
    vec3 amplitude = sqrt(r123);
    vec3 series = sqr(t121) * r23 / (1.0 - r123); // Eq. 10, all orders without their phase
    vec3 sum = r12 + series;
    vec3 order = series - t121;
    float path = 2.0 * film * thickness * cos_t; // Eq. 3
    for (int m = 1; m <= 2; ++m) { // higher orders are averaged away by the eye's curves
        order *= amplitude;
        sum += order * 2.0 * thin_film_sensitivity(float(m) * path, float(m) * shift);
    }
    return clamp(sum, vec3(0), vec3(1)); // outside sRGB's triangle some are negative
}

#endif
