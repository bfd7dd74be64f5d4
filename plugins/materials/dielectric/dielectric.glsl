// SPDX-License-Identifier: Apache-2.0
// Glass, water: smooth, rough or thin (pbrt-v4 DielectricBxDF and ThinDielectricBxDF; v3 "glass" with its two tints).
#include "lib/dielectric.glsl"

// As in pbrt-v3's glass, a roughness of 0 is smooth whatever the remapping makes of it.
vec2 dielectric_alpha(dielectric_Params m) {
    if (m.uroughness == 0.0 && m.vroughness == 0.0)
        return vec2(0);
    return alpha_from_roughness(m.uroughness, m.vroughness, m.remap);
}

// Index on the far side of the surface relative to wo's side.
float dielectric_eta(dielectric_Params m, vec3 wo) {
    float eta = m.eta > 0.0 ? m.eta : 1.0;
    return wo.z < 0.0 && !m.thin ? 1.0 / eta : eta;
}

vec2 dielectric_value_pdf(dielectric_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = dielectric_alpha(m);
    float eta = dielectric_eta(m, wo);
    if (m.thin || dielectric_is_smooth(alpha, eta))
        return vec2(0);
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    return rough_dielectric(vec3(wo.xy, side * wo.z), vec3(wi.xy, side * wi.z), alpha, eta, m.distribution);
}

vec3 dielectric_tint(dielectric_Params m, bool reflects) {
    return clamp(reflects ? m.reflectance : m.transmittance, vec3(0), vec3(1));
}

vec3 dielectric_eval(dielectric_Params m, vec3 wo, vec3 wi) {
    return dielectric_tint(m, same_hemisphere(wo, wi)) * dielectric_value_pdf(m, wo, wi).x;
}

float dielectric_pdf(dielectric_Params m, vec3 wo, vec3 wi) { return dielectric_value_pdf(m, wo, wi).y; }

BsdfSample dielectric_sample(dielectric_Params m, vec3 wo, vec3 u) {
    vec2 alpha = dielectric_alpha(m);
    float eta = dielectric_eta(m, wo);
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, abs(wo.z));
    if (v.z == 0.0)
        return BSDF_NONE;
    vec3 wi;
    float pdf;
    float weight;
    bool delta = m.thin || dielectric_is_smooth(alpha, eta);
    if (delta) {
        float cos_t;
        float r = fresnel_dielectric(v.z, eta, cos_t);
        if (m.thin)
            r = 2.0 * r / (1.0 + r); // R + T^2 R / (1 - R^2): Stokes 1862; Pharr et al. 2023, Eq. 9.10
        bool reflects = u.z < r;
        pdf = reflects ? r : 1.0 - r;
        wi = reflects ? vec3(-v.xy, v.z) : m.thin ? -v : normalize(vec3(-v.xy / eta, -cos_t));
        weight = reflects || m.thin ? 1.0 : 1.0 / (eta * eta);
        if (!reflects && wi.z == 0.0)
            return BSDF_NONE;
    } else {
        weight = rough_dielectric_sample(v, alpha, eta, m.distribution, u, wi, pdf);
        if (weight <= 0.0)
            return BSDF_NONE;
    }
    bool reflects = wi.z > 0.0;
    uint flags = (reflects ? BSDF_REFLECT : BSDF_TRANSMIT) | (delta ? BSDF_DELTA : 0u);
    wi.z *= side;
    return BsdfSample(wi, dielectric_tint(m, reflects) * weight, pdf, flags, reflects || m.thin ? 1.0 : eta);
}

vec3 dielectric_albedo(dielectric_Params m, vec3 wo) {
    float r = fresnel_dielectric(abs(wo.z), dielectric_eta(m, wo));
    return mix(dielectric_tint(m, false), dielectric_tint(m, true), m.thin ? 2.0 * r / (1.0 + r) : r);
}
