// SPDX-License-Identifier: Apache-2.0
// Hashes of floats to [0, 1), for choices that must fall the same way whoever makes them: cut-outs and mixes.
// render/gpu_scene.cpp has the same in C++.
#ifndef RESTAGE_LIB_HASH
#define RESTAGE_LIB_HASH
#include <restage/v1/rng.glsl>

const uint HASH_START = 0x9e3779b9u;
uint hash_add(uint h, float v) { return pcg_hash(h ^ floatBitsToUint(v)); }
uint hash_add(uint h, vec3 v) { return hash_add(hash_add(hash_add(h, v.x), v.y), v.z); }
float hash_unit(uint h) { return float(h >> 8) * (1.0 / 16777216.0); }

#endif
