/* SPDX-License-Identifier: Apache-2.0 */
/* Substrate: the parameter table; the physics is in substrate.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("kd", "Diffuse", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Reflectance of the base."),
    RESTAGE_COLOR_PARAM("ks", "Specular", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Reflectance of the coat at normal incidence."),
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0.1f),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0.1f),
    RESTAGE_ROW_REMAP(1),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_TANGENT,
    .type = "substrate",
    .label = "Substrate",
    .prefix = "substrate",
    .glsl_file = "substrate.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A glossy coat over a matte base (Ashikhmin-Shirley), as in pbrt-v3.",
};

RESTAGE_PLUGIN("org.restage.material.substrate", "0.1.0", {RESTAGE_MATERIAL1, &material})
