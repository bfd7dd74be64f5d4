// SPDX-License-Identifier: Apache-2.0
#include <restage/v1/texture.glsl>

Spectrum stripes_texture(stripes_Params m, TextureSite at) {
    return fract(at.uv.x * m.count) < 0.5 ? m.first : m.second;
}
