/* SPDX-License-Identifier: Apache-2.0 */
/* Velvet: the parameter table; the physics is in velvet.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"reflectance", "Cloth", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.1f, 0.02f, 0.03f}, "", NULL, "Of the matte cloth between the fibres."},
    {"sheen", "Sheen", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.8f, 0.3f, 0.35f}, "", NULL, "Of the fibres that stand on it."},
    {"roughness", "Roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.6f}, "", NULL, "Low: the fibres shine at the rim only; high: everywhere. Its square is the model's."},
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

RESTAGE_MATERIAL_PLUGIN("org.restage.material.velvet", "0.1.0", material)
