/* SPDX-License-Identifier: Apache-2.0 */
/* Emissive: a surface that emits. The host makes lights of its users; see restage/emission.h and README.md. */
#include <restage/emission.h>
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("radiance", "Colour", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "Colour of the light; with a picture, a screen or a lit sign."),
    RESTAGE_FLOAT_PARAM("scale", "Brightness", 0, 1000, 10, 0, "W/(m²sr)", "Radiance where the colour is 1: independent of distance."),
    RESTAGE_BOOL_PARAM("two_sided", "Two-sided", 0, 0, "Shines from the back of its surface, too."),
    RESTAGE_COLOR_PARAM("reflectance", "Reflectance", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "Share of other light that it reflects, as a matte surface."),
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
    .tooltip = "A surface that emits light: a lamp's shade, a screen, a lit sign.",
};

static const RestageEmission1 emission = {
    .size = sizeof(RestageEmission1),
    .type = "emissive",
    .radiance = "radiance",
    .scale = "scale",
    .two_sided = "two_sided",
};

RESTAGE_PLUGIN("org.restage.material.emissive", "0.1.0", {RESTAGE_MATERIAL1, &material}, {RESTAGE_EMISSION1, &emission})
