/* SPDX-License-Identifier: Apache-2.0 */
/* Mix: the parameter table, and mix.glsl in C for the CPU. */
#include <restage/texture.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tex1", "First", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "The value at an amount of 0."),
    RESTAGE_COLOR_PARAM("tex2", "Second", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The value at an amount of 1."),
    RESTAGE_FLOAT_PARAM("amount", "Amount", 0, 1, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Fraction of the second value."),
};
/* clang-format on */

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    const float amount = at->values[8];
    for (int k = 0; k < 3; ++k)
        rgb[k] = at->values[k] * (1 - amount) + at->values[4 + k] * amount;
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = 0,
    .type = "mix",
    .label = "Mix",
    .prefix = "blend",
    .glsl_file = "mix.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Linear interpolation between two values.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.restage.texture.mix", "0.1.0", {RESTAGE_TEXTURE1, &texture})
