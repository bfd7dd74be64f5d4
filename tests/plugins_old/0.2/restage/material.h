/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.material/1": a BSDF as a parameter table and a GLSL file; no native code runs while rendering.
 *
 * The GLSL file defines, with the table's prefix (here `p`), in the local shading frame (n = +z; wo towards the viewer,
 * wi towards the light, unit vectors that both point away from the surface; z < 0 is the back side):
 *
 *   Spectrum   p_eval  (p_Params m, vec3 wo, vec3 wi)    f(wo,wi) * |cos wi|  [1/sr], radiance transport (1/eta^2 on
 *                                                        transmission, Veach 1997 sec. 5.2); 0 for delta lobes
 *   float      p_pdf   (p_Params m, vec3 wo, vec3 wi)    solid-angle density of p_sample [1/sr]; 0 for delta lobes
 *   BsdfSample p_sample(p_Params m, vec3 wo, vec3 u)     u in [0,1)^3; see <restage/v1/bsdf.glsl>
 *   Spectrum   p_albedo(p_Params m, vec3 wo)             directional albedo, approximate (at the defaults within 0.3,
 *                                                        seen at up to 75 degrees); guides and light budget
 *
 * Of a material with RESTAGE_MATERIAL_SITE all four take `Site site` after `m`: the place on the object
 * (<restage/v1/site.glsl>). With RESTAGE_MATERIAL_STOCHASTIC, eval, pdf and sample take `inout Rng rng` as last
 * argument, and the expectation of eval is f*|cos|. `p_Params` is written by the host from the table: fields in its
 * order, already textured, a COLOR as a Spectrum: a vec3 in RGB mode, a vec4 in spectral mode, so that code must say
 * Spectrum and not vec3 (<restage/v1/spectrum.glsl>). The file may include the library, <restage/v1/microfacet.glsl>
 * and so on (share/restage/shaders), and files of its own folder. It sees nothing else, declares no bindings and no
 * buffers, and every name of its own starts with `p_`. RESTAGE_GLSL is the revision of the library, 1. */
#ifndef RESTAGE_MATERIAL_H
#define RESTAGE_MATERIAL_H

#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_MATERIAL1 "restage.material/1"

enum {
    RESTAGE_MATERIAL_STOCHASTIC = 1u,    /* eval/pdf/sample take an Rng */
    RESTAGE_MATERIAL_LOSSLESS = 2u,      /* the white furnace gives 1 when every COLOR is 1 (ADDITIVE: when they sum
                                     * to 1) and every other parameter has its default */
    RESTAGE_MATERIAL_TRANSMISSIVE = 4u,  /* may scatter to the other side */
    RESTAGE_MATERIAL_NONRECIPROCAL = 8u, /* f(wo,wi) != f(wi,wo), declared */
    RESTAGE_MATERIAL_NULL = 16u,         /* no surface at all: rays pass (pbrt's `interface`) */
    RESTAGE_MATERIAL_MIX = 32u, /* chooses between its MATERIAL parameters `first` and `second` by `amount` */
    RESTAGE_MATERIAL_TANGENT = 64u, /* depends on the tangent: the frame's x axis follows dp/du (anisotropy) */
    /* Its lobes add up as the scene says (pbrt-v3's plastic): energy <= 1 only while its COLOR parameters, all but an
     * "opacity", sum to at most 1; tests scale them so. */
    RESTAGE_MATERIAL_ADDITIVE = 128u,
    RESTAGE_MATERIAL_SITE = 256u /* depends on the place, not by textures alone: its functions take a Site */
};

typedef struct RestageMaterial1 {
    RESTAGE_SIZE(RestageMaterial1);
    uint32_t flags; /* RESTAGE_MATERIAL_* */
    const char* type; /* "conductor": what scene files and ParamSets call it; unique over all plugins */
    const char* label;
    const char* prefix; /* of every GLSL name, without the underscore */
    const char* glsl_file; /* relative to the plugin's folder; NULL for MIX and NULL-surface materials */
    const RestageParam* params;
    uint32_t param_count;
    const char* tooltip;
} RestageMaterial1;

#ifdef __cplusplus
}
#endif
#endif
