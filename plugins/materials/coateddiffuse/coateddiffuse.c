/* SPDX-License-Identifier: Apache-2.0 */
/* Coated diffuse: the parameter table; the physics is in coateddiffuse.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("reflectance", "Reflectance", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Of the base under the coat."),
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0),
    RESTAGE_ROW_REMAP(0),
    RESTAGE_ROWS_COAT("eta"),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_STOCHASTIC | RESTAGE_MATERIAL_TANGENT,
    .type = "coateddiffuse",
    .label = "Coated diffuse",
    .prefix = "coateddiffuse",
    .glsl_file = "coateddiffuse.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Matte colour under a clear coat: varnished wood, ceramics, plastic.",
};

RESTAGE_PLUGIN("org.restage.material.coateddiffuse", "0.1.0", {RESTAGE_MATERIAL1, &material})
