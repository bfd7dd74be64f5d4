/* SPDX-License-Identifier: Apache-2.0 */
/* The scene in plain C structs: importers push it, exporters pull it.
 *
 * Handles are 1-based and per kind; 0 is none. Matrices are column-major double[16], object to world, right-handed or
 * mirrored as they come. Lengths are in the scene's own unit. Colours are linear sRGB primaries; radiometric values are
 * relative as in pbrt. Strings are UTF-8; from the host they are never NULL ("" instead), nor is `origin`. From an
 * importer, NULL means "" and an empty origin. */
#ifndef RESTAGE_SCENE_IO_H
#define RESTAGE_SCENE_IO_H

#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef uint32_t RestageHandle;

/* A value as it was in the file, before it was reduced to what the scene can hold: a spectrum that became a colour. */
typedef struct RestageOriginValue {
    RESTAGE_SIZE(RestageOriginValue);
    uint32_t reserved; /* 0 */
    const char* id;    /* of the value; "*": of the whole thing, possibly on several lines */
    const char* text;  /* in the format's own notation */
} RestageOriginValue;

/* The origin of a thing, for exporters of the same format. The host reads only the ids: once a value is
 * edited, the entry with its id is dropped; once any value is, entries with "*" are dropped. */
typedef struct RestageOrigin {
    RESTAGE_SIZE(RestageOrigin);
    uint32_t value_count;
    const char* format;   /* "pbrt-v3", "pbrt-v4", "gltf", ...; "" = created in Restage */
    const char* verbatim; /* what the importer did not understand, one "key value" line each; "" = none */
    const RestageOriginValue* values;
} RestageOrigin;

typedef struct RestageMesh {
    RESTAGE_SIZE(RestageMesh);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    uint32_t vertex_count, triangle_count;
    const float* positions;   /* 3 per vertex */
    const float* normals;     /* 3 per vertex, or NULL */
    const float* uvs;         /* 2 per vertex, or NULL */
    const uint32_t* indices;  /* 3 per triangle, < vertex_count */
    const char* source_file;  /* the PLY/OBJ it was read from, absolute, or "": an exporter may refer to it */
    /* "", or the shape this tessellates, as a pbrt line: `sphere "float radius" 1`. Spheres, disks and cylinders are
     * rendered analytically; the triangles represent them everywhere else. */
    const char* primitive;
    /* 4 per vertex, or NULL: along u, then the sign (1 or -1) of the bitangent, sign * cross(normal, tangent), which
     * normal maps call y (glTF 2.0, 3.7.2.1). Without them it is cross(normal, dp/du), as in pbrt, even where uv are
     * mirrored. */
    const float* tangents;
    const float* uvs2; /* 2 per vertex, or NULL: a second set, for textures with `uvset` 1 */
} RestageMesh;

typedef enum RestageEncoding { RESTAGE_LINEAR = 0, RESTAGE_SRGB = 1, RESTAGE_GAMMA = 2 } RestageEncoding;
typedef struct RestageImage { /* an image file, read by the host; or pixels, when `path` is "" */
    RESTAGE_SIZE(RestageImage);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    const char* path; /* absolute */
    uint32_t encoding; /* RestageEncoding of 8-bit files; float files are linear */
    float gamma; /* for RESTAGE_GAMMA */
    uint32_t width, height, channels; /* 1, 3 or 4; row 0 is the top */
    const float* pixels; /* linear, or NULL when `path` is given */
} RestageImage;

/* `type` names a texture plugin (restage/texture.h); the values are those of its table. Shipped types include:
 *   constant      value
 *   imagemap      the image of RestageTexture.image; scale, invert, wrap
 *   scale         tex, scale              tex * scale
 *   mix           tex1, tex2, amount      (1 - amount) tex1 + amount tex2
 *   checkerboard  tex1, tex2
 * MAPPED types also have: uscale, vscale, udelta, vdelta (FLOAT): st = uv * scale + delta, pbrt's UVMapping;
 * ushear, vshear (FLOAT) add v * ushear to s and u * vshear to t; uvset (INT): 1 = the mesh's second set, if it has
 * one. Types without a plugin are kept, written back, and shade as their `average` (COLOR). */
typedef struct RestageTexture {
    RESTAGE_SIZE(RestageTexture);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    const char* type;
    uint32_t is_float; /* 1: a scalar texture, 0: colour */
    RestageHandle image;
    const RestageValue* values;
    uint32_t value_count;
} RestageTexture;

