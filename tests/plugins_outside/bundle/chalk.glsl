// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/sampling.glsl>

Spectrum chalk_eval(chalk_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? m.tint * INV_PI * abs_cos(wi) : Spectrum(0);
}

float chalk_pdf(chalk_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos(wi)) : 0.0;
}

BsdfSample chalk_sample(chalk_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (!positive(pdf) || wo.z == 0.0) return BSDF_NONE;
    if (wo.z < 0.0) wi.z = -wi.z;
    return BsdfSample(wi, m.tint, pdf, BSDF_REFLECT, 1.0);
}

Spectrum chalk_albedo(chalk_Params m, vec3 wo) { return m.tint; }
