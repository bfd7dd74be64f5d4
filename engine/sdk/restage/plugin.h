/* SPDX-License-Identifier: Apache-2.0 */
/* The entry point of a Restage plugin. C11.
 *
 * A plugin is a bundle: a folder with a manifest (plugin.json), and optionally a shared library and GLSL files. It may
 * provide several materials, an importer and an exporter, and anything else that has an interface. The manifest, which
 * the host reads before it opens the library, lists what it provides and needs. The library exports one symbol,
 * `restage_plugin`, of type RestagePlugin. Everything else is looked up by a string id with a revision
 * ("restage.material/1"); NULL means absent.
 * Whoever allocates frees; pointers passed to a call are valid only during it, unless stated otherwise. No C++ type,
 * exception or allocation crosses the ABI. Every function states its thread: [main] [worker] [any].
 *
 * Growth. Every struct that crosses the ABI begins with its `size`, as compiled by its writer. It may grow at its
 * end: members missing from a shorter one take the default their comment gives (0 or NULL if it gives none); the excess
 * of a longer one is ignored. Elements of an array lie `size` bytes apart: RESTAGE_AT finds them. A change that
 * this cannot express takes a new interface id ("restage.material/2"). */
#ifndef RESTAGE_PLUGIN_H
#define RESTAGE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Revision of the entry point itself. A library whose `abi` differs is refused with a message. */
#define RESTAGE_ABI 2u

/* The first member of every struct. C++ initializes it; in C write `.size = sizeof(RestageMaterial1)`. */
#ifdef __cplusplus
#define RESTAGE_SIZE(type) uint32_t size = sizeof(type)
#else
#define RESTAGE_SIZE(type) uint32_t size
#endif

/* Element i of an array of such structs compiled elsewhere: RESTAGE_AT(RestageValue, values, i). */
static inline const void* restage_at(const void* first, uint32_t size, size_t i) {
    return (const char*)first + i * size;
}
#define RESTAGE_AT(type, array, i) (*(const type*)restage_at((array), (array)->size, (i)))

#if defined(_WIN32)
#define RESTAGE_EXPORT __declspec(dllexport)
#else
#define RESTAGE_EXPORT __attribute__((visibility("default")))
#endif

/* Before the declaration of the exported symbol, in C as in C++. */
#ifdef __cplusplus
#define RESTAGE_C_LINKAGE extern "C"
#else
#define RESTAGE_C_LINKAGE extern
#endif

/* What the host offers. Services are found by id, for example "restage.log/1". */
typedef struct RestageHost {
    uint32_t abi;  /* RESTAGE_ABI of the host */
    uint32_t size; /* sizeof(RestageHost) in the host's build */
    const char* version; /* of the host, "0.1.0" */
    /* [any] Pointer to the service's table, valid as long as the plugin; NULL if the host does not have it. */
    const void* (*service)(const struct RestageHost* host, const char* id);
} RestageHost;

typedef struct RestagePlugin {
    uint32_t abi;  /* RESTAGE_ABI */
    uint32_t size; /* sizeof(RestagePlugin) in the plugin's build */
    const char* id;      /* reverse DNS, equal to the manifest's "id" */
    const char* version; /* equal to the manifest's "version" */
    /* [main] Once after loading; non-zero is success. May be NULL. `host` is valid until shutdown returns. */
    int (*init)(const RestageHost* host);
    /* [main] Once before unloading, only after a successful init. May be NULL. */
    void (*shutdown)(void);
    /* [main] The index-th table of the interface `id` ("restage.material/1"); NULL past the end, or if there is
     * none. Tables are valid until shutdown. */
    const void* (*query)(const char* id, uint32_t index);
} RestagePlugin;

#define RESTAGE_PLUGIN_SYMBOL "restage_plugin"

/* Defines the exported symbol, once, with everything the library provides:
 *
 *   RESTAGE_PLUGIN("org.example.cloth", "1.2.0",
 *                  {RESTAGE_MATERIAL1, &velvet},
 *                  {RESTAGE_MATERIAL1, &silk},
 *                  {RESTAGE_INSPECTOR1, &velvet_inspector})
 *
 * RESTAGE_PLUGIN_INIT takes the two functions as well; either may be NULL. A convenience: a plugin could write the same
 * itself. */
typedef struct RestageProvided { /* stays inside the plugin */
    const char* interface_id;
    const void* table;
} RestageProvided;

#define RESTAGE_PLUGIN_INIT(plugin_id, plugin_version, init, shutdown, ...)                                          \
    static const RestageProvided restage_provided[] = {__VA_ARGS__};                                                 \
    static const void* restage_query(const char* id, uint32_t index) {                                               \
        for (size_t i = 0; i < sizeof(restage_provided) / sizeof(restage_provided[0]); ++i)                          \
            if (strcmp(restage_provided[i].interface_id, id) == 0 && index-- == 0) return restage_provided[i].table; \
        return NULL;                                                                                                 \
    }                                                                                                                \
    RESTAGE_C_LINKAGE RESTAGE_EXPORT const RestagePlugin restage_plugin;                                             \
    const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), plugin_id, plugin_version, init,       \
                                          shutdown,    restage_query};
#define RESTAGE_PLUGIN(plugin_id, plugin_version, ...) \
    RESTAGE_PLUGIN_INIT(plugin_id, plugin_version, NULL, NULL, __VA_ARGS__)

/* Number of lines of a table. */
#define RESTAGE_COUNT(table) ((uint32_t)(sizeof(table) / sizeof((table)[0])))

#define RESTAGE_LOG "restage.log/1"
typedef enum RestageLogLevel { RESTAGE_LOG_INFO = 0, RESTAGE_LOG_WARNING = 1, RESTAGE_LOG_ERROR = 2 } RestageLogLevel;
typedef struct RestageLog1 {
    RESTAGE_SIZE(RestageLog1);
    void (*log)(const RestageHost* host, int level, const char* utf8_line); /* [any] */
} RestageLog1;

#ifdef __cplusplus
}
#endif
#endif
