/* SPDX-License-Identifier: Apache-2.0 */
/* Coated metal: the parameter table; the physics is in coatedconductor.glsl, formulas and sources in README.md. */
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_ROW_ROUGHNESS_U("interface_uroughness", "Coat roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("interface_vroughness", "Coat roughness v", 0),
    RESTAGE_ROWS_COAT("interface_eta"),
    RESTAGE_ROWS_CONDUCTOR("conductor_eta", "conductor_k"),
    RESTAGE_ROW_ROUGHNESS_U("conductor_uroughness", "Metal roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("conductor_vroughness", "Metal roughness v", 0),
    RESTAGE_ROW_REMAP(0),
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

RESTAGE_PLUGIN("org.restage.material.coatedconductor", "0.1.0", {RESTAGE_MATERIAL1, &material})
