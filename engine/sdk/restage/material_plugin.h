/* SPDX-License-Identifier: Apache-2.0 */
/* The entry point of a library that holds one material and does nothing else, in one line at the end of its source:
 *     RESTAGE_MATERIAL_PLUGIN("org.example.velvet", "1.0.0", velvet)
 * where `velvet` is a static const RestageMaterial1; or, with a RestageInspector1 that draws its part of the inspector:
 *     RESTAGE_MATERIAL_PLUGIN_UI("org.example.velvet", "1.0.0", velvet, velvet_inspector)
 * or, with a RestageTable1 that reads the files of its RESTAGE_TABLE parameters:
 *     RESTAGE_MATERIAL_PLUGIN_TABLE("org.example.velvet", "1.0.0", velvet, velvet_reader)
 * or, with a RestageEmission1 that says by which of its parameters it shines:
 *     RESTAGE_MATERIAL_PLUGIN_EMISSION("org.example.velvet", "1.0.0", velvet, velvet_emission)
 * Sugar: nothing in it that a plugin could not write itself. */
#ifndef RESTAGE_MATERIAL_PLUGIN_H
#define RESTAGE_MATERIAL_PLUGIN_H

#include <restage/emission.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/table.h>
#include <string.h>

#define RESTAGE_MATERIAL_PLUGIN(plugin_id, plugin_version, table)                  \
    static const void* restage_query(const char* id, uint32_t index) {             \
        return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? &(table) : NULL; \
    }                                                                              \
    RESTAGE_PLUGIN_ENTRY(plugin_id, plugin_version)

/* With a RestageTable1 that reads its files. */
#define RESTAGE_MATERIAL_PLUGIN_TABLE(plugin_id, plugin_version, table, reader)                 \
    static const void* restage_query(const char* id, uint32_t index) {                          \
        if (index == 0 && strcmp(id, RESTAGE_TABLE1) == 0) return (const void*)&(reader);       \
        return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? (const void*)&(table) : NULL; \
    }                                                                                           \
    RESTAGE_PLUGIN_ENTRY(plugin_id, plugin_version)

/* With a RestageEmission1: it shines. */
#define RESTAGE_MATERIAL_PLUGIN_EMISSION(plugin_id, plugin_version, table, emission)            \
    static const void* restage_query(const char* id, uint32_t index) {                          \
        if (index == 0 && strcmp(id, RESTAGE_EMISSION1) == 0) return (const void*)&(emission);  \
        return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? (const void*)&(table) : NULL; \
    }                                                                                           \
    RESTAGE_PLUGIN_ENTRY(plugin_id, plugin_version)

#define RESTAGE_MATERIAL_PLUGIN_UI(plugin_id, plugin_version, table, inspector)                  \
    static const void* restage_query(const char* id, uint32_t index) {                           \
        if (index == 0 && strcmp(id, RESTAGE_INSPECTOR1) == 0) return (const void*)&(inspector); \
        return index == 0 && strcmp(id, RESTAGE_MATERIAL1) == 0 ? (const void*)&(table) : NULL;  \
    }                                                                                            \
    RESTAGE_PLUGIN_ENTRY(plugin_id, plugin_version)

/* The exported symbol, for a function restage_query(id, index). */
#define RESTAGE_PLUGIN_ENTRY(plugin_id, plugin_version)                                                        \
    RESTAGE_C_LINKAGE RESTAGE_EXPORT const RestagePlugin restage_plugin;                                       \
    const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), plugin_id, plugin_version, NULL, \
                                          NULL,        restage_query};

/* Number of lines of a parameter table. */
#define RESTAGE_COUNT(table) ((uint32_t)(sizeof(table) / sizeof((table)[0])))

#endif
