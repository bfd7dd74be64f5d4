// SPDX-License-Identifier: Apache-2.0
// Layers bent by noise, coloured by a cubic spline. Pharr et al. 2018 (pbrt-v3), 10.6.6, with its colours.
#include <restage/v1/noise.glsl>

vec3 marble_color(int i) {
    return i == 3 ? vec3(0.5) : i == 4 ? vec3(0.6, 0.59, 0.58) : i == 7 ? vec3(0.2, 0.2, 0.33) : vec3(0.58, 0.58, 0.6);
}

Spectrum marble_texture(marble_Params m, TextureSite at) {
    vec4 p = m.scale * TEXTURE_SPACE(m, at);
    float t = 6.0 * (0.5 + 0.5 * sin(p.y + m.variation * noise_fbm(p.xyz, p.w, m.roughness, m.octaves)));
    int first = min(int(t), 5);
    t -= float(first);
    vec3 a = marble_color(first), b = marble_color(first + 1), c = marble_color(first + 2), d = marble_color(first + 3);
    vec3 ab = mix(a, b, t), bc = mix(b, c, t), cd = mix(c, d, t);
    return texture_color(at, 1.5 * mix(mix(ab, bc, t), mix(bc, cd, t), t));
}
