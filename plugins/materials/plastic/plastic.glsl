// SPDX-License-Identifier: Apache-2.0
// pbrt-v3 "plastic": Lambert plus GGX microfacets with dielectric Fresnel, simply added.
#include <restage/v1/fresnel.glsl>
#include <restage/v1/microfacet.glsl>
#include <restage/v1/sampling.glsl>

float plastic_alpha(plastic_Params m) { return max(alpha_from_roughness(m.roughness, m.roughness, m.remap).x, 1e-3); }

// pbrt-v3 builds its Fresnel term as (1.5, 1), the light arriving inside the plastic: total reflection beyond 42
// degrees on the front. This is v3's behaviour, so it is kept; from the back the indices are swapped.
float plastic_eta(vec3 wo) { return wo.z > 0.0 ? 1.0 / 1.5 : 1.5; }

// Probability of the glossy lobe.
float plastic_glossy(plastic_Params m, vec3 wo) {
    float s = clamp(max_component(m.ks), 0.0, 1.0) * (0.1 + 0.9 * fresnel_dielectric(abs(wo.z), plastic_eta(wo)));
    float d = clamp(max_component(m.kd), 0.0, 1.0);
    return s + d > 0.0 ? s / (s + d) : 0.0;
}

Spectrum plastic_eval(plastic_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    vec2 alpha = vec2(plastic_alpha(m));
    vec3 o = vec3(wo.xy, abs(wo.z));
    vec3 i = vec3(wi.xy, abs(wi.z));
    vec3 h = normalize(o + i);
    float gloss = 0.25 * ggx_d(h, alpha) * smith_visibility(o.z, ggx_sigma(o, alpha), i.z, ggx_sigma(i, alpha)) *
                  fresnel_dielectric(dot(i, h), plastic_eta(wo));
    return (clamp(m.kd, Spectrum(0), Spectrum(1)) * INV_PI + clamp(m.ks, Spectrum(0), Spectrum(1)) * gloss) * i.z;
}

float plastic_pdf(plastic_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return 0.0;
    vec2 alpha = vec2(plastic_alpha(m));
    vec3 o = vec3(wo.xy, abs(wo.z));
    vec3 i = vec3(wi.xy, abs(wi.z));
    return mix(cosine_hemisphere_pdf(i.z), ggx_d(normalize(o + i), alpha) / (4.0 * ggx_sigma(o, alpha)),
               plastic_glossy(m, wo));
}

BsdfSample plastic_sample(plastic_Params m, vec3 wo, vec3 u) {
    vec3 v = vec3(wo.xy, abs(wo.z));
    vec3 wi = u.z >= plastic_glossy(m, wo) ? sample_cosine_hemisphere(u.xy)
                                           : normalize(reflect_about(v, ggx_sample(v, vec2(plastic_alpha(m)), u.xy)));
    if (v.z == 0.0 || wi.z <= 0.0)
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    float pdf = plastic_pdf(m, wo, wi);
    if (!positive(pdf))
        return BSDF_NONE;
    return BsdfSample(wi, plastic_eval(m, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum plastic_albedo(plastic_Params m, vec3 wo) {
    return clamp(m.kd + m.ks * fresnel_dielectric(abs(wo.z), plastic_eta(wo)), Spectrum(0), Spectrum(1));
}
