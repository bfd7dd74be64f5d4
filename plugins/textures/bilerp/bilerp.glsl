// SPDX-License-Identifier: Apache-2.0
Spectrum bilerp_texture(bilerp_Params m, TextureSite at) {
    return mix(mix(m.v00, m.v01, at.uv.y), mix(m.v10, m.v11, at.uv.y), at.uv.x);
}
