/* SPDX-License-Identifier: Apache-2.0 */
/* A bundle with everything that 0.2 supports, always built with the headers next to it: every way in which a
 * plugin and the host exchange structs is used. tests/scripts/test_contract.py checks it with today's program. */
#include <restage/denoiser.h>
#include <restage/emission.h>
#include <restage/image.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/table.h>
#include <stdio.h>
#include <string.h>

/* --- services ------------------------------------------------------------------------------------------------------
 */

static int init(const RestageHost* host) {
    const RestageLog1* log = (const RestageLog1*)host->service(host, RESTAGE_LOG);
    const RestageImageService1* images = (const RestageImageService1*)host->service(host, RESTAGE_IMAGE_SERVICE);
    RestageDecodedImage image = {.size = sizeof image};
    if (!log || !images || images->decode(host, "no picture", 10, "bytes", &image)) return 0;
    log->log(host, RESTAGE_LOG_INFO, image.problem);
    images->release(host, &image);
    return 1;
}

/* --- a material that may emit, its part of the inspector, and its table ------------------------------------------ */

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.8f, 0.4f, 0.2f, RESTAGE_PARAM_TEXTURABLE, "", "Of the cloth."),
    RESTAGE_COLOR_PARAM("glow", "Glow", 0, 100, 0, 0, 0, 0, "W/(m^2 sr)", "Emission."),
    RESTAGE_FLOAT_PARAM("brightness", "Brightness", 0, 10, 1, 0, "", "Times the glow."),
    RESTAGE_INT_PARAM("threads", "Threads", 1, 9, 2, RESTAGE_PARAM_ADVANCED, "", "How many."),
    RESTAGE_BOOL_PARAM("both_sides", "Both sides", 0, 0, "Shines from both."),
    RESTAGE_ENUM_PARAM("twill", "Weave", "plain|twill", 0, 0, "Which."),
    RESTAGE_TABLE_PARAM("weave", "Weave file", "weave.dat", 0, "Numbers."),
};
static const RestageMaterial1 material = {
    .size = sizeof material,
    .type = "velvet02",
    .label = "Velvet of 0.2",
    .prefix = "velvet02",
    .glsl_file = "velvet.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Cloth.",
};
static const RestageEmission1 emission = {
    .size = sizeof emission, .type = "velvet02", .radiance = "glow", .scale = "brightness", .two_sided = "both_sides"};

static void draw(const RestageUi1* ui, void* ctx) {
    static const char* const names[] = {"Dim", "Bright"};
    RestageValue values[2] = {{.size = sizeof values[0]}, {.size = sizeof values[0]}};
    int chosen;
    if (!ui->get(ctx, "brightness", &values[0]) || !ui->get(ctx, "threads", &values[1])) return;
    chosen = ui->combo(ctx, "Preset", names, 2, values[0].v[0] > 5);
    if (chosen >= 0) {
        values[0].v[0] = chosen ? 9.0f : 1.0f;
        values[1].i = chosen ? 9 : 1;
        ui->set(ctx, names[chosen], values, 2);
    }
    ui->param(ctx, "brightness");
}
static const RestageInspector1 inspector = {sizeof inspector, "velvet02", draw};

static int read(const char* param_id, const RestageTableFile1* file) {
    uint32_t* words;
    if (strcmp(param_id, "weave") != 0 || file->length == 0 || file->length % 4 != 0) {
        file->error(file->ctx, 0, "is no list of words");
        return 0;
    }
    words = file->append(file->ctx, file->length / 4);
    return words && file->bytes(file->ctx, 0, file->length, words);
}
static const RestageTable1 reader = {sizeof reader, "velvet02", "dat", read};

/* --- an importer and an exporter of nine numbers per triangle
 * ---------------------------------------------------------
 */

static int probe(const char* path, const void* head, size_t size) {
    (void)path;
    return size >= 6 && memcmp(head, "soup 1", 6) == 0 ? 100 : 0;
}

