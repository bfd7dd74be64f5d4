/* SPDX-License-Identifier: Apache-2.0 */
/* An importer, an exporter, a denoiser and a material with an inspector and a table, each correct by itself; a macro
 * NATIVE_* makes one wrong. tests/scripts/test_check_native.py gives them manifests. */
#include <math.h>
#include <restage/denoiser.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/table.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(NATIVE_IMPORTER_CRASHES) || defined(NATIVE_IMPORTER_CUT) || defined(NATIVE_EXPORTER_CRASHES) || \
    defined(NATIVE_INSPECTOR_CRASHES) || defined(NATIVE_TABLE_CRASHES)
static int* volatile nowhere;
#endif

#if defined(NATIVE_IMPORTER_LOSES) || defined(NATIVE_EXPORTER_LOSES) || defined(NATIVE_DENOISER_LOSES)
char* volatile lost; /* the last leaked block */
#endif

#if defined(NATIVE_IMPORTER_WAITS) || defined(NATIVE_DENOISER_WAITS)
/* Signals a test that it is running, by creating the file named in the environment. */
static void mark(void) {
    const char* path = getenv("RESTAGE_TEST_MARK");
    FILE* file = path ? fopen(path, "wb") : NULL;
    if (file) fclose(file);
}
#endif

/* --- an importer of lines "x y size": one triangle each ---------------------------------------------------------- */

static int probe(const char* path, const void* head, size_t size) {
    (void)path;
#if defined(NATIVE_IMPORTER_SURE)
    (void)head;
    return size >= 4 ? 1000 : 0;
#elif defined(NATIVE_IMPORTER_DENIES)
    (void)head;
    return size > 1u << 20;
#else
    return size >= 4 && memcmp(head, "#tri", 4) == 0 ? 100 : 0;
#endif
}

static int load(const char* path, const RestageSceneWriter1* out) {
    FILE* file = fopen(path, "rb");
    char line[256];
    uint32_t number = 0;
    if (!file) {
        out->error(out->ctx, path, 0, 0, "cannot be opened");
        return 0;
    }
#if defined(NATIVE_IMPORTER_CRASHES)
    *nowhere = 1;
#elif defined(NATIVE_IMPORTER_LOSES)
    lost = (char*)malloc(100);
#endif
#if defined(NATIVE_IMPORTER_WAITS)
    mark();
    while (out->progress(out->ctx, 0.5f, "waiting")) {
    }
#endif
    while (fgets(line, sizeof line, file)) {
        double x, y, size;
        float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        static const uint32_t indices[3] = {0, 1, 2};
        RestageMesh mesh;
        RestageMaterialDesc material;
        RestageInstance instance;
        ++number;
        if (line[0] == '#' || line[0] == '\n') continue;
        if (sscanf(line, "%lf %lf %lf", &x, &y, &size) != 3) {
#if defined(NATIVE_IMPORTER_SILENT)
            fclose(file);
            return 0;
#elif !defined(NATIVE_IMPORTER_LEAKS)
            fclose(file);
#endif
            out->error(out->ctx, path, number, 1, "expected: x y size");
            return 0;
        }
        memset(&mesh, 0, sizeof mesh);
        memset(&material, 0, sizeof material);
        memset(&instance, 0, sizeof instance);
        mesh.size = sizeof mesh, material.size = sizeof material, instance.size = sizeof instance;
        mesh.vertex_count = 3, mesh.triangle_count = 1, mesh.positions = positions, mesh.indices = indices;
        mesh.source_file = "", mesh.primitive = "";
#if defined(NATIVE_IMPORTER_VARIES)
        {
            static float drift;
            positions[2] = drift += 1;
        }
#endif
        material.type = "diffuse";
        instance.alpha = 1;
        instance.mesh = out->mesh(out->ctx, &mesh);
        instance.material = out->material(out->ctx, &material);
        instance.object_to_world[0] = instance.object_to_world[5] = instance.object_to_world[10] = size;
        instance.object_to_world[12] = x, instance.object_to_world[13] = y, instance.object_to_world[15] = 1;
        out->instance(out->ctx, &instance);
#if defined(NATIVE_IMPORTER_CUT)
        if (!strchr(line, '\n')) *nowhere = 1; /* a line that ends with the file */
#endif
        if (!out->progress(out->ctx, 0.5f, "reading")) {
#if !defined(NATIVE_IMPORTER_DEAF)
            fclose(file);
            return 0;
#endif
        }
    }
    fclose(file);
    return 1;
}
static const RestageImporter1 importer = {sizeof(RestageImporter1), "tri", "Triangles", "tri", probe, load, NULL, 0};

