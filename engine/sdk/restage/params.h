/* SPDX-License-Identifier: Apache-2.0 */
/* Parameters: one table line each. The host owns every value; a plugin holds no document state.
 *
 * A table line gives the inspector widget, undo, project file, script access, copy/paste, export, the GLSL struct and
 * the fuzz range of a parameter. Unknown ids in a file are kept verbatim by the host. */
#ifndef RESTAGE_PARAMS_H
#define RESTAGE_PARAMS_H

#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum RestageType {
    RESTAGE_FLOAT = 1,    /* v[0]                                       GLSL float */
    RESTAGE_COLOR = 2,    /* v[0..2], linear sRGB primaries             GLSL vec3  */
    RESTAGE_INT = 3,      /* i                                          GLSL int   */
    RESTAGE_BOOL = 4,     /* i, 0 or 1                                  GLSL bool  */
    RESTAGE_ENUM = 5,     /* text = one of the table line's choices     GLSL int, the index of the choice */
    RESTAGE_TEXT = 6,     /* text; not seen by shaders */
    RESTAGE_MATERIAL = 7, /* ref = material handle; not seen by shaders (only the engine's `mix` uses it) */
    RESTAGE_TEXTURE = 8,  /* ref = texture handle; a slot with no constant (normal map); not seen by BSDFs */
    RESTAGE_TABLE = 9     /* text = absolute path of a file; GLSL Table, see restage/table.h */
} RestageType;

enum {
    RESTAGE_PARAM_TEXTURABLE = 1u, /* a texture may replace the constant (FLOAT, COLOR) */
    RESTAGE_PARAM_ADVANCED = 2u    /* initially folded in the inspector */
};

/* One line of a parameter table; the macros below write it. Strings live as long as the plugin. */
typedef struct RestageParam {
    RESTAGE_SIZE(RestageParam);
    uint32_t type;            /* RestageType */
    uint32_t flags;           /* RESTAGE_PARAM_* */
    int32_t int_min, int_max; /* INT; also the fuzz range */
    int32_t int_def;          /* default: INT; BOOL: 0 or 1; ENUM: index of the choice */
    float min, max;           /* FLOAT, COLOR: of each component; also the fuzz range */
    float def[4];             /* default: FLOAT, COLOR */
    const char* id;           /* lower_snake, unique in the table, a valid GLSL identifier */
    const char* label;        /* "Roughness" */
    const char* unit;         /* "", "deg", "m", "1/m" */
    const char* choices; /* ENUM: "ggx|beckmann". TABLE: the default, a file in the plugin's folder; NULL = none */
    const char* tooltip; /* one sentence */
} RestageParam;

/* clang-format off */
#define RESTAGE_FLOAT_PARAM(id, label, min, max, value, flags, unit, tooltip) \
    {sizeof(RestageParam), RESTAGE_FLOAT, flags, 0, 0, 0, min, max, {value}, id, label, unit, NULL, tooltip}
#define RESTAGE_COLOR_PARAM(id, label, min, max, red, green, blue, flags, unit, tooltip) \
    {sizeof(RestageParam), RESTAGE_COLOR, flags, 0, 0, 0, min, max, {red, green, blue}, id, label, unit, NULL, tooltip}
#define RESTAGE_INT_PARAM(id, label, min, max, value, flags, unit, tooltip) \
    {sizeof(RestageParam), RESTAGE_INT, flags, min, max, value, 0, 0, {0}, id, label, unit, NULL, tooltip}
#define RESTAGE_BOOL_PARAM(id, label, value, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_BOOL, flags, 0, 1, value, 0, 0, {0}, id, label, "", NULL, tooltip}
/* value: the index of the default among the choices "ggx|beckmann" */
#define RESTAGE_ENUM_PARAM(id, label, choices, value, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_ENUM, flags, 0, 0, value, 0, 0, {0}, id, label, "", choices, tooltip}
#define RESTAGE_TEXT_PARAM(id, label, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_TEXT, flags, 0, 0, 0, 0, 0, {0}, id, label, "", NULL, tooltip}
#define RESTAGE_MATERIAL_PARAM(id, label, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_MATERIAL, flags, 0, 0, 0, 0, 0, {0}, id, label, "", NULL, tooltip}
#define RESTAGE_TEXTURE_PARAM(id, label, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_TEXTURE, flags, 0, 0, 0, 0, 0, {0}, id, label, "", NULL, tooltip}
/* file: the default, in the plugin's folder; NULL = none */
#define RESTAGE_TABLE_PARAM(id, label, file, flags, tooltip) \
    {sizeof(RestageParam), RESTAGE_TABLE, flags, 0, 0, 0, 0, 0, {0}, id, label, "", file, tooltip}
/* clang-format on */

/* A value as it crosses the ABI. `ref`, if it is a texture, replaces v. */
typedef struct RestageValue {
    RESTAGE_SIZE(RestageValue);
    uint32_t type; /* RestageType */
    const char* id;
    uint32_t ref; /* handle of a texture (any texturable type, TEXTURE) or of a material (MATERIAL); 0 = none */
    int32_t i; /* INT, BOOL */
    float v[4]; /* FLOAT, COLOR */
    const char* text; /* ENUM, TEXT, TABLE; else NULL */
} RestageValue;

#ifdef __cplusplus
}
#endif
#endif
