/* SPDX-License-Identifier: Apache-2.0 */
/* Emissive: a surface that shines. The host makes lights of what has it; see restage/emission.h and README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"radiance", "Colour", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {1, 1, 1}, "", NULL, "Colour of the light; a picture makes a screen or a lit sign of it."},
    {"scale", "Brightness", RESTAGE_FLOAT, 0, 0, 1000, {10}, "W/(m²sr)", NULL, "Radiance where the colour is 1: the same from near and from far."},
    {"two_sided", "Two-sided", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "Shines from the back of its surface, too."},
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0, 0, 0}, "", NULL, "Share of other light that it reflects, as a matte surface."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .type = "emissive",
    .label = "Emissive",
    .prefix = "emissive",
    .glsl_file = "emissive.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A surface that shines: a lamp's shade, a screen, a lit sign.",
};

static const RestageEmission1 emission = {
    .size = sizeof(RestageEmission1),
    .type = "emissive",
    .radiance = "radiance",
    .scale = "scale",
    .two_sided = "two_sided",
};

RESTAGE_MATERIAL_PLUGIN_EMISSION("org.restage.material.emissive", "0.1.0", material, emission)
