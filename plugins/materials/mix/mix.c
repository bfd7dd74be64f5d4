/* SPDX-License-Identifier: Apache-2.0 */
/* Mix: only a parameter table; the engine acts on the flag. */
#include <restage/material.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_MATERIAL_PARAM("first", "First", 0, "The material at an amount of 0."),
    RESTAGE_MATERIAL_PARAM("second", "Second", 0, "The material at an amount of 1."),
    RESTAGE_FLOAT_PARAM("amount", "Amount", 0, 1, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "Share of the second material."),
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_MIX,
    .type = "mix",
    .label = "Mix",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "A blend of two materials.",
};

RESTAGE_PLUGIN("org.restage.material.mix", "0.1.0", {RESTAGE_MATERIAL1, &material})
