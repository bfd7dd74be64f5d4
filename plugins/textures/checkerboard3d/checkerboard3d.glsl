// SPDX-License-Identifier: Apache-2.0
Spectrum cubes_texture(cubes_Params m, TextureSite at) {
    vec3 cell = mod(floor(TEXTURE_SPACE(m, at).xyz), 2.0);
    return mod(cell.x + cell.y + cell.z, 2.0) < 0.5 ? m.tex1 : m.tex2;
}
