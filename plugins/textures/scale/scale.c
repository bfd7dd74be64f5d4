/* SPDX-License-Identifier: Apache-2.0 */
/* Product: the parameter table, and scale.glsl in C for the CPU. */
#include <restage/texture.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tex", "Value", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The first factor."),
    RESTAGE_COLOR_PARAM("scale", "Factor", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The second factor."),
};
/* clang-format on */

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    for (int k = 0; k < 3; ++k)
        rgb[k] = at->values[k] * at->values[4 + k];
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = 0,
    .type = "scale",
    .label = "Product",
    .prefix = "scaling",
    .glsl_file = "scale.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "The product of two values.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.restage.texture.scale", "0.1.0", {RESTAGE_TEXTURE1, &texture})
