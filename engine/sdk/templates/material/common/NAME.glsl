// @LABEL@: Lambert's diffuse reflection, f = tint / pi, to begin with. <restage/material.h> states the
// requirements of the four functions; `restage check` tests them.
#include <restage/v1/sampling.glsl>

Spectrum @NAME@_eval(@NAME@_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? m.tint * INV_PI * abs_cos(wi) : Spectrum(0);
}

float @NAME@_pdf(@NAME@_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos(wi)) : 0.0;
}

BsdfSample @NAME@_sample(@NAME@_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (!positive(pdf) || wo.z == 0.0)
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z; // from the back: both sides behave the same
    return BsdfSample(wi, m.tint, pdf, BSDF_REFLECT, 1.0);
}

Spectrum @NAME@_albedo(@NAME@_Params m, vec3 wo) { return m.tint; }
