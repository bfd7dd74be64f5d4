/* SPDX-License-Identifier: Apache-2.0 */
/* A plugin as somebody wrote and built it for release 0.1. */
#include <restage/material_plugin.h>
#include <restage/material_rows.h>

static int init(const RestageHost* host) {
    const RestageLog1* log = (const RestageLog1*)host->service(host, RESTAGE_LOG);
    if (!log || log->size < sizeof(RestageLog1) || host->size < sizeof(RestageHost)) return 0;
    log->log(host, RESTAGE_LOG_INFO, "velvet of 0.1 is here");
    return 1;
}

static const RestageParam params[] = {
    {"tint", "Tint", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.4f, 0.1f, 0.2f}, "", NULL, "Of the cloth."},
    {"fuzz", "Fuzz", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, 0, 2, {0.5f}, "m", NULL, "How fuzzy."},
    RESTAGE_ROW_REMAP(1),
};
static const RestageMaterial1 velvet = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_NONRECIPROCAL,
    .type = "velvet",
    .label = "Velvet",
    .prefix = "velvet",
    .glsl_file = "velvet.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Cloth.",
};
static const void* query(const char* id, uint32_t index) {
    return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? &velvet : NULL;
}
RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), "org.example.velvet", "1.0.0", init, NULL,
                                      query};
