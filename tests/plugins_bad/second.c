/* SPDX-License-Identifier: Apache-2.0 */
/* A bundle for two generations of programs: "velvet" in both revisions of the interface, "silk" only in the second. */
#include "material2.h"

#include <restage/material.h>

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.8f, 0.4f, 0.2f, RESTAGE_PARAM_TEXTURABLE, "", ""),
};
static const RestageMaterial1 velvet = {
    .size = sizeof velvet,
    .type = "velvet",
    .label = "Velvet of the first",
    .prefix = "velvet",
    .glsl_file = "velvet.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
};
static const TestMaterial2 velvet2 = {sizeof velvet2, "velvet.glsl", "Velvet of the second", "tint=0.8 0.4 0.2"};
static const TestMaterial2 silk2 = {sizeof silk2, "silk.glsl", "Silk", "tint=0.8 0.4 0.2"};

RESTAGE_PLUGIN("org.example.cloth", "1.0.0", {RESTAGE_MATERIAL1, &velvet}, {TEST_MATERIAL2, &velvet2},
               {TEST_MATERIAL2, &silk2})
