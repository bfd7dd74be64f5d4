/* SPDX-License-Identifier: Apache-2.0 */
/* Uber (v3): the parameter table; the physics is in uber.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("kd", "Diffuse", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Reflectance of the matte part."),
    RESTAGE_COLOR_PARAM("ks", "Glossy", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the glossy part."),
    RESTAGE_COLOR_PARAM("kr", "Mirror", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the mirror reflection."),
    RESTAGE_COLOR_PARAM("kt", "Transmission", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the smooth refraction."),
    RESTAGE_COLOR_PARAM("opacity", "Opacity", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The complement to white passes straight through."),
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0.1f),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0.1f),
    RESTAGE_FLOAT_PARAM("eta", "Index of refraction", 1, 3, 1.5f, 0, "", "Inside relative to outside."),
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

RESTAGE_PLUGIN("org.restage.material.uber", "0.1.0", {RESTAGE_MATERIAL1, &material})
