/* SPDX-License-Identifier: Apache-2.0 */
/* Checkerboard: the parameter table, and checkerboard.glsl in C for the CPU. */
#include <math.h>
#include <restage/texture.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tex1", "First", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "Value of the square at the origin."),
    RESTAGE_COLOR_PARAM("tex2", "Second", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "Value of its neighbours."),
};
/* clang-format on */

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    const float parity = floorf(at->uv[0]) + floorf(at->uv[1]);
    const float* of = at->values + (parity - 2 * floorf(parity / 2) < 0.5f ? 0 : 4);
    for (int k = 0; k < 3; ++k)
        rgb[k] = of[k];
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = RESTAGE_TEXTURE_MAPPED,
    .type = "checkerboard",
    .label = "Checkerboard",
    .prefix = "checkerboard",
    .glsl_file = "checkerboard.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Alternating unit squares of u and v.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.restage.texture.checkerboard", "0.1.0", {RESTAGE_TEXTURE1, &texture})
