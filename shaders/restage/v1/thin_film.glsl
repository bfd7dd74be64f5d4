// SPDX-License-Identifier: Apache-2.0
// Iridescence of a thin film over a base: Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence", with Schlick's Fresnel terms as in KHR_materials_iridescence.
#ifndef RESTAGE_V1_THIN_FILM
#define RESTAGE_V1_THIN_FILM

#include <restage/v1/fresnel.glsl>

#ifdef RESTAGE_SPECTRAL
// Interference at a path difference [nm] and at twice it.
void thin_film_sensitivity(float path, Spectrum shift, out Spectrum once, out Spectrum twice) {
    Spectrum phase = TWO_PI * path / wavelengths() + shift;
    once = cos(phase);
    twice = cos(2.0 * phase);
}
#else
// The eye's response to a path difference [nm] and to twice it, in linear sRGB: the Fourier transform of Gaussians fitted to
// the CIE 1931 curves (Belcour and Barla 2017, sec. 4.2 and supplemental). X has two of them.
void thin_film_sensitivity(float path, Spectrum shift, out Spectrum once, out Spectrum twice) {
    float phase = TWO_PI * path * 1e-9;
    const vec4 value = vec4(5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14) / 1.0685e-7;
    const vec4 position = vec4(1.6810e+06, 1.7953e+06, 2.2084e+06, 2.2399e+06);
    const vec4 variance = vec4(4.3278e+09, 9.3046e+09, 6.6121e+09, 4.5282e+09);
    const mat3 xyz_to_rgb = mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, //
                                 -0.4985314, 0.0415560, 1.0572252);
    vec4 wave = cos(position * phase + shift.xyzx);
    vec4 decay = exp(-sqr(phase) * variance);
    vec4 height = value * sqrt(TWO_PI * variance);
    vec4 a = height * wave * decay;
    decay *= decay;
    vec4 b = height * (2.0 * wave * wave - 1.0) * decay * decay; // at twice the phase
    once = xyz_to_rgb * vec3(a.x + a.w, a.yz);
    twice = xyz_to_rgb * vec3(b.x + b.w, b.yz);
}
#endif

// Reflectance at the cosine c of a film (index, thickness [nm]) over a base that reflects f0 at normal incidence.
Spectrum thin_film_reflectance(float c, float index, float thickness, Spectrum f0) {
    float film = mix(1.0, index, smoothstep(0.0, 30.0, thickness)); // the index vanishes with the film
    float cos2 = 1.0 - (1.0 - c * c) / (film * film);
    if (cos2 <= 0.0)
        return Spectrum(1);
    float cos_t = sqrt(cos2);
    float r12 = fresnel_schlick(Spectrum(sqr((film - 1.0) / (film + 1.0))), c).x; // equal for all
    float t121 = 1.0 - r12;
    Spectrum root = sqrt(clamp(f0, Spectrum(0), Spectrum(0.9999)));
    Spectrum base = (1.0 + root) / (1.0 - root);
    Spectrum r1 = (base - film) / (base + film);
    Spectrum r23 = fresnel_schlick(r1 * r1, cos_t);
    Spectrum shift = (film < 1.0 ? 0.0 : PI) + mix(Spectrum(0), Spectrum(PI), lessThan(base, Spectrum(film)));
    Spectrum r123 = clamp(r12 * r23, Spectrum(1e-5), Spectrum(0.9999));
    Spectrum amplitude = sqrt(r123);
    Spectrum series = sqr(t121) * r23 / (1.0 - r123); // Eq. 10, all orders without their phase
    Spectrum sum = r12 + series;
    Spectrum once, twice; // higher orders are averaged out by the eye's curves
    thin_film_sensitivity(2.0 * film * thickness * cos_t, shift, once, twice); // Eq. 3
    sum += 2.0 * (series - t121) * amplitude * (once + amplitude * twice);
    return clamp(sum, Spectrum(0), Spectrum(1)); // outside the sRGB gamut some are negative
}

#endif