typedef struct RestageMaterialDesc {
    RESTAGE_SIZE(RestageMaterialDesc);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    const char* type; /* of a material plugin */
    /* From its table; unset ones take the default. Also, for any material: `bump` and `normalmap` (TEXTURE). */
    const RestageValue* values;
    uint32_t value_count;
} RestageMaterialDesc;

typedef struct RestageMedium { /* homogeneous; only absorption is rendered (Beer-Lambert) */
    RESTAGE_SIZE(RestageMedium);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    float sigma_a[3], sigma_s[3]; /* [1/unit], scale applied */
    float g;
} RestageMedium;

enum {
    RESTAGE_INSTANCE_REVERSE_ORIENTATION = 1u, /* pbrt ReverseOrientation: flips the normal (side of emission) */
    RESTAGE_INSTANCE_HIDDEN = 2u,
    RESTAGE_INSTANCE_EMITS = 4u,
    RESTAGE_INSTANCE_TWO_SIDED = 8u, /* emission from both sides */
    /* For exporters, with EMITS: it emits because its material does (restage/emission.h), not by its own emission. If
     * the material's emission is textured, `emission` is its mean. */
    RESTAGE_INSTANCE_EMITS_BY_MATERIAL = 16u,
    /* alpha above 0 stops every ray, as in pbrt-v3. Without it alpha is the fraction of rays that is stopped. */
    RESTAGE_INSTANCE_ALPHA_MASK = 32u,
    /* Its own emission also applies where alpha lets rays pass: it lights, but is invisible there. pbrt-v4's lamps with
     * alpha 0, and all of pbrt-v3's. Without it cut-away parts do not emit. */
    RESTAGE_INSTANCE_EMITS_UNSEEN = 64u
};
typedef struct RestageInstance {
    RESTAGE_SIZE(RestageInstance);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    RestageHandle mesh, material, group;
    RestageHandle alpha_texture; /* scalar, or 0 */
    RestageHandle interior, exterior; /* media, 0 = vacuum; used if `has_medium_interface` */
    uint32_t has_medium_interface;
    uint32_t flags;
    float alpha; /* constant when alpha_texture is 0 */
    float emission[3]; /* radiance [W/(m^2 sr)], scale applied, when RESTAGE_INSTANCE_EMITS */
    double object_to_world[16];
} RestageInstance;

typedef struct RestageGroup { /* something a user selects as a unit: an ObjectInstance, an imported node */
    RESTAGE_SIZE(RestageGroup);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    RestageHandle parent;
} RestageGroup;

typedef enum RestageLightKind {
    RESTAGE_LIGHT_POINT = 1,
    RESTAGE_LIGHT_SPOT = 2,
    RESTAGE_LIGHT_DISTANT = 3
} RestageLightKind;
/* How a spot fades over its edge, t = (cos - cos cone) / (cos(cone - delta) - cos cone) in [0,1]. */
typedef enum RestageFalloff {
    RESTAGE_FALLOFF_SMOOTH = 0, /* t^2 (3 - 2t): pbrt-v4 */
    RESTAGE_FALLOFF_QUARTIC = 1 /* t^4: pbrt-v3 */
} RestageFalloff;
enum { RESTAGE_LIGHT_HIDDEN = 1u }; /* switched off: in the scene, but does not emit */
typedef struct RestageLight {
    RESTAGE_SIZE(RestageLight);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    uint32_t kind;
    float value[3]; /* point, spot: radiant intensity [W/sr]; distant: irradiance at normal incidence [W/m^2] */
    double light_to_world[16]; /* at the origin; spot and distant light travels along +z */
    float cone_angle,
        cone_delta; /* spot [deg]: half angle, width of the smooth edge (pbrt: coneangle, conedeltaangle) */
    uint32_t falloff; /* RestageFalloff, of a spot */
    uint32_t flags; /* RESTAGE_LIGHT_HIDDEN */
} RestageLight;

typedef enum RestageMapping { RESTAGE_EQUIRECT = 0, RESTAGE_OCTAHEDRAL = 1 } RestageMapping;
typedef struct RestageEnvironment {
    RESTAGE_SIZE(RestageEnvironment);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    RestageHandle image; /* 0 = constant */
    /* RestageMapping. EQUIRECT: pbrt-v3, z up, u = phi/2pi, v = theta/pi, row 0 = +z.
     * OCTAHEDRAL: equal-area, Clarberg 2008 as in pbrt-v4. */
    uint32_t mapping;
    float scale[3]; /* times the image; or the radiance itself */
    double light_to_world[16]; /* rotation (and mirror) */
    uint32_t hidden_from_camera; /* lights the scene, but camera rays that miss everything see black */
    uint32_t sky_value_count;
    /* "", or the type of the sky plugin that generates the image from sky_values (restage/sky.h). Exporters still get
     * the image. An importer may leave `image` 0: the host generates it if it has the plugin. */
    const char* sky;
    const RestageValue* sky_values;
} RestageEnvironment;

