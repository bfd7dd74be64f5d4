/* SPDX-License-Identifier: Apache-2.0 */
/* Coated diffuse: the parameter table; the physics is in coateddiffuse.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Of the base under the coat."},
    {"uroughness", "Roughness u", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."},
    {"vroughness", "Roughness v", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."},
    {"remap", "Roughness scale", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 2, {0}, "", "v4|v3|none", "How roughness becomes the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as it is."},
    {"thickness", "Coat thickness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.01f}, "", NULL, "Of the coat, in mean free paths of what fills it."},
    {"eta", "Coat index of refraction", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 1, 3, {1.5f}, "", NULL, "Of the coat relative to the outside."},
    {"g", "Coat anisotropy", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, -0.95f, 0.95f, {0}, "", NULL, "Of the scattering inside the coat: -1 back, 0 even, 1 forward."},
    {"albedo", "Coat albedo", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0, 0, 0}, "", NULL, "Of the particles inside the coat; black: a clear coat."},
    {"max_depth", "Coat bounces", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 100, {10}, "", NULL, "Most events inside the coat."},
    {"n_samples", "Coat samples", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 16, {1}, "", NULL, "Random walks a look at the coat: less noise, more time."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_STOCHASTIC | RESTAGE_MATERIAL_TANGENT,
    .type = "coateddiffuse",
    .label = "Coated diffuse",
    .prefix = "coateddiffuse",
    .glsl_file = "coateddiffuse.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Matte colour under a clear coat: varnished wood, ceramics, plastic.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.coateddiffuse", "0.1.0", material)
