// SPDX-License-Identifier: Apache-2.0
// The outside of a hit, without a Surface.
#ifndef RESTAGE_LIB_OUTWARD
#define RESTAGE_LIB_OUTWARD
#include "lib/quadric.glsl"
#include "lib/scene.glsl"
#include "shared/normal.h"

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