/* How a camera maps directions to the film, and which members of RestageCamera it uses. */
typedef enum RestageProjection {
    RESTAGE_PERSPECTIVE = 0,
    /* Parallel to +z. The screen window is in camera-space units; when taken from the aspect ratio, its shorter side is
     * 2. `fov` is not used. A lens is centred on the camera's origin, as in pbrt. */
    RESTAGE_ORTHOGRAPHIC = 1,
    /* All directions, +y up: u = phi/2pi from +x over +z, v = theta/pi from +y. No window, no lens. */
    RESTAGE_SPHERICAL = 2,
    RESTAGE_SPHERICAL_EQUAL_AREA = 3 /* likewise by Clarberg's octahedral map, as in pbrt-v4 */
} RestageProjection;
typedef struct RestageCamera {
    RESTAGE_SIZE(RestageCamera);
    const char* name; /* "" = the host invents one */
    const RestageOrigin* origin;
    double camera_to_world[16]; /* pbrt: looks along +z, +y up, +x right */
    float fov; /* [deg], of the shorter image side */
    float screen_window[4]; /* x0 x1 y0 y1; all 0 = from the aspect ratio */
    float lens_radius, focal_distance;
    float frame_aspect; /* 0 = width/height */
    uint32_t projection; /* RestageProjection */
    /* > 0: `fov` is of the shorter side of a frame of this aspect (width/height), all of which is visible whatever the
     * aspect of the picture; 0 = of the picture's own shorter side. Ignored with a screen_window or
     * frame_aspect. For exporters it is 0, and `fov` already accounts for the picture's aspect. */
    float fit_aspect;
} RestageCamera;

typedef struct RestageFilm {
    RESTAGE_SIZE(RestageFilm);
    uint32_t width, height;
    float crop[4]; /* x0 x1 y0 y1 in [0,1] */
    const char* filter; /* box triangle gaussian mitchell sinc */
    float filter_radius[2];
    float filter_params[2]; /* gaussian: sigma | mitchell: B C | sinc: tau */
    float exposure; /* linear factor on the film (pbrt-v4 sensor), 1 = none */
    const char* filename; /* as requested by the scene file, "" = none */
    uint32_t unexposed; /* for the host: 1 = the file has light in its own units and no exposure; the host meters one */
} RestageFilm;

typedef struct RestageSettings {
    RESTAGE_SIZE(RestageSettings);
    uint32_t max_depth; /* path vertices beyond the camera, pbrt's maxdepth: 0 = emission only */
    uint32_t samples; /* per pixel, from the file; 0 = unspecified */
    const RestageOrigin* origin; /* integrator, sampler, unknown options */
} RestageSettings;

typedef enum RestageFate { RESTAGE_KEPT = 0, RESTAGE_APPROXIMATED = 1, RESTAGE_DROPPED = 2 } RestageFate;

#define RESTAGE_IMPORTER1 "restage.importer/1"
#define RESTAGE_EXPORTER1 "restage.exporter/1"

/* Where an importer writes. Every function [worker], one thread at a time; data is copied before it returns.
 * A returned handle of 0 means the host refused (out of memory, invalid data) and recorded why: continue or return 0.
 */
typedef struct RestageSceneWriter1 {
    RESTAGE_SIZE(RestageSceneWriter1);
    void* ctx;
    RestageHandle (*mesh)(void* ctx, const RestageMesh*);
    RestageHandle (*image)(void* ctx, const RestageImage*);
    RestageHandle (*texture)(void* ctx, const RestageTexture*);
    RestageHandle (*material)(void* ctx, const RestageMaterialDesc*);
    RestageHandle (*medium)(void* ctx, const RestageMedium*);
    RestageHandle (*group)(void* ctx, const RestageGroup*);
    RestageHandle (*instance)(void* ctx, const RestageInstance*);
    RestageHandle (*light)(void* ctx, const RestageLight*);
    void (*environment)(void* ctx, const RestageEnvironment*);
    RestageHandle (*camera)(void* ctx, const RestageCamera*); /* the first is the active one */
    void (*camera_medium)(void* ctx, RestageHandle medium);
    void (*film)(void* ctx, const RestageFilm*);
    void (*settings)(void* ctx, const RestageSettings*);
    /* One line of the import report. `what`: 'material "oak"'; `note`: what was lost, or "" */
    void (*report)(void* ctx, int fate, const char* file, uint32_t line, const char* what, const char* note);
    /* Marks the import as broken: "mine, but malformed". Only the first call is shown. */
    void (*error)(void* ctx, const char* file, uint32_t line, uint32_t column, const char* message);
    /* 0..1; returns 0 if the user wants to stop: then return from load at once. */
    int (*progress)(void* ctx, float done, const char* what);
    /* The table of the material plugin for `type`, or NULL if there is none. */
    const RestageParam* (*material_table)(void* ctx, const char* type, uint32_t* count);
    /* Every option of the importer's table, in its order, set or default; valid until load returns. */
    const RestageValue* options;
    uint32_t option_count;
    /* Likewise for the texture plugin for `type`; a MAPPED type's includes the lines of its map (uscale ..). */
    const RestageParam* (*texture_table)(void* ctx, const char* type, uint32_t* count);
} RestageSceneWriter1;

