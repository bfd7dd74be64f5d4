/* SPDX-License-Identifier: Apache-2.0 */
/* Glass: the parameter table; the physics is in dielectric.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM("eta", "Index of refraction", 1, 3, 1.5f, 0, "", "Inside relative to outside: water 1.33, glass 1.5, diamond 2.4."),
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0),
    RESTAGE_ROW_REMAP(0),
    RESTAGE_ROW_DISTRIBUTION,
    RESTAGE_COLOR_PARAM("reflectance", "Reflection tint", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "Multiplies what is reflected; white is physical."),
    RESTAGE_COLOR_PARAM("transmittance", "Transmission tint", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "Multiplies what is transmitted; white is physical."),
    RESTAGE_BOOL_PARAM("thin", "Thin", 0, 0, "A pane without thickness: light passes straight on; roughness does not apply."),
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

RESTAGE_PLUGIN("org.restage.material.dielectric", "0.1.0", {RESTAGE_MATERIAL1, &material})
