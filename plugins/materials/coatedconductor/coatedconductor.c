/* SPDX-License-Identifier: Apache-2.0 */
/* Coated metal: the parameter table; the physics is in coatedconductor.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"interface_uroughness", "Coat roughness u", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."},
    {"interface_vroughness", "Coat roughness v", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."},
    {"thickness", "Coat thickness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.01f}, "", NULL, "Of the coat, in mean free paths of what fills it."},
    {"interface_eta", "Coat index of refraction", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 1, 3, {1.5f}, "", NULL, "Of the coat relative to the outside."},
    {"g", "Coat anisotropy", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, -0.95f, 0.95f, {0}, "", NULL, "Of the scattering inside the coat: -1 back, 0 even, 1 forward."},
    {"albedo", "Coat albedo", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0, 0, 0}, "", NULL, "Of the particles inside the coat; black: a clear coat."},
    {"max_depth", "Coat bounces", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 100, {10}, "", NULL, "Most events inside the coat."},
    {"n_samples", "Coat samples", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 16, {1}, "", NULL, "Random walks a look at the coat: less noise, more time."},
    {"conductor_eta", "Index of refraction", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.200438f, 0.924033f, 1.102212f}, "", NULL, "Real part, for red, green and blue."},
    {"conductor_k", "Absorption", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 20, {3.912949f, 2.452848f, 2.142188f}, "", NULL, "Imaginary part of the index of refraction."},
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.9f, 0.9f, 0.9f}, "", NULL, "Of the metal head on; used in place of the optical constants when the switch below is on."},
    {"use_reflectance", "Use reflectance", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "Take the colour, not the optical constants."},
    {"conductor_uroughness", "Metal roughness u", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."},
    {"conductor_vroughness", "Metal roughness v", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."},
    {"remap", "Roughness scale", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 2, {0}, "", "v4|v3|none", "How roughness becomes the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as it is."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_STOCHASTIC | RESTAGE_MATERIAL_TANGENT,
    .type = "coatedconductor",
    .label = "Coated metal",
    .prefix = "coatedconductor",
    .glsl_file = "coatedconductor.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Metal under a clear coat: lacquered brass, car paint.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.coatedconductor", "0.1.0", material)
