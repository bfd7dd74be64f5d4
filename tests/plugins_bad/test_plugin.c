/* SPDX-License-Identifier: Apache-2.0 */
/* One plugin and its possible faults: built once for each TEST_* macro. */
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/table.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(TEST_IMPORTER_CRASHES) || defined(TEST_IMPORTER_HANGS) || defined(TEST_IMPORTER_EATS)
#define TEST_IMPORTER
#endif

#if defined(TEST_SMALL_ENTRY)
#define ENTRY_SIZE 8u
#else
#define ENTRY_SIZE sizeof(RestagePlugin)
#endif
#if defined(TEST_OTHER_ABI)
#define ENTRY_ABI 77u
#else
#define ENTRY_ABI RESTAGE_ABI
#endif
#if defined(TEST_SMALL_TABLE)
#define TABLE_SIZE 16u
#else
#define TABLE_SIZE sizeof(RestageMaterial1)
#endif
#if defined(TEST_BAD_PREFIX)
#define TABLE_PREFIX "gl_velvet"
#else
#define TABLE_PREFIX "velvet"
#endif
#if defined(TEST_BAD_PARAM_ID)
#define PARAM_ID "float"
#else
#define PARAM_ID "fuzz"
#endif
#if defined(TEST_BAD_DEFAULT)
#define PARAM_DEFAULT 2.0f
#else
#define PARAM_DEFAULT 0.5f
#endif
#if defined(TEST_BAD_ENUM)
#define ENUM_DEFAULT 2
#else
#define ENUM_DEFAULT 1
#endif

#if !defined(TEST_IMPORTER) && !defined(TEST_NO_TABLES)
static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM(PARAM_ID, "Fuzz", 0.0f, 1.0f, PARAM_DEFAULT, RESTAGE_PARAM_TEXTURABLE, "", "How fuzzy."),
#if defined(TEST_TABLE_UNREAD) || defined(TEST_TABLE_GREEDY)
    RESTAGE_TABLE_PARAM("weave", "Weave", NULL, 0, "A file."),
#elif defined(TEST_TABLE_DEFAULT_GONE)
    RESTAGE_TABLE_PARAM("weave", "Weave", "gone.dat", 0, "A file."),
#else
    RESTAGE_ENUM_PARAM("weave", "Weave", "plain|twill", ENUM_DEFAULT, 0, "Which weave."),
#endif
};
static const RestageMaterial1 material = {TABLE_SIZE,    0,      "velvet", "Velvet", TABLE_PREFIX,
                                          "velvet.glsl", params, 2,        "Cloth."};
#endif

#if defined(TEST_TABLE_OF_NONE) || defined(TEST_TABLE_GREEDY)
/* Requests more than exists and reads past the end, without reporting an error. */
static int read_table(const char* param_id, const RestageTableFile1* file) {
    char byte;
    (void)param_id;
    while (file->append(file->ctx, (uint64_t)1 << 40)) {
    }
    return file->bytes(file->ctx, file->length, 1, &byte);
}
static const RestageTable1 reader = {sizeof(RestageTable1), "velvet", "dat", read_table};
#endif

