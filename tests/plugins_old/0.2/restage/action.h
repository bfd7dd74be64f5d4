/* SPDX-License-Identifier: Apache-2.0 */
/* Interfaces "restage.action/1" and "restage.panel/1": a plugin reads the scene and returns edits, and draws a panel.
 *
 * An action reads a snapshot of the scene through the reader that exporters have, and says what to change through an
 * edit writer. All of it is one step of undo, named by the action's label. The host validates it first; an action that
 * fails, or that the user stops, changes nothing. A panel shows parameters of its own with the widgets of an inspector,
 * and runs actions of its plugin with them. Neither holds document state: values are the host's. */
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

/* What is selected, in the order in which it was selected: the last object is the active one. */
typedef struct RestageSelection1 {
    RESTAGE_SIZE(RestageSelection1);
    uint32_t instance_count;
    const RestageHandle* instances; /* none twice; NULL where there are none */
} RestageSelection1;

/* Where an action writes. Every function [worker], one thread at a time; data is copied before it returns. Handles of
 * the reader are valid here, and so are those of new things, at once. The reader goes on showing the scene as it was.
 * What returns 0 was refused, and the host has noted why: go on or give up. */
typedef struct RestageEditWriter1 {
    RESTAGE_SIZE(RestageEditWriter1);
    void* ctx;

    /* New things, as importers push them. A name that is taken gets a number. */
    RestageHandle (*add_mesh)(void* ctx, const RestageMesh*);
    RestageHandle (*add_image)(void* ctx, const RestageImage*);
    RestageHandle (*add_texture)(void* ctx, const RestageTexture*);
    RestageHandle (*add_material)(void* ctx, const RestageMaterialDesc*);
    RestageHandle (*add_medium)(void* ctx, const RestageMedium*);
    RestageHandle (*add_group)(void* ctx, const RestageGroup*);
    RestageHandle (*add_instance)(void* ctx, const RestageInstance*);
    RestageHandle (*add_light)(void* ctx, const RestageLight*);
    RestageHandle (*add_camera)(void* ctx, const RestageCamera*);

    /* Changes of what there is, or of what is new. Transforms are column-major, affine and invertible. */
    int (*set_transform)(void* ctx, RestageHandle instance, const double object_to_world[16]);
    int (*set_material)(void* ctx, RestageHandle instance, RestageHandle material);
    int (*set_group)(void* ctx, RestageHandle instance, RestageHandle group); /* 0 = in none */
    int (*set_hidden)(void* ctx, uint32_t kind, RestageHandle, int hidden); /* of an INSTANCE or a LIGHT */
    int (*set_name)(void* ctx, uint32_t kind, RestageHandle, const char* name);
    /* Of a MATERIAL, held to its table: type, range, choices; or of a TEXTURE. */
    int (*set_param)(void* ctx, uint32_t kind, RestageHandle, const RestageValue*);
    int (*set_light)(void* ctx, RestageHandle, const RestageLight*); /* whole; its name and origin stay */
    int (*set_camera)(void* ctx, RestageHandle, const RestageCamera*); /* whole; its name and origin stay */
    int (*set_active_camera)(void* ctx, RestageHandle camera);
    int (*set_environment)(void* ctx, const RestageEnvironment*); /* NULL = none */
    /* Of one kind (RestageKind), all or none of them. Groups left empty go with their objects; what is still used, and
     * what this run has made, cannot be removed. */
    int (*remove)(void* ctx, uint32_t kind, const RestageHandle* handles, uint32_t count);

    /* The object is selected afterwards. Where no call says so, the new objects are. */
    int (*select)(void* ctx, RestageHandle instance);

    /* A line for the user about what was done (RESTAGE_KEPT), only nearly done, or left out (RestageFate). */
    void (*report)(void* ctx, int fate, const char* what, const char* note);
    /* Marks the run as failed: nothing will change. The first call is the one that is shown: what, and what to do. */
    void (*error)(void* ctx, const char* message);
    /* 0..1; returns 0 when the user wants to stop: then return from run at once. */
    int (*progress)(void* ctx, float done, const char* what);
    /* Is there a material plugin for `type`? Its table, or NULL. */
    const RestageParam* (*material_table)(void* ctx, const char* type, uint32_t* count);
} RestageEditWriter1;

enum { RESTAGE_ACTION_NEEDS_SELECTION = 1u }; /* at least one object: the host does not call run without */

typedef struct RestageAction1 {
    RESTAGE_SIZE(RestageAction1);
    const char* id; /* lower_snake, unique over all plugins: what scripts call it */
    const char* label; /* as in a menu, and the name of the step of undo: "Scatter" */
    const char* tooltip; /* one sentence */
    const RestageParam* params; /* any type but TABLE, none texturable; NULL where there are none */
    uint32_t param_count;
    uint32_t flags; /* RESTAGE_ACTION_* */
    /* [worker] 1 = done, 0 = failed: error() has been called. `params`: every parameter, in the table's order. Same
     * scene, selection and parameters: same edits. */
    int (*run)(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* params,
               uint32_t count, RestageEditWriter1* edits);
} RestageAction1;

typedef struct RestagePanel1 {
    RESTAGE_SIZE(RestagePanel1);
    const char* id; /* lower_snake, unique over all plugins */
    const char* label; /* of its tab, and in the menu of panels */
    const RestageParam* params; /* of its widgets; no document state: the host remembers them beside its layout */
    uint32_t param_count;
    /* [main] Each time the panel is drawn, as an inspector's (restage/inspector.h); only what it draws is shown. `ui`
     * has run() and selected(). */
    void (*draw)(const RestageUi1* ui, void* ctx);
} RestagePanel1;

#ifdef __cplusplus
}
#endif
#endif
