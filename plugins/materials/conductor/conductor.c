/* SPDX-License-Identifier: Apache-2.0 */
/* Metal: the parameter table; the physics is in conductor.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"eta", "Index of refraction", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.200438f, 0.924033f, 1.102212f}, "", NULL, "Real part, for red, green and blue."},
    {"k", "Absorption", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 20, {3.912949f, 2.452848f, 2.142188f}, "", NULL, "Imaginary part of the index of refraction."},
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.9f, 0.9f, 0.9f}, "", NULL, "Colour seen head on; used in place of the optical constants when the switch below is on."},
    {"use_reflectance", "Use reflectance", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "Take the colour, not the optical constants."},
    {"uroughness", "Roughness u", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."},
    {"vroughness", "Roughness v", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."},
    {"remap", "Roughness scale", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 2, {0}, "", "v4|v3|none", "How roughness becomes the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as it is."},
    {"distribution", "Distribution", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 1, {0}, "", "ggx|beckmann", "Shape of the microfacets: GGX has the longer tails."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_TANGENT,
    .type = "conductor",
    .label = "Metal",
    .prefix = "conductor",
    .glsl_file = "conductor.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A metal, given by its optical constants or by a colour.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.conductor", "0.1.0", material)