#if defined(TEST_IMPORTER)
static int probe(const char* path, const void* head, size_t size) {
    (void)path;
    return size >= 4 && memcmp(head, "TEST", 4) == 0 ? 50 : 0;
}
static int load(const char* path, const RestageSceneWriter1* out) {
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t indices[] = {0, 1, 2};
    const RestageMesh mesh = {.size = sizeof mesh,
                              .name = "triangle",
                              .vertex_count = 3,
                              .triangle_count = 1,
                              .positions = positions,
                              .indices = indices};
    const RestageMaterialDesc gray = {.size = sizeof gray, .name = "gray", .type = "velvet"};
    RestageInstance instance;
    RestageCamera camera;
    RestageFilm film;
    int i;
#if defined(TEST_IMPORTER_CRASHES)
    abort();
#elif defined(TEST_IMPORTER_HANGS)
    for (volatile int forever = 1; forever;)
        ;
#elif defined(TEST_IMPORTER_EATS) /* like a careless plugin that ignores malloc's result */
    for (;;)
        memset(malloc(1 << 26), 1, 1 << 26);
#endif
    memset(&instance, 0, sizeof instance);
    memset(&camera, 0, sizeof camera);
    memset(&film, 0, sizeof film);
    instance.size = sizeof instance, camera.size = sizeof camera, film.size = sizeof film;
    for (i = 0; i < 4; ++i)
        instance.object_to_world[5 * i] = camera.camera_to_world[5 * i] = 1;
    instance.alpha = 1;
    instance.mesh = out->mesh(out->ctx, &mesh);
    instance.material = out->material(out->ctx, &gray);
    if (!out->instance(out->ctx, &instance)) {
        out->error(out->ctx, path, 7, 3, "the host took no instance");
        return 0;
    }
    camera.fov = 40;
    camera.focal_distance = 1;
    out->camera(out->ctx, &camera);
    film.width = film.height = 8;
    film.crop[1] = film.crop[3] = 1;
    film.filter = "box";
    film.filter_radius[0] = film.filter_radius[1] = 0.5f;
    film.exposure = 1;
    out->film(out->ctx, &film);
    out->report(out->ctx, RESTAGE_DROPPED, path, 12, "light \"sun\"", "not known to the test");
    return out->progress(out->ctx, 1.0f, "done");
}
static const RestageImporter1 importer = {
    sizeof(RestageImporter1), "test", "Test format", "test", probe, load, NULL, 0};
#endif

static const RestageHost* used_host;

static int init(const RestageHost* host) {
    const RestageLog1* log = (const RestageLog1*)host->service(host, RESTAGE_LOG);
    used_host = host;
#if defined(TEST_CRASHES)
    abort();
#endif
    if (log) log->log(host, RESTAGE_LOG_INFO, "velvet is here");
#if defined(TEST_INIT_FAILS)
    return 0;
#else
    return log != NULL && host->service(host, "restage.nothing/9") == NULL;
#endif
}

static void leave(void) {
    const RestageLog1* log = (const RestageLog1*)used_host->service(used_host, RESTAGE_LOG);
    log->log(used_host, RESTAGE_LOG_INFO, "velvet leaves");
}

#if defined(TEST_UNRESOLVED)
int a_function_nobody_has(void);
#endif

static const void* query(const char* id, uint32_t index) {
#if defined(TEST_UNRESOLVED)
    if (a_function_nobody_has()) return NULL;
#endif
#if defined(TEST_NO_TABLES)
    (void)id, (void)index;
    return NULL;
#elif defined(TEST_IMPORTER)
    return strcmp(id, RESTAGE_IMPORTER1) == 0 && index == 0 ? (const void*)&importer : NULL;
#elif defined(TEST_ENDLESS)
    static RestageMaterial1 many[1000];
    static char names[1000][16];
    many[index] = material;
    names[index][0] = 'v';
    names[index][1] = (char)('a' + index % 26);
    names[index][2] = (char)('a' + index / 26 % 26);
    many[index].type = many[index].prefix = names[index];
    return strcmp(id, RESTAGE_MATERIAL1) == 0 ? &many[index] : NULL;
#elif defined(TEST_TABLE_OF_NONE) || defined(TEST_TABLE_GREEDY)
    if (strcmp(id, RESTAGE_TABLE1) == 0 && index == 0) return &reader;
    return strcmp(id, RESTAGE_MATERIAL1) == 0 && index == 0 ? &material : NULL;
#elif defined(TEST_TWICE)
    return strcmp(id, RESTAGE_MATERIAL1) == 0 && index < 2 ? &material : NULL;
#else
    return strcmp(id, RESTAGE_MATERIAL1) == 0 && index == 0 ? &material : NULL;
#endif
}

#if !defined(TEST_NO_SYMBOL)
RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {ENTRY_ABI, ENTRY_SIZE, "org.example.velvet", "1.0.0", init, leave, query};
#else
RESTAGE_EXPORT const RestagePlugin* something_else(void);
const RestagePlugin* something_else(void) {
    static const RestagePlugin plugin = {ENTRY_ABI, ENTRY_SIZE, "org.example.velvet", "1.0.0", init, leave, query};
    return &plugin;
}
#endif
