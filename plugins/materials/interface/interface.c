/* SPDX-License-Identifier: Apache-2.0 */
/* Interface: the parameter table is all there is; the engine acts on the flag. */
#include <restage/material.h>

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_NULL,
    .type = "interface",
    .label = "Interface",
    .tooltip = "No surface at all: the border of a medium.",
};

RESTAGE_PLUGIN("org.restage.material.interface", "0.1.0", {RESTAGE_MATERIAL1, &material})
