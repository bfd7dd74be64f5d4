// SPDX-License-Identifier: Apache-2.0
// Shared by the stages of the ray-tracing pipeline: the push constant and the two payloads.
// raygen loops over the path; the closest hit reports where; the callable of the hit's material type does the path step.
#ifndef RESTAGE_TRACE_COMMON
#define RESTAGE_TRACE_COMMON
#include "lib/outward.glsl"
#include "lib/quadric.glsl"
#include "path/film.glsl"

layout(push_constant, scalar) uniform Push { TracePush push; };

// A sample of the list, or of a rectangle of the crop window.
SamplePick launch_pick(FrameData frame) {
    uint x = push.x + gl_LaunchIDEXT.x;
    if (frame.picks != 0ul) return PickArray(frame.picks).at[x];
    return SamplePick((push.y + gl_LaunchIDEXT.y) * frame.crop_width + x, frame.first_sample + push.sample_index);
}

// Cull masks: what light hits, and the borders of media, which it passes. An instance with gaps may be both.
const uint MASK_SURFACES = 1u;
const uint MASK_BORDERS = 2u;
const uint MASK_SHADOWS = 4u; // what blocks shadow rays: surfaces except those with INSTANCE_PASSES

// Of traceRayEXT, location 0. 20 bytes.
struct HitPayload {
    float t; // in: >= 0; out: the hit's distance, or < 0 if the ray left the scene
    uint instance; // in: the mask, for any-hit; out: InstanceData index
    uint prim;
    vec2 bary;
};

// Of executeCallableEXT, location 1: a path and its hit go in, a shadow ray and the next ray come out. 156 bytes.
struct StepPayload {
    PathState path;    // in, out
    uint instance;     // in
    uint material;     // in: MaterialData index, mixes resolved
    uint prim;         // in
    float t;           // in: the hit's distance; out: > 0 if there is a next ray
    vec2 bary;         // in
    float tmin;        // in, out: start of the ray
    uint receiver;     // in, out: of its last vertex
    vec3 origin;       // in, out
    vec3 direction;    // in: of the ray that hit; out: of the next one
    vec3 shadow_origin;
    vec3 shadow_direction;
    float shadow_tmax; // out: > 0 if there is a shadow ray
    Spectrum shadow_contribution; // to the path's radiance, if the light is visible
    uint shadow_medium;
};

#endif
