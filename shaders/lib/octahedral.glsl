// SPDX-License-Identifier: Apache-2.0
// Equal-area octahedral map between the sphere and the unit square: Clarberg 2008; pbrt 4ed, 3.8.3.
#ifndef RESTAGE_LIB_OCTAHEDRAL
#define RESTAGE_LIB_OCTAHEDRAL
#include <restage/v1/bsdf.glsl>

vec3 octahedral_to_direction(vec2 p) {
    vec2 uv = 2.0 * p - 1.0;
    vec2 a = abs(uv);
    float d = 1.0 - (a.x + a.y);
    float r = 1.0 - abs(d);
    float phi = r == 0.0 ? PI * 0.25 : ((a.y - a.x) / r + 1.0) * PI * 0.25;
    float z = (d < 0.0 ? -1.0 : 1.0) * (1.0 - r * r);
    float s = r * sqrt(max(0.0, 2.0 - r * r));
    return vec3((uv.x < 0.0 ? -1.0 : 1.0) * cos(phi) * s, (uv.y < 0.0 ? -1.0 : 1.0) * sin(phi) * s, z);
}
vec2 direction_to_octahedral(vec3 w) {
    vec3 a = abs(w);
    float r = sqrt(max(0.0, 1.0 - a.z));
    float hi = max(a.x, a.y), lo = min(a.x, a.y);
    float phi = (hi == 0.0 ? 0.0 : atan(lo / hi)) * (2.0 / PI);
    if (a.x < a.y) phi = 1.0 - phi;
    float v = phi * r;
    float u = r - v;
    if (w.z < 0.0) {
        float t = u;
        u = 1.0 - v;
        v = 1.0 - t;
    }
    return 0.5 * (vec2(w.x < 0.0 ? -u : u, w.y < 0.0 ? -v : v) + 1.0);
}
// A point up to one square outside, where the map goes on (pbrt 4ed, fig. 3.22).
vec2 octahedral_wrap(vec2 p) {
    if (p.x < 0.0 || p.x > 1.0) p = vec2(p.x < 0.0 ? -p.x : 2.0 - p.x, 1.0 - p.y);
    if (p.y < 0.0 || p.y > 1.0) p = vec2(1.0 - p.x, p.y < 0.0 ? -p.y : 2.0 - p.y);
    return p;
}

#endif
