// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/noise.glsl>

Spectrum windy_texture(windy_Params m, TextureSite at) {
    vec4 p = TEXTURE_SPACE(m, at);
    float wind = noise_fbm(0.1 * p.xyz, 0.1 * p.w, 0.5, 3);
    return Spectrum(abs(wind) * noise_fbm(p.xyz, p.w, 0.5, 6));
}
