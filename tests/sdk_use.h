/* SPDX-License-Identifier: Apache-2.0 */
/* A typical plugin, compiled in every language that the SDK supports (tests/CMakeLists.txt). */
#include <restage/material.h>

static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM("fuzz", "Fuzz", 0, 1, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "How fuzzy."),
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.8f, 0.4f, 0.2f, 0, "", "Of all of it."),
    RESTAGE_INT_PARAM("layers", "Layers", 1, 9, 2, 0, "", "How many."),
    RESTAGE_ENUM_PARAM("weave", "Weave", "plain|twill", 1, 0, "Which weave."),
};
static const RestageMaterial1 velvet = {
    sizeof(RestageMaterial1), 0, "velvet", "Velvet", "velvet", "velvet.glsl", params, RESTAGE_COUNT(params), "Cloth."};

RESTAGE_PLUGIN("org.example.velvet", "1.0.0", {RESTAGE_MATERIAL1, &velvet})
