// SPDX-License-Identifier: Apache-2.0
// A diffuse base under a dielectric coat (pbrt-v4 CoatedDiffuseBxDF): see restage/v1/layered.glsl. Stochastic, except for a
// smooth coat without scattering below it, where the series has a closed form and eval and pdf are exact.
#include <restage/v1/layered.glsl>

Layered coateddiffuse_layers(coateddiffuse_Params m) {
    Layered l = layered_coat_of(vec2(m.uroughness, m.vroughness), m.remap, m.eta, m.thickness, m.albedo, m.g, m.max_depth,
                                m.n_samples);
    l.metal = false;
    l.base = clamp(m.reflectance, Spectrum(0), Spectrum(1));
    l.base_k = Spectrum(0);
    l.base_alpha = vec2(0);
    return l;
}

bool coateddiffuse_is_closed_form(Layered l) {
    return coat_is_smooth(l.alpha, l.eta) && max_component(l.albedo) <= 0.0 && l.eta >= 1.0;
}

// x^2 E1(x); Abramowitz and Stegun 5.1.53 (|error| < 2e-7) and 5.1.54 (< 5e-5).
float coateddiffuse_x2_e1(float x) {
    if (x < 1.0)
        return x * x * (-log(x) - 0.57721566 +
                        x * (0.99999193 + x * (-0.24991055 + x * (0.05519968 + x * (-0.00976004 + x * 0.00107857)))));
    return x * exp(-x) * (x * (x + 2.334733) + 0.250621) / (x * (x + 3.330657) + 1.681534);
}

// The fraction of a cosine-distributed beam from the base that the smooth coat reflects back to the base:
// K = int_0^1 2 mu F(mu) exp(-2 t / mu) dmu. Beyond the critical angle F = 1, which gives mu_c^2 2 E_3(2 t / mu_c),
// with E_3(x) = (exp(-x) (1 - x) + x^2 E_1(x)) / 2; the rest is F_avg / eta^2 at a mean slope (its share is below 7 %).
float coateddiffuse_returned(float eta, float thickness) {
    float mu_c2 = max(0.0, 1.0 - 1.0 / (eta * eta));
    float mu_c = sqrt(mu_c2);
    float slope = mix(mu_c, 1.0, 0.045 + mu_c2 * (0.33 + 0.155 * mu_c2)); // fitted to the integral, eta 1.05 to 3
    float x = 2.0 * thickness / max(mu_c, 1e-4);
    float beyond = mu_c2 * max(0.0, exp(-x) * (1.0 - x) + coateddiffuse_x2_e1(max(x, 1e-6)));
    return beyond + fresnel_dielectric_average(eta) / (eta * eta) * exp(-2.0 * thickness / slope);
}

// T(wo) T(wi) R / (pi eta^2) sum_k (R K)^k with as many terms as the walk has bounces on the base.
Spectrum coateddiffuse_closed_form(Layered l, vec3 wo, vec3 wi) {
    float cos_o;
    float cos_i;
    float fo = fresnel_dielectric(abs(wo.z), l.eta, cos_o);
    float fi = fresnel_dielectric(abs(wi.z), l.eta, cos_i);
    float passage = (1.0 - fo) * (1.0 - fi) * exp(-l.thickness * (1.0 / max(cos_o, 1e-4) + 1.0 / max(cos_i, 1e-4)));
    Spectrum q = clamp(l.base * coateddiffuse_returned(l.eta, l.thickness), Spectrum(1e-6), Spectrum(0.9999));
    float terms = float((max(l.max_depth, 0) + 1) / 2);
    Spectrum series = (1.0 - exp2(terms * log2(q))) / (1.0 - q);
    return l.base * series * (passage * abs(wi.z) * INV_PI / (l.eta * l.eta));
}

Spectrum coateddiffuse_eval(coateddiffuse_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    Layered l = coateddiffuse_layers(m);
    if (!same_hemisphere(wo, wi))
        return Spectrum(0);
    if (coateddiffuse_is_closed_form(l))
        return coateddiffuse_closed_form(l, wo, wi);
    return layered_eval(l, wo, wi, rng);
}

float coateddiffuse_pdf(coateddiffuse_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    return layered_pdf(coateddiffuse_layers(m), wo, wi);
}

BsdfSample coateddiffuse_sample(coateddiffuse_Params m, vec3 wo, vec3 u, inout Rng rng) {
    Layered l = coateddiffuse_layers(m);
    if (!coateddiffuse_is_closed_form(l))
        return layered_sample(l, wo, u, rng);
    if (wo.z == 0.0)
        return BSDF_NONE;
    float f = fresnel_dielectric(abs(wo.z), l.eta);
    if (u.z < f)
        return BsdfSample(vec3(-wo.xy, wo.z), Spectrum(1), f, BSDF_REFLECT | BSDF_DELTA, 1.0);
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = (1.0 - f) * cosine_hemisphere_pdf(wi.z);
    if (!positive(pdf))
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    return BsdfSample(wi, coateddiffuse_closed_form(l, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
}

// As if the coat were smooth and clear.
Spectrum coateddiffuse_albedo(coateddiffuse_Params m, vec3 wo) {
    float eta = max(m.eta, 1.0);
    float f = fresnel_dielectric(abs(wo.z), eta);
    float k = 1.0 - (1.0 - fresnel_dielectric_average(eta)) / (eta * eta);
    Spectrum r = clamp(m.reflectance, Spectrum(0), Spectrum(1));
    return f + (1.0 - f) * r * (1.0 - k) / (1.0 - r * min(k, 0.999));
}
