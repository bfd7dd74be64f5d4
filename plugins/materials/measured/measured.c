/* SPDX-License-Identifier: Apache-2.0 */
/* Measured: the parameter table. merl.c reads the file, measured.glsl looks it up; formulas and sources in README.md.
 */
#include "merl.h"

#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"filename", "File", RESTAGE_TABLE, 0, 0, 0, {0}, "", "glossy_paint.binary", "Reflection as it was measured: a file of the MERL BRDF database (.binary)."},
    {"tint", "Tint", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {1, 1, 1}, "", NULL, "Multiplies what was measured."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = 0,
    .type = "measured",
    .label = "Measured",
    .prefix = "measured",
    .glsl_file = "measured.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A surface as an instrument saw it, from a file of the MERL BRDF database.",
};

static const RestageTable1 reader = {
    .size = sizeof(RestageTable1), .type = "measured", .extensions = "binary", .read = merl_read};

RESTAGE_MATERIAL_PLUGIN_TABLE("org.restage.material.measured", "0.1.0", material, reader)
