/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.emission/1": a material that shines. Data alone: the table names the parameters of the material
 * that say how much, and the host makes lights of the objects that have it, which paths find by light sampling as by
 * BSDF sampling. What leaves every point, towards every direction of the outer side, is
 *
 *   L = radiance * scale   [W/(m^2 sr)], linear sRGB primaries
 *
 * where `radiance` may be a texture. An object with an emission of its own shines by that instead. Shares of a `mix` do
 * not shine; the host says so. The BSDF stays what the GLSL says: a lamp may reflect as well. */
#ifndef RESTAGE_EMISSION_H
#define RESTAGE_EMISSION_H

#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_EMISSION1 "restage.emission/1"

typedef struct RestageEmission1 {
    RESTAGE_SIZE(RestageEmission1);
    uint32_t reserved; /* 0 */
    const char* type; /* of a material of the same plugin */
    const char* radiance;  /* id of a COLOR parameter of it */
    const char* scale;     /* id of a FLOAT parameter without texture; NULL = 1 */
    const char* two_sided; /* id of a BOOL parameter; NULL = the outer side alone shines */
} RestageEmission1;

#ifdef __cplusplus
}
#endif
#endif