typedef struct RestageImporter1 {
    RESTAGE_SIZE(RestageImporter1);
    const char* format; /* "pbrt" */
    const char* label; /* "pbrt scene (v3, v4)" */
    const char* extensions; /* "pbrt|gz" without dots, '|' between */
    /* [any] 0..100: confidence that the file is of this format. head: the first bytes of the file (up to 4 KiB). */
    int (*probe)(const char* path, const void* head, size_t head_size);
    /* [worker] 1 = done (perhaps with a report), 0 = broken: error() has been called. */
    int (*load)(const char* path, const RestageSceneWriter1* out);
    const RestageParam*
        options; /* for example `up` (ENUM y|z); NULL = none. `load` finds the values in its writer's `options` */
    uint32_t option_count;
} RestageImporter1;

/* Where an exporter reads. [worker]; handles are 1..count(kind), getters return 0 for holes (removed things). `size`
 * of a struct that a getter fills is set by the caller, in C. Pointers are valid until the export ends. */
typedef enum RestageKind {
    RESTAGE_KIND_MESH = 1,
    RESTAGE_KIND_IMAGE,
    RESTAGE_KIND_TEXTURE,
    RESTAGE_KIND_MATERIAL,
    RESTAGE_KIND_MEDIUM,
    RESTAGE_KIND_GROUP,
    RESTAGE_KIND_INSTANCE,
    RESTAGE_KIND_LIGHT,
    RESTAGE_KIND_CAMERA
} RestageKind;
typedef struct RestageSceneReader1 {
    RESTAGE_SIZE(RestageSceneReader1);
    void* ctx;
    uint32_t (*count)(void* ctx, uint32_t kind);
    int (*mesh)(void* ctx, RestageHandle, RestageMesh*);
    int (*image)(void* ctx, RestageHandle, RestageImage*); /* pixels may be NULL if `path` exists on disk */
    int (*texture)(void* ctx, RestageHandle, RestageTexture*);
    int (*material)(void* ctx, RestageHandle, RestageMaterialDesc*);
    int (*medium)(void* ctx, RestageHandle, RestageMedium*);
    int (*group)(void* ctx, RestageHandle, RestageGroup*);
    int (*instance)(void* ctx, RestageHandle, RestageInstance*);
    int (*light)(void* ctx, RestageHandle, RestageLight*);
    int (*environment)(void* ctx, RestageEnvironment*); /* 0 = none */
    int (*camera)(void* ctx, RestageHandle, RestageCamera*);
    RestageHandle (*active_camera)(void* ctx);
    RestageHandle (*camera_medium)(void* ctx);
    void (*film)(void* ctx, RestageFilm*);
    void (*settings)(void* ctx, RestageSettings*);
    void (*report)(void* ctx, int fate, const char* what, const char* note); /* what the format cannot hold */
    void (*error)(void* ctx, const char* file, const char* message);
    int (*progress)(void* ctx, float done, const char* what);
} RestageSceneReader1;

typedef struct RestageExporter1 {
    RESTAGE_SIZE(RestageExporter1);
    const char* format;
    const char* label;
    const char* extensions;
    const RestageParam* options; /* for example `version` (ENUM v4|v3), `textures` (ENUM copy|reference) */
    uint32_t option_count;
    /* [worker] Writes `path` and files in its folder; 1 = done, 0 = error() has been called. The same scene gives the
     * same bytes. */
    int (*save)(const char* path, const RestageSceneReader1* in, const RestageValue* options, uint32_t option_count);
} RestageExporter1;

#ifdef __cplusplus
}
#endif
#endif
