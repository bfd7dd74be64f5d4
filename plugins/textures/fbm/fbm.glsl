// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/noise.glsl>

Spectrum fbm_texture(fbm_Params m, TextureSite at) {
    vec4 p = TEXTURE_SPACE(m, at);
    return Spectrum(noise_fbm(p.xyz, p.w, m.roughness, m.octaves));
}
