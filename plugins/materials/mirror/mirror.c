/* SPDX-License-Identifier: Apache-2.0 */
/* Mirror: the parameter table; the physics is in mirror.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"kr", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.9f, 0.9f, 0.9f}, "", NULL, "Share of the light that is reflected."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS,
    .type = "mirror",
    .label = "Mirror",
    .prefix = "mirror",
    .glsl_file = "mirror.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A perfect mirror.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.mirror", "0.1.0", material)
