/* SPDX-License-Identifier: Apache-2.0 */
/* Diffuse sheet: the parameter table; the physics is in diffusetransmission.glsl, formulas and sources in README.md. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("reflectance", "Reflectance", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Share of the light that is scattered back."),
    RESTAGE_COLOR_PARAM("transmittance", "Transmittance", 0, 1, 0.25f, 0.25f, 0.25f, RESTAGE_PARAM_TEXTURABLE, "", "Share of the light that is scattered through."),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS | RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_ADDITIVE,
    .type = "diffusetransmission",
    .label = "Diffuse sheet",
    .prefix = "diffusetransmission",
    .glsl_file = "diffusetransmission.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A thin sheet that lets diffuse light through: paper, leaf, curtain.",
};

RESTAGE_PLUGIN("org.restage.material.diffusetransmission", "0.1.0", {RESTAGE_MATERIAL1, &material})
