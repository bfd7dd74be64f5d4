/* SPDX-License-Identifier: Apache-2.0 */
/* Uber (v3): the parameter table; the physics is in uber.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    {"kd", "Diffuse", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.25f, 0.25f, 0.25f}, "", NULL, "Reflectance of the matte part."},
    {"ks", "Glossy", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.25f, 0.25f, 0.25f}, "", NULL, "Scale of the glossy part."},
    {"kr", "Mirror", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0, 0, 0}, "", NULL, "Scale of the mirror reflection."},
    {"kt", "Transmission", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0, 0, 0}, "", NULL, "Scale of the smooth refraction."},
    {"opacity", "Opacity", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {1, 1, 1}, "", NULL, "What is missing to white passes straight through."},
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0.1f),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0.1f),
    {"eta", "Index of refraction", RESTAGE_FLOAT, 0, 1, 3, {1.5f}, "", NULL, "Inside relative to outside."},
    RESTAGE_ROW_REMAP(1),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_ADDITIVE | RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_TANGENT,
    .type = "uber",
    .label = "Uber (v3)",
    .prefix = "uber",
    .glsl_file = "uber.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Matte, gloss, mirror, refraction and opacity in one, as in pbrt-v3.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.uber", "0.1.0", material)
