/* SPDX-License-Identifier: Apache-2.0 */
/* Metal: the parameter table; the physics is in conductor.glsl, formulas and sources in README.md. */
#include "inspector.h"

#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_ROWS_CONDUCTOR("eta", "k"),
    RESTAGE_ROW_ROUGHNESS_U("uroughness", "Roughness u", 0),
    RESTAGE_ROW_ROUGHNESS_V("vroughness", "Roughness v", 0),
    RESTAGE_ROW_REMAP(0),
    RESTAGE_ROW_DISTRIBUTION,
    RESTAGE_ROW_MULTISCATTER,
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

RESTAGE_PLUGIN("org.restage.material.conductor", "0.1.0", {RESTAGE_MATERIAL1, &material},
               {RESTAGE_INSPECTOR1, &conductor_inspector})
