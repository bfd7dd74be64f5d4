// SPDX-License-Identifier: Apache-2.0
// Layers bent by noise, coloured by a cubic spline. Pharr et al. 2018 (pbrt-v3), 10.6.6, with its colours.
#include <restage/v1/noise.glsl>

// The point in texture space, and the width of a sample there: an eighth of a pixel, as in pbrt-v4 from 64 samples on.
vec4 marble_point(marble_Params m, TextureSite at) {
    mat3 rows = mat3(m.x_from_x, m.x_from_y, m.x_from_z, m.y_from_x, m.y_from_y, m.y_from_z, m.z_from_x, m.z_from_y, m.z_from_z);
    float scale = max(length(rows[0]), max(length(rows[1]), length(rows[2])));
    return vec4(at.place.world * rows + vec3(m.origin_x, m.origin_y, m.origin_z), 0.125 * at.place.footprint * scale);
}

vec3 marble_color(int i) {
    return i == 3 ? vec3(0.5) : i == 4 ? vec3(0.6, 0.59, 0.58) : i == 7 ? vec3(0.2, 0.2, 0.33) : vec3(0.58, 0.58, 0.6);
}

Spectrum marble_texture(marble_Params m, TextureSite at) {
    vec4 p = m.scale * marble_point(m, at);
    float t = 6.0 * (0.5 + 0.5 * sin(p.y + m.variation * noise_fbm(p.xyz, p.w, m.roughness, m.octaves)));
    int first = min(int(t), 5);
    t -= float(first);
    vec3 a = marble_color(first), b = marble_color(first + 1), c = marble_color(first + 2), d = marble_color(first + 3);
    vec3 ab = mix(a, b, t), bc = mix(b, c, t), cd = mix(c, d, t);
    return texture_color(at, 1.5 * mix(mix(ab, bc, t), mix(bc, cd, t), t));
}
