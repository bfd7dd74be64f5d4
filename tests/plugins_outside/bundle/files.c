/* SPDX-License-Identifier: Apache-2.0 */
/* An importer with an option and an exporter for one format, and a denoiser. The format: a line "towers 1", then a line
 * "X Z HEIGHT" for each box of 1 x HEIGHT x 1 that stands on y = 0. */
#include "bundle.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int towers_probe(const char* path, const void* head, size_t size) {
    (void)path;
    return size >= 9 && memcmp(head, "towers 1\n", 9) == 0 ? 100 : 0;
}

static RestageHandle box(const RestageSceneWriter1* out) {
    static const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    static const uint32_t sides[] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                     3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5};
    RestageMesh mesh = {.size = sizeof mesh, .name = "box"};
    mesh.vertex_count = 8, mesh.positions = corners;
    mesh.triangle_count = 12, mesh.indices = sides;
    return out->mesh(out->ctx, &mesh);
}

static int towers_read(FILE* file, const char* path, const RestageSceneWriter1* out, double scale) {
    const RestageHandle mesh = box(out);
    RestageMaterialDesc grey = {.size = sizeof grey, .name = "tower", .type = "chalk"};
    const RestageHandle material = out->material(out->ctx, &grey);
    char line[256];
    uint32_t number = 0;
    while (fgets(line, sizeof line, file)) {
        RestageInstance it = {.size = sizeof it, .name = "tower", .mesh = mesh, .material = material, .alpha = 1};
        char rest;
        double x, z, height;
        if (!out->progress(out->ctx, 0.5f, "reading")) return 0;
        if (++number == 1) continue;
        if (sscanf(line, "%lf %lf %lf %c", &x, &z, &height, &rest) != 3 || !(fabs(x) < 1e6) || !(fabs(z) < 1e6) ||
            !(height > 0 && height < 1e6)) {
            out->error(out->ctx, path, number, 1, "expected: X Z HEIGHT");
            return 0;
        }
        it.object_to_world[0] = it.object_to_world[10] = scale;
        it.object_to_world[5] = height * scale;
        it.object_to_world[12] = x * scale, it.object_to_world[14] = z * scale;
        it.object_to_world[15] = 1;
        if (!mesh || !material || !out->instance(out->ctx, &it)) return 0;
        out->report(out->ctx, RESTAGE_KEPT, path, number, "tower", "");
    }
    return out->progress(out->ctx, 1, "reading");
}

static int towers_load(const char* path, const RestageSceneWriter1* out) {
    FILE* file = fopen(path, "rb");
    int done;
    if (!file) {
        out->error(out->ctx, path, 0, 0, strerror(errno));
        return 0;
    }
    done = towers_read(file, path, out, (double)RESTAGE_AT(RestageValue, out->options, 0).v[0]);
    fclose(file);
    return done;
}
static const RestageParam import_options[] = {
    RESTAGE_FLOAT_PARAM("scale", "Scale", 0.001f, 1000, 1, 0, "", "Scene units per unit of the file."),
};
const RestageImporter1 towers_in = {
    .size = sizeof(RestageImporter1),
    .format = "towers",
    .label = "Towers",
    .extensions = "towers",
    .probe = towers_probe,
    .load = towers_load,
    .options = import_options,
    .option_count = RESTAGE_COUNT(import_options),
};

static const RestageParam export_options[] = {
    RESTAGE_BOOL_PARAM("hidden", "Hidden objects", 0, 0, "Writes hidden objects, too."),
};
static int towers_write(FILE* file, const RestageSceneReader1* in, int hidden) {
    const uint32_t count = in->count(in->ctx, RESTAGE_KIND_INSTANCE);
    RestageHandle i;
    fputs("towers 1\n", file);
    for (i = 1; i <= count; ++i) {
        RestageInstance it = {.size = sizeof it};
        if (!in->progress(in->ctx, (float)i / (float)count, "writing")) return 0;
        if (!in->instance(in->ctx, i, &it) || ((it.flags & RESTAGE_INSTANCE_HIDDEN) && !hidden)) continue;
        in->report(in->ctx, RESTAGE_APPROXIMATED, it.name, "the format has only boxes");
        fprintf(file, "%.9g %.9g %.9g\n", it.object_to_world[12], it.object_to_world[14], it.object_to_world[5]);
    }
    return 1;
}
static int towers_save(const char* path, const RestageSceneReader1* in, const RestageValue* options, uint32_t count) {
    char part[4096];
    FILE* file;
    int done;
    (void)count;
    if (snprintf(part, sizeof part, "%s.part", path) >= (int)sizeof part) {
        in->error(in->ctx, path, "the path is too long");
        return 0;
    }
    file = fopen(part, "wb");
    if (!file) {
        in->error(in->ctx, part, strerror(errno));
        return 0;
    }
    done = towers_write(file, in, RESTAGE_AT(RestageValue, options, 0).i);
    if ((ferror(file) | fclose(file)) || (done && rename(part, path) != 0)) {
        in->error(in->ctx, path, strerror(errno));
        done = 0;
    }
    if (!done) remove(part);
    return done;
}
const RestageExporter1 towers_out = {
    .size = sizeof(RestageExporter1),
    .format = "towers",
    .label = "Towers",
    .extensions = "towers",
    .options = export_options,
    .option_count = RESTAGE_COUNT(export_options),
    .save = towers_save,
};

/* Each pixel: the mean of the finite ones among itself and its four neighbours. */
static void blur_pixel(const RestageDenoiseJob* job, const float* in, uint32_t x, uint32_t y) {
    const int step[5][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    double sum[3] = {0, 0, 0};
    int found = 0, k, c;
    for (k = 0; k < 5; ++k) {
        const int64_t i = (int64_t)x + step[k][0], j = (int64_t)y + step[k][1];
        const float* rgb = in + 3 * (size_t)(j * job->width + i);
        if (i < 0 || j < 0 || i >= job->width || j >= job->height) continue;
        if (!isfinite(rgb[0]) || !isfinite(rgb[1]) || !isfinite(rgb[2])) continue;
        for (c = 0; c < 3; ++c)
            sum[c] += (double)rgb[c];
        ++found;
    }
    for (c = 0; c < 3; ++c)
        job->output[3 * ((size_t)y * job->width + x) + c] = found ? (float)(sum[c] / found) : 0;
}
static int blur_available(const char** reason) {
    *reason = "";
    return 1;
}
static int blur_run(const RestageDenoiseJob* job, const char** reason) {
    const size_t bytes = (size_t)job->width * job->height * 3 * sizeof(float);
    float* in = (float*)malloc(bytes);
    uint32_t x, y;
    *reason = "out of memory";
    if (!in) return 0;
    memcpy(in, job->color, bytes);
    *reason = "stopped";
    for (y = 0; y < job->height; ++y) {
        if (job->progress && !job->progress(job->progress_ctx, (double)y / job->height)) {
            free(in);
            return 0;
        }
        for (x = 0; x < job->width; ++x)
            blur_pixel(job, in, x, y);
    }
    free(in);
    return 1;
}
const RestageDenoiser1 blur = {
    .size = sizeof(RestageDenoiser1),
    .type = "blur",
    .label = "Blur",
    .available = blur_available,
    .run = blur_run,
};
