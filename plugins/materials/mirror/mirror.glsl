// SPDX-License-Identifier: Apache-2.0
// A perfect mirror of constant reflectance (pbrt-v3 "mirror"), on both sides.
#include <restage/v1/bsdf.glsl>

Spectrum mirror_eval(mirror_Params m, vec3 wo, vec3 wi) { return Spectrum(0); }
float mirror_pdf(mirror_Params m, vec3 wo, vec3 wi) { return 0.0; }

BsdfSample mirror_sample(mirror_Params m, vec3 wo, vec3 u) {
    if (wo.z == 0.0)
        return BSDF_NONE;
    return BsdfSample(vec3(-wo.xy, wo.z), clamp(m.kr, Spectrum(0), Spectrum(1)), 1.0, BSDF_REFLECT | BSDF_DELTA, 1.0);
}

Spectrum mirror_albedo(mirror_Params m, vec3 wo) { return clamp(m.kr, Spectrum(0), Spectrum(1)); }
