// SPDX-License-Identifier: Apache-2.0
Spectrum imagemap_texture(imagemap_Params m, TextureSite at) {
    vec3 c = texture_image(m.image, at.uv, m.wrap).xyz * m.scale;
    if (m.invert) c = max(vec3(0), 1.0 - c); // after the scale, as in pbrt-v4
    return texture_color(at, c);
}
