// SPDX-License-Identifier: Apache-2.0
// What the stages of the ray-tracing pipeline share: the push constant and the two payloads.
// raygen loops over the path; the closest hit reports where; the callable of the hit's material type does the path step.
#ifndef RESTAGE_TRACE_COMMON
#define RESTAGE_TRACE_COMMON
#include "lib/quadric.glsl"
#include "path/film.glsl"
#include "shared/normal.h"

layout(push_constant, scalar) uniform Push { TracePush push; };

uint launch_pixel(FrameData frame) { // of the crop window, row by row
    return (push.y + gl_LaunchIDEXT.y) * frame.crop_width + push.x + gl_LaunchIDEXT.x;
}

// Cull masks: what light meets, and the borders of media, which it passes. An instance with gaps may be both.
const uint MASK_SURFACES = 1u;
const uint MASK_BORDERS = 2u;
const uint MASK_SHADOWS = 4u; // what stops shadow rays: surfaces but those of INSTANCE_PASSES

// Of traceRayEXT, location 0. 20 bytes.
struct HitPayload {
    float t; // in: >= 0; out: the hit's distance, or < 0 when the ray left the scene
    uint instance; // in: the mask, for any-hit; out: InstanceData index
    uint prim;
    vec2 bary;
};

// Of executeCallableEXT, location 1: a path and its hit go in, a shadow ray and the next ray come out. 152 bytes.
struct StepPayload {
    PathState path;    // in, out
    uint instance;     // in
    uint material;     // in: MaterialData index, mixes resolved
    uint prim;         // in
    float t;           // in: the hit's distance; out: > 0 when there is a next ray
    vec2 bary;         // in
    float tmin;        // in, out: where the ray begins
    vec3 origin;       // in, out
    vec3 direction;    // in: of the ray that hit; out: of the next one
    vec3 shadow_origin;
    vec3 shadow_direction;
    float shadow_tmax; // out: > 0 when there is a shadow ray
    vec3 shadow_contribution; // to the path's radiance, if the light is seen
    uint shadow_medium;
};

// The geometric normal on the outside, not unit.
vec3 outward_normal(InstanceData inst, uint prim, vec2 bary) {
    if (HAS_QUADRICS && (inst.flags & INSTANCE_QUADRIC) != 0u) {
        QuadricData q = quadric_of(inst);
        float phi = bary.x * q.phi_max, theta = mix(q.theta_min, q.theta_max, bary.y);
        vec3 around = vec3(cos(phi), sin(phi), 0.0), s = around;
        if (q.kind == QUADRIC_DISK) s = vec3(0, 0, 1);
        if (q.kind == QUADRIC_SPHERE) s = vec3(sin(theta) * around.xy, cos(theta));
        s = inst.normal_to_world * s;
        return (inst.flags & INSTANCE_FLIP_NORMAL) != 0u ? -s : s;
    }
    uvec3 tri = Uvec3Array(inst.indices).at[prim];
    Vec3Array positions = Vec3Array(inst.positions);
    vec3 p0 = positions.at[tri.x];
    vec3 n = inst.normal_to_world * cross(positions.at[tri.y] - p0, positions.at[tri.z] - p0);
    float along = 0.0;
    if ((inst.flags & INSTANCE_HAS_NORMALS) != 0u) {
        Vec3Array normals = Vec3Array(inst.normals);
        vec3 s = (1.0 - bary.x - bary.y) * normals.at[tri.x] + bary.x * normals.at[tri.y] + bary.y * normals.at[tri.z];
        along = dot(inst.normal_to_world * s, n);
    }
    return points_inward(along, (inst.flags & INSTANCE_FLIP_NORMAL) != 0u) ? -n : n;
}

#endif
