// SPDX-License-Identifier: Apache-2.0
// A thin sheet that scatters diffusely to both sides (pbrt-v4 DiffuseTransmissionBxDF).
#include <restage/v1/sampling.glsl>

Spectrum diffusetransmission_albedo(diffusetransmission_Params m, vec3 wo) {
    return clamp(m.reflectance, Spectrum(0), Spectrum(1)) + clamp(m.transmittance, Spectrum(0), Spectrum(1));
}

// Probability of reflection.
float diffusetransmission_reflects(diffusetransmission_Params m) {
    float r = clamp(max_component(m.reflectance), 0.0, 1.0);
    float t = clamp(max_component(m.transmittance), 0.0, 1.0);
    return r + t > 0.0 ? r / (r + t) : 1.0;
}

Spectrum diffusetransmission_eval(diffusetransmission_Params m, vec3 wo, vec3 wi) {
    Spectrum share = same_hemisphere(wo, wi) ? m.reflectance : m.transmittance;
    return clamp(share, Spectrum(0), Spectrum(1)) * (INV_PI * abs(wi.z));
}

float diffusetransmission_pdf(diffusetransmission_Params m, vec3 wo, vec3 wi) {
    float pr = diffusetransmission_reflects(m);
    return (same_hemisphere(wo, wi) ? pr : 1.0 - pr) * cosine_hemisphere_pdf(abs(wi.z));
}

BsdfSample diffusetransmission_sample(diffusetransmission_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pr = diffusetransmission_reflects(m);
    bool reflects = u.z < pr;
    if ((wo.z < 0.0) == reflects)
        wi.z = -wi.z;
    float pdf = diffusetransmission_pdf(m, wo, wi);
    if (!positive(pdf) || wo.z == 0.0)
        return BSDF_NONE;
    Spectrum weight = diffusetransmission_eval(m, wo, wi) / pdf;
    return BsdfSample(wi, weight, pdf, reflects ? BSDF_REFLECT : BSDF_TRANSMIT, 1.0);
}
