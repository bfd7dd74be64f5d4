// SPDX-License-Identifier: Apache-2.0
// pbrt-v3 "uber": Lambert (kd), GGX gloss (ks), mirror (kr) and refraction (kt), all scaled by opacity, simply added;
// the rest passes straight through.
#include <restage/v1/fresnel.glsl>
#include <restage/v1/microfacet.glsl>
#include <restage/v1/sampling.glsl>

vec2 uber_alpha(uber_Params m) { return max(alpha_from_roughness(m.uroughness, m.vroughness, m.remap), 1e-3); }
float uber_eta(uber_Params m, vec3 wo) {
    float eta = m.eta > 0.0 ? m.eta : 1.0;
    return wo.z > 0.0 ? eta : 1.0 / eta;
}
Spectrum uber_opacity(uber_Params m) { return clamp(m.opacity, Spectrum(0), Spectrum(1)); }

// Probabilities of the lobes: x diffuse, y glossy, z mirror, w refraction; the rest passes through.
vec4 uber_choice(uber_Params m, float fresnel) {
    Spectrum o = uber_opacity(m);
    vec4 p = vec4(max_component(clamp(m.kd, Spectrum(0), Spectrum(1)) * o),
                  max_component(clamp(m.ks, Spectrum(0), Spectrum(1)) * o) * (0.1 + 0.9 * fresnel),
                  max_component(clamp(m.kr, Spectrum(0), Spectrum(1)) * o) * fresnel,
                  max_component(clamp(m.kt, Spectrum(0), Spectrum(1)) * o) * (1.0 - fresnel));
    float through = max_component(1.0 - o);
    return p / max(dot(p, vec4(1)) + through, 1e-20);
}

Spectrum uber_eval(uber_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    vec2 alpha = uber_alpha(m);
    vec3 o = vec3(wo.xy, abs(wo.z));
    vec3 i = vec3(wi.xy, abs(wi.z));
    vec3 h = normalize(o + i);
    float gloss = 0.25 * ggx_d(h, alpha) * smith_visibility(o.z, ggx_sigma(o, alpha), i.z, ggx_sigma(i, alpha)) *
                  fresnel_dielectric(dot(i, h), uber_eta(m, wo));
    return uber_opacity(m) *
           (clamp(m.kd, Spectrum(0), Spectrum(1)) * INV_PI + clamp(m.ks, Spectrum(0), Spectrum(1)) * gloss) * i.z;
}

float uber_pdf(uber_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return 0.0;
    vec2 alpha = uber_alpha(m);
    vec3 o = vec3(wo.xy, abs(wo.z));
    vec3 i = vec3(wi.xy, abs(wi.z));
    vec4 p = uber_choice(m, fresnel_dielectric(o.z, uber_eta(m, wo)));
    return p.x * cosine_hemisphere_pdf(i.z) + p.y * ggx_d(normalize(o + i), alpha) / (4.0 * ggx_sigma(o, alpha));
}

BsdfSample uber_sample(uber_Params m, vec3 wo, vec3 u) {
    vec3 v = vec3(wo.xy, abs(wo.z));
    if (v.z == 0.0)
        return BSDF_NONE;
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    float eta = uber_eta(m, wo);
    float cos_t;
    float fresnel = fresnel_dielectric(v.z, eta, cos_t);
    Spectrum o = uber_opacity(m);
    vec4 p = uber_choice(m, fresnel);
    vec3 wi;
    if (u.z < p.x + p.y) {
        wi = u.z < p.x ? sample_cosine_hemisphere(u.xy)
                       : normalize(reflect_about(v, ggx_sample(v, uber_alpha(m), u.xy)));
        if (wi.z <= 0.0)
            return BSDF_NONE;
        wi.z *= side;
        float pdf = uber_pdf(m, wo, wi);
        if (!positive(pdf))
            return BSDF_NONE;
        return BsdfSample(wi, uber_eval(m, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
    }
    if (u.z < p.x + p.y + p.z)
        return BsdfSample(vec3(-wo.xy, wo.z), o * clamp(m.kr, Spectrum(0), Spectrum(1)) * (fresnel / p.z), p.z,
                          BSDF_REFLECT | BSDF_DELTA, 1.0);
    if (u.z < p.x + p.y + p.z + p.w) {
        wi = normalize(vec3(-v.xy / eta, -max(cos_t, 1e-6)));
        wi.z *= side;
        Spectrum weight = o * clamp(m.kt, Spectrum(0), Spectrum(1)) * ((1.0 - fresnel) / (p.w * eta * eta));
        return BsdfSample(wi, weight, p.w, BSDF_TRANSMIT | BSDF_DELTA, eta);
    }
    float through = 1.0 - dot(p, vec4(1));
    if (is_nan(through) || through <= 1e-6)
        return BSDF_NONE;
    return BsdfSample(-wo, (1.0 - o) / through, through, BSDF_TRANSMIT | BSDF_DELTA, 1.0);
}

Spectrum uber_albedo(uber_Params m, vec3 wo) {
    float f = fresnel_dielectric(abs(wo.z), uber_eta(m, wo));
    Spectrum o = uber_opacity(m);
    return clamp(o * (m.kd + (m.ks + m.kr) * f + m.kt * (1.0 - f)) + 1.0 - o, Spectrum(0), Spectrum(1));
}
