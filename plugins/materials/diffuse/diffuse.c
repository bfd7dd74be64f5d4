/* SPDX-License-Identifier: Apache-2.0 */
/* Diffuse: the parameter table; the physics is in diffuse.glsl, formulas and sources in README.md. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("reflectance", "Reflectance", 0, 1, 0.5f, 0.5f, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Share of the light that is reflected."),
    RESTAGE_FLOAT_PARAM("sigma", "Roughness", 0, 90, 0, RESTAGE_PARAM_TEXTURABLE, "deg", "Spread of the facets of a rough matte surface such as clay (Oren-Nayar); 0 is Lambert."),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS,
    .type = "diffuse",
    .label = "Diffuse",
    .prefix = "diffuse",
    .glsl_file = "diffuse.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A matte surface: paint, paper, plaster.",
};

RESTAGE_PLUGIN("org.restage.material.diffuse", "0.1.0", {RESTAGE_MATERIAL1, &material})
