// SPDX-License-Identifier: Apache-2.0
Spectrum checkerboard_texture(checkerboard_Params m, TextureSite at) {
    vec2 st = floor(at.uv);
    return mod(st.x + st.y, 2.0) < 0.5 ? m.tex1 : m.tex2;
}
