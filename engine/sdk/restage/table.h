/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.table/1": a file of numbers that a material looks up, such as a measured BRDF.
 *
 * A material's parameter of type RESTAGE_TABLE holds the path of a file. The host opens it; the plugin's `read` checks
 * the bytes and turns them into 32-bit words, in whatever order its GLSL expects. The host keeps the words, uploads
 * them once for all materials that name the file, and rereads it when it changes. The GLSL sees a `Table`:
 *
 *   #include <restage/v1/table.glsl>
 *   uint  table_size (Table t)          words; 0 = no file
 *   uint  table_word (Table t, uint i)  0 past the end
 *   float table_float(Table t, uint i)  the same bits as a float
 *
 * A file that `read` refuses is reported, and the material shows as grey until it is fixed. */
#ifndef RESTAGE_TABLE_H
#define RESTAGE_TABLE_H

#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_TABLE1 "restage.table/1"

/* The file and the destination of its words. [worker] Every function, only during read, on its thread. */
typedef struct RestageTableFile1 {
    RESTAGE_SIZE(RestageTableFile1);
    uint32_t reserved;
    void* ctx;
    const char* path; /* for messages only */
    uint64_t length;  /* of the file, in bytes */
    /* Copies `count` bytes from `offset` on. 1 = done; 0 = fewer exist, or reading failed: the host has
     * recorded why; return 0. */
    int (*bytes)(void* ctx, uint64_t offset, uint64_t count, void* out);
    /* Appends `count` zero words and returns them, valid until the next call. NULL = more than the host takes
     * (1 GiB per table): recorded; return 0. */
    uint32_t* (*append)(void* ctx, uint64_t count);
    /* A line for the log: "3.1 % of the entries were not measured". The host prepends the path. */
    void (*note)(void* ctx, const char* utf8_line);
    /* Why the file is unusable, and what to do: a sentence without the path. `line`: in a text file, else 0. Only the
     * first call is shown. */
    void (*error)(void* ctx, uint32_t line, const char* sentence);
} RestageTableFile1;

typedef struct RestageTable1 {
    RESTAGE_SIZE(RestageTable1);
    const char* type; /* of a material in the same plugin with a RESTAGE_TABLE */
    const char* extensions; /* "binary|dat", without dots: what the file browser shows initially */
    /* [worker] For any file, however broken. One call at a time. 1 = the words are complete; 0 = refused: error() has
     * been called. */
    int (*read)(const char* param_id, const RestageTableFile1* file);
} RestageTable1;

#ifdef __cplusplus
}
#endif
#endif
