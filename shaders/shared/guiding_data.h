// SPDX-License-Identifier: Apache-2.0
// The guide of paths: a kd-tree over places and normals whose leaves say from where light arrives, as a histogram over
// the sphere. Mueller et al. 2017, "Practical Path Guiding for Efficient Light-Transport Simulation". Made by
// render/guiding_map.
#ifndef RESTAGE_SHARED_GUIDING_DATA_H
#define RESTAGE_SHARED_GUIDING_DATA_H
#include "shared/address.h"
#include "shared/types.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(GUIDING_SIDE, 16u); // cells of the octahedral map, per axis
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct GuidingNode { // 16 bytes
    float split;
    uint axis; // 0 to 2 of the place, 3 to 5 of the normal
    uint next; // the child below the split; the other one follows it. A leaf has an infinite split and leads to itself
    uint leaf; // its number
};

struct GuidingLeaf {
    float share; // of directions that come from the guide, [0, 1); the BSDF chooses the others
    float rows[16]; // running sums of the rows' probabilities
    float columns[256]; // likewise of each row's cells, given the row
    float density[256]; // of each cell, per solid angle
};

struct GuidingData { // 24 bytes
    address nodes; // GuidingNode[], the root first
    address leaves; // GuidingLeaf[]
    uint depth; // of the deepest leaf
    uint pad0;
};

RESTAGE_SHARED_END
#endif
