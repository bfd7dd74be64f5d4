/* SPDX-License-Identifier: Apache-2.0 */
/* Measured: the parameter table. merl.c reads the file, measured.glsl looks it up; formulas and sources in README.md.
 */
#include "merl.h"

#include <restage/material.h>
#include <restage/table.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_TABLE_PARAM("filename", "File", "glossy_paint.binary", 0, "Measured reflection: a file of the MERL BRDF database (.binary)."),
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "Multiplies what was measured."),
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
    .tooltip = "A measured surface, from a file of the MERL BRDF database.",
};

static const RestageTable1 reader = {
    .size = sizeof(RestageTable1), .type = "measured", .extensions = "binary", .read = merl_read};

RESTAGE_PLUGIN("org.restage.material.measured", "0.1.0", {RESTAGE_MATERIAL1, &material}, {RESTAGE_TABLE1, &reader})
