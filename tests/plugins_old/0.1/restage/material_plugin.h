/* SPDX-License-Identifier: Apache-2.0 */
/* The entry point of a library that holds one material and does nothing else, in one line at the end of its source:
 *     RESTAGE_MATERIAL_PLUGIN("org.example.velvet", "1.0.0", velvet)
 * where `velvet` is a static const RestageMaterial1. Sugar: nothing in it that a plugin could not write itself. */
#ifndef RESTAGE_MATERIAL_PLUGIN_H
#define RESTAGE_MATERIAL_PLUGIN_H

#include <restage/material.h>
#include <string.h>

#define RESTAGE_MATERIAL_PLUGIN(plugin_id, plugin_version, table)                                              \
    static const void* restage_query(const char* id, uint32_t index) {                                         \
        return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? &(table) : NULL;                             \
    }                                                                                                          \
    RESTAGE_EXPORT extern const RestagePlugin restage_plugin;                                                  \
    const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), plugin_id, plugin_version, NULL, \
                                          NULL,        restage_query};

/* Number of lines of a parameter table. */
#define RESTAGE_COUNT(table) ((uint32_t)(sizeof(table) / sizeof((table)[0])))

#endif
