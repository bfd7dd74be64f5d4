/* SPDX-License-Identifier: Apache-2.0 */
/* Velvet: the parameter table; the physics is in velvet.glsl, formulas and sources in README.md. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("reflectance", "Cloth", 0, 1, 0.1f, 0.02f, 0.03f, RESTAGE_PARAM_TEXTURABLE, "", "Colour of the matte cloth between the fibres."),
    RESTAGE_COLOR_PARAM("sheen", "Sheen", 0, 1, 0.8f, 0.3f, 0.35f, RESTAGE_PARAM_TEXTURABLE, "", "Colour of the fibres that stand on it."),
    RESTAGE_FLOAT_PARAM("roughness", "Roughness", 0, 1, 0.6f, RESTAGE_PARAM_TEXTURABLE, "", "Low: the fibres show at the rim only; high: everywhere. Its square is the model's."),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = 0,
    .type = "velvet",
    .label = "Velvet",
    .prefix = "velvet",
    .glsl_file = "velvet.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Cloth with standing fibres: velvet, felt, dust, the skin of a peach.",
};

RESTAGE_PLUGIN("org.restage.material.velvet", "0.1.0", {RESTAGE_MATERIAL1, &material})
