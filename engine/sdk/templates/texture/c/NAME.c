/* @LABEL@: the parameter table, and @NAME@.glsl in C for the CPU. */
#include <math.h>
#include <restage/texture.h>

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("one", "One", 0, 1, 0.8f, 0.4f, 0.2f, RESTAGE_PARAM_TEXTURABLE, "",
                        "Colour of the stripe at the origin."),
    RESTAGE_COLOR_PARAM("other", "Other", 0, 1, 0.9f, 0.9f, 0.9f, RESTAGE_PARAM_TEXTURABLE, "",
                        "Colour of the next stripe."),
    RESTAGE_FLOAT_PARAM("share", "Share", 0, 1, 0.5f, 0, "",
                        "Fraction of each unit of u that the first stripe covers."),
};

/* The same as the GLSL, for cut-outs on the CPU, which are slower without it. Four values per table line. */
static void eval(const RestageTextureAt1* at, float rgb[3]) {
    const float* of = at->values + (at->uv[0] - floorf(at->uv[0]) < at->values[8] ? 0 : 4);
    int k;
    for (k = 0; k < 3; ++k)
        rgb[k] = of[k];
}

static const RestageTexture1 texture = {
    .size = sizeof(RestageTexture1),
    .flags = RESTAGE_TEXTURE_MAPPED,
    .type = "@NAME@",
    .label = "@LABEL@",
    .prefix = "@NAME@",
    .glsl_file = "@NAME@.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "One sentence for users who are choosing a texture.",
    .eval = eval,
};

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_TEXTURE1, &texture})
