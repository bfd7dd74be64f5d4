// SPDX-License-Identifier: Apache-2.0
// Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model", in pbrt-v3's form (FresnelBlend, sec. 8.5): a diffuse
// base under a glossy coat, with GGX for the distribution and no shadowing.
#include <restage/v1/fresnel.glsl>
#include <restage/v1/microfacet.glsl>
#include <restage/v1/sampling.glsl>

vec2 substrate_alpha(substrate_Params m) {
    return max(alpha_from_roughness(m.uroughness, m.vroughness, m.remap), 1e-3);
}

// x -> 1 - (1 - x / 2)^5, multiplied out: the difference would cancel at grazing angles.
float substrate_fade(float x) {
    float t = 0.5 * x;
    return t * (5.0 + t * (-10.0 + t * (10.0 + t * (-5.0 + t))));
}

// pbrt-v3, Eqs. 8.20 (diffuse) and 8.21 (specular).
Spectrum substrate_eval(substrate_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    Spectrum kd = clamp(m.kd, Spectrum(0), Spectrum(1));
    Spectrum ks = clamp(m.ks, Spectrum(0), Spectrum(1));
    vec3 h = normalize(wo + wi);
    float hi = max(dot(wi, h), 1e-6);
    Spectrum diffuse = kd * (1.0 - ks) * (28.0 / 23.0 * INV_PI * substrate_fade(wi.z) * substrate_fade(wo.z));
    float specular = ggx_d(h, substrate_alpha(m)) / (4.0 * hi * max(wi.z, wo.z));
    return (diffuse + specular * fresnel_schlick(ks, hi)) * wi.z;
}

// Half cosine, half visible normals.
float substrate_pdf(substrate_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return 0.0;
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    vec2 alpha = substrate_alpha(m);
    return 0.5 * (cosine_hemisphere_pdf(wi.z) + ggx_d(normalize(wo + wi), alpha) / (4.0 * ggx_sigma(wo, alpha)));
}

BsdfSample substrate_sample(substrate_Params m, vec3 wo, vec3 u) {
    vec3 v = vec3(wo.xy, abs(wo.z));
    vec3 wi = u.z < 0.5 ? sample_cosine_hemisphere(u.xy)
                        : normalize(reflect_about(v, ggx_sample(v, substrate_alpha(m), u.xy)));
    if (v.z == 0.0 || wi.z <= 0.0)
        return BSDF_NONE;
    float pdf = substrate_pdf(m, v, wi);
    Spectrum weight = substrate_eval(m, v, wi) / pdf;
    return BsdfSample(vec3(wi.xy, wo.z < 0.0 ? -wi.z : wi.z), weight, pdf, BSDF_REFLECT, 1.0);
}

// Exact for the diffuse part (the purpose of 28/23); ignores the specular part's loss at high roughness.
Spectrum substrate_albedo(substrate_Params m, vec3 wo) {
    Spectrum ks = clamp(m.ks, Spectrum(0), Spectrum(1));
    Spectrum diffuse = clamp(m.kd, Spectrum(0), Spectrum(1)) * (1.0 - ks) * substrate_fade(abs(wo.z));
    return diffuse + fresnel_schlick(ks, abs(wo.z));
}