/* --- an exporter of the names of all objects --------------------------------------------------------------------- */

#if defined(NATIVE_EXPORTER_IN_PLACE)
static void give_up(FILE* file, const char* part) {
    fclose(file);
    (void)part;
}
#else
static void give_up(FILE* file, const char* part) {
    fclose(file);
#if !defined(NATIVE_EXPORTER_LITTERS)
    remove(part);
#else
    (void)part;
#endif
}
#endif

static int save(const char* path, const RestageSceneReader1* in, const RestageValue* options, uint32_t count) {
    const uint32_t objects = in->count(in->ctx, RESTAGE_KIND_INSTANCE);
    char part[4096];
    uint32_t i;
    int bad;
    FILE* file;
    (void)options, (void)count;
#if defined(NATIVE_EXPORTER_IN_PLACE)
    snprintf(part, sizeof part, "%s", path);
#else
    snprintf(part, sizeof part, "%s.part", path);
#endif
#if defined(NATIVE_EXPORTER_LOSES)
    lost = (char*)malloc(100);
#endif
    file = fopen(part, "wb");
    if (!file) {
#if !defined(NATIVE_EXPORTER_SILENT)
        in->error(in->ctx, path, "cannot be written");
#endif
        return 0;
    }
    for (i = 1; i <= objects; ++i) {
        RestageInstance instance = {.size = sizeof instance};
        if (!in->instance(in->ctx, i, &instance)) {
#if defined(NATIVE_EXPORTER_CRASHES)
            *nowhere = 1; /* a null hole */
#endif
            continue;
        }
        fprintf(file, "%s\n", instance.name);
#if defined(NATIVE_EXPORTER_DEAF)
        in->progress(in->ctx, (float)i / (float)objects, "writing");
#else
        if (!in->progress(in->ctx, (float)i / (float)objects, "writing")) {
            give_up(file, part);
            return 0;
        }
#endif
    }
#if defined(NATIVE_EXPORTER_VARIES)
    {
        static int times;
        fprintf(file, "%d\n", ++times);
    }
#endif
    bad = fflush(file) != 0 || ferror(file);
#if defined(NATIVE_EXPORTER_CARELESS)
    bad = 0;
#endif
    if (bad) {
        in->error(in->ctx, path, "cannot be written: is the disk full?");
        give_up(file, part);
        return 0;
    }
    fclose(file);
    if (strcmp(part, path) != 0 && rename(part, path) != 0) {
        in->error(in->ctx, path, "cannot be replaced");
        remove(part);
        return 0;
    }
    return 1;
}
static const RestageExporter1 exporter = {sizeof(RestageExporter1), "names", "Names", "names", NULL, 0, save};

/* --- a denoiser that copies --------------------------------------------------------------------------------------- */

static int available(const char** reason) {
    *reason = "";
    return 1;
}

static int run(const RestageDenoiseJob* job, const char** reason) {
    const size_t count = (size_t)job->width * job->height * 3;
    size_t i;
    *reason = "";
#if defined(NATIVE_DENOISER_WAITS)
    mark();
    while (!job->progress || job->progress(job->progress_ctx, 0.5)) {
    }
#endif
#if defined(NATIVE_DENOISER_LOSES)
    lost = (char*)malloc(100);
#elif defined(NATIVE_DENOISER_SIZE)
    if (job->width != 96 || job->height != 64) {
        *reason = "only 96x64";
        return 0;
    }
#endif
    for (i = 0; i < count; ++i) {
#if defined(NATIVE_DENOISER_NAN)
        job->output[i] = job->color[i];
#else
        const float x = job->color[i];
        job->output[i] = x >= 0 ? (x < 65504.0f ? x : 65504.0f) : 0;
#endif
#if defined(NATIVE_DENOISER_GUIDES)
        job->output[i] += 0 * job->albedo[i]; /* may be NULL */
#endif
#if defined(NATIVE_DENOISER_DARKENS)
        job->output[i] *= 0.9f;
#elif defined(NATIVE_DENOISER_VARIES)
        {
            static float drift = 1;
            job->output[i] *= drift += 1e-7f;
        }
#endif
        if (i % 1024 == 0 && job->progress && !job->progress(job->progress_ctx, (double)i / (double)count)) {
#if !defined(NATIVE_DENOISER_DEAF)
            *reason = "stopped";
            return 0;
#endif
        }
    }
#if defined(NATIVE_DENOISER_OVERRUNS)
    job->output[count] = 0;
#endif
    return 1;
}
static const RestageDenoiser1 denoiser = {sizeof(RestageDenoiser1), "copy", "Copy", available, run};

