/* SPDX-License-Identifier: Apache-2.0 */
/* Diffuse: the parameter table; the physics is in diffuse.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Share of the light that is reflected."},
    {"sigma", "Roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 90, {0}, "deg", NULL, "Spread of the facets of a rough matte surface such as clay (Oren-Nayar); 0 is Lambert."},
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

RESTAGE_MATERIAL_PLUGIN("org.restage.material.diffuse", "0.1.0", material)
