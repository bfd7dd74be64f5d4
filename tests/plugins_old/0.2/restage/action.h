/* SPDX-License-Identifier: Apache-2.0 */
/* Interfaces "restage.action/1" and "restage.panel/1": a plugin reads the scene and returns edits, and draws a panel.
 *
 * An action reads a snapshot of the scene through the same reader as exporters, and records its changes with an edit
 * writer. They become one undo step, named after the action's label. The host validates them first; an action that
 * fails, or that the user cancels, changes nothing. A panel shows its parameters with the inspector's widgets and runs
 * actions of the same plugin with them. Neither holds document state: the host owns the values. */
#ifndef RESTAGE_ACTION_H
#define RESTAGE_ACTION_H

#include <restage/inspector.h>
#include <restage/params.h>
#include <restage/plugin.h>
#include <restage/scene_io.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_ACTION1 "restage.action/1"
#define RESTAGE_PANEL1 "restage.panel/1"

/* The selection, in the order in which the objects were selected: the last one is the active object. */
typedef struct RestageSelection1 {
    RESTAGE_SIZE(RestageSelection1);
    uint32_t instance_count;
    const RestageHandle* instances; /* no duplicates; NULL if there are none */
} RestageSelection1;

/* Where an action writes. Every function [worker], one thread at a time; data is copied before it returns. Handles of
 * the reader are valid here, and so, immediately, are those of new things. The reader keeps showing the scene as it
 * was. 0 means that the host refused the change and recorded why: continue or return 0. */
typedef struct RestageEditWriter1 {
    RESTAGE_SIZE(RestageEditWriter1);
    void* ctx;

    /* New things, as importers push them. A name already in use gets a number. */
    RestageHandle (*add_mesh)(void* ctx, const RestageMesh*);
    RestageHandle (*add_image)(void* ctx, const RestageImage*);
    RestageHandle (*add_texture)(void* ctx, const RestageTexture*);
    RestageHandle (*add_material)(void* ctx, const RestageMaterialDesc*);
    RestageHandle (*add_medium)(void* ctx, const RestageMedium*);
    RestageHandle (*add_group)(void* ctx, const RestageGroup*);
    RestageHandle (*add_instance)(void* ctx, const RestageInstance*);
    RestageHandle (*add_light)(void* ctx, const RestageLight*);
    RestageHandle (*add_camera)(void* ctx, const RestageCamera*);

    /* Changes to existing or new things. Transforms are column-major, affine and invertible. */
    int (*set_transform)(void* ctx, RestageHandle instance, const double object_to_world[16]);
    int (*set_material)(void* ctx, RestageHandle instance, RestageHandle material);
    int (*set_group)(void* ctx, RestageHandle instance, RestageHandle group); /* 0 = no group */
    int (*set_hidden)(void* ctx, uint32_t kind, RestageHandle, int hidden); /* of an INSTANCE or a LIGHT */
    int (*set_name)(void* ctx, uint32_t kind, RestageHandle, const char* name);
    /* Of a MATERIAL, checked against its table (type, range, choices), or of a TEXTURE. */
    int (*set_param)(void* ctx, uint32_t kind, RestageHandle, const RestageValue*);
    int (*set_light)(void* ctx, RestageHandle, const RestageLight*); /* replaced as a whole; its name and origin stay */
    int (*set_camera)(void* ctx, RestageHandle,
                      const RestageCamera*); /* replaced as a whole; its name and origin stay */
    int (*set_active_camera)(void* ctx, RestageHandle camera);
    int (*set_environment)(void* ctx, const RestageEnvironment*); /* NULL = none */
    /* Of one kind (RestageKind), all or none of them. Groups that become empty are removed too; things still in use,
     * and things that this run has added, cannot be removed. */
    int (*remove)(void* ctx, uint32_t kind, const RestageHandle* handles, uint32_t count);

    /* The object is selected afterwards. Without any such call, the new objects are. */
    int (*select)(void* ctx, RestageHandle instance);

    /* A line of the report: what was done (RESTAGE_KEPT), done approximately, or left out (RestageFate). */
    void (*report)(void* ctx, int fate, const char* what, const char* note);
    /* Marks the run as failed: nothing changes. Only the first call is shown: what is wrong, and what to do about it.
     */
    void (*error)(void* ctx, const char* message);
    /* 0..1; returns 0 if the user wants to stop: then return from run at once. */
    int (*progress)(void* ctx, float done, const char* what);
    /* The table of the material plugin for `type`, or NULL if there is none. */
    const RestageParam* (*material_table)(void* ctx, const char* type, uint32_t* count);
} RestageEditWriter1;

enum { RESTAGE_ACTION_NEEDS_SELECTION = 1u }; /* the host calls run only if at least one object is selected */

typedef struct RestageAction1 {
    RESTAGE_SIZE(RestageAction1);
    const char* id; /* lower_snake, unique over all plugins: its name in scripts */
    const char* label; /* in the menu, and the name of the undo step: "Scatter" */
    const char* tooltip; /* one sentence */
    const RestageParam* params; /* any type except TABLE, none texturable; NULL if there are none */
    uint32_t param_count;
    uint32_t flags; /* RESTAGE_ACTION_* */
    /* [worker] 1 = done, 0 = failed: error() has been called. `params`: every parameter, in the table's order. The
     * same scene, selection and parameters give the same edits. */
    int (*run)(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* params,
               uint32_t count, RestageEditWriter1* edits);
} RestageAction1;

typedef struct RestagePanel1 {
    RESTAGE_SIZE(RestagePanel1);
    const char* id; /* lower_snake, unique over all plugins */
    const char* label; /* of its tab, and in the Panels menu */
    const RestageParam*
        params; /* of its widgets; not document state: the host saves the values with the window layout */
    uint32_t param_count;
    /* [main] Called each time the panel is drawn, as an inspector's `draw` is (restage/inspector.h); only what it draws
     * is shown. `ui` has run() and selected(). */
    void (*draw)(const RestageUi1* ui, void* ctx);
} RestagePanel1;

#ifdef __cplusplus
}
#endif
#endif
