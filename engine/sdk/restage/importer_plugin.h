/* SPDX-License-Identifier: Apache-2.0 */
/* The entry point of a library that holds one importer and does nothing else, in one line at the end of its source:
 *     RESTAGE_IMPORTER_PLUGIN("org.example.importer.off", "1.0.0", off)
 * where `off` is a static const RestageImporter1. Sugar: nothing in it that a plugin could not write itself. */
#ifndef RESTAGE_IMPORTER_PLUGIN_H
#define RESTAGE_IMPORTER_PLUGIN_H

#include <restage/scene_io.h>
#include <string.h>

#define RESTAGE_IMPORTER_PLUGIN(plugin_id, plugin_version, table)                                              \
    static const void* restage_query(const char* id, uint32_t index) {                                         \
        return index == 0 && strcmp(id, RESTAGE_IMPORTER1) == 0 ? &(table) : NULL;                             \
    }                                                                                                          \
    RESTAGE_C_LINKAGE RESTAGE_EXPORT const RestagePlugin restage_plugin;                                       \
    const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), plugin_id, plugin_version, NULL, \
                                          NULL,        restage_query};

#endif
