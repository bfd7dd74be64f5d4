/* @LABEL@: a row of copies of the selected objects, to begin with. <restage/action.h> states the
 * requirements; `restage check` tests them. */
#include <restage/action.h>

static const RestageParam params[] = {
    RESTAGE_INT_PARAM("copies", "Copies", 1, 1000, 3, 0, "", "Of each selected object."),
    RESTAGE_FLOAT_PARAM("step", "Step", -1000, 1000, 1, 0, "", "From one to the next along x, in units of the scene."),
};

/* [worker] `scene` keeps showing the scene as it was; `edits` records the changes, all of them one undo step. */
static int run(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* values,
               uint32_t count, RestageEditWriter1* edits) {
    const int copies = RESTAGE_AT(RestageValue, values, 0).i; /* in the order of the table */
    const double step = RESTAGE_AT(RestageValue, values, 1).v[0];
    uint32_t i;
    int k;
    (void)count;
    for (i = 0; i < selection->instance_count; ++i) {
        RestageInstance object = {.size = sizeof object};
        if (!scene->instance(scene->ctx, selection->instances[i], &object)) continue;
        if (!edits->progress(edits->ctx, (float)i / (float)selection->instance_count, object.name)) return 0;
        for (k = 0; k < copies; ++k) {
            object.object_to_world[12] += step; /* column-major: the translation is the last column */
            if (!edits->add_instance(edits->ctx, &object)) {
                edits->error(edits->ctx, "a copy was refused");
                return 0;
            }
        }
    }
    return 1;
}

static const RestageAction1 action = {
    .size = sizeof(RestageAction1),
    .id = "@NAME@",
    .label = "@LABEL@",
    .tooltip = "One sentence for users who are choosing an action.",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .flags = RESTAGE_ACTION_NEEDS_SELECTION,
    .run = run,
};

/* [main] Describes the panel each time it is drawn. */
static void draw(const RestageUi1* ui, void* ctx) {
    ui->param(ctx, "copies");
    ui->param(ctx, "step");
    if (ui->selected(ctx) == 0)
        ui->text(ctx, "Select objects first.");
    else if (ui->button(ctx, "@LABEL@", "Copies of what is selected"))
        ui->run(ctx, "@NAME@");
}

static const RestagePanel1 panel = {
    .size = sizeof(RestagePanel1),
    .id = "@NAME@",
    .label = "@LABEL@",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .draw = draw,
};

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_ACTION1, &action}, {RESTAGE_PANEL1, &panel})
