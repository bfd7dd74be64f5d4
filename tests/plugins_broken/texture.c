/* SPDX-License-Identifier: Apache-2.0 */
/* A texture, correct by itself: stripes of two values along u. A macro TEXTURE_* makes its native evaluation wrong in
 * one way; faults of its GLSL are macros in texture.glsl. tests/scripts/test_check_texture.py gives it manifests. */
#include <math.h>
#include <restage/texture.h>
#include <stddef.h>

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("one", "One", 0, 1, 0.8f, 0.1f, 0.1f, RESTAGE_PARAM_TEXTURABLE, "", "A stripe."),
    RESTAGE_COLOR_PARAM("other", "Other", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The next."),
    RESTAGE_FLOAT_PARAM("part", "Part", 0, 1, 0.5f, 0, "", "Fraction of a unit of u that the first covers."),
    RESTAGE_INT_PARAM("turns", "Turns", 1, 9, 1, 0, "", "Number of stripes per unit of u."),
    RESTAGE_BOOL_PARAM("along", "Along u", 0, 0, "Whether they run along u."),
};

static void eval(const RestageTextureAt1* at, float rgb[3]) {
    const float x = (at->whole[4] ? at->uv[1] : at->uv[0]) * (float)at->whole[3];
    const float* of = at->values;
    int k;
#if defined(TEXTURE_INDEX) /* index of the line, instead of four floats per line */
    if (x - floorf(x) >= at->values[2]) of += 4;
#else
    if (x - floorf(x) >= at->values[8]) of += 4;
#endif
#if defined(TEXTURE_CRASHES)
    if (at->whole[3] == 9) of = NULL;
#endif
    for (k = 0; k < 3; ++k) {
        rgb[k] = of[k];
#if defined(TEXTURE_FORMULA)
        rgb[k] = of[k] * of[k];
#endif
    }
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = RESTAGE_TEXTURE_MAPPED,
    .type = "broken",
    .label = "Broken",
    .prefix = "broken",
    .glsl_file = "broken.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Stripes.",
    .eval = eval,
};

RESTAGE_PLUGIN("org.example.broken", "1.0.0", {RESTAGE_TEXTURE1, &texture})
