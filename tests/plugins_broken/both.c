/* SPDX-License-Identifier: Apache-2.0 */
/* A bundle of an importer and an exporter of one format, nine numbers per triangle, correct by itself; a macro BOTH_*
 * makes the round trip change the scene. */
#include <restage/scene_io.h>
#include <stdio.h>
#include <string.h>

static int probe(const char* path, const void* head, size_t size) {
    (void)path;
    return size >= 5 && memcmp(head, "#both", 5) == 0 ? 100 : 0;
}

static int load(const char* path, const RestageSceneWriter1* out) {
    FILE* file = fopen(path, "rb");
    char line[512];
    if (!file) {
        out->error(out->ctx, path, 0, 0, "cannot be opened");
        return 0;
    }
    while (fgets(line, sizeof line, file)) {
        static const uint32_t indices[3] = {0, 1, 2};
        float p[9];
        RestageMesh mesh = {.size = sizeof mesh, .vertex_count = 3, .triangle_count = 1, .indices = indices};
        RestageMaterialDesc material = {.size = sizeof material, .type = "diffuse"};
        RestageInstance instance = {.size = sizeof instance, .alpha = 1};
        if (line[0] == '#') continue;
        if (sscanf(line, "%f %f %f %f %f %f %f %f %f", p, p + 1, p + 2, p + 3, p + 4, p + 5, p + 6, p + 7, p + 8) !=
            9) {
            out->error(out->ctx, path, 0, 0, "expected: nine numbers");
            fclose(file);
            return 0;
        }
        mesh.positions = p;
        instance.mesh = out->mesh(out->ctx, &mesh);
        instance.material = out->material(out->ctx, &material);
        instance.object_to_world[0] = instance.object_to_world[5] = instance.object_to_world[10] = 1;
        instance.object_to_world[15] = 1;
        if (!out->instance(out->ctx, &instance) || !out->progress(out->ctx, 0.5f, "reading")) {
            fclose(file);
            return 0;
        }
    }
    fclose(file);
    return 1;
}
static const RestageImporter1 importer = {
    .size = sizeof importer, .format = "both", .label = "Both", .extensions = "both", .probe = probe, .load = load};

static void corner(FILE* file, const float* p, const double* m) {
    int row;
    for (row = 0; row < 3; ++row) {
#if defined(BOTH_TRANSPOSED)
        const double x = m[4 * row] * p[0] + m[4 * row + 1] * p[1] + m[4 * row + 2] * p[2] + m[12 + row];
#else
        const double x = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
#endif
#if defined(BOTH_DIGITS)
        fprintf(file, "%.3g ", x);
#else
        fprintf(file, "%.9g ", x);
#endif
    }
}

static int save(const char* path, const RestageSceneReader1* in, const RestageValue* options, uint32_t count) {
    const uint32_t objects = in->count(in->ctx, RESTAGE_KIND_INSTANCE);
    FILE* file = fopen(path, "wb");
    RestageHandle handle;
    (void)options, (void)count;
    if (!file) {
        in->error(in->ctx, path, "cannot be written");
        return 0;
    }
    fprintf(file, "#both\n");
#if defined(BOTH_REFUSED)
    fprintf(file, "a title\n");
#endif
    for (handle = 1; handle <= objects; ++handle) {
        RestageInstance instance = {.size = sizeof instance};
        RestageMesh mesh = {.size = sizeof mesh};
        uint32_t i;
        if (!in->instance(in->ctx, handle, &instance) || !in->mesh(in->ctx, instance.mesh, &mesh)) continue;
#if defined(BOTH_LOSES)
        for (i = 3; i < 3 * mesh.triangle_count; ++i) {
#else
        for (i = 0; i < 3 * mesh.triangle_count; ++i) {
#endif
            corner(file, mesh.positions + 3 * mesh.indices[i], instance.object_to_world);
            if (i % 3 == 2) fprintf(file, "\n");
        }
    }
    fclose(file);
    return 1;
}
static const RestageExporter1 exporter = {
    .size = sizeof exporter, .format = "both", .label = "Both", .extensions = "both", .save = save};

RESTAGE_PLUGIN("org.example.broken", "1.0.0", {RESTAGE_IMPORTER1, &importer}, {RESTAGE_EXPORTER1, &exporter})
