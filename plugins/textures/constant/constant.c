/* SPDX-License-Identifier: Apache-2.0 */
/* Constant: the parameter table, and constant.glsl in C for the CPU. */
#include <restage/texture.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("value", "Value", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The value."),
};
/* clang-format on */

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    for (int k = 0; k < 3; ++k)
        rgb[k] = at->values[k];
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = 0,
    .type = "constant",
    .label = "Constant",
    .prefix = "constant",
    .glsl_file = "constant.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "The same value everywhere.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.restage.texture.constant", "0.1.0", {RESTAGE_TEXTURE1, &texture})
