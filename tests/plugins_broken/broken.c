/* SPDX-License-Identifier: Apache-2.0 */
/* A rough metal, and the possible faults of a plugin's native code: built once for each BROKEN_* macro. */
#include <restage/material.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(BROKEN_SMALL_SIZE)
#define TABLE_SIZE 16u
#else
#define TABLE_SIZE sizeof(RestageMaterial1)
#endif

#define ROUGHNESS RESTAGE_FLOAT_PARAM("roughness", "Roughness", 0, 1, 0.3f, 0, "", "Its square is alpha.")
#define TINT RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.9f, 0.9f, 0.9f, 0, "", "Multiplies the reflection.")

#if defined(BROKEN_COUNT_LIES)
/* What follows two lines is not a table line. */
#define WILD ((const char*)16)
#define NOWHERE {sizeof(RestageParam), RESTAGE_FLOAT, 0, 0, 0, 0, 0, 1, {0}, WILD, WILD, WILD, NULL, WILD}
static const RestageParam params[] = {ROUGHNESS, TINT, NOWHERE, NOWHERE};
#define PARAM_COUNT 4
#else
static const RestageParam params[] = {ROUGHNESS, TINT};
#define PARAM_COUNT 2
#endif

static const RestageMaterial1 material = {TABLE_SIZE,    0,      "broken",    "Broken",        "broken",
                                          "broken.glsl", params, PARAM_COUNT, "A rough metal."};

static int init(const RestageHost* host) {
    (void)host;
#if defined(BROKEN_CRASHES)
    static int* volatile nowhere;
    *nowhere = 1;
#elif defined(BROKEN_EXITS)
    exit(3);
#elif defined(BROKEN_HANGS)
    static volatile int forever = 1;
    while (forever) {
    }
#elif defined(BROKEN_LEAKS)
    static char* volatile lost;
    lost = (char*)malloc(100000);
    if (lost) memset(lost, 1, 100000);
#elif defined(BROKEN_TALKS)
    printf("\x1frestage-check nonsense\n\n{\"event\": \"end\"}\nno newline at the end");
    fflush(stdout);
#endif
    return 1;
}

static const void* query(const char* id, uint32_t index) {
    return strcmp(id, RESTAGE_MATERIAL1) == 0 && index == 0 ? &material : NULL;
}

RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), "org.example.broken", "1.0.0", init, NULL,
                                      query};
