// SPDX-License-Identifier: Apache-2.0
// Push constants of the wavefront's kernels: data common to all paths of a wave, so that kernels need
// not load it through an address per path.
#ifndef RESTAGE_SHARED_WAVE_DATA_H
#define RESTAGE_SHARED_WAVE_DATA_H
#include "shared/address.h"
#include "shared/types.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(WAVE_PATHS, 65536u); // about 13 MB of path state: cache-friendly, amortises a submit
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct WavePush { // 128 bytes: the minimum guaranteed by Vulkan
    address frame;  // FrameData
    address rays;   // as in FrameData, from here
    address shadows;
    address paths;
    address guides;
    address queue;
    address scene;
    address instances; // as in SceneData, from here
    address materials;
    address params;
    address lights;
    address light_nodes;
    uint queue_first, queue_count;
    float world_copies;
    uint max_depth;
    uint russian_roulette;
    float clamp_direct, clamp_indirect;
    float ray_epsilon;
};

// Of wave_decide.comp.
struct HitAsked { // 16 bytes
    uint instance, prim;
    vec2 bary;
};
struct HitDecided { // 8 bytes
    float alpha; // within [0, 1]
    uint material; // as resolve_material
};
struct DecidePush {
    address scene; // SceneData
    address asked, decided;
    uint count, pad0;
};

RESTAGE_SHARED_END
#endif
