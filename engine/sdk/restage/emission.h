/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.emission/1": a material that emits. Pure data: the table names the parameters that hold the
 * radiance, and the host turns objects with the material into lights, which paths find by light sampling and by BSDF
 * sampling. The radiance leaving every point, in every direction on the outer side, is
 *
 *   L = radiance * scale   [W/(m^2 sr)], linear sRGB primaries
 *
 * where `radiance` may be a texture. An object with its own emission uses that instead. Components of a `mix` do
 * not emit, which the host reports. The BSDF stays what the GLSL says: a lamp may reflect as well. */
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
    const char* type; /* of a material in the same plugin */
    const char* radiance;  /* id of one of its COLOR parameters */
    const char* scale;     /* id of a FLOAT parameter without texture; NULL = 1 */
    const char* two_sided; /* id of a BOOL parameter; NULL = only the outer side emits */
} RestageEmission1;

#ifdef __cplusplus
}
#endif
#endif
