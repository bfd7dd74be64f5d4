// SPDX-License-Identifier: Apache-2.0
// Input of a texture's code (restage/texture.h): the point of evaluation, and its image.
#ifndef RESTAGE_V1_TEXTURE
#define RESTAGE_V1_TEXTURE
#include <restage/v1/spectrum.glsl>
#ifdef RESTAGE_TEXTURE_SITES
#include <restage/v1/site.glsl>
#endif

struct TextureSite {
    vec2 uv; // of the first set, or of the texture's own map (MAPPED)
    uint use_; // private to the host
#ifdef RESTAGE_TEXTURE_SITES // only for textures with SITE
    vec2 duv_dx, duv_dy; // change of uv from one pixel to the next, to the right and downwards
    Site place;          // place.uv and its changes are the mesh's own
#endif
};

const uint TEXTURE_REFLECTANCE = 0u, TEXTURE_UNBOUNDED = 1u, TEXTURE_DATA = 2u; // use_

#ifdef RESTAGE_TEXTURE_SITES
// The site's place in texture space, rows * world + origin; w: the width of a sample there, an eighth of a pixel, as in
// pbrt-v4 from 64 samples per pixel on.
vec4 texture_space(TextureSite at, mat3 rows, vec3 origin) {
    float scale = max(length(rows[0]), max(length(rows[1]), length(rows[2])));
    return vec4(at.place.world * rows + origin, 0.125 * at.place.footprint * scale);
}
// Of a texture whose parameters are x_from_x ... z_from_z and origin_x ... origin_z.
#define TEXTURE_SPACE(m, at)                                                                                           \
    texture_space(at,                                                                                                  \
                  mat3(m.x_from_x, m.x_from_y, m.x_from_z, m.y_from_x, m.y_from_y, m.y_from_z, m.z_from_x, m.z_from_y, \
                       m.z_from_z),                                                                                    \
                  vec3(m.origin_x, m.origin_y, m.origin_z))
#endif

// A colour from RGB. The slot that reads the texture decides whether it is a reflectance, unbounded, or three plain numbers (a
// normal, an opacity).
Spectrum texture_color(TextureSite at, vec3 rgb) {
#ifdef RESTAGE_SPECTRAL
    if (at.use_ == TEXTURE_DATA) return Spectrum(rgb, 0.0);
    return at.use_ == TEXTURE_REFLECTANCE ? spectrum_from_rgb(rgb) : spectrum_from_rgb_unbounded(rgb);
#else
    return rgb;
#endif
}

// The texture's image: the parameter `image` of textures with IMAGE. Its member is private to the host.
struct TextureImage {
    uint64_t record;
};
const int TEXTURE_REPEAT = 0, TEXTURE_BLACK = 1, TEXTURE_CLAMP = 2;

// Linear RGB and alpha, filtered bilinearly. s points right, t upwards: row 0 of the image is at t = 1.
vec4 texture_image(TextureImage image, vec2 st, int wrap); // lib/texture.glsl, which comes after the plugin's code

#endif
