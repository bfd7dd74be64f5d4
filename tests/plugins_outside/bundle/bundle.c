/* SPDX-License-Identifier: Apache-2.0 */
/* An action with a panel that runs it, and the list of everything the library provides. */
#include "bundle.h"

static const RestageParam lift_params[] = {
    RESTAGE_FLOAT_PARAM("height", "Height", -10, 10, 1, 0, "", "Distance to move the objects along y."),
};
static int lift_run(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* params,
                    uint32_t count, RestageEditWriter1* edits) {
    const double height = (double)RESTAGE_AT(RestageValue, params, 0).v[0];
    uint32_t i;
    (void)count;
    for (i = 0; i < selection->instance_count; ++i) {
        RestageInstance it = {.size = sizeof it};
        if (!edits->progress(edits->ctx, (float)i / (float)selection->instance_count, "lifting")) return 0;
        if (!scene->instance(scene->ctx, selection->instances[i], &it)) continue;
        it.object_to_world[13] += height;
        if (!edits->set_transform(edits->ctx, selection->instances[i], it.object_to_world)) return 0;
    }
    return 1;
}
static const RestageAction1 lift = {
    .size = sizeof(RestageAction1),
    .id = "lift",
    .label = "Lift",
    .tooltip = "Moves the selected objects upwards.",
    .params = lift_params,
    .param_count = RESTAGE_COUNT(lift_params),
    .flags = RESTAGE_ACTION_NEEDS_SELECTION,
    .run = lift_run,
};

static void lift_draw(const RestageUi1* ui, void* ctx) {
    ui->param(ctx, "height");
    if (ui->selected(ctx) == 0) ui->text(ctx, "Select the objects to lift.");
    if (ui->button(ctx, "Lift it", "Moves the selected objects upwards")) ui->run(ctx, "lift");
}
static const RestagePanel1 lift_panel = {
    .size = sizeof(RestagePanel1),
    .id = "lift",
    .label = "Lift",
    .params = lift_params,
    .param_count = RESTAGE_COUNT(lift_params),
    .draw = lift_draw,
};

RESTAGE_PLUGIN("org.example.bundle", "1.0.0", {RESTAGE_MATERIAL1, &chalk}, {RESTAGE_TEXTURE1, &stripes},
               {RESTAGE_SKY1, &dusk}, {RESTAGE_ACTION1, &lift}, {RESTAGE_PANEL1, &lift_panel},
               {RESTAGE_IMPORTER1, &towers_in}, {RESTAGE_EXPORTER1, &towers_out}, {RESTAGE_DENOISER1, &blur})
