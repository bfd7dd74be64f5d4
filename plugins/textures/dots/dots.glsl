// SPDX-License-Identifier: Apache-2.0
// Dots in about every other cell of a grid. Pharr et al. 2018 (pbrt-v3), 10.5.2; but as in the code of v3 and v4, which
// passes the two values in the wrong order, `inside` is the value between the dots.
#include <restage/v1/noise.glsl>

const float polka_radius = 0.35;

Spectrum polka_texture(polka_Params m, TextureSite at) {
    vec2 cell = floor(at.uv + 0.5);
    if (noise(vec3(cell + 0.5, 0.5)) <= 0.0) return m.inside;
    float most = 0.5 - polka_radius;
    vec2 centre = cell + most * vec2(noise(vec3(cell + vec2(1.5, 2.8), 0.5)), noise(vec3(cell + vec2(4.5, 9.8), 0.5)));
    vec2 d = at.uv - centre;
    return dot(d, d) < polka_radius * polka_radius ? m.outside : m.inside;
}