/* --- a material with an inspector and a table ----------------------------------------------------------------------
 */

static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM("share", "Share", 0, 1, 0.5f, 0, "", "Of light."),
    RESTAGE_TABLE_PARAM("file", "File", NULL, 0, "Numbers."),
};
static const RestageMaterial1 material = {
    sizeof(RestageMaterial1), 0, "broken", "Broken", "broken", "broken.glsl", params, 2, "Grey."};

static void draw(const RestageUi1* ui, void* ctx) {
    static const char* const names[] = {"Half", "All"};
    RestageValue value = {.size = sizeof value};
    int chosen;
    if (!ui->get(ctx, "share", &value)) return;
    chosen = ui->combo(ctx, "Preset", names, 2, value.v[0] == 1);
    if (chosen >= 0) {
        value.v[0] = chosen ? 1.0f : 0.5f;
#if defined(NATIVE_INSPECTOR_RANGE)
        value.v[0] = 2;
#elif defined(NATIVE_INSPECTOR_CRASHES)
        *nowhere = 1;
#elif defined(NATIVE_INSPECTOR_HANGS)
        {
            static volatile int forever = 1;
            while (forever) {
            }
        }
#endif
        ui->set(ctx, names[chosen], &value, 1);
    }
    if (ui->begin_group(ctx, "More")) {
        ui->param(ctx, "share");
#if !defined(NATIVE_INSPECTOR_GROUP)
        ui->end_group(ctx);
#endif
    }
}
static const RestageInspector1 inspector = {sizeof(RestageInspector1), "broken", draw};

static int read(const char* param, const RestageTableFile1* file) {
    uint32_t head[2];
    uint32_t* words;
    (void)param;
    if (file->length < sizeof head) {
        file->error(file->ctx, 0, "is too short");
        return 0;
    }
    if (!file->bytes(file->ctx, 0, sizeof head, head)) return 0;
    words = file->append(file->ctx, 2);
    if (!words) return 0;
#if defined(NATIVE_TABLE_CRASHES)
    words[head[0] * 4096u] = head[1]; /* an index from the file, unchecked */
    *nowhere = (int)head[1];
#endif
    words[0] = head[0], words[1] = head[1];
    return 1;
}
static const RestageTable1 reader = {sizeof(RestageTable1), "broken", "dat", read};

static int init(const RestageHost* host) {
    (void)host;
    return 1;
}

static const void* query(const char* id, uint32_t index) {
    if (index != 0) return NULL;
#if defined(NATIVE_IS_IMPORTER)
    (void)&exporter, (void)&denoiser, (void)&material, (void)&inspector, (void)&reader;
    return strcmp(id, RESTAGE_IMPORTER1) == 0 ? &importer : NULL;
#elif defined(NATIVE_IS_EXPORTER)
    (void)&importer, (void)&denoiser, (void)&material, (void)&inspector, (void)&reader;
    return strcmp(id, RESTAGE_EXPORTER1) == 0 ? &exporter : NULL;
#elif defined(NATIVE_IS_DENOISER)
    (void)&importer, (void)&exporter, (void)&material, (void)&inspector, (void)&reader;
    return strcmp(id, RESTAGE_DENOISER1) == 0 ? &denoiser : NULL;
#else
    (void)&importer, (void)&exporter, (void)&denoiser;
    if (strcmp(id, RESTAGE_MATERIAL1) == 0) return &material;
    if (strcmp(id, RESTAGE_INSPECTOR1) == 0) return &inspector;
    return strcmp(id, RESTAGE_TABLE1) == 0 ? &reader : NULL;
#endif
}

RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {RESTAGE_ABI, sizeof(RestagePlugin), "org.example.broken", "1.0.0", init, NULL,
                                      query};
