// SPDX-License-Identifier: Apache-2.0
// The BSDF contract: inputs and results of a material's GLSL. See engine/sdk/restage/material.h.
// Local shading frame: n = +z, wo towards the viewer, wi towards the light, both unit and pointing away from the surface.
// z < 0 is the back side (inside, for closed objects). Radiance transport: transmission carries 1/eta^2.
#ifndef RESTAGE_V1_BSDF
#define RESTAGE_V1_BSDF
#include <restage/v1/numbers.glsl>
#include <restage/v1/spectrum.glsl>

const float PI = 3.14159265358979323846;
const float INV_PI = 0.31830988618379067154;
const float TWO_PI = 6.28318530717958647693;

const uint BSDF_REFLECT = 1u;  // wi on wo's side
const uint BSDF_TRANSMIT = 2u; // wi on the other side
const uint BSDF_DELTA = 4u;    // wi is the only direction: no MIS, pdf is the lobe's probability

struct BsdfSample {
    vec3 wi;         // unit; meaningless when flags == 0
    Spectrum weight; // f * |cos wi| / pdf
    float pdf;       // solid-angle density; for a delta lobe its discrete probability
    uint flags;      // BSDF_*; 0 = no sample (absorbed)
    float eta;       // ior behind wi / ior before, on transmission; else 1 (Russian roulette uses it to undo eta^2)
};

const BsdfSample BSDF_NONE = BsdfSample(vec3(0, 0, 1), Spectrum(0), 0.0, 0u, 1.0);

float sqr(float x) { return x * x; }
float cos_theta(vec3 w) { return w.z; }
float abs_cos(vec3 w) { return abs(w.z); }
bool same_hemisphere(vec3 a, vec3 b) { return a.z * b.z > 0.0; }

#endif
