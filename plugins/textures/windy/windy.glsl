// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/noise.glsl>

// The point in texture space, and the width of a sample there: an eighth of a pixel, as in pbrt-v4 from 64 samples on.
vec4 windy_point(windy_Params m, TextureSite at) {
    mat3 rows = mat3(m.x_from_x, m.x_from_y, m.x_from_z, m.y_from_x, m.y_from_y, m.y_from_z, m.z_from_x, m.z_from_y, m.z_from_z);
    float scale = max(length(rows[0]), max(length(rows[1]), length(rows[2])));
    return vec4(at.place.world * rows + vec3(m.origin_x, m.origin_y, m.origin_z), 0.125 * at.place.footprint * scale);
}

Spectrum windy_texture(windy_Params m, TextureSite at) {
    vec4 p = windy_point(m, at);
    float wind = noise_fbm(0.1 * p.xyz, 0.1 * p.w, 0.5, 3);
    return Spectrum(abs(wind) * noise_fbm(p.xyz, p.w, 0.5, 6));
}
