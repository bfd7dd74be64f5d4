// SPDX-License-Identifier: Apache-2.0
// Cloth with standing fibres: a "Charlie" sheen (Estevez and Kulla 2017) over a Lambertian base, which gets what the
// fibres leave, as in KHR_materials_sheen. Both sides are alike.
#include <restage/v1/sampling.glsl>
#include <restage/v1/sheen.glsl>

Spectrum velvet_value(velvet_Params m, vec3 wo, vec3 wi) {
    float alpha = sheen_alpha(m.roughness);
    Spectrum sheen = clamp(m.sheen, Spectrum(0), Spectrum(1));
    float taken = max_component(sheen) * max(sheen_albedo(wo.z, alpha), sheen_albedo(wi.z, alpha));
    return sheen * sheen_value(wo, wi, alpha) +
           clamp(m.reflectance, Spectrum(0), Spectrum(1)) * ((1.0 - taken) * INV_PI * wi.z);
}

// The fraction of samples that follow the sheen.
float velvet_share(velvet_Params m, float cos_o) {
    float sheen = max_component(m.sheen) * sheen_albedo(cos_o, sheen_alpha(m.roughness));
    return sheen / max(sheen + max_component(m.reflectance) * (1.0 - sheen), 1e-20);
}

Spectrum velvet_eval(velvet_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    return velvet_value(m, vec3(wo.xy, abs(wo.z)), vec3(wi.xy, abs(wi.z)));
}

float velvet_pdf(velvet_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi))
        return 0.0;
    return mix(cosine_hemisphere_pdf(abs(wi.z)), SHEEN_PDF, velvet_share(m, abs(wo.z)));
}

BsdfSample velvet_sample(velvet_Params m, vec3 wo, vec3 u) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, abs(wo.z));
    float share = velvet_share(m, v.z);
    vec3 wi = u.z < share ? sheen_sample(u.xy) : sample_cosine_hemisphere(u.xy);
    float pdf = mix(cosine_hemisphere_pdf(wi.z), SHEEN_PDF, share);
    if (v.z <= 0.0 || wi.z <= 0.0 || !positive(pdf))
        return BSDF_NONE;
    Spectrum f = velvet_value(m, v, wi);
    return BsdfSample(vec3(wi.xy, side * wi.z), f / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum velvet_albedo(velvet_Params m, vec3 wo) {
    float sheen = sheen_albedo(abs(wo.z), sheen_alpha(m.roughness));
    return clamp(m.sheen * sheen + m.reflectance * (1.0 - max_component(m.sheen) * sheen), Spectrum(0), Spectrum(1));
}
