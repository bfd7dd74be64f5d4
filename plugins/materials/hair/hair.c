/* SPDX-License-Identifier: Apache-2.0 */
/* Hair and fur: the parameter table; the physics is in hair.glsl, formulas and sources in README.md. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("color", "Colour", 0, 1, 0.35f, 0.2f, 0.1f, RESTAGE_PARAM_TEXTURABLE, "", "Colour of many hairs together; one alone looks paler."),
    RESTAGE_FLOAT_PARAM("eta", "Index of refraction", 1.01f, 3, 1.55f, RESTAGE_PARAM_ADVANCED, "", "Of the hair's inside."),
    RESTAGE_FLOAT_PARAM("beta_m", "Roughness along", 0.05f, 1, 0.3f, RESTAGE_PARAM_TEXTURABLE, "", "Width of the highlights along the hair."),
    RESTAGE_FLOAT_PARAM("beta_n", "Roughness around", 0.05f, 1, 0.3f, RESTAGE_PARAM_TEXTURABLE, "", "Width of the highlights around the hair."),
    RESTAGE_FLOAT_PARAM("alpha", "Scale angle", 0, 10, 2, RESTAGE_PARAM_ADVANCED, "deg", "Tilt of the scales on the hair: it moves the highlights apart."),
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

RESTAGE_PLUGIN("org.restage.material.hair", "0.1.0", {RESTAGE_MATERIAL1, &material})
