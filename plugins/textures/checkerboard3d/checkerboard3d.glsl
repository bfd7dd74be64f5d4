// SPDX-License-Identifier: Apache-2.0
Spectrum cubes_texture(cubes_Params m, TextureSite at) {
    mat3 rows = mat3(m.x_from_x, m.x_from_y, m.x_from_z, m.y_from_x, m.y_from_y, m.y_from_z, m.z_from_x, m.z_from_y, m.z_from_z);
    vec3 cell = mod(floor(at.place.world * rows + vec3(m.origin_x, m.origin_y, m.origin_z)), 2.0);
    return mod(cell.x + cell.y + cell.z, 2.0) < 0.5 ? m.tex1 : m.tex2;
}
