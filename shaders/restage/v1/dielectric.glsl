// SPDX-License-Identifier: Apache-2.0
// A rough dielectric interface: reflection and transmission of one microfacet layer, in radiance transport.
// wo.z > 0; eta = ior below / ior above. From below the surface, mirror z and pass 1 / eta.
#ifndef RESTAGE_V1_DIELECTRIC
#define RESTAGE_V1_DIELECTRIC

#include <restage/v1/fresnel.glsl>
#include <restage/v1/microfacet.glsl>

// Nearly equal indices do not bend light and leave the half vector of transmission without a direction.
bool dielectric_is_smooth(vec2 alpha, float eta) { return alpha_is_smooth(alpha) || abs(eta - 1.0) < 1e-3; }

// x: f |cos wi|, y: density of wi if the half vector is a visible normal; both without the Fresnel factor, which is a
// function of ho, the cosine between wo and the half vector (0 where the value is). Reflection does not depend on eta.
// Walter et al. 2007, Eqs. 20, 21 and 17, with sigma as in microfacet.glsl; 1/eta^2: Veach 1997, sec. 5.2.
vec2 rough_interface(vec3 wo, vec3 wi, vec2 alpha, float eta, int distribution, out float ho) {
    ho = 0.0;
    bool reflects = wi.z > 0.0;
    vec3 h = reflects ? wo + wi : wo + eta * wi;
    float l2 = dot(h, h);
    if (wo.z <= 0.0 || wi.z == 0.0 || l2 < 1e-12)
        return vec2(0);
    h *= (h.z < 0.0 ? -1.0 : 1.0) * inversesqrt(l2);
    float hi = dot(wi, h);
    if (dot(wo, h) <= 0.0 || (hi > 0.0) != reflects)
        return vec2(0);
    ho = dot(wo, h);
    float ci = abs(wi.z);
    float sigma_o = microfacet_sigma(wo, alpha, distribution);
    float sigma_i = microfacet_sigma(vec3(wi.xy, ci), alpha, distribution);
    float jacobian = reflects ? 0.25 : -ho * hi / max(sqr(hi + ho / eta), 1e-20);
    float d = microfacet_d(h, alpha, distribution) * jacobian;
    float scale = reflects ? 1.0 : 1.0 / (eta * eta);
    return d * vec2(ci * smith_visibility(wo.z, sigma_o, ci, sigma_i) * scale, 1.0 / sigma_o);
}

// x: f |cos wi| without tint, y: density of rough_dielectric_sample; both include F or 1 - F.
vec2 rough_dielectric(vec3 wo, vec3 wi, vec2 alpha, float eta, int distribution) {
    float ho;
    vec2 value = rough_interface(wo, wi, alpha, eta, distribution, ho);
    float fresnel = fresnel_dielectric(ho, eta);
    return value * (wi.z > 0.0 ? fresnel : 1.0 - fresnel);
}

// Visible normal by u.xy, then reflection with probability F by u.z. Returns f |cos| / pdf without tint; 0 = absorbed.
float rough_dielectric_sample(vec3 wo, vec2 alpha, float eta, int distribution, vec3 u, out vec3 wi, out float pdf) {
    vec3 h = microfacet_sample(wo, alpha, u.xy, distribution);
    float ho = dot(wo, h);
    float cos_t;
    float fresnel = fresnel_dielectric(max(ho, 0.0), eta, cos_t);
    bool reflects = u.z < fresnel;
    wi = normalize(reflects ? reflect_about(wo, h) : refract_about(wo, h, ho, cos_t, eta));
    pdf = 0.0;
    if (wo.z <= 0.0 || ho <= 0.0 || wi.z == 0.0 || (wi.z > 0.0) != reflects)
        return 0.0;
    float ci = abs(wi.z);
    float sigma_o = microfacet_sigma(wo, alpha, distribution);
    float sigma_i = microfacet_sigma(vec3(wi.xy, ci), alpha, distribution);
    float hi = dot(wi, h);
    float jacobian = reflects ? 0.25 * fresnel : -ho * hi / max(sqr(hi + ho / eta), 1e-20) * (1.0 - fresnel);
    pdf = microfacet_d(h, alpha, distribution) * jacobian / sigma_o;
    if (!positive(pdf))
        return 0.0;
    return ci * smith_visibility(wo.z, sigma_o, ci, sigma_i) * sigma_o * (reflects ? 1.0 : 1.0 / (eta * eta));
}

#endif
