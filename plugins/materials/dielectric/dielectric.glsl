// SPDX-License-Identifier: Apache-2.0
// Glass, water: smooth, rough or thin (pbrt-v4 DielectricBxDF and ThinDielectricBxDF; v3 "glass" with its two tints).
// With `multiscatter`, light scattered between rough microfacets is restored.
#include <restage/v1/dielectric.glsl>
#include <restage/v1/multiscatter.glsl>
#include <restage/v1/sampling.glsl>

// As in pbrt-v3's glass, a roughness of 0 is smooth for any remapping.
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

Spectrum dielectric_tint(dielectric_Params m, bool reflects) {
    return clamp(reflects ? m.reflectance : m.transmittance, Spectrum(0), Spectrum(1));
}

// The fraction of samples for light scattered more than once.
float dielectric_multiple_share(dielectric_Params m, vec2 alpha, float eta, out MultiscatterDielectric lobe) {
    if (!m.multiscatter)
        return 0.0;
    lobe = multiscatter_dielectric(alpha, eta, m.distribution);
    return lobe.mean_loss.x;
}

// f |cos wi| without tint, and the density, of all lobes that are not delta.
vec2 dielectric_value_pdf(dielectric_Params m, vec3 wo, vec3 wi) {
    vec2 alpha = dielectric_alpha(m);
    float eta = dielectric_eta(m, wo);
    if (m.thin || dielectric_is_smooth(alpha, eta))
        return vec2(0);
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    wo.z *= side;
    wi.z *= side;
    vec2 value = rough_dielectric(wo, wi, alpha, eta, m.distribution);
    MultiscatterDielectric lobe;
    float share = dielectric_multiple_share(m, alpha, eta, lobe);
    if (share > 0.0 && wo.z > 0.0 && wi.z != 0.0) {
        value.x += multiscatter_transmission(lobe, wo, wi, alpha, m.distribution);
        float side_share = wi.z > 0.0 ? lobe.reflected : 1.0 - lobe.reflected;
        value.y = mix(value.y, side_share * cosine_hemisphere_pdf(abs(wi.z)), share);
    }
    return value;
}

Spectrum dielectric_eval(dielectric_Params m, vec3 wo, vec3 wi) {
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
        MultiscatterDielectric lobe;
        float share = dielectric_multiple_share(m, alpha, eta, lobe);
        if (u.z < share) {
            wi = sample_cosine_hemisphere(u.xy);
            if (wi.z <= 0.0)
                return BSDF_NONE;
            wi.z *= u.z < share * lobe.reflected ? 1.0 : -1.0;
            weight = 1.0;
        } else {
            u.z = (u.z - share) / (1.0 - share);
            weight = rough_dielectric_sample(v, alpha, eta, m.distribution, u, wi, pdf);
            if (weight <= 0.0)
                return BSDF_NONE;
        }
        if (share > 0.0) {
            vec2 value = dielectric_value_pdf(m, wo, vec3(wi.xy, side * wi.z));
            if (!positive(value.y))
                return BSDF_NONE;
            pdf = value.y;
            weight = value.x / value.y;
        }
    }
    bool reflects = wi.z > 0.0;
    uint flags = (reflects ? BSDF_REFLECT : BSDF_TRANSMIT) | (delta ? BSDF_DELTA : 0u);
    wi.z *= side;
    return BsdfSample(wi, dielectric_tint(m, reflects) * weight, pdf, flags, reflects || m.thin ? 1.0 : eta);
}

Spectrum dielectric_albedo(dielectric_Params m, vec3 wo) {
    float r = fresnel_dielectric(abs(wo.z), dielectric_eta(m, wo));
    return mix(dielectric_tint(m, false), dielectric_tint(m, true), m.thin ? 2.0 * r / (1.0 + r) : r);
}
