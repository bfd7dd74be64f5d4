// SPDX-License-Identifier: Apache-2.0
// A conductor under a dielectric coat (pbrt-v4 CoatedConductorBxDF): see restage/v1/layered.glsl. Stochastic.
#include <restage/v1/layered.glsl>

Layered coatedconductor_layers(coatedconductor_Params m) {
    Layered l = layered_coat_of(vec2(m.interface_uroughness, m.interface_vroughness), m.remap, m.interface_eta,
                                m.thickness, m.albedo, m.g, m.max_depth, m.n_samples);
    l.metal = true;
    // pbrt-v4 divides by the coat's ior in both cases.
    bool r = m.use_reflectance;
    l.base = (r ? Spectrum(1) : m.conductor_eta) / l.eta;
    l.base_k = (r ? conductor_k_from_reflectance(m.reflectance) : m.conductor_k) / l.eta;
    l.base_alpha = alpha_from_roughness(m.conductor_uroughness, m.conductor_vroughness, m.remap);
    return l;
}

Spectrum coatedconductor_eval(coatedconductor_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    return layered_eval(coatedconductor_layers(m), wo, wi, rng);
}
float coatedconductor_pdf(coatedconductor_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    return layered_pdf(coatedconductor_layers(m), wo, wi);
}
BsdfSample coatedconductor_sample(coatedconductor_Params m, vec3 wo, vec3 u, inout Rng rng) {
    return layered_sample(coatedconductor_layers(m), wo, u, rng);
}

// Ignores interreflection under the coat.
Spectrum coatedconductor_albedo(coatedconductor_Params m, vec3 wo) {
    Layered l = coatedconductor_layers(m);
    float cos_t;
    float f = fresnel_dielectric(abs(wo.z), l.eta, cos_t);
    Spectrum base = fresnel_conductor(cos_t, l.base, l.base_k) * exp(-2.0 * l.thickness / max(cos_t, 1e-3));
    return f + (1.0 - f) * (1.0 - f) * base / (1.0 - f * base);
}
