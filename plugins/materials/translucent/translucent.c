/* SPDX-License-Identifier: Apache-2.0 */
/* Translucent (v3): the parameter table; the physics is in translucent.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    {"kd", "Diffuse", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.25f, 0.25f, 0.25f}, "", NULL, "Scale of the diffuse part."},
    {"ks", "Glossy", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.25f, 0.25f, 0.25f}, "", NULL, "Scale of the glossy part."},
    {"reflect", "Reflection", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Scale of all that stays on the side of the light."},
    {"transmit", "Transmission", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Scale of all that passes to the other side."},
    {"roughness", "Roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.1f}, "", NULL, "Of the glossy part."},
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

RESTAGE_MATERIAL_PLUGIN("org.restage.material.translucent", "0.1.0", material)
