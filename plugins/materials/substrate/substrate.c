/* SPDX-License-Identifier: Apache-2.0 */
/* Substrate: the parameter table; the physics is in substrate.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"kd", "Diffuse", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Reflectance of the base."},
    {"ks", "Specular", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f, 0.5f, 0.5f}, "", NULL, "Reflectance of the coat head on."},
    {"uroughness", "Roughness u", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.1f}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."},
    {"vroughness", "Roughness v", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.1f}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."},
    {"remap", "Roughness scale", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 2, {1}, "", "v4|v3|none", "How roughness becomes the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as it is."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_TANGENT,
    .type = "substrate",
    .label = "Substrate",
    .prefix = "substrate",
    .glsl_file = "substrate.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A glossy coat over a matte base (Ashikhmin-Shirley), as in pbrt-v3.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.substrate", "0.1.0", material)
