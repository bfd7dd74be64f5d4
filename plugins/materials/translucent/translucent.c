/* SPDX-License-Identifier: Apache-2.0 */
/* Translucent (v3): the parameter table; the physics is in translucent.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("kd", "Diffuse", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the diffuse part."),
    RESTAGE_COLOR_PARAM("ks", "Glossy", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of the glossy part."),
    RESTAGE_COLOR_PARAM("reflect", "Reflection", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of everything reflected."),
    RESTAGE_COLOR_PARAM("transmit", "Transmission", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Scale of everything transmitted."),
    RESTAGE_FLOAT_PARAM("roughness", "Roughness", 0, 1, 0.1f, RESTAGE_PARAM_TEXTURABLE, "", "Roughness of the glossy part."),
    RESTAGE_ROW_REMAP(1),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_ADDITIVE | RESTAGE_MATERIAL_NONRECIPROCAL,
    .type = "translucent",
    .label = "Translucent (v3)",
    .prefix = "translucent",
    .glsl_file = "translucent.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Diffuse and glossy scattering to both sides, as in pbrt-v3.",
};

RESTAGE_PLUGIN("org.restage.material.translucent", "0.1.0", {RESTAGE_MATERIAL1, &material})
