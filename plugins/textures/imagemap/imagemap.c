/* SPDX-License-Identifier: Apache-2.0 */
/* Image: the parameter table, and imagemap.glsl in C for the CPU. */
#include <restage/texture.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM("scale", "Factor", 0, 100, 1, 0, "", "Multiplies the image."),
    RESTAGE_BOOL_PARAM("invert", "Inverted", 0, 0, "1 minus the scaled image."),
    RESTAGE_ENUM_PARAM("wrap", "Outside", "repeat|black|clamp", 0, 0, "What lies beyond the image's edge."),
};
/* clang-format on */

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    float texel[4];
    at->image(at, at->uv[0], at->uv[1], at->whole[2], texel);
    for (int k = 0; k < 3; ++k) {
        rgb[k] = texel[k] * at->values[0];
        if (at->whole[1]) rgb[k] = rgb[k] < 1 ? 1 - rgb[k] : 0; /* after the scale, as in pbrt-v4 */
    }
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = RESTAGE_TEXTURE_IMAGE | RESTAGE_TEXTURE_MAPPED,
    .type = "imagemap",
    .label = "Image",
    .prefix = "imagemap",
    .glsl_file = "imagemap.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "An image, filtered bilinearly.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.restage.texture.imagemap", "0.1.0", {RESTAGE_TEXTURE1, &texture})
