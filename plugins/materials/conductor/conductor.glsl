// SPDX-License-Identifier: Apache-2.0
// Metal: microfacets with complex Fresnel reflectance (pbrt-v4 ConductorBxDF; v3 "metal"); a mirror when smooth.
// With `multiscatter`, light scattered between a rough metal's microfacets is restored.
#include <restage/v1/multiscatter.glsl>
#include <restage/v1/sampling.glsl>

vec2 conductor_alpha(conductor_Params m) { return alpha_from_roughness(m.uroughness, m.vroughness, m.remap); }

// The index, real and imaginary part.
Spectrum conductor_eta(conductor_Params m) { return m.use_reflectance ? Spectrum(1) : m.eta; }
Spectrum conductor_k(conductor_Params m) {
    return m.use_reflectance ? conductor_k_from_reflectance(m.reflectance) : m.k;
}
Spectrum conductor_fresnel(conductor_Params m, float cos_i) {
    return fresnel_conductor(cos_i, conductor_eta(m), conductor_k(m));
}

// For light reflected more than once; the density of such samples follows its mean fraction of all light.
Spectrum conductor_multiple(conductor_Params m, vec2 alpha, out float share) {
    share = 0.0;
    if (!m.multiscatter)
        return Spectrum(0);
    float lost = microfacet_mean_loss(alpha, m.distribution);
    Spectrum mean = fresnel_conductor_average(conductor_eta(m), conductor_k(m));
    Spectrum color = multiscatter_color(mean, lost);
    float most = max_component(color) * lost;
    share = most / max(most + max_component(mean) * (1.0 - lost), 1e-20);
    return color;
}

// Pharr et al. 2023, Eq. 9.33 (Torrance and Sparrow 1967); wo.z, wi.z > 0.
Spectrum conductor_single(conductor_Params m, vec3 wo, vec3 wi, vec2 alpha, out float pdf) {
    vec3 h = normalize(wo + wi);
    float sigma_o = microfacet_sigma(wo, alpha, m.distribution);
    float sigma_i = microfacet_sigma(wi, alpha, m.distribution);
    float d = microfacet_d(h, alpha, m.distribution);
    pdf = d / (4.0 * sigma_o);
    return conductor_fresnel(m, dot(wo, h)) * (0.25 * d * wi.z * smith_visibility(wo.z, sigma_o, wi.z, sigma_i));
}

Spectrum conductor_value(conductor_Params m, vec3 wo, vec3 wi, vec2 alpha, out float pdf) {
    float share;
    Spectrum color = conductor_multiple(m, alpha, share);
    Spectrum f = conductor_single(m, wo, wi, alpha, pdf);
    if (share > 0.0) {
        float lost = microfacet_mean_loss(alpha, m.distribution);
        f += color * multiscatter_reflection(wo, wi, alpha, lost, m.distribution);
        pdf = mix(pdf, cosine_hemisphere_pdf(wi.z), share);
    }
    return f;
}

Spectrum conductor_eval(conductor_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = conductor_alpha(m);
    float pdf;
    if (!same_hemisphere(wo, wi) || alpha_is_smooth(alpha))
        return Spectrum(0);
    return conductor_value(m, vec3(wo.xy, abs(wo.z)), vec3(wi.xy, abs(wi.z)), alpha, pdf);
}

float conductor_pdf(conductor_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = conductor_alpha(m);
    if (!same_hemisphere(wo, wi) || alpha_is_smooth(alpha))
        return 0.0;
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    float sigma_o = microfacet_sigma(wo, alpha, m.distribution);
    float pdf = microfacet_d(normalize(wo + wi), alpha, m.distribution) / (4.0 * sigma_o);
    float share;
    conductor_multiple(m, alpha, share);
    return mix(pdf, cosine_hemisphere_pdf(wi.z), share);
}

BsdfSample conductor_sample(conductor_Params m, vec3 wo, vec3 u) {
    vec2 alpha = conductor_alpha(m);
    vec3 v = vec3(wo.xy, abs(wo.z));
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    bool smooth_surface = alpha_is_smooth(alpha);
    float share;
    conductor_multiple(m, alpha, share);
    bool multiple = !smooth_surface && u.z < share;
    vec3 h = smooth_surface || multiple ? vec3(0, 0, 1) : microfacet_sample(v, alpha, u.xy, m.distribution);
    vec3 wi = smooth_surface ? vec3(-v.xy, v.z) : normalize(reflect_about(v, h));
    if (multiple)
        wi = sample_cosine_hemisphere(u.xy);
    if (v.z <= 0.0 || wi.z <= 0.0)
        return BSDF_NONE;
    if (smooth_surface) {
        Spectrum weight = conductor_fresnel(m, dot(v, h));
        return BsdfSample(vec3(wi.xy, side * wi.z), weight, 1.0, BSDF_REFLECT | BSDF_DELTA, 1.0);
    }
    float pdf;
    Spectrum f = conductor_value(m, v, wi, alpha, pdf);
    if (!positive(pdf))
        return BSDF_NONE;
    return BsdfSample(vec3(wi.xy, side * wi.z), f / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum conductor_albedo(conductor_Params m, vec3 wo) { return conductor_fresnel(m, abs(wo.z)); }
