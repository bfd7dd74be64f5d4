/* SPDX-License-Identifier: Apache-2.0 */
/* Interface: only a parameter table; the engine acts on the flag. */
#include <restage/material.h>

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_NULL,
    .type = "interface",
    .label = "Interface",
    .tooltip = "A null surface: the boundary of a medium.",
};

RESTAGE_PLUGIN("org.restage.material.interface", "0.1.0", {RESTAGE_MATERIAL1, &material})
