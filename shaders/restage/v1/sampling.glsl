// SPDX-License-Identifier: Apache-2.0
// Warps of the unit square and the MIS heuristic.
#ifndef RESTAGE_V1_SAMPLING
#define RESTAGE_V1_SAMPLING

#include <restage/v1/bsdf.glsl>

// Uniform on the unit disk, polar map.
vec2 sample_disk(vec2 u) {
    float phi = TWO_PI * u.y;
    return sqrt(u.x) * vec2(cos(phi), sin(phi));
}

// z >= 0, density cos / pi.
vec3 sample_cosine_hemisphere(vec2 u) {
    return vec3(sample_disk(u), sqrt(max(0.0, 1.0 - u.x)));
}
float cosine_hemisphere_pdf(float cos_theta) { return max(0.0, cos_theta) * INV_PI; }

// Density 1 / (4 pi).
vec3 sample_sphere(vec2 u) {
    float z = 1.0 - 2.0 * u.x;
    float phi = TWO_PI * u.y;
    return vec3(sqrt(max(0.0, 1.0 - z * z)) * vec2(cos(phi), sin(phi)), z);
}

// Veach 1997, Eq. 9.13 with beta = 2, one sample each. Divides first: squares of large densities overflow.
float power_heuristic(float a, float b) {
    if (!positive(a))
        return 0.0;
    float r = b / a;
    return 1.0 / (1.0 + r * r);
}

float sample_tent(float u, float r) { // density (r - |x|) / r^2
    return u < 0.5 ? r * (sqrt(2.0 * u) - 1.0) : r * (1.0 - sqrt(max(0.0, 2.0 - 2.0 * u)));
}

#endif
