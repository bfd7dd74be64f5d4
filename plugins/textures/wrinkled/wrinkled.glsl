// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/noise.glsl>

Spectrum wrinkled_texture(wrinkled_Params m, TextureSite at) {
    vec4 p = TEXTURE_SPACE(m, at);
    return Spectrum(noise_turbulence(p.xyz, p.w, m.roughness, m.octaves));
}
