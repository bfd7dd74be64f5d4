/* SPDX-License-Identifier: Apache-2.0 */
/* Hair and fur: the parameter table; the physics is in hair.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"color", "Colour", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.35f, 0.2f, 0.1f}, "", NULL, "Of many hairs together; one alone looks paler."},
    {"eta", "Index of refraction", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, 1.01f, 3, {1.55f}, "", NULL, "Of the hair's inside."},
    {"beta_m", "Roughness along", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0.05f, 1, {0.3f}, "", NULL, "Width of the highlights along the hair."},
    {"beta_n", "Roughness around", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0.05f, 1, {0.3f}, "", NULL, "Width of the highlights around the hair."},
    {"alpha", "Scale angle", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, 0, 10, {2}, "deg", NULL, "Tilt of the scales on the hair: it moves the highlights apart."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS | RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_NONRECIPROCAL |
             RESTAGE_MATERIAL_TANGENT,
    .type = "hair",
    .label = "Hair",
    .prefix = "hair",
    .glsl_file = "hair.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Hair or fur, on curves: light that is reflected, passes, or turns around inside.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.hair", "0.1.0", material)
