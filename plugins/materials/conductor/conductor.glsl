// SPDX-License-Identifier: Apache-2.0
// Metal: microfacets with complex Fresnel reflectance (pbrt-v4 ConductorBxDF; v3 "metal"); a mirror when smooth.
#include "lib/fresnel.glsl"
#include "lib/microfacet.glsl"

vec2 conductor_alpha(conductor_Params m) { return alpha_from_roughness(m.uroughness, m.vroughness, m.remap); }

vec3 conductor_fresnel(conductor_Params m, float cos_i) {
    bool r = m.use_reflectance;
    return fresnel_conductor(cos_i, r ? vec3(1) : m.eta, r ? conductor_k_from_reflectance(m.reflectance) : m.k);
}

// Pharr et al. 2023, Eq. 9.33 (Torrance and Sparrow 1967).
vec3 conductor_eval(conductor_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = conductor_alpha(m);
    if (!same_hemisphere(wo, wi) || alpha_is_smooth(alpha))
        return vec3(0);
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    vec3 h = normalize(wo + wi);
    float sigma_o = microfacet_sigma(wo, alpha, m.distribution);
    float sigma_i = microfacet_sigma(wi, alpha, m.distribution);
    float d = microfacet_d(h, alpha, m.distribution);
    return conductor_fresnel(m, dot(wo, h)) * (0.25 * d * wi.z * smith_visibility(wo.z, sigma_o, wi.z, sigma_i));
}

float conductor_pdf(conductor_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = conductor_alpha(m);
    if (!same_hemisphere(wo, wi) || alpha_is_smooth(alpha))
        return 0.0;
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    float sigma_o = microfacet_sigma(wo, alpha, m.distribution);
    return microfacet_d(normalize(wo + wi), alpha, m.distribution) / (4.0 * sigma_o);
}

BsdfSample conductor_sample(conductor_Params m, vec3 wo, vec3 u) {
    vec2 alpha = conductor_alpha(m);
    vec3 v = vec3(wo.xy, abs(wo.z));
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    bool smooth_surface = alpha_is_smooth(alpha);
    vec3 h = smooth_surface ? vec3(0, 0, 1) : microfacet_sample(v, alpha, u.xy, m.distribution);
    vec3 wi = smooth_surface ? vec3(-v.xy, v.z) : normalize(reflect_about(v, h));
    if (v.z <= 0.0 || wi.z <= 0.0)
        return BSDF_NONE;
    vec3 weight = conductor_fresnel(m, dot(v, h));
    if (smooth_surface)
        return BsdfSample(vec3(wi.xy, side * wi.z), weight, 1.0, BSDF_REFLECT | BSDF_DELTA, 1.0);
    float sigma_o = microfacet_sigma(v, alpha, m.distribution);
    float sigma_i = microfacet_sigma(wi, alpha, m.distribution);
    weight *= wi.z * sigma_o * smith_visibility(v.z, sigma_o, wi.z, sigma_i);
    float pdf = microfacet_d(h, alpha, m.distribution) / (4.0 * sigma_o);
    if (!(pdf > 0.0))
        return BSDF_NONE;
    return BsdfSample(vec3(wi.xy, side * wi.z), weight, pdf, BSDF_REFLECT, 1.0);
}

vec3 conductor_albedo(conductor_Params m, vec3 wo) { return conductor_fresnel(m, abs(wo.z)); }