static int load(const char* path, const RestageSceneWriter1* out) {
    static const uint32_t indices[3] = {0, 1, 2};
    FILE* file = fopen(path, "rb");
    char line[512];
    uint32_t number = 0;
    RestageOriginValue words[2] = {{.size = sizeof words[0], .id = "a", .text = "one"},
                                   {.size = sizeof words[0], .id = "*", .text = "two"}};
    RestageOrigin origin = {
        .size = sizeof origin, .value_count = 2, .format = "soup02", .verbatim = "kept 1", .values = words};
    RestageValue values[2] = {{.size = sizeof values[0], .type = RESTAGE_COLOR, .id = "tint", .v = {0.5f, 0.25f, 1}},
                              {.size = sizeof values[0], .type = RESTAGE_INT, .id = "threads", .i = 7}};
    RestageMaterialDesc cloth = {.size = sizeof cloth,
                                 .name = "cloth",
                                 .origin = &origin,
                                 .type = "velvet02",
                                 .values = values,
                                 .value_count = 2};
    RestageGroup group = {.size = sizeof group, .name = "all"};
    RestageLight light = {.size = sizeof light, .name = "lamp", .kind = RESTAGE_LIGHT_POINT, .value = {1, 1, 1}};
    RestageCamera camera = {.size = sizeof camera, .name = "camera", .fov = 40, .focal_distance = 1};
    RestageFilm film = {.size = sizeof film, .width = 32, .height = 16, .crop = {0, 1, 0, 1}, .filter = "box"};
    RestageSettings settings = {.size = sizeof settings, .max_depth = 3, .samples = 8};
    RestageEnvironment sky = {.size = sizeof sky, .scale = {1, 1, 1}};
    RestageHandle material_handle, group_handle;
    uint32_t count = 0;
    int i;
    if (!file) {
        out->error(out->ctx, path, 0, 0, "cannot be opened");
        return 0;
    }
    for (i = 0; i < 16; i += 5)
        light.light_to_world[i] = camera.camera_to_world[i] = sky.light_to_world[i] = 1;
    film.filter_radius[0] = film.filter_radius[1] = 0.5f, film.exposure = 1;
    if (!out->material_table(out->ctx, "velvet02", &count) || count != RESTAGE_COUNT(params)) {
        out->error(out->ctx, path, 0, 0, "its own material is not there");
        fclose(file);
        return 0;
    }
    material_handle = out->material(out->ctx, &cloth);
    group_handle = out->group(out->ctx, &group);
    out->light(out->ctx, &light);
    out->camera(out->ctx, &camera);
    out->film(out->ctx, &film);
    out->settings(out->ctx, &settings);
    out->environment(out->ctx, &sky);
    while (fgets(line, sizeof line, file)) {
        float p[9];
        RestageMesh mesh = {.size = sizeof mesh, .vertex_count = 3, .triangle_count = 1, .positions = p};
        RestageInstance instance = {.size = sizeof instance, .group = group_handle, .alpha = 1};
        if (++number == 1) continue;
        if (sscanf(line, "%f %f %f %f %f %f %f %f %f", p, p + 1, p + 2, p + 3, p + 4, p + 5, p + 6, p + 7, p + 8) !=
            9) {
            out->error(out->ctx, path, number, 1, "expected: nine numbers");
            fclose(file);
            return 0;
        }
        mesh.indices = indices;
        for (i = 0; i < 16; i += 5)
            instance.object_to_world[i] = 1;
        instance.mesh = out->mesh(out->ctx, &mesh);
        instance.material = material_handle;
        if (!instance.mesh || !out->instance(out->ctx, &instance)) {
            out->error(out->ctx, path, number, 1, "the host refuses this triangle");
            fclose(file);
            return 0;
        }
        if (!out->progress(out->ctx, 0.5f, "reading")) {
            fclose(file);
            return 0;
        }
    }
    out->report(out->ctx, RESTAGE_KEPT, path, number, "triangles", "");
    fclose(file);
    return 1;
}
static const RestageImporter1 importer = {.size = sizeof importer,
                                          .format = "soup02",
                                          .label = "Soup of 0.2",
                                          .extensions = "soup02",
                                          .probe = probe,
                                          .load = load};

static const RestageParam options[] = {
    RESTAGE_BOOL_PARAM("hidden", "Hidden objects", 1, 0, "Are written, too."),
    RESTAGE_INT_PARAM("digits", "Digits", 7, 9, 9, 0, "", "Of a number."),
};

