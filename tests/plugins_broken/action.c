/* SPDX-License-Identifier: Apache-2.0 */
/* An action and a panel, correct by themselves; a macro ACTION_* or PANEL_* makes one wrong. The action stacks copies
 * of the selected objects. tests/scripts/test_check_action.py gives them manifests. */
#include <restage/action.h>
#include <stdlib.h>
#include <string.h>

static const RestageParam params[] = {
    RESTAGE_INT_PARAM("copies", "Copies", 0, 20, 3, 0, "", "Of each object."),
    RESTAGE_FLOAT_PARAM("step", "Step", -10, 10, 1, 0, "", "From one to the next."),
#if defined(ACTION_DEAF_SEED)
    RESTAGE_INT_PARAM("seed", "Seed", 0, 100, 1, 0, "", "Of nothing."),
#endif
};

#if defined(ACTION_CRASHES)
static int* volatile nowhere;
#endif
#if defined(ACTION_LEAKS)
static void* volatile kept;
#endif

static int run(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* values,
               uint32_t count, RestageEditWriter1* edits) {
    const int copies = count >= 2 ? RESTAGE_AT(RestageValue, values, 0).i : 0;
    float step = count >= 2 ? RESTAGE_AT(RestageValue, values, 1).v[0] : 0;
    uint32_t i;
    int k;
#if defined(ACTION_VARIES)
    static float calls;
    step += calls += 0.125f;
#elif defined(ACTION_LEAKS)
    kept = malloc(1 << 17);
    memset(kept, 1, 1 << 17);
#endif
    for (i = 0; i < selection->instance_count; ++i)
        for (k = 1; k <= copies; ++k) {
            RestageInstance object;
            memset(&object, 0, sizeof object);
            object.size = sizeof object;
            if (!scene->instance(scene->ctx, selection->instances[i], &object)) {
                edits->error(edits->ctx, "the selected object does not exist");
                return 0;
            }
#if defined(ACTION_CRASHES)
            if (object.group) *nowhere = 1;
#elif defined(ACTION_SILENT)
            if (object.group) return 0;
#elif defined(ACTION_UNSOUND)
            if (object.group) object.object_to_world[0] = object.object_to_world[1] = object.object_to_world[2] = 0;
#elif defined(ACTION_STUBBORN)
            {
                int more;
                for (more = 0; more < 200; ++more)
                    edits->add_instance(edits->ctx, &object);
            }
#endif
            object.object_to_world[12] += (double)step * k;
            if (!edits->progress(edits->ctx, (float)k / (float)copies, "stacking")) {
#if !defined(ACTION_STUBBORN)
                return 0;
#endif
            }
            if (!edits->add_instance(edits->ctx, &object)) {
                edits->error(edits->ctx, "a copy was refused");
                return 0;
            }
        }
    return 1;
}

static const RestageAction1 action = {
    sizeof(RestageAction1), "stack", "Stack", "Copies of the selected objects, one after the other.", params,
    RESTAGE_COUNT(params),  0,       run};

static void draw(const RestageUi1* ui, void* ctx) {
    RestageValue value;
    memset(&value, 0, sizeof value);
    value.size = sizeof value;
    ui->param(ctx, "copies");
    if (ui->get(ctx, "copies", &value) && ui->button(ctx, "More", NULL)) {
        value.i = value.i < 19 ? value.i + 1 : 20;
#if defined(PANEL_RANGE)
        value.i = 21;
#endif
        ui->set(ctx, "More", &value, 1);
    }
    if (ui->begin_group(ctx, "Where")) {
        ui->param(ctx, "step");
#if !defined(PANEL_GROUP)
        ui->end_group(ctx);
#endif
    }
#if defined(PANEL_ID)
    if (ui->selected(ctx) > 1 && ui->button(ctx, "Stack", "")) ui->run(ctx, "stck");
#else
    if (ui->selected(ctx) > 0 && ui->button(ctx, "Stack", "")) ui->run(ctx, "stack");
#endif
}

static const RestagePanel1 panel = {sizeof(RestagePanel1), "stack", "Stack", params, RESTAGE_COUNT(params), draw};

RESTAGE_PLUGIN("org.example.broken", "1.0.0", {RESTAGE_ACTION1, &action}, {RESTAGE_PANEL1, &panel})
