/* @LABEL@: the parameter table; the physics is in @NAME@.glsl. */
#include <restage/material.h>

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.8f, 0.4f, 0.2f, RESTAGE_PARAM_TEXTURABLE, "",
                        "Fraction of light that is reflected."),
};

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS,
    .type = "@NAME@",
    .label = "@LABEL@",
    .prefix = "@NAME@",
    .glsl_file = "@NAME@.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "One sentence for users who are choosing a material.",
};

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_MATERIAL1, &material})
