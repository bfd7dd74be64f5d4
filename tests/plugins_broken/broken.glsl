// SPDX-License-Identifier: Apache-2.0
// A rough metal (GGX, single scattering, visible normals), correct by itself; a macro broken_<fault> makes it wrong.
#include <restage/v1/microfacet.glsl>

vec2 broken_alpha(broken_Params m) {
#ifdef broken_nan_at_alpha_0
    return vec2(m.roughness * m.roughness);
#else
    return vec2(max(m.roughness * m.roughness, 0.002));
#endif
}

float broken_pdf(broken_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return 0.0;
#ifdef broken_back_side
    if (wo.z < 0.0)
        return abs(wi.z) * INV_PI;
#endif
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, side * wo.z);
    vec3 h = normalize(v + vec3(wi.xy, side * wi.z));
    float pdf = ggx_d(h, broken_alpha(m)) / (4.0 * ggx_sigma(v, broken_alpha(m)));
#ifdef broken_pdf_factor
    return pdf * 4.0 * dot(v, h); // the density of h, not of wi
#else
    return pdf;
#endif
}

Spectrum broken_eval(broken_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    vec2 alpha = broken_alpha(m);
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, side * wo.z);
    vec3 l = vec3(wi.xy, side * wi.z);
    vec3 h = normalize(v + l);
    float f = 0.25 * ggx_d(h, alpha) * smith_visibility(v.z, ggx_sigma(v, alpha), l.z, ggx_sigma(l, alpha));
#ifdef broken_grazing_gain
    f = 0.25 * ggx_d(h, alpha) / max(v.z * l.z, 1e-4); // no shadowing
#endif
#ifdef broken_non_reciprocal
    f *= 0.5 + 0.5 * v.z;
#endif
#ifdef broken_endless
    for (float x = 0.5; x < 2.0; x = 0.5 * x + 0.25 * min(1.0, 2.0 * m.roughness + 1.0)) // stays at 0.5
        f *= 0.999 + 0.001 * sin(f);
#endif
#ifdef broken_missing_cosine
    return m.tint * f;
#else
    return m.tint * (f * l.z);
#endif
}

BsdfSample broken_sample(broken_Params m, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, side * wo.z);
    if (v.z <= 0.0)
        return BSDF_NONE;
    vec3 h = ggx_sample(v, broken_alpha(m), u.xy);
    vec3 wi = 2.0 * dot(v, h) * h - v;
    if (wi.z <= 0.0)
        return BSDF_NONE;
    wi = normalize(wi);
    wi.z *= side;
    float pdf = broken_pdf(m, wo, wi);
    if (!(pdf > 0.0))
#ifdef broken_nan_at_alpha_0
        return BsdfSample(wi, Spectrum(1), 1.0, BSDF_REFLECT, 1.0);
#else
        return BSDF_NONE;
#endif
    return BsdfSample(wi, broken_eval(m, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum broken_albedo(broken_Params m, vec3 wo) { return m.tint; }
