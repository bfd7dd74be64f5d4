/* SPDX-License-Identifier: Apache-2.0 */
/* Parameters: one table line each. The host owns every value; a plugin holds no document state.
 *
 * A table line gives the inspector widget, undo, project file, script access, copy/paste, export, the GLSL struct and
 * the fuzz range of a parameter. Unknown ids in a file are kept verbatim by the host. */
#ifndef RESTAGE_PARAMS_H
#define RESTAGE_PARAMS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum RestageType {
    RESTAGE_FLOAT = 1,    /* v[0]                                       GLSL float */
    RESTAGE_COLOR = 2,    /* v[0..2], linear sRGB primaries             GLSL vec3  */
    RESTAGE_INT = 3,      /* v[0], integral                             GLSL int   */
    RESTAGE_BOOL = 4,     /* v[0], 0 or 1                               GLSL bool  */
    RESTAGE_ENUM = 5,     /* text = one of the table line's choices     GLSL int, the index of the choice */
    RESTAGE_TEXT = 6,     /* text; not seen by shaders */
    RESTAGE_MATERIAL = 7, /* ref = material handle; not seen by shaders (only the engine's `mix` uses it) */
    RESTAGE_TEXTURE = 8,  /* ref = texture handle; a slot with no constant (normal map); not seen by BSDFs */
    RESTAGE_TABLE = 9     /* text = absolute path of a file; GLSL Table, see restage/table.h */
} RestageType;

enum {
    RESTAGE_PARAM_TEXTURABLE = 1u, /* a texture may stand for the constant (FLOAT, COLOR) */
    RESTAGE_PARAM_ADVANCED = 2u    /* folded away in the inspector at first */
};

/* One line of a parameter table. Strings live as long as the plugin. */
typedef struct RestageParam {
    const char* id;      /* lower_snake, unique in the table, a valid GLSL identifier */
    const char* label;   /* "Roughness" */
    uint32_t type;       /* RestageType */
    uint32_t flags;      /* RESTAGE_PARAM_* */
    float min, max;      /* of each component; also the fuzz range; INT and FLOAT and COLOR */
    float def[4];        /* default; ENUM: def[0] = index of the choice */
    const char* unit;    /* "", "deg", "m", "1/m" */
    const char* choices; /* ENUM: "ggx|beckmann". TABLE: the default, a file of the plugin's folder; NULL = none */
    const char* tooltip; /* one sentence */
} RestageParam;

/* A value on its way through the ABI. `texture`, when not 0, stands for v. */
typedef struct RestageValue {
    const char* id;
    uint32_t type; /* RestageType */
    uint32_t ref;  /* handle of a texture (any texturable type, TEXTURE) or of a material (MATERIAL); 0 = none */
    float v[4];
    const char* text; /* ENUM, TEXT, TABLE; else NULL */
} RestageValue;

#ifdef __cplusplus
}
#endif
#endif
