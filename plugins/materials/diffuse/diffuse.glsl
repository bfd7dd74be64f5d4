// SPDX-License-Identifier: Apache-2.0
// Lambert, or Oren-Nayar when sigma > 0.
#include <restage/v1/sampling.glsl>

// Oren and Nayar 1994, Eq. 30 (the qualitative model; pbrt-v3, sec. 8.4.1). sin(alpha) tan(beta) cos(dphi) is
// dot(wo.xy, wi.xy) / max(co, ci): the sines of the two cases cancel.
Spectrum diffuse_eval(diffuse_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    float scale = INV_PI * abs(wi.z);
    if (m.sigma > 0.0) {
        float s2 = sqr(radians(min(m.sigma, 90.0)));
        float b = 0.45 * s2 / (s2 + 0.09) * max(0.0, dot(wo.xy, wi.xy)) / max(max(abs(wo.z), abs(wi.z)), 1e-6);
        scale *= 1.0 - 0.5 * s2 / (s2 + 0.33) + b;
    }
    return clamp(m.reflectance, Spectrum(0), Spectrum(1)) * scale;
}

float diffuse_pdf(diffuse_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs(wi.z)) : 0.0;
}

BsdfSample diffuse_sample(diffuse_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (wo.z < 0.0)
        wi.z = -wi.z;
    if (pdf <= 0.0 || wo.z == 0.0)
        return BSDF_NONE;
    return BsdfSample(wi, diffuse_eval(m, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum diffuse_albedo(diffuse_Params m, vec3 wo) { return clamp(m.reflectance, Spectrum(0), Spectrum(1)); }
