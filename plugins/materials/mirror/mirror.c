/* SPDX-License-Identifier: Apache-2.0 */
/* Mirror: the parameter table; the physics is in mirror.glsl, formulas and sources in README.md. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("kr", "Reflectance", 0, 1, 0.9f, 0.9f, 0.9f, RESTAGE_PARAM_TEXTURABLE, "", "Share of the light that is reflected."),
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

RESTAGE_PLUGIN("org.restage.material.mirror", "0.1.0", {RESTAGE_MATERIAL1, &material})
