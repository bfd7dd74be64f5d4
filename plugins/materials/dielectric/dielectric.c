/* SPDX-License-Identifier: Apache-2.0 */
/* Glass: the parameter table; the physics is in dielectric.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    {"eta", "Index of refraction", RESTAGE_FLOAT, 0, 1, 3, {1.5f}, "", NULL, "Inside relative to outside: water 1.33, glass 1.5, diamond 2.4."},
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0),
    RESTAGE_ROW_REMAP(0),
    RESTAGE_ROW_DISTRIBUTION,
    {"reflectance", "Reflection tint", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {1, 1, 1}, "", NULL, "Multiplies what is reflected; white is physical."},
    {"transmittance", "Transmission tint", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {1, 1, 1}, "", NULL, "Multiplies what is transmitted; white is physical."},
    {"thin", "Thin", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "A pane without thickness: light passes straight on; roughness does not apply."},
    RESTAGE_ROW_MULTISCATTER,
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS | RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_TANGENT,
    .type = "dielectric",
    .label = "Glass",
    .prefix = "dielectric",
    .glsl_file = "dielectric.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Glass, water, clear plastic; smooth, rough or thin.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.dielectric", "0.1.0", material)
