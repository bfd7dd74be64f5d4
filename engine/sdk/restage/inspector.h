/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.inspector/1": what a material shows in the inspector besides one widget per parameter.
 *
 * `draw` is called each time the panel is drawn and describes it from scratch (immediate mode): it calls the widgets of
 * RestageUi1 in order and keeps no state. Widgets name parameters of the material's table; changes go through the
 * host's history, so undo, gestures and project files work without code in the plugin. Plugins never link a UI library.
 * A parameter that draw itself shows is not repeated below. */
#ifndef RESTAGE_INSPECTOR_H
#define RESTAGE_INSPECTOR_H

#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_INSPECTOR1 "restage.inspector/1"

/* The widgets. Every function [main], only during draw, with the ctx passed to draw. Text is UTF-8 and copied.
 * An id that is not in the material's table shows nothing, and is logged once. */
typedef struct RestageUi1 {
    RESTAGE_SIZE(RestageUi1);
    /* The row the host would show for the parameter: slider, colour, switch, combo, with texture and reset. */
    void (*param)(void* ctx, const char* id);
    /* Suppresses the parameter's row below although no widget shows it now, as in a closed group. */
    void (*hide)(void* ctx, const char* id);
    /* A slider for a FLOAT or INT, with its own scale; logarithmic when `log_scale` and min > 0. */
    void (*slider)(void* ctx, const char* id, const char* label, float min, float max, int log_scale);
    void (*color)(void* ctx, const char* id, const char* label);   /* a COLOR, without its texture */
    void (*texture)(void* ctx, const char* id, const char* label); /* a texturable one's texture, or a TEXTURE */
    /* A choice among `count` texts; `current` < 0 = none of them. Returns the index the user has just chosen, or -1. */
    int (*combo)(void* ctx, const char* label, const char* const* choices, uint32_t count, int current);
    int (*button)(void* ctx, const char* label, const char* tooltip); /* 1 = just pressed */
    void (*text)(void* ctx, const char* text); /* a line of explanation, wrapped */
    /* A fold; 1 = open: draw its contents, then call end_group. 0 = closed: do neither. */
    int (*begin_group)(void* ctx, const char* label);
    void (*end_group)(void* ctx);
    /* Curves over one axis: `channels` (1 or 3: drawn red, green, blue) times `count` values, channel after channel, at
     * equal steps from x_min to x_max; y from y_min to y_max. */
    void (*plot)(void* ctx, const char* label, const float* values, uint32_t count, uint32_t channels, float x_min,
                 float x_max, float y_min, float y_max);
    /* A curve whose points the user drags up and down: point i is the FLOAT `ids[i]`, at equal steps of x. */
    void (*curve)(void* ctx, const char* label, const char* const* ids, uint32_t count);
    /* A small picture, RGB, 3 floats per pixel, linear, row 0 on top. */
    void (*image)(void* ctx, const char* label, const float* rgb, uint32_t width, uint32_t height);
    /* The parameter's current value (its default if unset). 1 = it exists. The caller sets `out->size`;
     * `out->text` is valid until the next call. */
    int (*get)(void* ctx, const char* id, RestageValue* out);
    /* Sets parameters together, as one undo step called `label`: for a choice or a button. Values are checked against
     * the table's types and ranges; those that do not fit are skipped and logged. */
    void (*set)(void* ctx, const char* label, const RestageValue* values, uint32_t count);
    /* Runs an action of the same plugin (restage/action.h) in the background, with the panel's values for parameters of
     * the same id. 1 = started; 0 = not started: another action is running, or it needs a selection and there is none.
     * For panels only: in an inspector both functions return 0. */
    int (*run)(void* ctx, const char* action);
    uint32_t (*selected)(void* ctx); /* how many objects are selected */
} RestageUi1;

typedef struct RestageInspector1 {
    RESTAGE_SIZE(RestageInspector1);
    const char* type; /* of a material in the same plugin */
    /* [main] */
    void (*draw)(const RestageUi1* ui, void* ctx);
} RestageInspector1;

#ifdef __cplusplus
}
#endif
#endif