static int write_all(FILE* file, const RestageSceneReader1* in, int hidden, int digits) {
    const uint32_t objects = in->count(in->ctx, RESTAGE_KIND_INSTANCE);
    RestageHandle handle;
    RestageFilm film = {.size = sizeof film};
    RestageCamera camera = {.size = sizeof camera};
    in->film(in->ctx, &film);
    if (film.width == 0 || !in->camera(in->ctx, in->active_camera(in->ctx), &camera)) return 0;
    fprintf(file, "soup 1\n");
    for (handle = 1; handle <= objects; ++handle) {
        RestageInstance o = {.size = sizeof o};
        RestageMesh mesh = {.size = sizeof mesh};
        RestageMaterialDesc look = {.size = sizeof look};
        uint32_t i;
        if (!in->instance(in->ctx, handle, &o) || !in->mesh(in->ctx, o.mesh, &mesh)) continue;
        if ((o.flags & RESTAGE_INSTANCE_HIDDEN) && !hidden) continue;
        if (in->material(in->ctx, o.material, &look))
            for (i = 0; i < look.value_count; ++i)
                if (!RESTAGE_AT(RestageValue, look.values, i).id) return 0; /* an array of the host's structs */
        for (i = 0; i < 3 * mesh.triangle_count; ++i) {
            const float* p = mesh.positions + 3 * mesh.indices[i];
            const double* m = o.object_to_world;
            int row;
            for (row = 0; row < 3; ++row)
                fprintf(file, "%.*g ", digits, m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row]);
            if (i % 3 == 2) fprintf(file, "\n");
        }
        if (!in->progress(in->ctx, (float)handle / (float)objects, "writing")) return 0;
    }
    if (in->count(in->ctx, RESTAGE_KIND_LIGHT) > 0)
        in->report(in->ctx, RESTAGE_DROPPED, "lights", "the format has none");
    return 1;
}

static int save(const char* path, const RestageSceneReader1* in, const RestageValue* values, uint32_t count) {
    char part[4096];
    FILE* file;
    int done;
    if (count != RESTAGE_COUNT(options)) return 0;
    snprintf(part, sizeof part, "%s.part", path);
    file = fopen(part, "wb");
    if (!file) {
        in->error(in->ctx, path, "cannot be written");
        return 0;
    }
    done = write_all(file, in, RESTAGE_AT(RestageValue, values, 0).i, RESTAGE_AT(RestageValue, values, 1).i);
    if (fflush(file) != 0 || ferror(file)) {
        in->error(in->ctx, path, "cannot be written: is the disk full?");
        done = 0;
    }
    fclose(file);
    if (done && rename(part, path) != 0) {
        in->error(in->ctx, path, "cannot be replaced");
        done = 0;
    }
    if (!done) remove(part);
    return done;
}
static const RestageExporter1 exporter = {.size = sizeof exporter,
                                          .format = "soup02",
                                          .label = "Soup of 0.2",
                                          .extensions = "soup02",
                                          .options = options,
                                          .option_count = RESTAGE_COUNT(options),
                                          .save = save};

/* --- a denoiser that copies ------------------------------------------------------------------------------------------
 */

static int available(const char** reason) {
    *reason = "";
    return 1;
}

static int run(const RestageDenoiseJob* job, const char** reason) {
    const size_t count = (size_t)job->width * job->height * 3;
    size_t i;
    for (i = 0; i < count; ++i) {
        const float x = job->color[i];
        job->output[i] = x >= 0 ? (x < 65504.0f ? x : 65504.0f) : 0;
        if (i % 1024 == 0 && job->progress && !job->progress(job->progress_ctx, (double)i / (double)count)) {
            *reason = "stopped";
            return 0;
        }
    }
    return 1;
}
static const RestageDenoiser1 denoiser = {sizeof denoiser, "copy02", "Copy of 0.2", available, run};

RESTAGE_PLUGIN_INIT("org.example.bundle02", "1.0.0", init, NULL, {RESTAGE_MATERIAL1, &material},
                    {RESTAGE_EMISSION1, &emission}, {RESTAGE_INSPECTOR1, &inspector}, {RESTAGE_TABLE1, &reader},
                    {RESTAGE_IMPORTER1, &importer}, {RESTAGE_EXPORTER1, &exporter}, {RESTAGE_DENOISER1, &denoiser})
