/* SPDX-License-Identifier: Apache-2.0 */
/* Mix: the parameter table is all there is; the engine acts on the flag. */
#include <restage/material_plugin.h>

/* clang-format off */
static const RestageParam params[] = {
    {"first", "First", RESTAGE_MATERIAL, 0, 0, 0, {0}, "", NULL, "Where the amount is 0."},
    {"second", "Second", RESTAGE_MATERIAL, 0, 0, 0, {0}, "", NULL, "Where the amount is 1."},
    {"amount", "Amount", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f}, "", NULL, "Share of the second material."},
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_MIX,
    .type = "mix",
    .label = "Mix",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A share of two materials, point by point.",
};

RESTAGE_MATERIAL_PLUGIN("org.restage.material.mix", "0.1.0", material)
