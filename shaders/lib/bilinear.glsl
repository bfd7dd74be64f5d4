// SPDX-License-Identifier: Apache-2.0
// Linear and bilinear densities over [0, 1] and the unit square. pbrt 4ed, A.5.1, A.5.2
#ifndef RESTAGE_LIB_BILINEAR
#define RESTAGE_LIB_BILINEAR

// Density proportional to the line from a at 0 to b at 1.
float sample_linear(float u, float a, float b) {
    return min(u * (a + b) / max(a + sqrt(mix(a * a, b * b, u)), 1e-37), 1.0);
}

// Density proportional to the bilinear function with these values at (0, 0), (1, 0), (0, 1) and (1, 1).
vec2 bilinear_sample(vec4 corners, vec2 u) {
    float y = sample_linear(u.y, corners.x + corners.y, corners.z + corners.w);
    vec2 line = mix(corners.xy, corners.zw, y);
    return vec2(sample_linear(u.x, line.x, line.y), y);
}
float bilinear_density(vec4 corners, vec2 at) {
    vec2 line = mix(corners.xy, corners.zw, at.y);
    return 4.0 * mix(line.x, line.y, at.x) / (corners.x + corners.y + corners.z + corners.w);
}

#endif
