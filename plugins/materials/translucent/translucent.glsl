// SPDX-License-Identifier: Apache-2.0
// pbrt-v3 "translucent": diffuse and rough-dielectric (ior 1.5) lobes, each scaled by `reflect` on the near side and by
// `transmit` on the far side, simply added.
#include <restage/v1/dielectric.glsl>
#include <restage/v1/sampling.glsl>

vec2 translucent_alpha(translucent_Params m) {
    return vec2(max(alpha_from_roughness(m.roughness, m.roughness, m.remap).x, 1e-3));
}
float translucent_eta(vec3 wo) { return wo.z > 0.0 ? 1.5 : 1.0 / 1.5; }

// Probabilities: x of the glossy lobe, y of reflection within the diffuse lobe.
vec2 translucent_choice(translucent_Params m) {
    float r = clamp(max_component(m.reflect), 0.0, 1.0);
    float t = clamp(max_component(m.transmit), 0.0, 1.0);
    float d = clamp(max_component(m.kd), 0.0, 1.0);
    float s = clamp(max_component(m.ks), 0.0, 1.0);
    return vec2(d + s > 0.0 ? s / (d + s) : 0.0, r + t > 0.0 ? r / (r + t) : 1.0);
}

// x: the glossy lobe's f |cos|, y: its density. wo and wi in the surface's frame.
vec2 translucent_glossy(translucent_Params m, vec3 wo, vec3 wi) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    return rough_dielectric(vec3(wo.xy, side * wo.z), vec3(wi.xy, side * wi.z), translucent_alpha(m),
                            translucent_eta(wo), DISTRIBUTION_GGX);
}

Spectrum translucent_combine(translucent_Params m, vec3 wo, vec3 wi, float glossy) {
    Spectrum tint = clamp(same_hemisphere(wo, wi) ? m.reflect : m.transmit, Spectrum(0), Spectrum(1));
    return tint * (clamp(m.kd, Spectrum(0), Spectrum(1)) * (INV_PI * abs(wi.z)) +
                   clamp(m.ks, Spectrum(0), Spectrum(1)) * glossy);
}
float translucent_density(translucent_Params m, vec3 wo, vec3 wi, float glossy) {
    vec2 p = translucent_choice(m);
    float diffuse = (same_hemisphere(wo, wi) ? p.y : 1.0 - p.y) * cosine_hemisphere_pdf(abs(wi.z));
    return mix(diffuse, glossy, p.x);
}

Spectrum translucent_eval(translucent_Params m, vec3 wo, vec3 wi) {
    return wo.z == 0.0 ? Spectrum(0) : translucent_combine(m, wo, wi, translucent_glossy(m, wo, wi).x);
}
float translucent_pdf(translucent_Params m, vec3 wo, vec3 wi) {
    return wo.z == 0.0 ? 0.0 : translucent_density(m, wo, wi, translucent_glossy(m, wo, wi).y);
}

BsdfSample translucent_sample(translucent_Params m, vec3 wo, vec3 u) {
    if (wo.z == 0.0)
        return BSDF_NONE;
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec2 p = translucent_choice(m);
    float eta = translucent_eta(wo);
    vec3 wi;
    if (u.z < p.x) {
        float pdf;
        u.z /= p.x;
        vec3 v = vec3(wo.xy, side * wo.z);
        if (rough_dielectric_sample(v, translucent_alpha(m), eta, DISTRIBUTION_GGX, u, wi, pdf) <= 0.0)
            return BSDF_NONE;
    } else {
        wi = sample_cosine_hemisphere(u.xy);
        if ((u.z - p.x) >= p.y * (1.0 - p.x))
            wi.z = -wi.z;
    }
    wi.z *= side;
    vec2 glossy = translucent_glossy(m, wo, wi);
    float pdf = translucent_density(m, wo, wi, glossy.y);
    if (!positive(pdf))
        return BSDF_NONE;
    bool reflects = same_hemisphere(wo, wi);
    // The diffuse lobes are a sheet without an inside, so eta is 1: roulette must not undo a 1/eta^2 that they lack.
    return BsdfSample(wi, translucent_combine(m, wo, wi, glossy.x) / pdf, pdf, reflects ? BSDF_REFLECT : BSDF_TRANSMIT,
                      1.0);
}

Spectrum translucent_albedo(translucent_Params m, vec3 wo) {
    float f = fresnel_dielectric(abs(wo.z), translucent_eta(wo));
    return clamp(m.kd * (m.reflect + m.transmit) + m.ks * mix(m.transmit, m.reflect, f), Spectrum(0), Spectrum(1));
}
