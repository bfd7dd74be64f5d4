/* SPDX-License-Identifier: Apache-2.0 */
/* Plastic (v3): the parameter table; the physics is in plastic.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("kd", "Diffuse", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Reflectance of the matte part."),
    RESTAGE_COLOR_PARAM("ks", "Specular", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the glossy part."),
    RESTAGE_FLOAT_PARAM("roughness", "Roughness", 0, 1, 0.1f, RESTAGE_PARAM_TEXTURABLE, "", "Roughness of the glossy part."),
    RESTAGE_ROW_REMAP(1),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_ADDITIVE,
    .type = "plastic",
    .label = "Plastic (v3)",
    .prefix = "plastic",
    .glsl_file = "plastic.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Matte plus gloss, as in pbrt-v3; for new scenes take Coated diffuse.",
};

RESTAGE_PLUGIN("org.restage.material.plastic", "0.1.0", {RESTAGE_MATERIAL1, &material})
