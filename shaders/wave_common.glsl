// SPDX-License-Identifier: Apache-2.0
// Shared by the wavefront kernels: path state in arrays behind the frame's addresses.
#ifndef RESTAGE_WAVE_COMMON
#define RESTAGE_WAVE_COMMON
#include "lib/light.glsl"
#include "path/film.glsl"
#include "shared/wave_data.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RayArray { RayHit at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ShadowArray { ShadowRay at[]; };

layout(push_constant, scalar) uniform Push { WavePush push; };

// The scene, with pushed values replacing those behind its address.
SceneData wave_scene() {
    SceneData scene = SceneRef(push.scene).scene;
    scene.instances = push.instances;
    scene.materials = push.materials;
    scene.params = push.params;
    scene.lights = push.lights;
    scene.light_nodes = push.light_nodes;
    scene.max_depth = push.max_depth;
    scene.russian_roulette = push.russian_roulette;
    scene.clamp_direct = push.clamp_direct;
    scene.clamp_indirect = push.clamp_indirect;
    scene.ray_epsilon = push.ray_epsilon;
    scene.world_copies = push.world_copies;
    if (HAS_GUIDING) scene.guiding = FrameRef(push.frame).frame.guiding;
    return scene;
}

// What a path has met, for Guiding: light that counts with the weight of `pdf` against pdf_light.
void note_light(uint path, Spectrum weighted, float pdf, float pdf_light) {
    float whole = weighted.x + weighted.y + weighted.z;
    if (pdf_light > 0.0) whole /= mis_weight(pdf, pdf_light);
    RayArray(push.rays).at[path].ng = vec3(whole, pdf_light, 0.0);
}

// FourthData[]; not read in RGB mode.
#ifdef RESTAGE_SPECTRAL
address wave_fourths() { return FrameRef(push.frame).frame.fourths; }
#else
address wave_fourths() { return uint64_t(0); }
#endif

// Of samples that are black now. The copies that fill a group do not count.
void count_not_finite(uint type, uint path) {
    if (path < WAVE_PATHS)
        atomicAdd(CounterArray(FrameRef(push.frame).frame.counters).at[min(type, uint(COUNTER_MAX_TYPES - 1))], 1u);
}

#endif
