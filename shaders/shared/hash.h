// SPDX-License-Identifier: Apache-2.0
// Hashes, for choices that every tracer must make alike: cut-outs and mixes. PCG-RXS-M-XS 32 (O'Neill
// 2014; as a hash, Jarzynski and Olano 2020).
#ifndef RESTAGE_SHARED_HASH_H
#define RESTAGE_SHARED_HASH_H
#include "shared/functions.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(HASH_START, 0x9e3779b9u);
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

RESTAGE_INLINE uint pcg_hash(uint x) {
    uint s = x * 747796405u + 2891336453u;
    uint w = ((s >> ((s >> 28u) + 4u)) ^ s) * 277803737u;
    return (w >> 22u) ^ w;
}
RESTAGE_INLINE uint hash_add(uint h, float v) { return pcg_hash(h ^ floatBitsToUint(v)); }
RESTAGE_INLINE uint hash_add(uint h, vec3 v) { return hash_add(hash_add(hash_add(h, v.x), v.y), v.z); }
RESTAGE_INLINE float hash_unit(uint h) { return float(h >> 8u) * (1.0f / 16777216.0f); } // [0, 1)

// Along a ray, for the surface `id`, primitive `prim`: one number per surface hit. pbrt 4ed, 7.1.1.
RESTAGE_INLINE float alpha_choice(vec3 origin, vec3 direction, uint id, uint prim) {
    uint h = hash_add(hash_add(HASH_START, origin), direction);
    return hash_unit(hash_add(hash_add(h, float(id)), float(prim)));
}
// Between the two materials of a mix, `depth` mixes deep: varies over the surface and is independent of the tracer.
RESTAGE_INLINE float mix_choice(vec2 bary, uint prim, uint depth) {
    return hash_unit(hash_add(hash_add(HASH_START, vec3(bary, float(prim))), float(depth)));
}

RESTAGE_SHARED_END
#endif
