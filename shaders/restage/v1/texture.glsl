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
