/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.texture/1": an operator or a procedural, as a parameter table and a GLSL file.
 *
 * The GLSL file defines, with the table's prefix (here `p`):
 *
 *   Spectrum p_texture(p_Params m, TextureSite at)
 *
 * `p_Params` is written by the host from the table, fields in its order. What is texturable may be another texture's
 * value: the function cannot tell. A COLOR arrives as a Spectrum, a FLOAT as a float; a FLOAT that is a texture is that
 * texture's first component. `at.uv` is where it is asked (<restage/v1/texture.glsl>). Colours of its own are made by
 * texture_color(at, rgb), never by a constructor of three numbers, and what it returns must be finite where its
 * parameters are. A FLOAT slot that takes the texture reads the first component: a scalar x is returned as Spectrum(x).
 *
 * The file may include <restage/v1/...> and files of its own folder. It sees nothing else, declares no bindings and no
 * buffers, and every name of its own starts with `p_`. Graphs of textures stay data: what is compiled is a switch over
 * the types that a scene has. */
#ifndef RESTAGE_TEXTURE_H
#define RESTAGE_TEXTURE_H

#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_TEXTURE1 "restage.texture/1"

enum {
    /* Looks up the texture's image: p_Params has `TextureImage image`. Without an image it shades as its `average`. */
    RESTAGE_TEXTURE_IMAGE = 1u,
    /* at.uv comes through the affine map that every such texture has besides its table (scene_io.h): uscale .. uvset */
    RESTAGE_TEXTURE_MAPPED = 2u,
    /* Depends on more than uv: at.place is a Site (<restage/v1/site.glsl>). Who does not ask does not pay. */
    RESTAGE_TEXTURE_SITE = 4u
};

/* What the native evaluation is given. */
typedef struct RestageTextureAt1 {
    RESTAGE_SIZE(RestageTextureAt1);
    float uv[2]; /* at.uv */
    const float* values; /* 4 a table line: FLOAT [0], COLOR [0..2] */
    const int32_t* whole; /* 1 a table line: INT, BOOL, ENUM (the index of the choice) */
    const void* host; /* of `image` */
    /* IMAGE, else NULL: bilinear, as texture_image() of the GLSL. wrap: 0 repeat, 1 black, 2 clamp */
    void (*image)(const struct RestageTextureAt1* at, float s, float t, int32_t wrap, float rgba[4]);
} RestageTextureAt1;

typedef struct RestageTexture1 {
    RESTAGE_SIZE(RestageTexture1);
    uint32_t flags; /* RESTAGE_TEXTURE_* */
    const char* type; /* "checkerboard": what scene files call it; unique over all plugins */
    const char* label;
    const char* prefix; /* of every GLSL name, without the underscore; unique among textures and materials */
    const char* glsl_file; /* relative to the plugin's folder */
    /* FLOAT, COLOR, INT, BOOL, ENUM, TEXT; at most 16 of them texturable. With IMAGE no id is `image`; with MAPPED none
     * is one of the map's */
    const RestageParam* params;
    uint32_t param_count;
    const char* tooltip;
    /* [any] The same in C, within rounding, or NULL. Only speed depends on it: the tracer on the CPU asks it where a
     * cut-out lets rays pass, and otherwise has the GLSL decide such points in batches. Not with SITE. */
    void (*eval)(const RestageTextureAt1* at, float rgb[3]);
} RestageTexture1;

#ifdef __cplusplus
}
#endif
#endif
