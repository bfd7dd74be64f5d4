// SPDX-License-Identifier: Apache-2.0
// Its reflection: Lambert, on both sides. The host handles its emission; see restage/emission.h.
#include <restage/v1/sampling.glsl>

Spectrum emissive_albedo(emissive_Params m, vec3 wo) { return clamp(m.reflectance, Spectrum(0), Spectrum(1)); }

Spectrum emissive_eval(emissive_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? emissive_albedo(m, wo) * (INV_PI * abs(wi.z)) : Spectrum(0);
}

float emissive_pdf(emissive_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs(wi.z)) : 0.0;
}

BsdfSample emissive_sample(emissive_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (wo.z < 0.0)
        wi.z = -wi.z;
    if (pdf <= 0.0 || wo.z == 0.0)
        return BSDF_NONE;
    return BsdfSample(wi, emissive_albedo(m, wo), pdf, BSDF_REFLECT, 1.0);
}
