/* SPDX-License-Identifier: Apache-2.0 */
/* The entry point of a Restage plugin. C11; a released table never changes: growth is a new interface id.
 *
 * A plugin is a folder with a manifest (plugin.json), a shared library and, for materials, GLSL. The host reads the
 * manifest before it opens the library. The library exports one symbol, `restage_plugin`, of type RestagePlugin.
 * Everything else is found by string id with a revision ("restage.material/1"); NULL means absent.
 * Whoever allocates frees; pointers given to a call are valid for that call only, unless said otherwise. No C++ type,
 * exception or allocation crosses the line. Every function says its thread: [main] [worker] [any]. */
#ifndef RESTAGE_PLUGIN_H
#define RESTAGE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Revision of the entry point itself. A library whose `abi` differs is refused with a sentence. */
#define RESTAGE_ABI 1u

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
    uint32_t size; /* sizeof(RestageHost) as the host was built */
    const char* version; /* of the host, "0.1.0" */
    /* [any] Pointer to the service's table, alive as long as the plugin is; NULL if the host does not have it. */
    const void* (*service)(const struct RestageHost* host, const char* id);
} RestageHost;

typedef struct RestagePlugin {
    uint32_t abi;        /* RESTAGE_ABI */
    uint32_t size;       /* sizeof(RestagePlugin) as the plugin was built */
    const char* id;      /* reverse DNS, equal to the manifest's "id" */
    const char* version; /* equal to the manifest's "version" */
    /* [main] Once after loading; non-zero is success. May be NULL. `host` lives until shutdown returns. */
    int (*init)(const RestageHost* host);
    /* [main] Once before unloading, only after a successful init. May be NULL. */
    void (*shutdown)(void);
    /* [main] The i-th interface of kind `id` ("restage.material/1"), NULL past the end or when unknown.
     * One library may hold several materials. Tables live until shutdown. */
    const void* (*query)(const char* id, uint32_t index);
} RestagePlugin;

#define RESTAGE_PLUGIN_SYMBOL "restage_plugin"
/* In exactly one source file of the plugin:  RESTAGE_C_LINKAGE RESTAGE_EXPORT const RestagePlugin restage_plugin; */

#define RESTAGE_LOG "restage.log/1"
typedef enum RestageLogLevel { RESTAGE_LOG_INFO = 0, RESTAGE_LOG_WARNING = 1, RESTAGE_LOG_ERROR = 2 } RestageLogLevel;
typedef struct RestageLog1 {
    uint32_t size;
    void (*log)(const RestageHost* host, int level, const char* utf8_line); /* [any] */
} RestageLog1;

#ifdef __cplusplus
}
#endif
#endif
